/* The rational engine: nodes are chosen until the interpolant of interpolant.h
   changes nowhere. */
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "model/modal.h"
#include "model/space.h"
#include "poles/poles.h"
#include "response/direct.h"
#include "response/interpolant.h"
#include "response/responder.h"
#include "response/state_poles.h"

#include <ritz/base.h>
#include <ritz/poles.h>

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct rational_nodes {
    ritz_direct full;               /* if the model is a component */
    const ritz_state_space *states; /* borrowed; NULL: the model is a
                                       component */
    ritz_pencil pencil;             /* of the state space */
    ritz_poles listed;              /* poles of the state space, to refine grids
                                       around */
    int64_t outputs, inputs;
    ritz_interpolant f;
    int64_t num_poles;
    double _Complex *pole; /* all, conjugates too */
    bool mirror;           /* nodes count at -i w too */
    int64_t values;
    int64_t count; /* of candidates */
    double *hertz;
    bool *used;
    bool *with_zeros;        /* values: which of the two errs less */
    double *missed;          /* 2 x values: largest error at last nodes */
    double *miss;            /* 2 x values, for each of those */
    const ritz_noise *noise; /* of the responder */
    double *peak, *level, *scale;
    double _Complex *H, *guess, *other;
    double _Complex *before; /* count x values: interpolants before the last
                                node was added */
    int64_t nodes;
    bool small;         /* `whole` holds the model */
    ritz_reduced whole; /* of which `view` is a view, with inputs and outputs */
    ritz_second_order view;
} rational_nodes;

/*
 * The frequencies where nodes may be, the choice of the next, and the end of
 * the search.
 */

/* The search ends when ENOUGH nodes in a row are within the tolerance. */
enum { ENOUGH = 3 };
enum { EVEN = 1000, BETWEEN = 16, MOST_NODES = 300, OFFSETS = 3, SWEPT = 500 };

/* Distance of a candidate from its pole, in half-power widths. */
static const double offset[OFFSETS] = {1.0, 4.0, 16.0};

/* H by the more accurate of the two interpolants of each channel. */
static void evaluate_best(rational_nodes *s, double hertz, double _Complex *H)
{
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);

    ritz_interpolant_at(&s->f, at, false, s->guess);
    ritz_interpolant_at(&s->f, at, true, s->other);
    for (int64_t v = 0; v < s->values; v++)
        H[v] = s->with_zeros[v] ? s->other[v] : s->guess[v];
}

static ritz_status rational_at(void *state, double hertz, double _Complex *H)
{
    rational_nodes *s = state;
    double w = 2.0 * RITZ_PI * hertz;
    const double _Complex at = ritz_complex(0.0, w);

    /* at an undamped pole that was cancelled there is no response */
    for (int64_t k = 0; k < s->num_poles; k++)
        if (cabs(at - s->pole[k]) <= RITZ_POLE_HIT * (w + cabs(s->pole[k])))
            return ritz_refuse_pole(s->pole[k] == 0.0, hertz);
    evaluate_best(s, hertz, H);
    return RITZ_OK;
}

/* Whether s is one of some points, up to rounding. */
static bool is_near(double _Complex s, int64_t count, const double _Complex *at,
                    double unit)
{
    for (int64_t k = 0; k < count; k++)
        if (cabs(s - at[k] * unit) <= RITZ_NODE_CLEAR * cabs(s))
            return true;
    return false;
}

/* A frequency where a node may be: at no pole and no zero. */
static void add_candidate(rational_nodes *s, double hertz, double low,
                          double high)
{
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);
    bool on = !(hertz >= low && hertz <= high) ||
              is_near(at, s->num_poles, s->pole, 1.0);

    for (int64_t v = 0; v < s->values; v++)
        on = on || is_near(at, s->f.num_zeros[v], s->f.zero[v], s->f.unit);
    if (!on)
        s->hertz[s->count++] = hertz;
}

/*
 * Candidates next to resonances, between them, and dense towards both ends of
 * the range, where Leja points gather.
 */
static ritz_status place_nodes(rational_nodes *s, double low, double high)
{
    RITZ_OWN_ARRAY double *at = NULL;
    int64_t n = 0;

    RITZ_CHECK_NEW(at, s->num_poles + 2);
    RITZ_CHECK_NEW(s->hertz,
                   EVEN + (s->num_poles + 2) * (BETWEEN + 1 + 2 * OFFSETS));
    for (int k = 1; k < EVEN; k++)
        add_candidate(
            s, 0.5 * (low + high - (high - low) * cos(RITZ_PI * k / EVEN)), low,
            high);
    at[n++] = low;
    at[n++] = high;
    for (int64_t k = 0; k < s->num_poles; k++) {
        double hertz = cimag(s->pole[k]) / (2.0 * RITZ_PI);
        double width = -creal(s->pole[k]) / (2.0 * RITZ_PI);

        if (hertz <= low || hertz >= high)
            continue;
        at[n++] = hertz;
        width = fmax(width, RITZ_BESIDE_POLE * hertz);
        for (int o = 0; o < OFFSETS; o++) {
            add_candidate(s, hertz - offset[o] * width, low, high);
            add_candidate(s, hertz + offset[o] * width, low, high);
        }
    }
    qsort(at, (size_t)n, sizeof *at, ritz_ascending);
    for (int64_t k = 0; k + 1 < n; k++)
        for (int part = 0; part <= BETWEEN; part++)
            if (part < BETWEEN || k + 2 == n)
                add_candidate(s, at[k] + (at[k + 1] - at[k]) * part / BETWEEN,
                              low, high);
    RITZ_CHECK_NEW(s->used, s->count);
    RITZ_CHECK_NEW(s->before, s->count * s->values);
    return RITZ_OK;
}

/* The candidate where a node helps most, -1 if none is left. */
static int64_t find_next(const rational_nodes *s)
{
    double most = -HUGE_VAL;
    int64_t best = -1;

    for (int64_t k = 0; k < s->count; k++) {
        double w = 2.0 * RITZ_PI * s->hertz[k];
        double need = s->used[k]
                          ? -HUGE_VAL
                          : ritz_interpolant_need(&s->f, ritz_complex(0.0, w));

        if (need > most) {
            most = need;
            best = k;
        }
    }
    return best;
}

static ritz_status add_node(rational_nodes *s, double hertz)
{
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);

    RITZ_CHECK(ritz_interpolant_append(&s->f, at, s->H));
    s->nodes++;
    if (!s->mirror || hertz == 0.0)
        return RITZ_OK;
    for (int64_t v = 0; v < s->values; v++)
        s->H[v] = conj(s->H[v]);
    return ritz_interpolant_append(&s->f, -at, s->H);
}

/*
 * Errors without and with zeros at a new node; whether one is within the
 * tolerance.
 */
static bool measure_node(rational_nodes *s, double hertz, double tolerance)
{
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);
    double *miss = s->miss + s->nodes % ENOUGH * 2 * s->values;
    bool near = s->nodes >= ENOUGH;

    ritz_interpolant_at(&s->f, at, false, s->guess);
    ritz_interpolant_at(&s->f, at, true, s->other);
    for (int64_t v = 0; v < s->values; v++)
        s->peak[v] = fmax(s->peak[v], cabs(s->H[v]));
    ritz_noise_heed(s->noise, hertz, s->H, s->level);
    ritz_noise_scales(s->outputs, s->inputs, tolerance, s->peak, s->level,
                      s->scale);
    for (int64_t v = 0; v < s->values; v++) {
        miss[v] = cabs(s->guess[v] - s->H[v]);
        miss[s->values + v] = cabs(s->other[v] - s->H[v]);
    }
    for (int64_t k = 0; k < 2 * s->values; k++) {
        s->missed[k] = 0.0;
        for (int64_t t = 0; t < ENOUGH; t++)
            s->missed[k] = fmax(s->missed[k], s->miss[t * 2 * s->values + k]);
    }
    for (int64_t v = 0; v < s->values; v++) {
        s->with_zeros[v] = s->missed[s->values + v] < s->missed[v];
        near = near && fmin(s->missed[v], s->missed[s->values + v]) <=
                           tolerance * s->scale[v];
    }
    return near;
}

/*
 * The candidate at which the interpolants without and with zeros differ most,
 * over the channels that use the latter; -1: none.
 */
static int64_t find_doubtful(rational_nodes *s)
{
    double most = 0.0;
    int64_t doubtful = -1;

    for (int64_t k = 0; k < s->count; k++) {
        if (s->used[k])
            continue;
        evaluate_best(s, s->hertz[k], s->H);
        for (int64_t v = 0; v < s->values; v++) {
            double gap = cabs(s->guess[v] - s->other[v]);

            if (!s->with_zeros[v] || gap <= most * s->scale[v])
                continue;
            most = gap / s->scale[v];
            doubtful = k;
        }
    }
    return doubtful;
}

/* H of the full model at a frequency. */
static ritz_status respond_full(rational_nodes *s, double hertz)
{
    const double _Complex at = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);

    memset(s->H, 0, (size_t)s->values * sizeof *s->H);
    if (!s->states)
        return ritz_direct_at(&s->full, hertz, s->H);
    return ritz_space_transfer(s->states, &s->pencil, at, s->H);
}

/* Store the interpolants at candidates before another node is added. */
static void keep_candidates(rational_nodes *s)
{
    for (int64_t k = 0; k < s->count; k += s->count / SWEPT + 1)
        if (!s->used[k])
            evaluate_best(s, s->hertz[k], s->before + k * s->values);
}

/*
 * The candidate at which the last node changed the interpolant most; -1 if no
 * change exceeds the tolerance. A node that is accurate shows nothing about the
 * error between other nodes.
 */
static int64_t find_changed(rational_nodes *s, double tolerance)
{
    double most = tolerance;
    int64_t changed = -1;

    for (int64_t k = 0; k < s->count; k += s->count / SWEPT + 1) {
        const double _Complex *before = s->before + k * s->values;

        if (!s->used[k])
            evaluate_best(s, s->hertz[k], s->H);
        for (int64_t v = 0; !s->used[k] && v < s->values; v++)
            if (cabs(s->H[v] - before[v]) > most * s->scale[v]) {
                most = cabs(s->H[v] - before[v]) / s->scale[v];
                changed = k;
            }
    }
    return changed;
}

/* Measure the errors of both interpolants at candidate k, then add it as a
   node. */
static ritz_status take_candidate(rational_nodes *s, int64_t k,
                                  double tolerance, bool *near)
{
    ritz_status status = RITZ_OK;

    s->used[k] = true;
    status = respond_full(s, s->hertz[k]);
    if (status == RITZ_ERR_SINGULAR && s->states)
        return RITZ_OK; /* an unknown pole: there is no response */
    RITZ_CHECK(status);
    *near = measure_node(s, s->hertz[k], tolerance);
    if (*near)
        keep_candidates(s);
    RITZ_CHECK(add_node(s, s->hertz[k]));
    ritz_monitor_step("nodes", s->nodes, 0);
    return RITZ_OK;
}

/*
 * Add nodes until the errors at the last ones are within the tolerance. Nodes
 * are placed where the error of the interpolant without zeros is expected to be
 * largest. If zeros are known to a few digits only, the other interpolant errs
 * elsewhere, so a node is also placed where the two differ most. Finally, the
 * last node must have changed the interpolant nowhere.
 */
static ritz_status converge_nodes(rational_nodes *s, double tolerance)
{
    bool near = false;
    int64_t changed = -1;

    while (!near || changed >= 0) {
        int64_t k = changed >= 0 ? changed : find_next(s);

        RITZ_REFUSE_IF(k < 0 || s->nodes >= MOST_NODES, RITZ_ERR_CONVERGENCE,
                       "%" PRId64 " nodes do not interpolate to %.1e of the "
                       "largest response: krylov may",
                       s->nodes, tolerance);
        RITZ_CHECK(take_candidate(s, k, tolerance, &near));
        k = near ? find_doubtful(s) : -1;
        if (k >= 0)
            RITZ_CHECK(take_candidate(s, k, tolerance, &near));
        changed = near ? find_changed(s, tolerance) : -1;
    }
    return RITZ_OK;
}

/* Poles and, for small components, zeros to cancel. */

/*
 * A pole that is in the list already is added once more, but not a third time:
 * 0 is a double pole, and two equal modes that are slightly coupled are
 * observable through both.
 */
static void add_pole(rational_nodes *s, double _Complex pole)
{
    int64_t there = 0;

    for (int64_t k = 0; k < s->num_poles; k++)
        there += cabs(s->pole[k] - pole) <= RITZ_SAME * cabs(pole);
    if (there < 2)
        s->pole[s->num_poles++] = pole;
}

/*
 * A small component as a dense model; damping ratios enter D through the modes.
 */
static ritz_status project_whole(rational_nodes *s)
{
    const ritz_direct *full = &s->full;
    ritz_dense *D = &s->whole.D;
    RITZ_OWN(ritz_dense) given = {0};

    RITZ_CHECK(ritz_whole_new(full->component, &s->whole));
    s->view = ritz_model_of_reduced(&s->whole, NULL).dense;
    s->view.io = &full->component->io;
    s->small = true;
    if (!full->ratios)
        return RITZ_OK;
    RITZ_CHECK(ritz_matrix_of_ratios(full->component, &full->damping,
                                     full->up_to_hz, &given));
    if (!D->val)
        RITZ_CHECK(ritz_dense_new(full->n, full->n, D));
    ritz_dense_add(1.0, &given, D);
    return RITZ_OK;
}

/* Damping that acts in addition to that model's D. */
static const ritz_damping *remaining_damping(const rational_nodes *s)
{
    return s->full.ratios ? NULL : &s->full.damping;
}

/*
 * The poles as the responder knows them; those of a small coupled component by
 * its dense model.
 */
static ritz_status list_poles(const rational_nodes *s,
                              const ritz_responder *responder, int64_t *count,
                              double _Complex **out)
{
    RITZ_OWN(ritz_spectrum) all = {0};

    if (!s->small || !s->full.poles.coupled)
        return ritz_responder_poles(responder, count, out);
    RITZ_CHECK(ritz_spectrum_of(
        ritz_model_of_dense(&s->view, remaining_damping(s)), NULL, &all));
    return ritz_spectrum_list(&all, count, out);
}

/* Cancel the poles up to 1.5 times the range and their conjugates. */
static ritz_status cancel_poles(rational_nodes *s, double to_hz, int64_t count,
                                const double _Complex *found)
{
    const double most = 2.0 * RITZ_PI * RITZ_POLES_BEYOND * to_hz;

    RITZ_CHECK_NEW(s->pole, 2 * count);
    for (int64_t k = 0; k < count; k++) {
        double _Complex at = found[k];

        if (cabs(at) > most || (s->states && cimag(at) < 0.0))
            continue;
        if (s->states && cabs(at) <= RITZ_NEGLIGIBLE * most)
            at = 0.0; /* exactly 0: the value is rounding */
        add_pole(s, at);
        if (cimag(at) > 0.0)
            add_pole(s, s->mirror ? conj(at) : -at);
    }
    return RITZ_OK;
}

/*
 * The poles that are observable in a channel, and their conjugates. With K4 the
 * poles below the real axis are taken as -s, which is exact without damping by
 * D, and accurate enough with it since they are far from the range.
 */
static ritz_status find_poles(rational_nodes *s,
                              const ritz_responder *responder)
{
    RITZ_OWN_ARRAY double _Complex *found = NULL;
    int64_t count = 0;

    if (s->full.n <= RITZ_WHOLE_DOFS)
        RITZ_CHECK(project_whole(s));
    RITZ_CHECK(list_poles(s, responder, &count, &found));
    return cancel_poles(s, responder->to_hz, count, found);
}

/* Find the poles to be cancelled: all poles of a dense state space, those near
   the range of a sparse one. */
static ritz_status find_state_poles(rational_nodes *s,
                                    const ritz_response_request *request)
{
    RITZ_OWN(ritz_near_poles) near = {0};
    RITZ_OWN_ARRAY double _Complex *found = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_poles_near(&s->pencil, request, &near));
    RITZ_CHECK(ritz_near_poles_list(&near, request, &s->listed));
    if (ritz_state_space_is_sparse(s->states))
        return cancel_poles(s, request->to_hz, near.count, near.s);
    RITZ_CHECK(ritz_state_space_poles(s->states, &count, &found));
    return cancel_poles(s, request->to_hz, count, found);
}

/* Zeros of channel v of the dense model, to be cancelled. */
static ritz_status find_zeros(rational_nodes *s, int64_t v)
{
    int64_t count = 0, n = 0;
    double _Complex *zero = NULL;
    ritz_status status =
        ritz_zeros_of(ritz_model_of_dense(&s->view, remaining_damping(s)),
                      v / s->inputs, v % s->inputs, &count, &zero);

    if (status != RITZ_OK) /* H is zero, or no zeros were found */
        return status == RITZ_ERR_MEMORY ? status : RITZ_OK;
    for (int64_t k = 0; k < count; k++)
        if (cabs(zero[k]) <= RITZ_POLES_BEYOND * s->f.unit)
            zero[n++] = zero[k] / s->f.unit;
    s->f.zero[v] = zero;
    s->f.num_zeros[v] = n;
    return RITZ_OK;
}

/*
 * Response by rational interpolation [KenneyStubberudLaub1992]: the full
 * matrices are factored at a few nodes. Between them a polynomial interpolates
 * H divided by its poles, which the eigensolver found up to 1.5 times the
 * range; for small components the zeros are cancelled too, in the channels
 * where that reduces the error. As H(-i w) is the conjugate of H(i w), unless
 * there is K4, each node counts twice.
 *
 * The next node is where prod |s - s_m| / prod |s - pole| is largest: near
 * resonances, but never at a pole or zero: candidates keep a half-power width
 * from them. The interpolant's error at a node is measured before the node is
 * added; three successive nodes within the tolerance end the search.
 */

/* Largest number of channels with zeros; with more, zeros take longer than
   nodes. */
static const int64_t most_channels = 9;

static void free_rational(void *state)
{
    rational_nodes *s = state;

    ritz_direct_free(&s->full);
    ritz_pencil_free(&s->pencil);
    ritz_poles_free(&s->listed);
    ritz_reduced_free(&s->whole);
    ritz_interpolant_free(&s->f);
    RITZ_FREE(s->pole, s->hertz, s->used, s->with_zeros, s->missed, s->miss,
              s->peak, s->level, s->scale, s->H, s->guess, s->other, s->before);
}

static ritz_status start_rational(const ritz_response_request *request,
                                  const ritz_responder *out, rational_nodes *s)
{
    const ritz_io io = ritz_model_io(request->model); /* borrowed */
    double unit = 2.0 * RITZ_PI * request->to_hz;
    double low = request->from_hz;

    s->outputs = io.num_outputs;
    s->inputs = io.num_inputs;
    s->values = s->outputs * s->inputs;
    s->noise = &out->noise;
    s->mirror = s->states || !request->model.component->K4.colptr;
    if (s->full.poles.num_rigid > 0 && low == 0.0)
        low = RITZ_ABOVE_REST * request->to_hz;
    RITZ_CHECK(s->states ? find_state_poles(s, request) : find_poles(s, out));
    s->f = (ritz_interpolant){
        .values = s->values, .unit = unit, .num_poles = s->num_poles};
    RITZ_CHECK_NEW(s->f.pole, s->num_poles);
    for (int64_t k = 0; k < s->num_poles; k++)
        s->f.pole[k] = s->pole[k] / unit;
    RITZ_CHECK_NEW(s->f.num_zeros, s->values);
    RITZ_CHECK_NEW(s->f.zero, s->values);
    RITZ_CHECK_NEW(s->with_zeros, s->values);
    RITZ_CHECK_NEW(s->missed, 2 * s->values);
    RITZ_CHECK_NEW(s->miss, 2 * s->values * ENOUGH);
    RITZ_CHECK_NEW(s->peak, s->values);
    RITZ_CHECK_NEW(s->level, s->values);
    RITZ_CHECK_NEW(s->scale, s->values);
    RITZ_CHECK_NEW(s->H, s->values);
    RITZ_CHECK_NEW(s->guess, s->values);
    RITZ_CHECK_NEW(s->other, s->values);
    for (int64_t v = 0;
         v < s->values && s->mirror && s->small && s->values <= most_channels;
         v++)
        RITZ_CHECK(find_zeros(s, v));
    RITZ_CHECK(place_nodes(s, low, request->to_hz));
    return converge_nodes(s, request->tolerance > 0.0 ? request->tolerance
                                                      : RITZ_ENGINE_TOLERANCE);
}

static ritz_status prepare_model(const ritz_response_request *request,
                                 ritz_responder *out, rational_nodes *s)
{
    const bool states = request->model.kind == RITZ_MODEL_STATES;

    out->poles = states ? &s->listed : &s->full.poles;
    out->pairs = states ? NULL : &s->full.pairs;
    if (!states) {
        RITZ_CHECK(ritz_direct_new(request->model.component,
                                   request->model.damping,
                                   ritz_response_highest(request), &s->full));
        return ritz_rounded_of(request->model.component, &s->full.pairs,
                               !s->full.apart, &out->rounded);
    }
    s->states = request->model.states;
    memcpy(out->damping, s->states->damping, sizeof out->damping);
    return ritz_pencil_of_space(s->states, &s->pencil);
}

static ritz_status make_rational(const ritz_response_request *request,
                                 ritz_responder *out)
{
    rational_nodes *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->state = s;
    out->free = free_rational;
    out->at = rational_at;
    RITZ_CHECK(prepare_model(request, out, s));
    out->uncertain = s->full.rest.uncertain;
    RITZ_CHECK(start_rational(request, out, s));
    (void)snprintf(out->remark, sizeof out->remark,
                   "%" PRId64 " factors at nodes, %" PRId64 " poles cancelled",
                   s->nodes, s->num_poles);
    return RITZ_OK;
}

const ritz_response_engine ritz_response_engine_rational = {
    .name = "rational",
    .summary = "interpolation between factored nodes, poles cancelled",
    .reference = "KenneyStubberudLaub1992",
    .when = "a range with few modes, few inputs and outputs; no space is kept",
    .cost = "about a factor for each mode that shows and ten more, then "
            "O(nodes) a point and channel",
    .holds = "what the nodes that came last showed, three in a row",
    .fails = "many modes: krylov needs fewer factors; D or K4 of a large "
             "component, whose poles take factors too; more than the 80 poles "
             "that are sought of a sparse state space",
    .takes = RITZ_MODEL_COMPONENT | RITZ_MODEL_STATES,
    .make = make_rational,
};
