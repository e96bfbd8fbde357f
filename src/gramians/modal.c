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
#include "linear/general.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>

static ritz_status check_limits(int64_t count, const double *limit,
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
    return check_limits(outputs, limit, output);
}

void ritz_outputs_weigh(const double *limit, ritz_dense *C)
{
    for (int64_t j = 0; j < C->ncol; j++)
        for (int64_t i = 0; i < C->nrow; i++)
            if (!isnan(limit[i]))
                ritz_dense_col(C, j)[i] /= limit[i];
}

ritz_status ritz_outputs_scaled(const ritz_dense *C, const double *limit,
                                ritz_dense *out)
{
    RITZ_OWN(ritz_dense) weighed = {0};

    RITZ_CHECK(ritz_dense_copy(C, &weighed));
    ritz_outputs_weigh(limit, &weighed);
    return ritz_general_transpose(&weighed, out);
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

    RITZ_CHECK_NEW(d, n);
    RITZ_CHECK(ritz_dense_block(Delta, first, n, first, n, V));
    for (int64_t k = 0; k < n * n; k++)
        *needed = *needed || (k % (n + 1) != 0 && V->val[k] != 0.0);
    if (!*needed)
        return RITZ_OK;
    ritz_dense_symmetrise(V);
    RITZ_REFUSE_IF(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (int)n, V->val,
                                 (int)n, d) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "damping of a cluster of modes cannot be made diagonal");
    ritz_dense_orient(V);
    return RITZ_OK;
}

ritz_status ritz_modes_turn(ritz_modal_model *modes)
{
    ritz_dense *const columns[6] = {&modes->Phi, &modes->MPhi, &modes->C,
                                    &modes->Cv,  &modes->Ca,   &modes->Delta};
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
        for (int i = 0; i < 6; i++)
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

double ritz_damping_between(const ritz_dense *Delta, double largest, int64_t i,
                            int64_t j)
{
    double own = sqrt(fabs(ritz_dense_col(Delta, i)[i]) *
                      fabs(ritz_dense_col(Delta, j)[j]));
    double off = fmax(fabs(ritz_dense_col(Delta, j)[i]),
                      fabs(ritz_dense_col(Delta, i)[j])) -
                 RITZ_NEGLIGIBLE * largest;

    return off > 0.0 ? off / own : 0.0;
}

static bool find_coupling(const ritz_modal_model *modes, coupling *out)
{
    const ritz_dense *d = &modes->Delta;
    double largest = ritz_dense_max(d);

    for (int64_t j = modes->num_rigid; j < d->ncol; j++)
        for (int64_t i = 0; i < j; i++) {
            double ratio = ritz_damping_between(d, largest, i, j);

            if (!(ratio > RITZ_DAMPING_COUPLES))
                continue;
            *out = (coupling){{i, j}, ratio};
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

/* A modal model with `count` flexible and `rigid` rigid modes, all zero. */
static ritz_status create_modal(int64_t count, int64_t rigid, int64_t inputs,
                                int64_t outputs, ritz_modal *out)
{
    RITZ_OWN(ritz_modal) modal = {.count = count, .num_rigid = rigid};

    RITZ_CHECK_NEW(modal.omega, count);
    RITZ_CHECK_NEW(modal.zeta, count);
    RITZ_CHECK(ritz_dense_new(count + rigid, inputs, &modal.B));
    RITZ_CHECK(ritz_dense_new(outputs, count + rigid, &modal.C));
    RITZ_CHECK(ritz_dense_new(outputs, count + rigid, &modal.Cv));
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

/* Whether damping couples a rigid mode to a flexible one. */
static bool is_rigid_coupled(const ritz_modal_model *modes)
{
    double largest = ritz_dense_max(&modes->Delta);

    for (int64_t j = modes->num_rigid; j < modes->count; j++)
        for (int64_t i = 0; i < modes->num_rigid; i++)
            if (ritz_damping_between(&modes->Delta, largest, i, j) >
                RITZ_DAMPING_COUPLES)
                return true;
    return false;
}

/* Flexible modes, followed by all rigid ones if damping couples any of these to
   a flexible one, since the basis of rigid motion is arbitrary. */
static ritz_status choose_modes(const ritz_modal_model *modes, ritz_dofs *out)
{
    RITZ_CHECK_NEW(out->at, modes->count);
    for (int64_t k = modes->num_rigid; k < modes->count; k++)
        out->at[out->count++] = k;
    for (int64_t k = 0; is_rigid_coupled(modes) && k < modes->num_rigid; k++)
        out->at[out->count++] = k;
    return RITZ_OK;
}

ritz_status ritz_refuse_undamped(double omega, double zeta)
{
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the mode at %.6g Hz has %s damping: every flexible mode "
                     "needs a positive ratio, from --damping or the scene",
                     omega / (2.0 * RITZ_PI), zeta < 0.0 ? "negative" : "no");
}

/*
 * Frequencies and damping ratios. If modes are not coupled, each ratio must be
 * positive. If they are, a ratio that is only rounding of the largest damping
 * becomes 0.
 */
static ritz_status put_ratios(const ritz_modal_model *modes, bool coupled,
                              ritz_modal *modal)
{
    double rounding =
        coupled ? RITZ_NEGLIGIBLE * ritz_dense_max(&modes->Delta) : 0.0;
    int64_t r = modes->num_rigid;

    for (int64_t k = 0; k < modal->count; k++) {
        double own = ritz_dense_col(&modes->Delta, r + k)[r + k];

        modal->omega[k] = sqrt(modes->lambda[r + k]);
        modal->zeta[k] =
            fabs(own) > rounding ? own / (2.0 * modal->omega[k]) : 0.0;
        if (!coupled && !(modal->zeta[k] > 0.0))
            return ritz_refuse_undamped(modal->omega[k], modal->zeta[k]);
    }
    return RITZ_OK;
}

/* Delta, and the accelerations that C and Cv express by Delta, divided by
   limits. */
static ritz_status put_coupling(const ritz_modal_model *modes,
                                const ritz_io *io, const ritz_dofs *chosen,
                                ritz_modal *modal)
{
    RITZ_CHECK(ritz_dense_principal(&modes->Delta, chosen->count, chosen->at,
                                    &modal->Delta));
    RITZ_CHECK(
        ritz_dense_pick(&modes->Ca, chosen->count, chosen->at, &modal->Ca));
    ritz_outputs_weigh(io->limit, &modal->Ca);
    return RITZ_OK;
}

ritz_status ritz_modal_of_modes(const ritz_modal_model *modes,
                                const ritz_io *io, const char *why,
                                ritz_modal *out)
{
    const ritz_dense *const from[] = {&modes->B, &modes->C, &modes->Cv};
    RITZ_OWN(ritz_modal) modal = {0};
    RITZ_OWN(ritz_dofs) chosen = {0};
    bool coupled = ritz_modes_coupled(modes);
    int64_t m = modes->count - modes->num_rigid;

    if (why)
        RITZ_CHECK(refuse_coupling(modes, why));
    RITZ_CHECK(check_limits(io->num_outputs, io->limit, io->output));
    RITZ_CHECK(choose_modes(modes, &chosen));
    RITZ_CHECK(create_modal(m, chosen.count - m, modes->B.ncol, modes->C.nrow,
                            &modal));
    RITZ_CHECK(put_ratios(modes, coupled, &modal));
    for (int64_t k = 0; k < chosen.count; k++)
        put_mode(from, chosen.at[k], io->limit, &modal, k);
    if (coupled)
        RITZ_CHECK(put_coupling(modes, io, &chosen, &modal));
    RITZ_MOVE(*out, modal);
    return RITZ_OK;
}

/* Whether damping couples modes of a part, or the part has rigid modes. */
static bool is_part_coupled(const ritz_modal *part)
{
    double largest = ritz_dense_max(&part->Delta);

    for (int64_t j = 0; j < part->Delta.ncol; j++)
        for (int64_t i = 0; i < j; i++)
            if (ritz_damping_between(&part->Delta, largest, i, j) >
                RITZ_DAMPING_COUPLES)
                return true;
    return part->num_rigid > 0;
}

/*
 * Restrict the accelerations of a part to the part's own damping: Cv contains
 * -sum_j ca_j Delta_jk over all modes j, and the terms of modes that are not in
 * the part are removed.
 */
static void restrict_accelerations(const ritz_modal *modal,
                                   const ritz_dofs *chosen, ritz_modal *part)
{
    int64_t all = modal->Delta.ncol;

    for (int64_t k = 0; modal->Ca.val && k < chosen->count; k++) {
        const double *delta = ritz_dense_col(&modal->Delta, chosen->at[k]);
        double *cv = ritz_dense_col(&part->Cv, k);
        int64_t next = 0;

        for (int64_t j = 0; j < all; j++) {
            bool there = next < chosen->count && chosen->at[next] == j;

            next += there;
            for (int64_t i = 0; !there && i < part->Cv.nrow; i++)
                cv[i] += ritz_dense_col(&modal->Ca, j)[i] * delta[j];
        }
    }
}

/* Damping matrix of the modes `chosen` of a model; {0} if it couples none of
   them. */
static ritz_status put_damping(const ritz_modal *modal, const ritz_dofs *chosen,
                               ritz_modal *part)
{
    if (!modal->Delta.val)
        return RITZ_OK;
    restrict_accelerations(modal, chosen, part);
    RITZ_CHECK(ritz_dense_principal(&modal->Delta, chosen->count, chosen->at,
                                    &part->Delta));
    if (!is_part_coupled(part)) {
        ritz_dense_free(&part->Delta);
        return RITZ_OK;
    }
    if (modal->Ca.val)
        RITZ_CHECK(
            ritz_dense_pick(&modal->Ca, chosen->count, chosen->at, &part->Ca));
    return RITZ_OK;
}

ritz_status ritz_modal_part(const ritz_modal *modal, const bool *taken,
                            const bool *rigid, ritz_modal *out)
{
    const ritz_dense *const from[] = {&modal->B, &modal->C, &modal->Cv};
    RITZ_OWN(ritz_modal) part = {0};
    RITZ_OWN(ritz_dofs) chosen = {0};
    int64_t m = modal->count, count = 0;

    RITZ_CHECK_NEW(chosen.at, m + modal->num_rigid);
    for (int64_t k = 0; k < m; k++)
        if (taken[k])
            chosen.at[chosen.count++] = k;
    count = chosen.count;
    for (int64_t k = 0; k < modal->num_rigid; k++)
        if (!rigid || rigid[k])
            chosen.at[chosen.count++] = m + k;
    RITZ_CHECK(create_modal(count, chosen.count - count, modal->B.ncol,
                            modal->C.nrow, &part));
    for (int64_t k = 0; k < chosen.count; k++)
        put_mode(from, chosen.at[k], NULL, &part, k);
    for (int64_t k = 0; k < count; k++) {
        part.omega[k] = modal->omega[chosen.at[k]];
        part.zeta[k] = modal->zeta[chosen.at[k]];
    }
    RITZ_CHECK(put_damping(modal, &chosen, &part));
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
    return ritz_modal_of_modes(&modes, io, NULL, out);
}

void ritz_modal_free(ritz_modal *modal)
{
    RITZ_FREE(modal->omega, modal->zeta);
    ritz_dense_free(&modal->B);
    ritz_dense_free(&modal->C);
    ritz_dense_free(&modal->Cv);
    ritz_dense_free(&modal->Delta);
    ritz_dense_free(&modal->Ca);
    *modal = (ritz_modal){0};
}
