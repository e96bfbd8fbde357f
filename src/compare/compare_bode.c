/*
 * Responses of two systems, and the MIMO Bode plot of both: the magnitude of a
 * transfer matrix at a frequency is bounded by its largest singular value, in
 * which attachment modes are compared [McDaniel2000, sec. 3.2.2].
 */
#include "base/alloc.h"
#include "compare/compare_parts.h"
#include "poles/dense_poles.h"

#include <lapacke.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

    return ritz_poles_of_dense(&model, &scene->damping, out);
}

ritz_status ritz_compare_respond(const ritz_scene *scene,
                                 const ritz_configuration *first,
                                 const ritz_configuration *second,
                                 ritz_two_responses *out)
{
    ritz_status status = RITZ_OK;
    const ritz_grid grid = {
        .from_hz = fmax(scene->band_hz[0], 1e-3 * scene->band_hz[1]),
        .to_hz = scene->band_hz[1],
        .count = 200,
        .refine = true,
    };
    ritz_poles one = {0}, two = {0};
    ritz_response r = {0};
    int64_t size = first->io.num_inputs * first->io.num_outputs;

    RITZ_TRY(find_poles(scene, first, &one));
    RITZ_TRY(find_poles(scene, second, &two));
    RITZ_TRY(ritz_response_new(&grid, &one, "modal", &scene->damping, &r));
    RITZ_NEW(out->two, r.count * size);
    for (int64_t k = 0; k < r.count; k++) {
        RITZ_TRY(ritz_poles_add(&one, r.hertz[k], r.H + k * size));
        RITZ_TRY(ritz_poles_add(&two, r.hertz[k], out->two + k * size));
    }
    out->count = r.count;
    out->num_inputs = first->io.num_inputs;
    out->num_outputs = first->io.num_outputs;
    out->hertz = r.hertz;
    out->one = r.H;
    r.hertz = NULL;
    r.H = NULL;
done:
    ritz_poles_free(&one);
    ritz_poles_free(&two);
    ritz_response_free(&r);
    return status;
}

void ritz_two_responses_free(ritz_two_responses *responses)
{
    free(responses->hertz);
    free(responses->one);
    free(responses->two);
    *responses = (ritz_two_responses){0};
}

/* Largest singular value of each of some matrices, m x n. */
static ritz_status largest_singular(int64_t count, int64_t m, int64_t n,
                                    const double _Complex *H, double *out)
{
    ritz_status status = RITZ_OK;
    int64_t least = m < n ? m : n;
    double _Complex *A = NULL;
    double *sigma = NULL, *work = NULL;

    RITZ_NEW(A, m * n);
    RITZ_NEW(sigma, least);
    RITZ_NEW(work, least);
    for (int64_t k = 0; k < count; k++) {
        memcpy(A, H + k * m * n, (size_t)(m * n) * sizeof *A);
        RITZ_FAIL_IF(LAPACKE_zgesvd(LAPACK_COL_MAJOR, 'N', 'N', (int)n, (int)m,
                                    A, (int)n, sigma, NULL, 1, NULL, 1,
                                    work) != 0,
                     RITZ_ERR_CONVERGENCE,
                     "singular values of a response do not converge");
        out[k] = sigma[0];
    }
done:
    free(A);
    free(sigma);
    free(work);
    return status;
}

ritz_status ritz_compare_bode(const ritz_two_responses *responses,
                              double *deviation, double *hertz)
{
    ritz_status status = RITZ_OK;
    const ritz_two_responses *r = responses;
    const double far_below = 1e-3; /* 60 dB */
    double *one = NULL, *two = NULL;
    double mean = 0.0;
    int64_t seen = 0;

    RITZ_NEW(one, r->count);
    RITZ_NEW(two, r->count);
    RITZ_TRY(
        largest_singular(r->count, r->num_outputs, r->num_inputs, r->one, one));
    RITZ_TRY(
        largest_singular(r->count, r->num_outputs, r->num_inputs, r->two, two));
    for (int64_t k = 0; k < r->count; k++)
        if (one[k] > 0.0) {
            mean += log(one[k]);
            seen++;
        }
    mean = seen > 0 ? exp(mean / (double)seen) : 0.0;
    *deviation = 0.0;
    *hertz = r->count > 0 ? r->hertz[0] : 0.0;
    for (int64_t k = 0; k < r->count; k++) {
        double level = fmax(one[k], far_below * mean);
        double apart = level > 0.0 ? fabs(two[k] - one[k]) / level : 0.0;

        if (apart > *deviation) {
            *deviation = apart;
            *hertz = r->hertz[k];
        }
    }
done:
    free(one);
    free(two);
    return status;
}
