/*
 * The pencil K - sigma M and what is done with its factor: the parts of
 * ritz_eigen_sparse.
 */
#ifndef RITZ_LINEAR_SHIFTED_H
#define RITZ_LINEAR_SHIFTED_H

#include <ritz/matrix.h>

#include <stdbool.h>

typedef struct ritz_shifted {
    const ritz_sparse *K, *M; /* borrowed */
    double sigma;
    ritz_factor *A; /* of K - sigma M */
} ritz_shifted;

typedef struct ritz_survey {
    double typical; /* median of K_jj / M_jj, 1 if there is none */
    int64_t *heavy; /* columns of M that are not zero */
    int64_t num_heavy;
} ritz_survey;

/** Look through a pencil. The caller frees out->heavy. */
ritz_status ritz_shifted_survey(const ritz_sparse *K, const ritz_sparse *M,
                                ritz_survey *out);

/** Set residual and num_rigid from Phi and lambda; return the worst residual.
 */
double ritz_shifted_assess(const ritz_shifted *S, ritz_pairs *P);

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
 * @param[out] reach the k-th eigenvalue, or what is known of it if SLOW
 */
ritz_status ritz_lanczos_lowest(const ritz_shifted *S, int64_t k, ritz_dense *X,
                                double *reach, ritz_lanczos_end *end);

/**
 * Vectors of all finite eigenvalues, where only the @p count columns @p heavy
 * of M are not zero: A is condensed to them. X is n x rank M.
 */
ritz_status ritz_condensed_all(const ritz_shifted *S, int64_t count,
                               const int64_t *heavy, ritz_dense *X);

/**
 * One inverse iteration and Rayleigh-Ritz: X becomes M-orthonormal, lambda
 * ascending.
 */
ritz_status ritz_shifted_polish(const ritz_shifted *S, ritz_dense *X,
                                double *lambda);

#endif
