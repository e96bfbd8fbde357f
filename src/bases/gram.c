#include "bases/gram.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

/* Of the energy of a column: less is left to the next round. */
static const double strong = 1e-3;

ritz_status ritz_gram_weigh(const ritz_sparse *W, const ritz_dense *R,
                            ritz_dense *WR)
{
    ritz_status status = RITZ_OK;
    ritz_dense product = {0};

    if (R->nrow * R->ncol == 0)
        return RITZ_OK;
    if (W)
        RITZ_TRY(ritz_sparse_mul(W, R, &product));
    memcpy(WR->val, W ? product.val : R->val,
           (size_t)(R->nrow * R->ncol) * sizeof *R->val);
done:
    ritz_dense_free(&product);
    return status;
}

int64_t ritz_gram_pivots(ritz_dense *G, int64_t most, int64_t *order)
{
    int64_t p = G->ncol;
    int64_t count = 0;

    while (count < most && count < p) {
        int64_t pivot = 0;
        double d = 0.0;

        for (int64_t j = 1; j < p; j++)
            if (ritz_dense_col(G, j)[j] >
                ritz_dense_col(G, pivot)[pivot] * (1.0 + 1e-9))
                pivot = j;
        d = ritz_dense_col(G, pivot)[pivot];
        if (!(d > strong))
            break;
        order[count++] = pivot;
        for (int64_t j = 0; j < p; j++) {
            double factor = ritz_dense_col(G, j)[pivot] / d;

            for (int64_t i = 0; i < p && j != pivot; i++)
                ritz_dense_col(G, j)[i] -= factor * ritz_dense_col(G, pivot)[i];
        }
        for (int64_t j = 0; j < p; j++)
            ritz_dense_col(G, j)[pivot] = ritz_dense_col(G, pivot)[j] = 0.0;
    }
    return count;
}

/* G := L of G = L L', column by column; the upper triangle stays. */
static ritz_status cholesky(ritz_dense *G)
{
    int64_t p = G->ncol;

    for (int64_t j = 0; j < p; j++) {
        double *g = ritz_dense_col(G, j);
        double d = sqrt(g[j]);

        RITZ_REFUSE_IF(!(g[j] > 0.0), RITZ_ERR_CONVERGENCE,
                       "a block of vectors lost its independence");
        for (int64_t i = j; i < p; i++)
            g[i] /= d;
        for (int64_t k = j + 1; k < p; k++)
            for (int64_t i = k; i < p; i++)
                ritz_dense_col(G, k)[i] -= g[i] * g[k];
    }
    return RITZ_OK;
}

ritz_status ritz_gram_normalise(const ritz_sparse *W, ritz_dense *Q,
                                ritz_dense *WQ)
{
    ritz_status status = RITZ_OK;
    ritz_dense G = {0};
    int n = (int)Q->nrow;
    int p = (int)Q->ncol;

    for (int pass = 0; pass < 2; pass++) {
        RITZ_TRY(ritz_dense_mul_tn(Q, WQ, &G));
        ritz_dense_symmetrise(&G);
        RITZ_TRY(cholesky(&G));
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans,
                    CblasNonUnit, n, p, 1.0, G.val, p, Q->val, n);
        RITZ_TRY(ritz_gram_weigh(W, Q, WQ));
        ritz_dense_free(&G);
    }
done:
    ritz_dense_free(&G);
    return status;
}
