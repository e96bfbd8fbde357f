/* Dense matrices: column-major, no padding between columns. */
#ifndef RITZ_MATRIX_H
#define RITZ_MATRIX_H

#include <ritz/base.h>

#include <stdint.h>

#pragma GCC visibility push(default)

typedef struct ritz_dense {
    int64_t nrow, ncol;
    double *val; /* nrow * ncol, A(i,j) is val[i + j * nrow] */
} ritz_dense;

/** Zero matrix. The caller frees @p out. */
ritz_status ritz_dense_new(int64_t nrow, int64_t ncol, ritz_dense *out);

/** C = A B, C = A'B, C = A B'. The caller frees @p C. */
ritz_status ritz_dense_mul(const ritz_dense *A, const ritz_dense *B,
                           ritz_dense *C);
ritz_status ritz_dense_mul_tn(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *C);
ritz_status ritz_dense_mul_nt(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *C);

ritz_status ritz_dense_copy(const ritz_dense *A, ritz_dense *out);

/** I of @p n rows. */
ritz_status ritz_dense_identity(int64_t n, ritz_dense *out);

/** A := A + factor B. */
void ritz_dense_add(double factor, const ritz_dense *B, ritz_dense *A);

/** A(i,j) := factor[i] A(i,j). */
void ritz_dense_scale_rows(const double *factor, ritz_dense *A);

/** A := B, which is left empty. */
void ritz_dense_replace(ritz_dense *A, ritz_dense *B);

/**
 * A := A B in the memory of A, which keeps its length.
 *
 * @param[in]     B  k x m, m <= k; it may be A itself, which is then copied
 * @param[in,out] A  n x k, n x m afterwards
 * @return RITZ_ERR_ARGUMENT if the sizes disagree; RITZ_ERR_MEMORY
 */
ritz_status ritz_dense_times(const ritz_dense *B, ritz_dense *A);

/** The block of @p out's size whose first entry is A(row, col). */
void ritz_dense_cut(const ritz_dense *A, int64_t row, int64_t col,
                    ritz_dense *out);

/** A becomes the block of @p out whose first entry is (row, col). */
void ritz_dense_put(const ritz_dense *A, int64_t row, int64_t col,
                    ritz_dense *out);

/** |A(i,j)|. */
ritz_status ritz_dense_abs(const ritz_dense *A, ritz_dense *out);

/** A := (A + A') / 2, exactly symmetric; A must be square. */
void ritz_dense_symmetrise(ritz_dense *A);

/** Largest |A(i,j) - A(j,i)| over largest |A(i,j)|, of a square matrix. */
double ritz_dense_asymmetry(const ritz_dense *A);

/** |A - A'| / (2 |A|) in the Frobenius norm: relative size of the antisymmetric
 * part of A. */
double ritz_dense_skew(const ritz_dense *A);

/** B'AB of a square A, exactly symmetric: always, or (project) if A is. */
ritz_status ritz_dense_congruence(const ritz_dense *A, const ritz_dense *B,
                                  ritz_dense *out);
ritz_status ritz_dense_project(const ritz_dense *A, const ritz_dense *B,
                               ritz_dense *out);

/** |B|'|A||B|, of which B'AB has the rounding. */
ritz_status ritz_dense_terms(const ritz_dense *A, const ritz_dense *B,
                             ritz_dense *out);

/**
 * X := X - left (right' X): of columns with right' left = I, the part of X
 * along them. Once leaves rounding; twice is enough.
 */
ritz_status ritz_dense_take_out(const ritz_dense *left, const ritz_dense *right,
                                ritz_dense *X);

/** Column i of A times column j of B. */
double ritz_dense_dot(const ritz_dense *A, int64_t i, const ritz_dense *B,
                      int64_t j);

/** [A B]; both have as many rows, or one has no columns. */
ritz_status ritz_dense_beside(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *out);

/** Columns first, first + 1, ...: a copy; borrowed, where they are. */
ritz_status ritz_dense_columns(const ritz_dense *A, int64_t first,
                               int64_t count, ritz_dense *out);
ritz_dense ritz_dense_part(const ritz_dense *A, int64_t first, int64_t count);

/** A(row..row+nrow-1, col..col+ncol-1) as a matrix of its own. */
ritz_status ritz_dense_block(const ritz_dense *A, int64_t row, int64_t nrow,
                             int64_t col, int64_t ncol, ritz_dense *out);

/** Rows row[0], row[1], ..., or columns, as a matrix of their own. */
ritz_status ritz_dense_rows(const ritz_dense *A, int64_t count,
                            const int64_t *row, ritz_dense *out);
ritz_status ritz_dense_pick(const ritz_dense *A, int64_t count,
                            const int64_t *col, ritz_dense *out);

/** A := 0 except its rows row[0], row[1], ..., which become those of @p B. */
void ritz_dense_spread(const ritz_dense *B, const int64_t *row, ritz_dense *A);

/** A(at, at): rows at[0], at[1], ..., and the columns. */
ritz_status ritz_dense_principal(const ritz_dense *A, int64_t count,
                                 const int64_t *at, ritz_dense *out);

/** Largest |A(i,j)|, of all or of a column; 0 if empty. */
double ritz_dense_max(const ritz_dense *A);
double ritz_dense_col_max(const ritz_dense *A, int64_t j);

/**
 * Turn each column so that its entry of largest magnitude is positive; of
 * entries equal within 1e-9 the first decides, lest rounding choose the sign.
 */
void ritz_dense_orient(ritz_dense *A);

/** Borrowed pointer to column @p j. */
double *ritz_dense_col(const ritz_dense *A, int64_t j);

void ritz_dense_free(ritz_dense *A);

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
 * A := A(rows, rows) in place, so that memory does not hold both.
 *
 * @param[in,out] A     square; not defined after a failure, and still to be freed
 * @param[in]     rows  distinct members of 0..nrow-1, ascending
 * @return RITZ_ERR_ARGUMENT if A is not square, or a member is out of range or
 *         does not ascend; RITZ_ERR_MEMORY
 * @cost   O(nrow + entries)
 */
ritz_status ritz_sparse_keep(ritz_sparse *A, int64_t count,
                             const int64_t *rows);

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

/**
 * T'AT, exactly symmetric: always, or (project) if A is; {0} of an absent A.
 *
 * @cost O(r nnz + n r^2)
 */
ritz_status ritz_sparse_condense(const ritz_sparse *A, const ritz_dense *T,
                                 ritz_dense *out);
ritz_status ritz_sparse_project(const ritz_sparse *A, const ritz_dense *T,
                                ritz_dense *out);

/**
 * L'A T, some columns of T at a time, so that memory never holds all of A T.
 *
 * @param[in]  L    n x l
 * @param[in]  A    n x k
 * @param[in]  T    k x r
 * @param[out] out  l x r, freed by the caller
 * @return RITZ_ERR_ARGUMENT if the sizes disagree; RITZ_ERR_MEMORY
 * @cost O(r nnz + n l r)
 */
ritz_status ritz_sparse_between(const ritz_dense *L, const ritz_sparse *A,
                                const ritz_dense *T, ritz_dense *out);

/**
 * A X and |A||X|. Rounding errors of A X are some eps times |A||X|, entry by
 * entry.
 *
 * @param[in]  A     n x n, symmetric, both triangles stored
 * @param[in]  X     n x k
 * @param[out] AX    n x k, freed by the caller; NULL: not wanted
 * @param[out] size  |A||X|, n x k, freed by the caller
 * @return RITZ_ERR_MEMORY
 * @cost  one pass over A for every eight columns
 */
ritz_status ritz_sparse_mul_sizes(const ritz_sparse *A, const ritz_dense *X,
                                  ritz_dense *AX, ritz_dense *size);

/**
 * Columns of |T|'|A||T|. Rounding errors of T'A T are some eps times this,
 * entry by entry.
 *
 * @param[in]  A      n x n, symmetric, both triangles stored
 * @param[in]  T      n x r
 * @param[in]  count  number of columns
 * @param[in]  at     their numbers; NULL: 0, 1, ..., count - 1
 * @param[out] out    r x count, freed by the caller
 * @cost O(count nnz + n r count)
 */
ritz_status ritz_sparse_terms(const ritz_sparse *A, const ritz_dense *T,
                              int64_t count, const int64_t *at,
                              ritz_dense *out);

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
 * Y = A X as if summed with twice the digits: each entry to its own rounding,
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

/**
 * The value of ritz_sparse_asymmetry(), bit for bit, in one pass over a square
 * A instead of one binary search for each entry: faster for large matrices.
 *
 * @param[out] next  workspace of A->ncol numbers, overwritten
 * @cost  O(n + number of entries)
 */
double ritz_sparse_sweep_asymmetry(const ritz_sparse *A, int64_t *next);

/** As ritz_dense_skew. */
double ritz_sparse_skew(const ritz_sparse *A);

/** A := (A + A') / 2, exactly symmetric in values and in pattern. */
ritz_status ritz_sparse_symmetrise(ritz_sparse *A);

void ritz_sparse_free(ritz_sparse *A);

/* Sparse factors: CHOLMOD for definite matrices, MUMPS for all others. */

typedef struct ritz_factor ritz_factor;

/**
 * Factor A = P' L L' P with a fill-reducing ordering (CHOLMOD, supernodal,
 * METIS or AMD, whichever is better).
 *
 * @param[in]  A    n x n, symmetric; only its lower triangle is read
 * @param[out] out  independent of A afterwards
 * @return RITZ_ERR_SINGULAR if A is not positive definite to working accuracy:
 *         at a row the factor broke down, or its smallest pivot stands
 */
ritz_status ritz_factor_spd(const ritz_sparse *A, ritz_factor **out);

/** On RITZ_ERR_SINGULAR *weak is that row (-1 if not known). */
ritz_status ritz_factor_spd_weak(const ritz_sparse *A, ritz_factor **out,
                                 int64_t *weak);

/** Overwrite @p X, n x k, by the solution of A X_new = X. */
ritz_status ritz_factor_solve(ritz_factor *F, ritz_dense *X);

void ritz_factor_free(ritz_factor **F);

/* Symmetric indefinite, real: LDL' by sequential MUMPS. */
typedef struct ritz_ldl ritz_ldl;

/**
 * Factor A, n x n symmetric, lower triangle read.
 *
 * @param[out] negative  number of negative pivots; NULL: not wanted
 * @return RITZ_ERR_SINGULAR if A is singular to working accuracy
 */
ritz_status ritz_ldl_new(const ritz_sparse *A, int64_t *negative,
                         ritz_ldl **out);
ritz_status ritz_ldl_solve(ritz_ldl *F, ritz_dense *X);
void ritz_ldl_free(ritz_ldl **F);

/*
 * Complex family Z(s) = sum_k c_k A_k over one pattern, factored by sequential
 * MUMPS: the analysis is done once, each shift costs a numeric factor. It is
 * L D L' of the lower triangles if all A_k are exactly symmetric, L U of the
 * whole if one is not (gyroscopic damping), at about twice the cost.
 */
typedef struct ritz_zldl ritz_zldl;

/** @param[in] A  count matrices, all n x n, borrowed until free */
ritz_status ritz_zldl_new(int64_t count, const ritz_sparse *const *A,
                          ritz_zldl **out);

/**
 * Every sum to come has, times one complex number, a definite real part, as
 * s^2 M + s D + K has off the imaginary axis where M, D and K are semidefinite:
 * such factors are stable without pivots, and a fifth cheaper.
 */
void ritz_zldl_definite(ritz_zldl *F);

/** Factor sum_k c[k] A_k. @return RITZ_ERR_SINGULAR */
ritz_status ritz_zldl_factor(ritz_zldl *F, const double _Complex *c);

/**
 * Overwrite @p X, n x k column-major, by the solution; @p transposed: by the
 * transposed matrix, which is the same of symmetric ones.
 */
ritz_status ritz_zldl_solve(ritz_zldl *F, bool transposed, int64_t k,
                            double _Complex *X);
void ritz_zldl_free(ritz_zldl **F);

/* Eigenpairs of the symmetric pencil K x = lambda M x. */

typedef struct ritz_pairs {
    ritz_dense Phi;   /* n x k, Phi' M Phi = I, oriented as ritz_dense_orient */
    double *lambda;   /* k, ascending, as computed  [rad^2/s^2] */
    double *residual; /* k, |K x - lambda M x| / | |K||x| + |lambda||M||x| |,
                         |K| and |x| taken entry by entry */
    double *error; /* k, bounds of the relative errors of lambda, which is not
                      below the eigenvalue; that of a rigid-body motion is
                      relative to the first flexible one. NULL: errors are as
                      small as the residuals allow */
    int64_t num_rigid; /* the first of them are rigid-body motions */
    double sigma;      /* shift that was used  [rad^2/s^2] */
    double proven_to; /* no mode is missing below  [rad^2/s^2]; NaN: unproven */
    char engine[RITZ_NAME_SIZE];
    const char *reason; /* why RITZ_EIGEN_AUTO chose it, one phrase; NULL: there
                           was no choice */
} ritz_pairs;

/* How pairs of a large pencil are found. */
typedef enum ritz_eigen_engine {
    RITZ_EIGEN_AUTO,    /* the fastest of LANCZOS, SLICES, AMLS by prediction */
    RITZ_EIGEN_LANCZOS, /* block Lanczos at one shift */
    RITZ_EIGEN_ARPACK,  /* one vector at a time, for comparison */
    RITZ_EIGEN_SLICES,  /* block Lanczos at shifts within the spectrum */
    RITZ_EIGEN_AMLS,    /* substructures: relative errors up to 1e-4 */
} ritz_eigen_engine;

/* How many of the lowest pairs. Rigid modes are always found in addition. */
typedef struct ritz_span {
    int64_t modes;   /* number of flexible ones; -1: by frequency */
    double up_to_hz; /* every one up to this frequency, where modes is -1 */
    ritz_eigen_engine engine;
    bool uncounted;  /* skip the count that proves none missing */
    double accuracy; /* largest relative error of eigenvalues, 1e-8 to 1e-2, for
                        AUTO, LANCZOS, AMLS; 0: 1e-4 for AMLS, as accurate as
                        the residuals allow for all others */
} ritz_span;

/**
 * Lowest pairs of a sparse pencil: all rigid ones and the requested flexible
 * ones.
 *
 * K is positive semidefinite, M too, and K + M positive definite: massless
 * dofs are allowed, dofs with neither stiffness nor mass are not. K - sigma M
 * is factored with sigma < 0 chosen by scale. That none is missing is proven
 * by the inertia of K - tau M, tau above the last pair returned; a cluster
 * (relative gap below 1e-6) at the end is returned whole, so there may be more
 * than requested. If fewer flexible modes exist than asked, all are returned.
 *
 * With an accuracy, and with RITZ_EIGEN_AMLS, residuals are not limited;
 * `engine` of the pairs states a bound of the errors of eigenvalues, and the
 * values are upper bounds. Small pencils are always solved by LAPACK, to
 * rounding. If substructures would be nearly as large as the model, do not
 * converge or miss a mode, spectrum slices find the pairs to rounding; block
 * Lanczos does if residuals of slices or of ARPACK stay above their limit.
 *
 * @return RITZ_ERR_ARGUMENT if the span is not one, or if an accuracy is
 *         requested of an engine that finds eigenvalues to rounding only;
 *         RITZ_ERR_SINGULAR if K + M is singular (a mechanism without mass);
 *         RITZ_ERR_CONVERGENCE if a residual stays above its limit or the
 *         inertia count finds a mode that was missed
 * @cost   a factor, about 3 k solves in blocks of eight, one LDL' factor for the
 *         proof
 */
ritz_status ritz_eigen_sparse(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, ritz_pairs *out);

/**
 * All pairs of a dense pencil, r x r, M positive definite, or semidefinite with
 * K + M definite (then the infinite ones are left out: Phi has fewer columns).
 *
 * @return RITZ_ERR_SINGULAR if neither holds
 * @cost   O(r^3); O(r^2) in modal coordinates: K is diagonal and M = I
 */
ritz_status ritz_eigen_dense(const ritz_dense *K, const ritz_dense *M,
                             ritz_pairs *out);

/**
 * Eigenvalues of (K, M) below @p tau, by the inertia of a MUMPS LDL' factor of
 * K - tau M.
 *
 * @return RITZ_ERR_SINGULAR if tau is an eigenvalue to working accuracy
 */
ritz_status ritz_eigen_count(const ritz_sparse *K, const ritz_sparse *M,
                             double tau, int64_t *out);

/**
 * How many of @p count ascending eigenvalues are rigid-body motions. Only a gap
 * can distinguish rounding from a soft mode; the first of these that holds
 * decides,
 * with lambda_next the one above the gap:
 *
 * - six below 1e-9 lambda_max, and 1e4 |lambda| <= lambda_next: one free body,
 *   its matrices rounded to ten digits, say;
 * - some negative beyond 64 eps lambda_max, which shows the rounding: those
 *   below 100 times the most negative and 1e-9 lambda_max, with a gap of 1e4;
 * - those below 64 eps lambda_max, with a gap of 100 to lambda_next or none
 *   above;
 * - those below the first gap of 1e8, which is 1e4 in frequency, if as many
 *   stand above: one very stiff link makes no rigid modes of all others.
 *
 * @param[in] lambda_max  largest eigenvalue of the pencil, or the largest
 *                        |x|'|K||x| of its modes x: eps of it is rounding
 */
int64_t ritz_eigen_rigid(int64_t count, const double *lambda,
                         double lambda_max);

/** Frequency in Hz of an eigenvalue, -sqrt|.| of a negative one; and back. */
double ritz_eigen_hertz(double lambda);
double ritz_eigen_lambda(double hertz);

void ritz_pairs_free(ritz_pairs *pairs);

/** Copy the first @p count pairs. proven_to of the copy is at most the eigenvalue
 * of the first pair that is not copied. */
ritz_status ritz_pairs_copy(const ritz_pairs *from, int64_t count,
                            ritz_pairs *out);

#pragma GCC visibility pop

#endif
