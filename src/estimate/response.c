/*
 * How far a reduced response can be off. In the trial's coordinates, with
 * z_j(w) = theta_j - w^2 + i w d_j and d the modal damping,
 *
 *     eta_j = x_j'b / z_j,   r_p = b - Z X eta = b_o - c X_R eta,
 *
 * b_o = b - M X X'b, X_R = R and c = 1; of D = a M + b K, c = 1 + i w b. The
 * same of an output's row, transposed, is r_d, and
 *
 *     H - H_r = defect + r_d' Z^-1 r_p.
 *
 * In exact modes, with mu = lambda - sigma and z = c mu - s,
 *
 *     1 / z = 1 / (c mu) + s / (c mu)^2 + rest(lambda) / mu
 *
 * the first two are forms in A^-1 and A^-1 M A^-1, known exactly, and the rest
 * is small for all modes far above w. Modes k that the reduced model holds take
 * part in r only by what it does not hold of them:
 *
 *     |phi_k'r| <= sqrt(mu_k) sin_k |r|_(A^-1),
 *     sum_(k<=N) (kappa_k - kappa_(N+1)) sin_k^2
 *                                <= sum_(k<=N) (kappa_k - 1 / t_k)
 *
 * from the trace of S in the span of the N lowest trial modes. The rest of mode
 * k is bounded over the interval that is known to hold lambda_k.
 *
 * Ratios zeta of exact modes are not those of reduced ones: D X is 2 zeta times
 * M X Theta^1/2 and, in exact modes, R times 2 zeta / (sqrt lambda_k + sqrt
 * theta_j) in addition: bounded by |R_j|. The defect X'D X - D_r is a second
 * difference of sqrt lambda, of order |R_i||R_j|.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "estimate/estimator.h"
#include "model/modal.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EVEN_POINTS = 100, MOST_INTERVALS = 20000, DEEPEST = 200 };

/* The bound of one channel at w, and the magnitudes it is compared with. */
static double bound_channel(const ritz_bounder *r, double w, double h,
                            int64_t input, int64_t output)
{
    const ritz_side *in = &r->side[input];
    const ritz_side *out = &r->side[r->io->num_inputs + output];
    ritz_channel_bound *c = &r->at[output + input * r->io->num_outputs];
    double sum = 0.0;
    double _Complex H = 0.0;

    for (int64_t j = 0; j < r->trial->count; j++)
        H += out->participation[j] * in->eta[j];
    c->most = sqrt(in->self * out->self);
    if (r->finer)
        ritz_refinement_bound(r, r->finer, w, h, input, output, c);
    else
        ritz_bound_pair(r, w, h, input, output, c);
    c->response = cabs(H + c->known);
    for (int k = 0; k < RITZ_PARTS; k++)
        sum += c->part[k];
    return isnan(sum) ? HUGE_VAL : sum;
}

/* Bounds of all channels anywhere within h of w rad/s, written to r->at;
   returns the largest of bound times weight. */
static double bound_at(ritz_bounder *r, double w, double h)
{
    double largest = 0.0;

    ritz_bounder_solve(r, w, h);
    if (r->finer)
        ritz_refinement_solve(r, r->finer, w, h);
    for (int64_t j = 0; j < r->io->num_inputs; j++) {
        ritz_bounder_take_input(r->finer ? &r->finer->fine : r, j);
        for (int64_t i = 0; i < r->io->num_outputs; i++) {
            double weight = r->at[i + j * r->io->num_outputs].weight;

            largest = fmax(largest, weight * bound_channel(r, w, h, j, i));
        }
    }
    return largest;
}

/* Between a and b, split until the bound is near the best of the points. */
static double bound_interval(ritz_bounder *r, double a, double b, double *best,
                             int64_t *left)
{
    double low[DEEPEST];
    double high[DEEPEST];
    double top = 0.0;
    int depth = 1;

    low[0] = a;
    high[0] = b;
    while (depth > 0) {
        double from = low[depth - 1];
        double to = high[depth - 1];
        double w = 0.5 * (from + to);
        double U = bound_at(r, w, 0.5 * (to - from));

        depth--;
        if (U <= RITZ_INTERVAL_SLACK * *best || --*left < 0 ||
            depth + 2 > DEEPEST) {
            top = fmax(top, U);
            continue;
        }
        *best = fmax(*best, bound_at(r, w, 0.0));
        low[depth] = from;
        high[depth++] = w;
        low[depth] = w;
        high[depth++] = to;
    }
    return top;
}

/* Points of the band, refined at the reduced model's poles. */
static ritz_status take_points(const ritz_bounder *r, const double band_hz[2],
                               double rules_hz, int64_t *count, double **hertz)
{
    ritz_grid grid = {.from_hz = band_hz[0],
                      .to_hz = band_hz[1],
                      .count = EVEN_POINTS,
                      .refine = true};
    int64_t m = r->trial->count - r->num_rigid;
    RITZ_OWN_ARRAY double *omega = NULL, *zeta = NULL;

    if (r->num_rigid > 0 || rules_hz > 0.0)
        grid.from_hz = fmax(grid.from_hz, RITZ_BAND_START * grid.to_hz);
    if (!(band_hz[0] > 0.0) && rules_hz < band_hz[1])
        grid.from_hz = fmax(grid.from_hz, rules_hz);
    RITZ_CHECK_NEW(omega, m);
    RITZ_CHECK_NEW(zeta, m);
    for (int64_t k = 0; k < m; k++) {
        double theta = r->trial->theta[r->num_rigid + k];

        omega[k] = sqrt(fmax(theta, 0.0));
        zeta[k] =
            omega[k] > 0.0 ? 0.5 * r->rates[r->num_rigid + k] / omega[k] : 1.0;
    }
    return ritz_grid_points(&grid, m, omega, zeta, count, hertz);
}

/* Results for one channel over all points of the band. */
typedef struct channel_found {
    double bound, hertz;     /* the largest bound, and its frequency */
    double part[RITZ_PARTS]; /* terms of that bound */
    double error;            /* the largest known part of the error */
    double least;            /* proven lower bound of max |H| */
    /* max |H| relative to its Cauchy-Schwarz bound is at least and at most
       this */
    double coupled[2];
    double most; /* the largest Cauchy-Schwarz bound of |H| */
} channel_found;

/* Results for the response. */
typedef struct response_found {
    int64_t count; /* channels, outputs by inputs */
    channel_found *channel;
    int64_t worst;        /* the channel with the largest relative bound */
    double value;         /* that bound; HUGE_VAL: nothing is known */
    bool between;         /* the bound is so large only between the points */
    ritz_rounded rounded; /* effect of rounding of K on the full response */
    double rules_hz;      /* frequency up to which that rounding dominates; 0:
                             none  [Hz] */
} response_found;

static void response_found_free(response_found *f)
{
    free(f->channel);
}

static void note_channel(const ritz_channel_bound *at, double hertz,
                         channel_found *c)
{
    double bound = 0.0, rest = 0.0;

    for (int k = 0; k < RITZ_PARTS; k++)
        bound += at->part[k];
    bound = isnan(bound) ? HUGE_VAL : bound;
    rest = bound - at->part[RITZ_PART_ERROR];
    if (bound > c->bound) {
        c->bound = bound;
        c->hertz = hertz;
        memcpy(c->part, at->part, sizeof c->part);
    }
    c->error = fmax(c->error, at->part[RITZ_PART_ERROR]);
    c->least = fmax(c->least, at->response - rest);
    c->most = fmax(c->most, at->most);
    if (!(at->most > 0.0))
        return;
    c->coupled[0] = fmax(c->coupled[0], (at->response - rest) / at->most);
    c->coupled[1] = fmax(c->coupled[1], (at->response + rest) / at->most);
}

static void visit_points(ritz_bounder *r, int64_t count, const double *hertz,
                         response_found *f)
{
    memset(f->channel, 0, (size_t)f->count * sizeof *f->channel);
    for (int64_t k = 0; k < count; k++) {
        (void)bound_at(r, 2.0 * RITZ_PI * hertz[k], 0.0);
        for (int64_t c = 0; c < f->count; c++)
            note_channel(&r->at[c], hertz[k], &f->channel[c]);
    }
}

/* Whether an input and an output count as decoupled. */
static bool is_hardly_coupled(const channel_found *c)
{
    return c->coupled[0] <= RITZ_CHANNEL_COUPLED &&
           c->coupled[1] <= RITZ_CHANNEL_WEAK;
}

/*
 * The magnitude that a channel's bound is relative to: the channel's own
 * largest |H|, so that units do not matter. If input and output are decoupled,
 * H is rounding, and its Cauchy-Schwarz bound is used, limited to the largest
 * |H| of all channels, which ritz-verify compares with. 0 if |H| is not proven
 * to be above 0.
 */
static double unit_of(const response_found *f, const channel_found *c)
{
    double largest = 0.0;

    if (!is_hardly_coupled(c))
        return c->least;
    for (int64_t k = 0; k < f->count; k++)
        largest = fmax(largest, f->channel[k].least);
    return fmin(largest, c->most);
}

/* Find the worst channel over the points, and set the weights of all. */
static void weigh_channels(ritz_bounder *r, response_found *f)
{
    f->worst = 0;
    f->value = 0.0;
    for (int64_t k = 0; k < f->count; k++) {
        const channel_found *c = &f->channel[k];
        double unit = unit_of(f, c);
        double value = c->bound > 0.0 ? c->bound / unit : 0.0;

        r->at[k].weight = unit > 0.0 ? 1.0 / unit : 0.0;
        if (value > f->value) {
            f->value = value;
            f->worst = k;
        }
    }
}

/* Whether the bound of any channel is far above its known error. */
static bool is_loose(const response_found *f)
{
    for (int64_t k = 0; k < f->count; k++)
        if (f->channel[k].bound > RITZ_RESPONSE_LOOSE * f->channel[k].error)
            return true;
    return false;
}

/* The richer trial of a response. */
typedef struct richer {
    ritz_enclosure before; /* intervals of the coarse trial, which are still
                              used */
    ritz_refinement finer;
} richer;

static void richer_free(richer *all)
{
    ritz_enclosure_free(&all->before);
    ritz_refinement_free(&all->finer);
}

/* Make a richer trial, if there is one, and the intervals that follow from
   it. */
static ritz_status refine_response(ritz_measuring *m, ritz_bounder *r,
                                   richer *all)
{
    RITZ_CHECK(ritz_enrich(m->estimator, r, &m->rich));
    if (m->rich.count == 0)
        return RITZ_OK;
    RITZ_MOVE(all->before, m->enclosure);
    r->e = &all->before;
    RITZ_CHECK(ritz_measuring_enclose(m));
    RITZ_CHECK(ritz_refinement_new(m->estimator, r, &m->rich, &m->enclosure,
                                   &all->finer));
    r->finer = &all->finer;
    return RITZ_OK;
}

/* Repeat the points with a richer trial, and keep the former results if these
   are better, as may happen where modes are missing. */
static ritz_status visit_finer(ritz_measuring *m, int64_t count,
                               const double *hertz, ritz_bounder *r,
                               richer *all, response_found *f)
{
    RITZ_OWN(response_found) before = *f;

    f->channel = NULL;
    RITZ_CHECK(refine_response(m, r, all));
    RITZ_CHECK_NEW(f->channel, f->count);
    if (r->finer) {
        visit_points(r, count, hertz, f);
        weigh_channels(r, f);
    }
    if (r->finer && f->value <= before.value)
        return RITZ_OK;
    memcpy(f->channel, before.channel, (size_t)f->count * sizeof *f->channel);
    r->finer = NULL;
    return RITZ_OK;
}

/* Extend the bound to all frequencies between the points. */
static void bound_between(ritz_bounder *r, int64_t count, const double *hertz,
                          response_found *f)
{
    int64_t left = MOST_INTERVALS;
    double best = fmax(f->value, RITZ_NEGLIGIBLE);
    double top = f->value;

    for (int64_t k = 0; k + 1 < count; k++)
        top = fmax(top,
                   bound_interval(r, 2.0 * RITZ_PI * hertz[k],
                                  2.0 * RITZ_PI * hertz[k + 1], &best, &left));
    f->between = top > RITZ_RESPONSE_LOOSE * f->value;
    f->value = top;
}

static ritz_status bound_band(ritz_measuring *m, bool known, richer *all,
                              ritz_bounder *r, response_found *f)
{
    int64_t count = 0;
    RITZ_OWN_ARRAY double *hertz = NULL;

    RITZ_CHECK(take_points(r, m->band_hz, f->rules_hz, &count, &hertz));
    f->count = r->io->num_inputs * r->io->num_outputs;
    RITZ_CHECK_NEW(f->channel, f->count);
    visit_points(r, count, hertz, f);
    weigh_channels(r, f);
    if (known && is_loose(f))
        RITZ_CHECK(visit_finer(m, count, hertz, r, all, f));
    weigh_channels(r, f);
    if (!r->coupled && isfinite(f->value))
        bound_between(r, count, hertz, f);
    return RITZ_OK;
}

/* Why a bound is far above the known error, or infinite; "" if it is
   neither. */
static const char *cause_of(const ritz_measuring *m, const response_found *f)
{
    static const char *const names[RITZ_PARTS] = {
        [RITZ_PART_DAMPING] = "damping of inexact modes",
        [RITZ_PART_REST] = "modes not held",
        [RITZ_PART_BETWEEN] = "between points",
        [RITZ_PART_ROUNDING] = "rounding",
    };
    const channel_found *c = &f->channel[f->worst];
    int most = RITZ_PART_DAMPING;

    if (f->between)
        return names[RITZ_PART_BETWEEN];
    if (c->bound <= RITZ_BOUND_FAR * c->error)
        return unit_of(f, c) > 0.0 ? "" : "response may be zero";
    for (int k = most + 1; k < RITZ_PARTS; k++)
        if (c->part[k] > c->part[most] || isnan(c->part[k]))
            most = k;
    if (most == RITZ_PART_REST && m->prediction.num_missing > 0)
        return "missing modes";
    return names[most];
}

/* Frequency and channel, "12.5 Hz, force to tip". */
static void say_where(const ritz_measuring *m, const response_found *f,
                      char where[RITZ_NAME_SIZE])
{
    const ritz_io *io = &m->estimator->component->io;

    const channel_found *c = &f->channel[f->worst];
    bool hardly = is_hardly_coupled(c);
    int room = hardly ? 12 : 20; /* characters of each name */

    (void)snprintf(where, RITZ_NAME_SIZE, "%.5g Hz, %.*s to %.*s%s", c->hertz,
                   room, io->input[f->worst / io->num_outputs], room,
                   io->output[f->worst % io->num_outputs],
                   hardly ? ", hardly coupled" : "");
}

/* What can be said of a response. */
typedef enum promise { NOTHING, ESTIMATE, BOUND } promise;

static promise promise_of(const ritz_estimator *estimator,
                          const ritz_reduced *reduced, int64_t modes)
{
    const ritz_component *full = estimator->component;
    ritz_damping_kind kind = estimator->request.damping.kind;

    if (modes != reduced->K.nrow || full->io.num_inputs == 0 ||
        full->io.num_outputs == 0 ||
        (full->dampers.count > 0 && !full->D.colptr) || /* not installed */
        (full->D.colptr && ritz_sparse_asymmetry(&full->D) > RITZ_GYROSCOPIC))
        return NOTHING;
    if (full->D.colptr || full->K4.colptr || kind == RITZ_DAMPING_BANDS ||
        kind == RITZ_DAMPING_MODES)
        return ESTIMATE;
    return kind == RITZ_DAMPING_NONE ? NOTHING : BOUND;
}

bool ritz_response_boundable(const ritz_estimator *estimator,
                             const ritz_reduced *reduced, int64_t modes)
{
    return promise_of(estimator, reduced, modes) != NOTHING;
}

/*
 * Whether the modes that count as rigid are the full model's: then both have
 * them at 0, where rounding of matrices may leave them elsewhere.
 */
static bool rigid_in_full(const ritz_lehmann *trial, int64_t num_rigid)
{
    bool all = true;

    for (int64_t j = 0; j < num_rigid; j++) {
        double t = trial->theta[j] - trial->sigma;
        double eps = sqrt(fmax(ritz_dense_col(&trial->G, j)[j], 0.0) / t);

        all = all && eps <= RITZ_RIGID_RESIDUAL;
    }
    return all;
}

/* Effect of rounding of K on the full response, from the trial's lowest modes,
   as ritz-verify computes it. */
static ritz_status find_rounding(const ritz_measuring *m, const ritz_bounder *r,
                                 response_found *f)
{
    const ritz_component *full = m->estimator->component;
    const ritz_pairs lowest = {.Phi = m->trial.X,
                               .lambda = m->trial.theta,
                               .num_rigid = m->pairs.num_rigid}; /* borrowed */
    const bool factors =
        r->coupled &&
        !ritz_ratios_act_on_all(full, &m->estimator->request.damping);

    RITZ_CHECK(ritz_rounded_of(full, &lowest, factors, &f->rounded));
    if (f->rounded.motions > 0)
        f->rules_hz = ritz_rounded_ends(&f->rounded, RITZ_START_ROUNDING);
    return RITZ_OK;
}

/* Report the frequency up to which rounding dominates the response. */
static ritz_status report_rounding(const ritz_measuring *m,
                                   const response_found *f, ritz_measures *out)
{
    char where[RITZ_NAME_SIZE];

    if (f->rules_hz <= fmax(m->band_hz[0], RITZ_BAND_START * m->band_hz[1]))
        return RITZ_OK;
    (void)snprintf(where, sizeof where,
                   "rigid eigenvalues of rounded K, %.3g Hz",
                   f->rounded.rigid_hz);
    return ritz_measures_add(out, "rounding-to-hz", f->rules_hz, nan(""),
                             where);
}

/* Report the bound, unless the error is 0. */
static ritz_status report_response(const ritz_measuring *m,
                                   const ritz_bounder *r, bool sure,
                                   const response_found *f, ritz_measures *out)
{
    const char *unknown = ritz_bounder_unknown(m, r);
    char where[RITZ_NAME_SIZE] = "";

    if (!(f->value > 0.0) && !unknown)
        return RITZ_OK;
    if (!unknown)
        say_where(m, f, where);
    RITZ_CHECK(ritz_measures_add(
        out, sure ? "response-relative-bound" : "response-relative-estimate",
        unknown ? HUGE_VAL : f->value, nan(""), where));
    ritz_measures_name_cause(out, unknown ? unknown : cause_of(m, f));
    return RITZ_OK;
}

ritz_status ritz_bound_response(ritz_measuring *m, const ritz_reduced *reduced,
                                ritz_measures *out)
{
    ritz_estimator *estimator = m->estimator;
    const ritz_damping *damping = &estimator->request.damping;
    bool known = promise_of(estimator, reduced, m->pairs.Phi.ncol) == BOUND;
    RITZ_OWN(response_found) found = {0};
    RITZ_OWN(richer) all = {0}; /* before r, which borrows from it */
    RITZ_OWN(ritz_bounder)
    r = {.trial = &m->trial,
         .e = &m->enclosure,
         .io = &estimator->component->io,
         .num_rigid = m->pairs.num_rigid,
         .rayleigh = ritz_damping_is_rayleigh(damping),
         .zeta = damping->zeta,
         .a = damping->a,
         .b = damping->b};
    RITZ_OWN_ARRAY double *matrices = NULL;

    RITZ_CHECK_NEW(r.rates, m->trial.count);
    RITZ_CHECK_NEW(matrices, m->trial.count);
    if (!known && damping->kind == RITZ_DAMPING_NONE)
        RITZ_CHECK(ritz_estimator_rayleigh(estimator->component, &r.a, &r.b,
                                           &r.rayleigh));
    known = known || r.rayleigh;
    if (!known)
        RITZ_CHECK(ritz_bounder_take_rates(estimator, &r, matrices));
    RITZ_CHECK(ritz_bounder_open(estimator, &r));
    RITZ_CHECK(find_rounding(m, &r, &found));
    RITZ_CHECK(bound_band(m, known, &all, &r, &found));
    RITZ_CHECK(report_response(
        m, &r, known && rigid_in_full(&m->trial, m->pairs.num_rigid), &found,
        out));
    return report_rounding(m, &found, out);
}
