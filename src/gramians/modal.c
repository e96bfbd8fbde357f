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
#include "base/tolerances.h"
#include "gramians/cluster.h"
#include "gramians/modal_modes.h"

#include <ritz/matrix.h>

#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One past the last of the modes at the frequency of mode `first`. */
static int64_t end_of_cluster(const ritz_modal_model *modes, int64_t first)
{
    int64_t last = first + 1;

    while (last < modes->count) {
        double w = sqrt(modes->lambda[last]);

        if (w - sqrt(modes->lambda[last - 1]) > RITZ_CLUSTER_GAP * w)
            break;
        last++;
    }
    return last;
}

/* Columns first, first + 1, ... of A := those times V. */
static ritz_status turn_columns(ritz_dense *A, int64_t first,
                                const ritz_dense *V)
{
    RITZ_OWN(ritz_dense) turned = {0};
    ritz_dense part = {0};

    if (A->nrow == 0 || A->ncol == 0)
        return RITZ_OK;
    part = ritz_dense_part(A, first, V->nrow);
    RITZ_CHECK(ritz_dense_mul(&part, V, &turned));
    memcpy(part.val, turned.val,
           (size_t)(turned.nrow * turned.ncol) * sizeof *turned.val);
    return RITZ_OK;
}

/* Rows first, first + 1, ... of A := V' times those. */
static ritz_status turn_rows(ritz_dense *A, int64_t first, const ritz_dense *V)
{
    RITZ_OWN(ritz_dense) part = {0}, turned = {0};
    int64_t n = V->nrow;

    RITZ_CHECK(ritz_dense_new(n, A->ncol, &part));
    for (int64_t j = 0; j < A->ncol; j++)
        memcpy(ritz_dense_col(&part, j), ritz_dense_col(A, j) + first,
               (size_t)n * sizeof *part.val);
    RITZ_CHECK(ritz_dense_mul_tn(V, &part, &turned));
    for (int64_t j = 0; j < A->ncol; j++)
        memcpy(ritz_dense_col(A, j) + first, ritz_dense_col(&turned, j),
               (size_t)n * sizeof *part.val);
    return RITZ_OK;
}

/* Eigenvectors of a block of Delta; *needed: it is not diagonal yet. */
static ritz_status axes_of(const ritz_dense *Delta, int64_t first, int64_t last,
                           ritz_dense *V, bool *needed)
{
    int64_t n = last - first;
    RITZ_OWN_ARRAY double *d = NULL;
    int info = 0;

    RITZ_CHECK_NEW(d, n);
    RITZ_CHECK(ritz_dense_new(n, n, V));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++) {
            double x = ritz_dense_col(Delta, first + j)[first + i];

            ritz_dense_col(V, j)[i] = x;
            *needed = *needed || (i != j && x != 0.0);
        }
    if (!*needed)
        return RITZ_OK;
    ritz_dense_symmetrise(V);
    info = LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (int)n, V->val, (int)n, d);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "damping of a cluster of modes cannot be made diagonal");
    ritz_dense_orient(V);
    return RITZ_OK;
}

ritz_status ritz_modes_turn(ritz_modal_model *modes)
{
    RITZ_OWN(ritz_dense) V = {0};
    int64_t last = 0;

    for (int64_t k = modes->num_rigid; k < modes->count; k = last) {
        bool needed = false;

        last = end_of_cluster(modes, k);
        if (last == k + 1)
            continue;
        RITZ_CHECK(axes_of(&modes->Delta, k, last, &V, &needed));
        if (needed) {
            RITZ_CHECK(turn_columns(&modes->Phi, k, &V));
            RITZ_CHECK(turn_columns(&modes->MPhi, k, &V));
            RITZ_CHECK(turn_columns(&modes->C, k, &V));
            RITZ_CHECK(turn_columns(&modes->Cv, k, &V));
            RITZ_CHECK(turn_columns(&modes->Delta, k, &V));
            RITZ_CHECK(turn_rows(&modes->Delta, k, &V));
            RITZ_CHECK(turn_rows(&modes->B, k, &V));
        }
        ritz_dense_free(&V);
    }
    return RITZ_OK;
}

bool ritz_modes_coupled(const ritz_modal_model *modes, ritz_coupling *out)
{
    const ritz_dense *d = &modes->Delta;
    double largest = 0.0;

    for (int64_t k = 0; k < d->ncol; k++)
        largest = fmax(largest, fabs(ritz_dense_col(d, k)[k]));
    for (int64_t j = modes->num_rigid; j < d->ncol; j++)
        for (int64_t i = 0; i < j; i++) {
            double own = sqrt(fabs(ritz_dense_col(d, i)[i]) *
                              fabs(ritz_dense_col(d, j)[j]));
            double off = fmax(fabs(ritz_dense_col(d, j)[i]),
                              fabs(ritz_dense_col(d, i)[j]));

            if (off <= RITZ_DAMPING_COUPLES * own + RITZ_NEGLIGIBLE * largest)
                continue;
            out->hertz[0] = ritz_eigen_hertz(modes->lambda[i]);
            out->hertz[1] = ritz_eigen_hertz(modes->lambda[j]);
            out->ratio = off / fmax(own, RITZ_NEGLIGIBLE * largest);
            return true;
        }
    return false;
}

ritz_status ritz_coupling_refuse(const ritz_coupling *coupling, const char *why)
{
    char own[RITZ_NAME_SIZE] = "which have none of their own";

    if (isfinite(coupling->ratio))
        snprintf(own, sizeof own, "%.1e of their own damping", coupling->ratio);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the damping matrix couples the modes at %.6g and %.6g "
                     "Hz (%s): %s",
                     coupling->hertz[0], coupling->hertz[1], own, why);
}

/* A model of `count` modes, all zero. */
static ritz_status modal_empty(int64_t count, int64_t inputs, int64_t outputs,
                               ritz_modal *out)
{
    RITZ_OWN(ritz_modal) modal = {.count = count};

    RITZ_CHECK_NEW(modal.omega, count);
    RITZ_CHECK_NEW(modal.zeta, count);
    RITZ_CHECK(ritz_dense_new(count, inputs, &modal.B));
    RITZ_CHECK(ritz_dense_new(outputs, count, &modal.C));
    RITZ_CHECK(ritz_dense_new(outputs, count, &modal.Cv));
    RITZ_MOVE(*out, modal);
    return RITZ_OK;
}

/* Inputs and outputs of flexible mode k, which is mode `at`. */
static void put_mode(const ritz_modal_model *modes, int64_t at,
                     const double *limit, ritz_modal *modal, int64_t k)
{
    for (int64_t j = 0; j < modal->B.ncol; j++)
        ritz_dense_col(&modal->B, j)[k] = ritz_dense_col(&modes->B, j)[at];
    for (int64_t i = 0; i < modal->C.nrow; i++) {
        double by = isnan(limit[i]) ? 1.0 : limit[i];

        ritz_dense_col(&modal->C, k)[i] = ritz_dense_col(&modes->C, at)[i] / by;
        ritz_dense_col(&modal->Cv, k)[i] =
            ritz_dense_col(&modes->Cv, at)[i] / by;
    }
}

ritz_status ritz_modal_of_modes(const ritz_modal_model *modes,
                                const ritz_io *io, ritz_modal *out)
{
    RITZ_OWN(ritz_modal) modal = {0};
    int64_t r = modes->num_rigid;

    for (int64_t i = 0; i < io->num_outputs; i++)
        RITZ_REFUSE_IF(io->limit[i] <= 0.0, RITZ_ERR_ARGUMENT,
                       "output '%s' has the limit %g, which is not positive",
                       io->output[i], io->limit[i]);
    RITZ_CHECK(
        modal_empty(modes->count - r, modes->B.ncol, modes->C.nrow, &modal));
    for (int64_t k = 0; k < modal.count; k++) {
        modal.omega[k] = sqrt(modes->lambda[r + k]);
        modal.zeta[k] = ritz_dense_col(&modes->Delta, r + k)[r + k] /
                        (2.0 * modal.omega[k]);
        RITZ_REFUSE_IF(
            !(modal.zeta[k] > 0.0), RITZ_ERR_ARGUMENT,
            "the mode at %.6g Hz has %s damping: every flexible mode "
            "needs a positive ratio",
            ritz_eigen_hertz(modes->lambda[r + k]),
            modal.zeta[k] < 0.0 ? "negative" : "no");
        put_mode(modes, r + k, io->limit, &modal, k);
    }
    RITZ_MOVE(*out, modal);
    return RITZ_OK;
}

int64_t ritz_modal_cluster(const ritz_modal *modal, int64_t first)
{
    int64_t last = first + 1;

    while (last < modal->count && modal->omega[last] - modal->omega[last - 1] <=
                                      RITZ_CLUSTER_GAP * modal->omega[last])
        last++;
    return last;
}

ritz_status ritz_modal_part(const ritz_modal *modal, int64_t first,
                            int64_t last, ritz_modal *out)
{
    int64_t outputs = modal->C.nrow;
    RITZ_OWN(ritz_modal) part = {0};

    RITZ_CHECK(modal_empty(last - first, modal->B.ncol, outputs, &part));
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
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

static ritz_status check_sizes(const ritz_dense *K, const ritz_dense *D,
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
                              ritz_modal_model *modes)
{
    const ritz_damping none = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_dense(K, M, &pairs));
    ritz_modal_model_take(&pairs, K->nrow, modes);
    if (D && D->val)
        RITZ_CHECK(ritz_dense_project(D, &modes->Phi, &modes->Delta));
    return ritz_modal_model_drive(io, damping ? damping : &none, modes);
}

ritz_status ritz_modal_new(const ritz_dense *K, const ritz_dense *M,
                           const ritz_dense *D, const ritz_io *io,
                           const ritz_damping *damping, ritz_modal *out)
{
    RITZ_OWN(ritz_modal_model) modes = {0};
    ritz_coupling coupling = {0};

    RITZ_CHECK(check_sizes(K, D, io));
    RITZ_CHECK(find_modes(K, M, D, io, damping, &modes));
    RITZ_CHECK(ritz_modes_turn(&modes));
    if (ritz_modes_coupled(&modes, &coupling))
        RITZ_CHECK(ritz_coupling_refuse(
            &coupling, "a ranking needs damping mode by mode"));
    return ritz_modal_of_modes(&modes, io, out);
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
