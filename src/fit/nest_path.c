/*
 * What is told of a scene's columns once they are in order: the path of systems
 * with one column less each, and of every body its prefixes.
 */
#include "fit/nest_parts.h"

#include "base/alloc.h"

#include <ritz/monitor.h>
#include <ritz/nested.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A row of the path: the first columns of the order. */
static ritz_status add_row(const ritz_fit_nesting *n, int64_t count,
                           ritz_fit_path *path)
{
    ritz_status status = RITZ_OK;
    ritz_fit_candidate judged = {.binding = -1};
    ritz_fit_row *row = &path->row[path->count];

    ritz_monitor_step("errors of the path", path->count,
                      n->order.count - n->order.fixed);
    RITZ_NEW(row->first, n->f->num_bodies);
    path->count++;
    for (int64_t k = 0; k < n->f->num_bodies; k++)
        row->first[k] = ritz_fit_own(n, k, count, n->order.column);
    RITZ_TRY(ritz_fit_judge_cut(n, count, n->order.column, &judged));
    row->columns = count;
    row->order = judged.order;
    row->errors = judged.errors;
    judged.errors = (ritz_measures){0};
    row->excess = judged.excess;
    row->binding = judged.refusal[0] ? -1 : judged.binding;
    row->feasible = judged.feasible;
    memcpy(row->refusal, judged.refusal, sizeof row->refusal);
done:
    ritz_fit_candidate_free(&judged);
    return status;
}

/* The next cut below, and at last the smallest. */
static int64_t below(const ritz_fit_nesting *n, int64_t columns, int64_t least)
{
    if (columns == least)
        return least - 1;
    return columns - n->step > least ? columns - n->step : least;
}

ritz_status ritz_fit_walk(const ritz_fit_nesting *n, ritz_fit_path *out)
{
    ritz_status status = RITZ_OK;
    ritz_fit_path path = {.num_bodies = n->f->num_bodies};
    const int64_t least = n->order.fixed;

    RITZ_NEW(path.row, n->order.count - least + 1);
    for (int64_t count = n->order.count; count >= least;
         count = below(n, count, least))
        RITZ_TRY(add_row(n, count, &path));
    *out = path;
    path = (ritz_fit_path){0};
done:
    ritz_fit_path_free(&path);
    return status;
}

/* "system-response-relative" of a body of so many columns. */
static ritz_status note(const ritz_measures *errors, int64_t order,
                        ritz_reduced *body)
{
    char name[RITZ_NAME_SIZE];

    for (int64_t j = 0; j < errors->count; j++) {
        const ritz_measure *m = &errors->item[j];

        (void)snprintf(name, sizeof name, "system-%.50s", m->name);
        if (!isfinite(m->value))
            continue;
        RITZ_CHECK(ritz_nested_note(body, order, name, m->value));
        if (order == body->K.ncol)
            RITZ_CHECK(ritz_measures_add(&body->errors, name, m->value, nan(""),
                                         m->where)); /* no limit is its own */
    }
    return RITZ_OK;
}

/* A row of the path that cuts this body alone, to so many columns. */
static const ritz_fit_row *row_of(const ritz_fit_path *path, int64_t k,
                                  int64_t columns)
{
    for (int64_t t = 0; t < path->count; t++) {
        const ritz_fit_row *whole = &path->row[0];
        const ritz_fit_row *row = &path->row[t];
        const int64_t cut = whole->columns - row->columns;

        if (row->first[k] == columns && whole->first[k] - columns == cut)
            return row;
    }
    return NULL;
}

/* This body's first columns, with all of the others. */
static int64_t cut_alone(const ritz_fit_nesting *n, int64_t k, int64_t columns)
{
    int64_t count = 0, seen = 0;

    for (int64_t j = 0; j < n->order.count; j++) {
        const int64_t c = n->order.column[j];
        const bool own = c >= n->first[k] && c < n->first[k + 1];

        if (!own || seen++ < columns)
            n->some[count++] = c;
    }
    return count;
}

ritz_status ritz_fit_note(const ritz_fit_nesting *n, int64_t k,
                          const ritz_fit_path *path, ritz_reduced *body)
{
    ritz_status status = RITZ_OK;
    ritz_fit_candidate judged = {0};
    const int64_t least = body->nested.smallest;

    for (int64_t r = body->K.ncol; r >= least; r = below(n, r, least)) {
        const ritz_fit_row *row = row_of(path, k, r);

        ritz_monitor_step("errors of prefixes", n->first[k + 1] - r,
                          n->order.count);
        if (!row)
            RITZ_TRY(
                ritz_fit_judge_cut(n, cut_alone(n, k, r), n->some, &judged));
        RITZ_TRY(note(row ? &row->errors : &judged.errors, r, body));
        ritz_fit_candidate_free(&judged);
    }
done:
    ritz_fit_candidate_free(&judged);
    return status;
}

void ritz_fit_path_free(ritz_fit_path *path)
{
    for (int64_t k = 0; k < path->count; k++) {
        free(path->row[k].first);
        ritz_measures_free(&path->row[k].errors);
    }
    free(path->row);
    *path = (ritz_fit_path){0};
}
