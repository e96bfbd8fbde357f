/*
 * Margins of a loop: for L = F G of one signal, factors -1 / L where L is real
 * and negative, and the angle from L to -1 where |L| = 1; of every
 * loop the most of |L| and of |(I + L)^-1|.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/curve.h"
#include "response/responder.h"

#include <ritz/closed_loop.h>

#include <math.h>
#include <stdlib.h>

enum { MOST_HALVES = 60 };
/* A sign that changes through infinity is no crossing. */
static const double real_within = 1e-6;

typedef enum which { GAIN, SENSITIVITY } which;

typedef struct prober {
    const ritz_loop *loop;
    ritz_responder *plant, *controller;
    double _Complex *G, *F;
    which want;
    double *largest, *sensitivity; /* at the points */
    double _Complex *gain;
} prober;

static ritz_status probe(prober *s, double hertz, ritz_loop_values *values)
{
    const ritz_io *io = &s->plant->poles->io;

    RITZ_CHECK_IN("plant", ritz_responder_at(s->plant, hertz, s->G));
    RITZ_CHECK_IN("controller", ritz_responder_at(s->controller, hertz, s->F));
    return ritz_loop_at(s->loop, io->num_outputs, io->num_inputs, s->G, s->F,
                        NULL, values);
}

static ritz_status value_at(void *state, double hertz, double *value)
{
    prober *s = state;
    ritz_loop_values values = {0};

    RITZ_CHECK(probe(s, hertz, &values));
    *value = s->want == GAIN ? values.largest_gain : values.sensitivity;
    return RITZ_OK;
}

/* What is zero at a crossing: Im L, or |L| - 1. */
static double of_phase(double _Complex L)
{
    return cimag(L);
}

static double of_size(double _Complex L)
{
    return cabs(L) - 1.0;
}

static ritz_status bisect(prober *s, double (*zero)(double _Complex),
                          double low, double high, double _Complex at_low,
                          double *hertz, double _Complex *L)
{
    ritz_loop_values values = {.gain = at_low};
    double middle = low;

    for (int k = 0; k < MOST_HALVES && high - low > 1e-14 * high; k++) {
        middle = low + (high - low) / 2.0;
        RITZ_CHECK(probe(s, middle, &values));
        if (zero(values.gain) * zero(at_low) > 0.0)
            low = middle;
        else
            high = middle;
    }
    *hertz = middle;
    *L = values.gain;
    return RITZ_OK;
}

static void heed_gain(double hertz, double _Complex L, ritz_margins *out)
{
    double factor = -1.0 / creal(L);

    if (!(creal(L) < 0.0) || fabs(cimag(L)) > real_within * fabs(creal(L)))
        return;
    if (factor >= 1.0 && !(factor >= out->gain_up)) {
        out->gain_up = factor;
        out->gain_up_hz = hertz;
    }
    if (factor <= 1.0 && !(factor <= out->gain_down)) {
        out->gain_down = factor;
        out->gain_down_hz = hertz;
    }
}

static void heed_phase(double hertz, double _Complex L, ritz_margins *out)
{
    double angle = fabs(carg(-L)) * 180.0 / RITZ_PI;

    if (fabs(cabs(L) - 1.0) > real_within || angle >= out->phase)
        return;
    out->phase = angle;
    out->phase_hz = hertz;
}

static ritz_status cross(prober *s, int64_t count, const double *hertz,
                         ritz_margins *out)
{
    double at = 0.0;
    double _Complex L = 0.0;

    for (int64_t k = 0; k + 1 < count; k++) {
        double _Complex a = s->gain[k], b = s->gain[k + 1];

        if (of_phase(a) * of_phase(b) < 0.0) {
            RITZ_CHECK(bisect(s, of_phase, hertz[k], hertz[k + 1], a, &at, &L));
            heed_gain(at, L, out);
        }
        if (of_size(a) * of_size(b) < 0.0) {
            RITZ_CHECK(bisect(s, of_size, hertz[k], hertz[k + 1], a, &at, &L));
            heed_phase(at, L, out);
        }
    }
    return RITZ_OK;
}

static ritz_status find_peaks(prober *s, int64_t count, const double *hertz,
                              ritz_margins *out)
{
    const ritz_curve curve = {value_at, s};

    s->want = GAIN;
    RITZ_CHECK(ritz_curve_peak(count, hertz, s->largest, &curve, &out->gain_hz,
                               &out->gain));
    s->want = SENSITIVITY;
    return ritz_curve_peak(count, hertz, s->sensitivity, &curve,
                           &out->sensitivity_hz, &out->sensitivity);
}

ritz_status ritz_loop_margins(const ritz_loop *loop, ritz_responder *plant,
                              ritz_responder *controller, int64_t count,
                              const double *hertz, ritz_margins *out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &plant->poles->io;
    const double none = nan("");
    ritz_margins m = {none, none, none, none, HUGE_VAL,
                      none, none, none, none, none};
    prober s = {.loop = loop, .plant = plant, .controller = controller};

    RITZ_NEW(s.G, io->num_outputs * io->num_inputs);
    RITZ_NEW(s.F, loop->num_driven * loop->num_measured);
    RITZ_NEW(s.largest, count);
    RITZ_NEW(s.sensitivity, count);
    RITZ_NEW(s.gain, count);
    for (int64_t k = 0; k < count; k++) {
        ritz_loop_values values = {0};

        RITZ_TRY(probe(&s, hertz[k], &values));
        s.gain[k] = values.gain;
        s.largest[k] = values.largest_gain;
        s.sensitivity[k] = values.sensitivity;
    }
    if (count > 0)
        RITZ_TRY(find_peaks(&s, count, hertz, &m));
    if (loop->num_driven == 1 && loop->num_measured == 1)
        RITZ_TRY(cross(&s, count, hertz, &m));
    if (isinf(m.phase))
        m.phase = none;
    *out = m;
done:
    free(s.G);
    free(s.F);
    free(s.largest);
    free(s.sensitivity);
    free(s.gain);
    return status;
}
