/* Suggestion of a further angle, by errors between listed angles. */
#include "compare/compare.h"

#include "base/tolerances.h"

#include <math.h>
#include <stddef.h>

/*
 * Suggest the angle whose error is largest relative to the errors at listed
 * angles. Nothing is suggested for errors that would be invisible in a plot,
 * nor for errors that are as large at listed angles, which another angle would
 * not reduce.
 */

static const struct measure {
    const char *name;
    size_t offset; /* in ritz_compare_row */
} measures[] = {
    {"response", offsetof(ritz_compare_row, response_error)},
    {"frequency", offsetof(ritz_compare_row, frequency_error)},
    {"gain", offsetof(ritz_compare_row, gain_error)},
    {"damping", offsetof(ritz_compare_row, damping_error)},
};

/* The largest error of one measure between listed angles; row -1 if there is
   none. */
static ritz_suggestion find_worst(const ritz_comparison *c,
                                  const struct measure *m)
{
    ritz_suggestion worst = {.row = -1, .measure = m->name};

    for (int64_t k = 0; k < c->num_rows; k++) {
        double error = *(const double *)((const char *)&c->row[k] + m->offset);

        if (c->row[k].listed)
            worst.listed = fmax(worst.listed, error); /* fmax ignores NaN */
        else if (!isnan(error) && (worst.row < 0 || error > worst.error)) {
            worst.row = k;
            worst.error = error;
        }
    }
    return worst;
}

/* How prominent an error is; above 1 its angle is suggested. */
static double rate_prominence(const ritz_suggestion *s)
{
    return s->row < 0 ? 0.0
                      : s->error / fmax(RITZ_SUGGEST_VISIBLE,
                                        RITZ_SUGGEST_FACTOR * s->listed);
}

void ritz_compare_suggest(const ritz_comparison *comparison,
                          ritz_suggestion *out)
{
    ritz_suggestion best = {.row = -1};

    for (size_t k = 0; k < sizeof measures / sizeof *measures; k++) {
        ritz_suggestion one = find_worst(comparison, &measures[k]);

        one.worth = rate_prominence(&one) > 1.0;
        if (one.row >= 0 &&
            (best.row < 0 ||
             (one.worth && rate_prominence(&one) > rate_prominence(&best))))
            best = one;
    }
    *out = best;
}
