/* Dense matrices: column-major, no padding between columns. */
#ifndef RITZ_DENSE_H
#define RITZ_DENSE_H

#include <ritz/status.h>

#include <stdint.h>

#pragma GCC visibility push(default)

typedef struct ritz_dense {
    int64_t nrow, ncol;
    double *val; /* nrow * ncol, A(i,j) is val[i + j * nrow] */
} ritz_dense;

/** Zero matrix. The caller frees @p out. */
ritz_status ritz_dense_new(int64_t nrow, int64_t ncol, ritz_dense *out);

/** C = A B, with A m x p and B p x q. The caller frees @p C. */
ritz_status ritz_dense_mul(const ritz_dense *A, const ritz_dense *B,
                           ritz_dense *C);

/** C = A' B, with A m x p and B m x q. The caller frees @p C. */
ritz_status ritz_dense_mul_tn(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *C);

/** C = A B', with A m x p and B q x p. The caller frees @p C. */
ritz_status ritz_dense_mul_nt(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *C);

ritz_status ritz_dense_copy(const ritz_dense *A, ritz_dense *out);

/** |A(i,j)|. */
ritz_status ritz_dense_abs(const ritz_dense *A, ritz_dense *out);

/** A := (A + A') / 2, exactly symmetric; A must be square. */
void ritz_dense_symmetrise(ritz_dense *A);

/** Largest |A(i,j) - A(j,i)| over largest |A(i,j)|, of a square matrix. */
double ritz_dense_asymmetry(const ritz_dense *A);

/** B'AB of a square A, made exactly symmetric. The caller frees @p out. */
ritz_status ritz_dense_congruence(const ritz_dense *A, const ritz_dense *B,
                                  ritz_dense *out);

/** B'AB of a square A, exactly symmetric only if A is: of damping matrices. */
ritz_status ritz_dense_project(const ritz_dense *A, const ritz_dense *B,
                               ritz_dense *out);

/** |B|'|A||B|: of B'AB, what it sums up, for its rounding. */
ritz_status ritz_dense_terms(const ritz_dense *A, const ritz_dense *B,
                             ritz_dense *out);

/**
 * X := X - left (right' X): of columns with right' left = I, the part of X along
 * them. Once leaves rounding; twice is enough.
 */
ritz_status ritz_dense_take_out(const ritz_dense *left, const ritz_dense *right,
                                ritz_dense *X);

/** Column i of A times column j of B. */
double ritz_dense_dot(const ritz_dense *A, int64_t i, const ritz_dense *B,
                      int64_t j);

/** [A B]; both have as many rows, or B has no columns. */
ritz_status ritz_dense_beside(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *out);

/** Columns j0..j0+count-1 as a matrix of their own. */
ritz_status ritz_dense_columns(const ritz_dense *A, int64_t first,
                               int64_t count, ritz_dense *out);

/** The same, borrowed: they stay where they are. */
ritz_dense ritz_dense_part(const ritz_dense *A, int64_t first, int64_t count);

/** Rows row[0], row[1], ... as a matrix of their own. */
ritz_status ritz_dense_rows(const ritz_dense *A, int64_t count,
                            const int64_t *row, ritz_dense *out);

/** Largest |A(i,j)|, 0 if empty. */
double ritz_dense_max(const ritz_dense *A);

/** The same of column @p j alone. */
double ritz_dense_col_max(const ritz_dense *A, int64_t j);

/**
 * Turn each column so that its entry of largest magnitude is positive; of
 * entries equal within 1e-9 the first decides, lest rounding choose the sign.
 */
void ritz_dense_orient(ritz_dense *A);

/** Borrowed pointer to column @p j. */
double *ritz_dense_col(const ritz_dense *A, int64_t j);

void ritz_dense_free(ritz_dense *A);

#pragma GCC visibility pop

#endif
