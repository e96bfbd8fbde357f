/* What is independent in a block of columns, by the Gram matrix R'WR. */
#ifndef RITZ_BASES_GRAM_H
#define RITZ_BASES_GRAM_H

#include <ritz/sparse.h>

/** WR := W R; W NULL is the identity. */
ritz_status ritz_gram_weigh(const ritz_sparse *W, const ritz_dense *R,
                            ritz_dense *WR);

/**
 * Pivoted Cholesky of G, which it destroys, diagonal one: order[] are its
 * strong pivots, at most @p most, the largest first.
 *
 * @return how many there are
 */
int64_t ritz_gram_pivots(ritz_dense *G, int64_t most, int64_t *order);

/**
 * Q := Q L^-T with Q'WQ = L L', twice, and WQ with it.
 *
 * @param[in] Q  far from dependent: strong pivots
 * @return RITZ_ERR_CONVERGENCE if it is not
 */
ritz_status ritz_gram_normalise(const ritz_sparse *W, ritz_dense *Q,
                                ritz_dense *WQ);

#endif
