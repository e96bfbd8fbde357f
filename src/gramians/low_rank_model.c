/* Matrices, loads and slow modes that the low-rank iteration starts from. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/low_rank_parts.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>

/*
 * What the iteration starts from: of inputs W = [0; B], of outputs
 * W = [C'; Cv'], without the part that rigid motion takes, M Phi Phi'W.
 *
 * Dofs m without mass, and without damping, follow those with mass:
 *
 *     u_m = -K_mm^-1 (K_mr u_r - B_m f),    T = [I; -K_mm^-1 K_mr],
 *
 * so that B and C' become T'B and T'C', zero in rows m, and C_m K_mm^-1 B_m
 * feeds through. An acceleration output gives, with X = T M_rr^-1 T'Ca',
 *
 *     C' := C' - K X,    Cv' := Cv' - D'X.
 *
 * Feedthrough is left out: it is the same whatever is kept.
 */

/* Rows @p to of A += f X. */
static void add_rows(const ritz_dofs *to, double f, const ritz_dense *X,
                     ritz_dense *A)
{
    for (int64_t j = 0; j < X->ncol; j++)
        for (int64_t i = 0; i < to->count; i++)
            ritz_dense_col(A, j)[to->at[i]] += f * ritz_dense_col(X, j)[i];
}

static void clear_rows(const ritz_dofs *rows, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < rows->count; i++)
            ritz_dense_col(A, j)[rows->at[i]] = 0.0;
}

/* X := K_mm^-1 of rows m of A. */
static ritz_status solve_held(const ritz_low_rank_model *model, ritz_factor *F,
                              const ritz_dense *A, ritz_dense *X)
{
    RITZ_CHECK(
        ritz_dense_rows(A, model->massless.count, model->massless.at, X));
    return ritz_factor_solve(F, X);
}

/* A := T'A */
static ritz_status condense_massless(const ritz_low_rank_model *model,
                                     const ritz_sparse *K_rm, ritz_factor *F,
                                     ritz_dense *A)
{
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};

    RITZ_CHECK(solve_held(model, F, A, &X));
    RITZ_CHECK(ritz_sparse_mul(K_rm, &X, &Y));
    add_rows(&model->massive, -1.0, &Y, A);
    clear_rows(&model->massless, A);
    return RITZ_OK;
}

/* A := T A, whose rows m are zero. */
static ritz_status follow_rows(const ritz_low_rank_model *model, ritz_factor *F,
                               ritz_dense *A)
{
    RITZ_OWN(ritz_dense) KA = {0}, X = {0};

    RITZ_CHECK(ritz_sparse_mul(&model->K, A, &KA));
    RITZ_CHECK(solve_held(model, F, &KA, &X));
    add_rows(&model->massless, -1.0, &X, A);
    return RITZ_OK;
}

/* Refuse outputs C' of motions without mass that inputs cause at once. */
static ritz_status refuse_improper(const ritz_low_rank_model *model,
                                   ritz_factor *F, const ritz_dense *B,
                                   const ritz_dense *Ct, const char *what)
{
    RITZ_OWN(ritz_dense) X = {0}, C_m = {0}, feed = {0};

    RITZ_CHECK(solve_held(model, F, B, &X));
    RITZ_CHECK(
        ritz_dense_rows(Ct, model->massless.count, model->massless.at, &C_m));
    RITZ_CHECK(ritz_dense_mul_tn(&C_m, &X, &feed));
    RITZ_REFUSE_IF(ritz_dense_max(&feed) > RITZ_RIGID_LOAD *
                                               ritz_dense_max(&C_m) *
                                               ritz_dense_max(&X),
                   RITZ_ERR_ARGUMENT,
                   "an output is the %s of a dof without mass that an input "
                   "drives: no states can give it",
                   what);
    return RITZ_OK;
}

/* B, C', Cv', Ca' of dofs with mass alone; F holds the others. */
static ritz_status condense_all(const ritz_low_rank_model *model,
                                ritz_dense *const parts[static 4],
                                ritz_factor **F)
{
    const ritz_dofs *m = &model->massless;
    const ritz_dofs *r = &model->massive;
    RITZ_OWN(ritz_sparse) K_mm = {0}, K_rm = {0};

    if (m->count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_extract(&model->K, m->count, m->at, m->count, m->at,
                                   &K_mm));
    RITZ_CHECK(ritz_sparse_extract(&model->K, r->count, r->at, m->count, m->at,
                                   &K_rm));
    RITZ_CHECK_IN("stiffness that holds the dofs without mass",
                  ritz_factor_spd(&K_mm, F));
    RITZ_CHECK(refuse_improper(model, *F, parts[0], parts[2], "velocity"));
    RITZ_CHECK(refuse_improper(model, *F, parts[0], parts[3], "acceleration"));
    for (int k = 0; k < 4; k++)
        RITZ_CHECK(condense_massless(model, &K_rm, *F, parts[k]));
    return RITZ_OK;
}

/* X := T M_rr^-1 X; M_rr must be definite in any case. */
static ritz_status solve_free(const ritz_low_rank_model *model, ritz_factor *F,
                              ritz_dense *X)
{
    const ritz_dofs *r = &model->massive;
    RITZ_OWN(ritz_sparse) M_rr = {0};
    RITZ_OWN(ritz_factor) *mass = NULL;
    RITZ_OWN(ritz_dense) Y = {0};
    ritz_status status = RITZ_OK;

    if (r->count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_extract(&model->M, r->count, r->at, r->count, r->at,
                                   &M_rr));
    status = ritz_factor_spd(&M_rr, &mass);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, RITZ_ERR_SINGULAR,
                   "M is singular, and not by dofs without mass alone: engines "
                   "'projection' and 'low-rank' need mass for every other "
                   "motion");
    RITZ_CHECK(status);
    if (ritz_dense_max(X) == 0.0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_rows(X, r->count, r->at, &Y));
    RITZ_CHECK(ritz_factor_solve(mass, &Y));
    clear_rows(r, X);
    add_rows(r, 1.0, &Y, X);
    return F ? follow_rows(model, F, X) : RITZ_OK;
}

/* Y := Y - A X */
static ritz_status subtract_product(const ritz_sparse *A, const ritz_dense *X,
                                    ritz_dense *Y)
{
    RITZ_OWN(ritz_dense) AX = {0};

    RITZ_CHECK(ritz_sparse_mul(A, X, &AX));
    ritz_dense_add(-1.0, &AX, Y);
    return RITZ_OK;
}

/* Row i of the upper half: W_c has displacements there, W_o forces. */
static double unit_above(const ritz_low_rank_model *model, int side, int64_t i)
{
    double stiff = model->stiff[i];

    if (!(stiff > 0.0))
        return 0.0;
    return side == RITZ_CONTROLLABLE ? sqrt(stiff) : 1.0 / sqrt(stiff);
}

/* Row i of the lower half, velocities; of M times that, one over it. */
static double unit_below(const ritz_low_rank_model *model, int64_t i)
{
    return sqrt(fmax(model->mass[i], 0.0));
}

double ritz_low_rank_unit(const ritz_low_rank_model *model, int side, int64_t i)
{
    int64_t n = model->n;

    return i < n ? unit_above(model, side, i) : unit_below(model, i - n);
}

void ritz_low_rank_weigh(const ritz_low_rank_model *model, int side,
                         ritz_dense W[static RITZ_HALVES])
{
    for (int64_t i = 0; i < model->n; i++) {
        double above = unit_above(model, side, i);
        double m = unit_below(model, i);

        for (int64_t j = 0; j < W[0].ncol; j++) {
            ritz_dense_col(&W[RITZ_ABOVE], j)[i] *= above;
            ritz_dense_col(&W[RITZ_BELOW], j)[i] *= m > 0.0 ? 1.0 / m : 0.0;
        }
    }
}

ritz_status ritz_low_rank_size(const ritz_low_rank_model *model, int side,
                               double *out)
{
    const ritz_dense *W = model->W[side];
    RITZ_OWN(ritz_dense_pair) S = {0}, G = {0};
    RITZ_OWN_ARRAY double *e = NULL;
    int p = (int)W[0].ncol;

    RITZ_CHECK_NEW(e, p);
    RITZ_CHECK(ritz_dense_copy(&W[RITZ_ABOVE], &S[RITZ_ABOVE]));
    RITZ_CHECK(ritz_dense_copy(&W[RITZ_BELOW], &S[RITZ_BELOW]));
    ritz_low_rank_weigh(model, side, S);
    for (int half = 0; half < RITZ_HALVES; half++)
        RITZ_CHECK(ritz_dense_mul_tn(&S[half], &S[half], &G[half]));
    ritz_dense_add(1.0, &G[1], &G[0]);
    RITZ_REFUSE_IF((p > 0 && LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', p,
                                           G[0].val, p, e) != 0) ||
                       (p > 0 && !isfinite(e[p - 1])),
                   RITZ_ERR_CONVERGENCE,
                   "a residual of a Gramian is not finite");
    *out = p > 0 ? fmax(e[p - 1], 0.0) : 0.0;
    return RITZ_OK;
}

/* W of both sides, whose dofs and modes are known. */
static ritz_status find_loads(const ritz_io *io, ritz_low_rank_model *model)
{
    ritz_dense *B = &model->W[RITZ_CONTROLLABLE][RITZ_BELOW];
    ritz_dense *C = &model->W[RITZ_OBSERVABLE][RITZ_ABOVE];
    ritz_dense *Cv = &model->W[RITZ_OBSERVABLE][RITZ_BELOW];
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN(ritz_factor) *F = NULL;

    RITZ_CHECK(ritz_dense_new(model->n, io->num_inputs,
                              &model->W[RITZ_CONTROLLABLE][RITZ_ABOVE]));
    RITZ_CHECK(ritz_dense_copy(&io->B, B));
    RITZ_CHECK(ritz_outputs_scaled(&io->C, io->limit, C));
    RITZ_CHECK(ritz_outputs_scaled(&io->Cv, io->limit, Cv));
    RITZ_CHECK(ritz_outputs_scaled(&io->Ca, io->limit, &X));
    RITZ_CHECK(condense_all(model, (ritz_dense *[]){B, C, Cv, &X}, &F));
    RITZ_CHECK(solve_free(model, F, &X));
    RITZ_CHECK(subtract_product(&model->K, &X, C));
    RITZ_CHECK(
        subtract_product(model->Dt.colptr ? &model->Dt : &model->D, &X, Cv));
    if (model->massless.count > 0) { /* K X has rounding there */
        clear_rows(&model->massless, C);
        clear_rows(&model->massless, Cv);
    }
    for (int side = 0; side < RITZ_SIDES; side++)
        RITZ_CHECK(ritz_low_rank_size(model, side, &model->whole[side]));
    for (int k = 0; k < 2; k++) { /* once leaves rounding */
        RITZ_CHECK(ritz_dense_take_out(&model->MPhi, &model->Phi, B));
        RITZ_CHECK(ritz_dense_take_out(&model->MPhi, &model->Phi, C));
        RITZ_CHECK(ritz_dense_take_out(&model->MPhi, &model->Phi, Cv));
    }
    return RITZ_OK;
}

static ritz_status collect_matrices(const ritz_gramians_request *request,
                                    ritz_low_rank_model *model)
{
    const ritz_component *component = request->component;
    const ritz_damping *damping = &request->damping;

    RITZ_CHECK(ritz_structure_refuse(component->K4.colptr != NULL));
    RITZ_REFUSE_IF(damping->kind != RITZ_DAMPING_NONE &&
                       !ritz_damping_is_rayleigh(damping),
                   RITZ_ERR_ARGUMENT,
                   "ratios of modes make no sparse matrix D, which engines "
                   "'projection' and 'low-rank' need: give rayleigh damping or "
                   "a fit, or take "
                   "engine 'modal'");
    model->n = component->num_dofs;
    model->M = component->M;
    RITZ_CHECK(ritz_structure_sparse(component, damping, &model->K, &model->D));
    RITZ_REFUSE_IF(!model->D.colptr || ritz_sparse_max(&model->D) == 0.0,
                   RITZ_ERR_ARGUMENT,
                   "there is no damping, without which no motion decays and no "
                   "Gramian is finite: give it by --damping");
    if (ritz_sparse_asymmetry(&model->D) > 0.0)
        RITZ_CHECK(ritz_sparse_transpose(&model->D, &model->Dt));
    return RITZ_OK;
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

/* Stiffness and mass of each dof: the units in which residuals are measured. */
static ritz_status weigh_dofs(double lambda, ritz_low_rank_model *model)
{
    model->lowest = lambda;
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
static ritz_status check_decoupled(const ritz_sparse *D,
                                   const ritz_low_rank_model *model)
{
    RITZ_OWN(ritz_dense) DPhi = {0};

    RITZ_CHECK(ritz_sparse_mul(D, &model->Phi, &DPhi));
    RITZ_CHECK(ritz_dense_take_out(&model->MPhi, &model->Phi, &DPhi));
    RITZ_REFUSE_IF(ritz_dense_max(&DPhi) > RITZ_RIGID_LOAD *
                                               ritz_sparse_max(D) *
                                               ritz_dense_max(&model->Phi),
                   RITZ_ERR_ARGUMENT,
                   "damping couples rigid motion to deformation, which engines "
                   "'projection' and 'low-rank' cannot decouple: hold the "
                   "component, or take "
                   "engine 'dense'");
    return RITZ_OK;
}

/* Poles of the lowest flexible modes, one of a pair, the slower real one. */
static ritz_status find_starts(const ritz_pairs *pairs,
                               ritz_low_rank_model *model)
{
    RITZ_OWN(ritz_dense) DPhi = {0};
    ritz_dense Phi = {0};
    int64_t flexible = pairs->Phi.ncol - pairs->num_rigid;

    model->num_starts =
        flexible < RITZ_LOW_RANK_STARTS ? flexible : RITZ_LOW_RANK_STARTS;
    Phi = ritz_dense_part(&pairs->Phi, pairs->num_rigid, model->num_starts);
    RITZ_CHECK(ritz_sparse_mul(&model->D, &Phi, &DPhi));
    for (int64_t k = 0; k < model->num_starts; k++) {
        double lambda = pairs->lambda[pairs->num_rigid + k];
        double d = ritz_dense_dot(&Phi, k, &DPhi, k) / 2.0;

        RITZ_REFUSE_IF(!(lambda > 0.0), RITZ_ERR_ARGUMENT,
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
    return RITZ_OK;
}

static ritz_status find_modes(ritz_low_rank_model *model)
{
    const ritz_span span = {.modes = RITZ_LOW_RANK_STARTS};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double lambda = 1.0;

    RITZ_CHECK_IN("modes to begin with",
                  ritz_eigen_sparse(&model->K, &model->M, &span, &pairs));
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, 0, pairs.num_rigid, &model->Phi));
    RITZ_CHECK(ritz_sparse_mul(&model->M, &model->Phi, &model->MPhi));
    RITZ_CHECK(check_decoupled(&model->D, model));
    if (model->Dt.colptr)
        RITZ_CHECK(check_decoupled(&model->Dt, model));
    RITZ_CHECK(find_starts(&pairs, model));
    if (model->num_starts > 0)
        lambda = pairs.lambda[pairs.num_rigid];
    return weigh_dofs(lambda, model);
}

ritz_status ritz_low_rank_model_new(const ritz_gramians_request *request,
                                    ritz_low_rank_model *out)
{
    RITZ_OWN(ritz_low_rank_model) model = {0};

    RITZ_REFUSE_IF(request->component->num_dofs == 0, RITZ_ERR_ARGUMENT,
                   "the component has no dofs");
    RITZ_CHECK(collect_matrices(request, &model));
    RITZ_CHECK(split_dofs(request->component, &model));
    RITZ_CHECK(find_modes(&model));
    RITZ_CHECK(find_loads(&request->component->io, &model));
    RITZ_MOVE(*out, model);
    return RITZ_OK;
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
    RITZ_FREE(model->stiff, model->mass);
    *model = (ritz_low_rank_model){0};
}
