/*
 * Full against reduced. Frequencies, shapes and damping ratios of the modes in
 * the band, responses on a grid that is refined at the poles of both models,
 * the flexible static gain, and what one of them has and the other has not.
 */
#include "verify/compare_sides.h"

#include "base/alloc.h"
#include "verify/dense_poles.h"

#include <ritz/verify.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A full model's modes are computed so far beyond the band. */
static const double beyond = 3.0;
/* Where nothing says how a response is damped. */
static const ritz_damping assumed = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};

/* Damping of both models: as asked, as the full one says, as the other does. */
static ritz_status choose_damping(const ritz_component *full,
                                  const char *reduced_text,
                                  const ritz_verify_request *request,
                                  ritz_sides *sides)
{
    ritz_status status = RITZ_OK;
    const char *text = full->damping[0] ? full->damping : reduced_text;
    bool matrices = full->D.colptr || full->K4.colptr;

    sides->damping = request->damping;
    if (sides->damping.kind == RITZ_DAMPING_NONE && text[0])
        RITZ_TRY_IN("damping", ritz_damping_parse(text, &sides->damping));
    if (sides->damping.kind == RITZ_DAMPING_NONE && !matrices) {
        sides->damping = assumed;
        sides->assumed = true;
    }
done:
    return status;
}

/*
 * The highest frequency that a reduced model answers for: of the modes that its
 * basis was made with, or else the highest of its own.
 */
static double highest_hertz(const ritz_poles *reduced,
                            const ritz_columns *columns)
{
    double highest = 0.0;

    for (int64_t k = 0; columns && k < columns->count; k++)
        if (isfinite(columns->hertz[k]))
            highest = fmax(highest, columns->hertz[k]);
    if (highest == 0.0 && reduced->count > 0)
        highest = ritz_eigen_hertz(reduced->lambda[reduced->count - 1]);
    return highest;
}

/* Up to the highest mode below half of the highest frequency. */
static void choose_band(const ritz_poles *reduced, double highest,
                        const ritz_verify_request *request, double band[2])
{
    band[0] = request->band_hz[0];
    band[1] = request->band_hz[1];
    if (band[1] > 0.0)
        return;
    for (int64_t k = reduced->num_rigid; k < reduced->count; k++) {
        double hertz = ritz_eigen_hertz(reduced->lambda[k]);

        if (k == reduced->num_rigid || hertz <= 0.5 * highest)
            band[1] = hertz;
    }
    if (band[1] == 0.0)
        band[1] = fmax(1.0, 2.0 * band[0]); /* rigid bodies: any will do */
}

static ritz_status check(const ritz_component *full, const ritz_io *io,
                         const ritz_verify_request *request)
{
    ritz_status status = RITZ_OK;

    RITZ_FAIL_IF(full->io.num_inputs != io->num_inputs ||
                     full->io.num_outputs != io->num_outputs,
                 RITZ_ERR_ARGUMENT,
                 "the full model has %" PRId64 " inputs and %" PRId64
                 " outputs, the reduced one %" PRId64 " and %" PRId64,
                 full->io.num_inputs, full->io.num_outputs, io->num_inputs,
                 io->num_outputs);
    for (int64_t k = 0; k < io->num_inputs; k++)
        RITZ_FAIL_IF(strcmp(full->io.input[k], io->input[k]) != 0,
                     RITZ_ERR_ARGUMENT,
                     "input %" PRId64 " is '%s' in the full model and '%s' in "
                     "the reduced one",
                     k + 1, full->io.input[k], io->input[k]);
    for (int64_t k = 0; k < io->num_outputs; k++)
        RITZ_FAIL_IF(strcmp(full->io.output[k], io->output[k]) != 0,
                     RITZ_ERR_ARGUMENT,
                     "output %" PRId64 " is '%s' in the full model and '%s' in "
                     "the reduced one",
                     k + 1, full->io.output[k], io->output[k]);
    RITZ_FAIL_IF(!(request->band_hz[0] >= 0.0) ||
                     !isfinite(request->band_hz[1]) ||
                     (request->band_hz[1] != 0.0 &&
                      request->band_hz[0] >= request->band_hz[1]),
                 RITZ_ERR_ARGUMENT, "a band from %g to %g Hz is none",
                 request->band_hz[0], request->band_hz[1]);
done:
    return status;
}

/* The full model's modes, and of the rest what inputs reach. */
static ritz_status open_full(const ritz_component *full, ritz_sides *sides)
{
    ritz_status status = RITZ_OK;

    sides->modes_hz = beyond * sides->band_hz[1];
    RITZ_TRY_IN("full model",
                ritz_poles_of_component(full, &sides->damping, sides->modes_hz,
                                        &sides->pairs, &sides->full));
    RITZ_TRY_IN("full model",
                ritz_residual_new(full, &sides->pairs, sides->band_hz[1],
                                  &sides->residual));
    RITZ_TRY_IN("full model",
                ritz_damped_new(&sides->full, full, &sides->pairs,
                                sides->band_hz, &sides->damped_full));
done:
    return status;
}

/* The reduced one's: its basis is dense and its modes are all there. */
static ritz_status open_reduced(const ritz_second_order *model,
                                ritz_sides *sides)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY_IN("reduced model",
                ritz_poles_of_dense(model, &sides->damping, &sides->reduced));
    RITZ_TRY_IN("reduced model",
                ritz_eigen_dense(model->K, model->M, &sides->small));
    RITZ_TRY_IN("reduced model",
                ritz_damped_new(&sides->reduced, NULL, NULL, sides->band_hz,
                                &sides->damped_reduced));
done:
    return status;
}

/* Q = Phi_full' M (T Phi_reduced) */
static ritz_status cross(const ritz_component *full, const ritz_dense *T,
                         const ritz_sides *sides, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense shapes = {0};
    ritz_dense MS = {0};

    RITZ_TRY(ritz_dense_mul(T, &sides->small.Phi, &shapes));
    RITZ_TRY(ritz_sparse_mul(&full->M, &shapes, &MS));
    RITZ_TRY(ritz_dense_mul_tn(&sides->pairs.Phi, &MS, out));
done:
    ritz_dense_free(&shapes);
    ritz_dense_free(&MS);
    return status;
}

static ritz_status measure(const ritz_component *full,
                           const ritz_second_order *model, const ritz_dense *T,
                           const ritz_verify_request *request,
                           ritz_sides *sides, ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense Q = {0};
    ritz_measures found = {0};

    sides->component = full;
    RITZ_TRY(open_full(full, sides));
    RITZ_TRY_IN("reduced model",
                ritz_static_gain(model->K, model->M, model->io,
                                 sides->pairs.num_rigid, &sides->gain_reduced));
    if (T && T->val && T->nrow == full->num_dofs) {
        sides->shapes = true;
        RITZ_TRY(cross(full, T, sides, &Q));
        RITZ_TRY(ritz_match_shapes(&sides->full, &sides->reduced, &Q,
                                   &sides->match));
    } else {
        RITZ_TRY(
            ritz_match_outputs(&sides->full, &sides->reduced, &sides->match));
    }
    RITZ_TRY(ritz_sides_modes(sides, request, &found));
    RITZ_TRY(ritz_sides_responses(sides, request, &found));
    *out = found;
    found = (ritz_measures){0};
done:
    ritz_dense_free(&Q);
    ritz_measures_free(&found);
    return status;
}

void ritz_sides_free(ritz_sides *sides)
{
    ritz_pairs_free(&sides->pairs);
    ritz_pairs_free(&sides->small);
    ritz_poles_free(&sides->full);
    ritz_poles_free(&sides->reduced);
    ritz_residual_free(&sides->residual);
    ritz_dense_free(&sides->gain_reduced);
    ritz_match_free(&sides->match);
    ritz_damped_free(&sides->damped_full);
    ritz_damped_free(&sides->damped_reduced);
    *sides = (ritz_sides){0};
}

ritz_status ritz_verify_reduced(const ritz_component *full,
                                const ritz_reduced *reduced,
                                const ritz_verify_request *request,
                                ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    const ritz_second_order model = {&reduced->K, &reduced->M, &reduced->D,
                                     &reduced->K4, &reduced->io};
    ritz_sides sides = {0};

    RITZ_FAIL_IF(reduced->num_dofs != full->num_dofs, RITZ_ERR_ARGUMENT,
                 "the reduced model comes from %" PRId64
                 " dofs, the full one has %" PRId64,
                 reduced->num_dofs, full->num_dofs);
    RITZ_TRY(check(full, &reduced->io, request));
    RITZ_TRY(choose_damping(full, reduced->damping, request, &sides));
    RITZ_TRY(open_reduced(&model, &sides));
    choose_band(&sides.reduced,
                highest_hertz(&sides.reduced, &reduced->columns), request,
                sides.band_hz);
    RITZ_TRY(measure(full, &model, &reduced->T, request, &sides, out));
done:
    ritz_sides_free(&sides);
    return status;
}

ritz_status ritz_verify_system(const ritz_component *full,
                               const ritz_configuration *reduced,
                               const ritz_verify_request *request,
                               ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    const ritz_second_order model = {&reduced->K, &reduced->M, &reduced->D,
                                     &reduced->K4, &reduced->io};
    ritz_sides sides = {0};

    RITZ_TRY(check(full, &reduced->io, request));
    RITZ_TRY(choose_damping(full, "", request, &sides));
    RITZ_TRY(open_reduced(&model, &sides));
    choose_band(&sides.reduced, highest_hertz(&sides.reduced, NULL), request,
                sides.band_hz);
    sides.outputs = true;
    RITZ_TRY(measure(full, &model, NULL, request, &sides, out));
done:
    ritz_sides_free(&sides);
    return status;
}

bool ritz_measure_holds(const ritz_measure *measure)
{
    if (isnan(measure->limit))
        return true;
    return strcmp(measure->name, "mac") == 0 ? measure->value >= measure->limit
                                             : measure->value <= measure->limit;
}
