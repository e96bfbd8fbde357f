/*
 * Dofs that have no mass, no stiffness, or no connection to the others. Dofs of
 * one grid belong together; two grids do if any entry of K or M couples them.
 */
#include "check/audit_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int64_t root_of(int64_t *parent, int64_t k)
{
    while (parent[k] != k) {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    return k;
}

static void join(int64_t *parent, int64_t a, int64_t b)
{
    a = root_of(parent, a);
    b = root_of(parent, b);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

static void join_entries(const ritz_sparse *A, int64_t *parent)
{
    for (int64_t j = 0; A->colptr && j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->val[p] != 0.0)
                join(parent, A->rowind[p], j);
}

/* A row and the grid it belongs to, to bring rows of a grid together. */
typedef struct seat {
    int64_t grid, row;
} seat;

static int compare_seats(const void *left, const void *right)
{
    const seat *a = left;
    const seat *b = right;

    if (a->grid != b->grid)
        return a->grid < b->grid ? -1 : 1;
    return (a->row > b->row) - (a->row < b->row);
}

static ritz_status join_grids(const ritz_component *c, int64_t *parent)
{
    ritz_status status = RITZ_OK;
    seat *list = NULL;

    RITZ_NEW(list, c->num_dofs);
    for (int64_t k = 0; k < c->num_dofs; k++)
        list[k] = (seat){c->dof[k].grid, k};
    qsort(list, (size_t)c->num_dofs, sizeof *list, compare_seats);
    for (int64_t k = 1; k < c->num_dofs; k++)
        if (list[k].grid == list[k - 1].grid)
            join(parent, list[k].row, list[k - 1].row);
done:
    free(list);
    return status;
}

/* Number the parts in it->part; their count, and the largest of them. */
static ritz_status find_parts(ritz_auditor *it, int64_t *count)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    int64_t n = c->num_dofs;
    int64_t *parent = NULL;
    int64_t *size = NULL;

    RITZ_NEW(parent, n);
    RITZ_NEW(size, n);
    RITZ_NEW(it->part, n);
    for (int64_t k = 0; k < n; k++)
        parent[k] = k;
    join_entries(&c->K, parent);
    join_entries(&c->M, parent);
    RITZ_TRY(join_grids(c, parent));
    *count = 0;
    for (int64_t k = 0; k < n; k++) { /* a root is the least of its part */
        int64_t root = root_of(parent, k);

        it->part[k] = root == k ? (*count)++ : it->part[root];
        size[it->part[k]]++;
    }
    for (int64_t k = 0; k < *count; k++)
        if (size[k] > size[it->largest])
            it->largest = k;
done:
    free(parent);
    free(size);
    return status;
}

/* Grids outside the largest part, each once. */
static void name_others(const ritz_auditor *it, char where[RITZ_WHERE_SIZE])
{
    const ritz_component *c = it->component;
    int64_t last = -1;

    where[0] = '\0';
    for (int64_t k = 0; k < c->num_dofs; k++) {
        char name[RITZ_DOF_NAME_SIZE];

        if (it->part[k] == it->largest || c->dof[k].grid == last)
            continue;
        last = c->dof[k].grid;
        snprintf(name, sizeof name, "%s %" PRId64,
                 c->dof[k].component == 0 ? "point" : "grid", last);
        ritz_auditor_list(where, name);
    }
}

static ritz_status check_parts(ritz_auditor *it)
{
    int64_t count = 0;
    char where[RITZ_WHERE_SIZE];

    RITZ_CHECK(find_parts(it, &count));
    name_others(it, where);
    if (count == 1)
        ritz_auditor_say(it, "separate-bodies", 1.0, 1.0, RITZ_PASS, where,
                         "all dofs are connected");
    else
        ritz_auditor_say(it, "separate-bodies", (double)count, 1.0, RITZ_WARN,
                         where,
                         "%" PRId64 " parts without connection: the grids "
                         "named lie outside the largest",
                         count);
    return RITZ_OK;
}

/* Flag the rows of A that hold nothing but zeros. */
static void flag_empty(const ritz_sparse *A, bool *flag)
{
    for (int64_t j = 0; j < A->ncol; j++) {
        flag[j] = true;
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->val[p] != 0.0)
                flag[j] = false;
    }
}

static void check_rows(ritz_auditor *it, const ritz_sparse *A, const char *name,
                       const char *meaning, bool *flag)
{
    char where[RITZ_WHERE_SIZE];
    int64_t count = 0;

    flag_empty(A, flag);
    count = ritz_auditor_where(it, flag, where);
    if (count == 0)
        ritz_auditor_say(it, name, 0.0, 0.0, RITZ_PASS, where,
                         "there are none");
    else
        ritz_auditor_say(it, name, (double)count, 0.0, RITZ_WARN, where,
                         "%" PRId64 " of %" PRId64 " dofs %s", count,
                         it->component->num_dofs, meaning);
}

ritz_status ritz_audit_dofs(ritz_auditor *it)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    bool *flag = NULL;

    RITZ_NEW(flag, c->num_dofs);
    check_rows(it, &c->M, "massless-dofs",
               "have no mass: they follow the others without inertia", flag);
    if (!it->rigid)
        check_rows(it, &c->K, "unconnected-dofs",
                   "have mass but no stiffness: they move freely", flag);
    RITZ_TRY(check_parts(it));
done:
    free(flag);
    return status;
}
