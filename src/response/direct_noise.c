/*
 * What rounding leaves of full answers. A factor is exact for a matrix that is
 * some eps |Z| off, entry by entry, so that with x = Z^-1 b and y = Z^-T c
 *
 *     |c'Z^-1 b - computed| <= some eps |y|'|Z||x|
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "response/direct.h"

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

/* What sums of rounding come to, measured: 2 to 5. */
static const double some = 16.0;

/* t += factor |A||x| */
static void add(const ritz_sparse *A, double factor, const double _Complex *x,
                double *t)
{
    for (int64_t j = 0; A->colptr && j < A->ncol; j++) {
        double size = factor * cabs(x[j]);

        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            t[A->rowind[p]] += fabs(A->val[p]) * size;
    }
}

ritz_status ritz_direct_noise(const ritz_direct *direct, double hertz,
                              const double _Complex *X, int64_t outputs,
                              const double _Complex *Y, double *out)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = direct->component;
    bool rayleigh = ritz_damping_is_rayleigh(&direct->damping);
    double w = 2.0 * RITZ_PI * hertz;
    double a = rayleigh ? fabs(direct->damping.a) : 0.0;
    double b = rayleigh ? fabs(direct->damping.b) : 0.0;
    int64_t n = direct->n;
    double *t = NULL;

    RITZ_NEW(t, n);
    for (int64_t j = 0; j < direct->inputs; j++) {
        const double _Complex *x = X + j * n;

        for (int64_t k = 0; k < n; k++)
            t[k] = 0.0;
        add(&c->K, 1.0 + w * b, x, t);
        add(&c->M, w * w + w * a, x, t);
        add(&c->D, w, x, t);
        add(&c->K4, 1.0, x, t);
        for (int64_t i = 0; i < outputs; i++) {
            double sum = 0.0;

            for (int64_t k = 0; k < n; k++)
                sum += cabs(Y[k + i * n]) * t[k];
            out[i * direct->inputs + j] = some * DBL_EPSILON * sum;
        }
    }
done:
    free(t);
    return status;
}
