/* Gramians of a component by the engine that is asked for, or that fits. */
#include "base/alloc.h"
#include "gramians/engines.h"
#include "gramians/low_rank.h"
#include "gramians/modal_modes.h"
#include "gramians/states.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rows first, first + step, ... of Z, over or times the scale. */
static ritz_status pick_rows(const ritz_dense *Z, int64_t first, int64_t step,
                             const double *scale, bool over, ritz_dense *out)
{
    int64_t m = Z->nrow / 2;

    RITZ_CHECK(ritz_dense_new(m, Z->ncol, out));
    for (int64_t j = 0; j < Z->ncol; j++) {
        const double *from = ritz_dense_col(Z, j) + first;
        double *to = ritz_dense_col(out, j);

        for (int64_t k = 0; k < m; k++) {
            double s = scale ? scale[k] : 1.0;

            to[k] = over ? from[k * step] / s : from[k * step] * s;
        }
    }
    return RITZ_OK;
}

/* [top Q; bottom V], Q and V the positions and the velocities in Z. */
static ritz_status stack_halves(const ritz_mode_states *states,
                                const ritz_dense *top, const ritz_dense *bottom,
                                bool over, const ritz_dense *Z, ritz_dense *out)
{
    int64_t n = states->modes->num_dofs;
    int64_t m = Z->nrow / 2;
    int64_t velocities = states->step == 1 ? m : 1;
    RITZ_OWN(ritz_dense) part = {0}, x = {0}, made = {0};

    RITZ_CHECK(ritz_dense_new(2 * n, Z->ncol, &made));
    for (int half = 0; half < 2 && Z->ncol > 0; half++) {
        RITZ_CHECK(pick_rows(Z, half * velocities, states->step,
                             half == 0 ? states->scale : NULL, over, &part));
        RITZ_CHECK(ritz_dense_mul(half == 0 ? top : bottom, &part, &x));
        for (int64_t j = 0; j < x.ncol; j++)
            memcpy(ritz_dense_col(&made, j) + half * n, ritz_dense_col(&x, j),
                   (size_t)n * sizeof *x.val);
        ritz_dense_free(&part);
        ritz_dense_free(&x);
    }
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* [top 0 own; 0 bottom own]: rigid modes, and then what is there. */
static ritz_status put_behind_rigid(const ritz_mode_states *states,
                                    const ritz_dense *top,
                                    const ritz_dense *bottom, ritz_dense *own)
{
    int64_t n = states->modes->num_dofs;
    int64_t r = states->apart;
    size_t column = (size_t)n * sizeof *own->val;
    RITZ_OWN(ritz_dense) all = {0};

    RITZ_CHECK(ritz_dense_new(2 * n, 2 * r + own->ncol, &all));
    for (int64_t j = 0; j < r; j++) {
        memcpy(ritz_dense_col(&all, j), ritz_dense_col(top, j), column);
        memcpy(ritz_dense_col(&all, r + j) + n, ritz_dense_col(bottom, j),
               column);
    }
    for (int64_t j = 0; j < own->ncol; j++)
        memcpy(ritz_dense_col(&all, 2 * r + j), ritz_dense_col(own, j),
               2 * column);
    ritz_dense_free(own);
    RITZ_MOVE(*own, all);
    return RITZ_OK;
}

/* * Gramians of modes as those of x = [u; u'] of the component:
 *
 *     Z_c := [Phi 0; 0 Phi] Z_c,    Z_o := [M Phi 0; 0 Phi] Z_o
 *
 * and T and W likewise, behind the rigid modes that stand apart.
 *
 * @param[in,out] gramians  in states; without E */
static ritz_status lift_gramians(const ritz_mode_states *states,
                                 ritz_gramians *gramians)
{
    const ritz_modal_model *modes = states->modes;
    int64_t m = modes->count - states->apart;
    const ritz_dense Phi = ritz_dense_part(&modes->Phi, states->apart, m);
    const ritz_dense MPhi = ritz_dense_part(&modes->MPhi, states->apart, m);
    const ritz_dense *Zc = &gramians->Zc, *Zo = &gramians->Zo;
    const ritz_dense *T = &gramians->T, *W = &gramians->W;
    RITZ_OWN(ritz_gramians) made = *gramians;

    made.Zc = made.Zo = made.T = made.W = (ritz_dense){0};
    RITZ_CHECK(stack_halves(states, &Phi, &Phi, true, Zc, &made.Zc));
    RITZ_CHECK(stack_halves(states, &Phi, &MPhi, true, Zc, &made.EZc));
    RITZ_CHECK(stack_halves(states, &MPhi, &Phi, false, Zo, &made.Zo));
    RITZ_CHECK(stack_halves(states, &Phi, &Phi, true, T, &made.T));
    RITZ_CHECK(stack_halves(states, &MPhi, &Phi, false, W, &made.W));
    RITZ_CHECK(put_behind_rigid(states, &modes->Phi, &modes->Phi, &made.T));
    RITZ_CHECK(put_behind_rigid(states, &modes->MPhi, &modes->Phi, &made.W));
    ritz_gramians_free(gramians);
    RITZ_MOVE(*gramians, made);
    return RITZ_OK;
}

/*
 * A component's Gramians by SLICOT, in states z = [S q; q'] of its modes
 * (states.h). Rigid modes that damping does not couple to others are split off
 * first; whatever else does not decay is split off by its poles.
 */

/* A, B and C of the states as a state space, which takes them. */
static ritz_status space_of(const ritz_io *io, ritz_states *states,
                            ritz_state_space *out)
{
    RITZ_OWN(ritz_state_space) space = {0};

    RITZ_CHECK(ritz_state_space_new(states->count, io, &space));
    ritz_dense_free(&space.A);
    ritz_dense_free(&space.B);
    ritz_dense_free(&space.C);
    space.A = states->A;
    space.B = states->B;
    space.C = states->C;
    states->A = states->B = states->C = (ritz_dense){0};
    RITZ_MOVE(*out, space);
    return RITZ_OK;
}

/* By SLICOT, in modal coordinates; what does not decay is split off. */
static ritz_status find_dense(const ritz_gramians_request *request,
                              ritz_gramians *out)
{
    RITZ_OWN(ritz_states) states = {0};
    RITZ_OWN(ritz_state_space) space = {0};
    RITZ_OWN(ritz_gramians) gramians = {0};
    ritz_mode_states layout = {.step = 1};

    RITZ_CHECK(
        ritz_states_new(request->component, &request->damping, 0.0, &states));
    RITZ_CHECK(space_of(&request->component->io, &states, &space));
    RITZ_CHECK(ritz_gramians_of_space(&space, &gramians));
    RITZ_REFUSE_IF(gramians.T.ncol == states.count, RITZ_ERR_ARGUMENT,
                   "no motion of the component decays, and none has a Gramian: "
                   "give it damping");
    layout.modes = &states.modes;
    layout.apart = states.num_apart;
    layout.scale = states.scale;
    RITZ_CHECK(lift_gramians(&layout, &gramians));
    snprintf(gramians.damping, sizeof gramians.damping, "%s", states.damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}

/*
 * A component's Gramians in closed form (modal_gramians.c, modal_band.c): of
 * all its modes by dense matrices, or of those up to a frequency by sparse ones.
 */

static ritz_status all_modes(const ritz_gramians_request *request,
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

/* Matrices with dampers installed. */
typedef struct sparse_structure {
    ritz_sparse K, D;
    ritz_dampers dampers;
} sparse_structure;

static void structure_free(sparse_structure *s)
{
    ritz_sparse_free(&s->K);
    ritz_sparse_free(&s->D);
    ritz_dampers_free(&s->dampers);
}

static ritz_status install_dampers(const ritz_component *component,
                                   sparse_structure *out)
{
    RITZ_CHECK(ritz_sparse_copy(&component->K, &out->K));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_copy(&component->D, &out->D));
    RITZ_CHECK(ritz_dampers_copy(&component->dampers, &out->dampers));
    return ritz_dampers_install_sparse(&out->dampers, &out->K, &out->D);
}

static ritz_status modes_up_to(const ritz_gramians_request *request,
                               ritz_modal_model *out)
{
    const ritz_component *component = request->component;
    const ritz_span span = {.modes = -1, .up_to_hz = request->among_hz};
    [[gnu::cleanup(structure_free)]] sparse_structure s = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_modal_model) modes = {0};

    RITZ_CHECK(ritz_structure_refuse(component->K4.colptr != NULL));
    RITZ_CHECK(install_dampers(component, &s));
    RITZ_CHECK(ritz_eigen_sparse(&s.K, &component->M, &span, &pairs));
    ritz_modal_model_take(&pairs, component->num_dofs, &modes);
    RITZ_CHECK(ritz_sparse_mul(&component->M, &modes.Phi, &modes.MPhi));
    if (s.D.colptr)
        RITZ_CHECK(ritz_sparse_project(&s.D, &modes.Phi, &modes.Delta));
    RITZ_CHECK(
        ritz_modal_model_drive(&component->io, &request->damping, &modes));
    RITZ_MOVE(*out, modes);
    return RITZ_OK;
}

ritz_status ritz_gramians_modes(const ritz_gramians_request *request,
                                ritz_modal_model *out)
{
    RITZ_CHECK(request->among_hz > 0.0 ? modes_up_to(request, out)
                                       : all_modes(request, out));
    RITZ_REFUSE_IF(out->count == out->num_rigid, RITZ_ERR_ARGUMENT,
                   "the component has no flexible modes%s: its rigid modes are "
                   "all there is",
                   request->among_hz > 0.0 ? " up to that frequency" : "");
    return ritz_modes_turn(out);
}

/* Gramians of modes that damping does not couple. */
static ritz_status closed_form(const ritz_gramians_request *request,
                               const ritz_modal_model *modes,
                               ritz_gramians *out)
{
    const ritz_mode_states layout = {
        .modes = modes, .apart = modes->num_rigid, .step = 2};
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_gramians) gramians = {.engine = "closed form"};

    RITZ_CHECK(ritz_modal_of_modes(modes, &request->component->io, &modal));
    RITZ_CHECK(request->band_hz[1] > 0.0
                   ? ritz_modal_factors_band(&modal, request->band_hz,
                                             &gramians.Zc, &gramians.Zo)
                   : ritz_modal_factors(&modal, &gramians.Zc, &gramians.Zo));
    RITZ_CHECK(lift_gramians(&layout, &gramians));
    ritz_damping_print(&request->damping, gramians.damping);
    RITZ_MOVE(*out, gramians);
    return RITZ_OK;
}

/* Closed form; @return RITZ_ERR_ARGUMENT also if damping couples modes */
static ritz_status find_modal(const ritz_gramians_request *request,
                              ritz_gramians *out)
{
    RITZ_OWN(ritz_modal_model) modes = {0};
    ritz_coupling coupling = {0};

    RITZ_CHECK(ritz_gramians_modes(request, &modes));
    if (ritz_modes_coupled(&modes, &coupling))
        RITZ_CHECK(ritz_coupling_refuse(
            &coupling, request->band_hz[1] > 0.0
                           ? "over a band it must be mode by mode"
                           : "engine 'dense' takes any"));
    return closed_form(request, &modes, out);
}

/* Closed form unless damping couples modes: then *fits is false, and nothing
   is found. */
static ritz_status find_modal_if(const ritz_gramians_request *request,
                                 bool *fits, ritz_gramians *out)
{
    RITZ_OWN(ritz_modal_model) modes = {0};
    ritz_coupling coupling = {0};

    RITZ_CHECK(ritz_gramians_modes(request, &modes));
    *fits = !ritz_modes_coupled(&modes, &coupling);
    if (*fits)
        RITZ_CHECK(closed_form(request, &modes, out));
    return RITZ_OK;
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
    bool fits = false;

    if (request->band_hz[1] > 0.0)
        return find_modal(request, out);
    if (large && !(request->among_hz > 0.0))
        return ritz_gramians_low_rank(request, out);
    RITZ_CHECK(find_modal_if(request, &fits, out));
    if (!fits)
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

    RITZ_REFUSE_IF(io->num_inputs == 0, RITZ_ERR_ARGUMENT,
                   "the component has no inputs: nothing of it can be reached");
    RITZ_REFUSE_IF(io->num_outputs == 0, RITZ_ERR_ARGUMENT,
                   "the component has no outputs: nothing of it can be seen");
    for (int64_t i = 0; i < io->num_outputs; i++)
        RITZ_REFUSE_IF(io->limit[i] <= 0.0, RITZ_ERR_ARGUMENT,
                       "output '%s' has the limit %g, which is not positive",
                       io->output[i], io->limit[i]);
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
