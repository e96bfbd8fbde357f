/* Sparse factors: CHOLMOD for definite matrices, MUMPS for all others. */
#ifndef RITZ_FACTOR_H
#define RITZ_FACTOR_H

#include <ritz/dense.h>
#include <ritz/sparse.h>

#include <complex.h>

#pragma GCC visibility push(default)

typedef struct ritz_factor ritz_factor;

/**
 * Factor A = P' L L' P with a fill-reducing ordering (CHOLMOD, supernodal,
 * METIS or AMD, whichever is better).
 *
 * @param[in]  A    n x n, symmetric; only its lower triangle is read
 * @param[out] out  independent of A afterwards
 * @return RITZ_ERR_SINGULAR if A is not positive definite to working accuracy;
 *         ritz_factor_weak then names the row that gave way
 */
ritz_status ritz_factor_spd(const ritz_sparse *A, ritz_factor **out);

/**
 * The same, but on RITZ_ERR_SINGULAR *weak is a row of A at which the factor
 * broke down or its smallest pivot stands (-1 if not known).
 */
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

/**
 * @param[in] count  how many matrices, all n x n, borrowed until free
 */
ritz_status ritz_zldl_new(int64_t count, const ritz_sparse *const *A,
                          ritz_zldl **out);

/**
 * Say that every sum to come has, times one complex number, a definite real
 * part, as s^2 M + s D + K has off the imaginary axis where M, D and K are
 * semidefinite. Such factors are stable without pivots, and a fifth cheaper.
 */
void ritz_zldl_definite(ritz_zldl *F);

/** Factor sum_k c[k] A_k. @return RITZ_ERR_SINGULAR */
ritz_status ritz_zldl_factor(ritz_zldl *F, const double _Complex *c);

/** Overwrite @p X, n x k column-major, by the solution. */
ritz_status ritz_zldl_solve(ritz_zldl *F, int64_t k, double _Complex *X);

/** The same of the transposed matrix: of symmetric ones no other. */
ritz_status ritz_zldl_solve_transposed(ritz_zldl *F, int64_t k,
                                       double _Complex *X);
void ritz_zldl_free(ritz_zldl **F);

#pragma GCC visibility pop

#endif
