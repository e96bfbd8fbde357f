/* Residuals of eigenpairs of sparse matrices. */
#ifndef RITZ_LINEAR_RESIDUALS_H
#define RITZ_LINEAR_RESIDUALS_H

#include <ritz/matrix.h>

/**
 * Fill in the residual of each pair and the number of rigid modes, and give the
 * worst residual: NaN if one is.
 *
 * @cost  a pass over K and M for every eight pairs, on all threads
 */
ritz_status ritz_pairs_assess(const ritz_sparse *K, const ritz_sparse *M,
                              ritz_pairs *P, double *worst);

#endif
