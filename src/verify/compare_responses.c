/* Measures between the responses and static gains of two models. */
#include "verify/compare_sides.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A free body has no response at 0 Hz: begin at this part of the band. */
static const double above_rest = 1e-3;

void ritz_sweep_free(ritz_sweep *sweep)
{
    free(sweep->hertz);
    free(sweep->full);
    *sweep = (ritz_sweep){0};
}

ritz_status ritz_sweep_points(const ritz_reference *reference,
                              const ritz_poles *poles,
                              const ritz_damped *damped, int64_t even,
                              ritz_sweep *out)
{
    ritz_status status = RITZ_OK;
    double *omega = NULL;
    ritz_grid grid = {.from_hz = reference->band_hz[0],
                      .to_hz = reference->band_hz[1],
                      .count = even,
                      .refine = true};

    if (poles->num_rigid + reference->poles.num_rigid > 0)
        grid.from_hz = fmax(grid.from_hz, above_rest * grid.to_hz);
    RITZ_NEW(omega, poles->count);
    for (int64_t k = 0; k < poles->count; k++)
        omega[k] = sqrt(poles->lambda[k]);
    RITZ_TRY(ritz_grid_points(&grid, poles->count, omega, damped->zeta,
                              &out->count, &out->hertz));
done:
    free(omega);
    return status;
}

/* The largest of what is no rigid motion: y = (C + i w Cv - w^2 Ca) q less the
 * rigid q = phi'b / (-w^2 + i w d). */
static double flexible_part(const ritz_poles *poles, const ritz_sweep *s)
{
    const ritz_io *io = &poles->io;
    double largest = 0.0;

    for (int64_t e = 0; e < s->count * s->values; e++) {
        double w = 2.0 * RITZ_PI * s->hertz[e / s->values];
        int64_t i = e % s->values / io->num_inputs;
        int64_t j = e % io->num_inputs;
        double _Complex H = s->full[e];

        for (int64_t k = 0; k < poles->num_rigid; k++)
            H -= ritz_complex(ritz_dense_col(&io->C, k)[i] -
                                  w * w * ritz_dense_col(&io->Ca, k)[i],
                              w * ritz_dense_col(&io->Cv, k)[i]) *
                 ritz_dense_col(&io->B, j)[k] /
                 ritz_complex(-w * w, w * poles->rate[k]);
        largest = fmax(largest, cabs(H));
    }
    return largest;
}

/*
 * Modes and the static answer of the rest do not say what a local damper does,
 * through which the rest moves too: then each point takes a factor.
 */
ritz_status ritz_reference_respond(const ritz_reference *reference,
                                   ritz_sweep *s)
{
    ritz_status status = RITZ_OK;
    const ritz_poles *poles = &reference->poles;
    const ritz_grid grid = {.from_hz = s->hertz[0],
                            .to_hz = s->hertz[s->count - 1],
                            .count = s->count,
                            .hertz = s->hertz};
    bool local = ritz_reference_factors(reference);
    ritz_response direct = {0};

    s->values = poles->io.num_inputs * poles->io.num_outputs;
    RITZ_NEW(s->full, s->count * s->values);
    if (local) {
        RITZ_TRY(ritz_response_direct(reference->component, &reference->damping,
                                      reference->modes_hz, &grid, &direct));
        memcpy(s->full, direct.H,
               (size_t)(s->count * s->values) * sizeof *s->full);
    }
    for (int64_t k = 0; !local && k < s->count; k++) {
        RITZ_TRY(ritz_poles_add(poles, s->hertz[k], s->full + k * s->values));
        ritz_residual_add(&reference->residual, s->hertz[k],
                          s->full + k * s->values);
    }
    s->flexible = flexible_part(poles, s);
    RITZ_TRY(ritz_sweep_hear(poles, s));
done:
    ritz_response_free(&direct);
    return ritz_context(status, "full model");
}

/* What is found while the points of all sweeps are passed. */
typedef struct extreme {
    double largest;   /* |H| of the full model */
    double flexible;  /* of that less rigid motion */
    bool heard;       /* any of it is more than rounding */
    double error;     /* |H - H_r| */
    double error_hz;  /* where */
    double db, db_hz; /* the level, where it is audible */
} extreme;

/* Both models at some frequencies. */
typedef struct both {
    const ritz_sweep *full; /* NULL: none */
    double _Complex *reduced;
} both;

/* One response of both models at a frequency. */
static ritz_status take(double _Complex H, double _Complex H_r, double hertz,
                        extreme *found)
{
    double error = cabs(H - H_r);

    RITZ_REFUSE_IF(!isfinite(error), RITZ_ERR_CONVERGENCE,
                   "the response at %.6g Hz leaves all bounds", hertz);
    found->largest = fmax(found->largest, cabs(H));
    if (error > found->error) {
        found->error = error;
        found->error_hz = hertz;
    }
    return RITZ_OK;
}

/*
 * The reduced model at the points, and how far it is off. Where a rigid motion
 * of the reduced model alone would answer without end, at rest, it is not asked.
 */
static ritz_status respond(const ritz_sides *sides, both *s, extreme *found)
{
    const int64_t values = s->full->values;
    double least = sides->reduced.num_rigid > 0
                       ? above_rest * sides->full->band_hz[1] * (1.0 - 1e-9)
                       : 0.0;

    found->flexible = fmax(found->flexible, s->full->flexible);
    found->heard = found->heard || s->full->heard;
    RITZ_CHECK_NEW(s->reduced, s->full->count * values);
    for (int64_t k = 0; k < s->full->count; k++) {
        double hertz = s->full->hertz[k];
        const double _Complex *H = s->full->full + k * values;
        double _Complex *H_r = s->reduced + k * values;

        if (hertz < least) {
            memcpy(H_r, H, (size_t)values * sizeof *H);
            continue;
        }
        RITZ_CHECK_IN("reduced model",
                      ritz_poles_add(&sides->reduced, hertz, H_r));
        for (int64_t i = 0; i < values; i++)
            RITZ_CHECK(take(H[i], H_r[i], hertz, found));
    }
    return RITZ_OK;
}

/* Levels mean something above a part of the largest |H|, once that is known. */
static void compare_levels(const both *s, extreme *found)
{
    const int64_t values = s->full->values;

    for (int64_t k = 0; k < s->full->count * values; k++) {
        double a = cabs(s->full->full[k]);
        double b = fmax(cabs(s->reduced[k]), 1e-300);

        if (a > RITZ_AUDIBLE * found->largest &&
            fabs(20.0 * log10(b / a)) > found->db) {
            found->db = fabs(20.0 * log10(b / a));
            found->db_hz = s->full->hertz[k / values];
        }
    }
}

/* "3.41 Hz, modal 0.01 assumed" */
static void say_where(const ritz_reference *full, double hertz,
                      char where[RITZ_NAME_SIZE])
{
    char damping[RITZ_DAMPING_SIZE] = "";

    ritz_damping_print(&full->damping, damping);
    (void)snprintf(where, RITZ_NAME_SIZE, "%.6g Hz%s%.30s%s", hertz,
                   damping[0] ? ", " : "", damping,
                   full->assumed ? " assumed" : "");
}

static ritz_status add_response(const ritz_sides *sides, const extreme *found,
                                const ritz_verify_request *request,
                                ritz_measures *out)
{
    const bool rigid = sides->full->poles.num_rigid > 0;
    char where[RITZ_NAME_SIZE];

    if (!found->heard) /* no output sees any input */
        return RITZ_OK;
    say_where(sides->full, found->error_hz, where);
    RITZ_CHECK(ritz_measures_add(
        out, "response-relative", found->error / found->largest,
        rigid ? request->limit_response
              : fmin(request->limit_response, request->limit_flexible),
        where));
    if (rigid && found->flexible > RITZ_AUDIBLE * found->error)
        RITZ_CHECK(ritz_measures_add(out, "flexible-response-relative",
                                     found->error / found->flexible,
                                     request->limit_flexible, where));
    say_where(sides->full, found->db_hz, where);
    return ritz_measures_add(out, "response-db", found->db, nan(""), where);
}

/* Every sweep that was asked for. */
static ritz_status compare(const ritz_sides *sides,
                           const ritz_verify_request *request,
                           ritz_measures *out)
{
    enum { SWEEPS = 3 };
    ritz_status status = RITZ_OK;
    const ritz_reference *full = sides->full;
    ritz_sweep other = {0};
    extreme found = {0};
    both sweep[SWEEPS] = {{&full->own, NULL}};

    if (sides->where & RITZ_AT_RANDOM)
        sweep[1].full = &full->random;
    if (sides->where & RITZ_AT_OTHER_POLES) {
        RITZ_TRY(ritz_sweep_points(full, &sides->reduced,
                                   &sides->damped_reduced, 2, &other));
        RITZ_TRY(ritz_reference_respond(full, &other));
        sweep[2].full = &other;
    }
    for (int k = 0; k < SWEEPS; k++)
        if (sweep[k].full)
            RITZ_TRY(respond(sides, &sweep[k], &found));
    for (int k = 0; k < SWEEPS; k++)
        if (sweep[k].full)
            compare_levels(&sweep[k], &found);
    RITZ_TRY(add_response(sides, &found, request, out));
done:
    for (int k = 0; k < SWEEPS; k++)
        free(sweep[k].reduced);
    ritz_sweep_free(&other);
    return status;
}

static ritz_status add_gain(const ritz_sides *sides, double limit,
                            ritz_measures *out)
{
    double error = 0.0;

    RITZ_CHECK(
        ritz_gain_error(&sides->full->gain, &sides->gain_reduced, &error));
    if (!isnan(error))
        RITZ_CHECK(ritz_measures_add(out, "static-gain-relative", error, limit,
                                     "largest singular value"));
    return RITZ_OK;
}

ritz_status ritz_sides_responses(const ritz_sides *sides,
                                 const ritz_verify_request *request,
                                 ritz_measures *out)
{
    const ritz_io *io = &sides->full->poles.io;

    if (io->num_inputs == 0 || io->num_outputs == 0)
        return RITZ_OK;
    if (sides->full->own.count > 0)
        RITZ_CHECK(compare(sides, request, out));
    return add_gain(sides, request->limit_gain, out);
}
