/*
 * Block Lanczos with one full reorthogonalisation, for the lowest pairs of a
 * factored pencil [GrimesLewisSimon1994].
 *
 * Eight vectors at once cost little more than one, as a solve reads the factor
 * once for all of them:
 *
 *     A = K - sigma M,   A^-1 M V_j = V_j-1 R_j' + V_j A_j + V_j+1 R_j+1,
 *     V'M V = I,   T z = theta z,   lambda = sigma + 1 / theta
 *
 * The residual of a Ritz pair is |R_j+1 z_j|, z_j the last part of z, and
 *
 *     x = V z + V_j+1 R_j+1 z_j / theta = A^-1 M V z / theta
 *
 * is one inverse iteration better than V z, and costs no solve.
 */
#ifndef RITZ_LINEAR_BLOCK_LANCZOS_H
#define RITZ_LINEAR_BLOCK_LANCZOS_H

#include "linear/general.h"

/**
 * The @p k eigenvalues nearest above sigma, and those behind them that converge
 * as well, up to a few.
 *
 * @param[in]  room    vectors that are kept at most, at least 5 k / 4 + 48;
 *                     0: as many as convergence mostly takes
 * @param[out] X       n x at least k, by ascending eigenvalue; empty unless
 *                     FOUND
 * @param[out] lambda  of the columns of X, to be freed; NULL unless FOUND
 * @param[out] next    the eigenvalue behind them, as far as it is known: an
 *                     upper bound, HUGE_VAL if nothing is known; of the k-th
 *                     if SLOW
 * @cost   some 3 k / 8 block solves; memory for some 4 k vectors
 */
ritz_status ritz_block_lanczos(const ritz_shifted *S, int64_t k, int64_t room,
                               ritz_dense *X, double **lambda, double *next,
                               ritz_lanczos_end *end);

#endif
