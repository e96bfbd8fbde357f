/*
 * P A P' = L L' by CHOLMOD.
 *
 * Whether A is singular must not depend on units: a model mixes N/m with N m.
 * Rounding perturbs A(i,j) by about eps sqrt(A(i,i) A(j,j)), whatever they are
 * [Demmel1989], so the measure is the smallest eigenvalue of
 *
 *     H = S A S,   S = diag(A)^-1/2
 *
 * estimated by inverse iteration from the row with the smallest L(j,j)^2 /
 * A(j,j).
 */
#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <suitesparse/cholmod.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    BLOCK = 32, /* right-hand sides at once: more gain nothing, cost room */
    SWEEPS = 3, /* of inverse iteration: one finds a lone small eigenvalue */
};

struct ritz_factor {
    cholmod_common common;
    cholmod_factor *L;
    cholmod_dense *X, *Y, *E; /* room for a solve, kept from one to the next */
};

/* Describe A to CHOLMOD without copying; stype -1 reads the lower triangle. */
static cholmod_sparse view_sparse(const ritz_sparse *A)
{
    return (cholmod_sparse){
        .nrow = (size_t)A->nrow,
        .ncol = (size_t)A->ncol,
        .nzmax = (size_t)A->colptr[A->ncol],
        .p = A->colptr,
        .i = A->rowind,
        .x = A->val,
        .stype = -1,
        .itype = CHOLMOD_LONG,
        .xtype = CHOLMOD_REAL,
        .dtype = CHOLMOD_DOUBLE,
        .sorted = 1,
        .packed = 1,
    };
}

static cholmod_dense view_dense(int64_t nrow, int64_t ncol, double *val)
{
    return (cholmod_dense){
        .nrow = (size_t)nrow,
        .ncol = (size_t)ncol,
        .nzmax = (size_t)(nrow * ncol),
        .d = (size_t)nrow,
        .x = val,
        .xtype = CHOLMOD_REAL,
        .dtype = CHOLMOD_DOUBLE,
    };
}

static ritz_status copy_diagonal(const ritz_sparse *A, double *a)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            RITZ_REFUSE_IF(!isfinite(A->val[p]), RITZ_ERR_ARGUMENT,
                           "entry (%" PRId64 ", %" PRId64 ") is not finite",
                           A->rowind[p], j);
            if (A->rowind[p] == j)
                a[j] = A->val[p];
        }
    return RITZ_OK;
}

/* d(k) = L(k,k) of a supernodal factor: blocks of columns with common rows. */
static void supernodal_diagonal(const cholmod_factor *L, double *d)
{
    const int64_t *super = L->super;
    const int64_t *pi = L->pi;
    const int64_t *px = L->px;
    const double *x = L->x;

    for (size_t s = 0; s < L->nsuper; s++) {
        int64_t rows = pi[s + 1] - pi[s];

        for (int64_t k = super[s]; k < super[s + 1]; k++)
            d[k] = x[px[s] + (k - super[s]) * (rows + 1)];
    }
}

/* Pivots of a simplicial factor: the first entry of each column. */
static void simplicial_diagonal(const cholmod_factor *L, double *d)
{
    const int64_t *p = L->p;
    const double *x = L->x;

    for (size_t k = 0; k < L->n; k++)
        d[k] = x[p[k]];
}

/* Smallest L(k,k)^2 / A(k,k), and the row of A where it stands. */
static ritz_status weakest_pivot(const cholmod_factor *L, const double *a,
                                 double *ratio, int64_t *row)
{
    const int64_t *perm = L->Perm;
    RITZ_OWN_ARRAY double *d = NULL;

    RITZ_CHECK_NEW(d, (int64_t)L->n);
    (L->is_super ? supernodal_diagonal : simplicial_diagonal)(L, d);
    for (size_t k = 0; k < L->n; k++) {
        double r = d[k] * d[k] / a[perm[k]];

        if (r >= *ratio) /* what is not a number is the weakest */
            continue;
        *ratio = r;
        *row = perm[k];
    }
    return RITZ_OK;
}

/* y := y / |y|, and |y|; an infinite one stays as it is. */
static double normalise_vector(int64_t n, double *y)
{
    double largest = 0.0;
    double sum = 0.0;

    for (int64_t i = 0; i < n; i++)
        largest = fabs(y[i]) <= largest ? largest : fabs(y[i]);
    for (int64_t i = 0; i < n; i++)
        sum += y[i] / largest * (y[i] / largest);
    sum = largest * sqrt(sum);
    for (int64_t i = 0; i < n; i++)
        y[i] /= sum;
    return sum;
}

/* Smallest eigenvalue of H, y := H^-1 y from y = e_row. */
static ritz_status smallest_eigenvalue(ritz_factor *F, const double *a,
                                       int64_t row, double *out)
{
    int64_t n = (int64_t)F->L->n;
    RITZ_OWN(ritz_dense) y = {0};

    RITZ_CHECK(ritz_dense_new(n, 1, &y));
    y.val[row] = 1.0;
    for (int s = 0; s < SWEEPS; s++) {
        for (int64_t i = 0; i < n; i++)
            y.val[i] *= sqrt(a[i]);
        RITZ_CHECK(ritz_factor_solve(F, &y));
        for (int64_t i = 0; i < n; i++)
            y.val[i] *= sqrt(a[i]);
        *out = 1.0 / normalise_vector(n, y.val);
    }
    return RITZ_OK;
}

static ritz_status judge_pivots(ritz_factor *F, const double *a, int64_t *weak)
{
    const int64_t *perm = F->L->Perm;
    double ratio = HUGE_VAL;
    double lambda = HUGE_VAL;
    int64_t row = -1;

    if (F->common.status == CHOLMOD_NOT_POSDEF) {
        row = F->L->minor < F->L->n ? perm[F->L->minor] : -1;
        lambda = 0.0;
    } else {
        RITZ_CHECK(weakest_pivot(F->L, a, &ratio, &row));
        if (row >= 0 && !(ratio > RITZ_PIVOT_STRONG))
            RITZ_CHECK(smallest_eigenvalue(F, a, row, &lambda));
    }
    if (weak)
        *weak = row;
    RITZ_REFUSE_IF(!(lambda > RITZ_SINGULAR_SPD), RITZ_ERR_SINGULAR,
                   "not positive definite, is a rigid-body motion left free?");
    return RITZ_OK;
}

/* Supernodal or not, and which ordering, CHOLMOD decides by the fill. */
static ritz_status factorise_sparse(ritz_factor *F, const ritz_sparse *A)
{
    cholmod_sparse view = view_sparse(A);

    cholmod_l_start(&F->common);
    F->common.print = 0;
    F->common.final_ll = 1; /* LDL', the default, accepts negative pivots */
    F->L = cholmod_l_analyze(&view, &F->common);
    if (F->L)
        cholmod_l_factorize(&view, F->L, &F->common);
    RITZ_REFUSE_IF(F->common.status == CHOLMOD_OUT_OF_MEMORY ||
                       F->common.status == CHOLMOD_TOO_LARGE,
                   RITZ_ERR_MEMORY,
                   "no memory for the factor of %" PRId64 " rows", A->nrow);
    RITZ_REFUSE_IF(F->common.status < 0, RITZ_ERR_ARGUMENT,
                   "the matrix cannot be factored, CHOLMOD says %d",
                   F->common.status);
    return RITZ_OK;
}

ritz_status ritz_factor_spd_weak(const ritz_sparse *A, ritz_factor **out,
                                 int64_t *weak)
{
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN_ARRAY double *a = NULL;

    if (weak)
        *weak = -1;
    RITZ_REFUSE_IF(A->nrow != A->ncol, RITZ_ERR_ARGUMENT,
                   "a %" PRId64 " x %" PRId64 " matrix is not square", A->nrow,
                   A->ncol);
    RITZ_CHECK_NEW(a, A->nrow);
    RITZ_CHECK(copy_diagonal(A, a));
    RITZ_CHECK_NEW(F, 1);
    RITZ_CHECK(factorise_sparse(F, A));
    RITZ_CHECK(judge_pivots(F, a, weak));
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

ritz_status ritz_factor_spd(const ritz_sparse *A, ritz_factor **out)
{
    return ritz_factor_spd_weak(A, out, NULL);
}

ritz_status ritz_factor_solve(ritz_factor *F, ritz_dense *X)
{
    int64_t n = (int64_t)F->L->n;

    RITZ_REFUSE_IF(X->nrow != n, RITZ_ERR_ARGUMENT,
                   "a factor of %" PRId64 " rows meets %" PRId64, n, X->nrow);
    for (int64_t j = 0; n > 0 && j < X->ncol; j += BLOCK) {
        int64_t k = X->ncol - j < BLOCK ? X->ncol - j : BLOCK;
        cholmod_dense B = view_dense(n, k, ritz_dense_col(X, j));
        int solved = cholmod_l_solve2(CHOLMOD_A, F->L, &B, NULL, &F->X, NULL,
                                      &F->Y, &F->E, &F->common);

        RITZ_REFUSE_IF(!solved, RITZ_ERR_MEMORY, "no memory to solve");
        memcpy(B.x, F->X->x, (size_t)(n * k) * sizeof *X->val);
    }
    return RITZ_OK;
}

void ritz_factor_free(ritz_factor **F)
{
    if (!*F)
        return;
    cholmod_l_free_dense(&(*F)->X, &(*F)->common);
    cholmod_l_free_dense(&(*F)->Y, &(*F)->common);
    cholmod_l_free_dense(&(*F)->E, &(*F)->common);
    cholmod_l_free_factor(&(*F)->L, &(*F)->common);
    cholmod_l_finish(&(*F)->common);
    free(*F);
    *F = NULL;
}
