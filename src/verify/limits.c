/*
 * Limits of error measures: rows of the table by their names, the words of a
 * tolerance, and how an error compares with what is allowed.
 */
#include "base/tolerances.h"

#include <ritz/base.h>
#include <ritz/verify.h>

#include <stdio.h>
#include <string.h>

static bool is_relative(const ritz_measure_kind *kind)
{
    return kind->unit[0] == '\0';
}

/* Whether a tolerance of second-order models can be given for it. */
static bool is_tolerance(const ritz_measure_kind *kind)
{
    return kind->word && kind->of_modes;
}

const ritz_measure_kind *ritz_measure_kind_find(const char *name)
{
    for (int k = 0; k < RITZ_MEASURES; k++)
        if (strcmp(ritz_measure_table[k].name, name) == 0)
            return &ritz_measure_table[k];
    return NULL;
}

static bool large_is_good(const char *name)
{
    const ritz_measure_kind *kind = ritz_measure_kind_find(name);

    return kind && kind->large_is_good;
}

double ritz_measure_limit(const double limit[RITZ_MEASURES], const char *name)
{
    const ritz_measure_kind *kind = ritz_measure_kind_find(name);

    return kind ? limit[kind - ritz_measure_table] : nan("");
}

double ritz_measure_error(const char *name, double value)
{
    return large_is_good(name) ? 1.0 - value : value;
}

double ritz_measure_ratio(const char *name, double value, double limit)
{
    double error = ritz_measure_error(name, value);
    double allowed = ritz_measure_error(name, limit);

    if (isnan(value)) /* no number is no proof that the limit is met */
        return HUGE_VAL;
    if (large_is_good(name)) /* rounding may take a MAC above 1 */
        error = fmax(error, 0.0);
    if (allowed > 0.0)
        return error / allowed;
    return error <= allowed ? 0.0 : 1.0 + error;
}

bool ritz_measure_meets(const char *name, double value, double limit)
{
    return large_is_good(name) ? value >= limit : value <= limit;
}

bool ritz_measure_holds(const ritz_measure *measure)
{
    return isnan(measure->limit) ||
           ritz_measure_meets(measure->name, measure->value, measure->limit);
}

bool ritz_measure_is_beside(const char *name, double value,
                            const ritz_measure *worst)
{
    const ritz_measure_kind *kind = ritz_measure_kind_find(name);
    const ritz_measure_kind *asked = ritz_measure_kind_find(worst->name);

    return kind && asked && is_relative(kind) && is_relative(asked) &&
           ritz_measure_error(name, value) >
               RITZ_BESIDE_WORST *
                   fmax(ritz_measure_error(worst->name, worst->value), 0.0);
}

/* The row of a word; NULL and a sentence if there is none. */
static const ritz_measure_kind *find_word(const char *word)
{
    char known[RITZ_MEASURES][RITZ_NAME_SIZE];
    char all[RITZ_MEASURES * RITZ_NAME_SIZE] = "";
    const char *near = NULL;
    int64_t count = 0;
    size_t used = 0;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        if (!is_tolerance(kind))
            continue;
        if (strcmp(kind->word, word) == 0)
            return kind;
        (void)snprintf(known[count++], sizeof *known, "%s", kind->word);
        used += (size_t)snprintf(all + used, sizeof all - used, "%s%s",
                                 used > 0 ? ", " : "", kind->word);
    }
    near = ritz_text_nearest(word, count, known[0], sizeof *known);
    ritz_record("there is no measure '%s', %s%s%s", word,
                near ? "is '" : "but ", near ? near : all,
                near ? "' meant?" : "");
    return NULL;
}

/* Read the number of a tolerance for a measure. */
static ritz_status take_number(const char *text, const ritz_measure_kind *kind,
                               double *out)
{
    double value = 0.0;

    RITZ_REFUSE_IF(!ritz_text_real(text, &value) || value < 0.0 ||
                       value > (is_relative(kind) ? RITZ_MOST_RELATIVE
                                                  : RITZ_MOST_COUNT) ||
                       (value == 0.0 && is_relative(kind)),
                   RITZ_ERR_ARGUMENT, "'%s' is no tolerance of '%s'", text,
                   kind->word);
    *out = value;
    return RITZ_OK;
}

/* Read a named tolerance, "gain=1e-2". */
static ritz_status take_named(const char *item, ritz_verify_request *limits)
{
    const char *equals = strchr(item, '=');
    char name[RITZ_NAME_SIZE];
    const ritz_measure_kind *kind = NULL;
    double *limit = NULL;

    (void)snprintf(name, sizeof name, "%.*s", (int)(equals - item), item);
    kind = find_word(name);
    if (!kind)
        return RITZ_ERR_ARGUMENT;
    limit = &limits->limit[kind - ritz_measure_table];
    RITZ_REFUSE_IF(!isnan(*limit), RITZ_ERR_ARGUMENT, "'%s' is given twice",
                   name);
    return take_number(equals + 1, kind, limit);
}

/*
 * Read a tolerance without a name, "1e-2". It holds for frequencies and for the
 * flexible response, unless these are named; not for the whole response, which
 * rigid motion near 0 Hz dominates.
 */
static ritz_status take_alone(const char *item, ritz_verify_request *limits)
{
    static const ritz_measure_id of[] = {RITZ_MEASURE_FLEXIBLE,
                                         RITZ_MEASURE_FREQUENCY};
    bool any = false;

    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        double *limit = &limits->limit[of[k]];

        if (!isnan(*limit))
            continue;
        RITZ_CHECK(take_number(item, &ritz_measure_table[of[k]], limit));
        any = true;
    }
    RITZ_REFUSE_IF(!any, RITZ_ERR_ARGUMENT,
                   "'%s' alone is of '%s' and '%s', and both have a tolerance",
                   item, ritz_measure_table[of[0]].word,
                   ritz_measure_table[of[1]].word);
    return RITZ_OK;
}

/* Read the items with a name, or those without. */
static ritz_status take_items(const char *text, bool named,
                              ritz_verify_request *limits)
{
    char item[2 * RITZ_NAME_SIZE];

    for (const char *at = text; at;) {
        size_t length = strcspn(at, ",");

        RITZ_REFUSE_IF(length == 0 || length >= sizeof item, RITZ_ERR_ARGUMENT,
                       "'%s' is no list of tolerances", text);
        memcpy(item, at, length);
        item[length] = '\0';
        if (named == (strchr(item, '=') != NULL))
            RITZ_CHECK(named ? take_named(item, limits)
                             : take_alone(item, limits));
        at = at[length] ? at + length + 1 : NULL;
    }
    return RITZ_OK;
}

ritz_status ritz_tolerance_take(const char *text, ritz_verify_request *limits)
{
    RITZ_CHECK(take_items(text, true, limits));
    return take_items(text, false, limits);
}

void ritz_tolerance_print(const ritz_verify_request *limits, int64_t size,
                          char *out)
{
    size_t used = 0;

    out[0] = '\0';
    for (int k = 0; k < RITZ_MEASURES && used < (size_t)size; k++)
        if (ritz_measure_table[k].word && !isnan(limits->limit[k]))
            used += (size_t)snprintf(
                out + used, (size_t)size - used, "%s%s=%g", used > 0 ? "," : "",
                ritz_measure_table[k].word, limits->limit[k]);
}

const char *ritz_tolerance_word(const char *measure)
{
    const ritz_measure_kind *kind = ritz_measure_kind_find(measure);

    return kind && kind->word ? kind->word : measure;
}
