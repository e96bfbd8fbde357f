#define _DEFAULT_SOURCE /* NOLINT: declares madvise */
#include "linear/packed.h"

#include "base/alloc.h"
#include "base/memory.h"
#include "base/team.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum {
    HUGE_PAGE = 2 << 20, /* bytes */
    SHARE = 10,          /* subtrees for each thread, to balance their work */
    OVERHEAD = 200,      /* time for a supernode as such, in entries of L */
    DISCARD = HUGE_PAGE, /* bytes of L after which their pages are returned */
};

/* The elimination tree of supernodes while L is packed. */
typedef struct tree {
    const cholmod_factor *L;
    int64_t count;
    int64_t *parent; /* of each supernode, -1 for a root */
    double *entries; /* in the subtree of each */
    int *owner;      /* thread of each supernode, -1 for the top */
    int32_t *place;  /* of each row among those of the top; -1: not there */
    int64_t *begin;  /* supernode s: block columns [begin[s], begin[s + 1]) */
} tree;

static void tree_free(tree *t)
{
    RITZ_FREE(t->parent, t->entries, t->owner, t->place, t->begin);
}

/* A supernode: consecutive columns of L with the same rows below them. */
typedef struct supernode {
    int64_t first, cols, rows;
    const int64_t *row;
    double *values; /* rows x cols */
} supernode;

static supernode supernode_of(const cholmod_factor *L, int64_t s)
{
    const int64_t *super = L->super, *pi = L->pi, *px = L->px;
    const int64_t *row = L->s;
    double *x = L->x;

    return (supernode){super[s], super[s + 1] - super[s], pi[s + 1] - pi[s],
                       row + pi[s], x + px[s]};
}

/* Find the parent of each supernode and the entries of L in its subtree. */
static ritz_status survey_tree(tree *t)
{
    const cholmod_factor *L = t->L;
    RITZ_OWN_ARRAY int64_t *of = NULL; /* supernode of each column */

    RITZ_CHECK_NEW(of, (int64_t)L->n);
    RITZ_CHECK_NEW(t->parent, t->count);
    RITZ_CHECK_NEW(t->entries, t->count);
    for (int64_t s = 0; s < t->count; s++) {
        const supernode node = supernode_of(L, s);

        for (int64_t j = 0; j < node.cols; j++)
            of[node.first + j] = s;
    }
    for (int64_t s = 0; s < t->count; s++) {
        const supernode node = supernode_of(L, s);

        t->entries[s] += (double)(node.cols * node.rows + OVERHEAD);
        t->parent[s] =
            node.rows > node.cols ? of[node.row[node.cols]] : (int64_t)-1;
        if (t->parent[s] >= 0)
            t->entries[t->parent[s]] += t->entries[s];
    }
    return RITZ_OK;
}

/*
 * Choose the owner of each supernode. A subtree that has at most 1 / (SHARE
 * threads) of all entries goes to the thread with the least work so far, from
 * the last supernode to the first; the supernodes above these subtrees are the
 * top. With one thread there is no top.
 */
static ritz_status share_tree(ritz_supernodal *S, tree *t)
{
    RITZ_OWN_ARRAY double *load = NULL;
    double whole = 0.0;

    RITZ_CHECK_NEW(load, S->threads);
    RITZ_CHECK_NEW(t->owner, t->count);
    for (int64_t s = 0; s < t->count; s++)
        whole += t->parent[s] < 0 ? t->entries[s] : 0.0;
    for (int64_t s = t->count - 1; s >= 0; s--) {
        const int64_t parent = t->parent[s];
        int least = 0;

        t->owner[s] = parent >= 0 ? t->owner[parent] : -1;
        if (t->owner[s] >= 0 ||
            (S->threads > 1 && t->entries[s] * SHARE * S->threads > whole))
            continue;
        for (int k = 1; k < S->threads; k++)
            least = load[k] < load[least] ? k : least;
        t->owner[s] = least;
        load[least] += t->entries[s];
    }
    return RITZ_OK;
}

/* Number the rows of the top, ascending: t->place and S->top_row. */
static ritz_status number_top(ritz_supernodal *S, tree *t)
{
    RITZ_CHECK_NEW(t->place, S->n);
    for (int64_t s = 0; s < t->count; s++)
        S->num_top += t->owner[s] < 0 ? supernode_of(t->L, s).cols : 0;
    RITZ_CHECK_NEW(S->top_row, S->num_top);
    S->num_top = 0;
    for (int64_t s = 0; s < t->count; s++) {
        const supernode node = supernode_of(t->L, s);

        for (int64_t j = 0; j < node.cols; j++) {
            t->place[node.first + j] = -1;
            if (t->owner[s] >= 0)
                continue;
            t->place[node.first + j] = (int32_t)S->num_top;
            S->top_row[S->num_top++] = (int32_t)(node.first + j);
        }
    }
    return RITZ_OK;
}

/* How many numbers a packed diagonal block has. It is a lower triangle: the
   panel of the rows from r on ends with column r + 7. */
static int64_t diagonal_size(int64_t cols)
{
    int64_t size = 0;

    for (int64_t r = 0; r < cols; r += RITZ_TILE)
        size += RITZ_TILE * (r + RITZ_TILE < cols ? r + RITZ_TILE : cols);
    return size;
}

static int64_t blocks_in(const supernode *node)
{
    return (node->cols + RITZ_TILE_COLS - 1) / RITZ_TILE_COLS;
}

/* The size of block column k of a supernode; its row and values are NULL. */
static ritz_block_column block_of(const supernode *node, int64_t k)
{
    const int64_t from = k * RITZ_TILE_COLS;
    const int64_t left = node->cols - from;
    const int64_t cols = left < RITZ_TILE_COLS ? left : RITZ_TILE_COLS;

    return (ritz_block_column){.first = node->first + from,
                               .cols = cols,
                               .below = node->rows - from - cols};
}

static int64_t block_size(const ritz_block_column *b)
{
    return diagonal_size(b->cols) +
           RITZ_TILE * ritz_panels_of(b->below) * b->cols;
}

/* Allocate room for all values, in huge pages where the system has them. Only
   those are asked for that the values fill, so that the last one takes no more
   memory than it needs. */
static ritz_status map_values(ritz_supernodal *S, int64_t count)
{
    const size_t page = HUGE_PAGE;
    const size_t used = (size_t)count * sizeof(double);
    const size_t bytes = (used + page) / page * page;
    void *map = MAP_FAILED;

    if (!ritz_alloc_denied || !ritz_alloc_denied())
        map = mmap(NULL, bytes, PROT_READ | PROT_WRITE,
                   MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    RITZ_REFUSE_IF(map == MAP_FAILED, RITZ_ERR_MEMORY,
                   "no memory for a factor of %zu MB", bytes >> 20);
    /* a refusal costs only speed */
    (void)madvise(map, used / page * page, MADV_HUGEPAGE);
    S->values = map;
    S->bytes = bytes;
    return RITZ_OK;
}

/* Set the sizes of all block columns, and add up their values and rows. */
static ritz_status lay_out_blocks(ritz_supernodal *S, tree *t, int64_t *values,
                                  int64_t *rows)
{
    RITZ_CHECK_NEW(t->begin, t->count + 1);
    for (int64_t s = 0; s < t->count; s++) {
        const supernode node = supernode_of(t->L, s);

        t->begin[s + 1] = t->begin[s] + blocks_in(&node);
    }
    S->num_blocks = t->begin[t->count];
    RITZ_CHECK_NEW(S->block, S->num_blocks);
    for (int64_t s = 0; s < t->count; s++) {
        const supernode node = supernode_of(t->L, s);
        ritz_block_column *b = S->block + t->begin[s];

        for (int64_t k = 0; k < blocks_in(&node); k++) {
            b[k] = block_of(&node, k);
            *values += block_size(&b[k]);
        }
        *rows += node.rows;
    }
    return RITZ_OK;
}

/* Point each block column to its rows, as ritz_block_column.row has them, and
   to room for its values. */
static ritz_status place_blocks(ritz_supernodal *S, const tree *t, int64_t rows)
{
    double *values = S->values;
    int32_t *row = NULL;

    RITZ_CHECK_NEW(S->row, rows);
    row = S->row;
    for (int64_t s = 0; s < t->count; s++) {
        const supernode node = supernode_of(t->L, s);
        ritz_block_column *b = S->block + t->begin[s];

        for (int64_t k = 0; k < node.rows; k++)
            row[k] = t->place[node.row[k]] < 0 ? (int32_t)node.row[k]
                                               : ~t->place[node.row[k]];
        for (int64_t k = 0; k < blocks_in(&node); k++) {
            b[k].row = row + (node.rows - b[k].below);
            b[k].diagonal = values;
            b[k].panel = values + diagonal_size(b[k].cols);
            values += block_size(&b[k]);
        }
        row += node.rows;
    }
    return RITZ_OK;
}

/* D := L^-1 of a lower triangle, n x n; D is zero on entry. */
static void invert_triangle(int64_t n, const double *L, int64_t stride,
                            double *D)
{
    for (int64_t j = 0; j < n; j++) {
        double *d = D + j * n;

        d[j] = 1.0;
        for (int64_t k = j; k < n; k++) {
            const double *l = L + k * stride;

            d[k] /= l[k];
            for (int64_t i = k + 1; i < n; i++)
                d[i] -= l[i] * d[k];
        }
    }
}

/* Pack a column-major matrix, rows x cols, into panels of eight rows. Those of
   a lower triangle end with the last column that is not zero in their rows. */
static void pack_panels(int64_t rows, int64_t cols, bool triangle,
                        const double *from, int64_t stride, double *to)
{
    for (int64_t r = 0; r < rows; r += RITZ_TILE) {
        const int64_t count = rows - r < RITZ_TILE ? rows - r : RITZ_TILE;
        const int64_t end = triangle ? r + count : cols;

        for (int64_t j = 0; j < end; j++, to += RITZ_TILE)
            for (int64_t i = 0; i < count; i++)
                to[i] = from[r + i + j * stride];
    }
}

static void pack_block(const supernode *node, const ritz_block_column *b,
                       double *to)
{
    const int64_t at = b->first - node->first;
    const double *L = node->values + at + at * node->rows;
    double D[RITZ_TILE_COLS * RITZ_TILE_COLS];

    memset(D, 0, (size_t)(b->cols * b->cols) * sizeof *D);
    invert_triangle(b->cols, L, node->rows, D);
    pack_panels(b->cols, b->cols, true, D, b->cols, to);
    pack_panels(b->below, b->cols, false, L + b->cols, node->rows,
                to + diagonal_size(b->cols));
}

/* Return the pages from *from on to the system, up to the last end of a huge
   page before `to`, which becomes *from: so none has to be split. */
static void discard_pages(char **from, const char *to)
{
    const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
    const uintptr_t begin = ((uintptr_t)*from + page - 1) / page * page;
    const uintptr_t end = (uintptr_t)to / HUGE_PAGE * HUGE_PAGE;

    if (end <= begin)
        return;
    *from += begin - (uintptr_t)*from;
    (void)madvise(*from, end - begin, MADV_DONTNEED); /* costs only memory */
    *from += end - begin;
}

typedef struct packing {
    ritz_supernodal *S;
    const tree *t;
} packing;

/* The supernode from which on a thread packs: each has the same share of L. */
static int64_t supernode_behind(const tree *t, int64_t thread, int64_t threads)
{
    const int64_t *px = t->L->px;
    const int64_t at = px[t->count] * thread / threads;
    int64_t low = 0;
    int64_t high = t->count;

    while (low < high) {
        const int64_t middle = (low + high) / 2;

        if (px[middle + 1] > at)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static void pack_part(int thread, int threads, void *task)
{
    const packing *P = task;
    const tree *t = P->t;
    const int64_t from = supernode_behind(t, thread, threads);
    const int64_t to = thread + 1 == threads
                           ? t->count
                           : supernode_behind(t, thread + 1, threads);
    char *read = NULL;

    for (int64_t s = from; s < to; s++) {
        const supernode node = supernode_of(t->L, s);
        char *end = (char *)(node.values + node.rows * node.cols);

        read = read ? read : (char *)node.values;
        for (int64_t k = t->begin[s]; k < t->begin[s + 1]; k++) {
            const ritz_block_column *b = &P->S->block[k];

            pack_block(&node, b, P->S->values + (b->diagonal - P->S->values));
        }
        if (end - read >= DISCARD)
            discard_pages(&read, end);
    }
}

/* List the block columns of each thread and those of the top. */
static ritz_status list_blocks(ritz_supernodal *S, const tree *t)
{
    RITZ_CHECK_NEW(S->crew, S->threads);
    RITZ_CHECK_NEW(S->shared, S->num_blocks);
    for (int k = 0; k < S->threads; k++)
        RITZ_CHECK_NEW(S->crew[k].block, S->num_blocks);
    for (int64_t s = 0; s < t->count; s++)
        for (int64_t b = t->begin[s]; b < t->begin[s + 1]; b++) {
            ritz_solve_crew *c = S->crew + (t->owner[s] < 0 ? 0 : t->owner[s]);

            if (t->owner[s] < 0)
                S->shared[S->num_shared++] = b;
            else
                c->block[c->num_blocks++] = b;
        }
    return RITZ_OK;
}

/* Allocate the workspace of all solves, so that a solve cannot fail. */
static ritz_status make_room(ritz_supernodal *S)
{
    const int64_t block = (int64_t)RITZ_TILE_COLS * RITZ_SOLVE_WIDTH;

    RITZ_CHECK_NEW(S->top, 2 * S->num_top * RITZ_SOLVE_WIDTH);
    for (int k = 0; k < S->threads; k++) {
        ritz_solve_crew *c = &S->crew[k];

        RITZ_CHECK_NEW(c->top, S->num_top * RITZ_SOLVE_WIDTH);
        RITZ_CHECK_NEW(c->z, 4 * block);
        c->sum[0] = c->z + block;
        c->sum[1] = c->z + 2 * block;
        c->rest = c->z + 3 * block;
    }
    return RITZ_OK;
}

ritz_status ritz_supernodal_pack(const cholmod_factor *L, ritz_supernodal *S)
{
    RITZ_OWN(tree) t = {.L = L, .count = (int64_t)L->nsuper};
    int64_t values = 0;
    int64_t rows = 0;

    RITZ_CHECK(survey_tree(&t));
    RITZ_CHECK(share_tree(S, &t));
    RITZ_CHECK(number_top(S, &t));
    RITZ_CHECK(lay_out_blocks(S, &t, &values, &rows));
    RITZ_CHECK(list_blocks(S, &t));
    RITZ_CHECK(make_room(S));
    RITZ_CHECK(map_values(S, values));
    RITZ_CHECK(place_blocks(S, &t, rows));
    ritz_team_run(S->threads, pack_part, &(packing){S, &t});
    ritz_memory_count_mapped((int64_t)S->bytes);
    S->packed = true;
    return RITZ_OK;
}
