#include "linear/block_list.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

enum { B = RITZ_BLOCK, SQUARE = RITZ_SQUARE, WINDOW = RITZ_BLOCK_WINDOW };

static size_t bytes_of(int64_t rows)
{
    return (size_t)(rows * B) * sizeof(double);
}

ritz_status ritz_block_list_new(int64_t n, int64_t count, ritz_block_list *out)
{
    RITZ_CHECK_NEW(out->at, count);
    out->n = n;
    out->count = count;
    out->held = count;
    return RITZ_OK;
}

void ritz_block_list_free(ritz_block_list *V)
{
    ritz_block_list_shorten(V, 0);
    ritz_spill_free(&V->file);
    RITZ_FREE(V->at, V->window);
    *V = (ritz_block_list){0};
}

/* What does not fit into memory is lost with its file: for whoever goes on
   without a result that needs too much memory, the causes are the same. */
static ritz_status as_memory(ritz_status status)
{
    return status == RITZ_ERR_FILE ? RITZ_ERR_MEMORY : status;
}

ritz_status ritz_block_list_limit(ritz_block_list *V, int64_t held)
{
    RITZ_CHECK(as_memory(
        ritz_spill_open("the Lanczos basis",
                        (size_t)(V->count - held) * bytes_of(V->n), &V->file)));
    RITZ_CHECK_RAW(V->window, WINDOW * V->n * B);
    V->held = held;
    return RITZ_OK;
}

/* --- the file ------------------------------------------------------------- */

/* Byte of the file at which row @p r of block @p j begins. */
static int64_t place_of(const ritz_block_list *V, int64_t j, int64_t r)
{
    return (int64_t)bytes_of((j - V->held) * V->n + r);
}

/* Rows [r, r + rows) of block j of the file. */
static ritz_status read_rows(const ritz_block_list *V, int64_t j, int64_t r,
                             int64_t rows, double *to)
{
    return as_memory(
        ritz_spill_read(&V->file, place_of(V, j, r), bytes_of(rows), to));
}

static ritz_status write_rows(const ritz_block_list *V, int64_t j, int64_t r,
                              int64_t rows, const double *from)
{
    return as_memory(
        ritz_spill_write(&V->file, place_of(V, j, r), bytes_of(rows), from));
}

static ritz_status make_block(ritz_block_list *V, int64_t j)
{
    if (!V->at[j])
        V->at[j] = ritz_alloc_admitted(V->n * B, sizeof **V->at);
    return V->at[j] ? RITZ_OK : RITZ_ERR_MEMORY;
}

ritz_status ritz_block_list_put(ritz_block_list *V, int64_t j, bool exchange,
                                double **W)
{
    double *const block = *W;

    if (j >= V->held)
        return write_rows(V, j, 0, V->n, block);
    RITZ_CHECK(make_block(V, j));
    if (exchange) {
        *W = V->at[j];
        V->at[j] = block;
    } else {
        memcpy(V->at[j], block, bytes_of(V->n));
    }
    return RITZ_OK;
}

ritz_status ritz_block_list_move(ritz_block_list *V, int64_t from, int64_t to)
{
    const double *block = NULL;

    if (from < V->held && to < V->held) {
        double *other = V->at[to];

        V->at[to] = V->at[from];
        V->at[from] = other;
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_block_list_look(V, from, &block));
    if (to >= V->held)
        return write_rows(V, to, 0, V->n, block);
    RITZ_CHECK(make_block(V, to));
    memcpy(V->at[to], block, bytes_of(V->n));
    return RITZ_OK;
}

ritz_status ritz_block_list_look(const ritz_block_list *V, int64_t j,
                                 const double **out)
{
    *out = j < V->held ? V->at[j] : V->window;
    return j < V->held ? RITZ_OK : read_rows(V, j, 0, V->n, V->window);
}

void ritz_block_list_shorten(ritz_block_list *V, int64_t kept)
{
    for (int64_t j = kept; j < V->count; j++) {
        free(V->at[j]);
        V->at[j] = NULL;
    }
}

/* --- products ------------------------------------------------------------- */

/* Blocks of a list that a product reads at a time. */
typedef struct batch {
    int64_t first, count;
    double *const *at;
    double *in_window[WINDOW];
} batch;

/* The blocks from @p first on, of which none from @p end on: all of them that
   are in memory, or some of the file, which are read into the window. */
static ritz_status next_group(const ritz_block_list *V, int64_t first,
                              int64_t end, batch *g)
{
    g->first = first;
    g->count = (first < V->held && V->held < end ? V->held : end) - first;
    g->at = V->at + first;
    if (first < V->held)
        return RITZ_OK;
    g->count = g->count < WINDOW ? g->count : WINDOW;
    g->at = g->in_window;
    for (int64_t k = 0; k < g->count; k++) {
        g->in_window[k] = V->window + k * V->n * B;
        RITZ_CHECK(read_rows(V, first + k, 0, V->n, g->in_window[k]));
    }
    return RITZ_OK;
}

/* Where the coefficients of a batch begin among those of @p count blocks, for
   block @p q of X: they are in the order of ritz_blocks_project(). */
static int64_t place_in(const batch *g, int64_t first, int64_t count, int64_t q)
{
    return (q * count + g->first - first) * SQUARE;
}

ritz_status ritz_block_list_project(const ritz_block_list *V,
                                    const ritz_blocks *on, int64_t first,
                                    int64_t count, int64_t width,
                                    const double *X, double *C)
{
    const int64_t end = first + count;
    batch g = {0};

    if (end <= V->held) {
        ritz_blocks_project(on, count, V->at + first, width, X, C);
        return RITZ_OK;
    }
    for (int64_t j = first; j < end; j += g.count) {
        RITZ_CHECK(next_group(V, j, end, &g));
        for (int64_t q = 0; q < width; q++)
            ritz_blocks_project(on, g.count, g.at, 1, X + q * V->n * B,
                                C + place_in(&g, first, count, q));
    }
    return RITZ_OK;
}

ritz_status ritz_block_list_add(const ritz_block_list *V, const ritz_blocks *on,
                                int64_t first, int64_t count, int64_t width,
                                const double *C, double *X)
{
    const int64_t end = first + count;
    batch g = {0};

    if (end <= V->held) {
        ritz_blocks_add(on, count, V->at + first, width, C, X);
        return RITZ_OK;
    }
    for (int64_t j = first; j < end; j += g.count) {
        RITZ_CHECK(next_group(V, j, end, &g));
        for (int64_t q = 0; q < width; q++)
            ritz_blocks_add(on, g.count, g.at, 1,
                            C + place_in(&g, first, count, q),
                            X + q * V->n * B);
    }
    return RITZ_OK;
}

/* The addresses of rows [r, r + rows) of @p count blocks: in memory, or in the
   window, into which those of the file are read. */
static ritz_status read_strip(const ritz_block_list *V, int64_t r, int64_t rows,
                              int64_t count, double **at)
{
    for (int64_t j = 0; j < count; j++) {
        if (j < V->held) {
            at[j] = V->at[j] + r * B;
            continue;
        }
        at[j] = V->window + (j - V->held) * rows * B;
        RITZ_CHECK(read_rows(V, j, r, rows, at[j]));
    }
    return RITZ_OK;
}

ritz_status ritz_block_list_combine(const ritz_block_list *V,
                                    const ritz_blocks *on, int64_t count,
                                    int64_t kept, int64_t stride,
                                    const double *C, double *room)
{
    const int64_t away = count > V->held ? count - V->held : 0;
    const int64_t most = away > WINDOW ? WINDOW * V->n / away : V->n;
    RITZ_OWN_ARRAY double **at = NULL;
    ritz_blocks strip = *on;

    RITZ_CHECK_NEW(at, count);
    for (int64_t r = 0; r < V->n; r += most) {
        strip.n = V->n - r < most ? V->n - r : most;
        RITZ_CHECK(read_strip(V, r, strip.n, count, at));
        ritz_blocks_combine(&strip, count, kept, stride, C, room, at);
        for (int64_t g = V->held; g < kept; g++)
            RITZ_CHECK(write_rows(V, g, r, strip.n, at[g]));
    }
    return RITZ_OK;
}
