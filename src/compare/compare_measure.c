/*
 * The second system against the first. Both have modal coordinates of unit
 * mass, so that with q_c = P_c x and q_c = V_c P2_c z
 *
 *     X = sum_c P_c' M_c V_c P2_c,    X_kj^2 = MAC of mode k and mode j
 */
#include "base/alloc.h"
#include "compare/compare_parts.h"

#include <ritz/eigen.h>
#include <ritz/verify.h>

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Modes closer than this in frequency are one cluster. */
static const double same_frequency = 1e-6;

/*
 * An eigenvalue of a dense pencil of order e is in error by up to
 * c eps lambda_max; two are compared, and P and V add their own rounding.
 */
static const double rounding = 20.0; /* c = rounding * e */

ritz_status ritz_compare_correlate(const ritz_stage *stage, const ritz_dense *V,
                                   const ritz_configuration *first,
                                   const ritz_configuration *second,
                                   ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_dense VP = {0}, MVP = {0}, part = {0};

    RITZ_TRY(ritz_dense_new(first->K.ncol, second->K.ncol, X));
    for (int64_t c = 0; c < stage->count; c++) {
        RITZ_TRY(ritz_dense_mul(&V[c], &second->P[c], &VP));
        RITZ_TRY(ritz_dense_mul(&stage->body[c].M, &VP, &MVP));
        RITZ_TRY(ritz_dense_mul_tn(&first->P[c], &MVP, &part));
        for (int64_t k = 0; k < part.nrow * part.ncol; k++)
            X->val[k] += part.val[k];
        ritz_dense_free(&VP);
        ritz_dense_free(&MVP);
        ritz_dense_free(&part);
    }
done:
    ritz_dense_free(&VP);
    ritz_dense_free(&MVP);
    ritz_dense_free(&part);
    return status;
}

/* The mode of the second system that is most like mode k, and how like. */
static int64_t find_partner(const ritz_configuration *second,
                            const ritz_dense *X, int64_t k, double *mac)
{
    int64_t best = second->num_rigid;
    double sum = 0.0;

    for (int64_t j = second->num_rigid; j < X->ncol; j++)
        if (fabs(ritz_dense_col(X, j)[k]) > fabs(ritz_dense_col(X, best)[k]))
            best = j;
    for (int64_t j = second->num_rigid; j < X->ncol; j++)
        if (fabs(sqrt(second->lambda[j] / second->lambda[best]) - 1.0) <=
            same_frequency)
            sum += ritz_dense_col(X, j)[k] * ritz_dense_col(X, j)[k];
    *mac = sum;
    return best;
}

/*
 * Of the modes that matter the smallest MAC and the largest error in frequency.
 * Where they were kept, a mode beyond what rounding allows it comes before any
 * that is within, lest a larger error that is allowed hide it.
 */
static void measure_modes(const ritz_configuration *first,
                          const ritz_configuration *second, const ritz_dense *X,
                          ritz_compare_row *row)
{
    int64_t e = first->K.ncol;
    double c = rounding * (double)e;
    bool any = false, broken = false;

    row->frequency_error = row->mac = row->allowed = nan("");
    for (int64_t i = 0; i < row->num_kept; i++) {
        int64_t k = first->num_rigid + row->kept[i];
        double mac = 0.0, error = 0.0, allowed = 0.0;
        bool beyond = false;
        int64_t j = 0;

        if (second->K.ncol <= second->num_rigid)
            continue;
        j = find_partner(second, X, k, &mac);
        error = fabs(sqrt(fabs(second->lambda[j] / first->lambda[k])) - 1.0);
        allowed = c * DBL_EPSILON * first->lambda[e - 1] / first->lambda[k];
        row->mac = fmin(row->mac, mac); /* which passes NaN over */
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

static void measure_rigid(const ritz_configuration *second,
                          ritz_compare_row *row)
{
    row->rigid_error = 0.0;
    for (int64_t j = 0; j < second->num_rigid; j++)
        row->rigid_error =
            fmax(row->rigid_error, fabs(ritz_eigen_hertz(second->lambda[j])));
}

/* Largest difference of two matrices, relative to the first. */
static double relative(const ritz_dense *one, const ritz_dense *two)
{
    double largest = ritz_dense_max(one);
    double apart = 0.0;

    for (int64_t k = 0; k < one->nrow * one->ncol; k++)
        apart = fmax(apart, fabs(two->val[k] - one->val[k]));
    return largest > 0.0 ? apart / largest : 0.0;
}

ritz_status ritz_compare_gain(const ritz_configuration *first,
                              const ritz_configuration *second, double *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense one = {0}, two = {0};

    RITZ_TRY(ritz_static_gain(&first->K, &first->M, &first->io,
                              first->num_rigid, &one));
    RITZ_TRY(ritz_static_gain(&second->K, &second->M, &second->io,
                              first->num_rigid, &two));
    RITZ_TRY(ritz_gain_error(&one, &two, out));
done:
    ritz_dense_free(&one);
    ritz_dense_free(&two);
    return status;
}

/* C Lambda^-i-1 B of the flexible part. */
static ritz_status moment(const ritz_configuration *c, int64_t i,
                          ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense X = {0};

    RITZ_TRY(ritz_dense_copy(&c->io.B, &X));
    for (int64_t j = 0; j < X.ncol; j++)
        for (int64_t k = 0; k < X.nrow; k++)
            ritz_dense_col(&X, j)[k] *=
                k < c->num_rigid ? 0.0 : pow(c->lambda[k], -1.0 - (double)i);
    RITZ_TRY(ritz_dense_mul(&c->io.C, &X, out));
done:
    ritz_dense_free(&X);
    return status;
}

ritz_status ritz_compare_moments(const ritz_configuration *first,
                                 const ritz_configuration *second,
                                 int64_t count, double *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense one = {0}, two = {0};

    *out = nan("");
    for (int64_t i = 0; i < count && first->io.num_outputs > 0; i++) {
        RITZ_TRY(moment(first, i, &one));
        RITZ_TRY(moment(second, i, &two));
        *out = fmax(*out, relative(&one, &two));
        ritz_dense_free(&one);
        ritz_dense_free(&two);
    }
done:
    ritz_dense_free(&one);
    ritz_dense_free(&two);
    return status;
}

/* Largest difference over largest magnitude, on the first system's points. */
static ritz_status measure_response(const ritz_scene *scene,
                                    const ritz_configuration *first,
                                    const ritz_configuration *second,
                                    ritz_compare_row *row)
{
    ritz_status status = RITZ_OK;
    ritz_two_responses r = {0};
    double largest = 0.0, gap = 0.0;

    RITZ_TRY(ritz_compare_respond(scene, first, second, &r));
    for (int64_t k = 0; k < r.count * r.num_inputs * r.num_outputs; k++) {
        largest = fmax(largest, cabs(r.one[k]));
        gap = fmax(gap, cabs(r.one[k] - r.two[k]));
    }
    row->response_error = largest > 0.0 ? gap / largest : 0.0;
done:
    ritz_two_responses_free(&r);
    return status;
}

ritz_status ritz_compare_measure(const ritz_stage *stage, const ritz_dense *V,
                                 const ritz_configuration *first,
                                 ritz_configuration *second,
                                 ritz_compare_row *row)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    ritz_dense X = {0};

    row->num_rigid = first->num_rigid;
    row->num_flexible = first->K.ncol - first->num_rigid;
    row->gain_error = row->response_error = nan("");
    RITZ_TRY(ritz_compare_correlate(stage, V, first, second, &X));
    measure_modes(first, second, &X, row);
    measure_rigid(second, row);
    RITZ_TRY(ritz_compare_strays(scene, first, second, &X, row));
    RITZ_TRY(ritz_compare_remove(row, second));
    row->order = second->K.ncol;
    if (scene->num_inputs > 0 && scene->num_outputs > 0)
        RITZ_TRY(ritz_compare_gain(first, second, &row->gain_error));
    RITZ_TRY(ritz_compare_moments(first, second, row->num_moments,
                                  &row->moment_error));
    if (ritz_compare_responds(scene))
        RITZ_TRY(measure_response(scene, first, second, row));
done:
    ritz_dense_free(&X);
    return status;
}
