/* Sparse M, D, K of a component for the low-rank engine, and its slow modes. */
#include "base/alloc.h"
#include "gramians/low_rank_parts.h"

#include <ritz/eigen.h>

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Of |D||Phi|: what damping leaves of a rigid motion is rounding. */
static const double rounding = 1e-10;

/* D := D + a M + b K */
static ritz_status add_rayleigh(const ritz_sparse *M, const ritz_sparse *K,
                                const ritz_damping *damping, ritz_sparse *D)
{
    ritz_status status = RITZ_OK;
    ritz_sparse C = {0}, sum = {0};

    RITZ_TRY(ritz_sparse_add(damping->a, M, damping->b, K, &C));
    if (D->colptr) {
        RITZ_TRY(ritz_sparse_add(1.0, D, 1.0, &C, &sum));
        ritz_sparse_free(D);
        *D = sum;
    } else {
        *D = C;
        C = (ritz_sparse){0};
    }
done:
    ritz_sparse_free(&C);
    return status;
}

static ritz_status collect_matrices(const ritz_gramians_request *request,
                                    ritz_low_rank_model *model)
{
    ritz_status status = RITZ_OK;
    const ritz_component *component = request->component;
    const ritz_damping *damping = &request->damping;
    ritz_dampers dampers = {0};

    RITZ_FAIL_IF(component->K4.colptr, RITZ_ERR_ARGUMENT,
                 "structural damping is of harmonic motion and has no states, "
                 "give it as a modal ratio");
    RITZ_FAIL_IF(damping->kind != RITZ_DAMPING_NONE &&
                     !ritz_damping_is_rayleigh(damping),
                 RITZ_ERR_ARGUMENT,
                 "ratios of modes make no sparse matrix D, which engine "
                 "'low-rank' needs: give rayleigh damping or a fit, or take "
                 "engine 'modal'");
    model->n = component->num_dofs;
    model->M = component->M;
    RITZ_TRY(ritz_sparse_copy(&component->K, &model->K));
    if (component->D.colptr)
        RITZ_TRY(ritz_sparse_copy(&component->D, &model->D));
    RITZ_TRY(ritz_dampers_copy(&component->dampers, &dampers));
    RITZ_TRY(ritz_dampers_install_sparse(&dampers, &model->K, &model->D));
    if (damping->kind != RITZ_DAMPING_NONE)
        RITZ_TRY(add_rayleigh(&model->M, &model->K, damping, &model->D));
    RITZ_FAIL_IF(!model->D.colptr || ritz_sparse_max(&model->D) == 0.0,
                 RITZ_ERR_ARGUMENT,
                 "there is no damping, without which no motion decays and no "
                 "Gramian is finite");
    if (ritz_sparse_asymmetry(&model->D) > 0.0)
        RITZ_TRY(ritz_sparse_transpose(&model->D, &model->Dt));
done:
    ritz_dampers_free(&dampers);
    return status;
}

static bool is_zero_column(const ritz_sparse *A, int64_t j)
{
    for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
        if (A->val[p] != 0.0)
            return false;
    return true;
}

/* Dofs with and without mass; damping must leave the latter alone. */
static ritz_status split_dofs(const ritz_component *component,
                              ritz_low_rank_model *model)
{
    int64_t count = 0;
    char name[RITZ_DOF_NAME_SIZE];

    RITZ_CHECK_NEW(model->massless.at, model->n);
    for (int64_t j = 0; j < model->n; j++) {
        if (!is_zero_column(&model->M, j))
            continue;
        RITZ_REFUSE_IF(!is_zero_column(&model->D, j) ||
                           (model->Dt.colptr && !is_zero_column(&model->Dt, j)),
                       RITZ_ERR_ARGUMENT,
                       "%s has no mass but is damped, and has no state of its "
                       "own: condense it first, or damp it otherwise",
                       ritz_dof_name(component->dof[j], name));
        model->massless.at[count++] = j;
    }
    model->massless.count = count;
    return ritz_dofs_complement(&model->massless, model->n, &model->massive);
}

/* What a dof has of stiffness and mass: units that residuals are told in. */
static ritz_status weigh_dofs(double lambda, ritz_low_rank_model *model)
{
    RITZ_CHECK_NEW(model->stiff, model->n);
    RITZ_CHECK_NEW(model->mass, model->n);
    for (int64_t j = 0; j < model->n; j++) {
        model->mass[j] = ritz_sparse_diagonal(&model->M, j);
        model->stiff[j] =
            fabs(ritz_sparse_diagonal(&model->K, j)) + lambda * model->mass[j];
    }
    return RITZ_OK;
}

/* |D Phi - M Phi (Phi'D Phi)| of a rigid motion against |D||Phi|. */
static ritz_status check_apart(const ritz_sparse *D,
                               const ritz_low_rank_model *model)
{
    ritz_status status = RITZ_OK;
    ritz_dense DPhi = {0};

    RITZ_TRY(ritz_sparse_mul(D, &model->Phi, &DPhi));
    RITZ_TRY(ritz_dense_take_out(&model->MPhi, &model->Phi, &DPhi));
    RITZ_FAIL_IF(ritz_dense_max(&DPhi) > rounding * ritz_sparse_max(D) *
                                             ritz_dense_max(&model->Phi),
                 RITZ_ERR_ARGUMENT,
                 "damping couples rigid motion to deformation, which engine "
                 "'low-rank' cannot set apart: hold the component, or take "
                 "engine 'dense'");
done:
    ritz_dense_free(&DPhi);
    return status;
}

/* Poles of the lowest flexible modes, one of a pair, the slower real one. */
static ritz_status find_starts(const ritz_pairs *pairs,
                               ritz_low_rank_model *model)
{
    ritz_status status = RITZ_OK;
    ritz_dense Phi = {0}, DPhi = {0};
    int64_t flexible = pairs->Phi.ncol - pairs->num_rigid;

    model->num_starts =
        flexible < RITZ_LOW_RANK_STARTS ? flexible : RITZ_LOW_RANK_STARTS;
    Phi = ritz_dense_part(&pairs->Phi, pairs->num_rigid, model->num_starts);
    RITZ_TRY(ritz_sparse_mul(&model->D, &Phi, &DPhi));
    for (int64_t k = 0; k < model->num_starts; k++) {
        double lambda = pairs->lambda[pairs->num_rigid + k];
        double d = ritz_dense_dot(&Phi, k, &DPhi, k) / 2.0;

        RITZ_FAIL_IF(!(lambda > 0.0), RITZ_ERR_ARGUMENT,
                     "K is not positive semidefinite, an eigenvalue is %.3g: "
                     "the component is not stable",
                     lambda);
        d = fmax(d, 16.0 * DBL_EPSILON * sqrt(lambda));
        if (d * d < lambda)
            model->start[k] =
                -d + sqrt(lambda - d * d) * (double _Complex)_Complex_I;
        else
            model->start[k] = -lambda / (d + sqrt(d * d - lambda));
    }
done:
    ritz_dense_free(&DPhi);
    return status;
}

static ritz_status find_modes(ritz_low_rank_model *model)
{
    ritz_status status = RITZ_OK;
    const ritz_span span = {.modes = RITZ_LOW_RANK_STARTS};
    ritz_pairs pairs = {0};
    double lambda = 1.0;

    RITZ_TRY_IN("modes to begin with",
                ritz_eigen_sparse(&model->K, &model->M, &span, &pairs));
    RITZ_TRY(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &model->Phi));
    RITZ_TRY(ritz_sparse_mul(&model->M, &model->Phi, &model->MPhi));
    RITZ_TRY(check_apart(&model->D, model));
    if (model->Dt.colptr)
        RITZ_TRY(check_apart(&model->Dt, model));
    RITZ_TRY(find_starts(&pairs, model));
    if (model->num_starts > 0)
        lambda = pairs.lambda[pairs.num_rigid];
    RITZ_TRY(weigh_dofs(lambda, model));
done:
    ritz_pairs_free(&pairs);
    return status;
}

ritz_status ritz_low_rank_model_new(const ritz_gramians_request *request,
                                    ritz_low_rank_model *out)
{
    ritz_status status = RITZ_OK;
    ritz_low_rank_model model = {0};

    RITZ_FAIL_IF(request->component->num_dofs == 0, RITZ_ERR_ARGUMENT,
                 "the component has no dofs");
    RITZ_TRY(collect_matrices(request, &model));
    RITZ_TRY(split_dofs(request->component, &model));
    RITZ_TRY(find_modes(&model));
    RITZ_TRY(ritz_low_rank_loads(&request->component->io, &model));
    *out = model;
    model = (ritz_low_rank_model){0};
done:
    ritz_low_rank_model_free(&model);
    return status;
}

void ritz_low_rank_model_free(ritz_low_rank_model *model)
{
    ritz_sparse_free(&model->K);
    ritz_sparse_free(&model->D);
    ritz_sparse_free(&model->Dt);
    ritz_dofs_free(&model->massive);
    ritz_dofs_free(&model->massless);
    ritz_dense_free(&model->Phi);
    ritz_dense_free(&model->MPhi);
    for (int side = 0; side < RITZ_SIDES; side++)
        for (int half = 0; half < RITZ_HALVES; half++)
            ritz_dense_free(&model->W[side][half]);
    free(model->stiff);
    free(model->mass);
    *model = (ritz_low_rank_model){0};
}
