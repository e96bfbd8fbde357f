/* Singular values of responses, by LAPACK zgesvd of scaled H. */
#include "linear/search.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/response.h>

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

static double channel_scale(const double *scale, int64_t k)
{
    return scale && !isnan(scale[k]) ? scale[k] : 1.0;
}

static int64_t smaller_of(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

ritz_status ritz_singular_values(int64_t num_outputs, int64_t num_inputs,
                                 const double _Complex *H,
                                 const ritz_scales *scales, double *sigma)
{
    static const ritz_scales none = {0};
    int p = (int)num_outputs, m = (int)num_inputs, info = 0;
    RITZ_OWN_ARRAY double _Complex *A = NULL;
    RITZ_OWN_ARRAY double *spare = NULL;

    if (p == 0 || m == 0)
        return RITZ_OK;
    scales = scales ? scales : &none;
    RITZ_CHECK_NEW(A, num_outputs * num_inputs);
    RITZ_CHECK_NEW(spare, smaller_of(num_outputs, num_inputs));
    for (int64_t i = 0; i < p; i++)
        for (int64_t j = 0; j < m; j++)
            A[i + j * p] = H[i * m + j] * channel_scale(scales->input, j) /
                           channel_scale(scales->output, i);
    info = LAPACKE_zgesvd(LAPACK_COL_MAJOR, 'N', 'N', p, m, A, p, sigma, NULL,
                          1, NULL, 1, spare);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "singular values of a response were not found");
    return RITZ_OK;
}

int64_t ritz_singular_rank(int64_t points, int64_t most, const double *sigma)
{
    double largest = 0.0;
    int64_t rank = 0;

    for (int64_t k = 0; k < points && most > 0; k++)
        largest = fmax(largest, sigma[k * most]);
    for (int64_t k = 0; k < points; k++)
        while (rank < most &&
               sigma[k * most + rank] > RITZ_ZERO_SINGULAR * largest)
            rank++;
    return rank;
}

ritz_status ritz_singular_of(const ritz_scales *scales, ritz_response *r)
{
    int64_t size = r->num_outputs * r->num_inputs;
    int64_t width = smaller_of(r->num_outputs, r->num_inputs);
    RITZ_OWN_ARRAY double *sigma = NULL;

    RITZ_CHECK_NEW(sigma, r->count * width);
    for (int64_t k = 0; k < r->count; k++)
        RITZ_CHECK(ritz_singular_values(r->num_outputs, r->num_inputs,
                                        r->H + k * size, scales,
                                        sigma + k * width));
    free(r->singular);
    RITZ_MOVE(r->singular, sigma);
    r->num_singular = width;
    return RITZ_OK;
}

/* The state of the search for the peak. */
typedef struct sampler {
    const ritz_response *response;
    const ritz_scales *scales;
    ritz_responder *responder;
    double _Complex *H;
    double *sigma;
} sampler;

static void sampler_free(sampler *s)
{
    RITZ_FREE(s->H, s->sigma);
}

static ritz_status largest_at(void *state, double hertz, double *value)
{
    sampler *s = state;
    const ritz_response *r = s->response;

    RITZ_CHECK(ritz_responder_at(s->responder, hertz, s->H));
    RITZ_CHECK(ritz_singular_values(r->num_outputs, r->num_inputs, s->H,
                                    s->scales, s->sigma));
    *value = s->sigma[0];
    return RITZ_OK;
}

ritz_status ritz_singular_peak(const ritz_response *r,
                               const ritz_scales *scales,
                               ritz_responder *responder, double *hertz,
                               double *value)
{
    int64_t size = r->num_outputs * r->num_inputs;
    RITZ_OWN(sampler)
    s = {.response = r, .scales = scales, .responder = responder};
    const ritz_curve curve = {largest_at, &s};
    RITZ_OWN_ARRAY double *first = NULL;

    *hertz = *value = 0.0;
    if (size == 0 || r->count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(first, r->count);
    RITZ_CHECK_NEW(s.H, size);
    RITZ_CHECK_NEW(s.sigma, smaller_of(r->num_outputs, r->num_inputs));
    for (int64_t k = 0; k < r->count; k++) {
        RITZ_CHECK(ritz_singular_values(r->num_outputs, r->num_inputs,
                                        r->H + k * size, scales, s.sigma));
        first[k] = s.sigma[0];
    }
    return ritz_curve_peak(r->count, r->hertz, first, responder ? &curve : NULL,
                           hertz, value);
}
