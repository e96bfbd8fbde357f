/*
 * Implicitly restarted Lanczos iterations [LehoucqSorensenYang1998] for
 *
 *     F^-1 A x = nu x   in the inner product of B
 *
 *     modes      A = B = M, F of K - sigma M: lambda = sigma + 1 / nu, ARPACK's
 *                mode 3. M may be singular: every vector starts in the range of
 *                the operator and stays there
 *     two ends   F of B:  nu = theta of A x = theta B x, ARPACK's mode 2, where
 *                it reads B F^-1 A x from A x
 *
 * Both have one loop over what ARPACK asks for.
 */
#include "linear/arpack.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <arpack.h>
#include <cblas.h>
#include <float.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <string.h>

enum {
    RESTARTS = 60,
    END_VECTORS = 20, /* of iterations for ends of a spectrum */
    END_RESTARTS = 8, /* of iterations for both ends */
    FORWARD = 2,      /* ARPACK's modes */
    INVERSE = 3,
    INVARIANT = -9999, /* info of dsaupd */
    SLOW = 1,
    CONVERGED = 4,   /* of iparam */
    RITZ_VALUES = 5, /* of ipntr */
};

typedef struct lanczos {
    const ritz_sparse *A, *B;
    ritz_factor *F;
    double unit; /* of nu */
    double sigma;
    const char *which, *what;
    a_int n, nev, ncv, lworkl, info;
    a_int iparam[11], ipntr[11];
    double *resid, *workd, *workl, *d;
    a_int *select;
    ritz_dense V;
} lanczos;

static void lanczos_free(lanczos *L)
{
    RITZ_FREE(L->resid, L->workd, L->workl, L->d, L->select);
    ritz_dense_free(&L->V);
}

/* y := A x; x and y may be the same array. */
static ritz_status multiply(const ritz_sparse *A, double *x, double *y)
{
    ritz_dense X = {A->ncol, 1, NULL};
    RITZ_OWN(ritz_dense) Y = {0};

    X.val = x;
    RITZ_CHECK(ritz_sparse_mul(A, &X, &Y));
    memcpy(y, Y.val, (size_t)A->nrow * sizeof *y);
    return RITZ_OK;
}

/* y := F^-1 x; x and y may be the same array. */
static ritz_status solve(const lanczos *L, const double *x, double *y)
{
    ritz_dense Y = {L->n, 1, y};

    if (y != x)
        memcpy(y, x, (size_t)L->n * sizeof *y);
    return ritz_factor_solve(L->F, &Y);
}

/* x := A x / unit, y := F^-1 x; x and y may be the same array. */
static ritz_status apply(const lanczos *L, double *x, double *y)
{
    RITZ_CHECK(multiply(L->A, x, x));
    cblas_dscal(L->n, 1.0 / L->unit, x, 1);
    return solve(L, x, y);
}

static ritz_status allocate(int64_t n, int64_t k, int64_t ncv, lanczos *L)
{
    ncv = ncv < n ? ncv : n;
    RITZ_REFUSE_IF(
        n > INT_MAX / 3 || ncv > 40000 || k >= ncv, RITZ_ERR_ARGUMENT,
        "%" PRId64 " %s of %" PRId64 " dofs are more than ARPACK can find", k,
        L->what, n);
    L->n = (a_int)n;
    L->nev = (a_int)k;
    L->ncv = (a_int)ncv;
    L->lworkl = (a_int)(ncv * (ncv + 8));
    L->info = 1; /* resid holds the start */
    L->iparam[0] = 1;
    L->unit = 1.0;
    RITZ_CHECK_NEW(L->resid, n);
    RITZ_CHECK_NEW(L->workd, 3 * n);
    RITZ_CHECK_NEW(L->workl, L->lworkl);
    RITZ_CHECK_NEW(L->d, ncv);
    RITZ_CHECK_NEW(L->select, ncv);
    return ritz_dense_new(n, ncv, &L->V);
}

/* The start F^-1 A times noise. */
static ritz_status start(lanczos *L)
{
    uint64_t seed = 1998;

    for (a_int i = 0; i < L->n; i++)
        L->resid[i] = ritz_general_noise(&seed);
    return apply(L, L->resid, L->resid);
}

/* Serve the requests of ARPACK until it has finished. */
static ritz_status iterate(lanczos *L)
{
    const bool inverse = L->iparam[6] == INVERSE;
    a_int ido = 0;
    int64_t solves = 0;

    for (;;) {
        double *x = NULL, *y = NULL;

        dsaupd_c(&ido, "G", L->n, L->which, L->nev, RITZ_ARNOLDI_SETTLED,
                 L->resid, L->ncv, L->V.val, L->n, L->iparam, L->ipntr,
                 L->workd, L->workl, L->lworkl, &L->info);
        x = L->workd + L->ipntr[0] - 1;
        y = L->workd + L->ipntr[1] - 1;
        if (ido == 2) {
            RITZ_CHECK(multiply(L->B, x, y));
            continue;
        }
        if (ido != 1 && ido != -1)
            break;
        ritz_monitor_step(L->what, ++solves, 0);
        if (ido == 1 && inverse) /* A x is known */
            RITZ_CHECK(solve(L, L->workd + L->ipntr[2] - 1, y));
        else
            RITZ_CHECK(apply(L, x, y));
    }
    RITZ_REFUSE_IF(L->info < 0 && L->info != INVARIANT, RITZ_ERR_CONVERGENCE,
                   "the iteration for %s failed, ARPACK says %d", L->what,
                   (int)L->info);
    return RITZ_OK;
}

/* Vectors to V, values to d, as many as converged. */
static ritz_status extract(lanczos *L)
{
    L->info = 0;
    dseupd_c(1, "A", L->select, L->d, L->V.val, L->n, L->sigma, "G", L->n,
             L->which, L->nev, RITZ_ARNOLDI_SETTLED, L->resid, L->ncv, L->V.val,
             L->n, L->iparam, L->ipntr, L->workd, L->workl, L->lworkl,
             &L->info);
    RITZ_REFUSE_IF(L->info != 0, RITZ_ERR_CONVERGENCE,
                   "%s cannot be found, ARPACK says %d", L->what, (int)L->info);
    return RITZ_OK;
}

/* ---- modes -------------------------------------------------------------- */

/* The k-th largest |nu| that ARPACK has reached, as an eigenvalue. */
static double reach_of(const lanczos *L)
{
    const double *nu = L->workl + L->ipntr[RITZ_VALUES] - 1;
    double *sorted = L->d; /* ncv long, and dseupd has not run */
    a_int k = 0;

    for (a_int i = 0; i < L->ncv; i++) {
        for (k = i; k > 0 && sorted[k - 1] < fabs(nu[i]); k--)
            sorted[k] = sorted[k - 1];
        sorted[k] = fabs(nu[i]);
    }
    return L->sigma + 1.0 / sorted[L->nev - 1];
}

ritz_status ritz_lanczos_lowest(const ritz_shifted *S, int64_t k, ritz_dense *X,
                                double *reach, ritz_lanczos_end *end)
{
    const int64_t ncv = 2 * k + 1 > k + 20 ? 2 * k + 1 : k + 20;
    RITZ_OWN(lanczos)
    L = {.A = S->M,
         .B = S->M,
         .F = S->A,
         .sigma = S->sigma,
         .which = "LM",
         .what = "modes",
         .iparam = {[2] = RESTARTS, [6] = INVERSE}};

    RITZ_CHECK(allocate(S->M->nrow, k, ncv, &L));
    RITZ_CHECK(start(&L));
    RITZ_CHECK(iterate(&L));
    if (L.info == INVARIANT) {
        *end = RITZ_LANCZOS_EXHAUSTED;
        return RITZ_OK;
    }
    *reach = reach_of(&L);
    *end = L.info == 0 ? RITZ_LANCZOS_FOUND : RITZ_LANCZOS_SLOW;
    if (*end != RITZ_LANCZOS_FOUND)
        return RITZ_OK;
    RITZ_CHECK(extract(&L));
    L.V.ncol = L.nev;
    RITZ_MOVE(*X, L.V);
    return RITZ_OK;
}

/* ---- ends of a spectrum ------------------------------------------------- */

/* |x| in the inner product of B. */
static ritz_status norm_of(const lanczos *L, double *x, double *out)
{
    double *work = L->workd;

    RITZ_CHECK(multiply(L->B, x, work));
    *out = sqrt(fmax(cblas_ddot(L->n, x, 1, work, 1), 0.0));
    return RITZ_OK;
}

/* A unit of theta in which its largest value is about one, since ARPACK takes
   values below eps^(2/3) for zero. 0 if A is zero. */
static ritz_status choose_unit(lanczos *L)
{
    double before = 0.0, after = 0.0;

    RITZ_CHECK(norm_of(L, L->resid, &before));
    if (before > 0.0) {
        cblas_dscal(L->n, 1.0 / before, L->resid, 1);
        RITZ_CHECK(apply(L, L->resid, L->resid));
        RITZ_CHECK(norm_of(L, L->resid, &after));
    }
    L->unit = after;
    return RITZ_OK;
}

/* eps |x|'|B||x|: the largest change of x'B x by rounding of B's entries. */
static double rounding_of(const ritz_sparse *B, const double *x)
{
    double sum = 0.0;

    for (int64_t j = 0; j < B->ncol; j++)
        for (int64_t p = B->colptr[j]; p < B->colptr[j + 1]; p++)
            sum += fabs(x[B->rowind[p]] * B->val[p] * x[j]);
    return DBL_EPSILON * sum;
}

/* Relative error of theta of pair j, x of length one by B: the residual
   |F^-1 A x - theta x| / |theta| and rounding of B. */
static ritz_status find_error(lanczos *L, int64_t j, double *out)
{
    double *const x = ritz_dense_col(&L->V, j), *const y = L->resid;

    memcpy(y, x, (size_t)L->n * sizeof *y);
    RITZ_CHECK(apply(L, y, y));
    cblas_daxpy(L->n, -L->d[j], x, 1, y, 1);
    RITZ_CHECK(norm_of(L, y, out));
    *out = *out / fabs(L->d[j]) + rounding_of(L->B, x);
    return RITZ_OK;
}

/* Keep the accurate values of L->d and set the others to NaN. */
static ritz_status keep_accurate(lanczos *L)
{
    double least = HUGE_VAL;

    for (a_int j = 0; j < L->iparam[CONVERGED]; j++) {
        double error = 0.0;

        RITZ_CHECK(find_error(L, j, &error));
        least = fmin(least, error);
        if (!(error <= RITZ_END_ERROR))
            L->d[j] = (double)NAN;
    }
    RITZ_REFUSE_IF(!(least <= RITZ_END_ERROR), RITZ_ERR_CONVERGENCE,
                   "rounding of a stiffness that is nearly singular may change "
                   "it by %.1e of itself",
                   least);
    return RITZ_OK;
}

/* Values in L->d, ascending, as many as converged. */
static ritz_status find_ends(const ritz_ended *of, lanczos *L)
{
    L->A = of->A;
    L->B = of->B;
    L->F = of->F;
    L->what = "buckling factors";
    L->iparam[6] = FORWARD;
    RITZ_CHECK(
        allocate(of->A->nrow, L->which[0] == 'B' ? 2 : 1, END_VECTORS, L));
    RITZ_CHECK(start(L));
    RITZ_CHECK(choose_unit(L));
    if (L->unit == 0.0)
        return RITZ_OK;
    RITZ_CHECK(iterate(L));
    RITZ_REFUSE_IF(L->info == INVARIANT || L->iparam[CONVERGED] < 1,
                   RITZ_ERR_CONVERGENCE,
                   "ARPACK does not find an end of the spectrum in %d restarts",
                   (int)L->iparam[2]);
    RITZ_CHECK(extract(L));
    return keep_accurate(L);
}

ritz_status ritz_lanczos_ends(const ritz_ended *of, double theta[2])
{
    RITZ_OWN(lanczos) L = {.which = "BE", .iparam = {[2] = END_RESTARTS}};
    double found[2] = {0.0, 0.0};

    RITZ_CHECK(find_ends(of, &L));
    if (L.unit > 0.0)
        found[0] = found[1] = (double)NAN;
    if (L.iparam[CONVERGED] == 1)
        found[L.d[0] > 0.0] = L.unit * L.d[0];
    for (int j = 0; j < 2 && L.iparam[CONVERGED] == 2; j++)
        found[j] = L.unit * L.d[j];
    memcpy(theta, found, sizeof found);
    return RITZ_OK;
}

ritz_status ritz_lanczos_end_of(const ritz_ended *of, ritz_spectrum_end end,
                                double *theta)
{
    RITZ_OWN(lanczos)
    L = {.which = end == RITZ_END_LOWEST ? "SA" : "LA",
         .iparam = {[2] = RESTARTS}};

    RITZ_CHECK(find_ends(of, &L));
    *theta = L.unit > 0.0 ? L.unit * L.d[0] : 0.0;
    return RITZ_OK;
}
