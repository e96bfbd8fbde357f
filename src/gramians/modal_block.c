/*
 * With S = d_i + d_j, Delta = w_i^2 - w_j^2, N = d_i w_j^2 + d_j w_i^2,
 * gamma = w_i g12 - w_j g21, den = Delta^2 + S N, the 2 x 2 block of
 *
 *     A_i' Y + Y A_j + g = 0
 *
 * is, in states (w q, q'),
 *
 *     y11 den = (d_i w_i^2 + d_j w_j^2 + S d_i d_j) g11 + S w_i w_j g22
 *               + w_j (Delta - S d_i) g12 - w_i (Delta + S d_j) g21
 *     y12 den = (d_i S - Delta) w_j g11 + S w_i gamma - Delta w_i g22
 *     y21 den = (d_j S + Delta) w_i g11 - S w_j gamma + Delta w_j g22
 *     y22 den = S w_i w_j g11 + Delta gamma + N g22
 *
 * Nothing is divided by S: light damping costs no digits. X = J Y J, g = J G J
 * turn it into the other equation. The tests hold both to it.
 */
#include "gramians/modal_block.h"

#include "base/alloc.h"

#include <stdlib.h>

ritz_status ritz_energy_new(const ritz_modal *modal, ritz_energy *out)
{
    ritz_status status = RITZ_OK;
    int64_t m = modal->count;
    ritz_energy model = {.count = m};

    RITZ_NEW(model.w, m);
    RITZ_NEW(model.d, m);
    RITZ_TRY(ritz_dense_new(2 * m, modal->B.ncol, &model.F[0]));
    RITZ_TRY(ritz_dense_new(2 * m, modal->C.nrow, &model.F[1]));
    for (int64_t k = 0; k < m; k++) {
        double w = modal->omega[k];

        RITZ_FAIL_IF(!(modal->zeta[k] > 0.0 && w > 0.0), RITZ_ERR_ARGUMENT,
                     "a mode without damping or stiffness has no Gramian");
        model.w[k] = w;
        model.d[k] = 2.0 * modal->zeta[k] * w;
        for (int64_t j = 0; j < modal->B.ncol; j++)
            ritz_dense_col(&model.F[0], j)[m + k] =
                ritz_dense_col(&modal->B, j)[k];
        for (int64_t i = 0; i < modal->C.nrow; i++) {
            ritz_dense_col(&model.F[1], i)[k] =
                ritz_dense_col(&modal->C, k)[i] / w;
            ritz_dense_col(&model.F[1], i)[m + k] =
                -ritz_dense_col(&modal->Cv, k)[i];
        }
    }
    *out = model;
    model = (ritz_energy){0};
done:
    ritz_energy_free(&model);
    return status;
}

void ritz_energy_blocks(const ritz_energy *model, int64_t j, int64_t upto,
                        const double *const G[static 2],
                        double *const X[static 2])
{
    int64_t m = model->count;
    double wj = model->w[j];
    double dj = model->d[j];
    const double *restrict w = model->w, *restrict d = model->d;
    const double *restrict g11 = G[0], *restrict g12 = G[1];
    const double *restrict g21 = G[0] + m, *restrict g22 = G[1] + m;
    double *restrict x11 = X[0], *restrict x12 = X[1];
    double *restrict x21 = X[0] + m, *restrict x22 = X[1] + m;

    for (int64_t i = 0; i < upto; i++) {
        double wi = w[i];
        double di = d[i];
        double S = di + dj;
        double Delta = (wi - wj) * (wi + wj);
        double N = di * wj * wj + dj * wi * wi;
        double by = 1.0 / (Delta * Delta + S * N);
        double gamma = wj * g21[i] - wi * g12[i];
        double ww = S * wi * wj;

        x11[i] = by * ((di * wi * wi + dj * wj * wj + S * di * dj) * g11[i] +
                       ww * g22[i] - wj * (Delta - S * di) * g12[i] +
                       wi * (Delta + S * dj) * g21[i]);
        x12[i] = by * ((Delta - di * S) * wj * g11[i] - S * wi * gamma +
                       Delta * wi * g22[i]);
        x21[i] = by * (-(dj * S + Delta) * wi * g11[i] + S * wj * gamma -
                       Delta * wj * g22[i]);
        x22[i] = by * (ww * g11[i] + Delta * gamma + N * g22[i]);
    }
}

void ritz_energy_free(ritz_energy *model)
{
    free(model->w);
    free(model->d);
    ritz_dense_free(&model->F[0]);
    ritz_dense_free(&model->F[1]);
    *model = (ritz_energy){0};
}
