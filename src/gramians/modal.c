/*
 * From matrices to a modal model: with K Phi = M Phi Lambda, Phi'M Phi = I,
 *
 *     q'' + Phi'D Phi q' + Lambda q = Phi'B u,    zeta_k = d_kk / (2 w_k)
 *
 * An acceleration output sees q'' = b u - 2 zeta w q' - w^2 q:
 *
 *     C  := C  - Ca w^2,    Cv := Cv - Ca 2 zeta w
 *
 * and the feedthrough Ca b u is left out: it is the same whatever is kept.
 */
#include "base/alloc.h"
#include "gramians/cluster.h"
#include "gramians/modal_modes.h"

#include <ritz/eigen.h>

#include <stdlib.h>

/* Relative gap of frequencies within a cluster. */
static const double near = 1e-6;

int64_t ritz_modal_cluster(const ritz_modal *modal, int64_t first)
{
    int64_t last = first + 1;

    while (last < modal->count && modal->omega[last] - modal->omega[last - 1] <=
                                      near * modal->omega[last])
        last++;
    return last;
}

ritz_status ritz_modal_part(const ritz_modal *modal, int64_t first,
                            int64_t last, ritz_modal *out)
{
    ritz_status status = RITZ_OK;
    int64_t outputs = modal->C.nrow;
    ritz_modal part = {0};

    RITZ_TRY(ritz_modal_empty(last - first, modal->B.ncol, outputs, &part));
    for (int64_t k = first; k < last; k++) {
        part.omega[k - first] = modal->omega[k];
        part.zeta[k - first] = modal->zeta[k];
        for (int64_t j = 0; j < modal->B.ncol; j++)
            ritz_dense_col(&part.B, j)[k - first] =
                ritz_dense_col(&modal->B, j)[k];
        for (int64_t i = 0; i < outputs; i++) {
            ritz_dense_col(&part.C, k - first)[i] =
                ritz_dense_col(&modal->C, k)[i];
            ritz_dense_col(&part.Cv, k - first)[i] =
                ritz_dense_col(&modal->Cv, k)[i];
        }
    }
    *out = part;
    part = (ritz_modal){0};
done:
    ritz_modal_free(&part);
    return status;
}

static ritz_status check(const ritz_dense *K, const ritz_dense *D,
                         const ritz_io *io)
{
    RITZ_REFUSE_IF(io->B.nrow != K->nrow || io->C.ncol != K->nrow,
                   RITZ_ERR_ARGUMENT,
                   "inputs and outputs are those of another model");
    RITZ_REFUSE_IF(D && D->val && D->nrow != K->nrow, RITZ_ERR_ARGUMENT,
                   "the damping matrix is that of another model");
    return RITZ_OK;
}

/* All modes with mass, and with them damping, inputs and outputs. */
static ritz_status find_modes(const ritz_dense *K, const ritz_dense *M,
                              const ritz_dense *D, const ritz_io *io,
                              const ritz_damping *damping,
                              ritz_first_order *modes)
{
    ritz_status status = RITZ_OK;
    const ritz_damping none = {0};
    ritz_pairs pairs = {0};

    RITZ_TRY(ritz_eigen_dense(K, M, &pairs));
    modes->num_dofs = K->nrow;
    modes->count = pairs.Phi.ncol;
    modes->num_rigid = pairs.num_rigid;
    modes->Phi = pairs.Phi;
    modes->lambda = pairs.lambda;
    pairs.Phi = (ritz_dense){0};
    pairs.lambda = NULL;
    if (D && D->val)
        RITZ_TRY(ritz_dense_project(D, &modes->Phi, &modes->Delta));
    RITZ_TRY(ritz_first_order_drive(io, damping ? damping : &none, modes));
done:
    ritz_pairs_free(&pairs);
    return status;
}

ritz_status ritz_modal_new(const ritz_dense *K, const ritz_dense *M,
                           const ritz_dense *D, const ritz_io *io,
                           const ritz_damping *damping, ritz_modal *out)
{
    ritz_status status = RITZ_OK;
    ritz_first_order modes = {0};
    ritz_coupling coupling = {0};

    RITZ_TRY(check(K, D, io));
    RITZ_TRY(find_modes(K, M, D, io, damping, &modes));
    RITZ_TRY(ritz_modes_turn(&modes));
    if (ritz_modes_coupled(&modes, &coupling))
        RITZ_TRY(ritz_coupling_refuse(&coupling,
                                      "a ranking needs damping mode by mode"));
    RITZ_TRY(ritz_modal_of_modes(&modes, io, out));
done:
    ritz_first_order_free(&modes);
    return status;
}

void ritz_modal_free(ritz_modal *modal)
{
    free(modal->omega);
    free(modal->zeta);
    ritz_dense_free(&modal->B);
    ritz_dense_free(&modal->C);
    ritz_dense_free(&modal->Cv);
    *modal = (ritz_modal){0};
}
