/*
 * Automated multilevel substructuring: many of the lowest eigenpairs,
 * approximately, from modes of substructures and of the interfaces between
 * them [BennighofLehoucq2004].
 */
#ifndef RITZ_LINEAR_AMLS_H
#define RITZ_LINEAR_AMLS_H

#include "linear/general.h"

/** How ritz_amls_lowest() divides the structure. */
typedef struct ritz_substructuring {
    int64_t leaf;  /* in: rows of a substructure that is not divided; 0: 200 */
    double cutoff; /* in: modes of substructures are kept up to this eigenvalue,
                      HUGE_VAL: all of them  [rad^2/s^2] */
    int64_t nodes; /* out: substructures and interfaces */
    int64_t order; /* out: modes kept, the order of the reduced matrix */
} ritz_substructuring;

/**
 * Approximations of the @p k lowest eigenpairs of K x = lambda M x, by the
 * Rayleigh-Ritz method in the space of substructure modes. Each lambda is an
 * upper bound of the eigenvalue of the same rank, and exact up to rounding if
 * all modes are kept.
 *
 * @param[in]  k      1 or more
 * @param[in]  S      K, M, and sigma below all eigenvalues; its factor is not
 *                    used
 * @param[out] X      n x k, M-orthonormal, by ascending eigenvalue; empty
 *                    unless *end is FOUND
 * @param[out] lambda k numbers, to be freed; NULL unless FOUND  [rad^2/s^2]
 * @param[out] end    FOUND; EXHAUSTED if fewer than k modes of substructures
 *                    are below the cutoff, or fewer than k have mass; SLOW if
 *                    a part of the structure is too densely connected to be
 *                    divided, or if the k-th theta = 1 / (lambda - sigma) is
 *                    lost in the rounding of the first
 * @return RITZ_ERR_SINGULAR if K - sigma M is not positive definite;
 *         RITZ_ERR_CONVERGENCE; RITZ_ERR_MEMORY, also if fronts and reduced
 *         matrix would exceed the limit of memory, as far as is known before
 * @cost   some three Cholesky factors with fronts held dense, the modes of each
 *         front, and an eigenvalue problem of the order of all modes kept;
 *         memory of about a factor, and X
 * @see    [BennighofLehoucq2004], [GaoLiYangBai2008]
 */
ritz_status ritz_amls_lowest(const ritz_shifted *S, int64_t k,
                             ritz_substructuring *how, ritz_dense *X,
                             double **lambda, ritz_lanczos_end *end);

#endif
