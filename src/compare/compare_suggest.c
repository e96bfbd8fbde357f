/*
 * Which angle to add: where an error between listed angles stands out of those
 * at listed ones. Errors that nobody would see in a plot ask for nothing, and
 * neither do those that are as large at listed angles, where another angle
 * would change nothing.
 */
#include "compare/compare_parts.h"

#include <math.h>
#include <stddef.h>

static const double visible = 1e-3;
static const double outstanding = 10.0;

static const struct measure {
    const char *name;
    size_t offset; /* in ritz_compare_row */
} measures[] = {
    {"response", offsetof(ritz_compare_row, response_error)},
    {"frequency", offsetof(ritz_compare_row, frequency_error)},
    {"gain", offsetof(ritz_compare_row, gain_error)},
};

static double error_of(const ritz_compare_row *row, const struct measure *m)
{
    return *(const double *)((const char *)row + m->offset);
}

/* The worst of one measure between angles; row -1 if there is none. */
static ritz_suggestion find_worst(const ritz_comparison *c,
                                  const struct measure *m)
{
    ritz_suggestion worst = {.row = -1, .measure = m->name};

    for (int64_t k = 0; k < c->num_rows; k++) {
        double error = error_of(&c->row[k], m);

        if (c->row[k].listed)
            worst.listed = fmax(worst.listed, error); /* NaN passes by */
        else if (!isnan(error) && (worst.row < 0 || error > worst.error)) {
            worst.row = k;
            worst.error = error;
        }
    }
    return worst;
}

/* How far an error stands out: one or less asks for nothing. */
static double stands_out(const ritz_suggestion *s)
{
    return s->row < 0 ? 0.0 : s->error / fmax(visible, outstanding * s->listed);
}

void ritz_compare_suggest(const ritz_comparison *comparison,
                          ritz_suggestion *out)
{
    ritz_suggestion best = {.row = -1};

    for (size_t k = 0; k < sizeof measures / sizeof *measures; k++) {
        ritz_suggestion one = find_worst(comparison, &measures[k]);

        one.worth = stands_out(&one) > 1.0;
        if (one.row >= 0 &&
            (best.row < 0 ||
             (one.worth && stands_out(&one) > stands_out(&best))))
            best = one;
    }
    *out = best;
}
