/*
 * Damped modes of poles that D couples:
 *
 *     s [q; v] = [0 I; -Lambda -D] [q; v]
 *
 * and, as modes that were left out change what a local damper does, on the full
 * matrices by inverse iteration for Z(s) = s^2 M + s D + K:
 *
 *     u = Z(s)^-1 Z'(s) x,    s_new = s - (x^H x) / (x^H u),   x_new = u
 *
 * K4 has no place in a free vibration: its share k4 / lambda of a mode's loss
 * is added as half of it.
 */
#include "verify/damped.h"

#include "base/alloc.h"

#include <ritz/factor.h>
#include <ritz/monitor.h>

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

enum { MOST_STEPS = 12 };
static const double settled = 1e-12;

/* One damped pair that is being refined. */
typedef struct iterate {
    const ritz_component *component;
    ritz_zldl *Z;
    double _Complex s;
    ritz_dense x; /* n x 2: real and imaginary part */
} iterate;

/* Eigenvalue and modal shape nearest to mode k, of what dgeev returned. */
static int64_t nearest(int64_t m, int64_t k, const double *im, const double *V)
{
    int64_t chosen = -1;
    double best = 0.0;

    for (int64_t j = 0; j + 1 < 2 * m; j++) {
        const double *re = V + j * 2 * m;
        const double *with = re + 2 * m;
        double all = 0.0;
        double own = hypot(re[k], with[k]);

        if (!(im[j] > 0.0)) /* the first of a pair */
            continue;
        for (int64_t i = 0; i < m; i++)
            all = hypot(all, hypot(re[i], with[i]));
        if (own > best * all) {
            best = own / all;
            chosen = j;
        }
    }
    return chosen;
}

/* Eigenpairs of the companion matrix; V 2m x 2m. */
static ritz_status companion(const ritz_poles *poles, double *re, double *im,
                             double *V)
{
    ritz_status status = RITZ_OK;
    int64_t m = poles->count;
    double *A = NULL;
    int info = 0;

    RITZ_NEW(A, 4 * m * m);
    for (int64_t j = 0; j < m; j++) {
        A[j + (m + j) * 2 * m] = 1.0;
        A[m + j + j * 2 * m] = -poles->lambda[j];
        for (int64_t i = 0; i < m; i++)
            A[m + i + (m + j) * 2 * m] = -ritz_dense_col(&poles->D, j)[i];
    }
    info = LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', (int)(2 * m), A,
                         (int)(2 * m), re, im, NULL, 1, V, (int)(2 * m));
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE,
                 "damped modes were not found");
done:
    free(A);
    return status;
}

static double norm(const ritz_dense *x)
{
    double sum = 0.0;

    for (int64_t i = 0; i < x->nrow * x->ncol; i++)
        sum = hypot(sum, x->val[i]);
    return sum;
}

/* u = (2 s M + D) x */
static ritz_status slope(const iterate *it, double _Complex *u)
{
    ritz_status status = RITZ_OK;
    ritz_dense Mx = {0};
    ritz_dense Dx = {0};
    int64_t n = it->x.nrow;

    RITZ_TRY(ritz_sparse_mul(&it->component->M, &it->x, &Mx));
    RITZ_TRY(ritz_sparse_mul(&it->component->D, &it->x, &Dx));
    for (int64_t i = 0; i < n; i++)
        u[i] = 2.0 * it->s * ritz_complex(Mx.val[i], Mx.val[n + i]) +
               ritz_complex(Dx.val[i], Dx.val[n + i]);
done:
    ritz_dense_free(&Mx);
    ritz_dense_free(&Dx);
    return status;
}

/* One step; `still` once s does not move. */
static ritz_status step(iterate *it, double _Complex *u, bool *still)
{
    ritz_status status = RITZ_OK;
    const double _Complex c[3] = {1.0, it->s * it->s, it->s};
    double size = norm(&it->x);
    double _Complex xu = 0.0;
    int64_t n = it->x.nrow;

    for (int64_t i = 0; i < 2 * n; i++)
        it->x.val[i] /= size;
    RITZ_TRY(slope(it, u));
    status = ritz_zldl_factor(it->Z, c);
    *still = status == RITZ_ERR_SINGULAR; /* s is the eigenvalue */
    if (*still)
        return RITZ_OK;
    RITZ_TRY(status);
    RITZ_TRY(ritz_zldl_solve(it->Z, 1, u));
    for (int64_t i = 0; i < n; i++)
        xu += ritz_complex(it->x.val[i], -it->x.val[n + i]) * u[i];
    for (int64_t i = 0; i < n; i++) {
        it->x.val[i] = creal(u[i]);
        it->x.val[n + i] = cimag(u[i]);
    }
    *still = cabs(1.0 / xu) <= settled * cabs(it->s);
    it->s -= 1.0 / xu;
done:
    return status;
}

/* x = Phi q of a modal shape, then steps. */
static ritz_status refine(iterate *it, const ritz_dense *Phi, const double *q)
{
    ritz_status status = RITZ_OK;
    int64_t m = Phi->ncol;
    ritz_dense shape = {0};
    double _Complex *u = NULL;
    bool still = false;

    RITZ_TRY(ritz_dense_new(m, 2, &shape));
    RITZ_NEW(u, Phi->nrow);
    for (int64_t i = 0; i < m; i++) {
        shape.val[i] = q[i];
        shape.val[m + i] = q[2 * m + i];
    }
    RITZ_TRY(ritz_dense_mul(Phi, &shape, &it->x));
    for (int t = 0; t < MOST_STEPS && !still; t++)
        RITZ_TRY(step(it, u, &still));
    RITZ_FAIL_IF(!still, RITZ_ERR_CONVERGENCE,
                 "the damped mode near %.6g Hz was not found",
                 ritz_eigen_hertz(cabs(it->s) * cabs(it->s)));
done:
    ritz_dense_free(&it->x);
    ritz_dense_free(&shape);
    free(u);
    return status;
}

/* What D leaves out: given ratios are in the rates, D's in the matrices. */
static double given_ratio(const ritz_poles *poles, const ritz_dense *own,
                          int64_t k)
{
    return (poles->rate[k] - own->val[k]) / (2.0 * sqrt(poles->lambda[k]));
}

/* Diagonal of Phi'D Phi, m x 1. */
static ritz_status own_rates(const ritz_sparse *D, const ritz_dense *Phi,
                             ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense DPhi = {0};

    RITZ_TRY(ritz_sparse_mul(D, Phi, &DPhi));
    RITZ_TRY(ritz_dense_new(Phi->ncol, 1, out));
    for (int64_t k = 0; k < Phi->ncol; k++)
        for (int64_t i = 0; i < Phi->nrow; i++)
            out->val[k] +=
                ritz_dense_col(Phi, k)[i] * ritz_dense_col(&DPhi, k)[i];
done:
    ritz_dense_free(&DPhi);
    return status;
}

/* Modes in the band, on the full matrices, from where the companion put s. */
static ritz_status refine_band(const ritz_poles *poles,
                               const ritz_component *component,
                               const ritz_pairs *pairs, const double band_hz[2],
                               const double *start[3], double *zeta)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *const A[] = {&component->K, &component->M,
                                    &component->D};
    iterate it = {.component = component};
    ritz_dense own = {0};
    int64_t m = poles->count;

    RITZ_TRY(own_rates(&component->D, &pairs->Phi, &own));
    RITZ_TRY(ritz_zldl_new(3, A, &it.Z));
    for (int64_t k = poles->num_rigid; k < m; k++) {
        double hertz = ritz_eigen_hertz(poles->lambda[k]);
        int64_t j = nearest(m, k, start[1], start[2]);

        if (j < 0 || hertz < band_hz[0] || hertz > band_hz[1] * (1.0 + 1e-9))
            continue;
        it.s = ritz_complex(start[0][j], start[1][j]);
        RITZ_TRY(refine(&it, &pairs->Phi, start[2] + j * 2 * m));
        zeta[k] = -creal(it.s) / cabs(it.s) + given_ratio(poles, &own, k);
        ritz_monitor_step("damped modes", k + 1, m);
    }
done:
    ritz_zldl_free(&it.Z);
    ritz_dense_free(&own);
    return status;
}

static ritz_status coupled_ratios(const ritz_poles *poles,
                                  const ritz_component *component,
                                  const ritz_pairs *pairs,
                                  const double band_hz[2], double *zeta)
{
    ritz_status status = RITZ_OK;
    int64_t m = poles->count;
    double *re = NULL;
    double *im = NULL;
    double *V = NULL;
    const double *start[3];

    RITZ_NEW(re, 2 * m);
    RITZ_NEW(im, 2 * m);
    RITZ_NEW(V, 4 * m * m);
    RITZ_TRY(companion(poles, re, im, V));
    for (int64_t k = poles->num_rigid; k < m; k++) {
        int64_t j = nearest(m, k, im, V);

        zeta[k] = j < 0 ? nan("") : -re[j] / hypot(re[j], im[j]);
    }
    start[0] = re;
    start[1] = im;
    start[2] = V;
    if (component && component->D.colptr && poles->count < component->num_dofs)
        RITZ_TRY(refine_band(poles, component, pairs, band_hz, start, zeta));
done:
    free(re);
    free(im);
    free(V);
    return status;
}

ritz_status ritz_damped_ratios(const ritz_poles *poles,
                               const ritz_component *component,
                               const ritz_pairs *pairs, const double band_hz[2],
                               double **out)
{
    ritz_status status = RITZ_OK;
    double *omega = NULL;
    double *zeta = NULL;

    RITZ_TRY(ritz_poles_ratios(poles, &omega, &zeta));
    if (poles->coupled && poles->D.val) {
        RITZ_TRY(coupled_ratios(poles, component, pairs, band_hz, zeta));
        for (int64_t k = poles->num_rigid; poles->K4.val && k < poles->count;
             k++)
            zeta[k] +=
                ritz_dense_col(&poles->K4, k)[k] / (2.0 * poles->lambda[k]);
    }
    *out = zeta;
    zeta = NULL;
done:
    free(omega);
    free(zeta);
    return status;
}
