/*
 * Measures between the responses and static gains of two models, which exist
 * where any transfer function of the full model is more than rounding.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "response/responder.h"
#include "verify/sides.h"

#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A mode's largest participation in any input, and in any row of C, Cv, Ca. */
enum { SHARES = 4 };
enum { SWEEPS = 3 };

static void find_participations(const ritz_io *io, int64_t k,
                                double share[SHARES])
{
    share[0] = 0.0;
    for (int64_t j = 0; j < io->num_inputs; j++)
        share[0] = fmax(share[0], fabs(ritz_dense_col(&io->B, j)[k]));
    share[1] = ritz_dense_col_max(&io->C, k);
    share[2] = ritz_dense_col_max(&io->Cv, k);
    share[3] = ritz_dense_col_max(&io->Ca, k);
}

/*
 * Whether any |H| is more than rounding of the sum over modes: entries of B and
 * C are known to some eps of the largest, b and c, so of thousands of modes
 *
 *     1e3 eps sum_k (|c_k| b + c |b_k|) / |w_k^2 - w^2 + i w d_k|
 */
static ritz_status find_significance(const ritz_poles *poles,
                                     ritz_reference_sweep *s)
{
    double most[SHARES] = {0.0};
    RITZ_OWN_ARRAY double *share = NULL;

    s->significant = false;
    RITZ_CHECK_NEW(share, SHARES * poles->count);
    for (int64_t k = 0; k < poles->count; k++) {
        find_participations(&poles->io, k, &share[SHARES * k]);
        for (int t = 0; t < SHARES; t++)
            most[t] = fmax(most[t], share[SHARES * k + t]);
    }
    for (int64_t p = 0; p < s->count && !s->significant; p++) {
        double w = 2.0 * RITZ_PI * s->hertz[p];
        double c_most = most[1] + w * (most[2] + w * most[3]);
        double sum = 0.0;

        for (int64_t k = 0; k < poles->count; k++) {
            const double *of = &share[SHARES * k];
            double c = of[1] + w * (of[2] + w * of[3]);
            double below = hypot(poles->lambda[k] - w * w, w * poles->rate[k]);

            if (below > 0.0)
                sum += (c * most[0] + c_most * of[0]) / below;
        }
        for (int64_t e = p * s->values; e < (p + 1) * s->values; e++)
            s->significant =
                s->significant || cabs(s->full[e]) > RITZ_HEARD_ROUNDING * sum;
    }
    return RITZ_OK;
}

void ritz_sweep_free(ritz_reference_sweep *sweep)
{
    RITZ_FREE(sweep->hertz, sweep->full);
    *sweep = (ritz_reference_sweep){0};
}

double ritz_reference_start(const ritz_reference *reference)
{
    const double *band = reference->band_hz;
    const ritz_rounded *rounded = &reference->rounded;
    double start = band[0];

    if (reference->poles.num_rigid > 0 || rounded->hidden)
        start = fmax(start, RITZ_BAND_START * band[1]);
    return !(band[0] > 0.0) && reference->rules_hz < band[1]
               ? fmax(start, reference->rules_hz)
               : start;
}

ritz_status ritz_sweep_points(const ritz_reference *reference,
                              const ritz_poles *poles,
                              const ritz_damped *damped, int64_t even,
                              ritz_reference_sweep *out)
{
    RITZ_OWN_ARRAY double *omega = NULL;
    ritz_grid grid = {.from_hz = ritz_reference_start(reference),
                      .to_hz = reference->band_hz[1],
                      .count = even,
                      .refine = true};

    if (poles->num_rigid > 0)
        grid.from_hz = fmax(grid.from_hz, RITZ_BAND_START * grid.to_hz);
    RITZ_CHECK_NEW(omega, poles->count);
    for (int64_t k = 0; k < poles->count; k++)
        omega[k] = sqrt(poles->lambda[k]);
    return ritz_grid_points(&grid, poles->count, omega, damped->zeta,
                            &out->count, &out->hertz);
}

/* The largest response without rigid motion: y = (C + i w Cv - w^2 Ca) q, less
   the same of the rigid q = phi'b / (-w^2 + i w d). */
static double flexible_part(const ritz_poles *poles,
                            const ritz_reference_sweep *s)
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

bool ritz_reference_factors(const ritz_reference *reference)
{
    return (reference->poles.coupled || !reference->residual.known) &&
           reference->poles.count < reference->component->num_dofs;
}

/* Whether rounding of K, which the krylov engine leaves out, dominates responses
   nowhere in the band. */
static bool is_unrounded(const ritz_reference *reference)
{
    const double *band = reference->band_hz;

    return reference->rules_hz <= fmax(band[0], RITZ_BAND_START * band[1]);
}

/*
 * Modes and the static response of the rest do not give the effect of a local
 * damper, through which the rest moves too. The krylov engine takes some factors
 * in all, the direct one a factor for each point. If ratios and matrices act
 * together, the damping matrix is full, and each of these factors would take
 * minutes.
 */
ritz_status ritz_reference_prepare(ritz_reference *reference)
{
    const ritz_response_request request = {
        .model =
            ritz_model_of_component(reference->component, &reference->damping),
        .from_hz = ritz_reference_start(reference),
        .to_hz = reference->band_hz[1],
        .up_to_hz = reference->modes_hz,
        .tolerance = RITZ_REFERENCE_TOLERANCE};

    const bool full =
        ritz_ratios_act_on_all(reference->component, &reference->damping);

    if (!ritz_reference_factors(reference))
        return RITZ_OK;
    return ritz_responder_or_direct(full || is_unrounded(reference)
                                        ? &ritz_response_engine_krylov
                                        : &ritz_response_engine_direct,
                                    &request, &reference->responder);
}

ritz_status ritz_reference_respond(const ritz_reference *reference,
                                   ritz_reference_sweep *s)
{
    const ritz_poles *poles = &reference->poles;
    const ritz_grid grid = {.from_hz = s->hertz[0],
                            .to_hz = s->hertz[s->count - 1],
                            .count = s->count,
                            .hertz = s->hertz};
    RITZ_OWN(ritz_response) direct = {0};

    s->values = poles->io.num_inputs * poles->io.num_outputs;
    if (reference->responder) {
        RITZ_CHECK(ritz_responder_sample(reference->responder, &grid, &direct));
        RITZ_MOVE(s->full, direct.H);
    } else {
        RITZ_CHECK_NEW(s->full, s->count * s->values);
        RITZ_CHECK(ritz_poles_add_all(poles, s->count, s->hertz, s->full));
        RITZ_CHECK(ritz_residual_add_all(&reference->residual, s->count,
                                         s->hertz, s->full));
    }
    s->flexible = flexible_part(poles, s);
    return find_significance(poles, s);
}

static void keep_larger(double value, double hertz, ritz_extreme *of)
{
    if (value > of->value)
        *of = (ritz_extreme){value, hertz};
}

static double square_of(double _Complex z)
{
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* Whether |z| is surely less than a, by squares, which are faster than cabs.
   False where squares overflow, or underflow. */
static bool is_less(double _Complex z, double a)
{
    return square_of(z) < a * a * (1.0 - RITZ_SAME) && a * a >= DBL_MIN;
}

ritz_status ritz_gap_add(double _Complex H, double _Complex H_r, double hertz,
                         ritz_gap *gap)
{
    double error = 0.0;

    if (!is_less(H, gap->largest))
        gap->largest = fmax(gap->largest, cabs(H));
    if (is_less(H - H_r, gap->error.value))
        return RITZ_OK;
    error = cabs(H - H_r);
    RITZ_REFUSE_IF(!isfinite(error), RITZ_ERR_CONVERGENCE,
                   "the response at %.6g Hz leaves all bounds", hertz);
    keep_larger(error, hertz, &gap->error);
    return RITZ_OK;
}

/*
 * The reduced model at the points, and how far it is off. It is not compared at
 * rest where its rigid motion alone would make its response infinite.
 */
static ritz_status compare_sweep(const ritz_sides *sides,
                                 ritz_reference_sweep *s, ritz_gap *gap)
{
    const int64_t values = s->values;
    int64_t first = 0;
    double least =
        sides->reduced.num_rigid > 0
            ? RITZ_BAND_START * sides->full->band_hz[1] * (1.0 - RITZ_SAME)
            : 0.0;

    gap->flexible = fmax(gap->flexible, s->flexible);
    gap->significant = gap->significant || s->significant;
    RITZ_CHECK_NEW(s->reduced, s->count * values);
    while (first < s->count && s->hertz[first] < least)
        first++; /* frequencies ascend */
    if (first > 0)
        memcpy(s->reduced, s->full,
               (size_t)(first * values) * sizeof *s->reduced);
    RITZ_CHECK_IN("reduced model",
                  ritz_poles_add_all(&sides->reduced, s->count - first,
                                     s->hertz + first,
                                     s->reduced + first * values));
    for (int64_t e = first * values; e < s->count * values; e++)
        RITZ_CHECK(
            ritz_gap_add(s->full[e], s->reduced[e], s->hertz[e / values], gap));
    return RITZ_OK;
}

/* Levels whose squares differ by less than that of the gap. */
typedef struct level_band {
    double low, high; /* of |H_r|^2 / |H|^2 */
} level_band;

static level_band find_level_band(double db)
{
    const double ratio = pow(10.0, db / 10.0);

    return (level_band){(1.0 + RITZ_SAME) / ratio, (1.0 - RITZ_SAME) * ratio};
}

/* Levels are compared where |H| is not negligible relative to the largest. */
static void compare_levels(const ritz_reference_sweep *s, ritz_gap *gap)
{
    level_band band = find_level_band(gap->db.value);

    for (int64_t k = 0; k < s->count * s->values; k++) {
        const double a2 = square_of(s->full[k]);
        const double b2 = square_of(s->reduced[k]);
        double a = 0.0, b = 0.0;

        if (b2 > a2 * band.low && b2 < a2 * band.high && a2 >= DBL_MIN &&
            b2 >= DBL_MIN)
            continue;
        a = cabs(s->full[k]);
        b = fmax(cabs(s->reduced[k]), RITZ_LEAST_SCALE);
        if (!(a > RITZ_AUDIBLE * gap->largest))
            continue;
        keep_larger(fabs(20.0 * log10(b / a)), s->hertz[k / s->values],
                    &gap->db);
        band = find_level_band(gap->db.value);
    }
}

/* Singular values of a model at every point of a sweep, descending at each. */
static ritz_status take_singular(const ritz_io *io,
                                 const ritz_reference_sweep *sweep,
                                 const double _Complex *H, int64_t most,
                                 double *sigma)
{
    const ritz_scales scales = {.output = io->limit};

    for (int64_t k = 0; k < sweep->count; k++)
        RITZ_CHECK(ritz_singular_values(io->num_outputs, io->num_inputs,
                                        H + k * sweep->values, &scales,
                                        sigma + k * most));
    return RITZ_OK;
}

/*
 * sigma_r of both models, r the rank of the full one [McDaniel2000, 3.3]: the
 * curve below in its plots of singular values over frequency.
 */
static ritz_status compare_singular(const ritz_sides *sides,
                                    const ritz_reference_sweep *s,
                                    ritz_gap *gap)
{
    const ritz_io *io = &sides->full->component->io;
    const int64_t points = s->count;
    const int64_t most =
        io->num_inputs < io->num_outputs ? io->num_inputs : io->num_outputs;
    RITZ_OWN_ARRAY double *sigma = NULL, *reduced = NULL;
    int64_t rank = 0;

    RITZ_CHECK_NEW(sigma, points * most);
    RITZ_CHECK_NEW(reduced, points * most);
    RITZ_CHECK(take_singular(io, s, s->full, most, sigma));
    RITZ_CHECK(take_singular(io, s, s->reduced, most, reduced));
    rank = ritz_singular_rank(points, most, sigma);
    for (int64_t k = 0; k < points && rank > 0; k++) {
        double full = sigma[k * most + rank - 1];
        double error = fabs(full - reduced[k * most + rank - 1]);

        gap->singular = fmax(gap->singular, full);
        keep_larger(error, s->hertz[k], &gap->singular_error);
    }
    return RITZ_OK;
}

/* The points of three sweeps; none where there are no points. */
typedef struct sweeps {
    ritz_reference_sweep at[SWEEPS];
} sweeps;

static void sweeps_free(sweeps *s)
{
    for (int k = 0; k < SWEEPS; k++)
        free(s->at[k].reduced);
    ritz_sweep_free(&s->at[SWEEPS - 1]); /* the others are the reference's */
}

ritz_status ritz_sides_respond(ritz_sides *sides)
{
    const ritz_reference *full = sides->full;
    RITZ_OWN(sweeps) s = {{full->own}};
    ritz_reference_sweep *other = &s.at[SWEEPS - 1];

    if (full->own.count == 0)
        return RITZ_OK;
    if (sides->where & RITZ_AT_RANDOM)
        s.at[1] = full->random;
    if (sides->where & RITZ_AT_OTHER_POLES) {
        RITZ_CHECK(ritz_sweep_points(full, &sides->reduced,
                                     &sides->damped_reduced, 2, other));
        RITZ_CHECK_IN("full model", ritz_reference_respond(full, other));
    }
    for (int k = 0; k < SWEEPS; k++)
        RITZ_CHECK(compare_sweep(sides, &s.at[k], &sides->gap));
    for (int k = 0; k < SWEEPS; k++) {
        compare_levels(&s.at[k], &sides->gap);
        if (!isnan(sides->limit[RITZ_MEASURE_SINGULAR]))
            RITZ_CHECK(compare_singular(sides, &s.at[k], &sides->gap));
    }
    return RITZ_OK;
}

/* The largest |f| of the rigid motions that only the reduced model holds; 0:
   none. */
static double find_held(const ritz_sides *sides)
{
    int64_t rigid = sides->full->poles.num_rigid;
    double held = 0.0;

    for (int64_t k = sides->reduced.num_rigid;
         k < rigid && k < sides->small.Phi.ncol; k++)
        held = fmax(held, fabs(ritz_eigen_hertz(sides->small.lambda[k])));
    return held;
}

/* Whether an error belongs to a rigid motion that is held: "9 Hz: rigid
   eigenvalues of rounded K, 0.0338 Hz". */
static bool tell_rigid(const ritz_sides *sides, double hertz,
                       char where[RITZ_NAME_SIZE])
{
    const ritz_reference *full = sides->full;
    const ritz_rounded reduced = {
        .rigid_hz = find_held(sides),
        .flexible_hz =
            ritz_eigen_hertz(full->poles.num_rigid < full->poles.count
                                 ? full->poles.lambda[full->poles.num_rigid]
                                 : 0.0)};

    if (hertz < full->rules_hz)
        (void)snprintf(where, RITZ_NAME_SIZE,
                       "%.6g Hz: rigid eigenvalues of rounded K, %.3g Hz",
                       hertz, full->rounded.rigid_hz);
    else if (hertz < ritz_rounded_ends(&reduced, RITZ_START_ROUNDING))
        (void)snprintf(where, RITZ_NAME_SIZE,
                       "%.6g Hz: reduced K holds rigid motion, %.3g Hz", hertz,
                       reduced.rigid_hz);
    else
        return false;
    return true;
}

/*
 * The error relative to @p unit, with its frequency and damping, "3.41 Hz,
 * modal 0.01 assumed", and the uncertainty of the full response.
 */
static void tell_error(const ritz_sides *sides, ritz_extreme found, double unit,
                       ritz_measure *out)
{
    const ritz_reference *full = sides->full;
    const double uncertain = full->residual.uncertain;
    char damping[RITZ_DAMPING_SIZE] = "";
    size_t used = 0;

    if (!sides->gap.significant)
        return;
    out->value = found.value / unit;
    if (tell_rigid(sides, found.hertz, out->where))
        return;
    ritz_damping_print(&full->damping, damping);
    (void)snprintf(out->where, sizeof out->where, "%.6g Hz%s%.30s%s",
                   found.hertz, damping[0] ? ", " : "", damping,
                   full->assumed ? " assumed" : "");
    used = strlen(out->where);
    if (uncertain > RITZ_RATIO_SETTLED)
        (void)snprintf(out->where + used, sizeof out->where - used,
                       " (to %.0e)", uncertain);
}

/* Models without rigid motion have one response, and it is the flexible one. */
ritz_status ritz_responses_error(const ritz_sides *sides, ritz_measure *out)
{
    tell_error(sides, sides->gap.error, sides->gap.largest, out);
    if (sides->full->poles.num_rigid == 0)
        out->limit = fmin(out->limit, sides->limit[RITZ_MEASURE_FLEXIBLE]);
    return RITZ_OK;
}

ritz_status ritz_responses_flexible(const ritz_sides *sides, ritz_measure *out)
{
    const ritz_gap *gap = &sides->gap;

    if (sides->full->poles.num_rigid > 0 &&
        gap->flexible > RITZ_AUDIBLE * gap->error.value)
        tell_error(sides, gap->error, gap->flexible, out);
    return RITZ_OK;
}

ritz_status ritz_responses_level(const ritz_sides *sides, ritz_measure *out)
{
    tell_error(sides, sides->gap.db, 1.0, out);
    return RITZ_OK;
}

/* The frequency up to which rounding of K dominates the response, if it is in
   the band. */
ritz_status ritz_responses_rounding(const ritz_sides *sides, ritz_measure *out)
{
    const ritz_reference *full = sides->full;
    double start = fmax(full->band_hz[0], RITZ_BAND_START * full->band_hz[1]);

    if (full->rules_hz <= start)
        return RITZ_OK;
    out->value = full->rules_hz;
    (void)snprintf(out->where, sizeof out->where,
                   "rigid eigenvalues of rounded K, %.3g Hz",
                   full->rounded.rigid_hz);
    return RITZ_OK;
}

ritz_status ritz_responses_singular(const ritz_sides *sides, ritz_measure *out)
{
    if (sides->gap.singular > 0.0)
        tell_error(sides, sides->gap.singular_error, sides->gap.singular, out);
    return RITZ_OK;
}

ritz_status ritz_responses_gain(const ritz_sides *sides, ritz_measure *out)
{
    if (!sides->gain_reduced.val) /* no measure with a limit needs it */
        return RITZ_OK;
    (void)snprintf(out->where, sizeof out->where, "largest singular value");
    return ritz_gain_error(&sides->full->gain, &sides->gain_reduced,
                           &out->value);
}
