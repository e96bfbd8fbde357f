/*
 * Dense matrices that need not be symmetric: what LAPACK and SLICOT do, and
 * what is made of it.
 */
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
 * LU factor of a matrix whose rows and columns have different units, as those
 * of a reduced model have. If the matrix seems singular, rows and columns are
 * scaled by powers of two and it is factored once more.
 */
typedef struct ritz_general_factor {
    ritz_dense LU;
    int *pivot;
    double *row, *col; /* scales of rows and columns; NULL: none */
} ritz_general_factor;

/** @return RITZ_ERR_SINGULAR if A is singular to working accuracy */
ritz_status ritz_general_factor_new(const ritz_dense *A,
                                    ritz_general_factor *out);

/** X := A^-1 X; X := A'^-1 X if @p transposed. */
void ritz_general_factor_solve(const ritz_general_factor *F, bool transposed,
                               ritz_dense *X);

void ritz_general_factor_free(ritz_general_factor *F);

RITZ_PAIR_OF(ritz_general_factor);

/** ritz_general_solve for a matrix whose rows and columns have different
 * units. */
ritz_status ritz_general_solve_scaled(const ritz_dense *A, bool transposed,
                                      ritz_dense *X);

/**
 * A := L of A = L L', lower triangles, and A's reciprocal condition number, 0
 * if it is not definite.
 */
ritz_status ritz_general_cholesky(ritz_dense *A, double *rcond);

/**
 * The same where only rcond > @p enough matters. If a bound from below that takes
 * 2 n^2 operations is more than that, @p rcond is this bound. LAPACK's estimate,
 * which takes a tenth of the time of all modes of 40 rows, would be more too.
 */
ritz_status ritz_general_cholesky_above(ritz_dense *A, double enough,
                                        double *rcond);

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
 * theta[j] = q'A q of each column q of @p Q, eigenvectors of a nearly diagonal
 * A. LAPACK's eigenvalues err by eps times the largest of them, these quotients
 * by much less where theta is small.
 *
 * @param[in]  A      k x k, symmetric
 * @param[in]  Q      k x m
 * @param[out] theta  m numbers
 */
ritz_status ritz_eigen_quotients(const ritz_dense *A, const ritz_dense *Q,
                                 double *theta);

/* Lanczos on the pencil K - sigma M, for ritz_eigen_sparse. */
/** Refuse a mass M_jj below @p least <= 0; m[0] is that of row @p first.
 * @return RITZ_ERR_SINGULAR */
ritz_status ritz_eigen_check_mass(int64_t count, const double *m, int64_t first,
                                  double least);

typedef struct ritz_shifted {
    const ritz_sparse *K, *M; /* borrowed */
    double sigma;
    ritz_factor *A; /* of K - sigma M */
    int64_t below;  /* number of eigenvalues below sigma, all to be found */
} ritz_shifted;

/** How ritz_lanczos_lowest ended, if it did not fail. */
typedef enum ritz_lanczos_end {
    RITZ_LANCZOS_FOUND,
    RITZ_LANCZOS_SLOW,      /* not converged: sigma is badly placed */
    RITZ_LANCZOS_EXHAUSTED, /* there are fewer finite eigenvalues than asked */
} ritz_lanczos_end;

/**
 * Singular values of A, min(m, n) of them, descending; A is lost.
 *
 * @return RITZ_ERR_CONVERGENCE
 */
ritz_status ritz_general_singular(ritz_dense *A, double *sigma);

/** The largest of them, 0 of an empty matrix; A is lost. */
ritz_status ritz_general_norm(ritz_dense *A, double *out);

/**
 * A number between -1 and 1, uniformly distributed: the next one of a sequence
 * that is the same on every machine.
 *
 * @param[in,out] state  any number to begin with
 */
double ritz_general_noise(uint64_t *state);

/** x := x / |x|; false, without a change of x, if x is zero. */
bool ritz_general_unit(int64_t n, double *x);

/** Frobenius norm. */
double ritz_general_size(const ritz_dense *A);

/**
 * As ritz_eigen_dense, without residuals, which take four products of n x n
 * matrices: they are NaN, or 0 where K and M are those of modal coordinates.
 */
ritz_status ritz_eigen_unchecked(const ritz_dense *K, const ritz_dense *M,
                                 ritz_pairs *out);

/** The residuals that ritz_eigen_unchecked left out, of the pairs that are kept:
 * |K x - lambda M x| / ||K||x| + |lambda||M||x||, || taken entry by entry. */
ritz_status ritz_eigen_residuals(const ritz_dense *K, const ritz_dense *M,
                                 ritz_pairs *pairs);

/** Eigenpairs of a symmetric A, vectors of length one: see ritz_eigen_unchecked. */
ritz_status ritz_general_symmetric(const ritz_dense *A, ritz_pairs *out);

/**
 * Eigenvalues alone, ascending, each with an error of some eps of the largest.
 *
 * @param[out] lambda  as many as A has rows
 * @cost   a third of ritz_general_symmetric
 */
ritz_status ritz_general_symmetric_values(const ritz_dense *A, double *lambda);

/** to(row.., col..) = sign A, or sign A'. */
void ritz_general_place(double sign, const ritz_dense *A, bool transposed,
                        int64_t row, int64_t col, ritz_dense *to);

/** The transpose. */
ritz_status ritz_general_transpose(const ritz_dense *A, ritz_dense *out);

/* Eigenvalues of a general matrix, and how far rounding may move them. */
typedef struct ritz_eigenvalues {
    int64_t count;
    double *re, *im;
    double *error; /* eps |A| / s, s the cosine between left and right
                      eigenvector: large where eigenvalues are defective */
    double radius; /* largest magnitude; 0 if there is none */
} ritz_eigenvalues;

/**
 * All eigenvalues, by magnitude ascending; of a pair the one with the positive
 * imaginary part first. A is balanced first (LAPACK dgeevx).
 *
 * @return RITZ_ERR_ARGUMENT if A is not square or not finite;
 *         RITZ_ERR_CONVERGENCE
 * @cost   about 25 n^3
 */
ritz_status ritz_eigenvalues_of(const ritz_dense *A, ritz_eigenvalues *out);

/**
 * Index of the eigenvalue that decides on stability: the rightmost of those
 * right of the imaginary axis by more than @p times their error; if there is
 * none, of those nearer to it; else of all. -1 if there are none.
 */
int64_t ritz_eigenvalues_worst(const ritz_eigenvalues *eigenvalues,
                               double times);

void ritz_eigenvalues_free(ritz_eigenvalues *eigenvalues);

/**
 * E = exp(A h), and of each symmetric Q_k
 *
 *     W_k = integral from 0 to h of exp(A s)'Q_k exp(A s) ds
 *
 * by a power series over h / 2^j and j doublings, A balanced first. What it
 * loses to rounding is about eps |A| h.
 *
 * @param[in]  Q  count, n x n
 * @param[out] W  count
 * @return RITZ_ERR_ARGUMENT if |A| h is beyond 2^60
 */
ritz_status ritz_exponential(const ritz_dense *A, double h, int count,
                             const ritz_dense *Q, ritz_dense *E, ritz_dense *W);

/**
 * Scales d, powers of two, with which D^-1 A D has rows and columns of similar
 * size: those by which ritz_exponential balances.
 *
 * @param[out] d  as many as A has rows
 * @param[out] norm  of D^-1 A D, the largest sum of a column
 * @return RITZ_ERR_ARGUMENT if A is not finite
 */
ritz_status ritz_general_balance(const ritz_dense *A, double *d, double *norm);

/* X'Y = U diag(s) V' */
typedef struct ritz_product_svd {
    int64_t count; /* min of n, l and k */
    double *s;     /* count, descending */
    int64_t rank;  /* r: from here on they are below eps^2 of the largest, and
                      are given as 0 */
    ritz_dense U;  /* l x r, orthonormal columns */
    ritz_dense V;  /* k x r */
} ritz_product_svd;

/**
 * Small values are as accurate, relative to themselves, as X with rows of unit
 * length and Y with rows of any scaling are well conditioned: the product is
 * never formed and its values are found by Jacobi rotations.
 *
 * @param[in] X        n x l
 * @param[in] Y        n x k
 * @param[in] vectors  whether U and V are wanted
 * @return RITZ_ERR_ARGUMENT if they are of different height or not finite;
 *         RITZ_ERR_CONVERGENCE
 * @cost   O((n + k + l) min(k, l)^2) and some n k l
 * @see    [Drmac1998]
 */
ritz_status ritz_product_svd_new(const ritz_dense *X, const ritz_dense *Y,
                                 bool vectors, ritz_product_svd *out);

void ritz_product_svd_free(ritz_product_svd *svd);

#endif
