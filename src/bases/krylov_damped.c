/*
 * The recurrence of the states. A block of states may be independent of the
 * others and add nothing to V: without damping, every second one is [0; d]. A
 * state is therefore kept by its coordinates in V, two columns as long as V is
 * wide, orthonormal among themselves: the two-level orthogonal Arnoldi
 * procedure of [LuSuBai2016].
 */
#include "bases/krylov_block.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/loads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* States [d; v] of a damped structure, as coordinates in Krylov vectors. */

/* One Krylov sequence of states. */
typedef struct ritz_krylov_states {
    const ritz_sparse *D;  /* borrowed; NULL: undamped */
    int64_t room;          /* rows of d in a state, as many as V can have */
    ritz_orthonormal kept; /* rows of d, then as many of v */
    int64_t first, count;  /* the last block of states */
    int64_t whole;         /* blocks of which V missed nothing */
    bool ended;            /* nothing new came of the last block */
} ritz_krylov_states;

/* Copy the rows of A to the rows of Z from `at` on. */
static void copy_rows(const ritz_dense *A, int64_t at, ritz_dense *Z)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(Z, j)[at + i] = ritz_dense_col(A, j)[i];
}

/* Copy `count` rows of the last states of a chain, from row `at` on. */
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
 * coordinates (WV)' d; v is in coordinates already.
 */
static ritz_status append_state(ritz_krylov *S, const ritz_forces *forces,
                                const ritz_dense *v, ritz_krylov_states *c)
{
    ritz_orthonormal *set = &S->set;
    RITZ_OWN(ritz_dense) R = {0}, raw = {0}, d = {0}, Z = {0};
    ritz_dense WV = {0};

    RITZ_CHECK(ritz_krylov_answer(S, &S->point[0], forces, &R));
    RITZ_CHECK(ritz_dense_copy(&R, &raw));
    RITZ_CHECK(ritz_orthonormal_append(set, &R, S->vectors - set->count, NULL));
    WV = ritz_dense_part(&set->WV, 0, set->count);
    RITZ_CHECK(ritz_dense_mul_tn(&WV, &raw, &d));
    RITZ_CHECK(ritz_dense_new(2 * c->room, d.ncol, &Z));
    copy_rows(&d, 0, &Z);
    copy_rows(v, c->room, &Z);
    c->first = c->kept.count;
    RITZ_CHECK(ritz_orthonormal_append(&c->kept, &Z, Z.ncol, NULL));
    c->count = c->kept.count - c->first;
    c->ended = c->count == 0;
    c->whole += !c->ended && set->left == 0;
    return RITZ_OK;
}

/* -omega (D d + omega M v), with d and v from their coordinates. */
static ritz_status find_forces(const ritz_krylov *S, const ritz_sparse *D,
                               double omega, const ritz_dense *d_in_V,
                               const ritz_dense *v_in_V, ritz_forces *out)
{
    const ritz_sparse *M = S->body->M;
    const ritz_dense V = ritz_dense_part(&S->set.V, 0, S->set.count);
    RITZ_OWN(ritz_dense) d = {0}, v = {0}, Dd = {0}, Mv = {0};

    RITZ_CHECK(ritz_dense_mul(&V, d_in_V, &d));
    RITZ_CHECK(ritz_dense_mul(&V, v_in_V, &v));
    RITZ_CHECK(ritz_sparse_mul(M, &v, &Mv));
    RITZ_CHECK(ritz_dense_new(V.nrow, d.ncol, &out->G));
    RITZ_CHECK(ritz_dense_new(V.nrow, d.ncol, &out->size));
    for (int64_t k = 0; k < V.nrow * d.ncol; k++)
        out->G.val[k] = -omega * omega * Mv.val[k];
    ritz_krylov_size(M, &v, omega * omega, &out->size);
    if (!D)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(D, &d, &Dd));
    for (int64_t k = 0; k < V.nrow * d.ncol; k++)
        out->G.val[k] -= omega * Dd.val[k];
    ritz_krylov_size(D, &d, omega, &out->size);
    return RITZ_OK;
}

static void free_krylov_states(ritz_krylov_states *chain)
{
    ritz_orthonormal_free(&chain->kept);
    *chain = (ritz_krylov_states){0};
}

/*
 * Begin a chain with the static response to forces: d = P' S P G, v = 0.
 *
 * @param[in]     D  borrowed until free, NULL where there is none
 * @param[in,out] S  whose V takes what is new in d
 */
static ritz_status start_krylov_states(ritz_krylov *S, const ritz_sparse *D,
                                       const ritz_forces *forces,
                                       ritz_krylov_states *out)
{
    ritz_status status = RITZ_OK;
    ritz_krylov_states chain = {.D = D, .room = S->vectors};
    const ritz_dense at_rest = {0};

    RITZ_TRY(ritz_orthonormal_new(2 * chain.room, NULL, S->set.tolerance,
                                  &chain.kept));
    RITZ_TRY(append_state(S, forces, &at_rest, &chain));
    RITZ_MOVE(*out, chain);
done:
    free_krylov_states(&chain);
    return status;
}

/*
 * Append a block: d <- -omega P' S P (D d + omega M v), v <- d.
 *
 * @param[in] omega  unit of velocities  [rad/s]
 */
static ritz_status advance_krylov_states(ritz_krylov *S, double omega,
                                         ritz_krylov_states *chain)
{
    RITZ_OWN(ritz_dense) d = {0}, v = {0};
    RITZ_OWN(ritz_forces) forces = {0};

    RITZ_CHECK(pick_rows(chain, 0, S->set.count, &d));
    RITZ_CHECK(pick_rows(chain, chain->room, S->set.count, &v));
    RITZ_CHECK(find_forces(S, chain->D, omega, &d, &v, &forces));
    return append_state(S, &forces, &d, chain);
}

/*
 * Krylov reduction of a damped structure: the recurrence of its first-order
 * form for displacement d and velocity v [CraigSuKim1992, sec. 3],
 *
 *     d_j+1 = -K^-1 (D d_j + M v_j),   v_j+1 = d_j,   d_1 = K^-1 F,  v_1 = 0
 *
 * of which the displacements alone are kept, span V = span of d_1, d_2, ...:
 * the reduced model stays symmetric and of second order, and keeps as many
 * moments of C (s^2 M + s D + K)^-1 B about s = 0 as it has whole blocks, twice
 * as many with both inputs and outputs among the loads. Velocity outputs start
 * as K^-1 Cv' does; the paper's M^-1 Cv' adds nothing to that, and M may be
 * singular.
 *
 * Raw vectors would align with the slowest mode. States are therefore combined
 * to be orthonormal; as both halves lie in the span of V, a state is two short
 * columns of coordinates in V [LuSuBai2016]. Velocities count in units of
 * omega, of the lowest Rayleigh quotient of the start.
 *
 * An unsymmetric D, of gyroscopes, goes with inputs, and D' with outputs: two
 * chains. Damping that acts on rigid motion couples it to the rest, so that
 * D Phi_r joins the loads of a free body.
 */

enum {
    MOST_CHAINS = 2,
    ALL_LOADS = RITZ_LOADS_ATTACHED | RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS,
};

typedef struct recurrence {
    const ritz_request *request;
    ritz_sparse K;              /* with the springs of discrete dampers */
    ritz_sparse D[MOST_CHAINS]; /* D, and D' if that is not the same */
    ritz_elastic body;
    ritz_krylov S;
    int64_t num_chains;
    ritz_krylov_states chain[MOST_CHAINS];
} recurrence;

static void free_recurrence(recurrence *r)
{
    for (int64_t k = 0; k < MOST_CHAINS; k++) {
        free_krylov_states(&r->chain[k]);
        ritz_sparse_free(&r->D[k]);
    }
    ritz_krylov_free(&r->S);
    ritz_elastic_free(&r->body);
    ritz_sparse_free(&r->K);
}

/* D := D + a M + b K; springs of dampers are part of K. */
static ritz_status add_rayleigh(const ritz_sparse *K, const ritz_sparse *M,
                                const ritz_damping *damping, ritz_sparse *D)
{
    RITZ_OWN(ritz_sparse) C = {0}, sum = {0};

    RITZ_CHECK(ritz_sparse_add(damping->a, M, damping->b, K, &C));
    if (D->colptr)
        RITZ_CHECK(ritz_sparse_add(1.0, D, 1.0, &C, &sum));
    else {
        RITZ_MOVE(sum, C);
    }
    ritz_sparse_free(D);
    RITZ_MOVE(*D, sum);
    return RITZ_OK;
}

/*
 * D of the model and of the requested damping, and K with the dampers' springs.
 */
static ritz_status collect_matrices(recurrence *r)
{
    const ritz_component *component = r->request->component;
    const ritz_choice *choice = &r->request->choice;
    ritz_damping damping = choice->damping;
    RITZ_OWN(ritz_dampers) dampers = {0};

    if (!(choice->given & RITZ_USES_DAMPING))
        RITZ_CHECK_IN("damping",
                      ritz_damping_parse(component->damping, &damping));
    RITZ_REFUSE_IF(damping.kind != RITZ_DAMPING_NONE &&
                       !ritz_damping_is_rayleigh(&damping),
                   RITZ_ERR_ARGUMENT,
                   "ratios of modes make no matrix D, which moments need: give "
                   "rayleigh damping");
    RITZ_CHECK(ritz_sparse_copy(&component->K, &r->K));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_copy(&component->D, &r->D[0]));
    if (component->dampers.count > 0) {
        RITZ_CHECK(ritz_dampers_copy(&component->dampers, &dampers));
        RITZ_CHECK(ritz_dampers_install_sparse(&dampers, &r->K, &r->D[0]));
    }
    if (damping.kind != RITZ_DAMPING_NONE)
        RITZ_CHECK(add_rayleigh(&r->K, &component->M, &damping, &r->D[0]));
    return RITZ_OK;
}

/* Columns of A from column `first` on of the forces, |A| of their sizes. */
static void add_columns(const ritz_dense *A, const ritz_dense *size,
                        int64_t first, ritz_forces *out)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++) {
            ritz_dense_col(&out->G, first + j)[i] = ritz_dense_col(A, j)[i];
            ritz_dense_col(&out->size, first + j)[i] =
                fabs(ritz_dense_col(size, j)[i]);
        }
}

/* Loads of a chain, and the damping forces of rigid motion. */
static ritz_status collect_loads(const recurrence *r, const ritz_sparse *D,
                                 int loads, ritz_forces *out)
{
    const ritz_dense *Phi = &r->body.Phi;
    int64_t n = r->K.nrow;
    int64_t count = ritz_loads_count(r->request, loads);
    int64_t more = D ? Phi->ncol : 0;
    RITZ_OWN(ritz_dense) F = {0}, DPhi = {0}, size = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    if (count > 0)
        RITZ_CHECK(ritz_loads_collect(r->request, loads, &F, &dof));
    RITZ_CHECK(ritz_dense_new(n, count + more, &out->G));
    RITZ_CHECK(ritz_dense_new(n, count + more, &out->size));
    add_columns(&F, &F, 0, out);
    if (more == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(D, Phi, &DPhi));
    RITZ_CHECK(ritz_dense_new(n, more, &size));
    ritz_krylov_size(D, Phi, 1.0, &size);
    add_columns(&DPhi, &size, count, out);
    return RITZ_OK;
}

/* omega^2 = lowest q'Kq / q'Mq of the vectors of the start; 1 without mass. */
static ritz_status choose_unit(const recurrence *r, double *omega)
{
    const ritz_dense V = ritz_dense_part(&r->S.set.V, 0, r->S.set.count);
    RITZ_OWN(ritz_dense) MV = {0}, KV = {0};
    double most = 0.0;

    RITZ_CHECK(ritz_sparse_mul(&r->request->component->M, &V, &MV));
    RITZ_CHECK(ritz_sparse_mul(&r->K, &V, &KV));
    for (int64_t j = 0; j < V.ncol; j++) {
        double m = 0.0;
        double k = 0.0;

        for (int64_t i = 0; i < V.nrow; i++) {
            m += ritz_dense_col(&V, j)[i] * ritz_dense_col(&MV, j)[i];
            k += ritz_dense_col(&V, j)[i] * ritz_dense_col(&KV, j)[i];
        }
        if (m > 0.0 && k > 0.0)
            most = fmax(most, m / k);
    }
    *omega = most > 0.0 ? 1.0 / sqrt(most) : 1.0;
    return RITZ_OK;
}

static ritz_status start_chain(recurrence *r, int64_t k, const ritz_sparse *D,
                               int loads)
{
    RITZ_OWN(ritz_forces) forces = {0};

    RITZ_CHECK(collect_loads(r, D, loads, &forces));
    RITZ_CHECK(start_krylov_states(&r->S, D, &forces, &r->chain[k]));
    r->num_chains = k + 1;
    return RITZ_OK;
}

/*
 * The chain of inputs with D and that of outputs with D'; one chain if both are
 * the same.
 */
static ritz_status start_chains(recurrence *r, int loads)
{
    const ritz_sparse *D = r->D[0].colptr ? &r->D[0] : NULL;

    if (!D || ritz_sparse_asymmetry(D) <= RITZ_SYMMETRIC)
        return start_chain(r, 0, D, loads);
    RITZ_CHECK(ritz_sparse_transpose(D, &r->D[1]));
    RITZ_CHECK(start_chain(r, 0, D, loads & ~RITZ_LOADS_OUTPUTS));
    return start_chain(r, 1, &r->D[1], loads & ~RITZ_LOADS_INPUTS);
}

static ritz_status run_chains(recurrence *r, int loads)
{
    double omega = 1.0;
    bool moving = true;

    RITZ_CHECK(start_chains(r, loads));
    RITZ_CHECK(choose_unit(r, &omega));
    while (moving && r->S.set.count < r->S.vectors) {
        moving = false;
        for (int64_t k = 0; k < r->num_chains; k++) {
            ritz_krylov_states *chain = &r->chain[k];

            if (chain->ended || r->S.set.count == r->S.vectors)
                continue;
            RITZ_CHECK(advance_krylov_states(&r->S, omega, chain));
            moving = moving || !chain->ended;
        }
    }
    r->S.point[0].whole = r->chain[0].whole;
    return RITZ_OK;
}

static ritz_status find_basis(recurrence *r, ritz_basis *out)
{
    const ritz_request *request = r->request;
    int loads = request->choice.loads ? request->choice.loads : ALL_LOADS;
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    RITZ_CHECK(ritz_loads_collect(request, loads, &F, &dof)); /* refuses none */
    RITZ_CHECK(collect_matrices(r));
    RITZ_CHECK(ritz_elastic_new(&r->K, &request->component->M, &r->body));
    RITZ_CHECK(ritz_krylov_new(&r->body, request, &r->S));
    RITZ_CHECK(run_chains(r, loads));
    RITZ_CHECK(ritz_krylov_join(&r->S, out));
    ritz_krylov_say_blocks(&r->S, request->modes, out);
    if (!r->D[0].colptr)
        ritz_krylov_say(out, "; there is no damping, krylov does the same");
    return ritz_krylov_say_orthonormal(&r->S, out);
}

static ritz_status make_krylov_damped(const ritz_request *request,
                                      ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    recurrence r = {.request = request};
    ritz_basis basis = {0};

    RITZ_TRY(find_basis(&r, &basis));
    RITZ_MOVE(*out, basis);
done:
    free_recurrence(&r);
    ritz_basis_free(&basis);
    return status;
}

const ritz_method ritz_method_krylov_damped = {
    .name = "krylov-damped",
    .summary = "rigid modes and block Krylov vectors of the damped structure",
    .reference = "CraigSuKim1992",
    .when = "damping that is not small, or that couples modes",
    .cost = "a factor, one solve a state: up to two a vector",
    .holds = "moments of the damped model, statics first; symmetry",
    .fails = "ratios of modes, which are no matrix D: refused",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS |
            RITZ_USES_INNER | RITZ_USES_DAMPING,
    .make = make_krylov_damped,
};
