/*
 * Full against reduced. The reference holds what every comparison with one full
 * model needs, made once: modes, responses on a grid that is refined at its
 * poles, flexible static gain. A reduced model is then held against it by every
 * row of the table of measures.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "poles/poles.h"
#include "verify/sides.h"
#include "verify/states.h"

#include <ritz/verify.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Dofs up to which all modes are taken where D couples them, or does what is
   not known to those above. */
enum { SMALL = 300 };
/* Points before those at the poles are added. */
enum { EVEN_POINTS = 200 };
/* Where nothing says how a response is damped. */
static const ritz_damping unstated = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};

double ritz_random_next(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53; /* [Steele2014] */
}

void ritz_random_hertz(uint64_t seed, const double band_hz[2], int64_t count,
                       double *out)
{
    /* one in each of `count` equal parts: anywhere, and nowhere twice */
    double part = (band_hz[1] - band_hz[0]) / (double)count;

    for (int64_t k = 0; k < count; k++)
        out[k] = band_hz[0] + ((double)k + ritz_random_next(&seed)) * part;
    qsort(out, (size_t)count, sizeof *out, ritz_ascending);
}

/* The flexible gain C Phi Lambda^-1 Phi'B of the modes, and of the rest. */
static ritz_status full_gain(ritz_reference *r)
{
    const ritz_poles *poles = &r->poles;
    int64_t p = poles->io.num_outputs;

    RITZ_CHECK(ritz_dense_new(p, poles->io.num_inputs, &r->gain));
    for (int64_t j = 0; j < poles->io.num_inputs; j++)
        for (int64_t i = 0; i < p; i++) {
            double *g = &ritz_dense_col(&r->gain, j)[i];

            *g = r->residual.count > 0 ? r->residual.C[i + j * p] : 0.0;
            for (int64_t k = poles->num_rigid; k < poles->count; k++)
                *g += ritz_dense_col(&poles->io.C, k)[i] *
                      ritz_dense_col(&poles->io.B, j)[k] / poles->lambda[k];
        }
    return RITZ_OK;
}

/* Modes up to a frequency, and the answer of the rest. */
static ritz_status take_modes(double up_to_hz, ritz_reference *r)
{
    ritz_status status = RITZ_OK;
    const ritz_component *full = r->component;

    RITZ_TRY(ritz_poles_of_component(full, &r->damping, up_to_hz, &r->pairs,
                                     &r->poles));
    RITZ_TRY(ritz_residual_new(full, &r->damping, &r->pairs, r->band_hz[1],
                               up_to_hz, &r->residual));
done:
    return ritz_context(status, "full model");
}

static ritz_status open_modes(ritz_reference *r)
{
    r->modes_hz = RITZ_REFERENCE_REACH * r->band_hz[1];
    RITZ_CHECK(take_modes(r->modes_hz, r));
    if (ritz_reference_factors(r) && r->component->num_dofs <= SMALL) {
        ritz_pairs_free(&r->pairs);
        ritz_poles_free(&r->poles);
        ritz_residual_free(&r->residual);
        RITZ_CHECK(take_modes(RITZ_ALL_MODES, r));
    }
    RITZ_CHECK_IN("full model",
                  ritz_damped_new(&r->poles, r->component, &r->pairs,
                                  r->band_hz, &r->damped));
    RITZ_CHECK_IN("full model", ritz_seen_new(r->component, &r->pairs,
                                              &r->poles, r->band_hz, &r->seen));
    RITZ_CHECK_IN("full model", full_gain(r));
    return RITZ_OK;
}

/* Responses where every reduction is compared. */
static ritz_status open_sweeps(const ritz_reference_request *request,
                               ritz_reference *r)
{
    double band[2] = {r->band_hz[0], r->band_hz[1]};

    if (r->poles.io.num_inputs == 0 || r->poles.io.num_outputs == 0 ||
        !(band[1] > band[0]))
        return RITZ_OK;
    RITZ_CHECK(
        ritz_sweep_points(r, &r->poles, &r->damped, EVEN_POINTS, &r->own));
    RITZ_CHECK(ritz_reference_respond(r, &r->own));
    if (request->num_random < 1)
        return RITZ_OK;
    if (r->poles.num_rigid > 0)
        band[0] = fmax(band[0], RITZ_BAND_START * band[1]);
    r->random.count = request->num_random;
    RITZ_CHECK_NEW(r->random.hertz, r->random.count);
    ritz_random_hertz(request->seed, band, r->random.count, r->random.hertz);
    return ritz_reference_respond(r, &r->random);
}

/* The same with damping that somebody has chosen, or has not. */
static ritz_status open_reference(const ritz_component *full,
                                  const ritz_reference_request *request,
                                  bool assumed, ritz_reference **out)
{
    RITZ_OWN(ritz_reference) *r = NULL;

    RITZ_CHECK_NEW(r, 1);
    r->component = full;
    r->band_hz[0] = request->band_hz[0];
    r->band_hz[1] = request->band_hz[1];
    r->damping = request->damping;
    r->assumed = assumed;
    RITZ_CHECK(open_modes(r));
    RITZ_CHECK(open_sweeps(request, r));
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

/* Damping of both models: as asked, as the full one says, as the other does. */
static ritz_status choose_damping(const ritz_component *full,
                                  const char *reduced_text,
                                  const ritz_damping *asked, ritz_damping *out,
                                  bool *is_assumed)
{
    const char *text = full->damping[0] ? full->damping : reduced_text;
    bool matrices = full->D.colptr || full->K4.colptr;

    *out = *asked;
    if (out->kind == RITZ_DAMPING_NONE && text[0])
        RITZ_CHECK_IN("damping", ritz_damping_parse(text, out));
    *is_assumed = out->kind == RITZ_DAMPING_NONE && !matrices;
    if (*is_assumed)
        *out = unstated;
    return RITZ_OK;
}

ritz_status ritz_reference_new(const ritz_component *full,
                               const ritz_reference_request *request,
                               ritz_reference **out)
{
    ritz_reference_request own = *request;
    bool is_assumed = false;

    RITZ_REFUSE_IF(!(own.band_hz[0] >= 0.0) || !isfinite(own.band_hz[1]) ||
                       !(own.band_hz[0] < own.band_hz[1]),
                   RITZ_ERR_ARGUMENT, "a band from %g to %g Hz is none",
                   own.band_hz[0], own.band_hz[1]);
    RITZ_CHECK(
        choose_damping(full, "", &request->damping, &own.damping, &is_assumed));
    return open_reference(full, &own, is_assumed, out);
}

int64_t ritz_reference_modes(const ritz_reference *reference, int64_t *rigid)
{
    int64_t count = 0;

    for (int64_t k = reference->poles.num_rigid; k < reference->poles.count;
         k++)
        count += ritz_in_band(reference->band_hz, reference->poles.lambda[k]);
    *rigid = reference->poles.num_rigid;
    return count;
}

void ritz_reference_free(ritz_reference **reference)
{
    ritz_reference *r = *reference;

    if (!r)
        return;
    ritz_pairs_free(&r->pairs);
    ritz_poles_free(&r->poles);
    ritz_residual_free(&r->residual);
    ritz_damped_free(&r->damped);
    ritz_seen_free(&r->seen);
    ritz_dense_free(&r->gain);
    ritz_sweep_free(&r->own);
    ritz_sweep_free(&r->random);
    free(r);
    *reference = NULL;
}

/*
 * Full against reduced. Frequencies, shapes and damping ratios of the modes in
 * the band, responses on a grid that is refined at the poles of both models,
 * the flexible static gain, and what one of them has and the other has not.
 */

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

/* That what goes in and comes out is the same of both. */
static ritz_status check_signals(const ritz_io *full, const ritz_io *io)
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

/* Its basis is dense and its modes are all there. */
static ritz_status open_sides(const ritz_second_order *model,
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
static ritz_status multiply_shapes(const ritz_sides *sides, const ritz_dense *T,
                                   ritz_dense *out)
{
    RITZ_OWN(ritz_dense) shapes = {0};
    RITZ_OWN(ritz_dense) MS = {0};

    RITZ_CHECK(ritz_dense_mul(T, &sides->small.Phi, &shapes));
    RITZ_CHECK(ritz_sparse_mul(&sides->full->component->M, &shapes, &MS));
    return ritz_dense_mul_tn(&sides->full->pairs.Phi, &MS, out);
}

/* Which mode of the full model is which of the reduced one. */
static ritz_status match_modes(const ritz_dense *T, ritz_sides *sides)
{
    const ritz_reference *full = sides->full;
    RITZ_OWN(ritz_dense) Q = {0};

    sides->shapes = T && T->val && T->nrow == full->component->num_dofs;
    if (!sides->shapes)
        return ritz_match_outputs(&full->poles, &sides->reduced, &full->seen,
                                  &sides->match);
    RITZ_CHECK(multiply_shapes(sides, T, &Q));
    return ritz_match_shapes(&full->poles, &sides->reduced, &Q, &sides->match);
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

/*
 * The measures of one model, whose poles are there already, against the full
 * one.
 *
 * @param[in]     T      NULL: shapes cannot be compared
 * @param[in,out] sides  with `reduced` and `small`; the rest is filled in
 */
static ritz_status measure_sides(const ritz_second_order *model,
                                 const ritz_dense *T,
                                 const ritz_verify_request *limits,
                                 ritz_sides *sides, ritz_measures *out)
{
    const ritz_reference *full = sides->full;
    RITZ_OWN(ritz_measures) found = {0};

    sides->limit = limits->limit;
    sides->model = model;
    RITZ_CHECK_IN("reduced model",
                  ritz_damped_new(&sides->reduced, NULL, NULL, full->band_hz,
                                  &sides->damped_reduced));
    RITZ_CHECK_IN("reduced model",
                  ritz_static_gain(model->K, model->M, model->io,
                                   full->pairs.num_rigid,
                                   &sides->gain_reduced));
    RITZ_CHECK(match_modes(T, sides));
    RITZ_CHECK(ritz_sides_respond(sides));
    RITZ_CHECK(measure_rows(sides, &found));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

static void free_sides(ritz_sides *sides)
{
    ritz_pairs_free(&sides->small);
    ritz_poles_free(&sides->reduced);
    ritz_dense_free(&sides->gain_reduced);
    ritz_match_free(&sides->match);
    ritz_damped_free(&sides->damped_reduced);
    *sides = (ritz_sides){0};
}

/* Measures of a dense model, made with the T that may be there. */
static ritz_status measure_dense(const ritz_reference *reference,
                                 const ritz_second_order *model,
                                 const ritz_dense *T,
                                 const ritz_verify_request *limits,
                                 ritz_sides *sides, ritz_measures *out)
{
    RITZ_CHECK(check_signals(&reference->component->io, model->io));
    RITZ_CHECK(
        open_sides(model, &reference->damping, reference->band_hz[1], sides));
    sides->full = reference;
    return measure_sides(model, T, limits, sides, out);
}

ritz_status ritz_reference_measure(const ritz_reference *reference,
                                   const ritz_reduced *reduced,
                                   const ritz_verify_request *limits, int where,
                                   ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    const ritz_second_order model = {&reduced->K, &reduced->M, &reduced->D,
                                     &reduced->K4, &reduced->io};
    ritz_sides sides = {.where = where};

    RITZ_FAIL_IF(reduced->num_dofs != reference->component->num_dofs,
                 RITZ_ERR_ARGUMENT,
                 "the reduced model comes from %" PRId64
                 " dofs, the full one has %" PRId64,
                 reduced->num_dofs, reference->component->num_dofs);
    RITZ_TRY(
        measure_dense(reference, &model, &reduced->T, limits, &sides, out));
done:
    free_sides(&sides);
    return status;
}

ritz_status ritz_reference_measure_at(const ritz_reference *reference,
                                      const ritz_configuration *reduced,
                                      const ritz_verify_request *limits,
                                      int where, ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    const ritz_second_order model = {&reduced->K, &reduced->M, &reduced->D,
                                     &reduced->K4, &reduced->io};
    ritz_sides sides = {.where = where, .outputs = true};

    RITZ_TRY(measure_dense(reference, &model, NULL, limits, &sides, out));
done:
    free_sides(&sides);
    return status;
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

static ritz_status verify_dense(const ritz_component *full, const other *o,
                                const ritz_verify_request *request,
                                ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    ritz_reference_request asked = {0};
    ritz_reference *reference = NULL;
    ritz_sides sides = {.where = RITZ_AT_OTHER_POLES, .outputs = !o->columns};
    bool is_assumed = false;

    RITZ_TRY(check_signals(&full->io, o->model.io));
    RITZ_TRY(check_band(request));
    RITZ_TRY(check_limits(&full->io, request));
    RITZ_TRY(choose_damping(full, o->damping, &request->damping, &asked.damping,
                            &is_assumed));
    RITZ_TRY(
        open_sides(&o->model, &asked.damping, request->band_hz[1], &sides));
    choose_band(&sides.reduced, highest_hertz(&sides.reduced, o->columns),
                request, asked.band_hz);
    RITZ_TRY(open_reference(full, &asked, is_assumed, &reference));
    sides.full = reference;
    RITZ_TRY(measure_sides(&o->model, o->T, request, &sides, out));
done:
    free_sides(&sides);
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
    return verify_dense(full, &o, request, out);
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

    return verify_dense(full, &o, request, out);
}

static ritz_status check_states(const ritz_state_space *full,
                                const ritz_verify_request *request)
{
    const double *band = request->band_hz;

    RITZ_REFUSE_IF(full->num_inputs == 0 || full->num_outputs == 0,
                   RITZ_ERR_ARGUMENT,
                   "there are no %s, nothing can be compared",
                   full->num_inputs == 0 ? "inputs" : "outputs");
    RITZ_REFUSE_IF(!(band[0] >= 0.0) || !isfinite(band[1]) ||
                       (band[1] != 0.0 && band[0] >= band[1]),
                   RITZ_ERR_ARGUMENT, "a band from %g to %g Hz is none",
                   band[0], band[1]);
    for (int k = 0; k < RITZ_MEASURES && band[1] == 0.0; k++)
        RITZ_REFUSE_IF(!isnan(request->limit[k]) &&
                           ritz_measure_table[k].needs & RITZ_NEEDS_BAND,
                       RITZ_ERR_ARGUMENT,
                       "--limit-%s of a state space needs --band-hz",
                       ritz_measure_table[k].word);
    return RITZ_OK;
}

ritz_status ritz_verify_states(const ritz_state_space *full,
                               const ritz_state_space *reduced,
                               const ritz_verify_request *request,
                               ritz_measures *out)
{
    RITZ_OWN(ritz_measures) found = {0};
    RITZ_OWN(ritz_state_pair) p = {0};

    RITZ_CHECK(check_states(full, request));
    RITZ_CHECK(ritz_state_pair_new(full, reduced, request, &p));
    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];
        ritz_measure m = {.value = nan(""), .limit = request->limit[k]};

        if (kind->of_states)
            RITZ_CHECK(kind->of_states(&p, &m));
        if (!isnan(m.value))
            RITZ_CHECK(ritz_measures_add(&found, kind->name, m.value, m.limit,
                                         m.where));
    }
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}
