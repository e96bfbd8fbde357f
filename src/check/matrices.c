/*
 * Matrices of a component: whether values are finite and symmetric, how many
 * digits they have, negative eigenvalues, proportional damping.
 */
#include "base/alloc.h"
#include "base/search.h"
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

/*
 * The significant digits of K: as the source states, or fewer where all values
 * are decimal numbers of fewer digits.
 *
 * A matrix of short numbers need not have been rounded: springs of 200 and 0.5
 * are exact. Of values that were rounded to d digits nine in ten need all d,
 * whatever their size, or, with a fixed number of decimals, nine in ten need
 * the last of these. Sums and products of short numbers have neither property.
 */

enum {
    LOOKED_AT = 2000, /* entries of K */
    FULL = 16,        /* digits of a double, and no decimal number */
    FEW = 12,         /* as many are enough; floats of 24 bits have more */
    LEAST = 5,        /* that a writer of stiffness leaves, as of %.4e */
    TELLING = 8,      /* values; less than half of so many: 1 in 2000 */
};

typedef struct decimals {
    int64_t count;     /* of values looked at, each once */
    int64_t full;      /* of them, those that need all of `digits` */
    int64_t last;      /* those that need the last decimal, `place` */
    int digits, place; /* that all make do with */
    double largest;
} decimals;

/* Whether `digits` decimal digits say what `value` is. */
static bool digits_suffice(double value, int digits)
{
    char text[40];

    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    return fabs(strtod(text, NULL) - value) <= 4.0 * DBL_EPSILON * fabs(value);
}

/* The digits of a value, and the power of ten of the last one. */
static int count_decimals(double value, int *place)
{
    char text[40];
    int digits = 1;

    while (digits < FULL && !digits_suffice(value, digits))
        digits++;
    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    *place = (int)strtol(strchr(text, 'e') + 1, NULL, 10) + 1 - digits;
    return digits;
}

/* Distinct magnitudes of some entries of K that are not 0. */
static int64_t sample_entries(const ritz_sparse *K, double *value)
{
    int64_t nnz = K->colptr[K->ncol], step = nnz / LOOKED_AT + 1;
    int64_t count = 0;

    for (int64_t p = 0; p < nnz; p += step)
        if (K->val[p] != 0.0)
            value[count++] = fabs(K->val[p]);
    return ritz_sort_distinct(count, value, 4.0 * DBL_EPSILON);
}

static ritz_status count_digits(const ritz_sparse *K, decimals *out)
{
    decimals d = {.digits = 1};
    RITZ_OWN_ARRAY double *value = NULL;

    RITZ_CHECK_NEW(value, LOOKED_AT + 1);
    d.count = sample_entries(K, value);
    for (int64_t k = 0; k < d.count && d.digits < FULL; k++) {
        int place = 0, digits = count_decimals(value[k], &place);

        if (digits > d.digits)
            d.full = 0;
        if (k == 0 || place < d.place) {
            d.last = 0;
            d.place = place;
        }
        d.digits = digits > d.digits ? digits : d.digits;
        d.full += digits == d.digits;
        d.last += place == d.place;
        d.largest = value[k];
    }
    *out = d;
    return RITZ_OK;
}

/* Whether its numbers are short without having been rounded. */
static bool is_exact(const decimals *d)
{
    return d->digits < LEAST ||
           (d->count >= TELLING && 2 * d->full < d->count &&
            (d->place >= 0 || 2 * d->last < d->count));
}

/* Set `digits` and `declared` from K, which has entries. */
static ritz_status find_digits(ritz_checker *it)
{
    const ritz_component *c = it->component;
    decimals d = {0};
    double needed = 17.0;
    bool exact = false;

    RITZ_CHECK(count_digits(&c->K, &d));
    exact = d.digits < FEW && is_exact(&d);
    if (d.digits < FULL && !exact)
        needed = d.digits;
    it->declared = !exact && c->digits > 0.0 && c->digits <= needed;
    it->digits = it->declared ? c->digits : needed;
    if (d.digits < FEW && d.largest <= RITZ_SHORT_NUMBERS * pow(10.0, d.place))
        it->declared = false;
    return RITZ_OK;
}

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
    return it->rigid ? RITZ_OK : find_digits(it);
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
