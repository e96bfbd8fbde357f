/*
 * The recurrence of krylov_damped.c. V may gain nothing from a block of states
 * that is new all the same: without damping, every second one is
 * [0; d]. A state is therefore kept by its coordinates in V, two columns as
 * long as V is wide, orthonormal among themselves: the
 * two-level orthogonal Arnoldi procedure of [LuSuBai2016].
 */
#include "bases/krylov_states.h"

/* Put rows 0.. of A below row `at` of Z. */
static void put_rows(const ritz_dense *A, int64_t at, ritz_dense *Z)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(Z, j)[at + i] = ritz_dense_col(A, j)[i];
}

/* `count` rows of the last states of a chain, from row `at` on. */
static ritz_status pick_rows(const ritz_krylov_states *c, int64_t at,
                             int64_t count, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(count, c->count, out));
    for (int64_t j = 0; j < c->count; j++)
        for (int64_t i = 0; i < count; i++)
            ritz_dense_col(out, j)[i] =
                ritz_dense_col(&c->kept.V, c->first + j)[at + i];
    return RITZ_OK;
}

/*
 * Append d to V, and the states [d; v] to those of the chain: d by its
 * coordinates (WV)' d, v as it is in coordinates already.
 */
static ritz_status append(ritz_krylov *S, const ritz_forces *forces,
                          const ritz_dense *v, ritz_krylov_states *c)
{
    ritz_status status = RITZ_OK;
    ritz_orthonormal *set = &S->set;
    ritz_dense R = {0}, raw = {0}, d = {0}, Z = {0}, WV = {0};

    RITZ_TRY(ritz_krylov_answer(S, &S->point[0], forces, &R));
    RITZ_TRY(ritz_dense_copy(&R, &raw));
    RITZ_TRY(ritz_orthonormal_append(set, &R, S->vectors - set->count, NULL));
    WV = ritz_dense_part(&set->WV, 0, set->count);
    RITZ_TRY(ritz_dense_mul_tn(&WV, &raw, &d));
    RITZ_TRY(ritz_dense_new(2 * c->room, d.ncol, &Z));
    put_rows(&d, 0, &Z);
    put_rows(v, c->room, &Z);
    c->first = c->kept.count;
    RITZ_TRY(ritz_orthonormal_append(&c->kept, &Z, Z.ncol, NULL));
    c->count = c->kept.count - c->first;
    c->ended = c->count == 0;
    c->whole += !c->ended && set->left == 0;
done:
    ritz_dense_free(&R);
    ritz_dense_free(&raw);
    ritz_dense_free(&d);
    ritz_dense_free(&Z);
    return status;
}

/* -omega (D d + omega M v), with d and v from their coordinates. */
static ritz_status find_forces(const ritz_krylov *S, const ritz_sparse *D,
                               double omega, const ritz_dense *d_in_V,
                               const ritz_dense *v_in_V, ritz_forces *out)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *M = S->body->M;
    const ritz_dense V = ritz_dense_part(&S->set.V, 0, S->set.count);
    ritz_dense d = {0}, v = {0}, Dd = {0}, Mv = {0};

    RITZ_TRY(ritz_dense_mul(&V, d_in_V, &d));
    RITZ_TRY(ritz_dense_mul(&V, v_in_V, &v));
    RITZ_TRY(ritz_sparse_mul(M, &v, &Mv));
    RITZ_TRY(ritz_dense_new(V.nrow, d.ncol, &out->G));
    RITZ_TRY(ritz_dense_new(V.nrow, d.ncol, &out->size));
    for (int64_t k = 0; k < V.nrow * d.ncol; k++)
        out->G.val[k] = -omega * omega * Mv.val[k];
    ritz_krylov_size(M, &v, omega * omega, &out->size);
    if (!D)
        goto done;
    RITZ_TRY(ritz_sparse_mul(D, &d, &Dd));
    for (int64_t k = 0; k < V.nrow * d.ncol; k++)
        out->G.val[k] -= omega * Dd.val[k];
    ritz_krylov_size(D, &d, omega, &out->size);
done:
    ritz_dense_free(&d);
    ritz_dense_free(&v);
    ritz_dense_free(&Dd);
    ritz_dense_free(&Mv);
    return status;
}

ritz_status ritz_krylov_states_start(ritz_krylov *S, const ritz_sparse *D,
                                     const ritz_forces *forces,
                                     ritz_krylov_states *out)
{
    ritz_status status = RITZ_OK;
    ritz_krylov_states chain = {.D = D, .room = S->vectors};
    const ritz_dense at_rest = {0};

    RITZ_TRY(ritz_orthonormal_new(2 * chain.room, NULL, S->set.tolerance,
                                  &chain.kept));
    RITZ_TRY(append(S, forces, &at_rest, &chain));
    *out = chain;
    chain = (ritz_krylov_states){0};
done:
    ritz_krylov_states_free(&chain);
    return status;
}

ritz_status ritz_krylov_states_advance(ritz_krylov *S, double omega,
                                       ritz_krylov_states *chain)
{
    ritz_status status = RITZ_OK;
    ritz_dense d = {0}, v = {0};
    ritz_forces forces = {0};

    RITZ_TRY(pick_rows(chain, 0, S->set.count, &d));
    RITZ_TRY(pick_rows(chain, chain->room, S->set.count, &v));
    RITZ_TRY(find_forces(S, chain->D, omega, &d, &v, &forces));
    RITZ_TRY(append(S, &forces, &d, chain));
done:
    ritz_dense_free(&d);
    ritz_dense_free(&v);
    ritz_forces_free(&forces);
    return status;
}

void ritz_krylov_states_free(ritz_krylov_states *chain)
{
    ritz_orthonormal_free(&chain->kept);
    *chain = (ritz_krylov_states){0};
}
