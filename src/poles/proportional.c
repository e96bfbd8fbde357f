/*
 * The a and b for which |D - a M - b K| is least in the Frobenius norm, M and K
 * taken as vectors m and k of their entries,
 *
 *     e = k - (m.k / m.m) m,    b = e.d / e.e,    a = (m.d - b m.k) / m.m
 */
#include "poles/proportional.h"

#include "base/tolerances.h"

#include <math.h>

/* Sum of the products of entries of A and B at the same places. */
static ritz_status inner_product(const ritz_sparse *A, const ritz_sparse *B,
                                 double *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse a = {0}, b = {0}; /* on the union of both patterns */
    int64_t nnz = 0;

    RITZ_TRY(ritz_sparse_add(1.0, A, 0.0, B, &a));
    RITZ_TRY(ritz_sparse_add(0.0, A, 1.0, B, &b));
    nnz = a.colptr[a.ncol];
    *out = 0.0;
    for (int64_t p = 0; p < nnz; p++)
        *out += a.val[p] * b.val[p];
done:
    ritz_sparse_free(&a);
    ritz_sparse_free(&b);
    return status;
}

/* |D - a M - b K| / |D| */
static ritz_status residual_of(const ritz_component *c, double a, double b,
                               double *out)
{
    RITZ_OWN(ritz_sparse) sum = {0}, rest = {0};
    double size = 0.0;

    RITZ_CHECK(ritz_sparse_add(a, &c->M, b, &c->K, &sum));
    RITZ_CHECK(ritz_sparse_add(1.0, &c->D, -1.0, &sum, &rest));
    *out = 0.0;
    for (int64_t p = 0; p < rest.colptr[rest.ncol]; p++)
        *out = hypot(*out, rest.val[p]);
    for (int64_t p = 0; p < c->D.colptr[c->D.ncol]; p++)
        size = hypot(size, c->D.val[p]);
    *out = size > 0.0 ? *out / size : 0.0;
    return RITZ_OK;
}

/* a and b; b = 0 without stiffness, or where K is a multiple of M. */
static ritz_status fit_coefficients(const ritz_component *c, double *a,
                                    double *b)
{
    double mm = 0.0, mk = 0.0, kk = 0.0, md = 0.0, kd = 0.0;
    double ee = 0.0;

    RITZ_CHECK(inner_product(&c->M, &c->M, &mm));
    RITZ_CHECK(inner_product(&c->M, &c->K, &mk));
    RITZ_CHECK(inner_product(&c->K, &c->K, &kk));
    RITZ_CHECK(inner_product(&c->M, &c->D, &md));
    RITZ_CHECK(inner_product(&c->K, &c->D, &kd));
    ee = mm > 0.0 ? kk - mk * (mk / mm) : kk;
    *b = ee > RITZ_PROPORTIONAL_RANK * kk
             ? (kd - (mm > 0.0 ? md * (mk / mm) : 0.0)) / ee
             : 0.0;
    *a = mm > 0.0 ? (md - *b * mk) / mm : 0.0;
    return RITZ_OK;
}

ritz_status ritz_proportional(const ritz_component *component, double *a,
                              double *b, double *left)
{
    RITZ_CHECK(fit_coefficients(component, a, b));
    return residual_of(component, *a, *b, left);
}
