/* Gramians of a component by the requested engine, or by one that fits. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"
#include "gramians/projection.h"
#include "gramians/space.h"
#include "linear/general.h"
#include "linear/split.h"

#include <ritz/basis.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ritz_status choose_scale(ritz_states *states)
{
    const ritz_modal_model *modes = &states->modes;
    int64_t half = modes->count - states->num_decoupled;
    double least = 0.0;

    RITZ_CHECK_NEW(states->scale, half);
    for (int64_t k = 0; k < half; k++) {
        double w = sqrt(fabs(modes->lambda[states->num_decoupled + k]));

        states->scale[k] = w;
        if (w > 0.0 && (least == 0.0 || w < least))
            least = w;
    }
    for (int64_t k = 0; k < half; k++)
        if (states->scale[k] == 0.0)
            states->scale[k] = least > 0.0 ? least : 1.0;
    return RITZ_OK;
}

/* A - alpha I, B and C. */
static ritz_status fill_states(ritz_states *states)
{
    int64_t r = states->num_decoupled;
    const ritz_modal_layout layout = {r, r, states->scale};

    RITZ_CHECK(ritz_modal_states(&states->modes, &layout, &states->A,
                                 &states->B, &states->C));
    states->count = states->A.nrow;
    for (int64_t k = 0; k < states->count; k++)
        ritz_dense_col(&states->A, k)[k] -= states->alpha;
    return RITZ_OK;
}

ritz_status ritz_states_new(const ritz_component *component,
                            const ritz_damping *damping, double alpha,
                            ritz_states *out)
{
    RITZ_OWN(ritz_states) states = {.alpha = alpha};
    RITZ_OWN(ritz_structure) structure = {0};

    RITZ_CHECK(ritz_structure_of_component(component, &structure));
    RITZ_CHECK(ritz_modal_model_new(&structure, &component->io, damping,
                                    &states.modes));
    ritz_damping_print(damping, states.damping);
    states.num_decoupled = ritz_modal_decoupled(&states.modes);
    RITZ_CHECK(choose_scale(&states));
    RITZ_CHECK(fill_states(&states));
    RITZ_REFUSE_IF(states.count == 0, RITZ_ERR_ARGUMENT,
                   "the component has no flexible states: its rigid modes are "
                   "all there is");
    RITZ_MOVE(*out, states);
    return RITZ_OK;
}

ritz_status ritz_states_basis(const ritz_states *states, const ritz_dense *T,
                              const ritz_dense *W, ritz_basis *out)
{
    const ritz_mode_states layout = {&states->modes, states->num_decoupled, 1,
                                     states->scale};
    int64_t r = 2 * states->num_decoupled;
    RITZ_OWN(ritz_basis) basis = {.states = true};

    RITZ_CHECK(ritz_states_lift(&layout, RITZ_LIFT_RIGHT, true, T, &basis.T));
    RITZ_CHECK(ritz_states_lift(&layout, RITZ_LIFT_LEFT, true, W, &basis.W));
    RITZ_CHECK(ritz_columns_new(basis.T.ncol, &basis.columns));
    for (int64_t j = 0; j < basis.T.ncol; j++)
        basis.columns.kind[j] = j < r ? RITZ_COLUMN_RIGID : RITZ_COLUMN_STATE;
    for (int64_t j = 0; j < r; j++)
        basis.columns.hertz[j] = 0.0;
    memcpy(basis.damping, states->damping, sizeof basis.damping);
    snprintf(basis.origin.engine, sizeof basis.origin.engine, "dense LAPACK");
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

void ritz_states_free(ritz_states *states)
{
    ritz_modal_model_free(&states->modes);
    free(states->scale);
    ritz_dense_free(&states->A);
    ritz_dense_free(&states->B);
    ritz_dense_free(&states->C);
    *states = (ritz_states){0};
}

/*
 * By SLICOT, in states z = [S q; q'] of the modes. Rigid modes that damping
 * does not couple to others are decoupled first; whatever else does not decay
 * is split off by its poles.
 */
static ritz_status find_dense(const ritz_gramians_request *request,
                              ritz_gramians *out)
{
    RITZ_OWN(ritz_states) states = {0};
    RITZ_OWN(ritz_state_space) space = {0};
    RITZ_OWN(ritz_gramians) gramians = {0};
    ritz_mode_states layout = {.step = 1};

    RITZ_CHECK(
        ritz_states_new(request->component, &request->damping, 0.0, &states));
    RITZ_CHECK(
        ritz_state_space_new(states.count, &request->component->io, &space));
    ritz_dense_free(&space.A);
    ritz_dense_free(&space.B);
    ritz_dense_free(&space.C);
    RITZ_MOVE(space.A, states.A);
    RITZ_MOVE(space.B, states.B);
    RITZ_MOVE(space.C, states.C);
    RITZ_CHECK(ritz_gramians_of_space(&space, &gramians));
    RITZ_REFUSE_IF(gramians.T.ncol == states.count, RITZ_ERR_ARGUMENT,
                   "no motion of the component decays, and none has a Gramian: "
                   "give it damping, as by --damping");
    layout.modes = &states.modes;
    layout.num_decoupled = states.num_decoupled;
    layout.scale = states.scale;
    RITZ_CHECK(ritz_gramians_lift(&layout, &gramians));
    snprintf(gramians.damping, sizeof gramians.damping, "%s", states.damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}

/*
 * A component's Gramians in closed form (modal_gramians.c, modal_band.c): of
 * all its modes by dense matrices, or of those up to a frequency by sparse
 * ones.
 */

static ritz_status find_all_modes(const ritz_gramians_request *request,
                                  ritz_modal_model *out)
{
    const ritz_component *component = request->component;
    RITZ_OWN(ritz_structure) structure = {0};

    RITZ_REFUSE_IF(component->num_dofs > RITZ_STATE_DOFS, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " dofs have too many modes to take all of them: "
                   "say up to which frequency by --among-hz, or take "
                   "--engine low-rank",
                   component->num_dofs);
    RITZ_CHECK(ritz_structure_of_component(component, &structure));
    return ritz_modal_model_new(&structure, &component->io, &request->damping,
                                out);
}

static ritz_status find_modes_up_to(const ritz_gramians_request *request,
                                    ritz_modal_model *out)
{
    const ritz_component *component = request->component;
    const ritz_span span = {.modes = -1, .up_to_hz = request->among_hz};
    RITZ_OWN(ritz_sparse) K = {0}, D = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_modal_model) modes = {0};

    RITZ_CHECK(ritz_structure_refuse(component->K4.colptr != NULL));
    RITZ_CHECK(ritz_structure_sparse(component, NULL, &K, &D));
    RITZ_CHECK(ritz_eigen_sparse(&K, &component->M, &span, &pairs));
    ritz_modal_model_take(&pairs, component->num_dofs, &modes);
    RITZ_CHECK(ritz_sparse_mul(&component->M, &modes.Phi, &modes.MPhi));
    if (D.colptr)
        RITZ_CHECK(ritz_sparse_project(&D, &modes.Phi, &modes.Delta));
    RITZ_CHECK(
        ritz_modal_model_drive(&component->io, &request->damping, &modes));
    RITZ_MOVE(*out, modes);
    return RITZ_OK;
}

ritz_status ritz_gramians_modes(const ritz_gramians_request *request,
                                ritz_modal_model *out)
{
    RITZ_CHECK(request->among_hz > 0.0 ? find_modes_up_to(request, out)
                                       : find_all_modes(request, out));
    RITZ_REFUSE_IF(out->count == out->num_rigid, RITZ_ERR_ARGUMENT,
                   "the component has no flexible modes%s: its rigid modes are "
                   "all there is",
                   request->among_hz > 0.0 ? " up to that frequency" : "");
    return ritz_modes_turn(out);
}

/* Closed form. With @p coupled, it says whether damping couples modes, of which
   nothing is found then; without, such damping is refused. */
static ritz_status find_closed_form(const ritz_gramians_request *request,
                                    bool *coupled, ritz_gramians *out)
{
    const double *band = request->band_hz[1] > 0.0 ? request->band_hz : NULL;
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_gramians) gramians = {.engine = "closed form"};
    ritz_mode_states layout = {.modes = &modes, .step = 2};

    RITZ_CHECK(ritz_gramians_modes(request, &modes));
    if (coupled && (*coupled = ritz_modes_coupled(&modes)))
        return RITZ_OK;
    RITZ_CHECK(ritz_modal_of_modes(&modes, &request->component->io,
                                   band ? "over a band it must be mode by mode"
                                        : "engine 'dense' takes any",
                                   &modal));
    RITZ_CHECK(ritz_modal_factors(&modal, band, &gramians.Zc, &gramians.Zo));
    layout.num_decoupled = modes.num_rigid;
    RITZ_CHECK(ritz_gramians_lift(&layout, &gramians));
    ritz_damping_print(&request->damping, gramians.damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}

static ritz_status find_modal(const ritz_gramians_request *request,
                              ritz_gramians *out)
{
    return find_closed_form(request, NULL, out);
}

/* Name of an engine, and the options it takes. */
typedef struct engine_row {
    const char *name;
    ritz_status (*find)(const ritz_gramians_request *request,
                        ritz_gramians *out);
    bool band, among;
} engine_row;

/* Gramians of a large component, by projection if D has the form it needs. */
static ritz_status find_large(const ritz_gramians_request *request,
                              ritz_gramians *out)
{
    bool fits = false;

    RITZ_CHECK(ritz_projection_fits(request, &fits));
    return fits ? ritz_gramians_projection(request, out)
                : ritz_gramians_low_rank(request, out);
}

/* Closed form where damping allows, what takes any damping elsewhere. */
static ritz_status find_any(const ritz_gramians_request *request,
                            ritz_gramians *out)
{
    bool large = request->component->num_dofs > RITZ_STATE_DOFS;
    bool coupled = false;

    if (request->band_hz[1] > 0.0)
        return find_modal(request, out);
    if (large && !(request->among_hz > 0.0))
        return find_large(request, out);
    RITZ_CHECK(find_closed_form(request, &coupled, out));
    if (coupled)
        RITZ_CHECK(large ? find_large(request, out) : find_dense(request, out));
    return RITZ_OK;
}

static const engine_row engines[] = {
    [RITZ_ENGINE_AUTO] = {"auto", find_any, true, true},
    [RITZ_ENGINE_DENSE] = {"dense", find_dense, false, false},
    [RITZ_ENGINE_MODAL] = {"modal", find_modal, true, true},
    [RITZ_ENGINE_LOW_RANK] = {"low-rank", ritz_gramians_low_rank, false, false},
    [RITZ_ENGINE_PROJECTION] = {"projection", ritz_gramians_projection, false,
                                false},
};

/* The enum has engines that compute modes, too; these compute no Gramians. */
static ritz_status refuse_modes(ritz_engine engine)
{
    RITZ_REFUSE_IF(engine > RITZ_ENGINE_PROJECTION, RITZ_ERR_ARGUMENT,
                   "Gramians are found by the engines auto, dense, modal, "
                   "low-rank and projection");
    return RITZ_OK;
}

static ritz_status check_request(const ritz_gramians_request *request,
                                 const engine_row *engine)
{
    const ritz_io *io = &request->component->io;
    const double *band = request->band_hz;

    RITZ_CHECK(ritz_ends_check("component", io->num_inputs, io->num_outputs,
                               io->limit, io->output));
    RITZ_REFUSE_IF(!(band[0] == 0.0 && band[1] == 0.0) && !engine->band,
                   RITZ_ERR_ARGUMENT,
                   "a band is of engine 'modal', not of '%s'", engine->name);
    RITZ_REFUSE_IF(band[1] <= 0.0 && band[0] != 0.0, RITZ_ERR_ARGUMENT,
                   "a band is from 0 Hz or more to more, not from %g to %g",
                   band[0], band[1]);
    RITZ_REFUSE_IF(!(request->among_hz >= 0.0), RITZ_ERR_ARGUMENT,
                   "modes cannot be taken up to %g Hz", request->among_hz);
    RITZ_REFUSE_IF(request->among_hz > 0.0 && !engine->among, RITZ_ERR_ARGUMENT,
                   "modes up to a frequency are of engine 'modal', not of '%s'",
                   engine->name);
    return RITZ_OK;
}

ritz_status ritz_gramians_of_component(const ritz_gramians_request *request,
                                       ritz_gramians *out)
{
    const engine_row *engine = &engines[request->engine];

    RITZ_CHECK(refuse_modes(request->engine));
    RITZ_CHECK(check_request(request, engine));
    return engine->find(request, out);
}

/*
 * Gramians of a state space. What belongs to stable poles,
 *
 *     Y'E X z' = Y'A X z + Y'B u,   y = C X z,   Y'A X quasi-triangular,
 *
 * has Hammarling's factors: Z_c = X F_c, Z_o = Y F_o. The rest is split off, as
 * T and W. [Hammarling1982], [Penzl1998]
 */
static ritz_status check_space(const ritz_state_space *model)
{
    RITZ_CHECK(ritz_state_space_check(model));
    RITZ_REFUSE_IF(ritz_state_space_order(model) == 0, RITZ_ERR_ARGUMENT,
                   "the model has no states, and no Gramians");
    return ritz_ends_check("model", model->num_inputs, model->num_outputs,
                           model->limit, model->output);
}

/* Z_c and Z_o of the stable part. */
static ritz_status factor_stable(const ritz_state_space *model,
                                 const ritz_split *split, ritz_gramians *out)
{
    RITZ_OWN(ritz_dense) B = {0}, Ct = {0}, C = {0}, F = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&split->Y, &model->B, &B));
    RITZ_CHECK(ritz_outputs_scaled(&model->C, model->limit, &Ct));
    RITZ_CHECK(ritz_dense_mul_tn(&split->X, &Ct, &C));
    RITZ_CHECK(ritz_general_hammarling(&split->S, &split->P, false, &B, &F));
    RITZ_CHECK(ritz_dense_mul(&split->X, &F, &out->Zc));
    ritz_dense_free(&F);
    RITZ_CHECK(ritz_general_hammarling(&split->S, &split->P, true, &C, &F));
    RITZ_CHECK(ritz_dense_mul(&split->Y, &F, &out->Zo));
    if (model->E.val)
        RITZ_CHECK(ritz_dense_mul(&model->E, &out->Zc, &out->EZc));
    return RITZ_OK;
}

static ritz_status find_space_dense(const ritz_state_space *model,
                                    ritz_gramians *out)
{
    RITZ_OWN(ritz_state_space) made = {0};
    RITZ_OWN(ritz_split) split = {0};
    RITZ_OWN(ritz_gramians) gramians = {0};

    RITZ_CHECK(ritz_state_space_dense(model, &made, &model));
    RITZ_CHECK(ritz_split_new(&model->A, &model->E, &split));
    RITZ_CHECK(factor_stable(model, &split, &gramians));
    RITZ_MOVE(gramians.T, split.T);
    RITZ_MOVE(gramians.W, split.W);
    snprintf(gramians.engine, sizeof gramians.engine, "SLICOT %s",
             split.P.val ? "SG03BD" : "SB03OD");
    snprintf(gramians.damping, sizeof gramians.damping, "%s", model->damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}

/* Low-rank engine for sparse models, dense for others, and for small sparse
   ones where ADI does not converge. */
static ritz_status find_space_any(const ritz_state_space *model,
                                  ritz_gramians *out)
{
    ritz_status status = RITZ_OK;

    if (!ritz_state_space_is_sparse(model))
        return find_space_dense(model, out);
    status = ritz_gramians_space_low_rank(model, 0.0, out);
    if (status == RITZ_ERR_CONVERGENCE &&
        ritz_state_space_order(model) <= 2 * (int64_t)RITZ_STATE_DOFS)
        return find_space_dense(model, out);
    return status;
}

ritz_status ritz_gramians_of_space_by(const ritz_state_space *model,
                                      ritz_engine engine, const double *band_hz,
                                      ritz_gramians *out)
{
    RITZ_CHECK(check_space(model));
    RITZ_CHECK(refuse_modes(engine));
    RITZ_REFUSE_IF(engine == RITZ_ENGINE_MODAL, RITZ_ERR_ARGUMENT,
                   "a state space has no modes: its engines are dense, "
                   "low-rank and projection");
    RITZ_REFUSE_IF(band_hz && engine != RITZ_ENGINE_AUTO, RITZ_ERR_ARGUMENT,
                   "Gramians of a state space over a band have one engine: "
                   "leave out --engine");
    if (band_hz)
        return ritz_gramians_space_band(model, band_hz, out);
    if (engine == RITZ_ENGINE_LOW_RANK)
        return ritz_gramians_space_low_rank(model, 0.0, out);
    if (engine == RITZ_ENGINE_PROJECTION)
        return ritz_gramians_space_projection(model, 0.0, out);
    return engine == RITZ_ENGINE_DENSE ? find_space_dense(model, out)
                                       : find_space_any(model, out);
}

ritz_status ritz_gramians_of_space(const ritz_state_space *model,
                                   ritz_gramians *out)
{
    return ritz_gramians_of_space_by(model, RITZ_ENGINE_AUTO, NULL, out);
}

/*
 * Balancing by square roots: both Gramians of the states W'E x are S, so that
 * what is controllable by little input and what is observable by little output
 * stand in the same order. A value no larger than the rounding of the product
 * has no direction of its own: T and W leave it out whatever was asked for.
 */

static const ritz_dense *descriptor_times(const ritz_gramians *gramians)
{
    return gramians->EZc.val ? &gramians->EZc : &gramians->Zc;
}

/* Singular values and vectors of Z_o' E Z_c. */
static ritz_status find_product(const ritz_gramians *gramians, bool vectors,
                                ritz_product_svd *out)
{
    if (gramians->core[1].val)
        return ritz_product_svd_new(&gramians->core[1], &gramians->core[0],
                                    vectors, out);
    return ritz_product_svd_new(&gramians->Zo, descriptor_times(gramians),
                                vectors, out);
}

ritz_status ritz_gramians_hankel(const ritz_gramians *gramians, int64_t *count,
                                 double **sigma)
{
    RITZ_OWN(ritz_product_svd) svd = {0};

    RITZ_CHECK_IN("Hankel values", find_product(gramians, false, &svd));
    *count = svd.count;
    RITZ_MOVE(*sigma, svd.s);
    return RITZ_OK;
}

double ritz_hankel_bound(int64_t count, const double *sigma, int64_t kept)
{
    double sum = 0.0;
    double last = 0.0;

    for (int64_t k = 0; k < count; k++) {
        if (k > 0 && last - sigma[k] <= RITZ_HANKEL_REPEATED * last)
            continue;
        last = sigma[k];
        if (k >= kept)
            sum += last;
    }
    return 2.0 * sum;
}

/* Values that rounding of the product leaves. */
static int64_t count_true(const ritz_gramians *gramians,
                          const ritz_product_svd *svd)
{
    int64_t k = gramians->Zc.ncol;
    int64_t l = gramians->Zo.ncol;
    double size = (double)(k > l ? k : l);
    int64_t count = 0;

    while (count < svd->rank && svd->s[count] > 0.0 &&
           svd->s[count] > size * DBL_EPSILON * svd->s[0])
        count++;
    return count;
}

/* The number of leading rows and columns of G that are close to I. */
static int64_t count_close(const ritz_dense *G)
{
    double sum = 0.0;

    for (int64_t j = 0; j < G->ncol; j++) {
        for (int64_t i = 0; i <= j; i++) {
            double upper = ritz_dense_col(G, j)[i] - (i == j ? 1.0 : 0.0);
            double lower = ritz_dense_col(G, i)[j];

            sum += upper * upper + (i < j ? lower * lower : 0.0);
        }
        if (!(sqrt(sum) <= RITZ_BALANCED_DEFECT))
            return j;
    }
    return G->ncol;
}

/* How many values are kept. */
static int64_t cut_values(int64_t count, const double *sigma, int64_t order,
                          double tolerance)
{
    int64_t kept = 0;

    while (kept < count && (order < 0 || kept < order) &&
           sigma[kept] >= tolerance * sigma[0])
        kept++;
    while (kept > 0 && kept < count &&
           sigma[kept - 1] - sigma[kept] <= RITZ_CLUSTER_GAP * sigma[kept - 1])
        kept--;
    return kept;
}

/* Z times columns of a side of the product, over the roots of s. */
static ritz_status project_side(const ritz_dense *Z, const ritz_dense *vectors,
                                const double *sigma, int64_t count,
                                ritz_dense *out)
{
    RITZ_OWN(ritz_dense) V = {0};

    RITZ_CHECK(ritz_dense_columns(vectors, 0, count, &V));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < V.nrow; i++)
            ritz_dense_col(&V, j)[i] /= sqrt(sigma[j]);
    return ritz_dense_mul(Z, &V, out);
}

/* The leading columns of W times G^-1 of the leading rows and columns. */
static ritz_status correct_sides(const ritz_dense *W, const ritz_dense *G,
                                 int64_t count, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) leading = {0}, X = {0};
    ritz_dense part = ritz_dense_part(W, 0, count);

    RITZ_CHECK(ritz_dense_block(G, 0, count, 0, count, &leading));
    RITZ_CHECK(ritz_general_transpose(&part, &X));
    RITZ_CHECK_IN("balancing", ritz_general_solve(&leading, true, &X));
    return ritz_general_transpose(&X, out);
}

/*
 * T and W of as many values as there are, then cut. G = (E T)'W is I but for
 * rounding, some eps |Z_o| |E Z_c| / sigma, and W := W G^-1 takes that away.
 */
static ritz_status project_balanced(const ritz_gramians *gramians,
                                    const ritz_product_svd *svd, int64_t order,
                                    double tolerance, ritz_balanced *out)
{
    int64_t count = count_true(gramians, svd);
    RITZ_OWN(ritz_dense) T = {0}, ET = {0}, W = {0}, G = {0};

    RITZ_CHECK(project_side(&gramians->Zc, &svd->V, svd->s, count, &T));
    RITZ_CHECK(project_side(&gramians->Zo, &svd->U, svd->s, count, &W));
    RITZ_CHECK(
        project_side(descriptor_times(gramians), &svd->V, svd->s, count, &ET));
    RITZ_CHECK(ritz_dense_mul_tn(&ET, &W, &G));
    out->count = count_close(&G);
    out->kept = cut_values(out->count, svd->s, order, tolerance);
    out->bound = ritz_hankel_bound(out->count, svd->s, out->kept);
    if (out->count > 0)
        out->bound += gramians->error * svd->s[0];
    RITZ_CHECK(ritz_dense_columns(&T, 0, out->kept, &out->T));
    return correct_sides(&W, &G, out->kept, &out->W);
}

ritz_status ritz_gramians_balance(const ritz_gramians *gramians, int64_t order,
                                  double tolerance, ritz_balanced *out)
{
    RITZ_OWN(ritz_product_svd) svd = {0};
    RITZ_OWN(ritz_balanced) balanced = {0};

    RITZ_REFUSE_IF(!(tolerance >= 0.0 && tolerance < 1.0), RITZ_ERR_ARGUMENT,
                   "a tolerance of Hankel values is %g, it must be at least 0 "
                   "and below 1",
                   tolerance);
    RITZ_CHECK_IN("balancing", find_product(gramians, true, &svd));
    RITZ_CHECK(project_balanced(gramians, &svd, order, tolerance, &balanced));
    RITZ_MOVE(balanced.sigma, svd.s);
    RITZ_MOVE(*out, balanced);
    return RITZ_OK;
}

void ritz_balanced_free(ritz_balanced *balanced)
{
    free(balanced->sigma);
    ritz_dense_free(&balanced->T);
    ritz_dense_free(&balanced->W);
    *balanced = (ritz_balanced){0};
}
