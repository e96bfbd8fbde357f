/* Modal coordinates that D or K4 couples: one dense solve a point. */
#include "poles/poles.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Z = Lambda - w^2 I + i (w D + K4), both triangles. */
static void assemble(const ritz_poles *poles, double w, double _Complex *Z)
{
    int64_t m = poles->count + poles->massless;

    for (int64_t j = 0; j < m; j++) {
        double own = poles->lambda[j] - (j < poles->count ? w * w : 0.0);

        for (int64_t i = 0; i < m; i++) {
            double k4 = poles->K4.val ? ritz_dense_col(&poles->K4, j)[i] : 0.0;
            double d = w * ritz_dense_col(&poles->D, j)[i];

            Z[i + j * m] = ritz_complex(i == j ? own : 0.0, d + k4);
        }
    }
}

/* S Z S and S q, of unit diagonal: w^2 of rigid motion is small beside Lambda
 * where nothing is wrong. */
static void equilibrate(int64_t m, int64_t inputs, double _Complex *Z,
                        double _Complex *q, double *s)
{
    for (int64_t j = 0; j < m; j++) {
        double own = cabs(Z[j + j * m]);

        s[j] = own > 0.0 ? 1.0 / sqrt(own) : 1.0;
    }
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < m; i++)
            Z[i + j * m] *= s[i] * s[j];
    for (int64_t j = 0; j < inputs; j++)
        for (int64_t i = 0; i < m; i++)
            q[i + j * m] *= s[i];
}

/* Z := its factors, complex symmetric or not; LAPACK's info. */
static int factor(bool skew, int m, double _Complex *Z, lapack_int *pivot,
                  double *rcond)
{
    double norm = LAPACKE_zlange(LAPACK_COL_MAJOR, '1', m, m, Z, m);
    int info = skew ? LAPACKE_zgetrf(LAPACK_COL_MAJOR, m, m, Z, m, pivot)
                    : LAPACKE_zsytrf(LAPACK_COL_MAJOR, 'L', m, Z, m, pivot);

    if (info != 0)
        return info;
    return skew ? LAPACKE_zgecon(LAPACK_COL_MAJOR, '1', m, Z, m, norm, rcond)
                : LAPACKE_zsycon(LAPACK_COL_MAJOR, 'L', m, Z, m, pivot, norm,
                                 rcond);
}

ritz_status ritz_poles_together(const ritz_poles *poles, double hertz,
                                double _Complex *q)
{
    ritz_status status = RITZ_OK;
    int64_t m = poles->count + poles->massless;
    int64_t inputs = poles->io.num_inputs;
    double _Complex *Z = NULL;
    double *s = NULL;
    lapack_int *pivot = NULL;
    double rcond = 0.0;
    int info = 0;

    RITZ_NEW(Z, m * m);
    RITZ_NEW(s, m);
    RITZ_NEW(pivot, m);
    assemble(poles, 2.0 * RITZ_PI * hertz, Z);
    for (int64_t k = 0; k < m * inputs; k++)
        q[k] = poles->io.B.val[k];
    equilibrate(m, inputs, Z, q, s);
    info = factor(poles->skew, (int)m, Z, pivot, &rcond);
    RITZ_FAIL_IF(info != 0 || !(rcond > 1e-16), RITZ_ERR_SINGULAR,
                 "the response at %.9g Hz is infinite: an undamped mode, or at "
                 "0 Hz a rigid-body motion",
                 hertz);
    if (poles->skew)
        (void)LAPACKE_zgetrs(LAPACK_COL_MAJOR, 'N', (int)m, (int)inputs, Z,
                             (int)m, pivot, q, (int)m);
    else
        (void)LAPACKE_zsytrs(LAPACK_COL_MAJOR, 'L', (int)m, (int)inputs, Z,
                             (int)m, pivot, q, (int)m);
    for (int64_t k = 0; k < m * inputs; k++)
        q[k] *= s[k % m];
done:
    free(Z);
    free(s);
    free(pivot);
    return status;
}
