/*
 * Spectrum slicing: many of the lowest eigenpairs, one or two hundred at a
 * time, each time by block Lanczos with a shift among them
 * [GrimesLewisSimon1994].
 */
#ifndef RITZ_LINEAR_SLICES_H
#define RITZ_LINEAR_SLICES_H

#include "linear/general.h"

/** How ritz_slices_lowest() divides the spectrum. */
typedef struct ritz_slicing {
    int64_t side;   /* in: eigenvalues on each side of a shift; 0: 100 */
    int64_t slices; /* out: runs of block Lanczos */
    int64_t proven; /* out: so many of the lowest are verified by inertia */
} ritz_slicing;

/**
 * The @p k lowest eigenpairs of K x = lambda M x, and any higher ones that were
 * found with them. Inertia verifies that none is missing below the last shift;
 * above it nothing is verified, and with k up to 2 side nothing at all.
 *
 * @param[in,out] S      K, M, sigma below all eigenvalues, and the factor of
 *                       K - sigma M, which is taken over and freed; S->A is
 *                       NULL on return, also on failure
 * @param[out]    X      n x at least k, M-orthonormal, by ascending eigenvalue;
 *                       empty unless *end is FOUND
 * @param[out]    lambda eigenvalues of the columns of X, to be freed; NULL
 *                       unless *end is FOUND  [rad^2/s^2]
 * @param[out]    end    FOUND; EXHAUSTED if fewer than k eigenvalues seem to
 *                       exist; SLOW if the number of slices exceeds its limit,
 *                       or block Lanczos is slow in one of them
 * @return RITZ_ERR_CONVERGENCE if eigenvalues that were counted are not found,
 *         or vectors of two slices are not orthogonal; RITZ_ERR_SINGULAR if no
 *         shift has an accurate factor; RITZ_ERR_MEMORY
 * @cost   for each slice of 2 side eigenvalues: one factor, some 6 side / 8
 *         solves of eight right-hand sides, and 2 n (6 side)^2 operations to
 *         orthogonalise its basis; 2 n k^2 to orthogonalise slices against each
 *         other; memory for one factor, the vectors found and some 10 side more
 */
ritz_status ritz_slices_lowest(ritz_shifted *S, int64_t k,
                               ritz_slicing *slicing, ritz_dense *X,
                               double **lambda, ritz_lanczos_end *end);

/** Bytes that a search for @p k pairs needs beside a factor, at least; S->A is
 * not used. */
int64_t ritz_slices_need(const ritz_shifted *S, int64_t k);

#endif
