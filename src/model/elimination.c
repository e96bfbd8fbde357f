/*
 * Dependent dofs in terms of the others:
 *
 *     u_m = R_mm u_m + R_mn u_n,    G_m = (I - R_mm)^-1 R_mn
 *
 * Dependents that depend on dependents are put in an order in which each comes
 * after those it needs, the strongly connected components of the graph of R_mm
 * as they are found depth first [Tarjan1972]. One alone is substitution; a
 * circle of s of them is a dense system of that size.
 */
#include "model/elimination_rows.h"

#include "base/alloc.h"

#include <stdlib.h>

/* ---- names ------------------------------------------------------------- */

typedef struct place {
    ritz_dof dof;
    int64_t row;
} place;

static int compare_places(const void *left, const void *right)
{
    const place *a = left;
    const place *b = right;

    return ritz_dof_compare(&a->dof, &b->dof);
}

static ritz_status find_place(const ritz_eliminator *s, const place *sorted,
                              ritz_dof dof, int64_t source, int64_t *out)
{
    const place wanted = {.dof = dof};
    const place *found = bsearch(&wanted, sorted, (size_t)s->num_all,
                                 sizeof *sorted, compare_places);
    char name[RITZ_DOF_NAME_SIZE];
    char cited[RITZ_CITATION_SIZE];

    RITZ_REFUSE_IF(!found, RITZ_ERR_FORMAT,
                   "%s names '%s', which is not among the dofs",
                   ritz_equations_cite(s->equations, source, cited),
                   ritz_dof_name(dof, name));
    *out = found->row;
    return RITZ_OK;
}

static ritz_status refuse_second(const ritz_eliminator *s, int64_t first,
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

/* Dependents: each once, and free to move. */
static ritz_status name_dependents(ritz_eliminator *s, const place *sorted,
                                   const bool *fixed)
{
    const ritz_equations *eq = s->equations;
    char name[RITZ_DOF_NAME_SIZE];
    char cited[RITZ_CITATION_SIZE];

    for (int64_t e = 0; e < eq->count; e++) {
        int64_t k = 0;

        RITZ_CHECK(find_place(s, sorted, eq->dependent[e], eq->source[e], &k));
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

static ritz_status name_terms(ritz_eliminator *s, const bool *fixed)
{
    ritz_status status = RITZ_OK;
    const ritz_equations *eq = s->equations;
    place *sorted = NULL;

    RITZ_NEW(sorted, s->num_all);
    for (int64_t k = 0; k < s->num_all; k++) {
        sorted[k] = (place){s->dof[k], k};
        s->equation[k] = -1;
    }
    qsort(sorted, (size_t)s->num_all, sizeof *sorted, compare_places);
    RITZ_TRY(name_dependents(s, sorted, fixed));
    for (int64_t e = 0; e < eq->count; e++)
        for (int64_t k = eq->first[e]; k < eq->first[e + 1]; k++)
            RITZ_TRY(
                find_place(s, sorted, eq->dof[k], eq->source[e], &s->at[k]));
done:
    free(sorted);
    return status;
}

/* ---- the order --------------------------------------------------------- */

/* Depth first through the equations, without recursion: chains may be long. */
typedef struct walk {
    int64_t *index; /* when an equation was met, 0 not yet */
    int64_t *low;   /* the earliest on the stack that it leads to */
    int64_t *next;  /* term to look at next */
    int64_t *path;  /* equations that are being looked at */
    int64_t *stack; /* those whose circle is not complete */
    bool *waiting;  /* whether it is on that stack */
    int64_t depth, height, met;
} walk;

static void enter(const ritz_equations *eq, int64_t e, walk *w)
{
    w->index[e] = w->low[e] = ++w->met;
    w->next[e] = eq->first[e];
    w->path[w->depth++] = e;
    w->stack[w->height++] = e;
    w->waiting[e] = true;
}

/* The next equation that e needs and that was not met; -1 if there is none. */
static int64_t advance(const ritz_eliminator *s, int64_t e, walk *w)
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

static ritz_status leave(ritz_eliminator *s, int64_t e, walk *w)
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
    RITZ_CHECK(ritz_eliminator_settle(s, w->height - from, w->stack + from));
    w->height = from;
    return RITZ_OK;
}

static ritz_status settle_all(ritz_eliminator *s)
{
    ritz_status status = RITZ_OK;
    const ritz_equations *eq = s->equations;
    walk w = {0};

    RITZ_NEW(w.index, eq->count);
    RITZ_NEW(w.low, eq->count);
    RITZ_NEW(w.next, eq->count);
    RITZ_NEW(w.path, eq->count);
    RITZ_NEW(w.stack, eq->count);
    RITZ_NEW(w.waiting, eq->count);
    for (int64_t e = 0; e < eq->count; e++) {
        if (w.index[e] > 0)
            continue;
        enter(eq, e, &w);
        while (w.depth > 0) {
            int64_t here = w.path[w.depth - 1];
            int64_t to = advance(s, here, &w);

            if (to >= 0)
                enter(eq, to, &w);
            else
                RITZ_TRY(leave(s, here, &w));
        }
    }
done:
    free(w.index);
    free(w.low);
    free(w.next);
    free(w.path);
    free(w.stack);
    free(w.waiting);
    return status;
}

/* ---- all together ------------------------------------------------------ */

/* Which dofs stay; column[k] is the column of G of each, -1 of the others. */
static ritz_status split(const ritz_eliminator *s, int64_t *column,
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

static ritz_status build(const ritz_eliminator *s, ritz_elimination *out)
{
    ritz_status status = RITZ_OK;
    int64_t *column = NULL, *line = NULL, *col = NULL;
    double *val = NULL;
    int64_t count = s->num_all - s->equations->count;

    for (int64_t e = 0; e < s->equations->count; e++)
        count += s->found[e].count;
    RITZ_NEW(column, s->num_all);
    RITZ_NEW(line, count);
    RITZ_NEW(col, count);
    RITZ_NEW(val, count);
    RITZ_TRY(split(s, column, out));
    count = 0;
    for (int64_t k = 0; k < s->num_all; k++) {
        const ritz_elimination_row *known =
            s->equation[k] < 0 ? NULL : &s->found[s->equation[k]];

        for (int64_t j = 0; j < (known ? known->count : 1); j++) {
            line[count] = k;
            col[count] = column[known ? known->col[j] : k];
            val[count++] = known ? known->val[j] : 1.0;
        }
    }
    RITZ_TRY(ritz_sparse_from_triplets(s->num_all, out->kept.count, count, line,
                                       col, val, &out->G));
done:
    free(column);
    free(line);
    free(col);
    free(val);
    return status;
}

ritz_status ritz_elimination_new(const ritz_equations *equations, int64_t count,
                                 const ritz_dof *dof, const bool *fixed,
                                 ritz_elimination *out)
{
    ritz_status status = RITZ_OK;
    ritz_elimination new = {0};
    ritz_eliminator s = {.equations = equations, .num_all = count, .dof = dof};
    int64_t terms =
        equations->count > 0 ? equations->first[equations->count] : 0;

    RITZ_NEW(s.at, terms);
    RITZ_NEW(s.equation, count);
    RITZ_NEW(s.found, equations->count);
    RITZ_NEW(s.sum, count);
    RITZ_NEW(s.used, count);
    RITZ_NEW(s.list, count);
    RITZ_NEW(s.member, equations->count);
    for (int64_t e = 0; e < equations->count; e++)
        s.member[e] = -1;
    RITZ_TRY(name_terms(&s, fixed));
    RITZ_TRY(settle_all(&s));
    RITZ_TRY(build(&s, &new));
    *out = new;
    new = (ritz_elimination){0};
done:
    for (int64_t e = 0; s.found && e < equations->count; e++) {
        free(s.found[e].col);
        free(s.found[e].val);
    }
    free(s.at);
    free(s.equation);
    free(s.found);
    free(s.sum);
    free(s.used);
    free(s.list);
    free(s.member);
    ritz_elimination_free(&new);
    return status;
}

void ritz_elimination_free(ritz_elimination *elimination)
{
    ritz_dofs_free(&elimination->kept);
    ritz_dofs_free(&elimination->gone);
    ritz_sparse_free(&elimination->G);
    *elimination = (ritz_elimination){0};
}
