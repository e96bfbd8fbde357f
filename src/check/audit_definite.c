/*
 * Definiteness: with S = diag(A)^-1/2, S A S has a diagonal of ones, and
 *
 *     S A S + tol I,   tol = n eps
 *
 * is positive definite if no eigenvalue lies below what rounding leaves. If it
 * is not, the digits of the source may be the reason: half a unit of the last
 * digit moves an eigenvalue by at most the largest row sum of |S A S| times it.
 * A static condensation cancels digits too: 1e-10 is let pass with a warning
 * (commercial superelements stay below, measured).
 */
#include "check/audit_parts.h"

#include "base/alloc.h"

#include <ritz/factor.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Diagonal of A, zero where it has no entry. */
static void read_diagonal(const ritz_sparse *A, double *diagonal)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->rowind[p] == j)
                diagonal[j] += A->val[p];
}

/* A row that a negative or missing diagonal entry makes indefinite; or -1. */
static int64_t bad_diagonal(const ritz_sparse *A, const double *diagonal)
{
    for (int64_t j = 0; j < A->ncol; j++) {
        if (diagonal[j] < 0.0)
            return j;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (diagonal[j] == 0.0 && A->val[p] != 0.0)
                return j;
    }
    return -1;
}

/* S A S + (tol on the diagonal, 1 in empty rows); largest row sum of |S A S| */
static ritz_status scale(const ritz_sparse *A, const double *diagonal,
                         double tol, ritz_sparse *out, double *sum)
{
    ritz_status status = RITZ_OK;
    ritz_sparse scaled = {0};
    ritz_sparse shift = {0};

    RITZ_TRY(ritz_sparse_copy(A, &scaled));
    RITZ_TRY(ritz_sparse_new(A->nrow, A->ncol, A->ncol, &shift));
    *sum = 0.0;
    for (int64_t j = 0; j < A->ncol; j++) {
        double column = 0.0;

        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            double d = diagonal[j] * diagonal[A->rowind[p]];

            scaled.val[p] = d > 0.0 ? A->val[p] / sqrt(d) : 0.0;
            column += fabs(scaled.val[p]);
        }
        *sum = fmax(*sum, column);
        shift.colptr[j + 1] = j + 1;
        shift.rowind[j] = j;
        shift.val[j] = diagonal[j] > 0.0 ? tol : 1.0;
    }
    RITZ_TRY(ritz_sparse_add(1.0, &scaled, 1.0, &shift, out));
done:
    ritz_sparse_free(&scaled);
    ritz_sparse_free(&shift);
    return status;
}

/* Eigenvalues of S A S below -tol; weak: where the factor gave way, or -1. */
static ritz_status count_negative(const ritz_sparse *A, const double *diagonal,
                                  double tol, double *sum, int64_t *weak,
                                  int64_t *count)
{
    ritz_status status = RITZ_OK;
    ritz_sparse scaled = {0};
    ritz_factor *F = NULL;
    ritz_ldl *L = NULL;

    *count = 0;
    *weak = -1;
    RITZ_TRY(scale(A, diagonal, tol, &scaled, sum));
    status = ritz_factor_spd_weak(&scaled, &F, weak);
    if (status != RITZ_ERR_SINGULAR)
        goto done;
    *count = 1; /* what is known if MUMPS meets an exact zero */
    status = ritz_ldl_new(&scaled, count, &L);
    if (status == RITZ_ERR_SINGULAR)
        status = RITZ_OK;
done:
    ritz_sparse_free(&scaled);
    ritz_factor_free(&F);
    ritz_ldl_free(&L);
    return status;
}

static void say_negative(ritz_auditor *it, const char *name, int64_t count,
                         int64_t row, bool explained)
{
    char dof[RITZ_DOF_NAME_SIZE] = "";

    if (row >= 0)
        ritz_dof_name(it->component->dof[row], dof);
    if (count == 0)
        ritz_auditor_say(it, name, 0.0, 0.0, RITZ_PASS, NULL,
                         "no negative eigenvalue");
    else if (explained)
        ritz_auditor_say(it, name, (double)count, 0.0, RITZ_WARN, dof,
                         "%" PRId64 " negative eigenvalues, no larger than "
                         "rounding of the source may leave",
                         count);
    else
        ritz_auditor_say(it, name, (double)count, 0.0, RITZ_FAIL, dof,
                         "%" PRId64 " negative eigenvalues: not positive "
                         "semidefinite",
                         count);
}

static ritz_status check_definite(ritz_auditor *it, const ritz_sparse *A,
                                  const char *name)
{
    ritz_status status = RITZ_OK;
    double n = (double)A->nrow;
    double tol = fmax(n, 64.0) * DBL_EPSILON;
    double *diagonal = NULL;
    double sum = 0.0;
    int64_t weak = -1;
    int64_t other = -1;
    int64_t count = 0;
    int64_t left = 1;

    RITZ_NEW(diagonal, A->nrow);
    read_diagonal(A, diagonal);
    weak = bad_diagonal(A, diagonal);
    if (weak >= 0) {
        char dof[RITZ_DOF_NAME_SIZE];

        ritz_auditor_say(it, name, diagonal[weak], 0.0, RITZ_FAIL,
                         ritz_dof_name(it->component->dof[weak], dof),
                         "its diagonal entry is %g, which cannot be",
                         diagonal[weak]);
        goto done;
    }
    RITZ_TRY(count_negative(A, diagonal, tol, &sum, &weak, &count));
    if (count > 0) {
        double rounding = 0.5 * pow(10.0, 1.0 - it->digits) * sum;

        RITZ_TRY(count_negative(A, diagonal, tol + fmax(rounding, 1e-10), &sum,
                                &other, &left));
    }
    say_negative(it, name, count, weak, left == 0);
done:
    free(diagonal);
    return status;
}

ritz_status ritz_audit_definite(ritz_auditor *it)
{
    RITZ_CHECK(check_definite(it, &it->component->M, "mass-definite"));
    if (!it->rigid)
        RITZ_CHECK(check_definite(it, &it->component->K, "stiffness-definite"));
    return RITZ_OK;
}
