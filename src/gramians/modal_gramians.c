/*
 * Exact Gramians of a modal model, block by block: B B' and C'C as products of
 * whole matrices, then a column of blocks at a time (modal_block.c) in states
 * of energy, put in place as (q_1, q_1', q_2, ...).
 */
#include "base/alloc.h"
#include "gramians/modal_block.h"

#include <stdlib.h>

enum { TILE = 32 };

/*
 * Blocks 0 .. j of columns 2j and 2j + 1 of W from two columns of X, as
 * W = t X t', t = diag(w, 1) or its inverse; with J, turned.
 */
static void put(const double *t, double sign, int64_t j, int64_t m,
                double *const X[static 2], ritz_dense *W)
{
    double *position = ritz_dense_col(W, 2 * j);
    double *velocity = ritz_dense_col(W, 2 * j + 1);

    for (int64_t i = 0; i <= j; i++) {
        position[2 * i] = t[i] * t[j] * X[0][i];
        position[2 * i + 1] = sign * t[j] * X[0][m + i];
        velocity[2 * i] = sign * t[i] * X[1][i];
        velocity[2 * i + 1] = X[1][m + i];
    }
    /* exactly symmetric: the block of a mode with itself has x12 = x21 */
    position[2 * j + 1] = velocity[2 * j];
}

/* Below the diagonal what is above it, tile by tile. */
static void mirror(ritz_dense *W)
{
    int64_t n = W->nrow;

    for (int64_t J = 0; J < n; J += TILE)
        for (int64_t I = 0; I <= J; I += TILE)
            for (int64_t j = J; j < n && j < J + TILE; j++)
                for (int64_t i = I; i < j && i < I + TILE; i++)
                    ritz_dense_col(W, i)[j] = ritz_dense_col(W, j)[i];
}

static ritz_status gramian(const ritz_energy *model, const ritz_dense *F,
                           const double *t, double sign, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t m = model->count;
    ritz_dense G = {0}, X = {0}, W = {0};

    RITZ_TRY(ritz_dense_mul_nt(F, F, &G));
    RITZ_TRY(ritz_dense_new(2 * m, 2, &X));
    RITZ_TRY(ritz_dense_new(2 * m, 2 * m, &W));
    for (int64_t j = 0; j < m; j++) {
        const double *const g[2] = {ritz_dense_col(&G, j),
                                    ritz_dense_col(&G, m + j)};
        double *const x[2] = {X.val, X.val + 2 * m};

        ritz_energy_blocks(model, j, j + 1, g, x);
        put(t, sign, j, m, x, &W);
    }
    mirror(&W);
    *out = W;
    W = (ritz_dense){0};
done:
    ritz_dense_free(&G);
    ritz_dense_free(&X);
    ritz_dense_free(&W);
    return status;
}

ritz_status ritz_modal_gramians(const ritz_modal *modal, ritz_dense *Wc,
                                ritz_dense *Wo)
{
    ritz_status status = RITZ_OK;
    ritz_energy model = {0};
    ritz_dense X = {0}, Y = {0};
    double *inverse = NULL;

    RITZ_TRY(ritz_energy_new(modal, &model));
    RITZ_NEW(inverse, modal->count);
    for (int64_t k = 0; k < modal->count; k++)
        inverse[k] = 1.0 / modal->omega[k];
    RITZ_TRY(gramian(&model, &model.F[0], inverse, 1.0, &X));
    RITZ_TRY(gramian(&model, &model.F[1], modal->omega, -1.0, &Y));
    *Wc = X;
    *Wo = Y;
    X = (ritz_dense){0};
    Y = (ritz_dense){0};
done:
    free(inverse);
    ritz_energy_free(&model);
    ritz_dense_free(&X);
    ritz_dense_free(&Y);
    return status;
}
