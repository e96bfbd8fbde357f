/*
 * Matrices of a component: whether values are finite and symmetric, how many
 * digits they have, negative eigenvalues, proportional damping.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "poles/poles.h"

#include <ritz/matrix.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Values: finite and symmetric. */

/* Entries that are not finite; their rows are flagged. */
static int64_t count_infinite(const ritz_sparse *A, bool *flag)
{
    int64_t count = 0;

    for (int64_t j = 0; A->colptr && j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (!isfinite(A->val[p])) {
                flag[A->rowind[p]] = true;
                count++;
            }
    return count;
}

static ritz_status check_finite(ritz_checker *it)
{
    const ritz_component *c = it->component;
    const ritz_sparse *const all[4] = {&c->K, &c->M, &c->D, &c->K4};
    RITZ_OWN_ARRAY bool *flag = NULL;
    char where[RITZ_WHERE_SIZE];
    int64_t count = 0;

    RITZ_CHECK_NEW(flag, c->num_dofs);
    for (int k = 0; k < 4; k++)
        count += count_infinite(all[k], flag);
    ritz_checker_dofs(it, flag, where);
    it->usable = count == 0;
    ritz_checker_say(it, "finite", (double)count, 0.0,
                     count == 0 ? RITZ_PASS : RITZ_FAIL, where,
                     count == 0 ? "all values are finite"
                                : "values that are not finite: no other check "
                                  "can be made");
    return RITZ_OK;
}

static void check_symmetry(ritz_checker *it)
{
    const ritz_component *c = it->component;
    /* not D, which may have a gyroscopic part */
    const ritz_sparse *const all[3] = {&c->K, &c->M, &c->K4};
    ritz_verdict verdict = RITZ_PASS;
    double now = 0.0;
    double found = 0.0;

    for (int k = 0; k < 3; k++)
        if (all[k]->colptr)
            now = fmax(now, ritz_sparse_asymmetry(all[k]));
    found = fmax(now, c->asymmetry);
    verdict = now > RITZ_SYMMETRIC_SOURCE     ? RITZ_FAIL
              : found > RITZ_SYMMETRIC_SOURCE ? RITZ_WARN
                                              : RITZ_PASS;
    ritz_checker_say(it, "symmetry", found, RITZ_SYMMETRIC_SOURCE, verdict,
                     NULL, "%s",
                     verdict == RITZ_FAIL ? "the matrices are not symmetric"
                     : verdict == RITZ_WARN
                         ? "the source was not symmetric, and was averaged"
                     : found > 0.0 ? "rounding only, averaged away"
                                   : "exactly symmetric");
}

ritz_status ritz_check_values(ritz_checker *it)
{
    RITZ_CHECK(check_finite(it));
    if (!it->usable)
        return RITZ_OK;
    check_symmetry(it);
    it->digits = 17.0;
    return it->rigid
               ? RITZ_OK
               : ritz_source_digits(it->component, &it->digits, &it->declared);
}

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

/* Diagonal of A, zero where it has no entry. */
static void read_diagonal(const ritz_sparse *A, double *diagonal)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->rowind[p] == j)
                diagonal[j] += A->val[p];
}

/* A row that a negative or missing diagonal entry makes indefinite; or -1. */
static int64_t find_bad_diagonal(const ritz_sparse *A, const double *diagonal)
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
static ritz_status scale_matrix(const ritz_sparse *A, const double *diagonal,
                                double tol, ritz_sparse *out, double *sum)
{
    RITZ_OWN(ritz_sparse) scaled = {0}, shift = {0};

    RITZ_CHECK(ritz_sparse_copy(A, &scaled));
    RITZ_CHECK(ritz_sparse_new(A->nrow, A->ncol, A->ncol, &shift));
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
    return ritz_sparse_add(1.0, &scaled, 1.0, &shift, out);
}

/* Eigenvalues of S A S below -tol; weak: where the factor gave way, or -1. */
static ritz_status count_negative(const ritz_sparse *A, const double *diagonal,
                                  double tol, double *sum, int64_t *weak,
                                  int64_t *count)
{
    ritz_status status = RITZ_OK;
    RITZ_OWN(ritz_sparse) scaled = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_ldl) *L = NULL;

    *count = 0;
    *weak = -1;
    RITZ_CHECK(scale_matrix(A, diagonal, tol, &scaled, sum));
    status = ritz_factor_spd_weak(&scaled, &F, weak);
    if (status != RITZ_ERR_SINGULAR)
        return status;
    *count = 1; /* what is known if MUMPS meets an exact zero */
    status = ritz_ldl_new(&scaled, count, &L);
    return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
}

static void say_negative(ritz_checker *it, const char *name, int64_t count,
                         int64_t row, bool explained)
{
    char dof[RITZ_DOF_NAME_SIZE] = "";

    if (row >= 0)
        ritz_dof_name(it->component->dof[row], dof);
    if (count == 0)
        ritz_checker_say(it, name, 0.0, 0.0, RITZ_PASS, NULL,
                         "no negative eigenvalue");
    else
        ritz_checker_say(it, name, (double)count, 0.0,
                         explained ? RITZ_WARN : RITZ_FAIL, dof,
                         "%" PRId64 " negative eigenvalues%s", count,
                         explained ? ", no larger than rounding of the source "
                                     "may leave"
                                   : ": not positive semidefinite");
}

static ritz_status check_definite(ritz_checker *it, const ritz_sparse *A,
                                  const char *name)
{
    double n = (double)A->nrow;
    double tol = fmax(n, 64.0) * DBL_EPSILON;
    RITZ_OWN_ARRAY double *diagonal = NULL;
    double sum = 0.0;
    int64_t weak = -1;
    int64_t other = -1;
    int64_t count = 0;
    int64_t left = 1;

    RITZ_CHECK_NEW(diagonal, A->nrow);
    read_diagonal(A, diagonal);
    weak = find_bad_diagonal(A, diagonal);
    if (weak >= 0) {
        char dof[RITZ_DOF_NAME_SIZE];

        ritz_checker_say(it, name, diagonal[weak], 0.0, RITZ_FAIL,
                         ritz_dof_name(it->component->dof[weak], dof),
                         "its diagonal entry is %g, which cannot be",
                         diagonal[weak]);
        return RITZ_OK;
    }
    RITZ_CHECK(count_negative(A, diagonal, tol, &sum, &weak, &count));
    if (count > 0) {
        double rounding = 0.5 * pow(10.0, 1.0 - it->digits) * sum;

        RITZ_CHECK(count_negative(A, diagonal,
                                  tol + fmax(rounding, RITZ_CONDENSATION_LOSS),
                                  &sum, &other, &left));
    }
    say_negative(it, name, count, weak, left == 0);
    return RITZ_OK;
}

ritz_status ritz_check_mass_definite(ritz_checker *it)
{
    return check_definite(it, &it->component->M, "mass-definite");
}

ritz_status ritz_check_stiffness_definite(ritz_checker *it)
{
    return check_definite(it, &it->component->K, "stiffness-definite");
}

/*
 * Whether D is proportional, a M + b K. One that is not is no fault: it couples
 * modes.
 */

ritz_status ritz_check_damping(ritz_checker *it)
{
    const ritz_component *c = it->component;
    double a = 0.0, b = 0.0, left = 0.0;
    double skew = 0.0;
    char where[RITZ_WHERE_SIZE];

    RITZ_CHECK(ritz_proportional(c, &a, &b, &left));
    skew = ritz_sparse_skew(&c->D);
    snprintf(where, sizeof where, "a = %.6g, b = %.6g", a, b);
    if (skew > 0.0)
        ritz_checker_say(it, "rayleigh", left, nan(""), RITZ_PASS, where,
                         "D is unsymmetric: %.3g %% of it is gyroscopic",
                         100.0 * skew);
    else
        ritz_checker_say(it, "rayleigh", left, nan(""), RITZ_PASS, where,
                         left <= RITZ_PROPORTIONAL_WITHIN
                             ? "damping is proportional: D = a M + b K"
                             : "damping is not proportional, it couples modes");
    return RITZ_OK;
}
