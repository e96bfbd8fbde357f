/* Symmetric matrices whose memory is needed for something else for a while. */
#ifndef RITZ_LINEAR_FOLDED_H
#define RITZ_LINEAR_FOLDED_H

#include "base/alloc.h"

#include <ritz/matrix.h>

/** The lower triangle of a symmetric matrix, 12 bytes an entry, in place of both
 * triangles at 16 bytes an entry; {0}: nothing is folded. */
typedef struct ritz_folded {
    int64_t n;
    int64_t *colptr; /* of both triangles */
    int32_t *row;    /* of the entries on and below the diagonal, by columns */
    double *val;
} ritz_folded;

/**
 * Fold A in its own memory, of which the rest is freed. A is empty then. A
 * matrix that is not exactly symmetric, entry by entry, stays as it is, and
 * @p out stays empty.
 *
 * @return RITZ_ERR_MEMORY, and A stays as it is
 * @cost   O(n + entries) time, n numbers of workspace
 */
ritz_status ritz_folded_new(ritz_sparse *A, ritz_folded *out);

/**
 * A := the matrix that was folded, with the same bits. Does nothing if nothing
 * was.
 *
 * @param[in,out] F  emptied, but not on failure
 * @return RITZ_ERR_MEMORY
 * @cost   O(n + entries) time, n numbers of workspace; the arrays become longer
 *         where they are if the memory behind them is free
 */
ritz_status ritz_folded_open(ritz_folded *F, ritz_sparse *A);

void ritz_folded_free(ritz_folded *F);

/** Bytes by which a matrix of so many entries is smaller while it is folded. */
static inline int64_t ritz_folded_saves(int64_t n, int64_t entries)
{
    return 16 * entries - 12 * (entries + n) / 2;
}

/** Bytes by which it will grow when it is opened; 0 if nothing is folded. */
static inline int64_t ritz_folded_growth(const ritz_folded *F)
{
    return F->colptr ? ritz_folded_saves(F->n, F->colptr[F->n]) : 0;
}

#endif
