/* Measures between the responses and static gains of two models. */
#include "verify/compare_sides.h"

#include "base/alloc.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Points before those at the poles are added. */
enum { EVEN_POINTS = 200 };
/* Of the largest |H|: a level in dB means nothing beneath. */
static const double audible = 1e-6;
/* A free body has no response at 0 Hz: begin at this part of the band. */
static const double above_rest = 1e-3;

/* Both models' responses, at the same frequencies. */
typedef struct sweep {
    int64_t count, values; /* points; responses at each */
    double *hertz;
    double _Complex *full, *reduced;
} sweep;

static void sweep_free(sweep *s)
{
    free(s->hertz);
    free(s->full);
    free(s->reduced);
    *s = (sweep){0};
}

/* The band, refined at the poles of both models. */
static ritz_status points(const ritz_sides *sides, sweep *s)
{
    ritz_status status = RITZ_OK;
    const ritz_poles *const side[2] = {&sides->full, &sides->reduced};
    const double *const zeta[2] = {sides->damped_full.zeta,
                                   sides->damped_reduced.zeta};
    int64_t m = 0;
    double *omega = NULL;
    double *ratio = NULL;
    ritz_grid grid = {.from_hz = sides->band_hz[0],
                      .to_hz = sides->band_hz[1],
                      .count = EVEN_POINTS,
                      .refine = true};

    if (sides->full.num_rigid + sides->reduced.num_rigid > 0)
        grid.from_hz = fmax(grid.from_hz, above_rest * grid.to_hz);
    RITZ_NEW(omega, side[0]->count + side[1]->count);
    RITZ_NEW(ratio, side[0]->count + side[1]->count);
    for (int t = 0; t < 2; t++)
        for (int64_t k = 0; k < side[t]->count; k++, m++) {
            omega[m] = sqrt(side[t]->lambda[k]);
            ratio[m] = zeta[t][k];
        }
    RITZ_TRY(ritz_grid_points(&grid, m, omega, ratio, &s->count, &s->hertz));
done:
    free(omega);
    free(ratio);
    return status;
}

/*
 * The full model at the points. Modes and the static answer of the rest do not
 * say what a local damper does, through which the rest moves too: then each
 * point takes a factor.
 */
static ritz_status evaluate_full(const ritz_sides *sides, sweep *s)
{
    ritz_status status = RITZ_OK;
    const ritz_grid grid = {.from_hz = s->hertz[0],
                            .to_hz = s->hertz[s->count - 1],
                            .count = s->count,
                            .hertz = s->hertz};
    bool local =
        sides->full.coupled && sides->full.count < sides->component->num_dofs;
    ritz_response direct = {0};

    if (local) {
        RITZ_TRY(ritz_response_direct(sides->component, &sides->damping,
                                      sides->modes_hz, &grid, &direct));
        memcpy(s->full, direct.H,
               (size_t)(s->count * s->values) * sizeof *s->full);
    }
    for (int64_t k = 0; !local && k < s->count; k++) {
        RITZ_TRY(
            ritz_poles_add(&sides->full, s->hertz[k], s->full + k * s->values));
        ritz_residual_add(&sides->residual, s->hertz[k],
                          s->full + k * s->values);
    }
done:
    ritz_response_free(&direct);
    return status;
}

static ritz_status evaluate(const ritz_sides *sides, sweep *s)
{
    ritz_status status = RITZ_OK;
    int64_t values = sides->full.io.num_inputs * sides->full.io.num_outputs;

    s->values = values;
    RITZ_NEW(s->full, s->count * values);
    RITZ_NEW(s->reduced, s->count * values);
    RITZ_TRY_IN("full model", evaluate_full(sides, s));
    for (int64_t k = 0; k < s->count; k++) {
        RITZ_TRY_IN("reduced model",
                    ritz_poles_add(&sides->reduced, s->hertz[k],
                                   s->reduced + k * values));
    }
done:
    return status;
}

/* "3.41 Hz, modal 0.01 assumed" */
static void say_where(const ritz_sides *sides, double hertz,
                      char where[RITZ_NAME_SIZE])
{
    char damping[RITZ_DAMPING_SIZE] = "";

    ritz_damping_print(&sides->damping, damping);
    (void)snprintf(where, RITZ_NAME_SIZE, "%.6g Hz%s%.30s%s", hertz,
                   damping[0] ? ", " : "", damping,
                   sides->assumed ? " assumed" : "");
}

static ritz_status add_response(const ritz_sides *sides, const sweep *s,
                                const ritz_verify_request *request,
                                ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    double largest = 0.0;
    double error = 0.0;
    double db = 0.0;
    int64_t at[2] = {0, 0};
    char where[RITZ_NAME_SIZE];

    for (int64_t k = 0; k < s->count * s->values; k++)
        largest = fmax(largest, cabs(s->full[k]));
    for (int64_t k = 0; k < s->count * s->values; k++) {
        double a = cabs(s->full[k]);
        double b = cabs(s->reduced[k]);
        double apart = cabs(s->full[k] - s->reduced[k]);
        double level = a > audible * largest
                           ? fabs(20.0 * log10(fmax(b, 1e-300) / a))
                           : 0.0;

        if (apart > error) {
            error = apart;
            at[0] = k / s->values;
        }
        if (level > db) {
            db = level;
            at[1] = k / s->values;
        }
    }
    if (largest == 0.0) /* no output sees any input: nothing to compare */
        return RITZ_OK;
    say_where(sides, s->hertz[at[0]], where);
    RITZ_TRY(ritz_measures_add(out, "response-relative", error / largest,
                               request->limit_response, where));
    say_where(sides, s->hertz[at[1]], where);
    RITZ_TRY(ritz_measures_add(out, "response-db", db, nan(""), where));
done:
    return status;
}

/* The full model's gain: of its modes, and of the rest. */
static ritz_status full_gain(const ritz_sides *sides, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const ritz_poles *poles = &sides->full;
    int64_t p = poles->io.num_outputs;

    RITZ_TRY(ritz_dense_new(p, poles->io.num_inputs, out));
    for (int64_t j = 0; j < poles->io.num_inputs; j++)
        for (int64_t i = 0; i < p; i++) {
            double *g = &ritz_dense_col(out, j)[i];

            *g = sides->residual.count > 0 ? sides->residual.C[i + j * p] : 0.0;
            for (int64_t k = poles->num_rigid; k < poles->count; k++)
                *g += ritz_dense_col(&poles->io.C, k)[i] *
                      ritz_dense_col(&poles->io.B, j)[k] / poles->lambda[k];
        }
done:
    return status;
}

static ritz_status add_gain(const ritz_sides *sides, double limit,
                            ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense G = {0};
    double error = 0.0;

    RITZ_TRY(full_gain(sides, &G));
    RITZ_TRY(ritz_gain_error(&G, &sides->gain_reduced, &error));
    if (!isnan(error))
        RITZ_TRY(ritz_measures_add(out, "static-gain-relative", error, limit,
                                   "largest singular value"));
done:
    ritz_dense_free(&G);
    return status;
}

ritz_status ritz_sides_responses(const ritz_sides *sides,
                                 const ritz_verify_request *request,
                                 ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &sides->full.io;
    sweep s = {0};

    if (io->num_inputs == 0 || io->num_outputs == 0)
        return RITZ_OK;
    if (sides->band_hz[1] > sides->band_hz[0]) {
        RITZ_TRY(points(sides, &s));
        RITZ_TRY(evaluate(sides, &s));
        RITZ_TRY(add_response(sides, &s, request, out));
    }
    RITZ_TRY(add_gain(sides, request->limit_gain, out));
done:
    sweep_free(&s);
    return status;
}
