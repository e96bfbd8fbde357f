#include "response/krylov.h"

#include "base/alloc.h"
#include "response/responder.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EVEN = 12, MOST_MODES = 60 };

/* Of an answer's terms: what rounding leaves of it. */
static const double rounding = 1e-13;
/* Points keep this far off modes, of their frequency; and off 0 Hz, of the
   end. */
static const double beside = 1e-5;
static const double above_rest = 1e-4;
/* Of lambda_h: what lambda_h - w^2 is taken for at least. */
static const double least_gap = 0.02;

bool ritz_krylov_couples(const ritz_krylov *k)
{
    const ritz_component *c = k->full.component;

    return c->D.colptr || c->K4.colptr;
}

/* f, or beside it where a mode is. */
static double clear(const ritz_krylov *k, double f)
{
    for (int64_t j = 0; j < k->full.m; j++) {
        double mode = ritz_eigen_hertz(k->full.poles.lambda[j]);

        if (fabs(f - mode) < 0.1 * beside * f)
            return f * (1.0 + beside);
    }
    return f;
}

/* Even ones; where modes are coupled, each resonance and between them too. */
static ritz_status place(ritz_krylov *k, double low, double high)
{
    double before = low;
    int64_t m = k->full.m;
    int64_t stride = 1 + m / MOST_MODES;

    RITZ_CHECK_NEW(k->hertz, EVEN + 2 * m);
    for (int j = 0; j < EVEN; j++)
        k->hertz[k->count++] = clear(k, low + (high - low) * j / (EVEN - 1));
    k->num_even = k->count;
    for (int64_t j = 0; j < m && ritz_krylov_couples(k); j += stride) {
        double mode = ritz_eigen_hertz(k->full.poles.lambda[j]);

        if (mode <= low || mode >= high)
            continue;
        k->hertz[k->count++] = mode * (1.0 + beside);
        k->hertz[k->count++] = clear(k, 0.5 * (before + mode));
        before = mode;
    }
    return RITZ_OK;
}

static ritz_status make_room(ritz_krylov *k)
{
    RITZ_CHECK_NEW(k->size, k->inputs + k->outputs);
    RITZ_CHECK_NEW(k->load, k->inputs + k->outputs);
    RITZ_CHECK_NEW(k->error, k->count * k->values);
    RITZ_CHECK_NEW(k->trial, k->values);
    RITZ_CHECK_NEW(k->noise, k->values);
    RITZ_CHECK_NEW(k->peak, k->values);
    RITZ_CHECK_NEW(k->allowed, k->values);
    RITZ_CHECK_NEW(k->H, k->values);
    return RITZ_OK;
}

ritz_status ritz_krylov_place(ritz_krylov *k, double from_hz, double to_hz)
{
    RITZ_CHECK(place(k, fmax(from_hz, above_rest * to_hz), to_hz));
    return make_room(k);
}

/* Residual `index`, inputs before outputs, of what was solved last. */
void ritz_krylov_take(ritz_krylov *k, double hertz, int64_t index)
{
    bool dual = index >= k->inputs;

    ritz_krylov_residual(&k->full, &k->space, &k->small, hertz, dual,
                         dual ? index - k->inputs : index, k->y);
}

/* Sizes of all residuals at a point; of loads, of which they are the rest. */
ritz_status ritz_krylov_judge(ritz_krylov *k, double hertz, double *error)
{
    double w2 = ritz_eigen_lambda(hertz);
    double gap = fmax(k->lambda_h - w2, least_gap * k->lambda_h);
    double most = k->amplify * (k->lambda_h + k->space.tau) / gap;

    RITZ_CHECK(ritz_krylov_small_solve(&k->small, hertz));
    for (int64_t j = 0; j < k->inputs + k->outputs; j++) {
        ritz_krylov_take(k, hertz, j);
        k->size[j] = ritz_krylov_space_norm(&k->space, k->y);
        for (int64_t c = 0; c < k->space.W.ncol; c++)
            if (k->space.column[c].kind > RITZ_KRYLOV_CA)
                k->y[c] = 0.0;
        k->load[j] = fmax(k->load[j], ritz_krylov_space_norm(&k->space, k->y));
    }
    for (int64_t i = 0; i < k->outputs; i++)
        for (int64_t j = 0; j < k->inputs; j++)
            error[i * k->inputs + j] =
                most * k->size[k->inputs + i] * k->size[j];
    return RITZ_OK;
}

static ritz_status see_peaks(ritz_krylov *k, double hertz)
{
    memset(k->H, 0, (size_t)k->values * sizeof *k->H);
    RITZ_CHECK(ritz_poles_add(&k->small.poles, hertz, k->H));
    for (int64_t v = 0; v < k->values; v++)
        k->peak[v] = fmax(k->peak[v], cabs(k->H[v]));
    return RITZ_OK;
}

/* What each channel may err. */
static void allow(ritz_krylov *k)
{
    ritz_channel_scales(k->outputs, k->inputs, k->peak, k->allowed);
    for (int64_t i = 0; i < k->outputs; i++)
        for (int64_t j = 0; j < k->inputs; j++) {
            int64_t v = i * k->inputs + j;

            k->allowed[v] =
                k->tolerance * k->allowed[v] +
                rounding * (k->peak[v] + k->load[j] * k->load[k->inputs + i]);
        }
}

/* Every point: the worst of them, against what is allowed. */
ritz_status ritz_krylov_measure(ritz_krylov *k)
{
    free(k->y);
    RITZ_CHECK_NEW(k->y, k->space.W.ncol);
    for (int64_t c = 0; c < k->count; c++) {
        RITZ_CHECK(ritz_krylov_judge(k, k->hertz[c], k->error + c * k->values));
        if (c < k->num_even)
            RITZ_CHECK(see_peaks(k, k->hertz[c]));
    }
    allow(k);
    k->worst = 0.0;
    for (int64_t c = 0; c < k->count; c++)
        for (int64_t v = 0; v < k->values; v++) {
            double part = k->error[c * k->values + v];

            if (part > 0.0 && !(part <= k->worst * k->allowed[v])) {
                k->worst = part / k->allowed[v];
                k->at = c;
            }
        }
    k->unmet = k->worst;
    return RITZ_OK;
}
