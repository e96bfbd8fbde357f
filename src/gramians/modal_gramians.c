/*
 * Exact Gramians of a modal model, block by block: with states (q, q') of modes
 * i and j, d = 2 zeta w, S = d_i + d_j, Delta = w_i^2 - w_j^2,
 * N = d_i w_j^2 + d_j w_i^2, the 2 x 2 blocks of
 *
 *     A W_c + W_c A' + B B' = 0,    A' W_o + W_o A + C'C = 0
 *
 * are, with beta = b_i b_j',
 *
 *     x11 = beta S / (Delta^2 + S N)      x12 = Delta x11 / S = -x21
 *     x22 = w_j^2 x11 + d_j x12
 *
 * and with g11 = cd_i'cd_j, g12 = cd_i'cv_j, g21 = cv_i'cd_j, g22 = cv_i'cv_j,
 * gamma = g12 - g21,
 *
 *     y22 = (S g11 + N g22 + Delta gamma) / (Delta^2 + S N)
 *     s   = (S (S g11 + Delta gamma) - Delta^2 g22) / (Delta^2 + S N)
 *     y12 = (d_i s - Delta y22 + gamma) / S
 *     y21 = (d_j s + Delta y22 - gamma) / S     (y12 + y21 = s)
 *     y11 = w_i^2 y22 + d_j y12 - g12
 *
 * The tests hold both to the Lyapunov equations.
 */
#include "base/alloc.h"

#include <ritz/modal.h>

#include <math.h>

/* What a block takes from its pair of modes. */
typedef struct pair {
    double wi2, wj2;      /* w^2 */
    double di, dj;        /* 2 zeta w */
    double S, Delta, den; /* as above, den = Delta^2 + S N */
    double N;
} pair;

static pair pair_of(const ritz_modal *modal, int64_t i, int64_t j)
{
    double wi = modal->omega[i];
    double wj = modal->omega[j];
    pair p = {.wi2 = wi * wi, .wj2 = wj * wj};

    p.di = 2.0 * modal->zeta[i] * wi;
    p.dj = 2.0 * modal->zeta[j] * wj;
    p.S = p.di + p.dj;
    p.Delta = (wi - wj) * (wi + wj);
    p.N = p.di * p.wj2 + p.dj * p.wi2;
    p.den = p.Delta * p.Delta + p.S * p.N;
    return p;
}

/* Put a block, and below the diagonal its transpose. */
static void put(ritz_dense *W, int64_t i, int64_t j, const double x[2][2])
{
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            ritz_dense_col(W, 2 * j + b)[2 * i + a] = x[a][b];
            ritz_dense_col(W, 2 * i + a)[2 * j + b] = x[a][b];
        }
}

static void controllability(const pair *p, double beta, double x[2][2])
{
    x[0][0] = beta * p->S / p->den;
    x[0][1] = p->Delta * x[0][0] / p->S;
    x[1][0] = -x[0][1];
    x[1][1] = p->wj2 * x[0][0] + p->dj * x[0][1];
}

static void observability(const pair *p, const double g[2][2], double y[2][2])
{
    double gamma = g[0][1] - g[1][0];
    double e = p->S * g[0][0] + p->Delta * gamma;
    double s = (p->S * e - p->Delta * p->Delta * g[1][1]) / p->den;

    y[1][1] = (e + p->N * g[1][1]) / p->den;
    y[0][1] = (p->di * s - p->Delta * y[1][1] + gamma) / p->S;
    y[1][0] = (p->dj * s + p->Delta * y[1][1] - gamma) / p->S;
    y[0][0] = p->wi2 * y[1][1] + p->dj * y[0][1] - g[0][1];
}

/* Dot products of columns i and j of C, and of their velocity parts. */
static void outputs(const ritz_modal *modal, int64_t i, int64_t j,
                    double g[2][2])
{
    const double *ci[2] = {ritz_dense_col(&modal->C, i),
                           ritz_dense_col(&modal->Cv, i)};
    const double *cj[2] = {ritz_dense_col(&modal->C, j),
                           ritz_dense_col(&modal->Cv, j)};

    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            g[a][b] = 0.0;
            for (int64_t k = 0; k < modal->C.nrow; k++)
                g[a][b] += ci[a][k] * cj[b][k];
        }
}

static double inputs(const ritz_modal *modal, int64_t i, int64_t j)
{
    double beta = 0.0;

    for (int64_t k = 0; k < modal->B.ncol; k++) {
        const double *b = ritz_dense_col(&modal->B, k);

        beta += b[i] * b[j];
    }
    return beta;
}

ritz_status ritz_modal_gramians(const ritz_modal *modal, ritz_dense *Wc,
                                ritz_dense *Wo)
{
    ritz_status status = RITZ_OK;
    int64_t m = modal->count;
    ritz_dense X = {0};
    ritz_dense Y = {0};
    double block[2][2];
    double g[2][2];

    for (int64_t k = 0; k < m; k++)
        RITZ_FAIL_IF(!(modal->zeta[k] > 0.0 && modal->omega[k] > 0.0),
                     RITZ_ERR_ARGUMENT,
                     "a mode without damping or stiffness has no Gramian");
    RITZ_TRY(ritz_dense_new(2 * m, 2 * m, &X));
    RITZ_TRY(ritz_dense_new(2 * m, 2 * m, &Y));
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i <= j; i++) {
            pair p = pair_of(modal, i, j);

            controllability(&p, inputs(modal, i, j), block);
            put(&X, i, j, block);
            outputs(modal, i, j, g);
            observability(&p, g, block);
            put(&Y, i, j, block);
        }
    *Wc = X;
    *Wo = Y;
    X = (ritz_dense){0};
    Y = (ritz_dense){0};
done:
    ritz_dense_free(&X);
    ritz_dense_free(&Y);
    return status;
}
