#include "linear/sharpen.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <float.h>
#include <math.h>

int64_t ritz_pairs_lost(const ritz_pairs *P, const double *energy)
{
    int64_t end = P->Phi.ncol;

    while (end > P->num_rigid && !(energy[end - 1] * DBL_EPSILON >
                                   RITZ_DIGITS_FEW * P->lambda[end - 1]))
        end--;
    return end;
}

typedef ritz_status product(const ritz_sparse *A, const ritz_dense *X,
                            ritz_dense *Y);

/* Phi'A x for the columns x from first to end - 1 of Phi, AT_ONCE at a time, so
   that A x takes little memory. */
static ritz_status project_columns(const ritz_sparse *A, product *multiply,
                                   const ritz_dense *Phi, int64_t first,
                                   int64_t end, ritz_dense *out)
{
    enum { AT_ONCE = 16 };

    RITZ_CHECK(ritz_dense_new(Phi->ncol, end - first, out));
    for (int64_t j = first; j < end; j += AT_ONCE) {
        const ritz_dense x =
            ritz_dense_part(Phi, j, end - j < AT_ONCE ? end - j : AT_ONCE);
        RITZ_OWN(ritz_dense) Ax = {0}, part = {0};

        RITZ_CHECK(multiply(A, &x, &Ax));
        RITZ_CHECK(ritz_dense_mul_tn(Phi, &Ax, &part));
        ritz_dense_put(&part, 0, j - first, out);
    }
    return RITZ_OK;
}

/* The whole of Phi'A Phi from its columns `first` and following. All entries in
   other rows and columns are those of exact pairs: 0, and on the diagonal the
   numbers given, or 1 if they are NULL. */
static ritz_status complete(const ritz_dense *some, int64_t first,
                            const double *diagonal, ritz_dense *out)
{
    const int64_t end = first + some->ncol;

    RITZ_CHECK(ritz_dense_new(some->nrow, some->nrow, out));
    for (int64_t j = 0; j < some->nrow; j++)
        ritz_dense_col(out, j)[j] = diagonal ? diagonal[j] : 1.0;
    ritz_dense_put(some, 0, first, out);
    for (int64_t j = first; j < end; j++)
        for (int64_t i = 0; i < some->nrow; i++)
            if (i < first || i >= end)
                ritz_dense_col(out, i)[j] = ritz_dense_col(out, j)[i];
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

ritz_status ritz_pairs_turn(const ritz_pairs *P, const ritz_dense *some_K,
                            const ritz_dense *some_M, ritz_pairs *out)
{
    RITZ_OWN(ritz_dense) K_r = {0}, M_r = {0};

    RITZ_CHECK(complete(some_K, P->num_rigid, P->lambda, &K_r));
    RITZ_CHECK(complete(some_M, P->num_rigid, NULL, &M_r));
    return ritz_eigen_dense(&K_r, &M_r, out);
}

ritz_status ritz_pairs_sharpen(const ritz_sparse *K, const ritz_sparse *M,
                               const double *energy, ritz_pairs *P)
{
    const int64_t first = P->num_rigid;
    const int64_t end = ritz_pairs_lost(P, energy);
    RITZ_OWN(ritz_dense) some_K = {0}, some_M = {0};
    RITZ_OWN(ritz_pairs) found = {0};
    double scale = 0.0; /* as of ritz_pairs_relate() */

    if (end == first)
        return RITZ_OK;
    RITZ_CHECK(project_columns(K, ritz_sparse_mul_twofold, &P->Phi, first, end,
                               &some_K));
    RITZ_CHECK(
        project_columns(M, ritz_sparse_mul, &P->Phi, first, end, &some_M));
    RITZ_CHECK(ritz_pairs_turn(P, &some_K, &some_M, &found));
    RITZ_CHECK(ritz_dense_times(&found.Phi, &P->Phi));
    for (int64_t j = 0; j < P->Phi.ncol; j++) {
        P->lambda[j] = found.lambda[j];
        scale = fmax(scale, energy[j]);
    }
    P->num_rigid = ritz_eigen_rigid(P->Phi.ncol, P->lambda, scale);
    return RITZ_OK;
}
