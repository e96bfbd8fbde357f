/*
 * Sparse matrices in compressed columns, the one storage scheme of Ritz.
 *
 * Symmetric matrices store both triangles, so no routine needs a flag to know
 * what it was given. Indices are int64_t throughout: a model of ten million
 * degrees of freedom overflows 32 bits in its factor, not in its matrices.
 *
 * Ownership, here and in every other header: {0} is a valid empty matrix; a
 * `const` argument is borrowed for the call; an argument named `out` must be
 * empty on entry, is written only on success, and is then the caller's to
 * free; freeing an empty matrix does nothing.
 */
#ifndef RITZ_SPARSE_H
#define RITZ_SPARSE_H

#include <ritz/dense.h>
#include <ritz/status.h>

#include <stdint.h>

#pragma GCC visibility push(default)

typedef struct ritz_sparse {
    int64_t nrow, ncol;
    int64_t *colptr; /* column j is entries colptr[j]..colptr[j+1]-1 */
    int64_t *rowind; /* row of each entry, ascending within a column */
    double *val;     /* value of each entry */
} ritz_sparse;

/** Allocate an @p nrow x @p ncol matrix with room for @p nnz entries. */
ritz_status ritz_sparse_new(int64_t nrow, int64_t ncol, int64_t nnz,
                            ritz_sparse *out);

/**
 * Assemble a matrix from @p count contributions, as element loops produce them.
 *
 * Contributions to the same place are summed; zeros are kept, so the pattern
 * depends on the mesh alone.
 *
 * @param[in]  row,col,val  count each; A(row[k], col[k]) += val[k]
 * @param[out] out          nrow x ncol
 * @return RITZ_ERR_ARGUMENT if an index is out of range; RITZ_ERR_MEMORY
 * @cost   O(count + nrow + ncol) time and workspace
 */
ritz_status ritz_sparse_from_triplets(int64_t nrow, int64_t ncol, int64_t count,
                                      const int64_t *row, const int64_t *col,
                                      const double *val, ritz_sparse *out);

/**
 * Copy the submatrix A(rows, cols), in the order the two lists give.
 *
 * @param[in]  rows,cols  distinct members of 0..nrow-1 and 0..ncol-1
 * @param[out] out        num_rows x num_cols
 * @return RITZ_ERR_ARGUMENT if a member is out of range; RITZ_ERR_MEMORY
 * @cost   O(nrow + entries of the chosen columns)
 */
ritz_status ritz_sparse_extract(const ritz_sparse *A, int64_t num_rows,
                                const int64_t *rows, int64_t num_cols,
                                const int64_t *cols, ritz_sparse *out);

/**
 * C = alpha A + beta B over the union of both patterns.
 *
 * @return RITZ_ERR_ARGUMENT if the sizes disagree; RITZ_ERR_MEMORY
 * @cost   O(entries of both)
 */
ritz_status ritz_sparse_add(double alpha, const ritz_sparse *A, double beta,
                            const ritz_sparse *B, ritz_sparse *C);

/** C = A B of sparse matrices; rows ascend. @cost O(flops + nnz log) */
ritz_status ritz_sparse_product(const ritz_sparse *A, const ritz_sparse *B,
                                ritz_sparse *C);

/** The transpose of @p A. */
ritz_status ritz_sparse_transpose(const ritz_sparse *A, ritz_sparse *out);

/** T'AT, exactly symmetric if A is. */
ritz_status ritz_sparse_congruence(const ritz_sparse *A, const ritz_sparse *T,
                                   ritz_sparse *out);

/** T'AT of a symmetric A, exactly symmetric. @cost O(r nnz + n r^2) */
ritz_status ritz_sparse_condense(const ritz_sparse *A, const ritz_dense *T,
                                 ritz_dense *out);

/** T'AT, exactly symmetric only if A is: of damping; {0} of an absent A. */
ritz_status ritz_sparse_project(const ritz_sparse *A, const ritz_dense *T,
                                ritz_dense *out);

/** |T|'|A||T| of a symmetric A: of T'AT, what it sums up, for its rounding. */
ritz_status ritz_sparse_terms(const ritz_sparse *A, const ritz_dense *T,
                              ritz_dense *out);

/** Copy of @p A. */
ritz_status ritz_sparse_copy(const ritz_sparse *A, ritz_sparse *out);

/** @p A as a dense matrix. @return RITZ_ERR_ARGUMENT if it is too large */
ritz_status ritz_sparse_dense(const ritz_sparse *A, ritz_dense *out);

/** Entries of @p A that are not 0. */
ritz_status ritz_sparse_from_dense(const ritz_dense *A, ritz_sparse *out);

/**
 * Y = A X.
 *
 * @param[in]  X  A->ncol x k
 * @param[out] Y  A->nrow x k
 * @return RITZ_ERR_ARGUMENT if the sizes disagree; RITZ_ERR_MEMORY
 */
ritz_status ritz_sparse_mul(const ritz_sparse *A, const ritz_dense *X,
                            ritz_dense *Y);

/**
 * The same as if summed with twice the digits: each entry to its own rounding,
 * whatever cancels in it. @cost five times as much
 */
ritz_status ritz_sparse_mul_twofold(const ritz_sparse *A, const ritz_dense *X,
                                    ritz_dense *Y);

/**
 * Hold a matrix that came from outside to what the rest of Ritz relies on:
 * pointers and rows ascend, rows lie in the matrix, values are finite.
 *
 * @param[in] nnz  how many entries there are room for
 * @return RITZ_ERR_FORMAT if one does not hold
 */
ritz_status ritz_sparse_check(const ritz_sparse *A, int64_t nnz);

/** A(j,j), 0 where nothing is stored. */
double ritz_sparse_diagonal(const ritz_sparse *A, int64_t j);

/** Largest |A(i,j)|, 0 if there is none. */
double ritz_sparse_max(const ritz_sparse *A);

/** Largest |A(i,j) - A(j,i)| over largest |A(i,j)|, for a square matrix. */
double ritz_sparse_asymmetry(const ritz_sparse *A);

/** |A - A'| / (2 |A|) in the Frobenius norm: how much of A is antisymmetric. */
double ritz_sparse_skew(const ritz_sparse *A);

/** A := (A + A') / 2, exactly symmetric in values and in pattern. */
ritz_status ritz_sparse_symmetrise(ritz_sparse *A);

/** Free what @p A owns and leave it empty. */
void ritz_sparse_free(ritz_sparse *A);

#pragma GCC visibility pop

#endif
