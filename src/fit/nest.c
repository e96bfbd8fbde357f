/*
 * Columns of all flexible bodies in the order in which they matter. From the
 * whole model one at a time is left out, that without which the model, at the
 * listed configurations, is nearest to its tolerance; what is left out last
 * comes first. Every body so gets an order of its own, and all of them together
 * a path of models, each with one column less than the one before.
 */
#include "fit/fitter.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/blas_threads.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Entries of a component's T above which columns stay as they were made. */
static const int64_t most_entries = 4000000;
/* Cuts of a component that fail one after the other, before the rest of its
   path is given up when columns are to be left out. */
enum { COMPONENT_PATIENCE = 2 };
/* Columns that are tried at each step: those that matter least alone. */
enum { TRIED = 6 };

typedef struct nesting {
    ritz_fitter *f;
    ritz_bodies whole;    /* flexible bodies with all their columns */
    ritz_dense parts;     /* of a component: Phi'M T of all columns */
    int64_t *first;       /* num_bodies + 1: its first column of all */
    int64_t count, fixed; /* columns; those that must stay, first */
    int64_t *column;      /* count, what matters most first */
    double *alone;        /* of each column: the ratio without it */
    int64_t *own, *some;  /* to work in: columns of one body, and of all */
    int64_t every;        /* of listed places the first, and each every-th */
    int64_t step;         /* columns between two cuts that are measured */
    int64_t hardest;      /* the place where the last model was worst */
    int only;             /* RITZ_ONLY_LIMITED: only those errors of cuts are
                             measured that have a limit; 0: all errors */
} nesting;

static void nesting_free(nesting *n)
{
    ritz_bodies_free(&n->whole);
    ritz_dense_free(&n->parts);
    RITZ_FREE(n->first, n->column, n->alone, n->own, n->some);
}

/* --- the model of some columns -------------------------------------------- */

/* The columns of body k among some, as the body numbers them, into `own`. */
static int64_t take_own(const nesting *n, int64_t k, int64_t count,
                        const int64_t *column)
{
    int64_t found = 0;

    for (int64_t j = 0; j < count; j++)
        if (column[j] >= n->first[k] && column[j] < n->first[k + 1])
            n->own[found++] = column[j] - n->first[k];
    return found;
}

/* The model of some columns. It needs no invariants and no T: shapes of a
   component are compared by `parts`. */
static ritz_status join_columns(const nesting *n, int64_t count,
                                const int64_t *column, ritz_fit_joined *out)
{
    RITZ_CHECK(ritz_bodies_new(n->f->num_bodies, &out->own));
    for (int64_t k = 0; k < n->f->num_bodies; k++) {
        ritz_reduced bare = n->whole.item[k]; /* borrowed */

        bare.T = (ritz_dense){0};
        bare.invariants = (ritz_invariants){0};
        RITZ_CHECK(ritz_reduced_nest(&bare, take_own(n, k, count, column),
                                     n->own, 1, &out->own.item[k]));
    }
    if (!n->f->scene)
        RITZ_CHECK(ritz_dense_pick(&n->parts, count, column, &out->parts));
    return ritz_fit_join_own(n->f, out);
}

/*
 * Worst error over tolerance of the model of some columns, on the grid of the
 * listed places. It begins where the last model was worst: a ratio of `most` or
 * more is not measured at the other places.
 */
static ritz_status measure_ratio(nesting *n, int64_t count,
                                 const int64_t *column, double most,
                                 double *out)
{
    const int64_t places = (n->f->num_listed + n->every - 1) / n->every;
    const int64_t from = n->hardest;
    RITZ_OWN(ritz_fit_candidate) judged = {0};
    RITZ_OWN(ritz_fit_joined) joined = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(ritz_fit_go_on(n->f));
    status = join_columns(n, count, column, &joined);
    for (int64_t t = 0;
         status == RITZ_OK && t < places && (t == 0 || judged.ratio < most);
         t++) {
        const int64_t k = (from + t) % places;
        const double before = judged.ratio;

        status = ritz_fit_measure_at(n->f, &joined, &n->f->place[k * n->every],
                                     RITZ_ONLY_LIMITED, false, &judged);
        if (status == RITZ_OK && judged.ratio > before)
            n->hardest = k;
    }
    RITZ_CHECK(ritz_fit_refuse(status, &judged));
    *out = judged.ratio;
    return RITZ_OK;
}

/* At all places, or at the listed ones on the grid if @p points is 0. */
static ritz_status measure_places(const nesting *n,
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
static ritz_status judge_columns(const nesting *n, int64_t count,
                                 const int64_t *column, ritz_fit_candidate *out)
{
    const ritz_reference *reference = n->f->place[0].reference;
    RITZ_OWN(ritz_fit_joined) joined = {0};
    ritz_status status = join_columns(n, count, column, &joined);
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

/* --- the order ------------------------------------------------------------ */

/* ceil(count / most) = k: one in k is measured; 1 if `most` is no limit. */
static int64_t divide_work(int64_t count, int64_t most)
{
    return count > most && most > 0 ? (count + most - 1) / most : 1;
}

/*
 * Columns as they were made, but those that must stay first. Where columns or
 * places are many, some of them speak for all: of c columns that may go, c
 * models alone and some 2 c cuts are measured at places.
 */
static ritz_status begin_nesting(ritz_fitter *f, nesting *n)
{
    RITZ_OWN_ARRAY ritz_column_kind *kind = NULL;
    const int64_t most = f->request.most_measured;

    n->f = f;
    RITZ_CHECK_NEW(n->first, f->num_bodies + 1);
    for (int64_t k = 0; k < f->num_bodies; k++)
        n->first[k + 1] = n->count += n->whole.item[k].K.ncol;
    RITZ_CHECK_NEW(n->column, n->count);
    RITZ_CHECK_NEW(n->alone, n->count);
    RITZ_CHECK_NEW(n->own, n->count);
    RITZ_CHECK_NEW(n->some, n->count);
    RITZ_CHECK_NEW(kind, n->count);
    if (!f->scene)
        RITZ_CHECK(ritz_reference_parts(f->place[0].reference,
                                        &n->whole.item[0].T, &n->parts));
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_CHECK(ritz_fit_kinds(&n->whole.item[k], kind + n->first[k]));
    for (int64_t k = 0; k < n->count; k++)
        if (ritz_fit_stays(kind[k]))
            n->column[n->fixed++] = k;
    for (int64_t k = 0, at = n->fixed; k < n->count; k++)
        if (!ritz_fit_stays(kind[k]))
            n->column[at++] = k;
    n->every = divide_work((n->count - n->fixed) * f->num_listed, most);
    n->step = divide_work(2 * (n->count - n->fixed) * f->num_places, most);
    return RITZ_OK;
}

/* The ratio without one of the first `left` columns of the order. */
static ritz_status measure_without(nesting *n, int64_t left, int64_t which,
                                   double most, double *out)
{
    memcpy(n->some, n->column, (size_t)left * sizeof *n->some);
    memmove(n->some + which, n->some + which + 1,
            (size_t)(left - which - 1) * sizeof *n->some);
    return measure_ratio(n, left - 1, n->some, most, out);
}

/* Move a column of the order to another place in it, the others moving up. */
static void move_column(nesting *n, int64_t from, int64_t to)
{
    const int64_t here = n->column[from];
    const int64_t step = from < to ? 1 : -1;

    for (int64_t k = from; k != to; k += step)
        n->column[k] = n->column[k + step];
    n->column[to] = here;
}

/* Sort the columns that may go by the ratio of the model without each alone. */
static ritz_status order_alone(nesting *n)
{
    for (int64_t k = n->fixed; k < n->count && n->count > 1; k++) {
        ritz_monitor_step("columns alone", k, n->count);
        RITZ_CHECK(
            measure_without(n, n->count, k, HUGE_VAL, &n->alone[n->column[k]]));
    }
    for (int64_t k = n->fixed + 1; k < n->count; k++) {
        int64_t at = k;

        while (at > n->fixed &&
               n->alone[n->column[k]] > n->alone[n->column[at - 1]])
            at--;
        move_column(n, k, at);
    }
    return RITZ_OK;
}

/* A body without columns that must stay keeps the one that matters most
   alone. */
static void keep_one_each(nesting *n)
{
    for (int64_t k = 0; k < n->f->num_bodies; k++) {
        int64_t at = n->fixed;

        if (take_own(n, k, n->fixed, n->column) > 0)
            continue;
        while (n->column[at] < n->first[k] || n->column[at] >= n->first[k + 1])
            at++;
        move_column(n, at, n->fixed++);
    }
}

/* Move one of the last few columns to the end: that which is missed least. */
static ritz_status drop_column(nesting *n, int64_t left)
{
    double least = HUGE_VAL;
    int64_t worst = left - 1;

    for (int64_t t = 0; t < TRIED && left - 1 - t >= n->fixed; t++) {
        double ratio = 0.0;

        RITZ_CHECK(measure_without(n, left, left - 1 - t, least, &ratio));
        if (ratio < least) {
            least = ratio;
            worst = left - 1 - t;
        }
    }
    move_column(n, worst, left - 1);
    return RITZ_OK;
}

/* Put the columns of all bodies in order, those that matter most first. If a
   component is too large for that, they stay as they were made. */
static ritz_status find_order(ritz_fitter *f, nesting *n)
{
    if (!f->scene && n->whole.item[0].T.nrow * n->count > most_entries)
        return RITZ_OK;
    RITZ_CHECK(order_alone(n));
    if (f->scene)
        keep_one_each(n);
    /* the one that matters least alone is the first to go */
    for (int64_t left = n->count - 1; left > n->fixed + 1; left--) {
        ritz_monitor_step("columns in order", n->count - left, n->count);
        RITZ_CHECK(drop_column(n, left));
    }
    return RITZ_OK;
}

/* The same for the bodies of a candidate before columns are left out: by the
   order that was kept, or by a new one that is kept from now on. */
static ritz_status order_columns(ritz_fitter *f, const ritz_fit_candidate *of,
                                 nesting *n)
{
    const ritz_fit_ordered *known = NULL;

    RITZ_CHECK(begin_nesting(f, n));
    known = ritz_fit_ordered_find(f, of, n->count);
    if (!known) {
        RITZ_CHECK(find_order(f, n));
        return ritz_fit_ordered_keep(f, of,
                                     &(ritz_fit_ordered){.count = n->count,
                                                         .fixed = n->fixed,
                                                         .column = n->column});
    }
    n->fixed = known->fixed;
    memcpy(n->column, known->column, (size_t)n->count * sizeof *n->column);
    return RITZ_OK;
}

/* --- the path ------------------------------------------------------------- */

/* A row of the path: the first columns of the order. */
static ritz_status add_row(const nesting *n, int64_t count, ritz_fit_path *path)
{
    ritz_fit_candidate *row = &path->row[path->count];

    ritz_monitor_step("errors of the path", path->count, n->count - n->fixed);
    RITZ_CHECK_NEW(row->modes, n->f->num_bodies);
    path->count++;
    for (int64_t k = 0; k < n->f->num_bodies; k++)
        row->modes[k] = take_own(n, k, count, n->column);
    row->num_bodies = n->f->num_bodies;
    row->worst = -1;
    row->columns = count;
    RITZ_CHECK(judge_columns(n, count, n->column, row));
    if (row->refusal[0])
        row->worst = -1;
    return RITZ_OK;
}

/* The next cut below, and at last the smallest. */
static int64_t next_cut(const nesting *n, int64_t columns, int64_t least)
{
    if (columns == least)
        return least - 1;
    return columns - n->step > least ? columns - n->step : least;
}

/* Cut after cut, until as many as @p patience fail one after the other. */
static ritz_status walk_path(const nesting *n, int64_t patience,
                             ritz_fit_path *path)
{
    const int64_t least = n->fixed > 0 ? n->fixed : 1;
    int64_t failed = 0;

    path->num_bodies = n->f->num_bodies;
    RITZ_CHECK_NEW(path->row, n->count + 1);
    for (int64_t count = n->count; count >= least && failed < patience;
         count = next_cut(n, count, least)) {
        RITZ_CHECK(add_row(n, count, path));
        failed = path->row[path->count - 1].feasible ? 0 : failed + 1;
    }
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
static ritz_status note_errors(const nesting *n, const ritz_measures *errors,
                               int64_t order, ritz_reduced *body)
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
static int64_t cut_alone(const nesting *n, int64_t k, int64_t columns)
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
static ritz_status note_prefixes(const nesting *n, int64_t k,
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
static ritz_status nest_body(const nesting *n, int64_t k, ritz_reduced *out)
{
    const int64_t fixed = take_own(n, k, n->fixed, n->column);
    const int64_t count = take_own(n, k, n->count, n->column);

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
static ritz_status find_cut(nesting *n, int64_t *columns)
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
    RITZ_OWN(nesting) n = {0};

    *found = 0;
    RITZ_CHECK(proven ? make_uncut(f, candidate, &n.whole)
                      : take_uncut(f, candidate, &n.whole));
    RITZ_CHECK(order_columns(f, candidate, &n));
    if (columns == 0)
        RITZ_CHECK(find_cut(&n, &columns));
    if (columns < n.fixed || columns < 1 || columns > n.count)
        return RITZ_OK;
    *found = columns;
    RITZ_CHECK(ritz_bodies_new(f->num_bodies, out));
    for (int64_t k = 0; k < f->num_bodies; k++) {
        const int64_t own = take_own(&n, k, columns, n.column);

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
    RITZ_OWN(nesting) n = {0};
    RITZ_OWN(ritz_fit_path) path = {0};
    RITZ_OWN(ritz_reduced) nested = {0};

    if (f->stopped)
        return make_plain(f, candidate, out);
    RITZ_CHECK(candidate->method->nested || candidate->method->narrow
                   ? make_uncut(f, candidate, &n.whole)
                   : take_uncut(f, candidate, &n.whole));
    RITZ_CHECK(order_columns(f, candidate, &n));
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
    RITZ_OWN(nesting) n = {0};

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
    RITZ_CHECK(order_columns(f, candidate, &n));
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
