/*
 * The recurrence of the states. A block of states may be independent of the
 * others and add nothing to V: without damping, every second one is [0; d]. A
 * state is therefore kept by its coordinates in V, two columns as long as V is
 * wide, orthonormal among themselves: the two-level orthogonal Arnoldi
 * procedure of [LuSuBai2016].
 */
#include "bases/krylov_waves.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "model/modal.h"

#include <math.h>
#include <stdio.h>

/* States [d; v] of a damped structure, as coordinates in Krylov vectors. */

/* One Krylov sequence of states. */
typedef struct state_chain {
    const ritz_sparse *D;  /* borrowed; NULL: undamped */
    int64_t room;          /* rows of d in a state, as many as V can have */
    ritz_orthonormal kept; /* rows of d, then as many of v */
    int64_t first, count;  /* the last block of states */
    int64_t whole;         /* blocks of which V missed nothing */
    bool ended;            /* nothing new came of the last block */
} state_chain;

static void state_chain_free(state_chain *chain)
{
    ritz_orthonormal_free(&chain->kept);
    *chain = (state_chain){0};
}

/*
 * Append d to V, and the states [d; v] to those of the chain: d by its
 * coordinates (WV)' d; v is in coordinates already.
 */
static ritz_status append_state(ritz_krylov *S, const ritz_forces *forces,
                                const ritz_dense *v, state_chain *c)
{
    ritz_orthonormal *set = &S->set;
    RITZ_OWN(ritz_dense) R = {0}, d = {0}, Z = {0};

    RITZ_CHECK(ritz_krylov_respond(S, &S->point[0], forces, &R));
    RITZ_CHECK(ritz_orthonormal_express(set, &R, S->vectors - set->count, &d));
    RITZ_CHECK(ritz_dense_new(2 * c->room, d.ncol, &Z));
    ritz_dense_put(&d, 0, 0, &Z);
    ritz_dense_put(v, c->room, 0, &Z);
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

/*
 * Append a block: d <- -omega P' S P (D d + omega M v), v <- d.
 *
 * @param[in] omega  unit of velocities  [rad/s]
 */
static ritz_status advance_chain(ritz_krylov *S, double omega,
                                 state_chain *chain)
{
    int64_t n = S->set.count;
    RITZ_OWN(ritz_dense) d = {0}, v = {0};
    RITZ_OWN(ritz_forces) forces = {0};

    RITZ_CHECK(
        ritz_dense_block(&chain->kept.V, 0, n, chain->first, chain->count, &d));
    RITZ_CHECK(ritz_dense_block(&chain->kept.V, chain->room, n, chain->first,
                                chain->count, &v));
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

enum { MOST_CHAINS = 2, MOST_WAVES = MOST_CHAINS * (int)RITZ_MOST_SHIFTS };

typedef struct recurrence {
    const ritz_request *request;
    ritz_sparse K;              /* with the springs of discrete dampers */
    ritz_sparse D[MOST_CHAINS]; /* D, and D' if that is not the same */
    const ritz_sparse *K4;      /* NULL: none */
    ritz_elastic body;
    ritz_krylov S;
    int64_t num_chains; /* real sequences: about 0 Hz, without K4 */
    state_chain chain[MOST_CHAINS];
    ritz_wave_point point[RITZ_MOST_SHIFTS]; /* for complex sequences; same
                                                indices as S.point */
    int64_t num_waves;
    ritz_waves wave[MOST_WAVES];
} recurrence;

static void recurrence_free(recurrence *r)
{
    for (int64_t k = 0; k < MOST_WAVES; k++)
        ritz_waves_free(&r->wave[k]);
    for (int64_t k = 0; k < RITZ_MOST_SHIFTS; k++)
        ritz_wave_point_free(&r->point[k]);
    for (int64_t k = 0; k < MOST_CHAINS; k++) {
        state_chain_free(&r->chain[k]);
        ritz_sparse_free(&r->D[k]);
    }
    ritz_krylov_free(&r->S);
    ritz_elastic_free(&r->body);
    ritz_sparse_free(&r->K);
}

/*
 * D of the model and of the requested damping, and K with the dampers' springs.
 */
static ritz_status collect_matrices(recurrence *r)
{
    ritz_damping damping = {0};

    RITZ_CHECK(ritz_request_damping(r->request, &damping));
    RITZ_REFUSE_IF(damping.kind != RITZ_DAMPING_NONE &&
                       !ritz_damping_is_rayleigh(&damping),
                   RITZ_ERR_ARGUMENT,
                   "ratios of modes make no matrix D, which moments need: give "
                   "rayleigh damping");
    if (r->request->component->K4.colptr)
        r->K4 = &r->request->component->K4;
    return ritz_structure_sparse(r->request->component, &damping, &r->K,
                                 &r->D[0]);
}

/* Loads of a chain, and the damping forces of rigid motion. */
static ritz_status collect_loads(const recurrence *r, const ritz_sparse *D,
                                 int loads, ritz_forces *out)
{
    const ritz_dense *Phi = &r->body.Phi;
    int64_t n = r->K.nrow;
    int64_t count = ritz_loads_count(r->request, loads);
    int64_t more = D ? Phi->ncol : 0;
    RITZ_OWN(ritz_dense) F = {0}, DPhi = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;
    ritz_dense size = {0};

    if (count > 0)
        RITZ_CHECK(ritz_loads_collect(r->request, loads, &F, &dof));
    RITZ_CHECK(ritz_dense_new(n, count + more, &out->G));
    ritz_dense_put(&F, 0, 0, &out->G);
    RITZ_CHECK(ritz_dense_abs(&out->G, &out->size));
    if (more == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(D, Phi, &DPhi));
    ritz_dense_put(&DPhi, 0, count, &out->G);
    size = ritz_dense_part(&out->size, count, more);
    ritz_krylov_size(D, Phi, 1.0, &size);
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
        double m = ritz_dense_dot(&V, j, &MV, j);
        double k = ritz_dense_dot(&V, j, &KV, j);

        if (m > 0.0 && k > 0.0)
            most = fmax(most, m / k);
    }
    *omega = most > 0.0 ? 1.0 / sqrt(most) : 1.0;
    return RITZ_OK;
}

/*
 * Begin a chain with the static response to its loads: d = P' S P G, v = 0.
 *
 * @param[in] D  NULL where there is none
 */
static ritz_status start_chain(recurrence *r, const ritz_sparse *D, int loads)
{
    const ritz_dense at_rest = {0};
    state_chain *chain = &r->chain[r->num_chains++];
    RITZ_OWN(ritz_forces) forces = {0};

    RITZ_CHECK(collect_loads(r, D, loads, &forces));
    chain->D = D;
    chain->room = r->S.vectors;
    RITZ_CHECK(ritz_orthonormal_new(2 * chain->room, NULL, r->S.set.tolerance,
                                    &chain->kept));
    return append_state(&r->S, &forces, &at_rest, chain);
}

/* Begin a complex sequence about point k, which is not at 0 Hz unless there is
   K4. */
static ritz_status start_waves(recurrence *r, int64_t k, const ritz_sparse *D,
                               int loads)
{
    ritz_waves *waves = &r->wave[r->num_waves++];
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    waves->point = &r->point[k];
    waves->D = D;
    waves->transposed = D && D == &r->D[1];
    if (ritz_loads_count(r->request, loads) > 0)
        RITZ_CHECK(ritz_loads_collect(r->request, loads, &F, &dof));
    else
        RITZ_CHECK(ritz_dense_new(r->K.nrow, 0, &F));
    return ritz_waves_start(&r->S, &F, waves);
}

static ritz_status start_at(recurrence *r, int64_t k, const ritz_sparse *D,
                            int loads)
{
    return r->S.point[k].hertz == 0.0 && !r->K4 ? start_chain(r, D, loads)
                                                : start_waves(r, k, D, loads);
}

/*
 * At each point begin a sequence from the inputs with D and one from the
 * outputs with D'; if D is symmetric, one sequence from both.
 */
static ritz_status start_chains(recurrence *r, int loads)
{
    const ritz_sparse *D = r->D[0].colptr ? &r->D[0] : NULL;
    const bool one = !D || ritz_sparse_asymmetry(D) <= RITZ_SYMMETRIC;

    if (!one)
        RITZ_CHECK(ritz_sparse_transpose(D, &r->D[1]));
    for (int64_t k = 0; k < r->S.num_points; k++) {
        double hertz = r->S.point[k].hertz;

        if (hertz > 0.0 || r->K4)
            RITZ_CHECK(
                ritz_wave_point_new(&r->body, D, r->K4, hertz, &r->point[k]));
        RITZ_CHECK(
            start_at(r, k, D, one ? loads : loads & ~RITZ_LOADS_OUTPUTS));
        if (!one)
            RITZ_CHECK(start_at(r, k, &r->D[1], loads & ~RITZ_LOADS_INPUTS));
    }
    return RITZ_OK;
}

/* Advance each sequence by a block; *moving is whether any gave a new
   vector. */
static ritz_status advance_all(recurrence *r, double omega, bool *moving)
{
    const int64_t full = r->S.vectors;

    *moving = false;
    for (int64_t k = 0; k < r->num_chains && r->S.set.count < full; k++)
        if (!r->chain[k].ended) {
            RITZ_CHECK(advance_chain(&r->S, omega, &r->chain[k]));
            *moving = *moving || !r->chain[k].ended;
        }
    for (int64_t k = 0; k < r->num_waves && r->S.set.count < full; k++)
        if (!r->wave[k].ended) {
            RITZ_CHECK(ritz_waves_advance(&r->S, omega, &r->wave[k]));
            *moving = *moving || !r->wave[k].ended;
        }
    return RITZ_OK;
}

/* Number of whole blocks of each point, by the sequence from its inputs. */
static void count_blocks(recurrence *r)
{
    for (int64_t k = 0; k < r->S.num_points; k++) {
        int64_t whole = r->chain[0].whole;

        for (int64_t j = r->num_waves - 1; j >= 0; j--)
            if (r->wave[j].point == &r->point[k])
                whole = r->wave[j].whole;
        r->S.point[k].whole = whole;
    }
}

static ritz_status run_chains(recurrence *r, int loads)
{
    double omega = 1.0;
    bool moving = true;

    RITZ_CHECK(start_chains(r, loads));
    RITZ_CHECK(choose_unit(r, &omega));
    while (moving && r->S.set.count < r->S.vectors)
        RITZ_CHECK(advance_all(r, omega, &moving));
    count_blocks(r);
    return RITZ_OK;
}

/* Note the engine, and remark if there is no damping. */
static void sign_basis(const recurrence *r, ritz_basis *basis)
{
    if (r->num_waves > 0)
        (void)snprintf(basis->origin.engine, sizeof basis->origin.engine,
                       "CHOLMOD + MUMPS");
    if (!r->D[0].colptr && !r->K4)
        ritz_remark_add(basis, "; ",
                        "there is no damping, krylov does the same");
}

static ritz_status make_krylov_damped(const ritz_request *request,
                                      ritz_basis *out)
{
    int loads = ritz_krylov_loads(request, false);
    RITZ_OWN(recurrence) r = {.request = request};
    ritz_request at_rest = *request;
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_loads_collect(request, loads, &F, &dof)); /* refuses none */
    RITZ_CHECK(collect_matrices(&r));
    RITZ_CHECK(ritz_elastic_new(&r.K, &request->component->M, NULL, &r.body));
    at_rest.choice.num_shifts = 0; /* no factors of K - sigma M */
    RITZ_CHECK(ritz_krylov_new(&r.body, &at_rest, &r.S));
    ritz_krylov_points(&request->choice, &r.S);
    RITZ_CHECK(run_chains(&r, loads));
    RITZ_CHECK(ritz_krylov_join(&r.S, &basis));
    RITZ_CHECK(ritz_krylov_sign(&r.S, request->modes, &basis));
    sign_basis(&r, &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const ritz_method ritz_method_krylov_damped = {
    .name = "krylov-damped",
    .summary = "rigid modes and block Krylov vectors of the damped structure",
    .reference = "CraigSuKim1992",
    .when = "damping that is not small, or that couples modes",
    .cost = "a factor a point, a solve a state: up to two a vector",
    .holds = "moments of the damped model at each point; symmetry",
    .fails = "ratios of modes, which are no matrix D: refused",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS |
            RITZ_USES_INNER | RITZ_USES_DAMPING | RITZ_USES_SHIFTS,
    .make = make_krylov_damped,
};
