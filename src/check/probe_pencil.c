/*
 * Where on the axis G + G^* may become singular [Boyd1989]: eigenvalues of
 *
 *     [ A  0   B      ]     [ I 0 0 ]
 *     [ 0 -A' -C'     ] - s [ 0 I 0 ]
 *     [ C  B'  D + D' ]     [ 0 0 0 ]
 */
#include "check/probe_parts.h"

#include "base/alloc.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Of |s|: an eigenvalue of the pencil no further from the axis is on it. */
static const double on_axis = 1e-6;
/* Velocities: C A and C B of what is a displacement. */
static ritz_status velocities(const ritz_collocated *model, ritz_dense *C,
                              ritz_dense *D)
{
    ritz_status status = RITZ_OK;
    ritz_dense CA = {0}, CB = {0};

    RITZ_TRY(ritz_dense_copy(&model->C, C));
    RITZ_TRY(ritz_dense_copy(&model->D, D));
    RITZ_TRY(ritz_dense_mul(&model->C, &model->A, &CA));
    RITZ_TRY(ritz_dense_mul(&model->C, &model->B, &CB));
    for (int64_t i = 0; i < C->nrow; i++) {
        if (model->power[i] != 1)
            continue;
        for (int64_t j = 0; j < C->ncol; j++)
            ritz_dense_col(C, j)[i] = ritz_dense_col(&CA, j)[i];
        for (int64_t j = 0; j < D->ncol; j++)
            ritz_dense_col(D, j)[i] = ritz_dense_col(&CB, j)[i];
    }
done:
    ritz_dense_free(&CA);
    ritz_dense_free(&CB);
    return status;
}

static ritz_status build_pencil(const ritz_collocated *model, double slack,
                                ritz_dense *P, ritz_dense *Q)
{
    ritz_status status = RITZ_OK;
    int64_t n = model->A.nrow, p = model->B.ncol, all = 2 * n + p;
    ritz_dense C = {0}, D = {0};

    RITZ_TRY(velocities(model, &C, &D));
    RITZ_TRY(ritz_dense_new(all, all, P));
    RITZ_TRY(ritz_dense_new(all, all, Q));
    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(Q, j)[j] = ritz_dense_col(Q, n + j)[n + j] = 1.0;
        for (int64_t i = 0; i < n; i++) {
            ritz_dense_col(P, j)[i] = ritz_dense_col(&model->A, j)[i];
            ritz_dense_col(P, n + i)[n + j] = -ritz_dense_col(&model->A, j)[i];
        }
        for (int64_t i = 0; i < p; i++) {
            ritz_dense_col(P, j)[2 * n + i] = ritz_dense_col(&C, j)[i];
            ritz_dense_col(P, 2 * n + i)[n + j] = -ritz_dense_col(&C, j)[i];
            ritz_dense_col(P, 2 * n + i)[j] = ritz_dense_col(&model->B, i)[j];
            ritz_dense_col(P, n + j)[2 * n + i] =
                ritz_dense_col(&model->B, i)[j];
        }
    }
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(P, 2 * n + j)[2 * n + i] =
                ritz_dense_col(&D, j)[i] + ritz_dense_col(&D, i)[j] +
                (i == j ? 2.0 * slack : 0.0);
done:
    ritz_dense_free(&C);
    ritz_dense_free(&D);
    return status;
}

ritz_status ritz_passivity_crossings(const ritz_collocated *model, double slack,
                                     int64_t *count, double **out)
{
    ritz_status status = RITZ_OK;
    ritz_dense P = {0}, Q = {0};
    double *re = NULL, *im = NULL, *beta = NULL, *w = NULL;
    int all = 0;
    int64_t found = 0;

    *count = 0;
    for (int64_t i = 0; i < model->B.ncol; i++)
        if (model->power[i] < 0) /* an integrator is on the axis itself */
            return RITZ_OK;
    RITZ_TRY(build_pencil(model, slack, &P, &Q));
    all = (int)P.nrow;
    RITZ_NEW(re, all);
    RITZ_NEW(im, all);
    RITZ_NEW(beta, all);
    RITZ_NEW(w, all);
    RITZ_FAIL_IF(LAPACKE_dggev(LAPACK_COL_MAJOR, 'N', 'N', all, P.val, all,
                               Q.val, all, re, im, beta, NULL, 1, NULL, 1) != 0,
                 RITZ_ERR_CONVERGENCE,
                 "eigenvalues of a Hamiltonian pencil were not found");
    for (int64_t k = 0; k < all; k++)
        if (beta[k] > 0.0 && im[k] > 0.0 && fabs(re[k]) <= on_axis * im[k] &&
            isfinite(im[k] / beta[k]))
            w[found++] = im[k] / beta[k];
    *count = ritz_probe_sort(found, w);
    *out = w;
    w = NULL;
done:
    ritz_dense_free(&P);
    ritz_dense_free(&Q);
    free(re);
    free(im);
    free(beta);
    free(w);
    return status;
}
