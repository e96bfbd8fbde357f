/*
 * What of a full model serves every comparison with a reduction of it: found
 * once, then only read.
 */
#include "verify/sides.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* A full model's modes are computed so far beyond the band. */
static const double beyond = 3.0;
/* Hz: no model has a mode above. */
static const double all_modes = 1e100;
/* Dofs up to which all modes are taken where D couples them, or does what is
   not known to those above. */
enum { SMALL = 300 };
/* Points before those at the poles are added. */
enum { EVEN_POINTS = 200 };
/* Rigid motion has no response at 0 Hz: begin at this part of the band. */
static const double above_rest = 1e-3;
/* Where nothing says how a response is damped. */
static const ritz_damping assumed_damping = {.kind = RITZ_DAMPING_MODAL,
                                             .zeta = 0.01};

double ritz_random_next(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

static int ascending(const void *left, const void *right)
{
    double a = *(const double *)left;
    double b = *(const double *)right;

    return (a > b) - (a < b);
}

void ritz_random_hertz(uint64_t seed, const double band_hz[2], int64_t count,
                       double *out)
{
    /* one in each of `count` equal parts: anywhere, and nowhere twice */
    double part = (band_hz[1] - band_hz[0]) / (double)count;

    for (int64_t k = 0; k < count; k++)
        out[k] = band_hz[0] + ((double)k + ritz_random_next(&seed)) * part;
    qsort(out, (size_t)count, sizeof *out, ascending);
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

bool ritz_reference_factors(const ritz_reference *reference)
{
    return (reference->poles.coupled || !reference->residual.known) &&
           reference->poles.count < reference->component->num_dofs;
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
    r->modes_hz = beyond * r->band_hz[1];
    RITZ_CHECK(take_modes(r->modes_hz, r));
    if (ritz_reference_factors(r) && r->component->num_dofs <= SMALL) {
        ritz_pairs_free(&r->pairs);
        ritz_poles_free(&r->poles);
        ritz_residual_free(&r->residual);
        RITZ_CHECK(take_modes(all_modes, r));
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
        band[0] = fmax(band[0], above_rest * band[1]);
    r->random.count = request->num_random;
    RITZ_CHECK_NEW(r->random.hertz, r->random.count);
    ritz_random_hertz(request->seed, band, r->random.count, r->random.hertz);
    return ritz_reference_respond(r, &r->random);
}

ritz_status ritz_reference_open(const ritz_component *full,
                                const ritz_reference_request *request,
                                bool assumed, ritz_reference **out)
{
    ritz_status status = RITZ_OK;
    ritz_reference *r = NULL;

    RITZ_NEW(r, 1);
    r->component = full;
    r->band_hz[0] = request->band_hz[0];
    r->band_hz[1] = request->band_hz[1];
    r->damping = request->damping;
    r->assumed = assumed;
    RITZ_TRY(open_modes(r));
    RITZ_TRY(open_sweeps(request, r));
    *out = r;
    r = NULL;
done:
    ritz_reference_free(&r);
    return status;
}

ritz_status ritz_reference_new(const ritz_component *full,
                               const ritz_reference_request *request,
                               ritz_reference **out)
{
    ritz_reference_request own = *request;
    bool assumed = false;

    RITZ_REFUSE_IF(!(own.band_hz[0] >= 0.0) || !isfinite(own.band_hz[1]) ||
                       !(own.band_hz[0] < own.band_hz[1]),
                   RITZ_ERR_ARGUMENT, "a band from %g to %g Hz is none",
                   own.band_hz[0], own.band_hz[1]);
    if (own.damping.kind == RITZ_DAMPING_NONE && full->damping[0])
        RITZ_CHECK_IN("damping",
                      ritz_damping_parse(full->damping, &own.damping));
    if (own.damping.kind == RITZ_DAMPING_NONE && !full->D.colptr &&
        !full->K4.colptr) {
        own.damping = assumed_damping;
        assumed = true;
    }
    return ritz_reference_open(full, &own, assumed, out);
}

/* Measures of a dense model, made with the T that may be there. */
static ritz_status measure(const ritz_reference *reference,
                           const ritz_second_order *model, const ritz_dense *T,
                           const ritz_verify_request *limits, ritz_sides *sides,
                           ritz_measures *out)
{
    RITZ_CHECK(ritz_sides_check(&reference->component->io, model->io));
    RITZ_CHECK(ritz_sides_open(model, &reference->damping,
                               reference->band_hz[1], sides));
    sides->full = reference;
    return ritz_sides_measure(model, T, limits, sides, out);
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
    RITZ_TRY(measure(reference, &model, &reduced->T, limits, &sides, out));
done:
    ritz_sides_free(&sides);
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

    RITZ_TRY(measure(reference, &model, NULL, limits, &sides, out));
done:
    ritz_sides_free(&sides);
    return status;
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
