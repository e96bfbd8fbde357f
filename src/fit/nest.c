/*
 * Columns of all flexible bodies in the order in which they matter. From the
 * whole model one at a time is left out, that without which the model, at the
 * listed configurations, is nearest to its tolerance; what is left out last
 * comes first. Every body so gets an order of its own, and all of them together
 * a path of models, each with one column less than the one before.
 */
#include "fit/nesting.h"

#include "base/alloc.h"
#include "base/team.h"
#include "linear/blas_threads.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Cuts of a component that fail one after the other, before the rest of its
   path is given up when columns are to be left out. */
enum { COMPONENT_PATIENCE = 2 };

/* --- the model of some columns -------------------------------------------- */

/* At all places, or at the listed ones on the grid if @p points is 0. */
static ritz_status measure_places(const ritz_nesting *n,
                                  const ritz_fit_joined *joined, int points,
                                  ritz_fit_candidate *out)
{
    ritz_fitter *f = n->f;
    const int64_t places = points ? f->num_places : f->num_listed;

    for (int64_t k = 0; k < places && !out->refusal[0]; k++)
        RITZ_CHECK(ritz_fit_measure_at(f, joined, &f->place[k],
                                       points | n->only, false, out));
    return RITZ_OK;
}

/* The model of some columns at all places, where candidates are confirmed. */
static ritz_status judge_columns(const ritz_nesting *n, int64_t count,
                                 const int64_t *column, ritz_fit_candidate *out)
{
    const ritz_reference *reference = n->f->place[0].reference;
    RITZ_OWN(ritz_fit_joined) joined = {0};
    ritz_status status = ritz_nesting_join(n, count, column, &joined);
    int points = ritz_fit_points(reference, &out->errors);

    if (status == RITZ_OK && !(points & RITZ_AT_OTHER_POLES)) {
        status = measure_places(n, &joined, 0, out);
        points = ritz_fit_points(reference, &out->errors);
        ritz_measures_free(&out->errors); /* poles only if there is need */
    }
    if (status == RITZ_OK)
        status = measure_places(n, &joined, points, out);
    RITZ_CHECK(ritz_fit_refuse(status, out));
    if (out->refusal[0])
        ritz_measures_free(&out->errors);
    return RITZ_OK;
}

/* --- the path ------------------------------------------------------------- */

/* A row of the path: the first columns of the order. */
static ritz_status begin_row(const ritz_nesting *n, int64_t count,
                             ritz_fit_candidate *row)
{
    RITZ_CHECK_NEW(row->modes, n->f->num_bodies);
    for (int64_t k = 0; k < n->f->num_bodies; k++)
        row->modes[k] = ritz_nesting_own(n, k, count, n->column, NULL);
    row->num_bodies = n->f->num_bodies;
    row->worst = -1;
    row->columns = count;
    return RITZ_OK;
}

/* Columns of the smallest model of the path. */
static int64_t find_least(const ritz_nesting *n)
{
    return n->fixed > 0 ? n->fixed : 1;
}

/* Rows of the path that are judged at once. */
typedef struct path_rows {
    const ritz_nesting *n; /* borrowed, as the rows are */
    ritz_fit_candidate *row;
    _Atomic bool failed; /* for lack of memory: others are the row's own */
} path_rows;

static void judge_row(int64_t k, void *task)
{
    path_rows *rows = task;
    ritz_fit_candidate *row = &rows->row[k];

    if (judge_columns(rows->n, row->columns, rows->n->column, row) != RITZ_OK)
        rows->failed = true;
    if (row->refusal[0])
        row->worst = -1;
}

/* The next cut below, and at last the smallest. */
static int64_t next_cut(const ritz_nesting *n, int64_t columns, int64_t least)
{
    if (columns == least)
        return least - 1;
    return columns - n->step > least ? columns - n->step : least;
}

/* Add some rows. @p count becomes that behind them. */
static ritz_status add_rows(const ritz_nesting *n, int threads, int64_t some,
                            int64_t *count, ritz_fit_path *path)
{
    const int64_t least = find_least(n);
    path_rows rows = {.n = n, .row = path->row + path->count};
    const int64_t before = path->count;

    ritz_monitor_step("errors of the path", before, n->count - n->fixed);
    for (; *count >= least && path->count < before + some;
         *count = next_cut(n, *count, least))
        RITZ_CHECK(begin_row(n, *count, &path->row[path->count++]));
    ritz_team_each(threads, path->count - before, judge_row, &rows);
    RITZ_REFUSE_IF(rows.failed, RITZ_ERR_MEMORY,
                   "no memory for the errors of the path");
    return RITZ_OK;
}

/* Whether a row is the last, as so many have failed one after the other. */
static bool ends_path(const ritz_fit_candidate *row, int64_t patience,
                      int64_t *failed)
{
    *failed = row->feasible ? 0 : *failed + 1;
    return *failed >= patience;
}

/* Cut after cut, until as many as @p patience fail one after the other. Rows
   that other threads have judged behind these are dropped. */
static ritz_status walk_path(const ritz_nesting *n, int64_t patience,
                             ritz_fit_path *path)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();
    const int64_t least = find_least(n);
    const int threads = ritz_nesting_threads(n, n->count - least + 1);
    const int64_t some =
        patience < n->count ? threads : ritz_team_shares(threads);
    int64_t failed = 0, kept = 0;
    bool ended = false;

    path->num_bodies = n->f->num_bodies;
    RITZ_CHECK_NEW(path->row, n->count + 1);
    for (int64_t count = n->count; count >= least && !ended;) {
        RITZ_CHECK(add_rows(n, threads, some, &count, path));
        while (kept < path->count && !ended)
            ended = ends_path(&path->row[kept++], patience, &failed);
    }
    while (path->count > kept)
        ritz_fit_candidate_free(&path->row[--path->count]);
    return RITZ_OK;
}

void ritz_fit_path_free(ritz_fit_path *path)
{
    RITZ_FREE_EACH(ritz_fit_candidate, path->count, path->row);
    *path = (ritz_fit_path){0};
}

/* --- nested bodies -------------------------------------------------------- */

/* Give a body of `order` columns "system-response-relative" of the scene, which
   has no limit for this body alone. */
static ritz_status note_errors(const ritz_nesting *n,
                               const ritz_measures *errors, int64_t order,
                               ritz_reduced *body)
{
    char name[RITZ_NAME_SIZE];

    for (int64_t j = 0; j < errors->count; j++) {
        const ritz_measure *m = &errors->item[j];

        (void)snprintf(name, sizeof name, "%s%.50s",
                       n->f->scene ? "system-" : "", m->name);
        if (!isfinite(m->value))
            continue;
        RITZ_CHECK(ritz_nested_note(body, order, name, m->value));
        if (n->f->scene && order == body->K.ncol)
            RITZ_CHECK(ritz_measures_add(&body->errors, name, m->value, nan(""),
                                         m->where));
    }
    return RITZ_OK;
}

/* The row of the path that cuts body k alone, to `columns`. */
static const ritz_fit_candidate *find_row(const ritz_fit_path *path, int64_t k,
                                          int64_t columns)
{
    for (int64_t t = 0; t < path->count; t++) {
        const ritz_fit_candidate *whole = &path->row[0], *row = &path->row[t];
        const int64_t cut = whole->columns - row->columns;

        if (row->modes[k] == columns && whole->modes[k] - columns == cut)
            return row;
    }
    return NULL;
}

/* This body's first columns, with all of the others, into `some`. */
static int64_t cut_alone(const ritz_nesting *n, int64_t k, int64_t columns)
{
    int64_t count = 0, passed = 0;

    for (int64_t j = 0; j < n->count; j++) {
        const int64_t c = n->column[j];
        const bool own = c >= n->first[k] && c < n->first[k + 1];

        if (!own || passed++ < columns)
            n->some[count++] = c;
    }
    return count;
}

/* Errors of the model into a nested body: of its prefixes, and of all. */
static ritz_status note_prefixes(const ritz_nesting *n, int64_t k,
                                 const ritz_fit_path *path, ritz_reduced *body)
{
    RITZ_OWN(ritz_fit_candidate) judged = {0};
    const int64_t least = body->nested.smallest;

    for (int64_t r = body->K.ncol; r >= least; r = next_cut(n, r, least)) {
        const ritz_fit_candidate *row = find_row(path, k, r);

        ritz_monitor_step("errors of prefixes", n->first[k + 1] - r, n->count);
        if (!row)
            RITZ_CHECK(judge_columns(n, cut_alone(n, k, r), n->some, &judged));
        RITZ_CHECK(
            note_errors(n, row ? &row->errors : &judged.errors, r, body));
        ritz_fit_candidate_free(&judged);
    }
    return RITZ_OK;
}

/* A body with its T and its own order of columns. */
static ritz_status nest_body(const ritz_nesting *n, int64_t k,
                             ritz_reduced *out)
{
    const int64_t fixed = ritz_nesting_own(n, k, n->fixed, n->column, NULL);
    const int64_t count = ritz_nesting_own(n, k, n->count, n->column, n->own);

    return ritz_reduced_nest(&n->whole.item[k], count, n->own,
                             fixed > 0 ? fixed : 1, out);
}

/* Flexible bodies of a candidate with all columns of their bases. */
static ritz_status make_uncut(ritz_fitter *f,
                              const ritz_fit_candidate *candidate,
                              ritz_bodies *out)
{
    RITZ_CHECK(ritz_bodies_new(f->num_bodies, out));
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_CHECK(ritz_fit_body(f, candidate->method, k, candidate->modes[k],
                                 &out->item[k]));
    return RITZ_OK;
}

/* The same from the bases that the search keeps, which is cheaper. Remarks and
   options of a body are those of its basis, which may have more modes. */
static ritz_status take_uncut(ritz_fitter *f,
                              const ritz_fit_candidate *candidate,
                              ritz_bodies *out)
{
    RITZ_CHECK(ritz_bodies_new(f->num_bodies, out));
    for (int64_t k = 0; k < f->num_bodies; k++) {
        RITZ_OWN(ritz_dense) parts = {0};

        RITZ_CHECK(ritz_fit_take(f, candidate->method, k, candidate->modes[k],
                                 true, &out->item[k], &parts));
    }
    return RITZ_OK;
}

/* The fewest columns in a feasible row of the path below its first row, which
   has all columns; 0: no such row is feasible. */
static ritz_status find_cut(ritz_nesting *n, int64_t *columns)
{
    RITZ_OWN(ritz_fit_path) path = {0};

    *columns = 0;
    n->only = RITZ_ONLY_LIMITED;
    RITZ_CHECK(
        walk_path(n, n->f->scene ? INT64_MAX : COMPONENT_PATIENCE, &path));
    for (int64_t t = 1; t < path.count; t++)
        if (path.row[t].feasible)
            *columns = path.row[t].columns;
    return RITZ_OK;
}

/* Cut the bodies of a candidate to the columns that matter most; not nested.
   @param[in]  proven   as for ritz_fit_make_bodies
   @param[in]  columns  of all bodies together; 0: as few as are feasible
   @param[out] found    how many there are; 0: no such cut, and no body */
static ritz_status cut_candidate(ritz_fitter *f,
                                 const ritz_fit_candidate *candidate,
                                 bool proven, int64_t columns, int64_t *found,
                                 ritz_bodies *out)
{
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = ritz_blas_single_new();
    RITZ_OWN(ritz_nesting) n = {0};

    *found = 0;
    RITZ_CHECK(proven ? make_uncut(f, candidate, &n.whole)
                      : take_uncut(f, candidate, &n.whole));
    RITZ_CHECK(ritz_nesting_order(f, candidate, &n));
    if (columns == 0)
        RITZ_CHECK(find_cut(&n, &columns));
    if (columns < n.fixed || columns < 1 || columns > n.count)
        return RITZ_OK;
    *found = columns;
    RITZ_CHECK(ritz_bodies_new(f->num_bodies, out));
    for (int64_t k = 0; k < f->num_bodies; k++) {
        const int64_t own = ritz_nesting_own(&n, k, columns, n.column, n.own);

        RITZ_CHECK(
            ritz_reduced_nest(&n.whole.item[k], own, n.own, 1, &out->item[k]));
        ritz_nested_free(&out->item[k].nested);
    }
    return RITZ_OK;
}

ritz_status ritz_fit_make_bodies(ritz_fitter *f,
                                 const ritz_fit_candidate *candidate,
                                 bool proven, ritz_bodies *out)
{
    int64_t found = 0;

    if (candidate->left_out == 0)
        return proven ? make_uncut(f, candidate, out)
                      : take_uncut(f, candidate, out);
    RITZ_CHECK(
        cut_candidate(f, candidate, proven, candidate->columns, &found, out));
    RITZ_REFUSE_IF(found == 0, RITZ_ERR_ARGUMENT,
                   "the candidate is none of this scene's: no cut of it has "
                   "%" PRId64 " columns",
                   candidate->columns);
    return RITZ_OK;
}

/* --- columns left out ----------------------------------------------------- */

/* Join cut bodies and measure them like any candidate; find the bounds of a
   scene that is feasible. */
static ritz_status measure_cut(ritz_fitter *f, ritz_fit_joined *cut,
                               ritz_fit_candidate *out)
{
    RITZ_CHECK(ritz_fit_join_own(f, cut));
    RITZ_CHECK(ritz_fit_measure(f, cut, out));
    return out->feasible && f->scene && f->place[0].estimator
               ? ritz_fit_bound_stage(f, &cut->stage, out)
               : RITZ_OK;
}

ritz_status ritz_fit_cost(ritz_fitter *f, ritz_fit_candidate *candidate)
{
    RITZ_OWN(ritz_fit_joined) joined = {0};

    if (candidate->cost.order > 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_fit_make_bodies(f, candidate, false, &joined.own));
    RITZ_CHECK(ritz_fit_join_own(f, &joined));
    return ritz_fit_take_cost(f, &joined.stage, candidate);
}

ritz_status ritz_fit_bound(ritz_fitter *f, ritz_fit_candidate *candidate)
{
    RITZ_OWN(ritz_fit_joined) joined = {0};

    if (!f->place[0].estimator)
        return RITZ_OK;
    if (f->scene) /* bounded already where columns are left out */
        return candidate->left_out > 0 ? RITZ_OK
                                       : ritz_fit_bound_joined(f, candidate);
    RITZ_CHECK(ritz_fit_make_bodies(f, candidate, false, &joined.own));
    RITZ_CHECK(ritz_fit_join_own(f, &joined));
    return ritz_fit_bound_stage(f, &joined.stage, candidate);
}

ritz_status ritz_fit_trim(ritz_fitter *f, const ritz_fit_candidate *from,
                          ritz_fit_candidate *out)
{
    RITZ_OWN(ritz_fit_candidate)
    less = {.method = from->method,
            .num_bodies = from->num_bodies,
            .worst = -1,
            .making = from->making};
    RITZ_OWN(ritz_fit_joined) cut = {0};

    RITZ_CHECK_COPY(less.modes, from->modes, f->num_bodies);
    RITZ_CHECK(cut_candidate(f, from, false, 0, &less.columns, &cut.own));
    if (less.columns == 0)
        return RITZ_OK;
    less.left_out = from->columns - less.columns;
    RITZ_CHECK(ritz_fit_refuse(measure_cut(f, &cut, &less), &less));
    if (less.feasible)
        RITZ_MOVE(*out, less);
    return RITZ_OK;
}

/* --- the answer ----------------------------------------------------------- */

/* The reduced component of a search that was stopped, not nested. */
static ritz_status make_plain(ritz_fitter *f,
                              const ritz_fit_candidate *candidate,
                              ritz_reduced *out)
{
    RITZ_OWN(ritz_bodies) body = {0};

    RITZ_CHECK(ritz_fit_make_bodies(f, candidate, false, &body));
    RITZ_CHECK(ritz_measures_copy(&candidate->errors, &body.item[0].errors));
    RITZ_MOVE(*out, body.item[0]);
    return RITZ_OK;
}

ritz_status ritz_fitter_reduced(ritz_fitter *f,
                                const ritz_fit_candidate *candidate,
                                ritz_reduced *out)
{
    [[maybe_unused]] RITZ_OWN(ritz_orders_lent) orders =
        ritz_orders_lend(f->orders);
    [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) spectra =
        ritz_spectra_lend(f->spectra);
    RITZ_OWN(ritz_nesting) n = {0};
    RITZ_OWN(ritz_fit_path) path = {0};
    RITZ_OWN(ritz_reduced) nested = {0};

    if (f->stopped)
        return make_plain(f, candidate, out);
    RITZ_CHECK(candidate->method->nested || candidate->method->narrow
                   ? make_uncut(f, candidate, &n.whole)
                   : take_uncut(f, candidate, &n.whole));
    RITZ_CHECK(ritz_nesting_order(f, candidate, &n));
    if (candidate->columns < n.count) /* the others are left out */
        n.count = candidate->columns;
    RITZ_CHECK(walk_path(&n, INT64_MAX, &path));
    RITZ_CHECK(nest_body(&n, 0, &nested));
    RITZ_CHECK(note_prefixes(&n, 0, &path, &nested));
    RITZ_CHECK(ritz_measures_copy(&candidate->errors, &nested.errors));
    RITZ_CHECK(ritz_measures_copy(&candidate->estimates, &nested.estimates));
    RITZ_MOVE(*out, nested);
    return RITZ_OK;
}

/* A copy of a body, what is noted of its prefixes included. */
static ritz_status copy_body(const ritz_reduced *from, ritz_reduced *out)
{
    RITZ_OWN_ARRAY int64_t *order = NULL;

    if (from->nested.smallest > 0)
        return ritz_reduced_prefix(from, from->K.ncol, out);
    RITZ_CHECK_NEW(order, from->K.ncol);
    for (int64_t k = 0; k < from->K.ncol; k++)
        order[k] = k;
    RITZ_CHECK(ritz_reduced_nest(from, from->K.ncol, order, from->K.ncol, out));
    ritz_nested_free(&out->nested);
    return RITZ_OK;
}

/* All components of a scene: those that stay copied, flexible ones nested. */
static ritz_status make_answer(ritz_fitter *f,
                               const ritz_fit_candidate *candidate,
                               ritz_reduced *body, ritz_fit_path *path)
{
    RITZ_OWN(ritz_nesting) n = {0};

    RITZ_CHECK(ritz_fit_make_bodies(f, candidate, !f->stopped, &n.whole));
    for (int64_t k = 0, j = 0; k < f->still.count; k++)
        if (j < f->num_bodies && f->body[j] == k)
            j++;
        else
            RITZ_CHECK(copy_body(&f->still.item[k], &body[k]));
    if (f->stopped) { /* not nested */
        for (int64_t k = 0; k < f->num_bodies; k++)
            RITZ_MOVE(body[f->body[k]], n.whole.item[k]);
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_nesting_order(f, candidate, &n));
    RITZ_CHECK(walk_path(&n, INT64_MAX, path));
    for (int64_t k = 0; k < f->num_bodies; k++) {
        RITZ_CHECK(nest_body(&n, k, &body[f->body[k]]));
        RITZ_CHECK(note_prefixes(&n, k, path, &body[f->body[k]]));
    }
    return RITZ_OK;
}

/* Each listed configuration with its errors; they are the first places. */
static ritz_status measure_system(ritz_fitter *f, ritz_system *system)
{
    for (int64_t k = 0; k < system->num_configurations; k++) {
        ritz_configuration *at = &system->configuration[k];

        ritz_measures_free(&at->errors);
        RITZ_CHECK(ritz_reference_measure(
            f->place[k].reference, ritz_model_of_configuration(at, NULL),
            &f->request.tolerance, RITZ_AT_OTHER_POLES | RITZ_AT_RANDOM,
            &at->errors));
    }
    return RITZ_OK;
}

ritz_status ritz_fitter_system(ritz_fitter *f,
                               const ritz_fit_candidate *candidate,
                               ritz_bodies *body, ritz_fit_path *path,
                               ritz_system *out)
{
    [[maybe_unused]] RITZ_OWN(ritz_orders_lent) orders =
        ritz_orders_lend(f->orders);
    [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) spectra =
        ritz_spectra_lend(f->spectra);
    RITZ_OWN(ritz_bodies) made = {0}, joined = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_system) system = {0};
    RITZ_OWN(ritz_fit_path) found = {0};

    RITZ_CHECK(ritz_bodies_new(f->still.count, &made));
    RITZ_CHECK(ritz_bodies_new(f->still.count, &joined));
    RITZ_CHECK(make_answer(f, candidate, made.item, &found));
    for (int64_t k = 0; k < made.count; k++)
        RITZ_CHECK(copy_body(&made.item[k], &joined.item[k]));
    RITZ_CHECK(ritz_stage_from(f->scene, joined.item, &stage));
    RITZ_CHECK(ritz_assemble(&stage, NULL, &system));
    RITZ_CHECK(measure_system(f, &system));
    RITZ_MOVE(*out, system);
    RITZ_MOVE(*body, made);
    RITZ_MOVE(*path, found);
    return RITZ_OK;
}
