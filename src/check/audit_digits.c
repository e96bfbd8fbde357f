/*
 * With how many digits K came: those that the source states, or fewer where
 * the values themselves are all decimal numbers of fewer digits.
 *
 * A file of few digits is not the only matrix of short numbers: springs of 200
 * and 0.5 are what they say. What d digits are left of has nine values in ten
 * that need all d, whatever their size, or, with a fixed number of decimals,
 * nine in ten that need the last of these. Sums and products of short numbers
 * have neither.
 */
#include "check/audit_parts.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LOOKED_AT = 2000, /* entries of K */
    FULL = 16,        /* digits of a double, and no decimal number */
    FEW = 12,         /* as many are enough; floats of 24 bits have more */
    LEAST = 5,        /* that a writer of stiffness leaves, as of %.4e */
    TELLING = 8,      /* values; less than half of so many: 1 in 2000 */
};
/* Whole numbers of some unit up to this are nobody's rounding, unless harm is
   seen. */
static const double small_whole = 1e6;

typedef struct decimals {
    int64_t count;     /* of values looked at, each once */
    int64_t full;      /* of them, those that need all of `digits` */
    int64_t last;      /* those that need the last decimal, `place` */
    int digits, place; /* that all make do with */
    double largest;
} decimals;

/* Whether `digits` decimal digits say what `value` is. */
static bool suffices(double value, int digits)
{
    char text[40];

    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    return fabs(strtod(text, NULL) - value) <= 4.0 * DBL_EPSILON * fabs(value);
}

/* The digits of a value, and the power of ten of the last one. */
static int digits_of(double value, int *place)
{
    char text[40];
    int digits = 1;

    while (digits < FULL && !suffices(value, digits))
        digits++;
    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    *place = (int)strtol(strchr(text, 'e') + 1, NULL, 10) + 1 - digits;
    return digits;
}

static int ascending(const void *left, const void *right)
{
    const double *a = left, *b = right;

    return (*a > *b) - (*a < *b);
}

/* Some entries of K, magnitudes, each once and none of them 0. */
static int64_t sample(const ritz_sparse *K, double *value)
{
    int64_t nnz = K->colptr[K->ncol], step = nnz / LOOKED_AT + 1;
    int64_t count = 0, kept = 0;

    for (int64_t p = 0; p < nnz; p += step)
        if (K->val[p] != 0.0)
            value[count++] = fabs(K->val[p]);
    qsort(value, (size_t)count, sizeof *value, ascending);
    for (int64_t k = 0; k < count; k++)
        if (kept == 0 ||
            value[k] - value[kept - 1] > 4.0 * DBL_EPSILON * value[k])
            value[kept++] = value[k];
    return kept;
}

static ritz_status look(const ritz_sparse *K, decimals *out)
{
    ritz_status status = RITZ_OK;
    decimals d = {.digits = 1};
    double *value = NULL;

    RITZ_NEW(value, LOOKED_AT + 1);
    d.count = sample(K, value);
    for (int64_t k = 0; k < d.count && d.digits < FULL; k++) {
        int place = 0, digits = digits_of(value[k], &place);

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
done:
    free(value);
    return status;
}

/* Whether its numbers are short without having been made so. */
static bool is_exact(const decimals *d)
{
    return d->digits < LEAST ||
           (d->count >= TELLING && 2 * d->full < d->count &&
            (d->place >= 0 || 2 * d->last < d->count));
}

ritz_status ritz_audit_digits(ritz_auditor *it)
{
    const ritz_component *c = it->component;
    decimals d = {0};
    double needed = 17.0;
    bool exact = false;

    RITZ_CHECK(look(&c->K, &d));
    exact = d.digits < FEW && is_exact(&d);
    if (d.digits < FULL && !exact)
        needed = d.digits;
    it->declared = !exact && c->digits > 0.0 && c->digits <= needed;
    it->digits = it->declared ? c->digits : needed;
    if (d.digits < FEW && d.largest <= small_whole * pow(10.0, d.place))
        it->declared = false;
    return RITZ_OK;
}
