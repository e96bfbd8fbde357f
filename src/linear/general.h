/* Dense matrices that need not be symmetric: what LAPACK and SLICOT do. */
#ifndef RITZ_LINEAR_GENERAL_H
#define RITZ_LINEAR_GENERAL_H

#include "base/alloc.h"

#include <ritz/matrix.h>

#include <stdbool.h>

RITZ_PAIR_OF(ritz_dense);

/**
 * X := A^-1 X by an LU factor; X := A'^-1 X if @p transposed.
 *
 * @return RITZ_ERR_SINGULAR if A is singular to working accuracy
 */
ritz_status ritz_general_solve(const ritz_dense *A, bool transposed,
                               ritz_dense *X);

/**
 * A = U diag(s) V', of min(m, n) values, descending.
 *
 * @param[out] U  m x min(m, n), or m x m with @p V
 * @param[out] s  min(m, n), to be freed
 * @param[out] V  n x n; NULL: not wanted
 */
ritz_status ritz_general_svd(const ritz_dense *A, ritz_dense *U, double **s,
                             ritz_dense *V);

/**
 * The factor of a Gramian, which itself is never formed (SLICOT SB03OD, after
 * [Hammarling1982]):
 *
 *     A W + W A' + B B' = 0,   W = U U',   U upper triangular
 *
 * @return RITZ_ERR_ARGUMENT if A has an eigenvalue that is not left of the axis
 */
ritz_status ritz_general_gramian(const ritz_dense *A, const ritz_dense *B,
                                 ritz_dense *U);

/**
 * Gramian of a pair in Schur form, S quasi-triangular and P triangular, P {0}
 * the identity:
 *
 *     S W P' + P W S' + B B' = 0,   W = F F'
 *
 * or, if @p transposed, S'W P + P'W S + B B' = 0, F the transpose of a
 * triangle (SLICOT SB03OD and SG03BD, [Hammarling1982], [Penzl1998]).
 *
 * @return RITZ_ERR_ARGUMENT if an eigenvalue is not left of the axis
 */
ritz_status ritz_general_hammarling(const ritz_dense *S, const ritz_dense *P,
                                    bool transposed, const ritz_dense *B,
                                    ritz_dense *F);

/** RITZ_ERR_ARGUMENT if a pencil of such sizes has no eigenvalues. */
ritz_status ritz_eigen_refuse(int64_t rows_K, int64_t cols_K, int64_t rows_M,
                              int64_t cols_M);

/**
 * K x = lambda M x by one call of LAPACK, M semidefinite; lambda ascending, in
 * error by few eps of the largest.
 *
 * @param[out] lambda  n
 * @param[out] X       n x r, X'MX = I, infinite ones left out
 * @return RITZ_ERR_SINGULAR if K + M is, or M has a negative eigenvalue
 */
ritz_status ritz_eigen_dense_once(const ritz_dense *K, const ritz_dense *M,
                                  double *lambda, ritz_dense *X);

/**
 * Singular values of A, min(m, n) of them, descending; A is lost.
 *
 * @return RITZ_ERR_CONVERGENCE
 */
ritz_status ritz_general_singular(ritz_dense *A, double *sigma);

/** The largest of them, 0 of an empty matrix; A is lost. */
ritz_status ritz_general_norm(ritz_dense *A, double *out);

/** Frobenius norm. */
double ritz_general_size(const ritz_dense *A);

/** Eigenpairs of a symmetric A, vectors of length one: see ritz_eigen_dense. */
ritz_status ritz_general_symmetric(const ritz_dense *A, ritz_pairs *out);

/** to(row.., col..) = sign A, or sign A'. */
void ritz_general_place(double sign, const ritz_dense *A, bool transposed,
                        int64_t row, int64_t col, ritz_dense *to);

/** The transpose. */
ritz_status ritz_general_transpose(const ritz_dense *A, ritz_dense *out);

#endif
