#include "linear/supernodal.h"

#include "base/alloc.h"
#include "base/memory.h"
#include "base/team.h"
#include "linear/packed.h"

#include <string.h>
#include <sys/mman.h>

enum { WORTHWHILE = 400000 }; /* one thread for each so many entries of L */

ritz_status ritz_supernodal_new(cholmod_factor *L, const double *sign,
                                ritz_supernodal **out)
{
    RITZ_OWN(ritz_supernodal) *S = NULL;

    RITZ_REFUSE_IF(L->n > INT32_MAX - 1, RITZ_ERR_ARGUMENT,
                   "%zu rows are more than a factor can have", L->n);
    RITZ_CHECK_NEW(S, 1);
    S->n = (int64_t)L->n;
    S->tiles = ritz_tiles_here();
    S->threads = ritz_team_ready(1 + (int64_t)L->xsize / WORTHWHILE);
    if (sign)
        RITZ_CHECK_COPY(S->sign, sign, S->n);
    if (S->n > 0)
        RITZ_CHECK(ritz_supernodal_pack(L, S));
    RITZ_MOVE(*out, S);
    return RITZ_OK;
}

typedef struct solving {
    ritz_supernodal *S;
    const ritz_tile_width *tile;
    double *x;
} solving;

static bool all_zero(const double *x, int64_t count)
{
    for (int64_t i = 0; i < count; i++)
        if (x[i] != 0.0)
            return false;
    return true;
}

/* x := L^-1 x in the rows of this thread's subtrees. Forces on a few dofs leave
   most of them at zero. */
static void descend_subtrees(const solving *s, const ritz_solve_crew *c)
{
    const int64_t width = s->tile->width;

    for (int64_t k = 0; k < c->num_blocks; k++) {
        const ritz_block_column *b = &s->S->block[c->block[k]];
        double *x = s->x + b->first * width;

        if (all_zero(x, b->cols * width))
            continue;
        s->tile->lower(b, x, c->z);
        memcpy(x, c->z, (size_t)(b->cols * width) * sizeof *x);
        s->tile->scatter(b, 0, ritz_panels_of(b->below), c->z, s->x, c->top);
    }
}

/* x := S x, x the rows of one block column. */
static void apply_signs(const ritz_supernodal *S, const ritz_block_column *b,
                        int64_t width, double *x)
{
    if (!S->sign)
        return;
    for (int64_t j = 0; j < b->cols; j++)
        for (int64_t c = 0; c < width; c++)
            x[j * width + c] *= S->sign[b->first + j];
}

/* x := L'^-1 S x in the same rows, with the solution of the top in c->top. */
static void ascend_subtrees(const solving *s, const ritz_solve_crew *c)
{
    const int64_t width = s->tile->width;

    for (int64_t k = c->num_blocks; k-- > 0;) {
        const ritz_block_column *b = &s->S->block[c->block[k]];
        double *x = s->x + b->first * width;
        double *sum = c->rest;

        apply_signs(s->S, b, width, x);
        memset(sum, 0, (size_t)(b->cols * width) * sizeof *sum);
        s->tile->gather(b, 0, ritz_panels_of(b->below), s->x, c->top, sum);
        for (int64_t i = 0; i < b->cols * width; i++)
            sum[i] = x[i] - sum[i];
        s->tile->upper(b, sum, c->z);
        memcpy(x, c->z, (size_t)(b->cols * width) * sizeof *x);
    }
}

/* Index, among the rows of the top, of the first row of a block column of the
   top. Its other rows follow, as consecutive rows stay so. */
static int64_t place_in_top(const ritz_supernodal *S,
                            const ritz_block_column *b)
{
    int64_t low = 0;
    int64_t high = S->num_top;

    while (low < high) {
        const int64_t middle = (low + high) / 2;

        if (S->top_row[middle] < b->first)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The work of one thread in block column k of the top. */
typedef struct shared_part {
    const ritz_block_column *b;
    int64_t at;       /* index in S->top of its first number */
    int64_t from, to; /* panels of this thread */
} shared_part;

static shared_part part_of_shared(const solving *s, int64_t k, int thread,
                                  int threads)
{
    const ritz_supernodal *S = s->S;
    shared_part part = {.b = &S->block[S->shared[k]]};

    part.at = place_in_top(S, part.b) * s->tile->width;
    ritz_team_part(ritz_panels_of(part.b->below), thread, threads, &part.from,
                   &part.to);
    return part;
}

/* S->top := right-hand sides of this thread's rows of the top, minus what the
   subtrees of all threads subtract from them (c->top is negative). */
static void collect_top(const solving *s, int thread, int threads)
{
    const ritz_supernodal *S = s->S;
    const int64_t width = s->tile->width;
    int64_t from = 0;
    int64_t to = 0;

    ritz_team_part(S->num_top, thread, threads, &from, &to);
    for (int64_t k = from; k < to; k++)
        for (int64_t c = 0; c < width; c++) {
            double sum = s->x[S->top_row[k] * width + c];

            for (int t = 0; t < threads; t++)
                sum += S->crew[t].top[k * width + c];
            S->top[k * width + c] = sum;
        }
}

/*
 * Forward substitution in the top. Every thread solves with the diagonal block
 * itself, which takes less time than waiting for another thread to do so, and
 * subtracts the product with its own panels. Thread 0 stores the solution
 * behind the right-hand sides.
 */
static void descend_top(const solving *s, int thread, int threads)
{
    const ritz_supernodal *S = s->S;
    const int64_t width = s->tile->width;
    const ritz_solve_crew *c = &S->crew[thread];
    double *solved = S->top + S->num_top * width;

    for (int64_t k = 0; k < S->num_shared; k++) {
        const shared_part part = part_of_shared(s, k, thread, threads);
        const ritz_block_column *b = part.b;

        s->tile->lower(b, S->top + part.at, c->z);
        if (thread == 0)
            memcpy(solved + part.at, c->z,
                   (size_t)(b->cols * width) * sizeof *c->z);
        s->tile->scatter(b, part.from, part.to, c->z, NULL, S->top);
        ritz_team_meet(threads);
    }
}

/*
 * Backward substitution in the top. Each thread sums over its own panels; then
 * each adds the sums of all threads and solves with the diagonal block, so that
 * each has the whole solution in its c->top. Two arrays of sums are used in
 * turn, so that no thread writes to one which another thread may still be
 * reading.
 */
static void ascend_top(const solving *s, int thread, int threads)
{
    const ritz_supernodal *S = s->S;
    const int64_t width = s->tile->width;
    const ritz_solve_crew *c = &S->crew[thread];
    const double *solved = S->top + S->num_top * width;

    for (int64_t k = S->num_shared; k-- > 0;) {
        const shared_part part = part_of_shared(s, k, thread, threads);
        const int64_t count = part.b->cols * width;
        double *sum = c->sum[k % 2];
        double *rest = c->rest;

        memset(sum, 0, (size_t)count * sizeof *sum);
        s->tile->gather(part.b, part.from, part.to, NULL, c->top, sum);
        ritz_team_meet(threads);
        memcpy(rest, solved + part.at, (size_t)count * sizeof *rest);
        apply_signs(S, part.b, width, rest);
        for (int t = 0; t < threads; t++)
            for (int64_t i = 0; i < count; i++)
                rest[i] -= S->crew[t].sum[k % 2][i];
        s->tile->upper(part.b, rest, c->z);
        memcpy(c->top + part.at, c->z, (size_t)count * sizeof *rest);
    }
}

/* Copy the solution of this thread's rows of the top to x. */
static void return_top(const solving *s, int thread, int threads)
{
    const ritz_supernodal *S = s->S;
    const int64_t width = s->tile->width;
    int64_t from = 0;
    int64_t to = 0;

    ritz_team_part(S->num_top, thread, threads, &from, &to);
    for (int64_t k = from; k < to; k++)
        memcpy(s->x + S->top_row[k] * width, S->crew[thread].top + k * width,
               (size_t)width * sizeof *s->x);
}

static void solve_part(int thread, int threads, void *task)
{
    const solving *s = task;
    const ritz_solve_crew *c = &s->S->crew[thread];
    const int64_t size = s->S->num_top * s->tile->width;

    memset(c->top, 0, (size_t)size * sizeof *c->top);
    descend_subtrees(s, c);
    if (threads > 1) {
        ritz_team_meet(threads);
        collect_top(s, thread, threads);
        ritz_team_meet(threads);
        descend_top(s, thread, threads);
        ascend_top(s, thread, threads);
        return_top(s, thread, threads);
    }
    ascend_subtrees(s, c);
}

void ritz_supernodal_solve(ritz_supernodal *S, int64_t width, double *x)
{
    const int k = width == S->tiles->of[0].width ? 0 : 1;

    if (S->n > 0)
        ritz_team_run(S->threads, solve_part,
                      &(solving){S, &S->tiles->of[k], x});
}

ritz_status ritz_supernodal_spill(ritz_supernodal *S)
{
    if (S->spill.bytes > 0 || S->bytes == 0)
        return RITZ_OK;
    return ritz_spill_put("the factor", S->values, S->bytes, &S->spill);
}

ritz_status ritz_supernodal_fetch(ritz_supernodal *S)
{
    return ritz_spill_fetch(&S->spill, S->values);
}

int ritz_supernodal_threads(const ritz_supernodal *S)
{
    return S->threads;
}

void ritz_supernodal_free(ritz_supernodal **S)
{
    if (!*S)
        return;
    for (int k = 0; (*S)->crew && k < (*S)->threads; k++)
        RITZ_FREE((*S)->crew[k].block, (*S)->crew[k].top, (*S)->crew[k].z);
    RITZ_FREE((*S)->block, (*S)->row, (*S)->top_row, (*S)->top, (*S)->shared,
              (*S)->crew, (*S)->sign);
    if ((*S)->packed && (*S)->spill.bytes == 0)
        ritz_memory_count_mapped(-(int64_t)(*S)->bytes);
    ritz_spill_free(&(*S)->spill);
    if ((*S)->values)
        munmap((*S)->values, (*S)->bytes);
    free(*S);
    *S = NULL;
}
