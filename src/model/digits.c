/*
 * The number of significant digits of K: as the source states, or fewer if all
 * values are decimal numbers with fewer digits.
 *
 * Values with few digits need not have been rounded: springs of 200 and 0.5 are
 * exact. If values were rounded to d digits, nine in ten of them need all d
 * digits; if they were rounded to a fixed number of decimals, nine in ten need
 * the last decimal. Sums and products of exact numbers with few digits have
 * neither property.
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
    LOOKED_AT = 2000, /* entries of K that are examined, at most */
    FULL = 16,        /* digits of a double that is no decimal number */
    FEW = 12,         /* fewer digits than this count as decimal; single
                         precision needs more */
    LEAST = 5,        /* fewest digits to which writers round a stiffness, as
                         with %.4e */
    TELLING = 8,      /* fewest values for a decision: of 8 rounded values, less
                         than half need all digits with a probability of only 1
                         in 2000 */
};

typedef struct decimals {
    int64_t count;     /* number of distinct values examined */
    int64_t full;      /* values that need all of `digits` */
    int64_t last;      /* values that need the last decimal, `place` */
    int digits, place; /* digits, and power of ten of the last decimal, that
                          suffice for all values */
    double largest;
} decimals;

/* Whether `digits` decimal digits represent `value` to 4 eps. */
static bool digits_suffice(double value, int digits)
{
    char text[40];

    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    return fabs(strtod(text, NULL) - value) <= 4.0 * DBL_EPSILON * fabs(value);
}

/* Number of decimal digits of a value, and the power of ten of the last one. */
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

/* Distinct magnitudes of a sample of the nonzero entries of K. */
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

/* Whether the values have few digits without having been rounded. */
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
