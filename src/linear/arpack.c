/*
 * Implicitly restarted Lanczos, ARPACK's mode 3 [LehoucqSorensenYang1998]:
 *
 *     (K - sigma M)^-1 M x = nu x,   lambda = sigma + 1 / nu
 *
 * in the inner product of M, which may be singular: every vector starts in the
 * range of the operator and stays there.
 */
#include "linear/arpack.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>

#include <arpack.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <string.h>

enum {
    RESTARTS = 60,
    INVARIANT = -9999, /* info of dsaupd */
    RITZ_VALUES = 5,   /* of ipntr */
};

typedef struct lanczos {
    a_int n, nev, ncv, lworkl, info;
    a_int iparam[11], ipntr[11];
    double *resid, *workd, *workl, *d;
    a_int *select;
    ritz_dense V;
} lanczos;

/* Uniform in (-1, 1), the same on every machine. */
static double next_noise(uint64_t *state)
{
    *state = *state * 6364136223846793005U + 1442695040888963407U;
    return (double)(int64_t)*state / (double)INT64_MAX;
}

/* y := M X, X a column, which y may be. */
static ritz_status multiply_mass(const ritz_sparse *M, const ritz_dense *X,
                                 double *y)
{
    RITZ_OWN(ritz_dense) Y = {0};

    RITZ_CHECK(ritz_sparse_mul(M, X, &Y));
    memcpy(y, Y.val, (size_t)M->nrow * sizeof *y);
    return RITZ_OK;
}

/* y := A^-1 x, which may be one and the same. */
static ritz_status solve_shifted(const ritz_shifted *S, const double *x,
                                 double *y)
{
    ritz_dense Y = {S->M->nrow, 1, y};

    if (y != x)
        memcpy(y, x, (size_t)Y.nrow * sizeof *y);
    return ritz_factor_solve(S->A, &Y);
}

static ritz_status allocate_lanczos(const ritz_shifted *S, int64_t k,
                                    lanczos *L)
{
    int64_t n = S->M->nrow;
    int64_t ncv = 2 * k + 1 > k + 20 ? 2 * k + 1 : k + 20;
    uint64_t seed = 1998;

    ncv = ncv < n ? ncv : n;
    RITZ_REFUSE_IF(
        n > INT_MAX / 3 || ncv > 40000 || k >= ncv, RITZ_ERR_ARGUMENT,
        "%" PRId64 " modes of %" PRId64 " dofs are more than ARPACK can find",
        k, n);
    L->n = (a_int)n;
    L->nev = (a_int)k;
    L->ncv = (a_int)ncv;
    L->lworkl = (a_int)(ncv * (ncv + 8));
    L->info = 1; /* resid holds the start */
    L->iparam[0] = 1;
    L->iparam[2] = RESTARTS;
    L->iparam[6] = 3;
    RITZ_CHECK_NEW(L->resid, n);
    RITZ_CHECK_NEW(L->workd, 3 * n);
    RITZ_CHECK_NEW(L->workl, L->lworkl);
    RITZ_CHECK_NEW(L->d, ncv);
    RITZ_CHECK_NEW(L->select, ncv);
    RITZ_CHECK(ritz_dense_new(n, ncv, &L->V));
    for (int64_t i = 0; i < n; i++)
        L->resid[i] = next_noise(&seed);
    RITZ_CHECK(multiply_mass(S->M, &(ritz_dense){n, 1, L->resid}, L->resid));
    return solve_shifted(S, L->resid, L->resid);
}

static void lanczos_free(lanczos *L)
{
    RITZ_FREE(L->resid, L->workd, L->workl, L->d, L->select);
    ritz_dense_free(&L->V);
}

/* Do what ARPACK asks for until it asks no more. */
static ritz_status iterate_lanczos(const ritz_shifted *S, lanczos *L)
{
    a_int ido = 0;
    int64_t solves = 0;

    for (;;) {
        ritz_dense X = {L->n, 1, NULL};
        double *y = NULL;

        dsaupd_c(&ido, "G", L->n, "LM", L->nev, RITZ_ARNOLDI_SETTLED, L->resid,
                 L->ncv, L->V.val, L->n, L->iparam, L->ipntr, L->workd,
                 L->workl, L->lworkl, &L->info);
        X.val = L->workd + L->ipntr[0] - 1;
        y = L->workd + L->ipntr[1] - 1;
        if (ido == 2) {
            RITZ_CHECK(multiply_mass(S->M, &X, y));
            continue;
        }
        if (ido != 1 && ido != -1)
            break;
        ritz_monitor_step("eigenvectors", ++solves, 0);
        if (ido == -1)
            RITZ_CHECK(multiply_mass(S->M, &X, y));
        RITZ_CHECK(
            solve_shifted(S, ido == 1 ? L->workd + L->ipntr[2] - 1 : y, y));
    }
    return RITZ_OK;
}

/* The k-th largest |nu| ARPACK came to, as an eigenvalue. */
static double reach_of(const lanczos *L, double sigma)
{
    const double *nu = L->workl + L->ipntr[RITZ_VALUES] - 1;
    double *sorted = L->d; /* ncv long, and dseupd has not run */
    a_int k = 0;

    for (a_int i = 0; i < L->ncv; i++) {
        for (k = i; k > 0 && sorted[k - 1] < fabs(nu[i]); k--)
            sorted[k] = sorted[k - 1];
        sorted[k] = fabs(nu[i]);
    }
    return sigma + 1.0 / sorted[L->nev - 1];
}

static ritz_status extract_pairs(const ritz_shifted *S, lanczos *L)
{
    dseupd_c(1, "A", L->select, L->d, L->V.val, L->n, S->sigma, "G", L->n, "LM",
             L->nev, RITZ_ARNOLDI_SETTLED, L->resid, L->ncv, L->V.val, L->n,
             L->iparam, L->ipntr, L->workd, L->workl, L->lworkl, &L->info);
    RITZ_REFUSE_IF(L->info != 0, RITZ_ERR_CONVERGENCE,
                   "the eigenvectors cannot be found, ARPACK says %d",
                   (int)L->info);
    return RITZ_OK;
}

ritz_status ritz_lanczos_lowest(const ritz_shifted *S, int64_t k, ritz_dense *X,
                                double *reach, ritz_lanczos_end *end)
{
    RITZ_OWN(lanczos) L = {0};

    RITZ_CHECK(allocate_lanczos(S, k, &L));
    RITZ_CHECK(iterate_lanczos(S, &L));
    if (L.info == INVARIANT) {
        *end = RITZ_LANCZOS_EXHAUSTED;
        return RITZ_OK;
    }
    RITZ_REFUSE_IF(L.info < 0, RITZ_ERR_CONVERGENCE,
                   "the iteration for eigenvectors failed, ARPACK says %d",
                   (int)L.info);
    *reach = reach_of(&L, S->sigma);
    *end = L.info == 0 ? RITZ_LANCZOS_FOUND : RITZ_LANCZOS_SLOW;
    if (*end != RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    RITZ_CHECK(extract_pairs(S, &L));
    L.V.ncol = L.nev;
    RITZ_MOVE(*X, L.V);
    return RITZ_OK;
}
