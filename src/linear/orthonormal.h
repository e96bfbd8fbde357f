/* Columns V that are orthonormal in a matrix W, and grow block by block. */
#ifndef RITZ_LINEAR_ORTHONORMAL_H
#define RITZ_LINEAR_ORTHONORMAL_H

#include <ritz/matrix.h>

#include <stdbool.h>

typedef struct ritz_orthonormal {
    int64_t count;        /* columns that are set; there may be room for more */
    ritz_dense V, WV;     /* n x room */
    double terms;         /* largest |v|'|W||v|, by which products by W are
                             rounded */
    const ritz_sparse *W; /* borrowed, symmetric; NULL: the identity */
    int64_t left;         /* of the last block: at least so many columns were
                             independent of V but not wanted; 0: none was */
    double tolerance;     /* of what is new in a column, relative, in W */
    int64_t expected;     /* columns that there will be, most likely; 0: not
                             known */
} ritz_orthonormal;

/**
 * Nothing yet, for @p n rows.
 *
 * @param[in] W  symmetric, definite on all that is appended; borrowed until
 *               free, NULL for the identity
 */
ritz_status ritz_orthonormal_new(int64_t n, const ritz_sparse *W,
                                 double tolerance, ritz_orthonormal *out);

/**
 * Append what a block adds to V, each column scaled to v'Wv = 1, the most
 * independent first; what depends on V or on the rest of the block is left out.
 *
 * @param[in,out] R      n x p, overwritten
 * @param[in]     most   append no more columns than this
 * @param[out]    taken  p, true for columns of R that gave one; NULL: not
 *                       wanted
 * @cost   O(n (count + p) p), twice; a product by W for the block, and two for
 *         each of the rounds that it takes
 */
ritz_status ritz_orthonormal_append(ritz_orthonormal *set, ritz_dense *R,
                                    int64_t most, bool *taken);

/**
 * As ritz_orthonormal_append, and also return the coordinates (WV)'R of the
 * original block in the columns of V.
 *
 * @param[out] at  count x p
 */
ritz_status ritz_orthonormal_express(ritz_orthonormal *set, ritz_dense *R,
                                     int64_t most, ritz_dense *at);

void ritz_orthonormal_free(ritz_orthonormal *set);

/**
 * Pivoted Cholesky of G, which it destroys: order[] are its pivots above @p
 * least, at most @p most, the largest first; how many there are. A pivot must
 * exceed another by the factor @p tie to be the larger one.
 */
int64_t ritz_pivots_find(ritz_dense *G, double least, double tie, int64_t most,
                         int64_t *order);

#endif
