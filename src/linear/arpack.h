/* Lanczos on the pencil K - sigma M, for ritz_eigen_sparse. */
#ifndef RITZ_LINEAR_ARPACK_H
#define RITZ_LINEAR_ARPACK_H

#include <ritz/matrix.h>

typedef struct ritz_shifted {
    const ritz_sparse *K, *M; /* borrowed */
    double sigma;
    ritz_factor *A; /* of K - sigma M */
} ritz_shifted;

/** How ritz_lanczos_lowest ended, if it did not fail. */
typedef enum ritz_lanczos_end {
    RITZ_LANCZOS_FOUND,
    RITZ_LANCZOS_SLOW,      /* not converged: sigma is badly placed */
    RITZ_LANCZOS_EXHAUSTED, /* there are fewer finite eigenvalues than asked */
} ritz_lanczos_end;

/**
 * Vectors of the @p k eigenvalues nearest above sigma, by ARPACK.
 *
 * @param[out] X     n x k, in no order; empty unless FOUND
 * @param[out] reach the k-th eigenvalue, or an estimate of it if SLOW
 */
ritz_status ritz_lanczos_lowest(const ritz_shifted *S, int64_t k, ritz_dense *X,
                                double *reach, ritz_lanczos_end *end);

#endif
