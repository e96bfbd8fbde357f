/*
 * Eigenvalues of A x = s E x near a point sigma: with
 *
 *     (A - sigma E)^-1 E x = nu x,   s = sigma + 1 / nu,
 *
 * the eigenvalues nearest to sigma have the largest nu, which implicitly
 * restarted Arnoldi iterations find first [LehoucqSorensenYang1998]. The pairs
 * are not refined further; the residual of each shows its accuracy.
 */
#include "linear/pencil.h"

#include "base/alloc.h"
#include "base/complex.h"
#include "base/tolerances.h"

#include <arpack.h>
#include <complex.h>
#include <inttypes.h>
#include <lapacke.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SMALL = 120,    /* up to this order, all eigenvalues by LAPACK cost less */
    RESTARTS = 100, /* largest number of restarts of the Arnoldi iterations */
    SPARE = 20,     /* Arnoldi vectors in addition to the pairs wanted */
};

typedef struct arnoldi {
    a_int n, nev, ncv, lworkl, info;
    a_int iparam[11], ipntr[14];
    double _Complex *resid, *workd, *workl, *d, *V, *workev;
    double *rwork;
    a_int *select;
} arnoldi;

static void arnoldi_free(arnoldi *a)
{
    RITZ_FREE(a->resid, a->workd, a->workl, a->d, a->V, a->workev, a->rwork,
              a->select);
}

/* y := (A - sigma E)^-1 E x */
static ritz_status apply_operator(ritz_pencil *p, int64_t k,
                                  const double _Complex *x, double _Complex *y)
{
    ritz_pencil_times(&p->E, k, x, y);
    return ritz_pencil_solve(p, false, k, y);
}

/* The starting vector is real, not smooth, and the same on every machine. */
static ritz_status allocate_arnoldi(const ritz_pencil *p, int64_t count,
                                    arnoldi *a)
{
    int64_t n = p->n;
    int64_t ncv = 2 * count + 1 > count + SPARE ? 2 * count + 1 : count + SPARE;

    ncv = ncv < n ? ncv : n;
    RITZ_REFUSE_IF(n > INT_MAX / 3 || ncv > 10000, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " poles of %" PRId64
                   " states are more than ARPACK can find",
                   count, n);
    a->n = (a_int)n;
    a->nev = (a_int)count;
    a->ncv = (a_int)ncv;
    a->lworkl = (a_int)(ncv * (3 * ncv + 5));
    a->info = 1; /* resid holds the starting vector */
    a->iparam[0] = 1;
    a->iparam[2] = RESTARTS;
    a->iparam[3] = 1;
    a->iparam[6] = 1;
    RITZ_CHECK_NEW(a->resid, n);
    RITZ_CHECK_NEW(a->workd, 3 * n);
    RITZ_CHECK_NEW(a->workl, a->lworkl);
    RITZ_CHECK_NEW(a->d, ncv + 1);
    RITZ_CHECK_NEW(a->V, n * ncv);
    RITZ_CHECK_NEW(a->workev, 2 * ncv);
    RITZ_CHECK_NEW(a->rwork, ncv);
    RITZ_CHECK_NEW(a->select, ncv);
    for (int64_t i = 0; i < n; i++)
        a->resid[i] = 1.5 + cos(3.0 * (double)i * (double)i);
    return RITZ_OK;
}

static ritz_status iterate_arnoldi(ritz_pencil *p, arnoldi *a)
{
    a_int ido = 0;
    int64_t solves = 0;

    for (;;) {
        znaupd_c(&ido, "I", a->n, "LM", a->nev, RITZ_ARNOLDI_SETTLED, a->resid,
                 a->ncv, a->V, a->n, a->iparam, a->ipntr, a->workd, a->workl,
                 a->lworkl, a->rwork, &a->info);
        if (ido != 1 && ido != -1)
            break;
        ritz_monitor_step("poles", ++solves, 0);
        RITZ_CHECK(apply_operator(p, 1, a->workd + a->ipntr[0] - 1,
                                  a->workd + a->ipntr[1] - 1));
    }
    RITZ_REFUSE_IF(a->info != 0, RITZ_ERR_CONVERGENCE,
                   "%d poles were not found, ARPACK says %d", (int)a->nev,
                   (int)a->info);
    zneupd_c(1, "A", a->select, a->d, a->V, a->n, 0.0, a->workev, "I", a->n,
             "LM", a->nev, RITZ_ARNOLDI_SETTLED, a->resid, a->ncv, a->V, a->n,
             a->iparam, a->ipntr, a->workd, a->workl, a->lworkl, a->rwork,
             &a->info);
    RITZ_REFUSE_IF(a->info != 0, RITZ_ERR_CONVERGENCE,
                   "the vectors of poles were not found, ARPACK says %d",
                   (int)a->info);
    return RITZ_OK;
}

/* All eigenvalues of a small pencil, by LAPACK. */
static ritz_status solve_small(ritz_pencil *p, arnoldi *a)
{
    int64_t n = p->n;
    RITZ_OWN_ARRAY double _Complex *X = NULL, *G = NULL;
    int info = 0;

    a->n = a->nev = (a_int)n;
    RITZ_CHECK_NEW(a->d, n);
    RITZ_CHECK_NEW(a->V, n * n);
    RITZ_CHECK_NEW(X, n * n);
    RITZ_CHECK_NEW(G, n * n);
    for (int64_t k = 0; k < n; k++)
        X[k + k * n] = 1.0;
    RITZ_CHECK(apply_operator(p, n, X, G));
    if (n > 0)
        info = LAPACKE_zgeev(LAPACK_COL_MAJOR, 'N', 'V', (int)n, G, (int)n,
                             a->d, NULL, 1, a->V, (int)n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE, "the poles were not found");
    return RITZ_OK;
}

typedef struct near_pole {
    double distance, imaginary;
    int64_t index;
} near_pole;

/* Order by distance; of two poles at the same distance, the one with the larger
   imaginary part comes first. */
static int compare_distance(const void *left, const void *right)
{
    const near_pole *a = left, *b = right;

    if (fabs(a->distance - b->distance) > RITZ_SAME * a->distance)
        return a->distance > b->distance ? 1 : -1;
    return (a->imaginary < b->imaginary) - (a->imaginary > b->imaginary);
}

/* |A x - s E x| / | |A||x| + |s||E||x| | */
static ritz_status find_residual(const ritz_pencil *p, double _Complex s,
                                 const double _Complex *x, double *out)
{
    const ritz_sparse *const M[] = {&p->A, &p->E};
    const double _Complex c[] = {1.0, -s};
    RITZ_OWN_ARRAY double _Complex *gap = NULL;
    RITZ_OWN_ARRAY double *size = NULL;
    double above = 0.0, below = 0.0;

    RITZ_CHECK_NEW(gap, p->n);
    RITZ_CHECK_NEW(size, p->n);
    for (int k = 0; k < 2; k++)
        for (int64_t j = 0; j < p->n; j++)
            for (int64_t q = M[k]->colptr[j]; q < M[k]->colptr[j + 1]; q++) {
                double _Complex term = c[k] * M[k]->val[q] * x[j];

                gap[M[k]->rowind[q]] += term;
                size[M[k]->rowind[q]] += cabs(term);
            }
    for (int64_t i = 0; i < p->n; i++) {
        above = hypot(above, cabs(gap[i]));
        below = hypot(below, size[i]);
    }
    *out = below > 0.0 ? above / below : 0.0;
    return RITZ_OK;
}

static ritz_status take_pairs(const ritz_pencil *p, double _Complex shift,
                              const arnoldi *a, int64_t count,
                              ritz_pencil_pairs *out)
{
    RITZ_OWN_ARRAY near_pole *order = NULL;
    int64_t n = p->n, found = 0;

    RITZ_CHECK_NEW(order, a->nev);
    for (int64_t k = 0; k < a->nev; k++)
        if (cabs(a->d[k]) > 0.0)
            order[found++] =
                (near_pole){1.0 / cabs(a->d[k]), cimag(1.0 / a->d[k]), k};
    qsort(order, (size_t)found, sizeof *order, compare_distance);
    out->count = found < count ? found : count;
    RITZ_CHECK_NEW(out->s, out->count);
    RITZ_CHECK_NEW(out->x, n * out->count);
    RITZ_CHECK_NEW(out->residual, out->count);
    for (int64_t k = 0; k < out->count; k++) {
        double _Complex *x = out->x + k * n;

        out->s[k] = shift + 1.0 / a->d[order[k].index];
        if (fabs(cimag(out->s[k])) <= RITZ_POLE_FOUND * cabs(out->s[k]))
            out->s[k] = creal(out->s[k]); /* the imaginary part is rounding */
        memcpy(x, a->V + order[k].index * n, (size_t)n * sizeof *x);
        RITZ_CHECK(find_residual(p, out->s[k], x, &out->residual[k]));
    }
    return RITZ_OK;
}

ritz_status ritz_pencil_nearest(ritz_pencil *pencil, double _Complex shift,
                                int64_t count, ritz_pencil_pairs *out)
{
    RITZ_OWN(arnoldi) a = {0};
    RITZ_OWN(ritz_pencil_pairs) pairs = {0};
    bool small = pencil->n <= SMALL || count >= pencil->n - 2;

    RITZ_REFUSE_IF(count < 1, RITZ_ERR_ARGUMENT, "no poles are asked for");
    RITZ_CHECK(ritz_pencil_factor(pencil, shift));
    if (small) {
        RITZ_CHECK(solve_small(pencil, &a));
    } else {
        RITZ_CHECK(allocate_arnoldi(pencil, count, &a));
        RITZ_CHECK(iterate_arnoldi(pencil, &a));
    }
    RITZ_CHECK(take_pairs(pencil, shift, &a, count, &pairs));
    (void)snprintf(pairs.engine, sizeof pairs.engine,
                   small ? "dense LAPACK" : "MUMPS + ARPACK");
    RITZ_MOVE(*out, pairs);
    return RITZ_OK;
}

void ritz_pencil_pairs_free(ritz_pencil_pairs *pairs)
{
    RITZ_FREE(pairs->s, pairs->x, pairs->residual);
    *pairs = (ritz_pencil_pairs){0};
}
