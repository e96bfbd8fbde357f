/* The number of negative eigenvalues of a sparse symmetric matrix, and of
 * eigenvalues of a pencil below a value. */
#ifndef RITZ_LINEAR_INERTIA_H
#define RITZ_LINEAR_INERTIA_H

#include <ritz/matrix.h>

/**
 * Negative pivots of A = L D L', by Sylvester's law of inertia the number of
 * negative eigenvalues. The factor is not kept, so that no solve tells whether
 * A is singular to working accuracy: an eigenvalue that is rounding counts as
 * negative or not.
 *
 * @param[in] order  of ritz_ordering_new(), NULL to find one
 * @return RITZ_ERR_SINGULAR if a pivot is rounding
 */
ritz_status ritz_inertia_negative(const ritz_sparse *A, const int64_t *order,
                                  int64_t *negative);

/**
 * ritz_eigen_count() with the order of rows of another factor of K and M.
 *
 * @param[in] order  as above
 */
ritz_status ritz_inertia_below(const ritz_sparse *K, const ritz_sparse *M,
                               double tau, const int64_t *order, int64_t *out);

/** ritz_ldl_new() with an order of rows, as above. */
ritz_status ritz_ldl_ordered(const ritz_sparse *A, const int64_t *order,
                             int64_t *negative, ritz_ldl **out);

#endif
