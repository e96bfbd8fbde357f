#include "moments.h"

#include "project.h"
#include "testing.h"

#include <ritz/eigen.h>

#include <lapacke.h>
#include <stdlib.h>

moments_model moments_full(const ritz_component *component)
{
    moments_model model = {0};

    assert_ok(ritz_sparse_dense(&component->K, &model.K));
    assert_ok(ritz_sparse_dense(&component->M, &model.M));
    if (component->D.colptr)
        assert_ok(ritz_sparse_dense(&component->D, &model.D));
    assert_ok(ritz_dense_copy(&component->io.B, &model.B));
    assert_ok(ritz_dense_copy(&component->io.C, &model.C));
    return model;
}

moments_model moments_reduced(const ritz_component *component,
                              const ritz_dense *T)
{
    moments_model model = {0};

    model.K = project(&component->K, T);
    model.M = project(&component->M, T);
    if (component->D.colptr)
        model.D = project(&component->D, T);
    assert_ok(ritz_dense_mul_tn(T, &component->io.B, &model.B));
    assert_ok(ritz_dense_mul(&component->io.C, T, &model.C));
    return model;
}

ritz_dense moments_undamped(const moments_model *model, double sigma, int j)
{
    ritz_pairs pairs = {0};
    ritz_dense seen = {0}, pushed = {0}, out = {0};

    assert_ok(ritz_eigen_dense(&model->K, &model->M, &pairs));
    assert_ok(ritz_dense_mul(&model->C, &pairs.Phi, &seen));
    assert_ok(ritz_dense_mul_tn(&pairs.Phi, &model->B, &pushed));
    for (int64_t k = 0; k < pairs.Phi.ncol; k++) {
        double share = k < pairs.num_rigid ? 0.0 : 1.0;

        for (int power = 0; power <= j && share != 0.0; power++)
            share /= pairs.lambda[k] - sigma;
        for (int64_t i = 0; i < seen.nrow; i++)
            ritz_dense_col(&seen, k)[i] *= share;
    }
    assert_ok(ritz_dense_mul(&seen, &pushed, &out));
    ritz_pairs_free(&pairs);
    ritz_dense_free(&seen);
    ritz_dense_free(&pushed);
    return out;
}

/* X := K^-1 X */
static void solve(const ritz_dense *K, ritz_dense *X)
{
    ritz_dense LU = {0};
    int n = (int)K->nrow;
    int *pivot = calloc((size_t)n, sizeof *pivot);

    assert_non_null(pivot);
    assert_ok(ritz_dense_copy(K, &LU));
    assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, n, (int)X->ncol, LU.val, n,
                                   pivot, X->val, n),
                     0);
    ritz_dense_free(&LU);
    free(pivot);
}

/* X := -A X, added to what is in sum. */
static void subtract(const ritz_dense *A, const ritz_dense *X, ritz_dense *sum)
{
    ritz_dense AX = {0};

    if (!A->val || !X->val)
        return;
    assert_ok(ritz_dense_mul(A, X, &AX));
    for (int64_t k = 0; k < AX.nrow * AX.ncol; k++)
        sum->val[k] -= AX.val[k];
    ritz_dense_free(&AX);
}

/* X_0 = K^-1 B, X_j = -K^-1 (D X_j-1 + M X_j-2). */
ritz_dense moments_damped(const moments_model *model, int j)
{
    ritz_dense X = {0}, before = {0}, out = {0};

    assert_ok(ritz_dense_copy(&model->B, &X));
    solve(&model->K, &X);
    for (int k = 0; k < j; k++) {
        ritz_dense next = {0};

        assert_ok(ritz_dense_new(X.nrow, X.ncol, &next));
        subtract(&model->D, &X, &next);
        subtract(&model->M, &before, &next);
        solve(&model->K, &next);
        ritz_dense_free(&before);
        before = X;
        X = next;
    }
    assert_ok(ritz_dense_mul(&model->C, &X, &out));
    ritz_dense_free(&X);
    ritz_dense_free(&before);
    return out;
}

static ritz_dense moment(const moments_model *model, double sigma, int j)
{
    return isnan(sigma) ? moments_damped(model, j)
                        : moments_undamped(model, sigma, j);
}

double moments_differ(const moments_model *full, const moments_model *reduced,
                      double sigma, int j)
{
    ritz_dense a = moment(full, sigma, j);
    ritz_dense b = moment(reduced, sigma, j);
    double size = ritz_dense_max(&a);

    for (int64_t k = 0; k < a.nrow * a.ncol; k++)
        b.val[k] -= a.val[k];
    size = ritz_dense_max(&b) / size;
    ritz_dense_free(&a);
    ritz_dense_free(&b);
    return size;
}

void moments_agree(const moments_model *full, const moments_model *reduced,
                   double sigma, int count, double bound)
{
    for (int j = 0; j < count; j++) {
        double error = moments_differ(full, reduced, sigma, j);

        if (!(error <= bound))
            fail_msg("moment %d differs by %.2e, allowed %.2e", j, error,
                     bound);
    }
}

void moments_free(moments_model *model)
{
    ritz_dense_free(&model->K);
    ritz_dense_free(&model->M);
    ritz_dense_free(&model->D);
    ritz_dense_free(&model->B);
    ritz_dense_free(&model->C);
    *model = (moments_model){0};
}
