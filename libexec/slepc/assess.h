/*
 * Residuals of distributed pairs, and pairs of more digits. Eight vectors at a
 * time are stored row by row, those of the rank's own rows and of the rows of
 * other ranks in which these have entries, and multiplied by the kernels of
 * src/linear/tiles.h.
 */
#ifndef RITZ_LIBEXEC_SLEPC_ASSESS_H
#define RITZ_LIBEXEC_SLEPC_ASSESS_H

#include <ritz/matrix.h>

#include <petscmat.h>

/* Rows of a pencil in this rank, and eight vectors. */
typedef struct assessor {
    int64_t own, far; /* rows of this rank, and of others that it needs */
    /* column j has the entries of row j of this rank; rows: own, then far */
    ritz_sparse K, M;
    double *x; /* own + far rows of eight numbers */
    Vec mine, others;
    VecScatter fetch; /* from `mine` of all ranks to `others` */
} assessor;

/** Copy this rank's rows of a pencil. Collective.
 * @return RITZ_ERR_MEMORY */
ritz_status assessor_new(Mat K, Mat M, assessor *out);

/**
 * Residuals | K x - lambda M x | / | |K||x| + |lambda||M||x| |, and the number
 * of rigid-body modes. Collective.
 *
 * @param[in]     X       vectors, as many as P has
 * @param[in,out] P       lambda and Phi.ncol are read; residual and num_rigid
 *                        are set
 * @param[out]    energy  |x|'|K||x| of each pair
 * @param[out]    worst   the largest residual; NaN if one is NaN
 */
ritz_status assessor_residuals(const assessor *a, Mat X, ritz_pairs *P,
                               double *energy, double *worst);

/**
 * Compute pairs that have lost digits again, as ritz_pairs_sharpen() does, with
 * products by K of twice the digits. Without it the rounding of the factor,
 * which depends on the number of ranks, would remain in low pairs, as of thin
 * plates. Collective.
 *
 * @param[in,out] X       M-orthonormal, by ascending eigenvalue
 * @param[in]     energy  of assessor_residuals()
 * @param[in,out] P       lambda is changed, num_rigid is read
 * @return as ritz_pairs_sharpen()
 */
ritz_status assessor_sharpen(const assessor *a, Mat X, const double *energy,
                             ritz_pairs *P);

void assessor_free(assessor *a);

#endif
