/*
 * COMPACT: vectors that make extraneous modes are removed from the bodies
 * [McDaniel2000, sec. 2.2.4, after a paper by Lee of 1993], so that these modes
 * do not return in any assembly of the bodies.
 *
 * In mode j of the second system, with unit mass, body c moves by z_cj = P_c
 * x_j in its orthonormal coordinates. For a direction v of the body, |v| = 1,
 *
 *     h(v) = v'H v / v'T v,    T = sum of z z' over all modes j,
 *                              H = the same without extraneous modes
 *
 * over all listed configurations, is the part of the motion along v that
 * belongs to modes that are not extraneous. In each step two directions of each
 * body are removed on trial, the one with the smallest h and the one with the
 * smallest v'H v. The direction whose removal increases the errors of kept
 * modes, responses and gains least is removed for good, until no extraneous
 * mode is left or the errors would increase by more than the scene's tolerance.
 *
 * Rigid motion, motions without mass and static solutions are never removed, so
 * that the static gain does not change.
 */
#include "compare/compare.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Stage two with some directions removed. */
typedef struct trial {
    ritz_subspaces subspaces;
    int64_t count;  /* bodies that H and T belong to */
    double change;  /* the largest of: errors of kept frequencies, 1 - MAC of
                       kept modes, and increases of the errors of responses,
                       static gains and damping */
    int64_t strays; /* extraneous modes at all listed configurations */
    ritz_dense *H;  /* for each body, over its directions that may be removed */
    ritz_dense *T;
} trial;

static void trial_free(trial *t)
{
    RITZ_FREE_EACH(ritz_dense, t->count, t->H);
    RITZ_FREE_EACH(ritz_dense, t->count, t->T);
    t->H = t->T = NULL;
    ritz_subspaces_free(&t->subspaces);
}

/* A += z z' with z from column j of Z, rows `first` and below. */
static void add_motion(const ritz_dense *Z, int64_t j, int64_t first,
                       ritz_dense *A)
{
    const double *z = ritz_dense_col(Z, j) + first;

    for (int64_t q = 0; q < A->ncol; q++)
        for (int64_t p = 0; p < A->nrow; p++)
            ritz_dense_col(A, q)[p] += z[p] * z[q];
}

/* Add the modes of one configuration to H and T of each body. */
static void add_modes(const ritz_configuration *second,
                      const ritz_compare_row *row, trial *t)
{
    int64_t next = 0; /* strays are sorted by mode */

    for (int64_t j = 0; j < second->K.ncol; j++) {
        bool stray = next < row->num_strays &&
                     row->stray[next].mode + second->num_rigid == j;

        next += stray;
        for (int64_t c = 0; c < t->subspaces.count; c++) {
            int64_t firm = t->subspaces.firm[c];

            add_motion(&second->P[c], j, firm, &t->T[c]);
            if (!stray)
                add_motion(&second->P[c], j, firm, &t->H[c]);
        }
    }
    t->strays += row->num_strays;
}

/* References of all trials: stage one, and stage two before anything was
   removed. */
typedef struct compactor {
    const ritz_rows *rows; /* borrowed, with the responses of stage one */
    double (*before)[3];   /* for each listed configuration, errors of response,
                              static gain and damping before anything was
                              removed */
    bool known;            /* `before` has been measured */
} compactor;

static void compactor_free(compactor *it)
{
    free(it->before);
}

/* Measure the second system of a trial at listed configuration k. */
static ritz_status measure_at(compactor *it, const ritz_comparison *second,
                              int64_t k, trial *t)
{
    RITZ_OWN(ritz_configuration) at = {0};
    ritz_compare_row row = {0};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(
        ritz_stage_assemble(&second->second, it->rows->row[k].setting, &at));
    status = ritz_rows_measure(it->rows, k, second->V, &at, &row);
    if (status == RITZ_OK) {
        add_modes(&at, &row, t);
        t->change = fmax(t->change, fmax(row.frequency_error, 1.0 - row.mac));
        const double errors[] = {row.response_error, row.gain_error,
                                 row.damping_error};

        for (int e = 0; e < 3; e++) {
            if (!it->known)
                it->before[k][e] = errors[e];
            t->change = fmax(t->change, errors[e] - it->before[k][e]);
        }
    }
    free(row.stray);
    return status;
}

/* Measure a trial; stops after the first configuration at which its change
   exceeds @p enough. */
static ritz_status measure_trial(compactor *it, double enough, trial *t)
{
    const int64_t count = t->subspaces.count;
    RITZ_OWN(ritz_comparison) second = {0};

    t->count = count;
    RITZ_CHECK_NEW(t->H, count);
    RITZ_CHECK_NEW(t->T, count);
    for (int64_t c = 0; c < count; c++) {
        int64_t loose = t->subspaces.V[c].ncol - t->subspaces.firm[c];

        RITZ_CHECK(ritz_dense_new(loose, loose, &t->H[c]));
        RITZ_CHECK(ritz_dense_new(loose, loose, &t->T[c]));
    }
    RITZ_CHECK(ritz_compare_project(it->rows->stage, &t->subspaces, &second));
    for (int64_t k = 0;
         k < it->rows->listed->num_configurations && t->change <= enough; k++)
        RITZ_CHECK(measure_at(it, &second, k, t));
    return RITZ_OK;
}

/*
 * The direction v with the smallest v'H v or, if @p relative, the smallest v'H
 * v / v'T v; v has no column if there is none. Directions without motion have
 * v'T v = 0; a small multiple of I is added to T, which gives them h = 0.
 */
static ritz_status find_direction(const trial *t, int64_t body, bool relative,
                                  ritz_dense *v)
{
    RITZ_OWN(ritz_dense) T = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    if (relative) {
        double least = RITZ_NO_MOTION * ritz_dense_max(&t->T[body]);

        RITZ_CHECK(ritz_dense_copy(&t->T[body], &T));
        for (int64_t k = 0; k < T.ncol; k++)
            ritz_dense_col(&T, k)[k] += least;
        RITZ_CHECK(ritz_eigen_dense(&t->H[body], &T, &pairs));
    } else {
        RITZ_CHECK(ritz_general_symmetric(&t->H[body], &pairs));
    }
    return ritz_dense_columns(&pairs.Phi, 0, pairs.Phi.ncol > 0 ? 1 : 0, v);
}

/*
 * V := V Q without the last column, where the Householder reflection Q maps the
 * last unit vector to v; v is zero in the first @p firm coordinates.
 */
static ritz_status leave_out(const ritz_dense *v, int64_t firm, ritz_dense *V)
{
    const int64_t s = V->ncol;
    RITZ_OWN(ritz_dense) Q = {0}, less = {0};
    RITZ_OWN_ARRAY double *w = NULL;
    double length = 0.0, square = 0.0;

    RITZ_CHECK_NEW(w, s);
    for (int64_t i = 0; i < v->nrow; i++)
        length = hypot(length, v->val[i]);
    for (int64_t i = 0; i < v->nrow; i++)
        w[firm + i] = v->val[i] / length;
    w[s - 1] += w[s - 1] < 0.0 ? -1.0 : 1.0;
    for (int64_t i = 0; i < s; i++)
        square += w[i] * w[i];
    RITZ_CHECK(ritz_dense_identity(s, &Q));
    for (int64_t j = 0; j < s; j++)
        for (int64_t i = 0; i < s; i++)
            ritz_dense_col(&Q, j)[i] -= 2.0 * w[i] * w[j] / square;
    RITZ_CHECK(ritz_dense_columns(&Q, 0, s - 1, &less));
    return ritz_dense_times(&less, V);
}

static ritz_status copy_subspaces(const ritz_subspaces *from,
                                  ritz_subspaces *out)
{
    RITZ_OWN(ritz_subspaces)
    made = {.count = from->count, .vectors = from->vectors};

    RITZ_CHECK_NEW(made.V, from->count);
    RITZ_CHECK_COPY(made.massless, from->massless, from->count);
    RITZ_CHECK_COPY(made.firm, from->firm, from->count);
    for (int64_t c = 0; c < from->count; c++)
        RITZ_CHECK(ritz_dense_copy(&from->V[c], &made.V[c]));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* Remove a direction of one body on trial, and store the result in @p best if
   it changes less. */
static ritz_status try_direction(compactor *it, const trial *now, int64_t body,
                                 bool relative, trial *best)
{
    RITZ_OWN(ritz_dense) v = {0};
    RITZ_OWN(trial) t = {0};

    RITZ_CHECK(find_direction(now, body, relative, &v));
    if (v.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(copy_subspaces(&now->subspaces, &t.subspaces));
    RITZ_CHECK(leave_out(&v, t.subspaces.firm[body], &t.subspaces.V[body]));
    RITZ_CHECK(
        measure_trial(it, best->subspaces.V ? best->change : HUGE_VAL, &t));
    if (best->subspaces.V && t.change >= best->change)
        return RITZ_OK;
    trial_free(best);
    RITZ_MOVE(*best, t);
    return RITZ_OK;
}

/* The best trial with one direction less. */
static ritz_status try_bodies(compactor *it, const trial *now, trial *best)
{
    for (int64_t c = 0; c < now->subspaces.count; c++) {
        if (now->subspaces.V[c].ncol <= now->subspaces.firm[c])
            continue;
        for (int relative = 0; relative < 2; relative++)
            RITZ_CHECK(try_direction(it, now, c, relative, best));
    }
    return RITZ_OK;
}

ritz_status ritz_compact(ritz_rows *rows, ritz_subspaces *subspaces,
                         ritz_comparison *out)
{
    const double tolerance = rows->stage->scene->extraneous_tolerance;
    RITZ_OWN(compactor) it = {.rows = rows};
    RITZ_OWN(trial) now = {0};

    out->dropped = 0;
    out->next_drop = nan("");
    RITZ_CHECK_NEW(it.before, rows->listed->num_configurations);
    RITZ_CHECK(ritz_rows_respond(rows));
    RITZ_CHECK(copy_subspaces(subspaces, &now.subspaces));
    RITZ_CHECK(measure_trial(&it, HUGE_VAL, &now));
    it.known = true;
    while (now.strays > 0) {
        RITZ_OWN(trial) best = {0};

        ritz_monitor_step("vectors of extraneous modes", out->dropped, 0);
        RITZ_CHECK(try_bodies(&it, &now, &best));
        if (!best.subspaces.V)
            break;
        out->next_drop = best.change;
        if (best.change > tolerance)
            break;
        out->dropped++;
        out->next_drop = nan("");
        trial_free(&now);
        RITZ_MOVE(now, best);
    }
    ritz_subspaces_free(subspaces);
    RITZ_MOVE(*subspaces, now.subspaces);
    return RITZ_OK;
}
