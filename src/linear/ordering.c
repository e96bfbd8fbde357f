#include "linear/ordering.h"

#include "base/alloc.h"

#include <suitesparse/cholmod.h>

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

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

/* Whether seven tenths of the entries of two columns are in the same rows. Not
   all need be: symmetry of the mesh makes some entries zero. Neighbours in a
   regular mesh of beams, shells or solids have two thirds in common. */
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
    return 10 * common >= 7 * longer;
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

/* The graph as CHOLMOD reads it. */
static cholmod_sparse view_graph(const grouping *g, const graph *G)
{
    return (cholmod_sparse){
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
}

/* at := the groups in the order that METIS finds. */
static ritz_status order_groups(const grouping *g, const graph *G, int64_t *at)
{
    cholmod_common common;
    cholmod_sparse view = view_graph(g, G);
    int done = 0;

    cholmod_l_start(&common);
    common.print = 0;
    done = cholmod_l_metis(&view, NULL, 0, 0, at, &common);
    cholmod_l_finish(&common);
    RITZ_REFUSE_IF(!done, RITZ_ERR_MEMORY,
                   "no memory to order %" PRId64 " groups of rows", g->count);
    return RITZ_OK;
}

/* --- orders that are stored ----------------------------------------------- */

/* If two patterns had the same hash, one of them would get the order of the
   other: its factor would have more entries, but be correct. */
typedef struct stored_order {
    int64_t rows, entries;
    uint64_t hash; /* of the pattern */
    int64_t *order;
} stored_order;

struct ritz_orders {
    int64_t count, room;
    stored_order *item;
};

static _Thread_local ritz_orders *lent;

ritz_status ritz_orders_new(ritz_orders **out)
{
    RITZ_CHECK_NEW(*out, 1);
    return RITZ_OK;
}

void ritz_orders_free(ritz_orders **orders)
{
    if (!*orders)
        return;
    for (int64_t k = 0; k < (*orders)->count; k++)
        free((*orders)->item[k].order);
    free((*orders)->item);
    free(*orders);
    *orders = NULL;
}

int64_t ritz_orders_count(const ritz_orders *orders)
{
    return orders->count;
}

ritz_orders_lent ritz_orders_lend(ritz_orders *orders)
{
    const ritz_orders_lent scope = {lent};

    lent = orders;
    return scope;
}

void ritz_orders_lent_free(ritz_orders_lent *scope)
{
    lent = scope->before;
}

/* The hash FNV-1a of whole numbers in place of bytes. */
static uint64_t hash_numbers(int64_t count, const int64_t *x, uint64_t hash)
{
    for (int64_t k = 0; k < count; k++)
        hash = (hash ^ (uint64_t)x[k]) * UINT64_C(0x100000001b3);
    return hash;
}

static stored_order describe_pattern(const ritz_sparse *A)
{
    const int64_t entries = A->colptr[A->ncol];
    uint64_t hash = UINT64_C(0xcbf29ce484222325);

    hash = hash_numbers(A->ncol + 1, A->colptr, hash);
    return (stored_order){.rows = A->nrow,
                          .entries = entries,
                          .hash = hash_numbers(entries, A->rowind, hash)};
}

static const int64_t *find_stored(const stored_order *of)
{
    for (int64_t k = 0; k < lent->count; k++) {
        const stored_order *s = &lent->item[k];

        if (s->rows == of->rows && s->entries == of->entries &&
            s->hash == of->hash)
            return s->order;
    }
    return NULL;
}

static ritz_status store_order(const int64_t *order, stored_order *of)
{
    RITZ_CHECK_ROOM(lent->item, lent->count, lent->room);
    RITZ_CHECK_COPY(of->order, order, of->rows);
    lent->item[lent->count++] = *of;
    return RITZ_OK;
}

static ritz_status find_order(const ritz_sparse *A, int64_t **order)
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

ritz_status ritz_ordering_new(const ritz_sparse *A, int64_t **order)
{
    RITZ_OWN_ARRAY int64_t *found = NULL;
    stored_order of = {0};
    const int64_t *known = NULL;

    if (!lent)
        return find_order(A, order);
    of = describe_pattern(A);
    known = find_stored(&of);
    if (known)
        RITZ_CHECK_COPY(found, known, A->nrow);
    else
        RITZ_CHECK(find_order(A, &found));
    if (!known)
        RITZ_CHECK(store_order(found, &of));
    RITZ_MOVE(*order, found);
    return RITZ_OK;
}

/* --- substructures -------------------------------------------------------- */

/* Nodes as CHOLMOD numbers them: the parent of each node and the node of each
   group. */
typedef struct node_tree {
    int64_t count;
    int64_t *parent, *of;
} node_tree;

static void node_tree_free(node_tree *t)
{
    RITZ_FREE(t->parent, t->of);
}

static ritz_status dissect_groups(const grouping *g, const graph *G,
                                  int64_t leaf, node_tree *t)
{
    RITZ_OWN_ARRAY int64_t *order = NULL;
    cholmod_common common;
    cholmod_sparse view = view_graph(g, G);

    RITZ_CHECK_NEW(order, g->count);
    RITZ_CHECK_NEW(t->parent, g->count);
    RITZ_CHECK_NEW(t->of, g->count);
    cholmod_l_start(&common);
    common.print = 0;
    common.current = 0;
    common.method[0].nd_small = (size_t)(leaf < 4 ? 4 : leaf);
    common.method[0].nd_components = 1;
    common.method[0].nd_camd = 0;
    t->count = cholmod_l_nested_dissection(&view, NULL, 0, order, t->parent,
                                           t->of, &common);
    cholmod_l_finish(&common);
    RITZ_REFUSE_IF(t->count < 0, RITZ_ERR_MEMORY,
                   "no memory to dissect %" PRId64 " groups of rows", g->count);
    return RITZ_OK;
}

/* place[c] := position of node c in a postorder of the tree; D->parent and
   D->begin follow. */
static ritz_status number_nodes(const node_tree *t, ritz_dissection *D,
                                int64_t *place)
{
    RITZ_OWN_ARRAY int64_t *child = NULL, *next = NULL;
    int64_t count = 0;
    int64_t at = -1;

    RITZ_CHECK_NEW(child, t->count + 1); /* [0]: the roots, [c + 1]: of c */
    RITZ_CHECK_NEW(next, t->count);
    for (int64_t c = 0; c <= t->count; c++)
        child[c] = -1;
    for (int64_t c = t->count - 1; c >= 0; c--) {
        next[c] = child[t->parent[c] + 1];
        child[t->parent[c] + 1] = c;
    }
    while (at >= 0 || child[0] >= 0) {
        const int64_t down = child[at + 1];

        if (down >= 0) { /* descend to the next child that is not numbered */
            child[at + 1] = next[down];
            D->begin[down] = count; /* by the node's old number, for now */
            at = down;
            continue;
        }
        place[at] = count++;
        at = t->parent[at];
    }
    memcpy(next, D->begin, (size_t)t->count * sizeof *next);
    for (int64_t c = 0; c < t->count; c++) {
        D->begin[place[c]] = next[c];
        D->parent[place[c]] = t->parent[c] < 0 ? -1 : place[t->parent[c]];
    }
    return RITZ_OK;
}

/* D->row and D->first, by counting the rows of each node. */
static void sort_rows(const grouping *g, const node_tree *t,
                      const int64_t *place, ritz_dissection *D)
{
    for (int64_t i = 0; i < D->rows; i++)
        D->first[place[t->of[g->of[i]]] + 1]++;
    for (int64_t s = 0; s < D->nodes; s++)
        D->first[s + 1] += D->first[s];
    for (int64_t i = 0; i < D->rows; i++)
        D->row[D->first[place[t->of[g->of[i]]]]++] = i;
    for (int64_t s = D->nodes; s > 0; s--)
        D->first[s] = D->first[s - 1];
    D->first[0] = 0;
}

ritz_status ritz_dissection_new(const ritz_sparse *A, int64_t leaf,
                                ritz_dissection *out)
{
    RITZ_OWN(grouping) g = {0};
    RITZ_OWN(graph) G = {0};
    RITZ_OWN(node_tree) t = {0};
    RITZ_OWN(ritz_dissection) D = {.rows = A->nrow};
    RITZ_OWN_ARRAY int64_t *place = NULL;

    RITZ_CHECK(group_rows(A, &g));
    RITZ_CHECK(join_groups(A, &g, &G));
    if (A->nrow > 0)
        RITZ_CHECK(dissect_groups(&g, &G, leaf * g.count / A->nrow, &t));
    D.nodes = t.count;
    RITZ_CHECK_NEW(place, D.nodes);
    RITZ_CHECK_NEW(D.row, D.rows);
    RITZ_CHECK_NEW(D.first, D.nodes + 1);
    RITZ_CHECK_NEW(D.parent, D.nodes);
    RITZ_CHECK_NEW(D.begin, D.nodes);
    RITZ_CHECK(number_nodes(&t, &D, place));
    sort_rows(&g, &t, place, &D);
    RITZ_MOVE(*out, D);
    return RITZ_OK;
}

void ritz_dissection_free(ritz_dissection *D)
{
    RITZ_FREE(D->row, D->first, D->parent, D->begin);
    *D = (ritz_dissection){0};
}
