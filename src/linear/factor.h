/* A Cholesky factor P A P' = L L', for solvers that work in the order of its
 * rows. */
#ifndef RITZ_LINEAR_FACTOR_H
#define RITZ_LINEAR_FACTOR_H

#include <ritz/matrix.h>

/**
 * Factor an indefinite matrix: A = L S L', S = diag(+1 or -1), for the same
 * solves as a Cholesky factor. Pivots are exchanged only within supernodes,
 * which may be inaccurate: the backward error of one solve is measured, and a
 * factor above RITZ_SIGNED_ERROR is refused.
 *
 * @param[in]  A         n x n, symmetric, both triangles stored
 * @param[in]  order     order of rows, as of ritz_factor_order(); NULL: find
 *             one
 * @param[out] negative  number of negative eigenvalues of A, by Sylvester's law
 * @param[out] out       to be freed by ritz_factor_free()
 * @return RITZ_ERR_SINGULAR if A or a leading submatrix of it is singular or
 *         nearly so: choose another shift; RITZ_ERR_ARGUMENT if A is not
 *         square; RITZ_ERR_MEMORY
 * @see    [GrimesLewisSimon1994]
 */
ritz_status ritz_factor_signed(const ritz_sparse *A, const int64_t *order,
                               int64_t *negative, ritz_factor **out);

/**
 * ritz_factor_spd() with a known order of rows.
 *
 * @param[in] order  as of ritz_factor_order(); NULL: find one
 */
ritz_status ritz_factor_spd_ordered(const ritz_sparse *A, const int64_t *order,
                                    ritz_factor **out);

/**
 * ritz_factor_spd_ordered() by one thread, for a caller that has work for
 * another one.
 *
 * @param[in] order  not NULL
 */
ritz_status ritz_factor_spd_alone(const ritz_sparse *A, const int64_t *order,
                                  ritz_factor **out);

/** n numbers: row k of the factor is row order[k] of A. Borrowed from @p F. */
const int64_t *ritz_factor_order(const ritz_factor *F);

/**
 * Write the numbers of the factor to a file and give back their memory. The next
 * ritz_factor_solve() reads them back; results have the same bits. Until then
 * ritz_factor_solve_rows() and ritz_factor_solve_two() must not be called.
 *
 * @return RITZ_ERR_FILE as ritz_spill_put(), and the factor can be used
 */
ritz_status ritz_factor_spill(ritz_factor *F);

/**
 * x := A^-1 x for a block of eight vectors: x[8 k + c] is row k, in the
 * factor's order, of vector c.
 */
void ritz_factor_solve_rows(ritz_factor *F, double *x);

/**
 * x := A^-1 x for two such blocks, which follow each other in x. Both together
 * take little longer than one, as L is read once for both.
 *
 * @param room  16 n numbers, overwritten
 */
void ritz_factor_solve_two(ritz_factor *F, double *x, double *room);

/** Entries of a factor of a definite matrix, and the operations that it took. */
void ritz_factor_size(const ritz_factor *F, double *entries,
                      double *operations);

/** How many threads each solve uses; products of vectors of this length may use
 * as many. */
int ritz_factor_threads(const ritz_factor *F);

#endif
