#include "linear/ordering.h"

#include "base/alloc.h"

#include <suitesparse/cholmod.h>

#include <inttypes.h>
#include <stdlib.h>

/* Consecutive rows with nearly the same entries form a group, mostly a grid. */
typedef struct grouping {
    int64_t count;
    int64_t *first; /* group g has the rows [first[g], first[g + 1]) */
    int64_t *of;    /* group of each row */
} grouping;

static void grouping_free(grouping *g)
{
    RITZ_FREE(g->first, g->of);
}

/* Whether four fifths of the entries of two columns are in the same rows. Not
   all need be: symmetry of the mesh may make a few entries zero. */
static bool is_alike(const ritz_sparse *A, int64_t a, int64_t b)
{
    const int64_t end_a = A->colptr[a + 1];
    const int64_t end_b = A->colptr[b + 1];
    int64_t p = A->colptr[a];
    int64_t q = A->colptr[b];
    const int64_t longer = end_a - p > end_b - q ? end_a - p : end_b - q;
    int64_t common = 0;

    while (p < end_a && q < end_b) {
        const int64_t i = A->rowind[p];
        const int64_t j = A->rowind[q];

        common += i == j;
        p += i <= j;
        q += j <= i;
    }
    return 5 * common >= 4 * longer;
}

static ritz_status group_rows(const ritz_sparse *A, grouping *g)
{
    RITZ_CHECK_NEW(g->first, A->nrow + 1);
    RITZ_CHECK_NEW(g->of, A->nrow);
    for (int64_t j = 0; j < A->nrow; j++) {
        if (j == 0 || !is_alike(A, g->first[g->count - 1], j))
            g->first[g->count++] = j;
        g->of[j] = g->count - 1;
    }
    g->first[g->count] = A->nrow;
    return RITZ_OK;
}

/*
 * The graph of groups: the neighbours h >= g of group g are the groups in whose
 * rows a column of g has an entry; neighbour[start[g]] and the following.
 */
typedef struct graph {
    int64_t *start, *neighbour;
} graph;

static void graph_free(graph *G)
{
    RITZ_FREE(G->start, G->neighbour);
}

static ritz_status join_groups(const ritz_sparse *A, const grouping *g,
                               graph *G)
{
    RITZ_OWN_ARRAY int64_t *met = NULL; /* 1 + last group next to this one */
    int64_t count = 0;

    RITZ_CHECK_NEW(met, g->count);
    RITZ_CHECK_NEW(G->start, g->count + 1);
    for (int pass = 0; pass < 2; pass++) {
        count = 0;
        for (int64_t k = 0; k < g->count; k++)
            met[k] = 0;
        for (int64_t k = 0; k < g->count; k++) {
            const int64_t end = A->colptr[g->first[k + 1]];

            G->start[k] = count;
            for (int64_t p = A->colptr[g->first[k]]; p < end; p++) {
                const int64_t h = g->of[A->rowind[p]];

                if (h < k || met[h] == k + 1)
                    continue;
                met[h] = k + 1;
                if (pass == 1)
                    G->neighbour[count] = h;
                count++;
            }
        }
        G->start[g->count] = count;
        if (pass == 0)
            RITZ_CHECK_NEW(G->neighbour, count);
    }
    return RITZ_OK;
}

/* at := the groups in the order that METIS finds. */
static ritz_status order_groups(const grouping *g, const graph *G, int64_t *at)
{
    cholmod_common common;
    cholmod_sparse view = {
        .nrow = (size_t)g->count,
        .ncol = (size_t)g->count,
        .nzmax = (size_t)G->start[g->count],
        .p = G->start,
        .i = G->neighbour,
        .stype = -1,
        .itype = CHOLMOD_LONG,
        .xtype = CHOLMOD_PATTERN,
        .dtype = CHOLMOD_DOUBLE,
        .packed = 1,
    };
    int done = 0;

    cholmod_l_start(&common);
    common.print = 0;
    done = cholmod_l_metis(&view, NULL, 0, 0, at, &common);
    cholmod_l_finish(&common);
    RITZ_REFUSE_IF(!done, RITZ_ERR_MEMORY,
                   "no memory to order %" PRId64 " groups of rows", g->count);
    return RITZ_OK;
}

ritz_status ritz_ordering_new(const ritz_sparse *A, int64_t **order)
{
    RITZ_OWN(grouping) g = {0};
    RITZ_OWN(graph) G = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL, *found = NULL;
    int64_t count = 0;

    RITZ_CHECK(group_rows(A, &g));
    RITZ_CHECK(join_groups(A, &g, &G));
    RITZ_CHECK_NEW(at, g.count);
    RITZ_CHECK_NEW(found, A->nrow);
    RITZ_CHECK(order_groups(&g, &G, at));
    for (int64_t k = 0; k < g.count; k++)
        for (int64_t j = g.first[at[k]]; j < g.first[at[k] + 1]; j++)
            found[count++] = j;
    RITZ_MOVE(*order, found);
    return RITZ_OK;
}
