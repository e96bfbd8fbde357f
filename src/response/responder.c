/*
 * What all engines share: the points of a grid, the rounding of responses,
 * names and damped poles.
 */
#include "response/responder.h"

#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "poles/poles.h"

#include <ritz/base.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * The frequencies at which a response is computed. A resonance of ratio zeta at
 * frequency f is 2 zeta f wide at half its power: an even grid steps over it as
 * soon as its own step is wider. With `refine` each gets its peak and points on
 * both sides that lie 1/4 to 8 widths away.
 */

/* In half-power widths. */
static const double beside[] = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
enum { BESIDE = sizeof beside / sizeof *beside, AROUND = 2 * BESIDE + 1 };
static const int64_t most_points = 100000000;

/* Given points must ascend, and none may be negative. */
static ritz_status check_points(const ritz_grid *grid)
{
    RITZ_REFUSE_IF(grid->count < 1, RITZ_ERR_ARGUMENT,
                   "a response needs at least one frequency");
    for (int64_t k = 0; k < grid->count; k++)
        RITZ_REFUSE_IF(!isfinite(grid->hertz[k]) || grid->hertz[k] < 0.0 ||
                           (k > 0 && grid->hertz[k] <= grid->hertz[k - 1]),
                       RITZ_ERR_ARGUMENT,
                       "frequencies do not ascend from 0 Hz at %g",
                       grid->hertz[k]);
    return RITZ_OK;
}

ritz_status ritz_grid_check(const ritz_grid *grid)
{
    if (grid->hertz)
        return check_points(grid);
    RITZ_REFUSE_IF(!isfinite(grid->from_hz) || !isfinite(grid->to_hz) ||
                       grid->from_hz < 0.0 || grid->from_hz >= grid->to_hz,
                   RITZ_ERR_ARGUMENT,
                   "a response from %g to %g Hz has no range", grid->from_hz,
                   grid->to_hz);
    RITZ_REFUSE_IF(grid->count < 2, RITZ_ERR_ARGUMENT,
                   "a response needs at least two frequencies");
    RITZ_REFUSE_IF(grid->count > most_points, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " frequencies are too many", grid->count);
    RITZ_REFUSE_IF(grid->log && !(grid->from_hz > 0.0), RITZ_ERR_ARGUMENT,
                   "a logarithmic grid cannot begin at 0 Hz");
    return RITZ_OK;
}

static double place_even(const ritz_grid *grid, int64_t k)
{
    double t = (double)k / (double)(grid->count - 1);

    if (grid->hertz)
        return grid->hertz[k];
    if (k == 0)
        return grid->from_hz;
    if (k == grid->count - 1)
        return grid->to_hz;
    return grid->log ? grid->from_hz * pow(grid->to_hz / grid->from_hz, t)
                     : grid->from_hz + t * (grid->to_hz - grid->from_hz);
}

/* Peak of 1/|w^2 - x^2 + 2 i zeta w x|, then the points on both sides of it. */
static void place_around(double omega, double zeta, double out[static AROUND])
{
    double f = omega / (2.0 * RITZ_PI);
    double peak = zeta < sqrt(0.5) ? f * sqrt(1.0 - 2.0 * zeta * zeta) : f;

    out[0] = peak;
    for (int k = 0; k < BESIDE; k++) {
        out[1 + 2 * k] = peak - beside[k] * 2.0 * zeta * f;
        out[2 + 2 * k] = peak + beside[k] * 2.0 * zeta * f;
    }
}

ritz_status ritz_grid_points(const ritz_grid *grid, int64_t num_modes,
                             const double *omega, const double *zeta,
                             int64_t *count, double **out)
{
    int64_t n = 0;
    RITZ_OWN_ARRAY double *f = NULL;
    double extra[AROUND];

    RITZ_CHECK(ritz_grid_check(grid));
    RITZ_CHECK_NEW(f, grid->count + (grid->refine ? num_modes * AROUND : 0));
    for (n = 0; n < grid->count; n++)
        f[n] = place_even(grid, n);
    for (int64_t k = 0; grid->refine && !grid->hertz && k < num_modes; k++) {
        if (!(omega[k] > 0.0 && zeta[k] > 0.0)) /* no width to resolve */
            continue;
        place_around(omega[k], zeta[k], extra);
        for (int a = 0; a < AROUND; a++)
            if (extra[a] >= grid->from_hz && extra[a] <= grid->to_hz)
                f[n++] = extra[a];
    }
    *count = grid->hertz ? n : ritz_sort_distinct(n, f, RITZ_SAME_POINT);
    RITZ_MOVE(*out, f);
    return RITZ_OK;
}

/* H of more values than this is a mistake in the request. */
static const int64_t most_values = INT64_C(1) << 31;

ritz_status ritz_response_new(const ritz_grid *grid, const ritz_poles *poles,
                              ritz_response *out)
{
    const ritz_io *io = &poles->io;
    RITZ_OWN(ritz_response)
    r = {.num_inputs = io->num_inputs, .num_outputs = io->num_outputs};
    RITZ_OWN_ARRAY double *omega = NULL, *zeta = NULL;

    RITZ_CHECK(ritz_poles_ratios(poles, &omega, &zeta));
    RITZ_CHECK(
        ritz_grid_points(grid, poles->count, omega, zeta, &r.count, &r.hertz));
    RITZ_REFUSE_IF(r.num_inputs * r.num_outputs >
                       most_values / (r.count > 0 ? r.count : 1),
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " frequencies of %" PRId64 " x %" PRId64
                   " responses are too many",
                   r.count, r.num_outputs, r.num_inputs);
    RITZ_CHECK_COPY(r.input, io->input, r.num_inputs);
    RITZ_CHECK_COPY(r.output, io->output, r.num_outputs);
    RITZ_CHECK_NEW(r.H, r.count * r.num_inputs * r.num_outputs);
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

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

/*
 * Of a component or a small dense model; otherwise {0}, with which no channel
 * counts as rounding.
 */
static ritz_status new_noise(const ritz_response_request *request,
                             ritz_noise *out)
{
    const ritz_io io = ritz_model_io(request->model);

    if (request->model.kind == RITZ_MODEL_STATES)
        return RITZ_OK;
    out->num_outputs = io.num_outputs;
    out->num_inputs = io.num_inputs;
    RITZ_CHECK_NEW(out->output, KINDS * io.num_outputs);
    RITZ_CHECK_NEW(out->input, io.num_inputs);
    measure_loads(request, &io, out);
    return RITZ_OK;
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

double ritz_response_highest(const ritz_response_request *request)
{
    const double usual = 3.0 * request->to_hz;

    if (request->model.kind == RITZ_MODEL_COMPONENT &&
        ritz_ratios_act_on_all(request->model.component,
                               request->model.damping))
        return fmax(request->up_to_hz, usual);
    return request->up_to_hz > 0.0 ? request->up_to_hz : usual;
}

ritz_status ritz_response_reach(const ritz_response_request *request)
{
    RITZ_REFUSE_IF(request->up_to_hz > 0.0 &&
                       request->up_to_hz < request->to_hz,
                   RITZ_ERR_ARGUMENT,
                   "modes up to %g Hz cannot give a response up to %g Hz: "
                   "raise --up-to-hz",
                   request->up_to_hz, request->to_hz);
    return RITZ_OK;
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

/* Remark if damping ratios act only on the modes that are summed, as for large
   components with D or K4. */
static void remark_ratios(const ritz_response_request *request,
                          ritz_responder *r)
{
    const size_t used = strlen(r->remark);

    if (!r->component || !ritz_damping_has_ratios(&r->given) ||
        ritz_ratios_act_on_all(r->component, &r->given))
        return;
    (void)snprintf(r->remark + used, sizeof r->remark - used,
                   "%sratios damp the modes up to %g Hz alone",
                   used > 0 ? "; " : "", ritz_response_highest(request));
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
    RITZ_REFUSE_IF(request->tolerance > 0.0 &&
                       r->uncertain > request->tolerance,
                   RITZ_ERR_CONVERGENCE,
                   "what ratios do to the modes above is known to %.1e of the "
                   "largest |H|, not %.1e: raise --up-to-hz",
                   r->uncertain, request->tolerance);
    remark_ratios(request, r);
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

void ritz_responder_free(ritz_responder **responder)
{
    ritz_responder *r = *responder;

    if (!r)
        return;
    if (r->state)
        r->free(r->state);
    RITZ_FREE(r->state, r->noise.output, r->noise.input, r);
    *responder = NULL;
}

double ritz_responder_uncertainty(const ritz_responder *responder)
{
    return responder->uncertain;
}

const char *ritz_responder_remark(const ritz_responder *responder)
{
    return responder->remark;
}

ritz_rounded ritz_responder_rounded(const ritz_responder *responder)
{
    return responder->rounded;
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

void ritz_responder_sign(const ritz_responder *responder, ritz_response *r)
{
    (void)snprintf(r->method, sizeof r->method, "%s", responder->engine->name);
    memcpy(r->damping, responder->damping, sizeof r->damping);
}

ritz_status ritz_responder_sample(ritz_responder *responder,
                                  const ritz_grid *grid, ritz_response *out)
{
    RITZ_OWN(ritz_response) r = {0};

    RITZ_CHECK(ritz_response_new(grid, responder->poles, &r));
    ritz_responder_sign(responder, &r);
    for (int64_t k = 0; k < r.count; k++) {
        RITZ_CHECK(ritz_responder_at(responder, r.hertz[k],
                                     r.H + k * r.num_outputs * r.num_inputs));
        ritz_monitor_step("response", k + 1, r.count);
    }
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

ritz_status ritz_spectrum_list(const ritz_spectrum *all, int64_t *count,
                               double _Complex **out)
{
    *count = all->count + all->num_zero; /* those at 0 behind */
    RITZ_CHECK_NEW(*out, *count);
    for (int64_t k = 0; k < all->count; k++)
        (*out)[k] = all->s[k];
    return RITZ_OK;
}

/* Poles of the full matrices, or else of the modal ones. */
static ritz_status list_coupled(const ritz_responder *r, int64_t *count,
                                double _Complex **out)
{
    const double band_hz[2] = {r->from_hz, r->to_hz};
    const ritz_span span = {.modes = -1,
                            .up_to_hz = RITZ_POLES_BEYOND * r->to_hz};
    RITZ_OWN(ritz_spectrum) own = {0};
    RITZ_OWN(ritz_damped) damped = {0};

    if (r->pairs)
        RITZ_CHECK(ritz_spectrum_of(
            ritz_model_of_component(r->component, &r->given), &span, &own));
    else
        RITZ_CHECK(ritz_damped_new(r->poles, NULL, NULL, band_hz, &damped));
    return ritz_spectrum_list(r->pairs ? &own : &damped.listing, count, out);
}

ritz_status ritz_poles_name(const ritz_io *io, ritz_poles *poles)
{
    ritz_io *to = &poles->io;
    int64_t n = poles->count;

    RITZ_CHECK(ritz_io_new(n, io->num_inputs, io->num_outputs, to));
    for (int64_t j = 0; j < io->num_inputs; j++)
        memcpy(to->input[j], io->input[j], sizeof *to->input);
    for (int64_t i = 0; i < io->num_outputs; i++)
        memcpy(to->output[i], io->output[i], sizeof *to->output);
    for (int64_t k = 0; k < n * io->num_inputs; k++)
        to->B.val[k] = 1.0;
    for (int64_t k = 0; k < n * io->num_outputs; k++)
        to->C.val[k] = 1.0;
    return RITZ_OK;
}

ritz_status ritz_responder_poles(const ritz_responder *responder,
                                 int64_t *count, double _Complex **out)
{
    const ritz_poles *poles = responder->poles;
    double _Complex *s = NULL;
    int64_t n = 0;

    if (poles->coupled && poles->D.val)
        return list_coupled(responder, count, out);
    RITZ_CHECK_NEW(s, 2 * poles->count);
    for (int64_t k = 0; k < poles->count; k++)
        if (ritz_poles_matter(poles, k)) {
            ritz_poles_roots(poles->lambda[k], poles->rate[k], s + n);
            n += cimag(s[n]) > 0.0 ? 1 : 2;
        }
    *count = n;
    *out = s;
    return RITZ_OK;
}
