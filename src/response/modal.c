/*
 * Response by modes: all modes of a small dense model; the lowest modes of a
 * full component, with the residual of the others.
 *
 * D and K4 damp the residual too, and couple it with the modes. The sum
 * neglects this unless D is a M + b K. The resulting error is measured: the
 * full matrices are factored at the resonances where the sum is largest, and at
 * some points between.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "response/direct.h"
#include "response/responder.h"

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* `pairs` and `residual` are those of a component, else empty. */
typedef struct modal_responder {
    ritz_pairs pairs;
    ritz_poles poles;
    ritz_residual residual;
} modal_responder;

static void free_modal(void *state)
{
    modal_responder *m = state;

    ritz_pairs_free(&m->pairs);
    ritz_poles_free(&m->poles);
    ritz_residual_free(&m->residual);
}

static ritz_status modal_at(void *state, double hertz, double _Complex *H)
{
    const modal_responder *m = state;

    RITZ_CHECK(ritz_poles_add(&m->poles, hertz, H));
    ritz_residual_add(&m->residual, hertz, H);
    return RITZ_OK;
}

/* Number of points of comparison between resonances, and at the largest
   resonances. */
enum { BETWEEN = 4, RESONANCES = 8 };

/* The comparison of the sum with the full matrices. */
typedef struct modal_comparison {
    int64_t values, count;     /* number of channels; number of points */
    double *hertz;             /* count, points between resonances first */
    double *size;              /* count x values, |H| of the sum */
    double *error;             /* count x values, |H - H_full| */
    double *peak, *level;      /* values; see ritz_noise_scales */
    double *scale;             /* values, magnitude that errors are relative
                                  to */
    double _Complex *H, *full; /* values, work space */
    int64_t compared;          /* number of points at which both responses are
                                  finite */
    double worst, at_hz;       /* largest error, relative to the largest |H| of
                                  its channel, and its frequency */
} modal_comparison;

static void modal_comparison_free(modal_comparison *c)
{
    RITZ_FREE(c->hertz, c->size, c->error, c->peak, c->level, c->scale, c->H,
              c->full);
}

static ritz_status modal_comparison_new(const modal_responder *m,
                                        modal_comparison *c)
{
    const int64_t most = BETWEEN + m->poles.count;

    c->values = m->poles.io.num_inputs * m->poles.io.num_outputs;
    RITZ_CHECK_NEW(c->hertz, most);
    RITZ_CHECK_NEW(c->size, most * c->values);
    RITZ_CHECK_NEW(c->error, most * c->values);
    RITZ_CHECK_NEW(c->peak, c->values);
    RITZ_CHECK_NEW(c->level, c->values);
    RITZ_CHECK_NEW(c->scale, c->values);
    RITZ_CHECK_NEW(c->H, c->values);
    RITZ_CHECK_NEW(c->full, c->values);
    return RITZ_OK;
}

/* Add a point of comparison with the sum of modes, unless the sum is infinite
   there. */
static ritz_status add_point(modal_responder *m, double hertz,
                             modal_comparison *c)
{
    ritz_status status = RITZ_OK;

    memset(c->H, 0, (size_t)c->values * sizeof *c->H);
    status = modal_at(m, hertz, c->H);
    if (status == RITZ_ERR_SINGULAR)
        return RITZ_OK;
    RITZ_CHECK(status);
    for (int64_t v = 0; v < c->values; v++) {
        c->size[c->count * c->values + v] = cabs(c->H[v]);
        c->peak[v] = fmax(c->peak[v], cabs(c->H[v]));
    }
    c->hertz[c->count++] = hertz;
    return RITZ_OK;
}

/* Largest |H| at a point, relative to the peak of its channel. */
static double size_point(const modal_comparison *c, int64_t point)
{
    double size = 0.0;

    for (int64_t v = 0; v < c->values; v++)
        if (c->peak[v] > 0.0)
            size = fmax(size, c->size[point * c->values + v] / c->peak[v]);
    return size;
}

static void swap_reals(double *a, double *b)
{
    const double was = *a;

    *a = *b;
    *b = was;
}

/* Keep the largest of the points from the first resonance on. */
static ritz_status keep_largest(int64_t first, modal_comparison *c)
{
    const int64_t most = first + RESONANCES;
    RITZ_OWN_ARRAY double *size = NULL;

    RITZ_CHECK_NEW(size, c->count);
    for (int64_t k = first; k < c->count; k++)
        size[k] = size_point(c, k);
    for (int64_t k = first; k < c->count && k < most; k++) {
        int64_t largest = k;

        for (int64_t j = k + 1; j < c->count; j++)
            largest = size[j] > RITZ_TIE * size[largest] ? j : largest;
        swap_reals(&c->hertz[k], &c->hertz[largest]);
        swap_reals(&size[k], &size[largest]);
    }
    c->count = c->count < most ? c->count : most;
    return RITZ_OK;
}

/* Points between resonances, and the largest resonances of all channels. */
static ritz_status place_points(const ritz_response_request *request,
                                modal_responder *m, modal_comparison *c)
{
    const double from = request->from_hz, range = request->to_hz - from;
    int64_t first = 0;

    for (int k = 0; k < BETWEEN; k++)
        RITZ_CHECK(add_point(m, from + (k + 0.5) / BETWEEN * range, c));
    first = c->count;
    for (int64_t k = m->poles.num_rigid; k < m->poles.count; k++) {
        double hertz = ritz_eigen_hertz(m->poles.lambda[k]);

        if (hertz >= from && hertz <= request->to_hz)
            RITZ_CHECK(add_point(m, hertz, c));
    }
    return keep_largest(first, c);
}

/* |H - H_full| at each point; 0 where the full response is infinite. */
static ritz_status compare_points(modal_responder *m, const ritz_noise *noise,
                                  ritz_direct *direct, modal_comparison *c)
{
    memset(c->peak, 0, (size_t)c->values * sizeof *c->peak);
    for (int64_t k = 0; k < c->count; k++) {
        ritz_status status = RITZ_OK;

        memset(c->H, 0, (size_t)c->values * sizeof *c->H);
        memset(c->full, 0, (size_t)c->values * sizeof *c->full);
        RITZ_CHECK(modal_at(m, c->hertz[k], c->H));
        status = ritz_direct_at(direct, c->hertz[k], c->full);
        if (status == RITZ_ERR_SINGULAR)
            continue;
        RITZ_CHECK(status);
        c->compared++;
        ritz_noise_heed(noise, c->hertz[k], c->full, c->level);
        for (int64_t v = 0; v < c->values; v++) {
            c->peak[v] = fmax(c->peak[v], cabs(c->full[v]));
            c->error[k * c->values + v] = cabs(c->H[v] - c->full[v]);
        }
    }
    return RITZ_OK;
}

/* Largest error, relative to the largest |H| of its channel. */
static ritz_status measure_error(const ritz_response_request *request,
                                 const ritz_noise *noise, modal_responder *m,
                                 modal_comparison *c)
{
    const double tolerance =
        request->tolerance > 0.0 ? request->tolerance : RITZ_ENGINE_TOLERANCE;
    const ritz_model *model = &request->model;
    RITZ_OWN(ritz_direct) direct = {0};

    RITZ_CHECK(modal_comparison_new(m, c));
    RITZ_CHECK(place_points(request, m, c));
    RITZ_CHECK_IN("comparison with the full matrices",
                  ritz_direct_new(model->component, model->damping,
                                  ritz_response_highest(request), &direct));
    RITZ_CHECK(compare_points(m, noise, &direct, c));
    ritz_noise_scales(m->poles.io.num_outputs, m->poles.io.num_inputs,
                      tolerance, c->peak, c->level, c->scale);
    for (int64_t e = 0; e < c->count * c->values; e++) {
        double scale = c->scale[e % c->values];

        if (scale > 0.0 && c->error[e] > c->worst * scale) {
            c->worst = c->error[e] / scale;
            c->at_hz = c->hertz[e / c->values];
        }
    }
    return RITZ_OK;
}

/* Remark on the error of the sum, and refuse it if it exceeds the tolerance. */
static ritz_status judge_sum(const ritz_response_request *request,
                             modal_responder *m, ritz_responder *out)
{
    const double highest = ritz_response_highest(request);
    const double allowed = request->tolerance;
    RITZ_OWN(modal_comparison) c = {0};

    RITZ_CHECK(measure_error(request, &out->noise, m, &c));
    RITZ_REFUSE_IF(allowed > 0.0 && c.compared == 0, RITZ_ERR_CONVERGENCE,
                   "modes above %g Hz are summed undamped, which makes an "
                   "error that is not known",
                   highest);
    RITZ_REFUSE_IF(allowed > 0.0 && !(c.worst <= allowed), RITZ_ERR_CONVERGENCE,
                   "modes above %g Hz are summed undamped: off by %.1e of the "
                   "largest |H| at %.6g Hz, not %.1e",
                   highest, c.worst, c.at_hz, allowed);
    if (c.compared == 0)
        (void)snprintf(out->remark, sizeof out->remark,
                       "modes above %g Hz are summed undamped, which makes an "
                       "error that is not known",
                       highest);
    else
        (void)snprintf(out->remark, sizeof out->remark,
                       "modes above %g Hz are summed undamped: off by %.1e of "
                       "the largest |H| at %.6g Hz, the worst of %" PRId64
                       " frequencies that were compared with direct",
                       highest, c.worst, c.at_hz, c.compared);
    return RITZ_OK;
}

static ritz_status make_modal(const ritz_response_request *request,
                              ritz_responder *out)
{
    const ritz_model *model = &request->model;
    double highest = ritz_response_highest(request);
    modal_responder *m = NULL;

    RITZ_CHECK_NEW(m, 1);
    out->state = m;
    out->free = free_modal;
    out->poles = &m->poles;
    out->at = modal_at;
    if (model->kind != RITZ_MODEL_COMPONENT)
        return ritz_poles_of_dense(&model->dense, model->damping,
                                   request->to_hz, &m->poles);
    RITZ_CHECK(ritz_response_reach(request));
    RITZ_CHECK(ritz_poles_of_component(model->component, model->damping,
                                       highest, &m->pairs, &m->poles));
    RITZ_CHECK(
        ritz_rounded_of(model->component, &m->pairs, false, &out->rounded));
    RITZ_CHECK(ritz_residual_new(model->component, model->damping, &m->pairs,
                                 request->to_hz, highest, &m->residual));
    out->uncertain = m->residual.uncertain;
    return m->residual.known ? RITZ_OK : judge_sum(request, m, out);
}

const ritz_response_engine ritz_response_engine_modal = {
    .name = "modal",
    .summary = "a sum of modes, and of a component the series of the rest",
    .reference = "Sirlin1992",
    .when = "reduced components and systems; components with damping ratios",
    .cost = "the modes; then O(modes) a point, O(modes^3) where D or K4 "
            "couples them; for a component with these also a dozen factors",
    .holds = "exact for dense models; of components without K4, and with no D "
             "but a M + b K, to 1e-12; ratios damp all modes, beyond 2000 "
             "dofs to an uncertainty that is stated",
    .fails = "of components, K4 and any other D act on the modes that are "
             "summed alone: the error is measured, and direct takes over where "
             "it exceeds the tolerance",
    .takes = (int)RITZ_MODEL_COMPONENT | (int)RITZ_MODEL_DENSE,
    .make = make_modal,
};
