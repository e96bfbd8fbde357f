/* Which records, which measures and which methods a chart shows. */
#include "cli/records.h"

#include <ritz/verify.h>

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

/* Those of one subject that can be drawn, each once. */
static ritz_status select_records(const records *all, const char *subject,
                                  records *out)
{
    records some = {.item = calloc((size_t)all->count + 1, sizeof *some.item)};
    const record *first = NULL;

    out->item = some.item;
    RITZ_REFUSE_IF(!some.item, RITZ_ERR_MEMORY, "no memory for records");
    for (int64_t k = 0; k < all->count; k++) {
        const record *r = &all->item[k];

        if (!usable(r) || (subject && strcmp(r->subject, subject) != 0))
            continue;
        first = first ? first : r;
        RITZ_REFUSE_IF(!subject && strcmp(r->subject, first->subject) != 0,
                       RITZ_ERR_ARGUMENT,
                       "records of '%.60s' and of '%.60s' do not compare: "
                       "choose by --subject",
                       first->subject, r->subject);
        put_down(r, &some);
    }
    RITZ_REFUSE_IF(some.count == 0 && subject && *subject, RITZ_ERR_ARGUMENT,
                   "no record of '%.60s' has a method, an order and errors",
                   subject);
    RITZ_REFUSE_IF(some.count == 0, RITZ_ERR_ARGUMENT,
                   "no record has a method, an order and errors: those of "
                   "ritz-verify and ritz-fit do");
    out->count = some.count;
    return RITZ_OK;
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

static void add_measure(const char *name, record_set *s)
{
    measure *m = &s->measure[s->num_measures];

    for (int64_t k = 0; k < s->num_measures; k++)
        if (strcmp(s->measure[k].name, name) == 0)
            return;
    if (s->num_measures == RECORD_SET_MEASURES || !has(&s->all, name) ||
        strlen(name) >= RITZ_NAME_SIZE)
        return;
    snprintf(m->name, RITZ_NAME_SIZE, "%s", name);
    snprintf(m->title, RITZ_NAME_SIZE, "%s", title_of(name));
    m->tolerance = tolerance_of(&s->all, name);
    s->num_measures++;
}

/* Those known, in their order; then others, relative ones or all. */
static void add_measures(json_t *values, bool others, record_set *s)
{
    const char *name = NULL;
    json_t *value = NULL;

    for (int k = 0; by_importance(k); k++)
        if (json_object_get(values, by_importance(k)->name))
            add_measure(by_importance(k)->name, s);
    json_object_foreach(values, name, value)
    {
        const char *end = strrchr(name, '-');

        if (others || (end && strcmp(end, "-relative") == 0))
            add_measure(name, s);
    }
}

/* Measures with a tolerance first, then relative errors by importance. */
static ritz_status list_measures(record_set *s)
{
    for (int64_t k = 0; k < s->all.count; k++)
        add_measures(s->all.item[k].tolerance, true, s);
    for (int k = 0; by_importance(k); k++)
        add_measure(by_importance(k)->name, s);
    for (int64_t k = 0; k < s->all.count; k++)
        add_measures(s->all.item[k].errors, false, s);
    RITZ_REFUSE_IF(s->num_measures == 0, RITZ_ERR_ARGUMENT,
                   "no record has a relative error that could be drawn");
    return RITZ_OK;
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

/* Methods in order of their names, and of each record which it is. */
static ritz_status list_methods(record_set *s)
{
    const records *all = &s->all;
    int64_t n = 0;

    s->method = calloc((size_t)all->count + 1, sizeof *s->method);
    s->which = calloc((size_t)all->count + 1, sizeof *s->which);
    RITZ_REFUSE_IF(!s->method || !s->which, RITZ_ERR_MEMORY,
                   "no memory for methods");
    for (int64_t k = 0; k < all->count; k++)
        s->method[k] = all->item[k].method;
    qsort(s->method, (size_t)all->count, sizeof *s->method, by_name);
    for (int64_t k = 0; k < all->count; k++)
        if (n == 0 || strcmp(s->method[n - 1], s->method[k]) != 0)
            s->method[n++] = s->method[k];
    for (int64_t k = 0; k < all->count; k++)
        while (strcmp(s->method[s->which[k]], all->item[k].method) != 0)
            s->which[k]++;
    s->num_methods = n;
    return RITZ_OK;
}

ritz_status record_set_new(const records *all, const char *subject,
                           record_set *out)
{
    *out = (record_set){0};
    RITZ_CHECK(select_records(all, subject, &out->all));
    RITZ_CHECK(list_methods(out));
    return list_measures(out);
}

void record_set_free(record_set *s)
{
    free(s->all.item);
    free(s->method);
    free(s->which);
    *s = (record_set){0};
}
