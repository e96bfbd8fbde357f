/*
 * The rank of constraints is what counts: a row that is rounding and no
 * constraint would give a wrong system [McDaniel2000, table 3.3]. C' = Q_1 R
 * and a singular value decomposition of the small R show what is which.
 */
#include "assembly/null_space.h"

#include "base/alloc.h"

#include <lapacke.h>

#include <stdlib.h>
#include <string.h>

/* Singular values below this, relative to the largest, are rounding. */
static const double rank_tolerance = 1e-9;

/* How many singular values are more than rounding. */
static int64_t count_rank(int64_t count, const double *sigma)
{
    int64_t rank = 0;

    while (rank < count && sigma[rank] > rank_tolerance * sigma[0])
        rank++;
    return rank;
}

/*
 * N = Q_1 [U_2, 0; 0, I] with C' = Q_1 [R; 0], R = U S W', U_2 the left vectors
 * of no singular value: orthonormal, spans the null space of C.
 */
ritz_status ritz_null_space(const ritz_dense *C, int64_t *rank, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = C->ncol;
    int64_t c = C->nrow < n ? C->nrow : n;
    ritz_dense F = {0}, R = {0}, U = {0}, N = {0};
    double *tau = NULL, *sigma = NULL, *work = NULL;

    RITZ_NEW(tau, c);
    RITZ_NEW(sigma, c);
    RITZ_NEW(work, c);
    RITZ_TRY(ritz_dense_new(n, C->nrow, &F));
    RITZ_TRY(ritz_dense_new(c, C->nrow, &R));
    RITZ_TRY(ritz_dense_new(c, c, &U));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < C->nrow; i++)
            ritz_dense_col(&F, i)[j] = ritz_dense_col(C, j)[i];
    *rank = 0;
    if (c > 0) {
        RITZ_FAIL_IF(LAPACKE_dgeqrf(LAPACK_COL_MAJOR, (int)n, (int)C->nrow,
                                    F.val, (int)n, tau) != 0,
                     RITZ_ERR_MEMORY, "no memory for the constraints");
        for (int64_t j = 0; j < C->nrow; j++)
            for (int64_t i = 0; i <= j && i < c; i++)
                ritz_dense_col(&R, j)[i] = ritz_dense_col(&F, j)[i];
        RITZ_FAIL_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'A', 'N', (int)c,
                                    (int)C->nrow, R.val, (int)c, sigma, U.val,
                                    (int)c, NULL, 1, work) != 0,
                     RITZ_ERR_CONVERGENCE,
                     "singular values of the constraints do not converge");
        *rank = count_rank(c, sigma);
    }
    RITZ_TRY(ritz_dense_new(n, n - *rank, &N));
    for (int64_t j = *rank; j < n; j++)
        if (j < c)
            memcpy(ritz_dense_col(&N, j - *rank), ritz_dense_col(&U, j),
                   (size_t)c * sizeof *N.val);
        else
            ritz_dense_col(&N, j - *rank)[j] = 1.0;
    if (c > 0 && N.ncol > 0)
        RITZ_FAIL_IF(LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'N', (int)n,
                                    (int)N.ncol, (int)c, F.val, (int)n, tau,
                                    N.val, (int)n) != 0,
                     RITZ_ERR_MEMORY, "no memory for the constraints");
    *out = N;
    N = (ritz_dense){0};
done:
    free(tau);
    free(sigma);
    free(work);
    ritz_dense_free(&F);
    ritz_dense_free(&R);
    ritz_dense_free(&U);
    ritz_dense_free(&N);
    return status;
}
