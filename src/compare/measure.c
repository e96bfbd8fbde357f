/*
 * Responses of two systems, and the MIMO Bode plot of both: the magnitude of a
 * transfer matrix at a frequency is bounded by its largest singular value, by
 * which attachment modes are compared [McDaniel2000, sec. 3.2.2].
 */
#include "base/alloc.h"
#include "base/tolerances.h"

#include "compare/compare.h"
#include "poles/poles.h"

#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <complex.h>
#include <float.h>
#include <math.h>

bool ritz_compare_responds(const ritz_scene *scene)
{
    return scene->num_inputs > 0 && scene->num_outputs > 0 &&
           scene->band_hz[1] > 0.0 && scene->damping.kind != RITZ_DAMPING_NONE;
}

/* Poles of a configuration, damped as the scene says. */
static ritz_status find_poles(const ritz_scene *scene,
                              const ritz_configuration *c, ritz_poles *out)
{
    const ritz_second_order model = {&c->K, &c->M, &c->D, &c->K4, &c->io};

    return ritz_poles_of_dense(&model, &scene->damping, scene->band_hz[1], out);
}

static ritz_status respond_at(const ritz_scene *scene,
                              const ritz_configuration *c,
                              const ritz_grid *grid, ritz_response *out)
{
    RITZ_OWN(ritz_poles) poles = {0};
    RITZ_OWN(ritz_response) made = {0};

    RITZ_CHECK(find_poles(scene, c, &poles));
    RITZ_CHECK(ritz_response_new(grid, &poles, &made));
    RITZ_CHECK(ritz_poles_add_all(&poles, made.count, made.hertz, made.H));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* Response over the band, with additional points around each resonance. */
static ritz_status respond_over_band(const ritz_scene *scene,
                                     const ritz_configuration *configuration,
                                     ritz_response *out)
{
    const ritz_grid grid = {
        .from_hz = fmax(scene->band_hz[0], RITZ_BAND_START * scene->band_hz[1]),
        .to_hz = scene->band_hz[1],
        .count = 200,
        .refine = true,
    };

    return respond_at(scene, configuration, &grid, out);
}

ritz_status ritz_compare_follow(const ritz_scene *scene,
                                const ritz_configuration *configuration,
                                const ritz_response *points, ritz_response *out)
{
    const ritz_grid grid = {.count = points->count, .hertz = points->hertz};

    return respond_at(scene, configuration, &grid, out);
}

ritz_status ritz_rows_respond(ritz_rows *rows)
{
    const ritz_scene *scene = rows->stage->scene;

    if (rows->response || !ritz_compare_responds(scene))
        return RITZ_OK;
    RITZ_CHECK_NEW(rows->response, rows->listed->num_configurations);
    rows->num_responses = rows->listed->num_configurations;
    for (int64_t k = 0; k < rows->num_responses; k++)
        RITZ_CHECK(respond_over_band(scene, ritz_rows_first(rows, k),
                                     &rows->response[k]));
    return RITZ_OK;
}

void ritz_rows_free(ritz_rows *rows)
{
    RITZ_FREE_EACH(ritz_response, rows->num_responses, rows->response);
    ritz_system_free(&rows->between);
}

/* All singular values at each point of a response, descending. */
static ritz_status list_singular(const ritz_scales *scales,
                                 const ritz_response *r, int64_t width,
                                 double *sigma)
{
    for (int64_t k = 0; k < r->count; k++)
        RITZ_CHECK(
            ritz_singular_values(r->num_outputs, r->num_inputs,
                                 r->H + k * r->num_outputs * r->num_inputs,
                                 scales, sigma + k * width));
    return RITZ_OK;
}

/* The worst deviation of singular value @p i between two responses. */
static void compare_curve(const ritz_response *r, int64_t width, int64_t i,
                          const double *one, const double *two,
                          double *deviation, double *hertz)
{
    double mean = 0.0;
    int64_t nonzero = 0;

    for (int64_t k = 0; k < r->count; k++)
        if (one[k * width + i] > 0.0) {
            mean += log(one[k * width + i]);
            nonzero++;
        }
    mean = nonzero > 0 ? exp(mean / (double)nonzero) : 0.0;
    *deviation = 0.0;
    *hertz = r->count > 0 ? r->hertz[0] : 0.0;
    for (int64_t k = 0; k < r->count; k++) {
        double first = one[k * width + i], second = two[k * width + i];
        double level = fmax(first, RITZ_BODE_FLOOR * mean);
        double error = level > 0.0 ? fabs(second - first) / level : 0.0;

        if (error > *deviation) {
            *deviation = error;
            *hertz = r->hertz[k];
        }
    }
}

ritz_status ritz_compare_bode(const ritz_scales *scales,
                              const ritz_response *first,
                              const ritz_response *second, ritz_bode_gap *out)
{
    const ritz_response *r = first;
    const int64_t width =
        r->num_inputs < r->num_outputs ? r->num_inputs : r->num_outputs;
    RITZ_OWN_ARRAY double *one = NULL, *two = NULL;
    int64_t rank = 0;

    RITZ_CHECK_NEW(one, r->count * width);
    RITZ_CHECK_NEW(two, r->count * width);
    RITZ_CHECK(list_singular(scales, first, width, one));
    RITZ_CHECK(list_singular(scales, second, width, two));
    rank = ritz_singular_rank(r->count, width, one);
    for (int k = 0; k < 2; k++)
        compare_curve(r, width, k == 0 || rank == 0 ? 0 : rank - 1, one, two,
                      &out->deviation[k], &out->hertz[k]);
    return RITZ_OK;
}

/*
 * Stray modes: those of the second system that represent no kept mode. With
 * modes of unit mass and X_kj their M-products, the part of mode j in the kept
 * modes' space is
 *
 *     s_j = sum over kept k of X_kj^2,    0 <= s_j <= 1
 *
 * which does not depend on the basis of a cluster. It represents kept modes if
 * that is half or more; the sum over all j is at most their number. The others
 * are due to the projection: bodies have more coordinates than the system had
 * modes [McDaniel2000, table 3.3]. Static corrections are among them.
 */

/*
 * Describe a stray mode, and find the mode of the first system with the largest
 * MAC.
 */
static ritz_stray describe_stray(const ritz_scene *scene,
                                 const ritz_configuration *first, double lambda,
                                 const double *x)
{
    ritz_stray stray = {.hertz = ritz_eigen_hertz(lambda), .like = -1};
    bool outside =
        stray.hertz < scene->band_hz[0] || stray.hertz > scene->band_hz[1];

    for (int64_t k = first->num_rigid; k < first->K.ncol; k++)
        if (x[k] * x[k] > stray.mac) {
            stray.mac = x[k] * x[k];
            stray.like = k - first->num_rigid;
        }
    stray.removed =
        scene->extraneous == RITZ_EXTRANEOUS_REMOVE ||
        (scene->extraneous == RITZ_EXTRANEOUS_OUT_OF_BAND && outside);
    return stray;
}

/* Flexible modes of stage 2 that represent no kept mode. */
static ritz_status find_strays(const ritz_scene *scene,
                               const ritz_configuration *first,
                               const ritz_configuration *second,
                               const ritz_dense *X, ritz_compare_row *row)
{
    const double half = 0.5;

    RITZ_CHECK_NEW(row->stray, second->K.ncol);
    if (scene->select == RITZ_SELECT_KRYLOV)
        return RITZ_OK; /* no mode was kept, so none is stray */
    for (int64_t j = second->num_rigid; j < second->K.ncol; j++) {
        const double *x = ritz_dense_col(X, j);
        double part = 0.0; /* s_j */

        for (int64_t i = 0; i < row->num_kept; i++)
            part += x[first->num_rigid + row->kept[i]] *
                    x[first->num_rigid + row->kept[i]];
        if (part >= half)
            continue;
        row->stray[row->num_strays] =
            describe_stray(scene, first, second->lambda[j], x);
        row->stray[row->num_strays++].mode = j - second->num_rigid;
    }
    return RITZ_OK;
}

/* Keep columns `keep` of A, or rows. */
static ritz_status keep_some(bool rows, int64_t count, const int64_t *keep,
                             ritz_dense *A)
{
    RITZ_OWN(ritz_dense) kept = {0};

    if (!A->val)
        return RITZ_OK;
    RITZ_CHECK(rows ? ritz_dense_rows(A, count, keep, &kept)
                    : ritz_dense_pick(A, count, keep, &kept));
    ritz_dense_replace(A, &kept);
    return RITZ_OK;
}

/* Keep the modes `keep` of a configuration and no others; keep[j] >= j. */
static ritz_status truncate_modes(int64_t count, const int64_t *keep,
                                  ritz_configuration *c)
{
    ritz_dense *const columns[] = {&c->io.C, &c->io.Cv,    &c->io.Ca,
                                   &c->K,    &c->M,        &c->D,
                                   &c->K4,   &c->momentum, NULL};
    ritz_dense *const rows[] = {&c->io.B, &c->dampers.B, &c->K, &c->M,
                                &c->D,    &c->K4,        NULL};

    for (int64_t k = 0; k < c->num_blocks; k++)
        RITZ_CHECK(keep_some(false, count, keep, &c->P[k]));
    for (ritz_dense *const *A = columns; *A; A++)
        RITZ_CHECK(keep_some(false, count, keep, *A));
    for (ritz_dense *const *A = rows; *A; A++)
        RITZ_CHECK(keep_some(true, count, keep, *A));
    for (int64_t j = 0; j < count; j++)
        c->lambda[j] = c->lambda[keep[j]];
    return RITZ_OK;
}

/* Remove the modes marked `removed` from the second system. */
static ritz_status remove_strays(const ritz_compare_row *row,
                                 ritz_configuration *second)
{
    RITZ_OWN_ARRAY int64_t *keep = NULL;
    int64_t count = 0;
    int64_t next = 0; /* strays ascend by mode */

    RITZ_CHECK_NEW(keep, second->K.ncol);
    for (int64_t j = 0; j < second->K.ncol; j++) {
        bool stray = next < row->num_strays &&
                     row->stray[next].mode + second->num_rigid == j;

        if (!stray || !row->stray[next].removed)
            keep[count++] = j;
        next += stray;
    }
    return count < second->K.ncol ? truncate_modes(count, keep, second)
                                  : RITZ_OK;
}

/*
 * Comparison of the second system with the first. Both have modal coordinates
 * of unit mass, so that with q_c = P_c x and q_c = V_c P2_c z
 *
 *     X = sum_c P_c' M_c V_c P2_c,    X_kj^2 = MAC of mode k and mode j
 */

ritz_status ritz_modes_correlate(const ritz_stage *stage, const ritz_dense *V,
                                 bool flexible, const ritz_configuration *first,
                                 const ritz_configuration *second,
                                 ritz_dense *X)
{
    int64_t i = flexible ? first->num_rigid : 0;
    int64_t j = flexible ? second->num_rigid : 0;
    int64_t m = first->K.ncol - i, n = second->K.ncol - j;

    RITZ_CHECK(ritz_dense_new(m, n, X));
    for (int64_t c = 0; c < stage->count; c++) {
        const ritz_dense P = ritz_dense_part(&first->P[c], i, m);
        const ritz_dense P2 = ritz_dense_part(&second->P[c], j, n);
        RITZ_OWN(ritz_dense) VP = {0}, MVP = {0}, part = {0};

        if (V)
            RITZ_CHECK(ritz_dense_mul(&V[c], &P2, &VP));
        RITZ_CHECK(ritz_dense_mul(&stage->body[c].M, V ? &VP : &P2, &MVP));
        RITZ_CHECK(ritz_dense_mul_tn(&P, &MVP, &part));
        for (int64_t k = 0; k < m * n; k++)
            X->val[k] += part.val[k];
    }
    return RITZ_OK;
}

/*
 * The mode of the second system with the largest MAC with mode k, and that MAC.
 */
static int64_t find_paired_mode(const ritz_configuration *second,
                                const ritz_dense *X, int64_t k, double *mac)
{
    int64_t best = second->num_rigid;
    double sum = 0.0;

    for (int64_t j = second->num_rigid; j < X->ncol; j++)
        if (fabs(ritz_dense_col(X, j)[k]) > fabs(ritz_dense_col(X, best)[k]))
            best = j;
    for (int64_t j = second->num_rigid; j < X->ncol; j++)
        if (fabs(sqrt(second->lambda[j] / second->lambda[best]) - 1.0) <=
            RITZ_CLUSTER_GAP)
            sum += ritz_dense_col(X, j)[k] * ritz_dense_col(X, j)[k];
    *mac = sum;
    return best;
}

/*
 * The smallest MAC and the largest error in frequency of the modes that matter.
 * If any mode exceeds its allowed error, only such modes count, so that a
 * larger error that is allowed does not hide them. Kept modes are allowed their
 * rounding and, if bodies were compacted, the scene's tolerance.
 */
static void measure_modes(const ritz_scene *scene,
                          const ritz_configuration *first,
                          const ritz_configuration *second, const ritz_dense *X,
                          ritz_compare_row *row)
{
    int64_t e = first->K.ncol;
    double c = RITZ_EIGENVALUE_ROUNDING * (double)e;
    double least = scene->extraneous == RITZ_EXTRANEOUS_COMPACT
                       ? scene->extraneous_tolerance
                       : 0.0;
    bool any = false, broken = false;

    row->frequency_error = row->mac = row->allowed = nan("");
    for (int64_t i = 0; i < row->num_kept; i++) {
        int64_t k = first->num_rigid + row->kept[i];
        double mac = 0.0, error = 0.0, allowed = 0.0;
        bool beyond = false;
        int64_t j = 0;

        if (second->K.ncol <= second->num_rigid)
            continue;
        j = find_paired_mode(second, X, k, &mac);
        error = fabs(sqrt(fabs(second->lambda[j] / first->lambda[k])) - 1.0);
        allowed = fmax(
            c * DBL_EPSILON * first->lambda[e - 1] / first->lambda[k], least);
        row->mac = fmin(row->mac, mac); /* fmin ignores NaN */
        beyond = row->listed && error > allowed;
        if (!any || beyond > broken ||
            (beyond == broken && error > row->frequency_error)) {
            any = true;
            broken = beyond;
            row->frequency_error = error;
            row->allowed = row->listed ? allowed : nan("");
        }
    }
}

ritz_status ritz_compare_gain(const ritz_configuration *first,
                              const ritz_configuration *second, double *out)
{
    RITZ_OWN(ritz_dense) one = {0}, two = {0};

    RITZ_CHECK(ritz_static_gain(&first->K, &first->M, &first->io,
                                first->num_rigid, &one));
    RITZ_CHECK(ritz_static_gain(&second->K, &second->M, &second->io,
                                first->num_rigid, &two));
    return ritz_gain_error(&one, &two, out);
}

/* The moment C Lambda^-i-1 B of the flexible part. */
static ritz_status compute_moment(const ritz_configuration *c, int64_t i,
                                  ritz_dense *out)
{
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_dense_copy(&c->io.B, &X));
    for (int64_t j = 0; j < X.ncol; j++)
        for (int64_t k = 0; k < X.nrow; k++)
            ritz_dense_col(&X, j)[k] *=
                k < c->num_rigid ? 0.0 : pow(c->lambda[k], -1.0 - (double)i);
    return ritz_dense_mul(&c->io.C, &X, out);
}

/* Worst error of the kept moments, relative to the largest entry of each; NaN
    if there are none. */
static ritz_status measure_moments(const ritz_configuration *first,
                                   const ritz_configuration *second,
                                   int64_t count, double *out)
{
    *out = nan("");
    for (int64_t i = 0; i < count && first->io.num_outputs > 0; i++) {
        RITZ_OWN(ritz_dense) one = {0}, two = {0};
        double largest = 0.0, gap = 0.0;

        RITZ_CHECK(compute_moment(first, i, &one));
        RITZ_CHECK(compute_moment(second, i, &two));
        largest = ritz_dense_max(&one);
        for (int64_t k = 0; k < one.nrow * one.ncol; k++)
            gap = fmax(gap, fabs(two.val[k] - one.val[k]));
        *out = fmax(*out, largest > 0.0 ? gap / largest : 0.0);
    }
    return RITZ_OK;
}

/*
 * Largest difference relative to the largest magnitude, at the first system's
 * points.
 */
static ritz_status measure_response(const ritz_scene *scene,
                                    const ritz_configuration *first,
                                    const ritz_response *given,
                                    const ritz_configuration *second,
                                    ritz_compare_row *row)
{
    RITZ_OWN(ritz_response) made = {0}, two = {0};
    const ritz_response *one = given ? given : &made;
    double largest = 0.0, gap = 0.0;

    if (!given)
        RITZ_CHECK(respond_over_band(scene, first, &made));
    RITZ_CHECK(ritz_compare_follow(scene, second, one, &two));
    for (int64_t k = 0; k < two.count * two.num_inputs * two.num_outputs; k++) {
        largest = fmax(largest, cabs(one->H[k]));
        gap = fmax(gap, cabs(one->H[k] - two.H[k]));
    }
    row->response_error = largest > 0.0 ? gap / largest : 0.0;
    return RITZ_OK;
}

/*
 * The largest error of the damping ratios of the modes that matter. Where D
 * couples modes, a mode is represented by the pole that it has become, and is
 * paired with the nearest pole of the second system, as in verify/modes.c.
 */
static double damping_error(const ritz_damped *two, int64_t count,
                            double _Complex s, double zeta)
{
    double other = ritz_spectrum_ratio(ritz_damped_nearest(two, count, s));

    if (isnan(zeta) || other == zeta)
        return isnan(zeta) ? zeta : 0.0;
    return isnan(other) ? 1.0
                        : fabs(other - zeta) / fmax(fabs(other), fabs(zeta));
}

/* Whether every flexible mode has a positive eigenvalue. */
static bool is_stable(const ritz_configuration *c)
{
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        if (!(c->lambda[k] > 0.0))
            return false;
    return true;
}

static ritz_status measure_damping(const ritz_scene *scene,
                                   const ritz_configuration *first,
                                   const ritz_configuration *second,
                                   ritz_compare_row *row)
{
    RITZ_OWN(ritz_poles) p = {0}, p2 = {0};
    RITZ_OWN(ritz_damped) one = {0}, two = {0};
    double largest = 0.0;

    if (row->num_kept == 0 || !is_stable(first) || !is_stable(second))
        return RITZ_OK;
    RITZ_CHECK(find_poles(scene, first, &p));
    RITZ_CHECK(find_poles(scene, second, &p2));
    RITZ_CHECK(ritz_damped_new(&p, NULL, NULL, scene->band_hz, &one));
    RITZ_CHECK(ritz_damped_new(&p2, NULL, NULL, scene->band_hz, &two));
    for (int64_t k = 0; k < p.count; k++)
        largest = fmax(largest, fabs(one.zeta[k])); /* fmax ignores NaN */
    for (int64_t i = 0; i < row->num_kept && largest > 0.0; i++) {
        int64_t k = first->num_rigid + row->kept[i];

        row->damping_error =
            fmax(row->damping_error,
                 fabs(one.zeta[k]) <= RITZ_NEGLIGIBLE * largest
                     ? 0.0
                     : damping_error(&two, p2.count, one.s[k], one.zeta[k]));
    }
    return RITZ_OK;
}

ritz_status ritz_compare_measure(const ritz_stage *stage, const ritz_dense *V,
                                 const ritz_configuration *first,
                                 const ritz_response *response,
                                 ritz_configuration *second,
                                 ritz_compare_row *row)
{
    const ritz_scene *scene = stage->scene;
    RITZ_OWN(ritz_dense) X = {0};

    row->num_rigid = first->num_rigid;
    row->num_flexible = first->K.ncol - first->num_rigid;
    row->gain_error = row->response_error = row->damping_error = nan("");
    RITZ_CHECK(ritz_modes_correlate(stage, V, false, first, second, &X));
    measure_modes(scene, first, second, &X, row);
    row->rigid_error = 0.0;
    for (int64_t j = 0; j < second->num_rigid; j++)
        row->rigid_error =
            fmax(row->rigid_error, fabs(ritz_eigen_hertz(second->lambda[j])));
    RITZ_CHECK(find_strays(scene, first, second, &X, row));
    RITZ_CHECK(remove_strays(row, second));
    row->order = second->K.ncol;
    if (scene->num_inputs > 0 && scene->num_outputs > 0)
        RITZ_CHECK(ritz_compare_gain(first, second, &row->gain_error));
    RITZ_CHECK(
        measure_moments(first, second, row->num_moments, &row->moment_error));
    RITZ_CHECK(measure_damping(scene, first, second, row));
    if (ritz_compare_responds(scene))
        RITZ_CHECK(measure_response(scene, first, response, second, row));
    return RITZ_OK;
}

ritz_status ritz_rows_measure(const ritz_rows *rows, int64_t k,
                              const ritz_dense *V, ritz_configuration *second,
                              ritz_compare_row *row)
{
    *row = rows->row[k];
    row->num_strays = 0;
    row->stray = NULL;
    return ritz_compare_measure(rows->stage, V, ritz_rows_first(rows, k),
                                rows->response ? &rows->response[k] : NULL,
                                second, row);
}
