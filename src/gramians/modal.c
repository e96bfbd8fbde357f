/*
 * From matrices to a modal model: with K Phi = M Phi Lambda, Phi'M Phi = I,
 *
 *     q'' + Phi'D Phi q' + Lambda q = Phi'B u,    zeta_k = d_kk / (2 w_k)
 *
 * An acceleration output is q'' = b u - 2 zeta w q' - w^2 q:
 *
 *     C  := C  - Ca w^2,    Cv := Cv - Ca 2 zeta w
 *
 * and the feedthrough Ca b u is left out: it is the same whatever is kept.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>

ritz_status ritz_limits_check(int64_t count, const double *limit,
                              const char (*output)[RITZ_NAME_SIZE])
{
    for (int64_t i = 0; i < count; i++)
        RITZ_REFUSE_IF(limit[i] <= 0.0, RITZ_ERR_ARGUMENT,
                       "output '%s' has the limit %g, which is not positive",
                       output[i], limit[i]);
    return RITZ_OK;
}

ritz_status ritz_ends_check(const char *what, int64_t inputs, int64_t outputs,
                            const double *limit,
                            const char (*output)[RITZ_NAME_SIZE])
{
    RITZ_REFUSE_IF(inputs == 0, RITZ_ERR_ARGUMENT,
                   "the %s has no inputs: nothing of it is controllable", what);
    RITZ_REFUSE_IF(outputs == 0, RITZ_ERR_ARGUMENT,
                   "the %s has no outputs: nothing of it is observable", what);
    return ritz_limits_check(outputs, limit, output);
}

ritz_status ritz_outputs_scaled(const ritz_dense *C, const double *limit,
                                ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(C->ncol, C->nrow, out));
    for (int64_t i = 0; i < C->nrow; i++)
        for (int64_t j = 0; j < C->ncol; j++)
            ritz_dense_col(out, i)[j] =
                ritz_dense_col(C, j)[i] / (isnan(limit[i]) ? 1.0 : limit[i]);
    return RITZ_OK;
}

/* One past the last mode at the frequency of mode `first`. */
static int64_t find_cluster_end(int64_t count, const double *omega,
                                int64_t first)
{
    int64_t last = first + 1;

    while (last < count &&
           omega[last] - omega[last - 1] <= RITZ_CLUSTER_GAP * omega[last])
        last++;
    return last;
}

int64_t ritz_modal_cluster(const ritz_modal *modal, int64_t first)
{
    return find_cluster_end(modal->count, modal->omega, first);
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
    ritz_dense_put(&turned, 0, first, A);
    return RITZ_OK;
}

/* Rows first, first + 1, ... of A := V' times those. */
static ritz_status turn_rows(ritz_dense *A, int64_t first, const ritz_dense *V)
{
    RITZ_OWN(ritz_dense) part = {0}, turned = {0};

    RITZ_CHECK(ritz_dense_block(A, first, V->nrow, 0, A->ncol, &part));
    RITZ_CHECK(ritz_dense_mul_tn(V, &part, &turned));
    ritz_dense_put(&turned, first, 0, A);
    return RITZ_OK;
}

/* Eigenvectors V of a block of Delta; *needed: it is not diagonal yet. */
static ritz_status find_axes(const ritz_dense *Delta, int64_t first,
                             int64_t last, ritz_dense *V, bool *needed)
{
    int64_t n = last - first;
    RITZ_OWN_ARRAY double *d = NULL;
    int info = 0;

    RITZ_CHECK_NEW(d, n);
    RITZ_CHECK(ritz_dense_block(Delta, first, n, first, n, V));
    for (int64_t k = 0; k < n * n; k++)
        *needed = *needed || (k % (n + 1) != 0 && V->val[k] != 0.0);
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
    ritz_dense *const columns[5] = {&modes->Phi, &modes->MPhi, &modes->C,
                                    &modes->Cv, &modes->Delta};
    RITZ_OWN_ARRAY double *omega = NULL;
    int64_t last = 0;

    RITZ_CHECK_NEW(omega, modes->count);
    for (int64_t k = modes->num_rigid; k < modes->count; k++)
        omega[k] = sqrt(modes->lambda[k]);
    for (int64_t k = modes->num_rigid; k < modes->count; k = last) {
        RITZ_OWN(ritz_dense) V = {0};
        bool needed = false;

        last = find_cluster_end(modes->count, omega, k);
        if (last > k + 1)
            RITZ_CHECK(find_axes(&modes->Delta, k, last, &V, &needed));
        if (!needed)
            continue;
        for (int i = 0; i < 5; i++)
            RITZ_CHECK(turn_columns(columns[i], k, &V));
        RITZ_CHECK(turn_rows(&modes->Delta, k, &V));
        RITZ_CHECK(turn_rows(&modes->B, k, &V));
    }
    return RITZ_OK;
}

/* Two modes that damping couples, one at least flexible. */
typedef struct coupling {
    int64_t mode[2];
    double ratio; /* of their own damping */
} coupling;

static bool find_coupling(const ritz_modal_model *modes, coupling *out)
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
            double rounding = RITZ_NEGLIGIBLE * largest;

            if (off <= RITZ_DAMPING_COUPLES * own + rounding)
                continue;
            *out = (coupling){{i, j}, off / fmax(own, rounding)};
            return true;
        }
    return false;
}

bool ritz_modes_coupled(const ritz_modal_model *modes)
{
    return find_coupling(modes, &(coupling){0});
}

static ritz_status refuse_coupling(const ritz_modal_model *modes,
                                   const char *why)
{
    coupling found = {0};
    char own[RITZ_NAME_SIZE] = "which have none of their own";

    if (!find_coupling(modes, &found))
        return RITZ_OK;
    if (isfinite(found.ratio))
        snprintf(own, sizeof own, "%.1e of their own damping", found.ratio);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the damping matrix couples the modes at %.6g and %.6g "
                     "Hz (%s): %s",
                     ritz_eigen_hertz(modes->lambda[found.mode[0]]),
                     ritz_eigen_hertz(modes->lambda[found.mode[1]]), own, why);
}

/* A model of `count` modes, all zero. */
static ritz_status create_modal(int64_t count, int64_t inputs, int64_t outputs,
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

/* Inputs and outputs of mode k are those of mode `at`, over limits if any. */
static void put_mode(const ritz_dense *const from[static 3], int64_t at,
                     const double *limit, ritz_modal *modal, int64_t k)
{
    for (int64_t j = 0; j < modal->B.ncol; j++)
        ritz_dense_col(&modal->B, j)[k] = ritz_dense_col(from[0], j)[at];
    for (int64_t i = 0; i < modal->C.nrow; i++) {
        double by = limit && !isnan(limit[i]) ? limit[i] : 1.0;

        ritz_dense_col(&modal->C, k)[i] = ritz_dense_col(from[1], at)[i] / by;
        ritz_dense_col(&modal->Cv, k)[i] = ritz_dense_col(from[2], at)[i] / by;
    }
}

ritz_status ritz_modal_of_modes(const ritz_modal_model *modes,
                                const ritz_io *io, const char *why,
                                ritz_modal *out)
{
    const ritz_dense *const from[] = {&modes->B, &modes->C, &modes->Cv};
    RITZ_OWN(ritz_modal) modal = {0};
    int64_t r = modes->num_rigid;

    RITZ_CHECK(refuse_coupling(modes, why));
    RITZ_CHECK(ritz_limits_check(io->num_outputs, io->limit, io->output));
    RITZ_CHECK(
        create_modal(modes->count - r, modes->B.ncol, modes->C.nrow, &modal));
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
        put_mode(from, r + k, io->limit, &modal, k);
    }
    RITZ_MOVE(*out, modal);
    return RITZ_OK;
}

ritz_status ritz_modal_part(const ritz_modal *modal, int64_t first,
                            int64_t last, const bool *taken, ritz_modal *out)
{
    const ritz_dense *const from[] = {&modal->B, &modal->C, &modal->Cv};
    RITZ_OWN(ritz_modal) part = {0};
    int64_t count = 0;

    for (int64_t k = first; k < last; k++)
        count += !taken || taken[k];
    RITZ_CHECK(create_modal(count, modal->B.ncol, modal->C.nrow, &part));
    count = 0;
    for (int64_t k = first; k < last; k++) {
        if (taken && !taken[k])
            continue;
        part.omega[count] = modal->omega[k];
        part.zeta[count] = modal->zeta[k];
        put_mode(from, k, NULL, &part, count++);
    }
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

ritz_status ritz_modal_new(const ritz_dense *K, const ritz_dense *M,
                           const ritz_dense *D, const ritz_io *io,
                           const ritz_damping *damping, ritz_modal *out)
{
    const ritz_damping none = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_modal_model) modes = {0};

    RITZ_REFUSE_IF(io->B.nrow != K->nrow || io->C.ncol != K->nrow,
                   RITZ_ERR_ARGUMENT,
                   "inputs and outputs are those of another model");
    RITZ_REFUSE_IF(D && D->val && D->nrow != K->nrow, RITZ_ERR_ARGUMENT,
                   "the damping matrix is that of another model");
    RITZ_CHECK(ritz_eigen_dense(K, M, &pairs));
    ritz_modal_model_take(&pairs, K->nrow, &modes);
    if (D && D->val)
        RITZ_CHECK(ritz_dense_project(D, &modes.Phi, &modes.Delta));
    RITZ_CHECK(ritz_modal_model_drive(io, damping ? damping : &none, &modes));
    RITZ_CHECK(ritz_modes_turn(&modes));
    return ritz_modal_of_modes(&modes, io,
                               "a ranking needs damping mode by mode", out);
}

void ritz_modal_free(ritz_modal *modal)
{
    RITZ_FREE(modal->omega, modal->zeta);
    ritz_dense_free(&modal->B);
    ritz_dense_free(&modal->C);
    ritz_dense_free(&modal->Cv);
    *modal = (ritz_modal){0};
}
