/*
 * Static gain of the flexible part, which rigid motion does not make infinite:
 *
 *     G = C Phi_f Lambda_f^-1 Phi_f' B
 *
 * and what motions without mass add to it.
 */
#include "verify/static_rest.h"

#include <ritz/eigen.h>
#include <ritz/verify.h>

ritz_status ritz_static_gain(const ritz_dense *K, const ritz_dense *M,
                             const ritz_io *io, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const ritz_second_order model = {.K = K, .M = M, .io = io};
    ritz_pairs pairs = {0};
    ritz_io modes = {0};
    ritz_residual rest = {0};

    RITZ_TRY(ritz_eigen_dense(K, M, &pairs));
    RITZ_TRY(ritz_io_project(io, &pairs.Phi, &modes));
    for (int64_t j = 0; j < modes.num_inputs; j++)
        for (int64_t k = 0; k < pairs.Phi.ncol; k++)
            ritz_dense_col(&modes.B, j)[k] *=
                k < pairs.num_rigid ? 0.0 : 1.0 / pairs.lambda[k];
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
