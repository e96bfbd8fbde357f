
#include "response/responder.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "poles/damped.h"

#include <ritz/base.h>

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KINDS = 3 };

/* (K + tau M)_kk */
static double shifted_diagonal(const ritz_response_request *request, double tau,
                               int64_t k)
{
    const ritz_component *c = request->model.component;
    const ritz_second_order *m = &request->model.dense;

    if (request->model.kind == RITZ_MODEL_COMPONENT)
        return ritz_sparse_diagonal(&c->K, k) +
               tau * ritz_sparse_diagonal(&c->M, k);
    return ritz_dense_col(m->K, k)[k] + tau * ritz_dense_col(m->M, k)[k];
}

static void measure_loads(const ritz_response_request *request,
                          const ritz_io *io, ritz_noise *noise)
{
    const ritz_dense *const rows[KINDS] = {&io->C, &io->Cv, &io->Ca};
    double tau = ritz_eigen_lambda(request->to_hz);
    int64_t p = io->num_outputs;

    for (int64_t k = 0; k < io->B.nrow; k++) {
        double d = shifted_diagonal(request, tau, k);
        double unit = d > 0.0 ? 1.0 / sqrt(d) : 0.0;

        for (int64_t i = 0; i < KINDS * p; i++)
            noise->output[i] = hypot(
                noise->output[i], unit * ritz_dense_col(rows[i / p], k)[i % p]);
        for (int64_t j = 0; j < io->num_inputs; j++)
            noise->input[j] =
                hypot(noise->input[j], unit * ritz_dense_col(&io->B, j)[k]);
    }
}

static void free_noise(ritz_noise *noise)
{
    free(noise->output);
    free(noise->input);
    *noise = (ritz_noise){0};
}

/*
 * Of a component or a small dense model; otherwise {0}, with which no channel
 * counts as rounding.
 */
static ritz_status new_noise(const ritz_response_request *request,
                             ritz_noise *out)
{
    ritz_status status = RITZ_OK;
    const ritz_model *model = &request->model;
    const ritz_io *io = model->kind == RITZ_MODEL_COMPONENT
                            ? &model->component->io
                            : model->dense.io;
    ritz_noise noise = {0};

    if (model->kind == RITZ_MODEL_STATES)
        return RITZ_OK;
    noise.num_outputs = io->num_outputs;
    noise.num_inputs = io->num_inputs;
    RITZ_NEW(noise.output, KINDS * io->num_outputs);
    RITZ_NEW(noise.input, io->num_inputs);
    measure_loads(request, io, &noise);
    RITZ_MOVE(*out, noise);
done:
    free_noise(&noise);
    return status;
}

/* |c_i + i w cv_i - w^2 ca_i|, or an upper bound that is a little larger. */
static double output_size(const ritz_noise *noise, double w, int64_t i)
{
    const double *size = noise->output;
    int64_t p = noise->num_outputs;

    return size[i] + w * size[p + i] + w * w * size[2 * p + i];
}

void ritz_noise_heed(const ritz_noise *noise, double hertz,
                     const double _Complex *H, double *level)
{
    double w = 2.0 * RITZ_PI * hertz;
    int64_t p = noise->num_outputs;
    int64_t m = noise->num_inputs;
    double gain = 0.0;

    if (!noise->output)
        return;
    for (int64_t i = 0; i < p; i++)
        for (int64_t j = 0; j < m; j++) {
            double size = output_size(noise, w, i) * noise->input[j];

            if (size > 0.0)
                gain = fmax(gain, cabs(H[i * m + j]) / size);
        }
    for (int64_t i = 0; i < p; i++)
        for (int64_t j = 0; j < m; j++)
            level[i * m + j] =
                fmax(level[i * m + j],
                     gain * output_size(noise, w, i) * noise->input[j]);
}

void ritz_noise_scales(int64_t num_outputs, int64_t num_inputs,
                       double tolerance, const double *peak,
                       const double *level, double *scale)
{
    int64_t values = num_outputs * num_inputs;

    ritz_channel_scales(num_outputs, num_inputs, peak, scale);
    for (int64_t v = 0; v < values; v++) {
        double least = RITZ_NEGLIGIBLE * level[v];

        if (peak[v] <= least)
            scale[v] = fmax(scale[v], least / tolerance);
        else
            scale[v] += RITZ_RESPONSE_GRAIN * level[v] / tolerance;
    }
}

/* What all engines share: the points of a grid, names, damped poles. */

double ritz_response_highest(const ritz_response_request *request)
{
    return request->up_to_hz > 0.0 ? request->up_to_hz : 3.0 * request->to_hz;
}

/* The highest frequency of a grid of any kind. */
double ritz_grid_end(const ritz_grid *grid)
{
    return grid->hertz && grid->count > 0 ? grid->hertz[grid->count - 1]
                                          : grid->to_hz;
}

static ritz_status check_needs(const ritz_response_engine *engine,
                               const ritz_response_request *request)
{
    static const char *const nouns[] = {
        [RITZ_MODEL_COMPONENT] = "a component",
        [RITZ_MODEL_DENSE] = "a small dense model",
        [RITZ_MODEL_STATES] = "a state space",
    };
    ritz_model_kind kind = request->model.kind;

    RITZ_REFUSE_IF(!(engine->takes & (int)kind), RITZ_ERR_ARGUMENT,
                   "%s is not for %s", engine->name, nouns[kind]);
    RITZ_REFUSE_IF(
        !isfinite(request->from_hz) || !isfinite(request->to_hz) ||
            request->from_hz < 0.0 || request->to_hz < request->from_hz,
        RITZ_ERR_ARGUMENT, "a response from %g to %g Hz has no range",
        request->from_hz, request->to_hz);
    return RITZ_OK;
}

ritz_status ritz_responder_new(const ritz_response_engine *engine,
                               const ritz_response_request *request,
                               ritz_responder **out)
{
    RITZ_OWN(ritz_responder) *r = NULL;

    RITZ_CHECK(check_needs(engine, request));
    RITZ_CHECK_NEW(r, 1);
    r->engine = engine;
    if (request->model.kind == RITZ_MODEL_COMPONENT)
        r->component = request->model.component;
    r->from_hz = request->from_hz;
    r->to_hz = request->to_hz;
    if (request->model.damping)
        r->given = *request->model.damping;
    ritz_damping_print(&r->given, r->damping);
    RITZ_CHECK(new_noise(request, &r->noise));
    RITZ_CHECK(engine->make(request, r));
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

void ritz_responder_free(ritz_responder **responder)
{
    if (!*responder)
        return;
    if ((*responder)->state)
        (*responder)->free((*responder)->state);
    free_noise(&(*responder)->noise);
    free(*responder);
    *responder = NULL;
}

const char *ritz_responder_remark(const ritz_responder *responder)
{
    return responder->remark;
}

ritz_status ritz_responder_at(ritz_responder *responder, double hertz,
                              double _Complex *H)
{
    const ritz_io *io = &responder->poles->io;

    RITZ_REFUSE_IF(responder->component &&
                       !(hertz <= responder->to_hz * RITZ_RANGE_END),
                   RITZ_ERR_ARGUMENT,
                   "%g Hz lies above %g Hz, up to which the response was "
                   "prepared",
                   hertz, responder->to_hz);
    for (int64_t k = 0; k < io->num_outputs * io->num_inputs; k++)
        H[k] = 0.0;
    return responder->at(responder->state, hertz, H);
}

ritz_status ritz_responder_sample(ritz_responder *responder,
                                  const ritz_grid *grid, ritz_response *out)
{
    RITZ_OWN(ritz_response) r = {0};

    RITZ_CHECK(ritz_response_new(grid, responder->poles,
                                 responder->engine->name, NULL, &r));
    memcpy(r.damping, responder->damping, sizeof r.damping);
    for (int64_t k = 0; k < r.count; k++) {
        RITZ_CHECK(ritz_responder_at(responder, r.hertz[k],
                                     r.H + k * r.num_outputs * r.num_inputs));
        ritz_monitor_step("response", k + 1, r.count);
    }
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

/* Both roots of s^2 + rate s + lambda, the conjugate of a pair left out. */
static void add_roots(double lambda, double rate, int64_t *count,
                      double _Complex *s)
{
    double half = 0.5 * rate;
    double gap = lambda - half * half;

    if (gap > 0.0) {
        s[(*count)++] = ritz_complex(-half, sqrt(gap));
        return;
    }
    s[(*count)++] = -(half + sqrt(-gap));
    s[*count] = s[*count - 1] != 0.0 ? lambda / s[*count - 1] : 0.0;
    (*count)++;
}

/* Poles of the full matrices, or else of the modal ones. */
static ritz_status add_coupled(const ritz_responder *r, int64_t *count,
                               double _Complex **out)
{
    const double band_hz[2] = {r->from_hz, r->to_hz};
    const ritz_span span = {.modes = -1,
                            .up_to_hz = RITZ_POLES_BEYOND * r->to_hz};
    ritz_status status = RITZ_OK;
    ritz_spectrum own = {0};
    ritz_damped damped = {0};
    const ritz_spectrum *all = r->pairs ? &own : &damped.listing;
    double _Complex *s = NULL;
    int64_t n = 0;

    if (r->pairs)
        RITZ_TRY(ritz_spectrum_of(
            ritz_model_of_component(r->component, &r->given), &span, &own));
    else
        RITZ_TRY(ritz_damped_new(r->poles, NULL, NULL, band_hz, &damped));
    RITZ_NEW(s, all->count + all->num_zero);
    for (int64_t k = 0; k < all->count; k++)
        s[n++] = all->s[k];
    for (int64_t k = 0; k < all->num_zero; k++)
        s[n++] = 0.0;
    *count = n;
    RITZ_MOVE(*out, s);
done:
    free(s);
    ritz_spectrum_free(&own);
    ritz_damped_free(&damped);
    return status;
}

ritz_status ritz_responder_poles(const ritz_responder *responder,
                                 int64_t *count, double _Complex **out)
{
    const ritz_poles *poles = responder->poles;
    double _Complex *s = NULL;
    int64_t n = 0;

    if (poles->coupled && poles->D.val)
        return add_coupled(responder, count, out);
    RITZ_CHECK_NEW(s, 2 * poles->count);
    for (int64_t k = 0; k < poles->count; k++)
        if (ritz_poles_matter(poles, k))
            add_roots(poles->lambda[k], poles->rate[k], &n, s);
    *count = n;
    *out = s;
    return RITZ_OK;
}

void ritz_channel_scales(int64_t num_outputs, int64_t num_inputs,
                         const double *peak, double *scale)
{
    for (int64_t i = 0; i < num_outputs; i++)
        for (int64_t j = 0; j < num_inputs; j++) {
            double row = 0.0, column = 0.0;

            for (int64_t k = 0; k < num_inputs; k++)
                row = fmax(row, peak[i * num_inputs + k]);
            for (int64_t k = 0; k < num_outputs; k++)
                column = fmax(column, peak[k * num_inputs + j]);
            scale[i * num_inputs + j] =
                fmax(peak[i * num_inputs + j],
                     RITZ_CHANNEL_LEAST * sqrt(row * column));
        }
}
