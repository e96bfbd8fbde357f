/*
 * Products of tall matrices, of many rows and few columns, by several threads.
 *
 * Rows are divided among the threads, each of which calls the BLAS for its own:
 * the threads of the BLAS itself divide the few columns. Sums over rows are
 * added in the order of the threads, so that a result has the same bits
 * whenever the number of threads is the same.
 *
 * Outputs are allocated by the caller and must not overlap the inputs. None of
 * these functions may be called by a thread of a team.
 */
#ifndef RITZ_LINEAR_TALL_H
#define RITZ_LINEAR_TALL_H

#include <ritz/matrix.h>

/** A matrix whose entries have no values until they are written. */
ritz_status ritz_tall_new(int64_t nrow, int64_t ncol, ritz_dense *out);

/** G := A'B. @param[out] out  allocated here */
ritz_status ritz_tall_inner(const ritz_dense *A, const ritz_dense *B,
                            ritz_dense *out);

/** size[j] := a_j'b_j */
void ritz_tall_dots(const ritz_dense *A, const ritz_dense *B, double *size);

/** A := A - B H */
void ritz_tall_subtract(const ritz_dense *B, const ritz_dense *H,
                        ritz_dense *A);

/** A := A L^-T, L the lower triangle of a square matrix. */
void ritz_tall_divide(const ritz_dense *L, ritz_dense *A);

/** Y := W X. @param[in] W  symmetric; NULL is the identity */
ritz_status ritz_tall_weigh(const ritz_sparse *W, const ritz_dense *X,
                            ritz_dense *Y);

/**
 * WX := W X, and size[j] := |v_j|'|W||x_j|, by which rounding is estimated.
 *
 * @param[in]  W     symmetric; NULL is the identity
 * @param[out] WX    NULL: not wanted
 * @param[out] size  one number a column
 */
ritz_status ritz_tall_weigh_sizes(const ritz_sparse *W, const ritz_dense *V,
                                  const ritz_dense *X, ritz_dense *WX,
                                  double *size);

/**
 * W X, and |W||X|, the magnitude of the terms that it sums.
 *
 * @param[in]  W         symmetric
 * @param[out] WX, size  allocated here
 */
ritz_status ritz_tall_weigh_terms(const ritz_sparse *W, const ritz_dense *X,
                                  ritz_dense *WX, ritz_dense *size);

/**
 * X := X - left (right' X): of columns with right' left = I, the part of X
 * along them. Once leaves rounding; twice is enough.
 */
ritz_status ritz_tall_take_out(const ritz_dense *left, const ritz_dense *right,
                               ritz_dense *X);

#endif
