/*
 * K - sigma M = L D L' of distributed matrices by MUMPS. It is called directly:
 * PETSc's interface finds out again for each block of right-hand sides to which
 * ranks MUMPS has assigned rows, and cannot pass an order of rows on.
 *
 * The order is that of the other engines, by METIS on the graph of grids, found
 * in rank 0. The pattern is analysed once, for all sigma.
 */
#ifndef RITZ_LIBEXEC_SLEPC_FACTOR_H
#define RITZ_LIBEXEC_SLEPC_FACTOR_H

#include <ritz/matrix.h>

#include <petscmat.h>

typedef struct rank_factor rank_factor;

/**
 * Analyse the pattern of K - sigma M. Collective.
 *
 * @param[in]  K,M  symmetric, both triangles stored; borrowed
 * @return RITZ_ERR_MEMORY, also if all ranks of one machine would exceed the
 *         limit of rank 0 by MUMPS's estimate
 */
ritz_status rank_factor_new(Mat K, Mat M, rank_factor **out);

/**
 * Factor K - sigma M, in place of the factor before. Collective.
 *
 * @param[in]  step      its name for ritz_monitor_step()
 * @param[out] negative  eigenvalues of the pencil below sigma, by Sylvester's
 *                       law of inertia
 * @return RITZ_ERR_SINGULAR if MUMPS finds a pivot that is zero or rounding;
 *         RITZ_ERR_MEMORY; RITZ_ERR_CONVERGENCE for any other failure of MUMPS
 */
ritz_status rank_factor_make(rank_factor *F, double sigma, const char *step,
                             int64_t *negative);

/** In rank 0, after a factor that is singular: the row of a pivot that is zero;
 * -1 if there is none, and in all other ranks. */
int64_t rank_factor_null_row(const rank_factor *F);

/**
 * X := (K - sigma M)^-1 B. Collective.
 *
 * @param[in]  B  this rank's rows of as many columns in each rank, one column
 *                after the other
 * @param[out] X  likewise; not B
 * @return RITZ_ERR_MEMORY, or RITZ_ERR_CONVERGENCE for any other failure of
 *         MUMPS
 */
ritz_status rank_factor_solve(rank_factor *F, int64_t columns, const double *B,
                              double *X);

void rank_factor_free(rank_factor **F);

#endif
