/* Singular values of a product whose factors are known better than it is. */
#ifndef RITZ_LINEAR_PRODUCT_SVD_H
#define RITZ_LINEAR_PRODUCT_SVD_H

#include <ritz/matrix.h>

#include <stdbool.h>

/* X'Y = U diag(s) V' */
typedef struct ritz_product_svd {
    int64_t count; /* min of n, l and k */
    double *s;     /* count, descending */
    int64_t rank;  /* r: from here on they are below eps^2 of the largest, and
                      are given as 0 */
    ritz_dense U;  /* l x r, orthonormal columns */
    ritz_dense V;  /* k x r */
} ritz_product_svd;

/**
 * Small values are as accurate, relative to themselves, as X with rows of unit
 * length and Y with rows of any scaling are well conditioned: the product is
 * never formed and its values are found by Jacobi rotations.
 *
 * @param[in] X        n x l
 * @param[in] Y        n x k
 * @param[in] vectors  whether U and V are wanted
 * @return RITZ_ERR_ARGUMENT if they are of different height or not finite;
 *         RITZ_ERR_CONVERGENCE
 * @cost   O((n + k + l) min(k, l)^2) and some n k l
 * @see    [Drmac1998]
 */
ritz_status ritz_product_svd_new(const ritz_dense *X, const ritz_dense *Y,
                                 bool vectors, ritz_product_svd *out);

void ritz_product_svd_free(ritz_product_svd *svd);

#endif
