/*
 * The latest displacements X that the iteration found, a ring of columns, and
 * M, K and D between them: a small model of second order, for shifts.
 */
#include "base/alloc.h"
#include "gramians/low_rank_parts.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Twice the columns of a step at least, or this many. */
enum { COLUMNS = 96 };

/* Of the Gram matrix of columns of length one: rounding, twice over. */
static const double dependent = 1e-12;

ritz_status ritz_low_rank_window_new(const ritz_low_rank_model *model,
                                     ritz_low_rank_window *out)
{
    ritz_status status = RITZ_OK;
    ritz_low_rank_window window = {0};
    int64_t step = 2 * (model->W[RITZ_REACHED][RITZ_BELOW].ncol +
                        model->W[RITZ_SEEN][RITZ_BELOW].ncol);

    window.room = 2 * step > COLUMNS ? 2 * step : COLUMNS;
    RITZ_TRY(ritz_dense_new(model->n, window.room, &window.X));
    for (int k = 0; k < 3; k++)
        RITZ_TRY(ritz_dense_new(window.room, window.room, &window.G[k]));
    *out = window;
    window = (ritz_low_rank_window){0};
done:
    ritz_low_rank_window_free(&window);
    return status;
}

/* g := X'y, count entries. */
static void project(const ritz_low_rank_window *window, const double *y,
                    double *g)
{
    int n = (int)window->X.nrow;

    if (n > 0 && window->count > 0)
        cblas_dgemv(CblasColMajor, CblasTrans, n, (int)window->count, 1.0,
                    window->X.val, n, y, 1, 0.0, g, 1);
}

/* Column @p at of G = X'AX, and its row by A'; both are A x for symmetric A. */
static void put_products(int64_t at, const double *Ax, const double *Atx,
                         ritz_low_rank_window *window, ritz_dense *G)
{
    double *column = ritz_dense_col(G, at);

    project(window, Atx, column);
    for (int64_t j = 0; j < window->count; j++)
        ritz_dense_col(G, j)[at] = column[j];
    project(window, Ax, column);
}

static void put_column(const double *x, ritz_low_rank_window *window,
                       int64_t *at)
{
    size_t size = (size_t)window->X.nrow * sizeof *x;

    *at = window->next;
    memcpy(ritz_dense_col(&window->X, *at), x, size);
    window->next = (*at + 1) % window->room;
    if (window->count < window->room)
        window->count++;
}

ritz_status ritz_low_rank_window_add(const ritz_low_rank_model *model,
                                     const ritz_dense *X,
                                     ritz_low_rank_window *window)
{
    ritz_status status = RITZ_OK;
    const ritz_sparse *const A[3] = {&model->M, &model->K, &model->D};
    ritz_dense AX[3] = {0}, DtX = {0};

    for (int k = 0; k < 3; k++)
        RITZ_TRY(ritz_sparse_mul(A[k], X, &AX[k]));
    if (model->Dt.colptr)
        RITZ_TRY(ritz_sparse_mul(&model->Dt, X, &DtX));
    for (int64_t j = 0; j < X->ncol; j++) {
        int64_t at = 0;

        put_column(ritz_dense_col(X, j), window, &at);
        for (int k = 0; k < 3; k++) {
            const double *Ax = ritz_dense_col(&AX[k], j);
            bool turned = k == 2 && DtX.val;

            put_products(at, Ax, turned ? ritz_dense_col(&DtX, j) : Ax, window,
                         &window->G[k]);
        }
    }
done:
    for (int k = 0; k < 3; k++)
        ritz_dense_free(&AX[k]);
    ritz_dense_free(&DtX);
    return status;
}

/* A = V diag(e) V', V over A. */
static ritz_status symmetric_modes(ritz_dense *A, double *e)
{
    int n = (int)A->nrow;
    int info = 0;

    if (n > 0)
        info = LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', n, A->val, n, e);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "the latest displacements have no modes");
    return RITZ_OK;
}

/* F with F'GF = I, G = X'MX, of what is independent in X. */
static ritz_status orthonormal(const ritz_low_rank_window *window,
                               ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t c = window->count;
    int64_t first = 0;
    ritz_dense G = {0};
    double *size = NULL, *e = NULL;

    RITZ_NEW(size, c);
    RITZ_NEW(e, c);
    RITZ_TRY(ritz_dense_new(c, c, &G));
    for (int64_t j = 0; j < c; j++) {
        double g = ritz_dense_col(&window->G[0], j)[j];

        size[j] = g > 0.0 ? 1.0 / sqrt(g) : 0.0;
    }
    for (int64_t j = 0; j < c; j++)
        for (int64_t i = 0; i < c; i++)
            ritz_dense_col(&G, j)[i] =
                size[i] * ritz_dense_col(&window->G[0], j)[i] * size[j];
    RITZ_TRY(symmetric_modes(&G, e));
    while (first < c && !(e[first] > dependent * e[c - 1]))
        first++;
    RITZ_TRY(ritz_dense_columns(&G, first, c - first, out));
    for (int64_t j = 0; j < out->ncol; j++)
        for (int64_t i = 0; i < c; i++)
            ritz_dense_col(out, j)[i] *= size[i] / sqrt(e[first + j]);
done:
    ritz_dense_free(&G);
    free(size);
    free(e);
    return status;
}

/* F'GF of the columns that are there. */
static ritz_status between(const ritz_low_rank_window *window, int which,
                           const ritz_dense *F, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    int64_t c = window->count;
    ritz_dense G = {0};

    RITZ_TRY(ritz_dense_new(c, c, &G));
    for (int64_t j = 0; j < c; j++)
        memcpy(ritz_dense_col(&G, j), ritz_dense_col(&window->G[which], j),
               (size_t)c * sizeof *G.val);
    RITZ_TRY(ritz_dense_project(&G, F, out));
done:
    ritz_dense_free(&G);
    return status;
}

ritz_status ritz_low_rank_window_modes(const ritz_low_rank_window *window,
                                       ritz_dense *F, double **omega,
                                       ritz_dense *Delta)
{
    ritz_status status = RITZ_OK;
    ritz_dense V = {0}, K = {0}, modes = {0};
    double *w = NULL;

    RITZ_TRY(orthonormal(window, &V));
    RITZ_TRY(between(window, 1, &V, &K));
    RITZ_NEW(w, K.nrow);
    ritz_dense_symmetrise(&K);
    RITZ_TRY(symmetric_modes(&K, w));
    RITZ_TRY(ritz_dense_mul(&V, &K, &modes));
    RITZ_TRY(between(window, 2, &modes, Delta));
    for (int64_t k = 0; k < K.nrow; k++) /* the last one is exact enough */
        w[k] = sqrt(fmax(w[k], DBL_EPSILON * w[K.nrow - 1]));
    *F = modes;
    *omega = w;
    modes = (ritz_dense){0};
    w = NULL;
done:
    ritz_dense_free(&V);
    ritz_dense_free(&K);
    ritz_dense_free(&modes);
    free(w);
    return status;
}

void ritz_low_rank_window_free(ritz_low_rank_window *window)
{
    ritz_dense_free(&window->X);
    for (int k = 0; k < 3; k++)
        ritz_dense_free(&window->G[k]);
    *window = (ritz_low_rank_window){0};
}
