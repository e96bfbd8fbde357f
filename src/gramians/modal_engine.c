/*
 * A component's Gramians in closed form (modal_factors.c, modal_band.c): of all
 * its modes by dense matrices, or of those up to a frequency by sparse ones.
 */
#include "base/alloc.h"
#include "gramians/engines.h"
#include "gramians/modal_modes.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static ritz_status all_modes(const ritz_gramians_request *request,
                             ritz_first_order *out)
{
    ritz_status status = RITZ_OK;
    const ritz_component *component = request->component;
    ritz_structure structure = {0};

    RITZ_FAIL_IF(component->num_dofs > RITZ_STATE_DOFS, RITZ_ERR_ARGUMENT,
                 "%" PRId64 " dofs have too many modes to take all of them: "
                 "say up to which frequency, or ask engine 'low-rank'",
                 component->num_dofs);
    RITZ_TRY(ritz_structure_of_component(component, &structure));
    RITZ_TRY(ritz_first_order_new(&structure, &component->io, &request->damping,
                                  out));
done:
    ritz_structure_free(&structure);
    return status;
}

/* Matrices with dampers installed. */
typedef struct sparse_structure {
    ritz_sparse K, D;
    ritz_dampers dampers;
} sparse_structure;

static void release(sparse_structure *s)
{
    ritz_sparse_free(&s->K);
    ritz_sparse_free(&s->D);
    ritz_dampers_free(&s->dampers);
}

static ritz_status install(const ritz_component *component,
                           sparse_structure *out)
{
    RITZ_CHECK(ritz_sparse_copy(&component->K, &out->K));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_copy(&component->D, &out->D));
    RITZ_CHECK(ritz_dampers_copy(&component->dampers, &out->dampers));
    return ritz_dampers_install_sparse(&out->dampers, &out->K, &out->D);
}

static ritz_status modes_up_to(const ritz_gramians_request *request,
                               ritz_first_order *out)
{
    ritz_status status = RITZ_OK;
    const ritz_component *component = request->component;
    const ritz_span span = {.modes = -1, .up_to_hz = request->among_hz};
    sparse_structure s = {0};
    ritz_pairs pairs = {0};
    ritz_first_order modes = {.num_dofs = component->num_dofs};

    RITZ_FAIL_IF(component->K4.colptr, RITZ_ERR_ARGUMENT,
                 "structural damping is of harmonic motion and has no states, "
                 "give it as a modal ratio");
    RITZ_TRY(install(component, &s));
    RITZ_TRY(ritz_eigen_sparse(&s.K, &component->M, &span, &pairs));
    modes.count = pairs.Phi.ncol;
    modes.num_rigid = pairs.num_rigid;
    modes.Phi = pairs.Phi;
    modes.lambda = pairs.lambda;
    pairs.Phi = (ritz_dense){0};
    pairs.lambda = NULL;
    for (int64_t k = 0; k < modes.num_rigid; k++)
        modes.lambda[k] = 0.0;
    RITZ_TRY(ritz_sparse_mul(&component->M, &modes.Phi, &modes.MPhi));
    if (s.D.colptr)
        RITZ_TRY(ritz_sparse_project(&s.D, &modes.Phi, &modes.Delta));
    RITZ_TRY(ritz_first_order_drive(&component->io, &request->damping, &modes));
    *out = modes;
    modes = (ritz_first_order){0};
done:
    release(&s);
    ritz_pairs_free(&pairs);
    ritz_first_order_free(&modes);
    return status;
}

ritz_status ritz_gramians_modes(const ritz_gramians_request *request,
                                ritz_first_order *out)
{
    RITZ_CHECK(request->among_hz > 0.0 ? modes_up_to(request, out)
                                       : all_modes(request, out));
    RITZ_REFUSE_IF(out->count == out->num_rigid, RITZ_ERR_ARGUMENT,
                   "the component has no flexible modes%s: its rigid modes are "
                   "all there is",
                   request->among_hz > 0.0 ? " up to that frequency" : "");
    return ritz_modes_turn(out);
}

/* Of modes that damping does not couple. */
static ritz_status closed_form(const ritz_gramians_request *request,
                               const ritz_first_order *modes,
                               ritz_gramians *out)
{
    ritz_status status = RITZ_OK;
    const ritz_mode_states layout = {
        .modes = modes, .apart = modes->num_rigid, .step = 2};
    ritz_modal modal = {0};
    ritz_gramians gramians = {.engine = "closed form"};

    RITZ_TRY(ritz_modal_of_modes(modes, &request->component->io, &modal));
    RITZ_TRY(request->band_hz[1] > 0.0
                 ? ritz_modal_factors_band(&modal, request->band_hz,
                                           &gramians.Zc, &gramians.Zo)
                 : ritz_modal_factors(&modal, &gramians.Zc, &gramians.Zo));
    RITZ_TRY(ritz_gramians_lift(&layout, &gramians));
    ritz_damping_print(&request->damping, gramians.damping);
    *out = gramians;
    gramians = (ritz_gramians){0};
done:
    ritz_modal_free(&modal);
    ritz_gramians_free(&gramians);
    return status;
}

ritz_status ritz_gramians_modal(const ritz_gramians_request *request,
                                ritz_gramians *out)
{
    ritz_status status = RITZ_OK;
    ritz_first_order modes = {0};
    ritz_coupling coupling = {0};

    RITZ_TRY(ritz_gramians_modes(request, &modes));
    if (ritz_modes_coupled(&modes, &coupling))
        RITZ_TRY(ritz_coupling_refuse(
            &coupling, request->band_hz[1] > 0.0
                           ? "over a band it must be mode by mode"
                           : "engine 'dense' takes any"));
    RITZ_TRY(closed_form(request, &modes, out));
done:
    ritz_first_order_free(&modes);
    return status;
}

ritz_status ritz_gramians_modal_if(const ritz_gramians_request *request,
                                   bool *fits, ritz_gramians *out)
{
    ritz_status status = RITZ_OK;
    ritz_first_order modes = {0};
    ritz_coupling coupling = {0};

    RITZ_TRY(ritz_gramians_modes(request, &modes));
    *fits = !ritz_modes_coupled(&modes, &coupling);
    if (*fits)
        RITZ_TRY(closed_form(request, &modes, out));
done:
    ritz_first_order_free(&modes);
    return status;
}
