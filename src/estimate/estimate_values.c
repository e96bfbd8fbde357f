/*
 * The Ritz values tau of estimate_enclose.c, as their inverses. Rounding of a
 * dense problem is eps times its largest value, and tau is large where rho is
 * close to a mode: so nu = 1 / tau is sought, whose largest belong to the modes
 * furthest from rho. With J = sign D and z = |D|^-1/2 u
 *
 *     D z = tau (D^2 + G^) z   is   H u = nu J u,
 *     H = |D| + |D|^-1/2 G^ |D|^-1/2 = LL',
 *
 * and nu are the eigenvalues of L'JL.
 */
#include "estimate/estimate_parts.h"

#include "base/alloc.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Diagonal of D; false if rounding may have turned a sign of it. */
static bool offsets(const ritz_lehmann *trial, double rho, double *d)
{
    bool clear = true;

    for (int64_t j = 0; j < trial->count; j++) {
        double off = rho - trial->theta[j];
        double t = trial->theta[j] - trial->sigma;

        clear = clear && fabs(off) > trial->rounding[j];
        d[j] = off / (t * (rho - trial->sigma));
    }
    return clear;
}

/* H; what rounding leaves of a residual is one more. */
static void fill(const ritz_lehmann *trial, const double *d, ritz_dense *H)
{
    for (int64_t j = 0; j < trial->count; j++) {
        double t_j = trial->theta[j] - trial->sigma;
        double rounded = trial->rounding[j] / (t_j * t_j);

        for (int64_t i = 0; i < trial->count; i++) {
            double t = (trial->theta[i] - trial->sigma) * t_j;

            ritz_dense_col(H, j)[i] = ritz_dense_col(&trial->G, j)[i] /
                                      (t * sqrt(t * fabs(d[i] * d[j])));
        }
        ritz_dense_col(H, j)[j] += fabs(d[j]) + rounded * rounded / fabs(d[j]);
    }
}

/* L over H; false if rounding has left it indefinite. */
static bool factor(ritz_dense *H)
{
    int m = (int)H->nrow;

    for (int64_t j = 0; j < H->ncol; j++)
        memset(ritz_dense_col(H, j), 0, (size_t)j * sizeof *H->val);
    return LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', m, H->val, m) == 0;
}

/* L'JL. */
static ritz_status join(const ritz_dense *L, const double *d, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense JL = {0};

    RITZ_TRY(ritz_dense_copy(L, &JL));
    for (int64_t j = 0; j < L->ncol; j++)
        for (int64_t i = j; i < L->nrow; i++)
            ritz_dense_col(&JL, j)[i] *= d[i] > 0.0 ? 1.0 : -1.0;
    RITZ_TRY(ritz_dense_mul_tn(L, &JL, out));
    ritz_dense_symmetrise(out);
done:
    ritz_dense_free(&JL);
    return status;
}

ritz_status ritz_lehmann_values(const ritz_lehmann *trial, double rho,
                                ritz_pairs *out)
{
    ritz_status status = RITZ_OK;
    int64_t m = trial->count;
    double *d = NULL;
    ritz_dense L = {0};
    ritz_dense LJL = {0};
    ritz_dense one = {0};

    RITZ_NEW(d, m);
    if (!offsets(trial, rho, d))
        goto done;
    RITZ_TRY(ritz_dense_new(m, m, &L));
    fill(trial, d, &L);
    if (!factor(&L))
        goto done;
    RITZ_TRY(join(&L, d, &LJL));
    RITZ_TRY(ritz_dense_new(m, m, &one));
    for (int64_t j = 0; j < m; j++)
        ritz_dense_col(&one, j)[j] = 1.0;
    RITZ_TRY(ritz_eigen_dense(&LJL, &one, out));
done:
    free(d);
    ritz_dense_free(&L);
    ritz_dense_free(&LJL);
    ritz_dense_free(&one);
    return status;
}
