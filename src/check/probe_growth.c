/*
 * How large a free motion becomes before it dies: the largest |e^(A t)|^2.
 *
 * In y = [w q; q'] of the modes |y|^2 is twice the energy, and
 *
 *     d/dt |y|^2 = y'(A + A')y = -2 q'' Delta q',
 *
 * so where D's symmetric part is semidefinite nothing grows. Otherwise e^(A t)
 * is met at t = h 2^(i/4) by squaring, which gives what is reached at least;
 * and with A V = V B, B of diagonal blocks [a b; -b a], a <= 0,
 *
 *     |e^(A t)| <= |V| |V^-1|
 *
 * gives what is reached at most.
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    MOST_STATES = 400, /* of whose exponential powers are taken */
    FOURTHS = 4,       /* of an octave */
    TERMS = 14, /* of a Taylor series at |A h| <= 1/2: 0.5^15 / 15! < eps */
};
/* Of a free motion so small nothing is said any more. */
static const double died_out = 1e-3;
/* Of |A| t: squaring has added up rounding to 1e-7 then. */
static const double long_enough = 1e-7 / DBL_EPSILON;

ritz_status ritz_probe_energy_matrix(const ritz_first_order *modes,
                                     ritz_dense *out)
{
    int64_t m = modes->count;
    int64_t r = modes->num_rigid;
    int64_t f = m - r;
    ritz_dense A = {0};

    RITZ_CHECK(ritz_dense_new(f + m, f + m, &A));
    for (int64_t k = r; k < m; k++) {
        double w = sqrt(fabs(modes->lambda[k]));

        ritz_dense_col(&A, f + k)[k - r] = w;
        ritz_dense_col(&A, k - r)[f + k] = -w;
    }
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < m; i++)
            ritz_dense_col(&A, f + j)[f + i] =
                -ritz_dense_col(&modes->Delta, j)[i];
    *out = A;
    return RITZ_OK;
}

static double norm_one(const ritz_dense *A)
{
    return LAPACKE_dlange(LAPACK_COL_MAJOR, '1', (int)A->nrow, (int)A->ncol,
                          A->val, (int)A->nrow);
}

/* e^(A h) where |A h| <= 1/2, by Horner's rule. */
static ritz_status exponential(const ritz_dense *A, double h, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = A->nrow;
    ritz_dense E = {0}, next = {0};

    RITZ_TRY(ritz_dense_new(n, n, &E));
    for (int64_t i = 0; i < n; i++)
        ritz_dense_col(&E, i)[i] = 1.0;
    for (int term = TERMS; term > 0; term--) {
        RITZ_TRY(ritz_dense_mul(A, &E, &next));
        for (int64_t k = 0; k < n * n; k++)
            next.val[k] *= h / term;
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&next, i)[i] += 1.0;
        ritz_dense_free(&E);
        E = next;
        next = (ritz_dense){0};
    }
    *out = E;
    E = (ritz_dense){0};
done:
    ritz_dense_free(&E);
    ritz_dense_free(&next);
    return status;
}

/* e^(A h), e^(2 A h), e^(4 A h), ... until nothing is left, or t = most. */
static ritz_status follow(const ritz_dense *A, double h, double most,
                          ritz_growth *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense E = {0}, next = {0};
    double size = 1.0;

    RITZ_TRY(exponential(A, h, &E));
    for (int k = 0; size > died_out && h * ldexp(1.0, k) <= most; k++) {
        RITZ_TRY(ritz_dense_copy(&E, &next));
        RITZ_TRY(ritz_general_norm(&next, &size));
        ritz_dense_free(&next);
        if (!(size < 1e100)) /* what is unstable is told by its poles */
            break;
        if (size * size > out->met) {
            out->met = size * size;
            out->seconds = h * ldexp(1.0, k);
        }
        RITZ_TRY(ritz_dense_mul(&E, &E, &next));
        ritz_dense_free(&E);
        E = next;
        next = (ritz_dense){0};
    }
done:
    ritz_dense_free(&E);
    ritz_dense_free(&next);
    return status;
}

/* (|V| |V^-1|)^2, eigenvectors of A as columns of length 1. */
static ritz_status bound(const ritz_dense *A, double *out)
{
    ritz_status status = RITZ_OK;
    int n = (int)A->nrow;
    ritz_dense H = {0}, V = {0};
    double *re = NULL, *im = NULL, *sigma = NULL;
    int info = 0;

    RITZ_TRY(ritz_dense_copy(A, &H));
    RITZ_TRY(ritz_dense_new(n, n, &V));
    RITZ_NEW(re, n);
    RITZ_NEW(im, n);
    RITZ_NEW(sigma, n);
    info = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', n, H.val, n, re, im, NULL,
                         1, V.val, n);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE, "poles were not found");
    RITZ_TRY(ritz_general_singular(&V, sigma));
    *out = sigma[n - 1] > 0.0 ? pow(sigma[0] / sigma[n - 1], 2.0) : HUGE_VAL;
done:
    ritz_dense_free(&H);
    ritz_dense_free(&V);
    free(re);
    free(im);
    free(sigma);
    return status;
}

ritz_status ritz_growth_measure(const ritz_dense *A, ritz_growth *out)
{
    double size = norm_one(A);

    *out = (ritz_growth){.met = 1.0, .most = HUGE_VAL, .followed = true};
    if (A->nrow == 0 || size == 0.0) {
        out->most = 1.0;
        return RITZ_OK;
    }
    RITZ_CHECK(bound(A, &out->most));
    out->followed = A->nrow <= MOST_STATES;
    if (!out->followed)
        return RITZ_OK;
    for (int k = 0; k < FOURTHS; k++)
        RITZ_CHECK(follow(A, 0.25 / size * exp2((double)k / FOURTHS),
                          long_enough / size, out));
    out->most = fmax(out->most, out->met);
    return RITZ_OK;
}

void ritz_prober_growth(ritz_prober *it, const ritz_growth *found, double limit,
                        const char *what)
{
    char where[RITZ_WHERE_SIZE];

    if (found->seconds > 0.0)
        snprintf(where, sizeof where, "after %.3g s", found->seconds);
    else
        snprintf(where, sizeof where, "not followed, of more than %d states",
                 MOST_STATES);
    ritz_prober_say(it, "energy-growth", found->met, limit,
                    found->met > limit ? RITZ_WARN : RITZ_PASS,
                    found->met > 1.0 || !found->followed ? where : "",
                    "%s of a free motion: %.4g times its first at least, %.3g "
                    "at most",
                    what, found->met, found->most);
}

static ritz_status grow_modes(ritz_prober *it)
{
    ritz_status status = RITZ_OK;
    ritz_growth found = {0};
    ritz_dense A = {0};

    RITZ_TRY(ritz_probe_energy_matrix(&it->modes, &A));
    RITZ_TRY(ritz_growth_measure(&A, &found));
    /* squaring doubles rounding each time */
    ritz_prober_growth(it, &found, 1.0 + 1e-6, "energy");
done:
    ritz_dense_free(&A);
    return status;
}

ritz_status ritz_probe_growth(ritz_prober *it)
{
    static const char name[] = "energy-growth";

    if (!it->usable)
        return RITZ_OK;
    if (it->definite) {
        ritz_prober_say(it, name, 1.0, 1.0, RITZ_PASS, "",
                        "proven: M, K and D are semidefinite");
        return RITZ_OK;
    }
    if (!it->stable) {
        ritz_prober_say(it, name, HUGE_VAL, 1.0, RITZ_FAIL, "",
                        "a free motion grows without bound");
        return RITZ_OK;
    }
    return it->reduced ? grow_modes(it) : ritz_probe_growth_states(it);
}
