/*
 * Dependent dofs in terms of the others:
 *
 *     u_m = R_mm u_m + R_mn u_n,    G_m = (I - R_mm)^-1 R_mn
 *
 * Dependents that depend on dependents are ordered so that each comes after
 * those it needs: the strongly connected components of the graph of R_mm, as
 * depth-first search finds them [Tarjan1972]. A single one is found by
 * substitution, a circle of s of them by a dense system of order s.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/equations.h"

#include <inttypes.h>
#include <lapacke.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- equations ---------------------------------------------------------- */

const char *ritz_equations_cite(const ritz_equations *equations, int64_t source,
                                char text[static RITZ_CITATION_SIZE])
{
    const ritz_equation_source *from = &equations->from[source];
    const char *path = from->file < 0 ? NULL : equations->file[from->file];

    if (path)
        snprintf(text, RITZ_CITATION_SIZE, "%s ('%.100s', line %" PRId64 ")",
                 from->name, path, from->line);
    else if (from->line > 0)
        snprintf(text, RITZ_CITATION_SIZE, "%s (line %" PRId64 ")", from->name,
                 from->line);
    else
        snprintf(text, RITZ_CITATION_SIZE, "%s", from->name);
    return text;
}

int64_t ritz_equations_find(const ritz_equations *equations, ritz_dof dof)
{
    for (int64_t e = 0; e < equations->count; e++)
        if (ritz_dof_compare(&equations->dependent[e], &dof) == 0)
            return e;
    return -1;
}

void ritz_equations_free(ritz_equations *equations)
{
    RITZ_FREE(equations->dependent, equations->first, equations->dof,
              equations->share, equations->source, equations->from);
    for (int64_t k = 0; k < equations->num_files; k++)
        free(equations->file[k]);
    RITZ_FREE(equations->file, equations->refused);
    *equations = (ritz_equations){0};
}

/* room[] is of these arrays */
enum { DEPENDENT, FIRST, DOF, SHARE, SOURCE, FROM };

ritz_status ritz_equations_cite_next(ritz_equations *equations,
                                     ritz_equation_source from)
{
    RITZ_CHECK_ROOM(equations->from, equations->num_sources,
                    equations->room[FROM]);
    equations->from[equations->num_sources++] = from;
    return RITZ_OK;
}

ritz_status ritz_equations_begin(ritz_equations *equations, ritz_dof dependent)
{
    int64_t e = equations->count;
    int64_t starts = e == 0 ? 0 : e + 1;
    int64_t begin = 0;

    if (starts > 0)
        begin = equations->first[e];
    RITZ_CHECK_ROOM(equations->dependent, e, equations->room[DEPENDENT]);
    RITZ_CHECK_ROOM(equations->source, e, equations->room[SOURCE]);
    /* room for two more: first[0] comes with the first equation */
    RITZ_CHECK_ROOM(equations->first, starts, equations->room[FIRST]);
    RITZ_CHECK_ROOM(equations->first, e + 1, equations->room[FIRST]);
    equations->dependent[e] = dependent;
    equations->source[e] = equations->num_sources - 1;
    equations->first[e] = begin;
    equations->first[e + 1] = begin;
    equations->count++;
    return RITZ_OK;
}

ritz_status ritz_equations_add(ritz_equations *equations, ritz_dof dof,
                               double share)
{
    int64_t *end = &equations->first[equations->count];

    if (share == 0.0)
        return RITZ_OK;
    RITZ_CHECK_ROOM(equations->dof, *end, equations->room[DOF]);
    RITZ_CHECK_ROOM(equations->share, *end, equations->room[SHARE]);
    equations->dof[*end] = dof;
    equations->share[(*end)++] = share;
    return RITZ_OK;
}

/* ---- rows of G_m ------------------------------------------------------- */

/* A row of G_m, by columns. */
typedef struct elimination_row {
    int64_t count;
    int64_t *col; /* among all dofs */
    double *val;
} elimination_row;

static void elimination_row_free(elimination_row *row)
{
    RITZ_FREE(row->col, row->val);
}

RITZ_ARRAY_OF(elimination_row);

typedef struct eliminator {
    const ritz_equations *equations;
    int64_t num_all;
    const ritz_dof *dof;
    int64_t *at;       /* of each term of the equations, its dof among all */
    int64_t *equation; /* of each dof among all, -1 if it is not dependent */
    elimination_row_array found; /* of each equation */
    double *sum;                 /* among all dofs, zero between uses */
    bool *used;                  /* whether a place of `sum` is in use */
    int64_t *list;               /* the places in use */
    int64_t num_used;
    int64_t *member;  /* of each equation, its place in the circle, or -1 */
    int64_t num_kept; /* entries of all rows found */
} eliminator;

static void eliminator_free(eliminator *s)
{
    RITZ_FREE(s->at, s->equation);
    elimination_row_array_free(&s->found);
    RITZ_FREE(s->sum, s->used, s->list, s->member);
}

enum {
    MOST_COUPLED = 2000,      /* in one circle: a factor of 32 MB */
    MOST_ENTRIES = 200000000, /* of all rows: 3 GB */
};

static void add_to_sum(eliminator *s, int64_t col, double value)
{
    if (!s->used[col]) {
        s->used[col] = true;
        s->list[s->num_used++] = col;
    }
    s->sum[col] += value;
}

/*
 * Equation e with all that is known substituted, in `sum`; shares of members
 * of its own circle are taken from row i of I - R_mm instead.
 */
static void substitute_known(eliminator *s, int64_t e, int64_t i, ritz_dense *A)
{
    const ritz_equations *eq = s->equations;

    for (int64_t k = eq->first[e]; k < eq->first[e + 1]; k++) {
        int64_t of = s->equation[s->at[k]];
        const elimination_row *known = of < 0 ? NULL : &s->found.at[of];

        if (of < 0)
            add_to_sum(s, s->at[k], eq->share[k]);
        else if (s->member[of] >= 0)
            ritz_dense_col(A, s->member[of])[i] -= eq->share[k];
        else
            for (int64_t j = 0; j < known->count; j++)
                add_to_sum(s, known->col[j], eq->share[k] * known->val[j]);
    }
}

/* Store `sum` as a row; of a circle, row i of X at the places in use. */
static ritz_status keep_row(eliminator *s, const ritz_dense *X, int64_t i,
                            elimination_row *out)
{
    RITZ_OWN(elimination_row) new = {0};

    RITZ_REFUSE_IF(s->num_used > MOST_ENTRIES - s->num_kept, RITZ_ERR_FORMAT,
                   "the constraints spread over more than %d entries: a chain "
                   "of them sums up too much",
                   MOST_ENTRIES);
    s->num_kept += s->num_used;
    RITZ_CHECK_NEW(new.col, s->num_used);
    RITZ_CHECK_NEW(new.val, s->num_used);
    for (int64_t k = 0; k < s->num_used; k++) {
        double value = X ? ritz_dense_col(X, k)[i] : s->sum[s->list[k]];

        if (value == 0.0)
            continue;
        new.col[new.count] = s->list[k];
        new.val[new.count++] = value;
    }
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

/* X := A^-1 X. Rows of A have entries of about 1 and need no scaling. */
static ritz_status solve_dense(const eliminator *s, const int64_t *circle,
                               ritz_dense *A, ritz_dense *X)
{
    const ritz_equations *eq = s->equations;
    lapack_int n = (lapack_int)A->nrow;
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    double size = 0.0;
    double rcond = 0.0;
    char name[RITZ_DOF_NAME_SIZE];
    char cited[RITZ_CITATION_SIZE];

    RITZ_CHECK_NEW(pivot, n);
    size = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', n, n, A->val, n);
    if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, n, n, A->val, n, pivot) == 0)
        RITZ_REFUSE_IF(LAPACKE_dgecon(LAPACK_COL_MAJOR, '1', n, A->val, n, size,
                                      &rcond) != 0,
                       RITZ_ERR_MEMORY, "no memory for the constraints");
    RITZ_REFUSE_IF(!(rcond > RITZ_WELL_CONDITIONED), RITZ_ERR_SINGULAR,
                   "%s leaves '%s' undetermined%s",
                   ritz_equations_cite(eq, eq->source[circle[0]], cited),
                   ritz_dof_name(eq->dependent[circle[0]], name),
                   n > 1 ? ", together with the constraints that depend on it"
                         : ": it depends on itself alone");
    if (X->ncol > 0)
        RITZ_REFUSE_IF(LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', n,
                                      (lapack_int)X->ncol, A->val, n, pivot,
                                      X->val, n) != 0,
                       RITZ_ERR_MEMORY, "no memory for the constraints");
    return RITZ_OK;
}

/* Right-hand sides of a circle, a column for each place in use. */
static ritz_status gather_circle(eliminator *s, int64_t count,
                                 const int64_t *circle, ritz_dense *A,
                                 ritz_dense *X)
{
    RITZ_OWN(elimination_row_array) side = {.count = count};

    RITZ_CHECK_NEW(side.at, count);
    for (int64_t i = 0; i < count; i++) {
        substitute_known(s, circle[i], i, A);
        RITZ_CHECK(keep_row(s, NULL, 0, &side.at[i]));
        for (int64_t k = 0; k < s->num_used; k++)
            s->sum[s->list[k]] = 0.0;
    }
    RITZ_CHECK(ritz_dense_new(count, s->num_used, X));
    for (int64_t k = 0; k < s->num_used; k++)
        s->sum[s->list[k]] = (double)k;
    for (int64_t i = 0; i < count; i++)
        for (int64_t k = 0; k < side.at[i].count; k++)
            ritz_dense_col(X, (int64_t)s->sum[side.at[i].col[k]])[i] =
                side.at[i].val[k];
    return RITZ_OK;
}

static ritz_status solve_circle(eliminator *s, int64_t count,
                                const int64_t *circle)
{
    RITZ_OWN(ritz_dense) A = {0}, X = {0};

    RITZ_REFUSE_IF(count > MOST_COUPLED, RITZ_ERR_FORMAT,
                   "%" PRId64 " dofs depend on each other in a circle, of at "
                   "most %d that is solved",
                   count, MOST_COUPLED);
    for (int64_t i = 0; i < count; i++)
        s->member[circle[i]] = i;
    RITZ_CHECK(ritz_dense_identity(count, &A));
    RITZ_CHECK(gather_circle(s, count, circle, &A, &X));
    RITZ_CHECK(solve_dense(s, circle, &A, &X));
    for (int64_t i = 0; i < count; i++) {
        RITZ_CHECK(keep_row(s, &X, i, &s->found.at[circle[i]]));
        s->member[circle[i]] = -1;
    }
    return RITZ_OK;
}

static bool needs_itself(const eliminator *s, int64_t e)
{
    const ritz_equations *eq = s->equations;

    for (int64_t k = eq->first[e]; k < eq->first[e + 1]; k++)
        if (s->equation[s->at[k]] == e)
            return true;
    return false;
}

/* Find the rows of a circle, or of one equation; all others that they need
   are known. */
static ritz_status settle_circle(eliminator *s, int64_t count,
                                 const int64_t *circle)
{
    if (count > 1 || needs_itself(s, circle[0])) {
        RITZ_CHECK(solve_circle(s, count, circle));
    } else {
        substitute_known(s, circle[0], 0, NULL);
        RITZ_CHECK(keep_row(s, NULL, 0, &s->found.at[circle[0]]));
    }
    for (int64_t k = 0; k < s->num_used; k++) {
        s->sum[s->list[k]] = 0.0;
        s->used[s->list[k]] = false;
    }
    s->num_used = 0;
    return RITZ_OK;
}

/* ---- names ------------------------------------------------------------- */

static ritz_status find_place(const eliminator *s, const ritz_roster *roster,
                              ritz_dof dof, int64_t source, int64_t *out)
{
    char name[RITZ_DOF_NAME_SIZE];
    char cited[RITZ_CITATION_SIZE];

    *out = ritz_roster_row(roster, dof);
    RITZ_REFUSE_IF(*out < 0, RITZ_ERR_FORMAT,
                   "%s names '%s', which is not among the dofs",
                   ritz_equations_cite(s->equations, source, cited),
                   ritz_dof_name(dof, name));
    return RITZ_OK;
}

static ritz_status refuse_second(const eliminator *s, int64_t first,
                                 int64_t second)
{
    const ritz_equations *eq = s->equations;
    char name[RITZ_DOF_NAME_SIZE];
    char one[RITZ_CITATION_SIZE];
    char two[RITZ_CITATION_SIZE];

    ritz_dof_name(eq->dependent[second], name);
    ritz_equations_cite(eq, eq->source[first], one);
    ritz_equations_cite(eq, eq->source[second], two);
    if (eq->source[first] == eq->source[second])
        return ritz_fail(RITZ_ERR_FORMAT, "'%s' depends on %s twice", name,
                         one);
    return ritz_fail(RITZ_ERR_FORMAT, "'%s' depends on %s and on %s", name, one,
                     two);
}

/* Each dof is dependent once, and is not held. */
static ritz_status name_dependents(eliminator *s, const ritz_roster *roster,
                                   const bool *fixed)
{
    const ritz_equations *eq = s->equations;
    char name[RITZ_DOF_NAME_SIZE];
    char cited[RITZ_CITATION_SIZE];

    for (int64_t e = 0; e < eq->count; e++) {
        int64_t k = 0;

        RITZ_CHECK(find_place(s, roster, eq->dependent[e], eq->source[e], &k));
        if (s->equation[k] >= 0)
            RITZ_CHECK(refuse_second(s, s->equation[k], e));
        RITZ_REFUSE_IF(fixed && fixed[k], RITZ_ERR_FORMAT,
                       "'%s' depends on %s and is fixed by the deck: it cannot "
                       "be both",
                       ritz_dof_name(eq->dependent[e], name),
                       ritz_equations_cite(eq, eq->source[e], cited));
        s->equation[k] = e;
    }
    return RITZ_OK;
}

static ritz_status name_terms(eliminator *s, const bool *fixed)
{
    const ritz_equations *eq = s->equations;
    RITZ_OWN(ritz_roster) roster = {0};

    for (int64_t k = 0; k < s->num_all; k++)
        s->equation[k] = -1;
    RITZ_CHECK(ritz_roster_new(s->num_all, s->dof, &roster));
    RITZ_CHECK(name_dependents(s, &roster, fixed));
    for (int64_t e = 0; e < eq->count; e++)
        for (int64_t k = eq->first[e]; k < eq->first[e + 1]; k++)
            RITZ_CHECK(
                find_place(s, &roster, eq->dof[k], eq->source[e], &s->at[k]));
    return RITZ_OK;
}

/* ---- the order --------------------------------------------------------- */

/* Depth first through the equations, without recursion: chains may be long. */
typedef struct walk {
    int64_t *index; /* number of the visit to an equation, 0 before it */
    int64_t *low;   /* earliest equation on the stack that it leads to */
    int64_t *next;  /* term to look at next */
    int64_t *path;  /* path of equations that are being visited */
    int64_t *stack; /* equations whose circle is not complete */
    bool *waiting;  /* whether it is on that stack */
    int64_t depth, height, met;
} walk;

static void walk_free(walk *w)
{
    RITZ_FREE(w->index, w->low, w->next, w->path, w->stack, w->waiting);
}

static void enter_equation(const ritz_equations *eq, int64_t e, walk *w)
{
    w->index[e] = w->low[e] = ++w->met;
    w->next[e] = eq->first[e];
    w->path[w->depth++] = e;
    w->stack[w->height++] = e;
    w->waiting[e] = true;
}

/* Next equation that e needs and that was not visited, or -1. */
static int64_t find_next(const eliminator *s, int64_t e, walk *w)
{
    const ritz_equations *eq = s->equations;

    while (w->next[e] < eq->first[e + 1]) {
        int64_t to = s->equation[s->at[w->next[e]++]];

        if (to < 0)
            continue;
        if (w->index[to] == 0)
            return to;
        if (w->waiting[to] && w->index[to] < w->low[e])
            w->low[e] = w->index[to];
    }
    return -1;
}

static ritz_status leave_equation(eliminator *s, int64_t e, walk *w)
{
    int64_t from = w->height;

    w->depth--;
    if (w->depth > 0 && w->low[e] < w->low[w->path[w->depth - 1]])
        w->low[w->path[w->depth - 1]] = w->low[e];
    if (w->low[e] < w->index[e])
        return RITZ_OK;
    do
        w->waiting[w->stack[--from]] = false;
    while (w->stack[from] != e);
    RITZ_CHECK(settle_circle(s, w->height - from, w->stack + from));
    w->height = from;
    return RITZ_OK;
}

static ritz_status settle_all(eliminator *s)
{
    const ritz_equations *eq = s->equations;
    RITZ_OWN(walk) w = {0};

    RITZ_CHECK_NEW(w.index, eq->count);
    RITZ_CHECK_NEW(w.low, eq->count);
    RITZ_CHECK_NEW(w.next, eq->count);
    RITZ_CHECK_NEW(w.path, eq->count);
    RITZ_CHECK_NEW(w.stack, eq->count);
    RITZ_CHECK_NEW(w.waiting, eq->count);
    for (int64_t e = 0; e < eq->count; e++) {
        if (w.index[e] > 0)
            continue;
        enter_equation(eq, e, &w);
        while (w.depth > 0) {
            int64_t here = w.path[w.depth - 1];
            int64_t to = find_next(s, here, &w);

            if (to >= 0)
                enter_equation(eq, to, &w);
            else
                RITZ_CHECK(leave_equation(s, here, &w));
        }
    }
    return RITZ_OK;
}

/* ---- all together ------------------------------------------------------ */

/* Divide the dofs; column[k] is the column of G of a kept one, else -1. */
static ritz_status split_dofs(const eliminator *s, int64_t *column,
                              ritz_elimination *out)
{
    RITZ_CHECK_NEW(out->kept.at, s->num_all - s->equations->count);
    RITZ_CHECK_NEW(out->gone.at, s->equations->count);
    for (int64_t k = 0; k < s->num_all; k++) {
        bool stays = s->equation[k] < 0;

        column[k] = stays ? out->kept.count : -1;
        if (stays)
            out->kept.at[out->kept.count++] = k;
        else
            out->gone.at[out->gone.count++] = k;
    }
    return RITZ_OK;
}

static ritz_status build_elimination(const eliminator *s, ritz_elimination *out)
{
    RITZ_OWN_ARRAY int64_t *column = NULL, *line = NULL, *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;
    int64_t count = s->num_all - s->equations->count;

    for (int64_t e = 0; e < s->equations->count; e++)
        count += s->found.at[e].count;
    RITZ_CHECK_NEW(column, s->num_all);
    RITZ_CHECK_NEW(line, count);
    RITZ_CHECK_NEW(col, count);
    RITZ_CHECK_NEW(val, count);
    RITZ_CHECK(split_dofs(s, column, out));
    count = 0;
    for (int64_t k = 0; k < s->num_all; k++) {
        const elimination_row *known =
            s->equation[k] < 0 ? NULL : &s->found.at[s->equation[k]];

        for (int64_t j = 0; j < (known ? known->count : 1); j++) {
            line[count] = k;
            col[count] = column[known ? known->col[j] : k];
            val[count++] = known ? known->val[j] : 1.0;
        }
    }
    return ritz_sparse_from_triplets(s->num_all, out->kept.count, count, line,
                                     col, val, &out->G);
}

ritz_status ritz_elimination_new(const ritz_equations *equations, int64_t count,
                                 const ritz_dof *dof, const bool *fixed,
                                 ritz_elimination *out)
{
    RITZ_OWN(ritz_elimination) new = {0};
    RITZ_OWN(eliminator)
    s = {.equations = equations, .num_all = count, .dof = dof};
    int64_t terms =
        equations->count > 0 ? equations->first[equations->count] : 0;

    RITZ_CHECK_NEW(s.at, terms);
    RITZ_CHECK_NEW(s.equation, count);
    RITZ_CHECK_NEW(s.found.at, equations->count);
    s.found.count = equations->count;
    RITZ_CHECK_NEW(s.sum, count);
    RITZ_CHECK_NEW(s.used, count);
    RITZ_CHECK_NEW(s.list, count);
    RITZ_CHECK_NEW(s.member, equations->count);
    for (int64_t e = 0; e < equations->count; e++)
        s.member[e] = -1;
    RITZ_CHECK(name_terms(&s, fixed));
    RITZ_CHECK(settle_all(&s));
    RITZ_CHECK(build_elimination(&s, &new));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

void ritz_elimination_free(ritz_elimination *elimination)
{
    ritz_dofs_free(&elimination->kept);
    ritz_dofs_free(&elimination->gone);
    ritz_sparse_free(&elimination->G);
    *elimination = (ritz_elimination){0};
}
