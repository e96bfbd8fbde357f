/*
 * Full against reduced. Frequencies, shapes and damping ratios of the modes in
 * the band, responses on a grid that is refined at the poles of both models,
 * the flexible static gain, and what one of them has and the other has not.
 */
#include "verify/sides.h"

#include "base/alloc.h"
#include "poles/dense_poles.h"

#include <ritz/verify.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where nothing says how a response is damped. */
static const ritz_damping assumed = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};

/* Rounding of the edge of a band belongs to it. */
static const double edge = 1e-9;

/* Damping of both models: as asked, as the full one says, as the other does. */
static ritz_status choose_damping(const ritz_component *full,
                                  const char *reduced_text,
                                  const ritz_verify_request *request,
                                  ritz_damping *out, bool *is_assumed)
{
    const char *text = full->damping[0] ? full->damping : reduced_text;
    bool matrices = full->D.colptr || full->K4.colptr;

    *out = request->damping;
    if (out->kind == RITZ_DAMPING_NONE && text[0])
        RITZ_CHECK_IN("damping", ritz_damping_parse(text, out));
    *is_assumed = out->kind == RITZ_DAMPING_NONE && !matrices;
    if (*is_assumed)
        *out = assumed;
    return RITZ_OK;
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

ritz_status ritz_sides_check(const ritz_io *full, const ritz_io *io)
{
    RITZ_REFUSE_IF(full->num_inputs != io->num_inputs ||
                       full->num_outputs != io->num_outputs,
                   RITZ_ERR_ARGUMENT,
                   "the full model has %" PRId64 " inputs and %" PRId64
                   " outputs, the reduced one %" PRId64 " and %" PRId64,
                   full->num_inputs, full->num_outputs, io->num_inputs,
                   io->num_outputs);
    for (int64_t k = 0; k < io->num_inputs; k++)
        RITZ_REFUSE_IF(
            strcmp(full->input[k], io->input[k]) != 0, RITZ_ERR_ARGUMENT,
            "input %" PRId64 " is '%s' in the full model and '%s' in "
            "the reduced one",
            k + 1, full->input[k], io->input[k]);
    for (int64_t k = 0; k < io->num_outputs; k++)
        RITZ_REFUSE_IF(
            strcmp(full->output[k], io->output[k]) != 0, RITZ_ERR_ARGUMENT,
            "output %" PRId64 " is '%s' in the full model and '%s' in "
            "the reduced one",
            k + 1, full->output[k], io->output[k]);
    return RITZ_OK;
}

static ritz_status check_band(const ritz_verify_request *request)
{
    RITZ_REFUSE_IF(!(request->band_hz[0] >= 0.0) ||
                       !isfinite(request->band_hz[1]) ||
                       (request->band_hz[1] != 0.0 &&
                        request->band_hz[0] >= request->band_hz[1]),
                   RITZ_ERR_ARGUMENT, "a band from %g to %g Hz is none",
                   request->band_hz[0], request->band_hz[1]);
    return RITZ_OK;
}

bool ritz_in_band(const double band_hz[2], double lambda)
{
    double hertz = ritz_eigen_hertz(lambda);

    return hertz >= band_hz[0] * (1.0 - edge) &&
           hertz <= band_hz[1] * (1.0 + edge);
}

/* Its basis is dense and its modes are all there. */
ritz_status ritz_sides_open(const ritz_second_order *model,
                            const ritz_damping *damping, double to_hz,
                            ritz_sides *sides)
{
    RITZ_CHECK_IN("reduced model",
                  ritz_poles_of_dense(model, damping, to_hz, &sides->reduced));
    RITZ_CHECK_IN("reduced model",
                  ritz_eigen_dense(model->K, model->M, &sides->small));
    return RITZ_OK;
}

/* Q = Phi_full' M (T Phi_reduced) */
static ritz_status cross(const ritz_sides *sides, const ritz_dense *T,
                         ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense shapes = {0};
    ritz_dense MS = {0};

    RITZ_TRY(ritz_dense_mul(T, &sides->small.Phi, &shapes));
    RITZ_TRY(ritz_sparse_mul(&sides->full->component->M, &shapes, &MS));
    RITZ_TRY(ritz_dense_mul_tn(&sides->full->pairs.Phi, &MS, out));
done:
    ritz_dense_free(&shapes);
    ritz_dense_free(&MS);
    return status;
}

/* Which mode of the full model is which of the reduced one. */
static ritz_status match_modes(const ritz_dense *T, ritz_sides *sides)
{
    ritz_status status = RITZ_OK;
    const ritz_reference *full = sides->full;
    ritz_dense Q = {0};

    sides->shapes = T && T->val && T->nrow == full->component->num_dofs;
    if (!sides->shapes)
        return ritz_match_outputs(&full->poles, &sides->reduced, &full->seen,
                                  &sides->match);
    RITZ_TRY(cross(sides, T, &Q));
    RITZ_TRY(
        ritz_match_shapes(&full->poles, &sides->reduced, &Q, &sides->match));
done:
    ritz_dense_free(&Q);
    return status;
}

/* Every row of the table that exists for these models. */
static ritz_status measure_rows(const ritz_sides *sides, ritz_measures *out)
{
    const ritz_io *io = &sides->full->component->io;
    const bool channels = io->num_inputs > 0 && io->num_outputs > 0;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];
        ritz_measure m = {.value = nan(""), .limit = sides->limit[k]};

        if (!kind->of_modes ||
            (kind->needs & RITZ_NEEDS_CHANNELS && !channels) ||
            (kind->needs & RITZ_NEEDS_LIMIT && isnan(m.limit)))
            continue;
        RITZ_CHECK(kind->of_modes(sides, &m));
        if (!isnan(m.value))
            RITZ_CHECK(
                ritz_measures_add(out, kind->name, m.value, m.limit, m.where));
    }
    return RITZ_OK;
}

ritz_status ritz_sides_measure(const ritz_second_order *model,
                               const ritz_dense *T,
                               const ritz_verify_request *limits,
                               ritz_sides *sides, ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    const ritz_reference *full = sides->full;
    ritz_measures found = {0};

    sides->limit = limits->limit;
    sides->model = model;
    RITZ_TRY_IN("reduced model",
                ritz_damped_new(&sides->reduced, NULL, NULL, full->band_hz,
                                &sides->damped_reduced));
    RITZ_TRY_IN("reduced model",
                ritz_static_gain(model->K, model->M, model->io,
                                 full->pairs.num_rigid, &sides->gain_reduced));
    RITZ_TRY(match_modes(T, sides));
    RITZ_TRY(ritz_sides_respond(sides));
    RITZ_TRY(measure_rows(sides, &found));
    *out = found;
    found = (ritz_measures){0};
done:
    ritz_measures_free(&found);
    return status;
}

void ritz_sides_free(ritz_sides *sides)
{
    ritz_pairs_free(&sides->small);
    ritz_poles_free(&sides->reduced);
    ritz_dense_free(&sides->gain_reduced);
    ritz_match_free(&sides->match);
    ritz_damped_free(&sides->damped_reduced);
    *sides = (ritz_sides){0};
}

/* What is compared: a reduced component, or a system without shapes. */
typedef struct other {
    ritz_second_order model;
    const ritz_columns *columns;
    const ritz_dense *T;
    const char *damping;
} other;

/* What is held to something must be there to be measured. */
static ritz_status check_limits(const ritz_io *io,
                                const ritz_verify_request *request)
{
    for (int k = 0; k < RITZ_MEASURES; k++)
        RITZ_REFUSE_IF(
            !isnan(request->limit[k]) &&
                ritz_measure_table[k].needs & RITZ_NEEDS_CHANNELS &&
                (io->num_inputs == 0 || io->num_outputs == 0),
            RITZ_ERR_ARGUMENT,
            "a limit of '%s' needs inputs and outputs, and there are "
            "%" PRId64 " and %" PRId64,
            ritz_measure_table[k].name, io->num_inputs, io->num_outputs);
    return RITZ_OK;
}

static ritz_status verify(const ritz_component *full, const other *o,
                          const ritz_verify_request *request,
                          ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    ritz_reference_request asked = {0};
    ritz_reference *reference = NULL;
    ritz_sides sides = {.where = RITZ_AT_OTHER_POLES, .outputs = !o->columns};
    bool is_assumed = false;

    RITZ_TRY(ritz_sides_check(&full->io, o->model.io));
    RITZ_TRY(check_band(request));
    RITZ_TRY(check_limits(&full->io, request));
    RITZ_TRY(
        choose_damping(full, o->damping, request, &asked.damping, &is_assumed));
    RITZ_TRY(ritz_sides_open(&o->model, &asked.damping, request->band_hz[1],
                             &sides));
    choose_band(&sides.reduced, highest_hertz(&sides.reduced, o->columns),
                request, asked.band_hz);
    RITZ_TRY(ritz_reference_open(full, &asked, is_assumed, &reference));
    sides.full = reference;
    RITZ_TRY(ritz_sides_measure(&o->model, o->T, request, &sides, out));
done:
    ritz_sides_free(&sides);
    ritz_reference_free(&reference);
    return status;
}

ritz_status ritz_verify_reduced(const ritz_component *full,
                                const ritz_reduced *reduced,
                                const ritz_verify_request *request,
                                ritz_measures *out)
{
    const other o = {
        {&reduced->K, &reduced->M, &reduced->D, &reduced->K4, &reduced->io},
        &reduced->columns,
        &reduced->T,
        reduced->damping};

    RITZ_REFUSE_IF(reduced->num_dofs != full->num_dofs, RITZ_ERR_ARGUMENT,
                   "the reduced model comes from %" PRId64
                   " dofs, the full one has %" PRId64,
                   reduced->num_dofs, full->num_dofs);
    return verify(full, &o, request, out);
}

ritz_status ritz_verify_system(const ritz_component *full,
                               const ritz_configuration *reduced,
                               const ritz_verify_request *request,
                               ritz_measures *out)
{
    const other o = {
        {&reduced->K, &reduced->M, &reduced->D, &reduced->K4, &reduced->io},
        NULL,
        NULL,
        ""};

    return verify(full, &o, request, out);
}
