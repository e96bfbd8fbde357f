/*
 * Static gain of the flexible part, which rigid motion does not make infinite:
 *
 *     G = C Phi_f Lambda_f^-1 Phi_f' B
 *
 * and what motions without mass add to it.
 */
#include "linear/general.h"
#include "poles/static_rest.h"

#include <ritz/eigen.h>
#include <ritz/verify.h>

#include <math.h>

/* A gain this much smaller than its error is rounding. */
static const double no_gain = 1e-14;

ritz_status ritz_static_gain(const ritz_dense *K, const ritz_dense *M,
                             const ritz_io *io, int64_t num_rigid,
                             ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const ritz_second_order model = {.K = K, .M = M, .io = io};
    ritz_pairs pairs = {0};
    ritz_io modes = {0};
    ritz_residual rest = {0};

    RITZ_TRY(ritz_eigen_dense(K, M, &pairs));
    if (num_rigid < pairs.num_rigid)
        num_rigid = pairs.num_rigid;
    RITZ_TRY(ritz_io_project(io, &pairs.Phi, &modes));
    for (int64_t j = 0; j < modes.num_inputs; j++)
        for (int64_t k = 0; k < pairs.Phi.ncol; k++)
            ritz_dense_col(&modes.B, j)[k] *=
                k < num_rigid ? 0.0 : 1.0 / pairs.lambda[k];
    RITZ_TRY(ritz_static_rest(&model, &pairs, &rest));
    RITZ_TRY(ritz_dense_mul(&modes.C, &modes.B, out));
    for (int64_t k = 0; rest.count > 0 && k < out->nrow * out->ncol; k++)
        out->val[k] += rest.C[k];
done:
    ritz_residual_free(&rest);
    ritz_pairs_free(&pairs);
    ritz_io_free(&modes);
    return status;
}

ritz_status ritz_gain_error(const ritz_dense *full, const ritz_dense *reduced,
                            double *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense G = {0}, apart = {0};
    double size = 0.0;
    double error = 0.0;

    RITZ_TRY(ritz_dense_copy(full, &G));
    RITZ_TRY(ritz_dense_copy(reduced, &apart));
    for (int64_t k = 0; k < G.nrow * G.ncol; k++)
        apart.val[k] -= G.val[k];
    RITZ_TRY_IN("static gain", ritz_general_norm(&G, &size));
    RITZ_TRY_IN("static gain", ritz_general_norm(&apart, &error));
    *out = error == 0.0 ? 0.0 : size > no_gain * error ? error / size : nan("");
done:
    ritz_dense_free(&G);
    ritz_dense_free(&apart);
    return status;
}
