/*
 * The significant digits of K: as the source states, or fewer where all values
 * are decimal numbers of fewer digits.
 *
 * A matrix of short numbers need not have been rounded: springs of 200 and 0.5
 * are exact. Of values that were rounded to d digits nine in ten need all d,
 * whatever their size, or, with a fixed number of decimals, nine in ten need
 * the last of these. Sums and products of short numbers have neither property.
 */

#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "model/rounding.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

ritz_status ritz_source_digits(const ritz_component *component, double *digits,
                               bool *declared)
{
    const double stated = component->digits;
    decimals d = {0};
    double needed = 17.0;
    bool exact = false;

    RITZ_CHECK(count_digits(&component->K, &d));
    exact = d.digits < FEW && is_exact(&d);
    if (d.digits < FULL && !exact)
        needed = d.digits;
    *declared = !exact && stated > 0.0 && stated <= needed;
    *digits = *declared ? stated : needed;
    if (d.digits < FEW && d.largest <= RITZ_SHORT_NUMBERS * pow(10.0, d.place))
        *declared = false;
    return RITZ_OK;
}
