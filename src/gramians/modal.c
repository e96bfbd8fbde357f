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

#include <ritz/eigen.h>

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the damping of the modes themselves; beneath is what rounding leaves. */
static const double coupled_above = 1e-6;
static const double rounding = 1e-12;
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

static ritz_status modal_empty(int64_t count, int64_t inputs, int64_t outputs,
                               ritz_modal *out)
{
    ritz_status status = RITZ_OK;

    out->count = count;
    RITZ_NEW(out->omega, count);
    RITZ_NEW(out->zeta, count);
    RITZ_TRY(ritz_dense_new(count, inputs, &out->B));
    RITZ_TRY(ritz_dense_new(outputs, count, &out->C));
    RITZ_TRY(ritz_dense_new(outputs, count, &out->Cv));
done:
    return status;
}

ritz_status ritz_modal_part(const ritz_modal *modal, int64_t first,
                            int64_t last, ritz_modal *out)
{
    ritz_status status = RITZ_OK;
    int64_t outputs = modal->C.nrow;
    ritz_modal part = {0};

    RITZ_TRY(modal_empty(last - first, modal->B.ncol, outputs, &part));
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

/* Phi'D Phi. */
static ritz_status project(const ritz_dense *D, const ritz_dense *Phi,
                           ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense DPhi = {0};

    RITZ_TRY(ritz_dense_mul(D, Phi, &DPhi));
    RITZ_TRY(ritz_dense_mul_tn(Phi, &DPhi, out));
done:
    ritz_dense_free(&DPhi);
    return status;
}

/*
 * Columns first .. last - 1 of Phi belong to one eigenvalue and may be any
 * basis of their space: turn them into the one in which D is diagonal.
 */
static ritz_status turn_cluster(const ritz_dense *D, int64_t first,
                                int64_t last, ritz_dense *Phi)
{
    ritz_status status = RITZ_OK;
    int64_t n = last - first;
    ritz_dense part = {
        .nrow = Phi->nrow, .ncol = n, .val = ritz_dense_col(Phi, first)};
    ritz_dense V = {0};
    ritz_dense turned = {0};
    double *d = NULL;
    int info = 0;

    RITZ_NEW(d, n);
    RITZ_TRY(project(D, &part, &V));
    info = LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (int)n, V.val, (int)n, d);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE,
                 "damping of a cluster of modes cannot be made diagonal");
    RITZ_TRY(ritz_dense_mul(&part, &V, &turned));
    ritz_dense_orient(&turned);
    memcpy(part.val, turned.val,
           (size_t)(turned.nrow * turned.ncol) * sizeof *turned.val);
done:
    free(d);
    ritz_dense_free(&V);
    ritz_dense_free(&turned);
    return status;
}

static ritz_status turn_clusters(const ritz_dense *D, ritz_pairs *pairs)
{
    ritz_status status = RITZ_OK;
    int64_t last = 0;

    for (int64_t k = pairs->num_rigid; k < pairs->Phi.ncol; k = last) {
        double w = 0.0;

        last = k + 1;
        while (last < pairs->Phi.ncol) {
            w = sqrt(pairs->lambda[last]);
            if (w - sqrt(pairs->lambda[last - 1]) > near * w)
                break;
            last++;
        }
        if (last > k + 1)
            RITZ_TRY(turn_cluster(D, k, last, &pairs->Phi));
    }
done:
    return status;
}

static ritz_status check_coupling(const ritz_dense *d, const double *lambda)
{
    ritz_status status = RITZ_OK;
    double largest = 0.0;

    for (int64_t k = 0; k < d->ncol; k++)
        largest = fmax(largest, fabs(ritz_dense_col(d, k)[k]));
    for (int64_t j = 0; j < d->ncol; j++)
        for (int64_t i = 0; i < j; i++) {
            double own = sqrt(fabs(ritz_dense_col(d, i)[i]) *
                              fabs(ritz_dense_col(d, j)[j]));
            double off = fabs(ritz_dense_col(d, j)[i]);

            RITZ_FAIL_IF(
                !(off <= coupled_above * own + rounding * largest),
                RITZ_ERR_ARGUMENT,
                "the damping matrix couples the modes at %.6g and %.6g Hz "
                "(%.1e "
                "of their own damping): a ranking needs damping mode by mode",
                ritz_eigen_hertz(lambda[i]), ritz_eigen_hertz(lambda[j]),
                off / fmax(own, rounding * largest));
        }
done:
    return status;
}

/* Diagonal of Phi'D Phi, once Phi fits D; NULL where there is no D. */
static ritz_status modal_damping(const ritz_dense *D, ritz_pairs *pairs,
                                 double **out)
{
    ritz_status status = RITZ_OK;
    ritz_dense d = {0};
    double *own = NULL;

    RITZ_NEW(own, pairs->Phi.ncol);
    if (D && D->val) {
        RITZ_TRY(turn_clusters(D, pairs));
        RITZ_TRY(project(D, &pairs->Phi, &d));
        RITZ_TRY(check_coupling(&d, pairs->lambda));
        for (int64_t k = 0; k < d.ncol; k++)
            own[k] = ritz_dense_col(&d, k)[k];
    }
    *out = own;
    own = NULL;
done:
    free(own);
    ritz_dense_free(&d);
    return status;
}

/* Inputs and outputs of flexible mode k, whose column in `io` is `at`. */
static void put_mode(const ritz_io *io, int64_t at, ritz_modal *modal,
                     int64_t k)
{
    double w2 = modal->omega[k] * modal->omega[k];
    double d = 2.0 * modal->zeta[k] * modal->omega[k];

    for (int64_t j = 0; j < io->num_inputs; j++)
        ritz_dense_col(&modal->B, j)[k] = ritz_dense_col(&io->B, j)[at];
    for (int64_t i = 0; i < io->num_outputs; i++) {
        double limit = isnan(io->limit[i]) ? 1.0 : io->limit[i];
        double ca = ritz_dense_col(&io->Ca, at)[i];

        ritz_dense_col(&modal->C, k)[i] =
            (ritz_dense_col(&io->C, at)[i] - ca * w2) / limit;
        ritz_dense_col(&modal->Cv, k)[i] =
            (ritz_dense_col(&io->Cv, at)[i] - ca * d) / limit;
    }
}

static ritz_status fill(const ritz_pairs *pairs, const double *own,
                        const ritz_io *io, const ritz_damping *damping,
                        ritz_modal *modal)
{
    ritz_status status = RITZ_OK;

    for (int64_t k = 0; k < modal->count; k++) {
        int64_t at = pairs->num_rigid + k;
        double w = sqrt(pairs->lambda[at]);
        double given = damping ? ritz_damping_of_mode(damping, k, w) : 0.0;

        modal->omega[k] = w;
        modal->zeta[k] = given + own[at] / (2.0 * w);
        RITZ_FAIL_IF(!(modal->zeta[k] > 0.0), RITZ_ERR_ARGUMENT,
                     "the mode at %.6g Hz has %s damping: a ranking needs a "
                     "positive ratio for every flexible mode",
                     ritz_eigen_hertz(pairs->lambda[at]),
                     modal->zeta[k] < 0.0 ? "negative" : "no");
        put_mode(io, at, modal, k);
    }
done:
    return status;
}

static ritz_status check(const ritz_dense *K, const ritz_dense *D,
                         const ritz_io *io)
{
    ritz_status status = RITZ_OK;

    RITZ_FAIL_IF(io->B.nrow != K->nrow || io->C.ncol != K->nrow,
                 RITZ_ERR_ARGUMENT,
                 "inputs and outputs are those of another model");
    RITZ_FAIL_IF(D && D->val && D->nrow != K->nrow, RITZ_ERR_ARGUMENT,
                 "the damping matrix is that of another model");
    for (int64_t i = 0; i < io->num_outputs; i++)
        RITZ_FAIL_IF(io->limit[i] <= 0.0, RITZ_ERR_ARGUMENT,
                     "output '%s' has the limit %g, which is not positive",
                     io->output[i], io->limit[i]);
done:
    return status;
}

ritz_status ritz_modal_new(const ritz_dense *K, const ritz_dense *M,
                           const ritz_dense *D, const ritz_io *io,
                           const ritz_damping *damping, ritz_modal *out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};
    ritz_io modes = {0};
    ritz_modal modal = {0};
    double *own = NULL;

    RITZ_TRY(check(K, D, io));
    RITZ_TRY(ritz_eigen_dense(K, M, &pairs));
    RITZ_TRY(modal_damping(D, &pairs, &own));
    RITZ_TRY(ritz_io_project(io, &pairs.Phi, &modes));
    RITZ_TRY(modal_empty(pairs.Phi.ncol - pairs.num_rigid, io->num_inputs,
                         io->num_outputs, &modal));
    RITZ_TRY(fill(&pairs, own, &modes, damping, &modal));
    *out = modal;
    modal = (ritz_modal){0};
done:
    free(own);
    ritz_modal_free(&modal);
    ritz_io_free(&modes);
    ritz_pairs_free(&pairs);
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
