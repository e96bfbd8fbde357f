/*
 * Columns of all flexible bodies in one order. From the whole model one at a
 * time is left out, that without which the model, at the listed configurations,
 * is nearest to its tolerance: so every body has an order of its own, and all of
 * them together a path of models, each with one column less than the one before.
 */
#include "fit/fitter.h"
#include "fit/order.h"

#include "base/alloc.h"

#include <ritz/assembly.h>
#include <ritz/base.h>
#include <ritz/model.h>

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

typedef struct nesting {
    ritz_fitter *f;
    const ritz_reduced *whole; /* of each flexible body */
    int64_t *first;            /* num_bodies + 1: its first column of all */
    int64_t *own;              /* to work in: columns of one body */
    int64_t *some;             /* to work in: columns of all */
    int64_t every;   /* only every so manieth listed place decides the order */
    int64_t step;    /* columns between two cuts that are measured */
    int64_t hardest; /* of those places: where the last was farthest off */
    ritz_fit_order order;
} nesting;

/* Of some columns those of body k, as it numbers them, into `own`. */
static int64_t take_own(const nesting *n, int64_t k, int64_t count,
                        const int64_t *column)
{
    int64_t found = 0;

    for (int64_t j = 0; j < count; j++)
        if (column[j] >= n->first[k] && column[j] < n->first[k + 1])
            n->own[found++] = column[j] - n->first[k];
    return found;
}

/* Those columns of a body. Invariants do not matter here, nor does T unless MAC
   is of shapes. */
static ritz_status cut_body(const nesting *n, int64_t k, int64_t count,
                            const int64_t *column, ritz_reduced *out)
{
    ritz_reduced bare = n->whole[k]; /* borrowed */

    if (n->f->scene)
        bare.T = (ritz_dense){0};
    bare.invariants = (ritz_invariants){0};
    return ritz_reduced_nest(&bare, take_own(n, k, count, column), n->own, 1,
                             out);
}

/* Those columns joined. */
static ritz_status join_columns(const nesting *n, int64_t count,
                                const int64_t *column, ritz_stage *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *body = NULL;

    RITZ_NEW(body, n->f->num_bodies);
    for (int64_t k = 0; k < n->f->num_bodies; k++)
        RITZ_TRY(cut_body(n, k, count, column, &body[k]));
    RITZ_TRY(ritz_fit_join(n->f, body, out));
done:
    for (int64_t k = 0; body && k < n->f->num_bodies; k++)
        ritz_reduced_free(&body[k]);
    free(body);
    return status;
}

/*
 * How far the model of some columns is off at listed places, on the grid. It
 * begins where the one before was farthest off: what is as far off there as
 * `most` is not measured elsewhere.
 */
static ritz_status take_ratio(void *context, int64_t count,
                              const int64_t *column, double most, double *out)
{
    ritz_status status = RITZ_OK;
    nesting *n = context;
    const int64_t listed = n->f->scene ? n->f->scene->num_configurations : 1;
    const int64_t places = (listed + n->every - 1) / n->every;
    const int64_t from = n->hardest;
    ritz_fit_candidate judged = {0};
    ritz_stage stage = {0};

    RITZ_TRY(join_columns(n, count, column, &stage));
    for (int64_t t = 0; t < places && (t == 0 || judged.ratio < most); t++) {
        const int64_t k = (from + t) % places;
        const double before = judged.ratio;

        RITZ_TRY(ritz_fit_measure_at(n->f, &stage, &n->f->place[k * n->every],
                                     0, &judged));
        if (judged.ratio > before)
            n->hardest = k;
    }
done:
    status = ritz_fit_refuse(status, &judged);
    *out = judged.ratio;
    ritz_fit_part(n->f, &stage, NULL);
    ritz_fit_candidate_free(&judged);
    return status;
}

/* ceil(count / most): of so many one is measured; 1 if there is no end. */
static int64_t share_of(int64_t count, int64_t most)
{
    return count > most && most > 0 ? (count + most - 1) / most : 1;
}

/* Where columns or places are many, some of them speak for all: of c columns
   that may go, c models alone and some 2 c cuts are measured at places. */
static void limit_work(nesting *n)
{
    const int64_t most = n->f->request.most_measured;
    const int64_t may_go = n->order.count - n->order.fixed;
    const int64_t listed = n->f->scene ? n->f->scene->num_configurations : 1;

    n->every = share_of(may_go * listed, most);
    n->step = share_of(2 * may_go * n->f->num_places, most);
}

static ritz_status begin_nesting(ritz_fitter *f, const ritz_reduced *whole,
                                 nesting *n)
{
    RITZ_OWN_ARRAY ritz_column_kind *kind = NULL;
    int64_t all = 0;

    *n = (nesting){.f = f, .whole = whole, .every = 1, .step = 1};
    RITZ_CHECK_NEW(n->first, f->num_bodies + 1);
    for (int64_t k = 0; k < f->num_bodies; k++) {
        n->first[k] = all;
        all += whole[k].K.ncol;
    }
    n->first[f->num_bodies] = all;
    RITZ_CHECK_NEW(n->own, all);
    RITZ_CHECK_NEW(n->some, all);
    RITZ_CHECK_NEW(kind, all);
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_CHECK(ritz_fit_kinds(&whole[k], kind + n->first[k]));
    RITZ_CHECK(ritz_fit_order_new(all, kind, take_ratio, n, &n->order));
    limit_work(n);
    return RITZ_OK;
}

static void free_nesting(nesting *n)
{
    ritz_fit_order_free(&n->order);
    free(n->first);
    free(n->own);
    free(n->some);
}

/* Of a body without columns that must stay the one that matters most alone
   does. */
static void keep_one_each(nesting *n)
{
    ritz_fit_order *o = &n->order;

    for (int64_t k = 0; k < n->f->num_bodies; k++) {
        int64_t at = o->fixed;
        int64_t here = 0;

        if (take_own(n, k, o->fixed, o->column) > 0)
            continue;
        while (o->column[at] < n->first[k] || o->column[at] >= n->first[k + 1])
            at++;
        here = o->column[at];
        memmove(o->column + o->fixed + 1, o->column + o->fixed,
                (size_t)(at - o->fixed) * sizeof *o->column);
        o->column[o->fixed++] = here;
    }
}

static ritz_status order_columns(ritz_fitter *f, const ritz_reduced *whole,
                                 nesting *n)
{
    RITZ_CHECK(begin_nesting(f, whole, n));
    if (!f->scene && whole->T.nrow * n->order.count > most_entries)
        return RITZ_OK;
    RITZ_CHECK(ritz_fit_order_alone(&n->order));
    if (f->scene)
        keep_one_each(n);
    return ritz_fit_order_drop(&n->order);
}

/* --- the path -------------------------------------------------------------------- */

/* The model of some columns at places, of which the listed ones are first. */
static ritz_status measure_columns(const nesting *n, int64_t count,
                                   const int64_t *column, int points,
                                   ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    const int64_t listed = n->f->scene ? n->f->scene->num_configurations : 1;
    const int64_t places = points ? n->f->num_places : listed;
    ritz_stage stage = {0};

    RITZ_TRY(join_columns(n, count, column, &stage));
    for (int64_t k = 0; k < places && out->refusal[0] == '\0'; k++)
        RITZ_TRY(
            ritz_fit_measure_at(n->f, &stage, &n->f->place[k], points, out));
done:
    ritz_fit_part(n->f, &stage, NULL);
    return ritz_fit_refuse(status, out);
}

/* The model of some columns at all places, where candidates are confirmed. */
static ritz_status judge_columns(const nesting *n, int64_t count,
                                 const int64_t *column, ritz_fit_candidate *out)
{
    const ritz_reference *reference = n->f->place[0].reference;
    int points = ritz_fit_points(reference, &out->errors);

    if (!(points & RITZ_AT_OTHER_POLES)) { /* unless there is need of them */
        RITZ_CHECK(measure_columns(n, count, column, 0, out));
        points = ritz_fit_points(reference, &out->errors);
        ritz_measures_free(&out->errors);
    }
    if (out->refusal[0] == '\0')
        RITZ_CHECK(measure_columns(n, count, column, points, out));
    if (out->refusal[0])
        ritz_measures_free(&out->errors);
    return RITZ_OK;
}

/* A row of the path: the first columns of the order. */
static ritz_status add_row(const nesting *n, int64_t count, ritz_fit_path *path)
{
    RITZ_OWN(ritz_fit_candidate) judged = {.worst = -1};
    ritz_fit_row *row = &path->row[path->count];

    ritz_monitor_step("errors of the path", path->count,
                      n->order.count - n->order.fixed);
    RITZ_CHECK_NEW(row->first, n->f->num_bodies);
    path->count++;
    for (int64_t k = 0; k < n->f->num_bodies; k++)
        row->first[k] = take_own(n, k, count, n->order.column);
    RITZ_CHECK(judge_columns(n, count, n->order.column, &judged));
    row->columns = count;
    row->order = judged.order;
    row->errors = judged.errors;
    judged.errors = (ritz_measures){0};
    row->ratio = judged.ratio;
    row->worst = judged.refusal[0] ? -1 : judged.worst;
    row->feasible = judged.feasible;
    memcpy(row->refusal, judged.refusal, sizeof row->refusal);
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
                             ritz_fit_path *out)
{
    RITZ_OWN(ritz_fit_path) path = {.num_bodies = n->f->num_bodies};
    const int64_t least = n->order.fixed > 0 ? n->order.fixed : 1;
    int64_t failed = 0;

    RITZ_CHECK_NEW(path.row, n->order.count + 1);
    for (int64_t count = n->order.count; count >= least && failed < patience;
         count = next_cut(n, count, least)) {
        RITZ_CHECK(add_row(n, count, &path));
        failed = path.row[path.count - 1].feasible ? 0 : failed + 1;
    }
    RITZ_MOVE(*out, path);
    return RITZ_OK;
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

/* --- nested bodies --------------------------------------------------------------- */

/* "system-response-relative" of a scene's body of so many columns; no limit is
   its own. */
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

/* A row of the path that cuts this body alone, to so many columns. */
static const ritz_fit_row *find_row(const ritz_fit_path *path, int64_t k,
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
static int64_t cut_alone(const nesting *n, int64_t k, int64_t columns)
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

/* Errors of the model into a nested body: of its prefixes, and of all. */
static ritz_status note_prefixes(const nesting *n, int64_t k,
                                 const ritz_fit_path *path, ritz_reduced *body)
{
    RITZ_OWN(ritz_fit_candidate) judged = {0};
    const int64_t least = body->nested.smallest;

    for (int64_t r = body->K.ncol; r >= least; r = next_cut(n, r, least)) {
        const ritz_fit_row *row = find_row(path, k, r);

        ritz_monitor_step("errors of prefixes", n->first[k + 1] - r,
                          n->order.count);
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
    const ritz_fit_order *o = &n->order;
    const int64_t fixed = take_own(n, k, o->fixed, o->column);
    const int64_t count = take_own(n, k, o->count, o->column);

    return ritz_reduced_nest(&n->whole[k], count, n->own, fixed > 0 ? fixed : 1,
                             out);
}

/* Room for flexible bodies as they are, and nested. */
typedef struct nested_bodies {
    ritz_reduced *whole, *body; /* num_bodies each */
    ritz_fit_path path;
} nested_bodies;

static void free_bodies(int64_t count, ritz_reduced **body)
{
    for (int64_t k = 0; *body && k < count; k++)
        ritz_reduced_free(&(*body)[k]);
    free(*body);
    *body = NULL;
}

static void free_nested(const ritz_fitter *f, nested_bodies *b)
{
    free_bodies(f->num_bodies, &b->whole);
    free_bodies(f->num_bodies, &b->body);
    ritz_fit_path_free(&b->path);
}

/* All columns of a candidate's uncut bodies in order, and the path of cuts. */
static ritz_status nest_uncut(ritz_fitter *f,
                              const ritz_fit_candidate *candidate,
                              nested_bodies *b)
{
    ritz_status status = RITZ_OK;
    nesting n = {0};

    RITZ_NEW(b->whole, f->num_bodies);
    RITZ_NEW(b->body, f->num_bodies);
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_TRY(ritz_fit_body(f, candidate->method, k, candidate->modes[k],
                               &b->whole[k]));
    RITZ_TRY(order_columns(f, b->whole, &n));
    RITZ_TRY(
        walk_path(&n, f->scene ? INT64_MAX : COMPONENT_PATIENCE, &b->path));
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_TRY(nest_body(&n, k, &b->body[k]));
done:
    free_nesting(&n);
    return status;
}

/* Bodies as a row of the path cuts them, no longer nested. */
static ritz_status cut_bodies(const ritz_fitter *f, const ritz_fit_row *row,
                              const ritz_reduced *nested, ritz_reduced *out)
{
    for (int64_t k = 0; k < f->num_bodies; k++) {
        RITZ_CHECK(ritz_reduced_prefix(&nested[k], row->first[k], &out[k]));
        ritz_nested_free(&out[k].nested);
    }
    return RITZ_OK;
}

ritz_status ritz_fit_make_bodies(ritz_fitter *f,
                                 const ritz_fit_candidate *candidate,
                                 ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    const ritz_fit_row *row = NULL;
    nested_bodies b = {0};

    if (candidate->left_out == 0) {
        for (int64_t k = 0; k < f->num_bodies; k++)
            RITZ_TRY(ritz_fit_body(f, candidate->method, k, candidate->modes[k],
                                   &out[k]));
        return RITZ_OK;
    }
    RITZ_TRY(nest_uncut(f, candidate, &b));
    for (int64_t t = 0; t < b.path.count; t++)
        if (b.path.row[t].columns == candidate->columns)
            row = &b.path.row[t];
    RITZ_FAIL_IF(!row, RITZ_ERR_ARGUMENT,
                 "the candidate is none of this scene's: no cut of it has "
                 "%" PRId64 " columns",
                 candidate->columns);
    RITZ_TRY(cut_bodies(f, row, b.body, out));
done:
    free_nested(f, &b);
    return status;
}

/* --- columns left out -------------------------------------------------------------- */

/* Cut bodies joined, measured like any other candidate, and bounded. */
static ritz_status measure_cut(ritz_fitter *f, ritz_reduced *part,
                               ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    ritz_stage stage = {0};

    RITZ_TRY(ritz_fit_join(f, part, &stage));
    RITZ_TRY(ritz_fit_measure(f, &stage, out));
    if (out->feasible && f->scene && f->place[0].estimator)
        RITZ_TRY(ritz_fit_bound_stage(f, &stage, out));
done:
    ritz_fit_part(f, &stage, NULL);
    return ritz_fit_refuse(status, out);
}

ritz_status ritz_fit_trim(ritz_fitter *f, const ritz_fit_candidate *from,
                          ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    ritz_fit_candidate less = {.method = from->method,
                               .num_bodies = from->num_bodies,
                               .worst = -1,
                               .making = from->making};
    const ritz_fit_row *row = NULL;
    ritz_reduced *part = NULL;
    nested_bodies b = {0};

    RITZ_NEW(part, f->num_bodies);
    RITZ_NEW(less.modes, f->num_bodies);
    memcpy(less.modes, from->modes, (size_t)f->num_bodies * sizeof *less.modes);
    RITZ_TRY(nest_uncut(f, from, &b));
    for (int64_t t = 1; t < b.path.count; t++)
        if (b.path.row[t].feasible)
            row = &b.path.row[t];
    if (!row)
        goto done;
    RITZ_TRY(cut_bodies(f, row, b.body, part));
    less.columns = row->columns;
    less.left_out = from->columns - row->columns;
    RITZ_TRY(measure_cut(f, part, &less));
    if (less.feasible) {
        RITZ_MOVE(*out, less);
    }
done:
    free_bodies(f->num_bodies, &part);
    free_nested(f, &b);
    ritz_fit_candidate_free(&less);
    return status;
}

/* --- the answer --------------------------------------------------------------------- */

ritz_status ritz_fitter_reduced(ritz_fitter *f,
                                const ritz_fit_candidate *candidate,
                                ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced whole = {0}, nested = {0};
    ritz_fit_path path = {0};
    nesting n = {0};

    RITZ_TRY(
        ritz_fit_body(f, candidate->method, 0, candidate->modes[0], &whole));
    RITZ_TRY(order_columns(f, &whole, &n));
    if (candidate->columns < n.order.count) /* the others are left out */
        n.order.count = candidate->columns;
    RITZ_TRY(walk_path(&n, INT64_MAX, &path));
    RITZ_TRY(nest_body(&n, 0, &nested));
    RITZ_TRY(note_prefixes(&n, 0, &path, &nested));
    RITZ_TRY(ritz_measures_copy(&candidate->errors, &nested.errors));
    RITZ_TRY(ritz_measures_copy(&candidate->estimates, &nested.estimates));
    RITZ_MOVE(*out, nested);
done:
    ritz_reduced_free(&whole);
    ritz_reduced_free(&nested);
    ritz_fit_path_free(&path);
    free_nesting(&n);
    return status;
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
    ritz_status status = RITZ_OK;
    ritz_reduced *whole = NULL;
    nesting n = {0};

    RITZ_NEW(whole, f->num_bodies);
    RITZ_TRY(ritz_fit_make_bodies(f, candidate, whole));
    for (int64_t k = 0, j = 0; k < f->num_components; k++)
        if (j < f->num_bodies && f->body[j] == k)
            j++;
        else
            RITZ_TRY(copy_body(&f->still[k], &body[k]));
    RITZ_TRY(order_columns(f, whole, &n));
    RITZ_TRY(walk_path(&n, INT64_MAX, path));
    for (int64_t k = 0; k < f->num_bodies; k++) {
        RITZ_TRY(nest_body(&n, k, &body[f->body[k]]));
        RITZ_TRY(note_prefixes(&n, k, path, &body[f->body[k]]));
    }
done:
    free_bodies(f->num_bodies, &whole);
    free_nesting(&n);
    return status;
}

/* Each listed configuration with its errors; they are the first places. */
static ritz_status measure_system(ritz_fitter *f, ritz_system *system)
{
    for (int64_t k = 0; k < system->num_configurations; k++) {
        ritz_configuration *at = &system->configuration[k];

        ritz_measures_free(&at->errors);
        RITZ_CHECK(ritz_reference_measure_at(
            f->place[k].reference, at, &f->request.tolerance,
            RITZ_AT_OTHER_POLES | RITZ_AT_RANDOM, &at->errors));
    }
    return RITZ_OK;
}

ritz_status ritz_fitter_system(ritz_fitter *f,
                               const ritz_fit_candidate *candidate,
                               ritz_reduced **body, ritz_fit_path *path,
                               ritz_system *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced *made = NULL, *joined = NULL;
    ritz_stage stage = {0};
    ritz_system system = {0};
    ritz_fit_path found = {0};

    RITZ_NEW(made, f->num_components);
    RITZ_NEW(joined, f->num_components);
    RITZ_TRY(make_answer(f, candidate, made, &found));
    for (int64_t k = 0; k < f->num_components; k++)
        RITZ_TRY(copy_body(&made[k], &joined[k]));
    RITZ_TRY(ritz_stage_from(f->scene, joined, &stage));
    RITZ_TRY(ritz_assemble(&stage, NULL, &system));
    RITZ_TRY(measure_system(f, &system));
    *out = system;
    *body = made;
    *path = found;
    system = (ritz_system){0};
    found = (ritz_fit_path){0};
    made = NULL;
done:
    free_bodies(f->num_components, &made);
    free_bodies(f->num_components, &joined);
    ritz_stage_free(&stage);
    ritz_system_free(&system);
    ritz_fit_path_free(&found);
    return status;
}
