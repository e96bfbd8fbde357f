/*
 * Spectrum slices: many of the lowest pairs, some hundred at a time, each
 * hundred by block Lanczos at a shift among them [GrimesLewisSimon1994].
 */
#ifndef RITZ_LINEAR_SLICES_H
#define RITZ_LINEAR_SLICES_H

#include "linear/general.h"

/** How ritz_slices_lowest() divides the spectrum. */
typedef struct ritz_slicing {
    int64_t side;   /* eigenvalues on each side of a shift; 0: what is mostly
                       fastest */
    int64_t slices; /* out: how many there were */
    int64_t proven; /* out: so many of the lowest are counted by inertia */
} ritz_slicing;

/**
 * The @p k lowest eigenvalues of a pencil without eigenvalues below sigma, and
 * those behind them that were found as well. All below the last shift are
 * counted by inertia, those above it are not.
 *
 * @param[in,out] S      its factor is freed as soon as the first slice is found
 * @param[out]    X      n x at least k, by ascending eigenvalue; empty unless
 *                       FOUND
 * @param[out]    lambda of the columns of X, to be freed; NULL unless FOUND
 * @param[out]    end    EXHAUSTED if nothing is found behind the last border,
 *                       SLOW if slices become too many
 * @return RITZ_ERR_CONVERGENCE if eigenvalues that were counted are not found,
 *         or vectors of two slices are not orthogonal; RITZ_ERR_SINGULAR if no
 *         shift has an accurate factor
 * @cost   for each slice of 2 side: a factor, some 6 side / 8 block solves, and
 *         2 n (6 side)^2 operations to keep vectors orthogonal; 2 n k^2 for
 *         those of different slices; memory for one factor, the vectors found
 *         and some 10 side more
 */
ritz_status ritz_slices_lowest(ritz_shifted *S, int64_t k,
                               ritz_slicing *slicing, ritz_dense *X,
                               double **lambda, ritz_lanczos_end *end);

#endif
