/* Eigenpairs of the symmetric pencil K x = lambda M x. */
#ifndef RITZ_EIGEN_H
#define RITZ_EIGEN_H

#include <ritz/dense.h>
#include <ritz/sparse.h>
#include <ritz/text.h>

#pragma GCC visibility push(default)

typedef struct ritz_pairs {
    ritz_dense Phi;   /* n x k, Phi' M Phi = I, oriented as ritz_dense_orient */
    double *lambda;   /* k, ascending, as computed  [rad^2/s^2] */
    double *residual; /* k, |K x - lambda M x| / | |K||x| + |lambda||M||x| |,
                         |K| and |x| taken entry by entry */
    int64_t num_rigid; /* the first of them are rigid-body motions */
    double sigma;      /* shift that was used  [rad^2/s^2] */
    double proven_to; /* no mode is missing below  [rad^2/s^2]; NaN: unproven */
    char engine[RITZ_NAME_SIZE];
} ritz_pairs;

/* Which pairs: the lowest. Rigid modes are always found beside them. */
typedef struct ritz_span {
    int64_t modes;   /* so many flexible ones; -1: by frequency */
    double up_to_hz; /* every one up to this frequency, where modes is -1 */
} ritz_span;

/**
 * Lowest pairs of a sparse pencil: all rigid ones and the flexible ones asked.
 *
 * K is positive semidefinite, M too, and K + M positive definite: massless
 * dofs are allowed, dofs with neither stiffness nor mass are not. K - sigma M
 * is factored with sigma < 0 chosen by scale. That none is missing is proven
 * by the inertia of K - tau M, tau above the last pair returned; a cluster
 * (relative gap below 1e-6) at the end is returned whole, so there may be more
 * than asked. If fewer flexible modes exist than asked, all are returned.
 *
 * @return RITZ_ERR_SINGULAR if K + M is singular (a mechanism without mass);
 *         RITZ_ERR_CONVERGENCE if a residual stays above its limit or the
 *         inertia count finds a mode that was missed
 * @cost   a factor, about 2k solves, one LDL' factor for the proof
 */
ritz_status ritz_eigen_sparse(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, ritz_pairs *out);

/**
 * All pairs of a dense pencil, r x r, M positive definite, or semidefinite with
 * K + M definite (then the infinite ones are left out: Phi has fewer columns).
 *
 * @return RITZ_ERR_SINGULAR if neither holds
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
 * can tell rounding from a soft mode; the first of these that holds decides,
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

#pragma GCC visibility pop

#endif
