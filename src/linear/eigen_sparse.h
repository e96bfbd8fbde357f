/* Lowest eigenpairs of a sparse pencil, with a factor that the caller has or
 * that the search lends. */
#ifndef RITZ_LINEAR_EIGEN_SPARSE_H
#define RITZ_LINEAR_EIGEN_SPARSE_H

#include "linear/trial.h"

#include <ritz/matrix.h>

/** Something that needs the factor of a search as well as its pairs. */
typedef struct ritz_factor_use {
    /**
     * @param[in] of     the member below
     * @param[in] found  pairs of the search, more than were requested as a rule
     * @param[in] count  the first so many of them were requested
     * @param[in] A      the factor of K - sigma M; NULL: none is left
     * @return a failure ends the search with the same status
     */
    ritz_status (*call)(void *of, const ritz_pairs *found, int64_t count,
                        ritz_factor *A, double sigma);
    void *of;
} ritz_factor_use;

/**
 * ritz_eigen_sparse() that lends its factor: use->call is called once the pairs
 * are found, before the count by number frees the factor. If the count finds
 * that pairs are missing, the search goes on and use->call is called again: the
 * last call has the pairs that are returned. By then slices may have freed the
 * factor. Of a small pencil, which LAPACK solves, there is no call.
 *
 * @param[in] use  NULL: the factor is not lent
 */
ritz_status ritz_eigen_lending(const ritz_sparse *K, const ritz_sparse *M,
                               const ritz_span *span,
                               const ritz_factor_use *use, ritz_pairs *out);

/**
 * ritz_eigen_sparse() for a positive definite K whose Cholesky factor the
 * caller has. The search uses this factor (sigma = 0) instead of making one of
 * K - sigma M. The factor is freed once the pairs are found, before the count
 * makes its own, so that memory holds one factor at a time.
 *
 * @param[in,out] K,M  folded while block Lanczos does not need them, see
 *                     folded.h: their arrays may be others afterwards, with the
 *                     same contents. After RITZ_ERR_MEMORY they may be empty
 * @param[in,out] L    the factor of K; freed and NULL afterwards, also on
 *                     failure
 * @param[in]     use  as of ritz_eigen_lending(); of a small pencil, it is called
 *                     with the factor given, after LAPACK
 */
ritz_status ritz_eigen_factored(ritz_sparse *K, ritz_sparse *M, ritz_factor **L,
                                const ritz_span *span,
                                const ritz_factor_use *use, ritz_pairs *out);

/** Bytes that ritz_eigen_factored() needs beside the factor at least; 0: not
 * known, as for modes up to a frequency. */
int64_t ritz_eigen_factored_needs(const ritz_sparse *K, const ritz_sparse *M,
                                  const ritz_span *span);

/** What the caller of a search hands over to it. */
typedef struct ritz_eigen_given {
    ritz_factor **L; /* a factor of K, which is taken over; NULL: none */
    ritz_sparse *K,
        *M; /* the same as those of the search, which may be folded; NULL */
    const ritz_trial *size; /* of a test; NULL: that of ritz_trial_here() */
} ritz_eigen_given;

/**
 * ritz_eigen_sparse() without its cases for LAPACK and without its checks.
 *
 * @param[in] given  NULL: nothing
 * @param[in] use    NULL: the factor is not lent
 */
ritz_status ritz_eigen_search(const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_eigen_given *given,
                              const ritz_span *span, const ritz_factor_use *use,
                              ritz_pairs *out);

/** RITZ_ERR_ARGUMENT if the span has an accuracy that is out of range, or an
 * engine that finds eigenvalues to rounding only. */
ritz_status ritz_eigen_refuse_accuracy(const ritz_span *span);

#endif
