/*
 * Motions without mass. With A = K + alpha M = C C', definite, the columns of
 * C'Phi are orthogonal; N is C'^-1 of what completes them:
 *
 *     N'AN = I,   Phi'AN = (Lambda + alpha) Phi'MN = 0,   so M N = 0
 */
#include "poles/massless.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* C, lower triangle, of K + alpha M; alpha beyond all |lambda|. */
static ritz_status factor_shifted(const ritz_second_order *model, int64_t m,
                                  const double *lambda, ritz_dense *C)
{
    int n = (int)model->K->nrow;
    double alpha = 0.0;
    int info = 0;

    for (int64_t k = 0; k < m; k++)
        alpha = fmax(alpha, 2.0 * fabs(lambda[k]));
    if (alpha == 0.0)
        alpha = 1.0;
    RITZ_CHECK(ritz_dense_copy(model->K, C));
    for (int64_t i = 0; i < C->nrow * C->ncol; i++)
        C->val[i] += alpha * model->M->val[i];
    info = LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, C->val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_SINGULAR,
                   "neither mass nor stiffness holds a motion");
    return RITZ_OK;
}

/* The last n - m columns of an orthonormal basis whose first span B's. */
static ritz_status complete_basis(ritz_dense *B, ritz_dense *out)
{
    int n = (int)B->nrow;
    int m = (int)B->ncol;
    RITZ_OWN_ARRAY double *tau = NULL;
    int info = 0;

    RITZ_CHECK_NEW(tau, m);
    RITZ_CHECK(ritz_dense_new(n, n - m, out));
    for (int64_t j = 0; j < n - m; j++)
        ritz_dense_col(out, j)[m + j] = 1.0;
    if (m > 0)
        info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, n, m, B->val, n, tau);
    if (m > 0 && info == 0)
        info = LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'N', n, n - m, m, B->val,
                              n, tau, out->val, n);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "the motions without mass were not found");
    return RITZ_OK;
}

ritz_status ritz_massless(const ritz_second_order *model, const ritz_dense *Phi,
                          const double *lambda, ritz_dense *out)
{
    int n = (int)Phi->nrow;
    int m = (int)Phi->ncol;
    RITZ_OWN(ritz_dense) C = {0}, B = {0}, N = {0};

    RITZ_CHECK(factor_shifted(model, m, lambda, &C));
    RITZ_CHECK(ritz_dense_copy(Phi, &B));
    if (m > 0)
        cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, n, m, 1.0, C.val, n, B.val, n);
    RITZ_CHECK(complete_basis(&B, &N));
    if (n > m)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, n, n - m, 1.0, C.val, n, N.val, n);
    RITZ_MOVE(*out, N);
    return RITZ_OK;
}

/* out = C N (N'B), num_outputs x num_inputs. */
static ritz_status put_static(const ritz_dense *C, const ritz_dense *N,
                              const ritz_dense *NB, double *out)
{
    RITZ_OWN(ritz_dense) CN = {0}, H = {0};

    RITZ_CHECK(ritz_dense_mul(C, N, &CN));
    RITZ_CHECK(ritz_dense_mul(&CN, NB, &H));
    memcpy(out, H.val, (size_t)(H.nrow * H.ncol) * sizeof *out);
    return RITZ_OK;
}

ritz_status ritz_static_rest(const ritz_second_order *model,
                             const ritz_pairs *pairs, ritz_residual *out)
{
    const ritz_io *io = model->io;
    int64_t size = io->num_outputs * io->num_inputs;
    RITZ_OWN(ritz_residual)
    found = {.num_outputs = io->num_outputs,
             .num_inputs = io->num_inputs,
             .known = true};
    RITZ_OWN(ritz_dense) N = {0}, NB = {0};

    if (pairs->Phi.ncol == model->K->ncol || size == 0)
        return RITZ_OK;
    found.count = 1;
    RITZ_CHECK_NEW(found.C, size);
    RITZ_CHECK_NEW(found.Cv, size);
    RITZ_CHECK_NEW(found.Ca, size);
    RITZ_CHECK(ritz_massless(model, &pairs->Phi, pairs->lambda, &N));
    RITZ_CHECK(ritz_dense_mul_tn(&N, &io->B, &NB));
    RITZ_CHECK(put_static(&io->C, &N, &NB, found.C));
    RITZ_CHECK(put_static(&io->Cv, &N, &NB, found.Cv));
    RITZ_CHECK(put_static(&io->Ca, &N, &NB, found.Ca));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

/*
 * Static gain of the flexible part, which rigid motion does not make infinite:
 *
 *     G = C Phi_f Lambda_f^-1 Phi_f' B
 *
 * and what motions without mass add to it.
 */

ritz_status ritz_static_gain(const ritz_dense *K, const ritz_dense *M,
                             const ritz_io *io, int64_t num_rigid,
                             ritz_dense *out)
{
    const ritz_second_order model = {.K = K, .M = M, .io = io};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_io) modes = {0};
    RITZ_OWN(ritz_residual) rest = {0};

    RITZ_CHECK(ritz_eigen_dense(K, M, &pairs));
    if (num_rigid < pairs.num_rigid)
        num_rigid = pairs.num_rigid;
    RITZ_CHECK(ritz_io_project(io, &pairs.Phi, &modes));
    for (int64_t j = 0; j < modes.num_inputs; j++)
        for (int64_t k = 0; k < pairs.Phi.ncol; k++)
            ritz_dense_col(&modes.B, j)[k] *=
                k < num_rigid ? 0.0 : 1.0 / pairs.lambda[k];
    RITZ_CHECK(ritz_static_rest(&model, &pairs, &rest));
    RITZ_CHECK(ritz_dense_mul(&modes.C, &modes.B, out));
    for (int64_t k = 0; rest.count > 0 && k < out->nrow * out->ncol; k++)
        out->val[k] += rest.C[k];
    return RITZ_OK;
}

ritz_status ritz_gain_error(const ritz_dense *full, const ritz_dense *reduced,
                            double *out)
{
    RITZ_OWN(ritz_dense) G = {0}, apart = {0};
    double size = 0.0;
    double error = 0.0;

    RITZ_CHECK(ritz_dense_copy(full, &G));
    RITZ_CHECK(ritz_dense_copy(reduced, &apart));
    for (int64_t k = 0; k < G.nrow * G.ncol; k++)
        apart.val[k] -= G.val[k];
    RITZ_CHECK_IN("static gain", ritz_general_norm(&G, &size));
    RITZ_CHECK_IN("static gain", ritz_general_norm(&apart, &error));
    *out = error == 0.0                  ? 0.0
           : size > RITZ_NO_GAIN * error ? error / size
                                         : nan("");
    return RITZ_OK;
}
