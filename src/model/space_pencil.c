/* The pencil of a state space, and the transfer function by its
   factorisations. */
#include "model/space.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <complex.h>
#include <math.h>

ritz_status ritz_pencil_of_space(const ritz_state_space *model,
                                 ritz_pencil *out)
{
    RITZ_OWN(ritz_sparse) A = {0}, E = {0};

    if (model->sA.colptr)
        return ritz_pencil_new(&model->sA, &model->sE, out);
    RITZ_CHECK(ritz_sparse_from_dense(&model->A, &A));
    if (model->E.val)
        RITZ_CHECK(ritz_sparse_from_dense(&model->E, &E));
    return ritz_pencil_new(&A, &E, out);
}

/* Whether a symmetric matrix is positive definite to working accuracy. */
static ritz_status is_definite(const ritz_sparse *A, bool *out)
{
    RITZ_OWN(ritz_factor) *L = NULL;
    ritz_status status = ritz_factor_spd(A, &L);

    *out = status == RITZ_OK;
    return status == RITZ_ERR_SINGULAR ? RITZ_OK : status;
}

ritz_status ritz_pencil_is_dissipative(const ritz_pencil *pencil, bool *out)
{
    RITZ_OWN(ritz_sparse) sum = {0};

    *out = false;
    if (ritz_sparse_asymmetry(&pencil->E) > 0.0)
        return RITZ_OK;
    RITZ_CHECK(is_definite(&pencil->E, out));
    if (!*out)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_add(-1.0, &pencil->A, -1.0,
                               ritz_pencil_system(pencil, true), &sum));
    return is_definite(&sum, out);
}

/* Solves with the columns of B, or with the rows of C if these are fewer. */
ritz_status ritz_space_transfer(const ritz_state_space *model,
                                ritz_pencil *pencil, double _Complex s,
                                double _Complex *H)
{
    const int64_t n = pencil->n, m = model->num_inputs, p = model->num_outputs;
    const bool dual = p < m;
    const int64_t count = dual ? p : m;
    RITZ_OWN_ARRAY double _Complex *X = NULL;

    RITZ_CHECK_NEW(X, n * count);
    for (int64_t k = 0; k < count; k++)
        for (int64_t i = 0; i < n; i++)
            X[i + k * n] = dual ? ritz_dense_col(&model->C, i)[k]
                                : ritz_dense_col(&model->B, k)[i];
    RITZ_CHECK(ritz_pencil_factor(pencil, s));
    RITZ_CHECK(ritz_pencil_solve(pencil, dual, count, X));
    for (int64_t i = 0; i < p; i++)
        for (int64_t j = 0; j < m; j++) {
            const double _Complex *x = X + (dual ? i : j) * n;
            double _Complex sum = 0.0;

            for (int64_t k = 0; k < n; k++)
                sum += x[k] * (dual ? ritz_dense_col(&model->B, j)[k]
                                    : ritz_dense_col(&model->C, k)[i]);
            H[i * m + j] = ritz_dense_col(&model->D, j)[i] - sum;
        }
    return RITZ_OK;
}

/* ARPACK does not converge next to a double pole with a single eigenvector. */
ritz_status ritz_space_slowest(ritz_pencil *pencil, int64_t count,
                               ritz_pencil_pairs *out)
{
    const double size =
        ritz_sparse_max(&pencil->A) / ritz_sparse_max(&pencil->E);
    double shift = RITZ_SHIFT_ASIDE * size;
    ritz_status status = ritz_pencil_nearest(pencil, 0.0, count, out);

    while ((status == RITZ_ERR_SINGULAR || status == RITZ_ERR_CONVERGENCE) &&
           shift < size) {
        status = ritz_pencil_nearest(pencil, shift, count, out);
        shift *= RITZ_SHIFT_FARTHER;
    }
    return status;
}
