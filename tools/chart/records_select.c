/* Which records, which measures and which methods a chart shows. */
#include "cli/records.h"

#include <ritz/measures.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The measure that is drawn after so many others; NULL: there are no more. */
static const ritz_measure_kind *by_importance(int rank)
{
    for (int k = 0; k < RITZ_MEASURES; k++)
        if (ritz_measure_table[k].importance == rank + 1)
            return &ritz_measure_table[k];
    return NULL;
}

double record_error(const record *r, const char *name)
{
    return ritz_measure_error(name, record_value(r->errors, name));
}

static bool usable(const record *r)
{
    return r->errors && r->order >= 0 && *r->method;
}

/* A later line that says the same and more takes the place of an earlier. */
static void put_down(const record *r, records *some)
{
    for (int64_t k = 0; k < some->count; k++) {
        record *before = &some->item[k];

        if (before->order != r->order ||
            strcmp(before->method, r->method) != 0 ||
            !json_equal(before->errors, r->errors))
            continue;
        bool chosen = before->chosen, runner_up = before->runner_up;

        *before = *r;
        before->chosen = before->chosen || chosen;
        before->runner_up = before->runner_up || runner_up;
        return;
    }
    some->item[some->count++] = *r;
}

ritz_status records_select(const records *all, const char *subject,
                           records *out)
{
    ritz_status status = RITZ_OK;
    records some = {0};
    const record *first = NULL;

    some.item = calloc((size_t)all->count + 1, sizeof *some.item);
    RITZ_FAIL_IF(!some.item, RITZ_ERR_MEMORY, "no memory for records");
    for (int64_t k = 0; k < all->count; k++) {
        const record *r = &all->item[k];

        if (!usable(r) || (subject && strcmp(r->subject, subject) != 0))
            continue;
        first = first ? first : r;
        RITZ_FAIL_IF(!subject && strcmp(r->subject, first->subject) != 0,
                     RITZ_ERR_ARGUMENT,
                     "records of '%.60s' and of '%.60s' do not compare: choose "
                     "by --subject",
                     first->subject, r->subject);
        put_down(r, &some);
    }
    RITZ_FAIL_IF(some.count == 0 && subject && *subject, RITZ_ERR_ARGUMENT,
                 "no record of '%.60s' has a method, an order and errors",
                 subject);
    RITZ_FAIL_IF(some.count == 0, RITZ_ERR_ARGUMENT,
                 "no record has a method, an order and errors: those of "
                 "ritz-verify and ritz-fit do");
    *out = some;
    some = (records){0};
done:
    free(some.item);
    return status;
}

static bool has(const records *all, const char *name)
{
    for (int64_t k = 0; k < all->count; k++)
        if (isfinite(record_value(all->item[k].errors, name)))
            return true;
    return false;
}

static const char *title_of(const char *name)
{
    const ritz_measure_kind *kind = ritz_measure_kind_find(name);

    return kind && kind->label ? kind->label : name;
}

/* The tolerance that records state of a measure; of MAC, what it may lack. */
static double tolerance_of(const records *all, const char *name)
{
    for (int64_t k = 0; k < all->count; k++) {
        double limit = record_value(all->item[k].tolerance, name);

        if (isfinite(limit))
            return ritz_measure_error(name, limit);
    }
    return nan("");
}

enum { MOST_MEASURES = 12 };

static void add(const records *all, const char *name, int64_t *count,
                measure *list)
{
    for (int64_t k = 0; k < *count; k++)
        if (strcmp(list[k].name, name) == 0)
            return;
    if (*count == MOST_MEASURES || !has(all, name) ||
        strlen(name) >= RITZ_NAME_SIZE)
        return;
    snprintf(list[*count].name, RITZ_NAME_SIZE, "%s", name);
    snprintf(list[*count].title, RITZ_NAME_SIZE, "%s", title_of(name));
    list[*count].tolerance = tolerance_of(all, name);
    ++*count;
}

/* Those known, in their order; then others, of which @p wanted is true. */
static void add_all(const records *all, json_t *const *values, bool others,
                    int64_t *count, measure *list)
{
    const char *name = NULL;
    json_t *value = NULL;

    for (int k = 0; by_importance(k); k++)
        if (json_object_get(*values, by_importance(k)->name))
            add(all, by_importance(k)->name, count, list);
    json_object_foreach(*values, name, value)
    {
        const char *end = strrchr(name, '-');

        if (others || (end && strcmp(end, "-relative") == 0))
            add(all, name, count, list);
    }
}

ritz_status records_measures(const records *all, int64_t *count, measure **out)
{
    ritz_status status = RITZ_OK;
    measure *list = calloc(MOST_MEASURES, sizeof *list);

    *count = 0;
    RITZ_FAIL_IF(!list, RITZ_ERR_MEMORY, "no memory for measures");
    for (int64_t k = 0; k < all->count; k++)
        if (all->item[k].tolerance)
            add_all(all, &all->item[k].tolerance, true, count, list);
    for (int k = 0; by_importance(k); k++)
        add(all, by_importance(k)->name, count, list);
    for (int64_t k = 0; k < all->count; k++)
        add_all(all, &all->item[k].errors, false, count, list);
    RITZ_FAIL_IF(*count == 0, RITZ_ERR_ARGUMENT,
                 "no record has a relative error that could be drawn");
    *out = list;
    list = NULL;
done:
    free(list);
    return status;
}

bool records_matter(const records *all, const measure *m)
{
    for (int64_t k = 0; k < all->count; k++)
        if (record_error(&all->item[k], m->name) > RECORDS_ROUNDING)
            return true;
    return false;
}

bool records_cost(const records *all)
{
    bool any = false;

    for (int64_t k = 0; k < all->count; k++) {
        if (!all->item[k].errors)
            continue;
        if (!isfinite(all->item[k].cost))
            return false;
        any = true;
    }
    return any;
}

static int by_name(const void *a, const void *b)
{
    const char *const *x = a, *const *y = b;

    return strcmp(*x, *y);
}

ritz_status records_methods(const records *all, int64_t *count,
                            const char ***out, int64_t **which)
{
    ritz_status status = RITZ_OK;
    const char **name = calloc((size_t)all->count + 1, sizeof *name);
    int64_t *of = calloc((size_t)all->count + 1, sizeof *of);
    int64_t n = 0;

    RITZ_FAIL_IF(!name || !of, RITZ_ERR_MEMORY, "no memory for methods");
    for (int64_t k = 0; k < all->count; k++)
        name[k] = all->item[k].method;
    qsort(name, (size_t)all->count, sizeof *name, by_name);
    for (int64_t k = 0; k < all->count; k++)
        if (n == 0 || strcmp(name[n - 1], name[k]) != 0)
            name[n++] = name[k];
    for (int64_t k = 0; k < all->count; k++)
        while (strcmp(name[of[k]], all->item[k].method) != 0)
            of[k]++;
    *count = n;
    *out = name;
    *which = of;
    name = NULL;
    of = NULL;
done:
    free(name);
    free(of);
    return status;
}
