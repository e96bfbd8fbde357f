/*
 * Block Lanczos iteration for the lowest eigenpairs of K x = lambda M x, with a
 * Cholesky factor of A = K - sigma M [GrimesLewisSimon1994]. A block has eight
 * vectors, because the time of a solve is that of reading the factor, which is
 * read once for the whole block. Where many pairs are requested, a step adds two
 * such blocks at once, V_j of sixteen vectors: a tenth more vectors are needed
 * in all, but the factor and the basis are read half as often. Each new
 * V_j+1 is made orthogonal to all vectors before it:
 *
 *     A^-1 M V_j = V_j-1 R_j' + V_j A_j + V_j+1 R_j+1,   V'M V = I
 *
 * T = V'M A^-1 M V is block tridiagonal, with A_j on its diagonal. Its
 * eigenpairs T z = theta z give lambda = sigma + 1 / theta. With z_j the
 * components of z for V_j, |R_j+1 z_j| is the norm of the residual A^-1 M x -
 * theta x of x = V z, and
 *
 *     V z + V_j+1 R_j+1 z_j / theta = A^-1 M V z / theta
 *
 * is the vector of one more inverse iteration, which needs no solve: this one
 * is returned. If a larger residual is admitted, the iteration ends earlier. These
 * vectors are then not orthogonal enough, and are combined by Rayleigh-Ritz.
 */
#ifndef RITZ_LINEAR_BLOCK_LANCZOS_H
#define RITZ_LINEAR_BLOCK_LANCZOS_H

#include "linear/enclosure.h"
#include "linear/general.h"

/** What ritz_block_lanczos() is to find. */
typedef struct ritz_lanczos_plan {
    int64_t k;     /* in: pairs */
    int64_t room;  /* in: largest number of basis vectors, at least 5 k / 4 +
                      48; 0: about 4 k, with which few models need a restart */
    int64_t width; /* in: blocks of eight that each step adds, 1 or 2; 0: 2 from
                      100 pairs on */
    double settled; /* in: residual |A^-1 M x - theta x| / |theta x| at which a
                       pair has converged; 0: 1e-10. If it is not 0, vectors are
                       combined by a Rayleigh-Ritz step, and moments are
                       returned; sigma must then be below all eigenvalues */
    ritz_moments moments; /* out: of the vectors before their last inverse
                             iteration, as ritz_vectors_polish() returns them;
                             freed by the caller */
    ritz_sparse *fold[2]; /* in: K and M of S if they may be folded during the
                             iteration, see folded.h, or M freed and made again
                             of its rows; NULL: not. Afterwards they are as
                             before, but may be empty after RITZ_ERR_MEMORY */
    double next; /* out: estimate of the next eigenvalue after those found, by
                      distance from sigma, or of the k-th one if the search was
                      SLOW; the true one is nearer to sigma. HUGE_VAL if there
                      is no estimate; not set if it was EXHAUSTED */
} ritz_lanczos_plan;

/**
 * The plan->k eigenpairs nearest to sigma, and more if these have converged,
 * too: up to eight if S->below is 0, any number otherwise. The search goes on
 * until at least S->below of them lie below sigma. That none is missing is not
 * guaranteed: see ritz_inertia_negative().
 *
 * @param[in]     S       K, M and the factor of K - sigma M, which is positive
 *                        definite if S->below is 0; M positive semidefinite
 * @param[in,out] plan    what to find; its moments must be empty
 * @param[out]    X       n x at least k, by distance from sigma, columns
 *                        M-orthonormal; empty unless *end is FOUND
 * @param[out]    lambda  eigenvalues of the columns of X, to be freed; NULL
 *                        unless *end is FOUND  [rad^2/s^2]
 * @param[out]    end     FOUND; SLOW after 40 restarts, or if the room is too
 *                        small for one; EXHAUSTED if there are fewer than k
 *                        finite eigenvalues, or fewer than S->below below sigma
 * @return RITZ_ERR_MEMORY, also if basis vectors that do not fit into memory
 *         cannot be in a file either; RITZ_ERR_ARGUMENT if k is too large for
 *         LAPACK; RITZ_ERR_CONVERGENCE if LAPACK fails
 * @cost   about 3 k / 8 solves of a block, or half as many of two blocks, and
 *         4 k vectors of memory, or k + 40 of memory and the others of a file
 */
ritz_status ritz_block_lanczos(const ritz_shifted *S, ritz_lanczos_plan *plan,
                               ritz_dense *X, double **lambda,
                               ritz_lanczos_end *end);

/**
 * Bytes that a search for @p k pairs needs beside the factor at least: with most
 * of its basis in a file. S->A is not used.
 *
 * @param[in] folded  whether K and M may be folded
 */
int64_t ritz_block_lanczos_needs(const ritz_shifted *S, int64_t k, bool folded);

#endif
