/*
 * K Phi = M Phi Lambda, Phi'M Phi = I, of a dense model. Accelerations are
 * written out, u'' = Phi (B u - Lambda q - Delta q').
 *
 * Motion without mass has no modes here. Undamped, it responds statically: with
 * R the part of those infinite eigenvalues in the flexibility,
 *
 *     (K + s M)^-1 = Phi (Lambda + s)^-1 Phi' + R     for every s,
 *
 * u = Phi q + R B u, and C R B feeds through. D R must be zero.
 */
#include "model/modal.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <ritz/matrix.h>
#include <ritz/model.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

ritz_status ritz_structure_refuse(bool structural)
{
    RITZ_REFUSE_IF(
        structural, RITZ_ERR_ARGUMENT,
        "structural damping is of harmonic motion and has no states, "
        "give it as a modal ratio");
    return RITZ_OK;
}

/* K and D with discrete dampers. */
static ritz_status install_dampers(const ritz_dampers *apart,
                                   ritz_structure *model)
{
    RITZ_OWN(ritz_dampers) dampers = {0};

    RITZ_CHECK(ritz_dampers_copy(apart, &dampers));
    return ritz_dampers_install(&dampers, &model->K, &model->D);
}

ritz_status ritz_structure_of_component(const ritz_component *component,
                                        ritz_structure *out)
{
    RITZ_OWN(ritz_structure) model = {0};

    RITZ_REFUSE_IF(component->num_dofs > RITZ_STATE_DOFS, RITZ_ERR_ARGUMENT,
                   "%" PRId64
                   " dofs are too many for dense matrices of states, "
                   "there can be %d: reduce it by another method first",
                   component->num_dofs, RITZ_STATE_DOFS);
    RITZ_CHECK(ritz_structure_refuse(component->K4.colptr != NULL));
    RITZ_CHECK(ritz_sparse_dense(&component->K, &model.K));
    RITZ_CHECK(ritz_sparse_dense(&component->M, &model.M));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_dense(&component->D, &model.D));
    RITZ_CHECK(install_dampers(&component->dampers, &model));
    RITZ_MOVE(*out, model);
    return RITZ_OK;
}

ritz_status ritz_structure_sparse(const ritz_component *component,
                                  const ritz_damping *rayleigh, ritz_sparse *K,
                                  ritz_sparse *D)
{
    RITZ_OWN(ritz_dampers) dampers = {0};
    RITZ_OWN(ritz_sparse) given = {0}, sum = {0};

    RITZ_CHECK(ritz_sparse_copy(&component->K, K));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_copy(&component->D, D));
    RITZ_CHECK(ritz_dampers_copy(&component->dampers, &dampers));
    RITZ_CHECK(ritz_dampers_install_sparse(&dampers, K, D));
    if (!rayleigh || rayleigh->kind == RITZ_DAMPING_NONE)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_sparse_add(rayleigh->a, &component->M, rayleigh->b, K, &given));
    if (D->colptr) {
        RITZ_CHECK(ritz_sparse_add(1.0, D, 1.0, &given, &sum));
        ritz_sparse_free(D);
        RITZ_MOVE(*D, sum);
    } else {
        RITZ_MOVE(*D, given);
    }
    return RITZ_OK;
}

ritz_status ritz_structure_of_reduced(const ritz_reduced *reduced,
                                      ritz_structure *out)
{
    RITZ_OWN(ritz_structure) model = {0};

    RITZ_CHECK(ritz_dense_copy(&reduced->K, &model.K));
    RITZ_CHECK(ritz_dense_copy(&reduced->M, &model.M));
    if (reduced->D.val)
        RITZ_CHECK(ritz_dense_copy(&reduced->D, &model.D));
    RITZ_CHECK(install_dampers(&reduced->dampers, &model));
    RITZ_MOVE(*out, model);
    return RITZ_OK;
}

void ritz_structure_free(ritz_structure *model)
{
    ritz_dense_free(&model->K);
    ritz_dense_free(&model->M);
    ritz_dense_free(&model->D);
}

/* Phi'D Phi; what of a rigid motion is no more than rounding is zero. */
static ritz_status project_damping(const ritz_dense *D, ritz_modal_model *model)
{
    RITZ_OWN(ritz_dense) most = {0};

    RITZ_CHECK(ritz_dense_project(D, &model->Phi, &model->Delta));
    RITZ_CHECK(ritz_dense_terms(D, &model->Phi, &most));
    for (int64_t j = 0; j < model->count; j++)
        for (int64_t i = 0; i < model->count; i++)
            if ((i < model->num_rigid || j < model->num_rigid) &&
                fabs(ritz_dense_col(&model->Delta, j)[i]) <=
                    RITZ_SUM_ROUNDING * ritz_dense_col(&most, j)[i])
                ritz_dense_col(&model->Delta, j)[i] = 0.0;
    return RITZ_OK;
}

double ritz_modal_rate(const ritz_damping *damping, int64_t flexible,
                       double lambda)
{
    double w = sqrt(fmax(lambda, 0.0));

    if (!damping)
        return 0.0;
    if (ritz_damping_is_rayleigh(damping))
        return damping->a + damping->b * lambda;
    return flexible < 0 ? 0.0
                        : 2.0 * w * ritz_damping_of_mode(damping, flexible, w);
}

/* R X = (K + s M)^-1 X - Phi (Lambda + s)^-1 Phi'X, and |.| of the first. */
static ritz_status massless_share(const ritz_structure *model,
                                  const ritz_modal_model *modes,
                                  const ritz_dense *X, ritz_dense *RX,
                                  double *size)
{
    int64_t r = modes->num_rigid;
    double s = r < modes->count ? fabs(modes->lambda[r]) : 1.0;
    RITZ_OWN(ritz_dense) A = {0}, Y = {0}, q = {0}, part = {0};

    RITZ_CHECK(ritz_dense_copy(&model->K, &A));
    ritz_dense_add(s, &model->M, &A);
    RITZ_CHECK(ritz_dense_copy(X, &Y));
    RITZ_CHECK_IN("motion without mass",
                  ritz_general_solve_scaled(&A, false, &Y));
    *size = ritz_dense_max(&Y);
    RITZ_CHECK(ritz_dense_mul_tn(&modes->Phi, X, &q));
    for (int64_t j = 0; j < q.ncol; j++)
        for (int64_t i = 0; i < q.nrow; i++)
            ritz_dense_col(&q, j)[i] /= modes->lambda[i] + s;
    RITZ_CHECK(ritz_dense_mul(&modes->Phi, &q, &part));
    ritz_dense_add(-1.0, &part, &Y);
    RITZ_MOVE(*RX, Y);
    return RITZ_OK;
}

/* Whether outputs contain a derivative of the response of massless dofs. */
static ritz_status is_improper(const ritz_dense *C, const ritz_dense *RB,
                               double size, bool *out)
{
    RITZ_OWN(ritz_dense) seen = {0};

    RITZ_CHECK(ritz_dense_mul(C, RB, &seen));
    *out =
        ritz_dense_max(&seen) > RITZ_MASSLESS_SHARE * ritz_dense_max(C) * size;
    return RITZ_OK;
}

/* feed += C R B, once nothing else depends on R. */
static ritz_status add_massless(const ritz_structure *model, const ritz_io *io,
                                const ritz_damping *damping,
                                ritz_modal_model *modes)
{
    RITZ_OWN(ritz_dense) RB = {0}, RD = {0}, feed = {0};
    bool damped = ritz_damping_is_rayleigh(damping) && damping->b > 0.0;
    bool improper[2] = {false, false};
    double size = 0.0;

    if (model->D.val && !damped) {
        RITZ_CHECK(massless_share(model, modes, &model->D, &RD, &size));
        damped = ritz_dense_max(&RD) > RITZ_MASSLESS_SHARE * size;
    }
    RITZ_REFUSE_IF(damped, RITZ_ERR_ARGUMENT,
                   "dofs without mass are damped, and have no state of their "
                   "own: condense them first");
    RITZ_CHECK(massless_share(model, modes, &io->B, &RB, &size));
    RITZ_CHECK(is_improper(&io->Cv, &RB, size, &improper[0]));
    RITZ_CHECK(is_improper(&io->Ca, &RB, size, &improper[1]));
    RITZ_REFUSE_IF(improper[0] || improper[1], RITZ_ERR_ARGUMENT,
                   "an output is the %s of a dof without mass that an input "
                   "drives: no states can give it",
                   improper[0] ? "velocity" : "acceleration");
    RITZ_CHECK(ritz_dense_mul(&io->C, &RB, &feed));
    for (int64_t k = 0; k < feed.nrow * feed.ncol; k++)
        if (fabs(feed.val[k]) >
            RITZ_MASSLESS_SHARE * ritz_dense_max(&io->C) * size)
            modes->feed.val[k] += feed.val[k];
    return RITZ_OK;
}

/* C - Ca Phi Lambda, Cv - Ca Phi Delta, Ca Phi B. */
static ritz_status project_io(const ritz_io *io, ritz_modal_model *model)
{
    RITZ_OWN(ritz_io) part = {0};
    RITZ_OWN(ritz_dense) CaDelta = {0};

    RITZ_CHECK(ritz_io_project(io, &model->Phi, &part));
    RITZ_CHECK(ritz_dense_mul(&part.Ca, &model->Delta, &CaDelta));
    RITZ_CHECK(ritz_dense_mul(&part.Ca, &part.B, &model->feed));
    for (int64_t k = 0; k < model->count; k++)
        for (int64_t i = 0; i < io->num_outputs; i++) {
            double ca = ritz_dense_col(&part.Ca, k)[i];

            ritz_dense_col(&part.C, k)[i] -= ca * model->lambda[k];
            ritz_dense_col(&part.Cv, k)[i] -= ritz_dense_col(&CaDelta, k)[i];
        }
    RITZ_MOVE(model->B, part.B);
    RITZ_MOVE(model->C, part.C);
    RITZ_MOVE(model->Cv, part.Cv);
    RITZ_MOVE(model->Ca, part.Ca);
    return RITZ_OK;
}

void ritz_modal_model_take(ritz_pairs *pairs, int64_t num_dofs,
                           ritz_modal_model *out)
{
    out->num_dofs = num_dofs;
    out->count = pairs->Phi.ncol;
    out->num_rigid = pairs->num_rigid;
    RITZ_MOVE(out->Phi, pairs->Phi);
    RITZ_MOVE(out->lambda, pairs->lambda);
    for (int64_t k = 0; k < out->num_rigid; k++)
        out->lambda[k] = 0.0;
}

ritz_status ritz_modal_model_drive(const ritz_io *io,
                                   const ritz_damping *damping,
                                   ritz_modal_model *modes)
{
    if (!modes->Delta.val)
        RITZ_CHECK(ritz_dense_new(modes->count, modes->count, &modes->Delta));
    for (int64_t k = 0; k < modes->count; k++)
        ritz_dense_col(&modes->Delta, k)[k] +=
            ritz_modal_rate(damping, k - modes->num_rigid, modes->lambda[k]);
    return project_io(io, modes);
}

ritz_status ritz_modal_model_new(const ritz_structure *model, const ritz_io *io,
                                 const ritz_damping *damping,
                                 ritz_modal_model *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_modal_model) modes = {0};

    RITZ_CHECK(ritz_eigen_dense(&model->K, &model->M, &pairs));
    ritz_modal_model_take(&pairs, model->K.nrow, &modes);
    RITZ_CHECK(ritz_dense_mul(&model->M, &modes.Phi, &modes.MPhi));
    if (model->D.val)
        RITZ_CHECK(project_damping(&model->D, &modes));
    RITZ_CHECK(ritz_modal_model_drive(io, damping, &modes));
    if (modes.count < modes.num_dofs && io->num_inputs + io->num_outputs > 0)
        RITZ_CHECK(add_massless(model, io, damping, &modes));
    RITZ_MOVE(*out, modes);
    return RITZ_OK;
}

/* M Phi Delta Phi'M of ratios alone. */
static ritz_status spread_ratios(const ritz_structure *model,
                                 const ritz_damping *damping, ritz_dense *out)
{
    const ritz_structure bare = {model->K, model->M, {0}};
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_dense) MPhiDelta = {0};

    RITZ_CHECK(ritz_io_new(model->K.nrow, 0, 0, &io));
    RITZ_CHECK(ritz_modal_model_new(&bare, &io, damping, &modes));
    RITZ_CHECK(ritz_dense_mul(&modes.MPhi, &modes.Delta, &MPhiDelta));
    return ritz_dense_mul_nt(&MPhiDelta, &modes.MPhi, out);
}

ritz_status ritz_modal_damping(const ritz_structure *model,
                               const ritz_damping *damping, ritz_dense *D)
{
    int64_t n = model->K.nrow;
    RITZ_OWN(ritz_dense) more = {0};

    if (damping->kind == RITZ_DAMPING_NONE)
        return RITZ_OK;
    if (!ritz_damping_is_rayleigh(damping)) {
        RITZ_CHECK(spread_ratios(model, damping, &more));
    } else {
        RITZ_CHECK(ritz_dense_new(n, n, &more));
        for (int64_t k = 0; k < n * n; k++)
            more.val[k] =
                damping->a * model->M.val[k] + damping->b * model->K.val[k];
    }
    if (D->val)
        ritz_dense_add(1.0, D, &more);
    ritz_dense_replace(D, &more);
    return RITZ_OK;
}

int64_t ritz_modal_decoupled(const ritz_modal_model *modes)
{
    int64_t r = modes->num_rigid;

    for (int64_t j = r; j < modes->count; j++)
        for (int64_t i = 0; i < r; i++)
            if (ritz_dense_col(&modes->Delta, j)[i] != 0.0 ||
                ritz_dense_col(&modes->Delta, i)[j] != 0.0)
                return 0;
    return r;
}

double ritz_modal_scale(double lambda)
{
    return lambda != 0.0 ? sqrt(fabs(lambda)) : 1.0;
}

/* Row k of a modal model, as inputs and outputs have it, in its states. */
static void put_loads(const ritz_modal_model *modes, int64_t k, double s,
                      int64_t q, int64_t v, ritz_dense *B, ritz_dense *C)
{
    for (int64_t j = 0; B && j < modes->B.ncol; j++)
        ritz_dense_col(B, j)[v] = ritz_dense_col(&modes->B, j)[k];
    for (int64_t i = 0; C && i < modes->C.nrow; i++) {
        if (q >= 0)
            ritz_dense_col(C, q)[i] = ritz_dense_col(&modes->C, k)[i] / s;
        ritz_dense_col(C, v)[i] = ritz_dense_col(&modes->Cv, k)[i];
    }
}

ritz_status ritz_modal_states(const ritz_modal_model *modes,
                              const ritz_modal_layout *layout, ritz_dense *A,
                              ritz_dense *B, ritz_dense *C)
{
    int64_t first = layout->first;
    int64_t positions = modes->count - layout->position;
    int64_t n = positions + modes->count - first;

    RITZ_CHECK(ritz_dense_new(n, n, A));
    if (B)
        RITZ_CHECK(ritz_dense_new(n, modes->B.ncol, B));
    if (C)
        RITZ_CHECK(ritz_dense_new(modes->C.nrow, n, C));
    for (int64_t k = first; k < modes->count; k++) {
        double lambda = modes->lambda[k];
        double s =
            layout->scale ? layout->scale[k - first] : ritz_modal_scale(lambda);
        int64_t q = k - layout->position, v = positions + k - first;

        if (q >= 0) {
            ritz_dense_col(A, v)[q] = s;
            ritz_dense_col(A, q)[v] = -lambda / s;
        }
        for (int64_t i = first; i < modes->count; i++)
            ritz_dense_col(A, v)[positions + i - first] =
                -ritz_dense_col(&modes->Delta, k)[i];
        put_loads(modes, k, s, q, v, B, C);
    }
    return RITZ_OK;
}

void ritz_modal_model_free(ritz_modal_model *model)
{
    ritz_dense_free(&model->Phi);
    ritz_dense_free(&model->MPhi);
    free(model->lambda);
    ritz_dense_free(&model->Delta);
    ritz_dense_free(&model->B);
    ritz_dense_free(&model->C);
    ritz_dense_free(&model->Cv);
    ritz_dense_free(&model->Ca);
    ritz_dense_free(&model->feed);
    *model = (ritz_modal_model){0};
}
