#include "response/krylov_space.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of its length: what is left of a vector beneath this is nothing new. */
static const double dependent = 1e-10;

/* A gets `more` behind its columns; room is doubled where there is none. */
static ritz_status append(ritz_dense *A, int64_t *room, const ritz_dense *more)
{
    int64_t ncol = A->ncol + more->ncol;
    double *val = NULL;

    if (ncol > *room) {
        RITZ_CHECK_NEW(val, more->nrow * 2 * ncol);
        if (A->ncol > 0)
            memcpy(val, A->val, (size_t)(A->nrow * A->ncol) * sizeof *val);
        free(A->val);
        A->val = val;
        *room = 2 * ncol;
    }
    A->nrow = more->nrow;
    if (more->ncol > 0)
        memcpy(A->val + A->nrow * A->ncol, more->val,
               (size_t)(more->nrow * more->ncol) * sizeof *val);
    A->ncol = ncol;
    return RITZ_OK;
}

/* Columns of one kind into W, their modal part taken out, and into S. */
static ritz_status add_columns(ritz_krylov_space *s, ritz_krylov_kind kind,
                               int64_t first, ritz_dense *W)
{
    ritz_status status = RITZ_OK;
    int64_t before = s->W.ncol, S_room = s->W_room, old = s->W_room;
    ritz_krylov_column *column = NULL;
    ritz_dense S = {0};

    if (W->ncol == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_dense_take_out(s->MPhi, s->Phi, W));
    RITZ_TRY(ritz_dense_copy(W, &S));
    RITZ_TRY(ritz_factor_solve(s->F, &S));
    RITZ_TRY(append(&s->S, &S_room, &S));
    RITZ_TRY(append(&s->W, &s->W_room, W));
    if (s->W_room > old) {
        RITZ_NEW(column, s->W_room);
        if (before > 0)
            memcpy(column, s->column, (size_t)before * sizeof *column);
        free(s->column);
        s->column = column;
    }
    for (int64_t k = 0; k < W->ncol; k++)
        s->column[before + k] = (ritz_krylov_column){kind, first + k};
done:
    ritz_dense_free(&S);
    return status;
}

static ritz_status add_loads(ritz_krylov_space *s)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &s->component->io;
    const struct {
        const ritz_dense *rows;
        ritz_krylov_kind kind;
    } seen[] = {{&io->C, RITZ_KRYLOV_C},
                {&io->Cv, RITZ_KRYLOV_CV},
                {&io->Ca, RITZ_KRYLOV_CA}};
    ritz_dense W = {0};

    RITZ_TRY(ritz_dense_copy(&io->B, &W));
    RITZ_TRY(add_columns(s, RITZ_KRYLOV_B, 0, &W));
    for (size_t k = 0; k < sizeof seen / sizeof *seen; k++) {
        if (ritz_dense_max(seen[k].rows) == 0.0)
            continue;
        ritz_dense_free(&W);
        RITZ_TRY(ritz_dense_new(seen[k].rows->ncol, seen[k].rows->nrow, &W));
        for (int64_t j = 0; j < W.ncol; j++)
            for (int64_t i = 0; i < W.nrow; i++)
                ritz_dense_col(&W, j)[i] = ritz_dense_col(seen[k].rows, i)[j];
        RITZ_TRY(add_columns(s, seen[k].kind, 0, &W));
    }
done:
    ritz_dense_free(&W);
    return status;
}

/* One kind's matrix times columns of V, from `first` on. */
static ritz_status add_product(ritz_krylov_space *s, ritz_krylov_kind kind,
                               const ritz_sparse *A, int64_t first,
                               const ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_dense W = {0};

    if (!A->colptr || X->ncol == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_sparse_mul(A, X, &W));
    RITZ_TRY(add_columns(s, kind, first, &W));
done:
    ritz_dense_free(&W);
    return status;
}

/* What damping matrices do with columns of V. */
static ritz_status add_damping(ritz_krylov_space *s, int64_t first,
                               const ritz_dense *X)
{
    RITZ_CHECK(add_product(s, RITZ_KRYLOV_D, &s->component->D, first, X));
    RITZ_CHECK(add_product(s, RITZ_KRYLOV_DT, &s->DT, first, X));
    return add_product(s, RITZ_KRYLOV_K4, &s->component->K4, first, X);
}

static ritz_status weigh(ritz_krylov_space *s)
{
    ritz_dense_free(&s->G);
    RITZ_CHECK(ritz_dense_mul_tn(&s->W, &s->S, &s->G));
    ritz_dense_symmetrise(&s->G);
    return RITZ_OK;
}

ritz_status ritz_krylov_space_new(const ritz_direct *direct, double tau,
                                  ritz_krylov_space *out)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = direct->component;
    ritz_krylov_space s = {.component = c,
                           .tau = tau,
                           .Phi = &direct->pairs.Phi,
                           .MPhi = &direct->MPhi};

    RITZ_TRY(ritz_sparse_add(1.0, &c->K, tau, &c->M, &s.A));
    RITZ_TRY_IN("static answer", ritz_factor_spd(&s.A, &s.F));
    if (c->D.colptr && ritz_sparse_asymmetry(&c->D) > 0.0)
        RITZ_TRY(ritz_sparse_transpose(&c->D, &s.DT));
    RITZ_TRY(append(&s.V, &s.V_room, s.Phi));
    RITZ_TRY(add_loads(&s));
    RITZ_TRY(add_damping(&s, 0, s.Phi));
    RITZ_TRY(weigh(&s));
    *out = s;
    s = (ritz_krylov_space){0};
done:
    ritz_krylov_space_free(&s);
    return status;
}

/* x := x - X X'A x for the columns of X, and its length in A. */
static ritz_status turn(const ritz_krylov_space *s, const ritz_dense *X,
                        ritz_dense *x, double *length)
{
    ritz_status status = RITZ_OK;
    ritz_dense Ax = {0}, share = {0}, part = {0};

    RITZ_TRY(ritz_dense_take_out(s->Phi, s->MPhi, x));
    RITZ_TRY(ritz_sparse_mul(&s->A, x, &Ax));
    RITZ_TRY(ritz_dense_mul_tn(X, &Ax, &share));
    RITZ_TRY(ritz_dense_mul(X, &share, &part));
    for (int64_t i = 0; i < x->nrow; i++)
        x->val[i] -= part.val[i];
    ritz_dense_free(&Ax);
    RITZ_TRY(ritz_sparse_mul(&s->A, x, &Ax));
    *length = sqrt(fmax(ritz_dense_dot(x, 0, &Ax, 0), 0.0));
done:
    ritz_dense_free(&Ax);
    ritz_dense_free(&share);
    ritz_dense_free(&part);
    return status;
}

/* One vector; twice is enough for orthogonality. */
static ritz_status add_one(ritz_krylov_space *s, ritz_dense *x, bool *added)
{
    int64_t m = s->Phi->ncol;
    const ritz_dense none = {.nrow = x->nrow};
    ritz_dense X = ritz_dense_part(&s->V, m, s->V.ncol - m);
    double before = 0.0, length = 0.0;

    *added = false;
    if (s->V.ncol >= x->nrow)
        return RITZ_OK;
    RITZ_CHECK(turn(s, &none, x, &before));
    for (int pass = 0; pass < 2; pass++) {
        RITZ_CHECK(turn(s, &X, x, &length));
        if (!(length > dependent * before) || !isfinite(length))
            return RITZ_OK;
    }
    for (int64_t i = 0; i < x->nrow; i++)
        x->val[i] /= length;
    RITZ_CHECK(append(&s->V, &s->V_room, x));
    *added = true;
    return RITZ_OK;
}

ritz_status ritz_krylov_space_add(ritz_krylov_space *space, ritz_dense *X,
                                  int64_t *added)
{
    int64_t first = space->V.ncol;
    ritz_dense fresh = {0};

    for (int64_t k = 0; k < X->ncol; k++) {
        ritz_dense x = ritz_dense_part(X, k, 1);
        bool one = false;

        RITZ_CHECK(add_one(space, &x, &one));
    }
    *added = space->V.ncol - first;
    fresh = ritz_dense_part(&space->V, first, *added);
    RITZ_CHECK(
        add_product(space, RITZ_KRYLOV_K, &space->component->K, first, &fresh));
    RITZ_CHECK(
        add_product(space, RITZ_KRYLOV_M, &space->component->M, first, &fresh));
    RITZ_CHECK(add_damping(space, first, &fresh));
    return weigh(space);
}

void ritz_krylov_space_free(ritz_krylov_space *space)
{
    ritz_sparse_free(&space->A);
    ritz_factor_free(&space->F);
    ritz_sparse_free(&space->DT);
    ritz_dense_free(&space->V);
    ritz_dense_free(&space->W);
    ritz_dense_free(&space->S);
    ritz_dense_free(&space->G);
    free(space->column);
    *space = (ritz_krylov_space){0};
}
