/* Gramians of a component by the requested engine, or by one that fits. */
#include "base/alloc.h"
#include "gramians/modes.h"
#include "linear/general.h"
#include "linear/split.h"

#include <inttypes.h>
#include <stdio.h>

/*
 * Gramians of modes as those of x = [u; u'] of the component,
 *
 *     Z_c := [Phi 0; 0 Phi] Z_c,    Z_o := [M Phi 0; 0 Phi] Z_o
 *
 * and T and W likewise, behind the decoupled rigid modes.
 *
 * @param[in,out] gramians  in states; without E
 */
static ritz_status lift_gramians(const ritz_mode_states *states,
                                 ritz_gramians *gramians)
{
    const ritz_dense *Zc = &gramians->Zc, *Zo = &gramians->Zo;
    RITZ_OWN(ritz_gramians) x = *gramians;

    x.Zc = x.Zo = x.T = x.W = (ritz_dense){0};
    RITZ_CHECK(ritz_states_lift(states, RITZ_LIFT_RIGHT, false, Zc, &x.Zc));
    RITZ_CHECK(ritz_states_lift(states, RITZ_LIFT_MOMENTA, false, Zc, &x.EZc));
    RITZ_CHECK(ritz_states_lift(states, RITZ_LIFT_LEFT, false, Zo, &x.Zo));
    RITZ_CHECK(
        ritz_states_lift(states, RITZ_LIFT_RIGHT, true, &gramians->T, &x.T));
    RITZ_CHECK(
        ritz_states_lift(states, RITZ_LIFT_LEFT, true, &gramians->W, &x.W));
    ritz_gramians_free(gramians);
    RITZ_MOVE(*gramians, x);
    return RITZ_OK;
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
                   "give it damping");
    layout.modes = &states.modes;
    layout.num_decoupled = states.num_decoupled;
    layout.scale = states.scale;
    RITZ_CHECK(lift_gramians(&layout, &gramians));
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
                   "say up to which frequency, or ask engine 'low-rank'",
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
    RITZ_CHECK(lift_gramians(&layout, &gramians));
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

/* Closed form where damping allows, what takes any damping elsewhere. */
static ritz_status find_any(const ritz_gramians_request *request,
                            ritz_gramians *out)
{
    bool large = request->component->num_dofs > RITZ_STATE_DOFS;
    bool coupled = false;

    if (request->band_hz[1] > 0.0)
        return find_modal(request, out);
    if (large && !(request->among_hz > 0.0))
        return ritz_gramians_low_rank(request, out);
    RITZ_CHECK(find_closed_form(request, &coupled, out));
    if (coupled)
        RITZ_CHECK(large ? ritz_gramians_low_rank(request, out)
                         : find_dense(request, out));
    return RITZ_OK;
}

static const engine_row engines[] = {
    [RITZ_ENGINE_AUTO] = {"auto", find_any, true, true},
    [RITZ_ENGINE_DENSE] = {"dense", find_dense, false, false},
    [RITZ_ENGINE_MODAL] = {"modal", find_modal, true, true},
    [RITZ_ENGINE_LOW_RANK] = {"low-rank", ritz_gramians_low_rank, false, false},
};

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
    RITZ_REFUSE_IF(model->A.nrow == 0, RITZ_ERR_ARGUMENT,
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

ritz_status ritz_gramians_of_space(const ritz_state_space *model,
                                   ritz_gramians *out)
{
    RITZ_OWN(ritz_split) split = {0};
    RITZ_OWN(ritz_gramians) gramians = {0};

    RITZ_CHECK(check_space(model));
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
