/*
 * A component in the space of its lowest modes and of static responses,
 *
 *     (K - sigma M) X = [B, b_1, b_2, ...],    W = [Phi X],   sigma <= 0,
 *
 * where X is without its part along Phi and has columns of unit length in
 * K - sigma M.
 * Truncated modes alone are not accurate, since all modes that were left out
 * contribute to the motion across a damper [ChuMilman1992, eq. 11-14].
 *
 * Each choice of dampers uses a choice of columns of W. With G = W'(K - sigma
 * M) W of these columns and G E = E g, the basis is W E g^-1/2.
 */
#include "poles/h2.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <math.h>
#include <string.h>

/* Scale the columns of X to unit length in A; those that are small relative to
   `before`, X with its part along Phi, become zero. */
static ritz_status normalise_columns(const ritz_sparse *A,
                                     const ritz_dense *before, ritz_dense *X)
{
    RITZ_OWN(ritz_dense) AX = {0}, Abefore = {0};

    RITZ_CHECK(ritz_sparse_mul(A, X, &AX));
    RITZ_CHECK(ritz_sparse_mul(A, before, &Abefore));
    for (int64_t j = 0; j < X->ncol; j++) {
        double size = sqrt(fmax(ritz_dense_dot(X, j, &AX, j), 0.0));
        double whole = sqrt(fmax(ritz_dense_dot(before, j, &Abefore, j), 0.0));
        double factor = size > RITZ_STATIC_DEPENDENT * whole ? 1.0 / size : 0.0;

        for (int64_t i = 0; i < X->nrow; i++)
            ritz_dense_col(X, j)[i] *= factor;
    }
    return RITZ_OK;
}

/* Responses X to inputs and dampers, without their part along Phi. */
static ritz_status find_responses(const ritz_component *component,
                                  const ritz_pairs *pairs, double sigma,
                                  ritz_dense *out)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0}, MPhi = {0}, before = {0};

    RITZ_CHECK(ritz_sparse_add(1.0, &component->K, -sigma, &component->M, &A));
    RITZ_CHECK_IN("static solution", ritz_factor_spd(&A, &F));
    RITZ_CHECK(ritz_dense_beside(&component->io.B, &component->dampers.B, &X));
    RITZ_CHECK(ritz_factor_solve(F, &X));
    RITZ_CHECK(ritz_dense_copy(&X, &before));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &pairs->Phi, &MPhi));
    for (int pass = 0; pass < 2; pass++)
        RITZ_CHECK(ritz_dense_take_out(&pairs->Phi, &MPhi, &X));
    RITZ_CHECK(normalise_columns(&A, &before, &X));
    RITZ_MOVE(*out, X);
    return RITZ_OK;
}

static ritz_status project_component(const ritz_component *component,
                                     const ritz_dense *W,
                                     ritz_static_space *space)
{
    RITZ_CHECK(ritz_sparse_project(&component->K, W, &space->whole.K));
    RITZ_CHECK(ritz_sparse_project(&component->M, W, &space->whole.M));
    if (component->D.colptr)
        RITZ_CHECK(ritz_sparse_project(&component->D, W, &space->whole.D));
    RITZ_CHECK(ritz_io_project(&component->io, W, &space->io));
    return ritz_dampers_project(&component->dampers, W, &space->dampers);
}

/* Shift of K: 0, or -lambda of the lowest flexible mode if the component has
   rigid motion. */
static double choose_shift(const ritz_pairs *pairs)
{
    int64_t r = pairs->num_rigid;

    if (r == 0)
        return 0.0;
    return r < pairs->Phi.ncol && pairs->lambda[r] > 0.0 ? -pairs->lambda[r]
                                                         : -1.0;
}

ritz_status ritz_static_space_new(ritz_model model, int64_t modes,
                                  const ritz_disturbance *noise,
                                  ritz_static_space *out)
{
    const ritz_component *component = model.component;
    const ritz_span span = {.modes = modes};
    RITZ_OWN(ritz_static_space) space = {.noise = *noise};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) X = {0}, W = {0};

    RITZ_CHECK(ritz_structure_refuse(component->K4.colptr != NULL));
    RITZ_CHECK(ritz_eigen_sparse(&component->K, &component->M, &span, &pairs));
    space.num_modes = pairs.Phi.ncol;
    space.num_inputs = component->io.num_inputs;
    space.sigma = choose_shift(&pairs);
    RITZ_CHECK(find_responses(component, &pairs, space.sigma, &X));
    RITZ_CHECK(ritz_dense_beside(&pairs.Phi, &X, &W));
    RITZ_CHECK(project_component(component, &W, &space));
    if (model.damping)
        space.damping = *model.damping;
    RITZ_MOVE(*out, space);
    return RITZ_OK;
}

/* The columns of W for a choice of dampers, without those that are zero. */
static ritz_status choose_columns(const ritz_static_space *space,
                                  const bool *used, int64_t *count,
                                  int64_t **out)
{
    int64_t fixed = space->num_modes + space->num_inputs;
    RITZ_OWN_ARRAY int64_t *column = NULL;

    RITZ_CHECK_NEW(column, fixed + space->dampers.count);
    *count = 0;
    for (int64_t j = 0; j < fixed + space->dampers.count; j++) {
        double own = ritz_dense_col(&space->whole.K, j)[j] -
                     space->sigma * ritz_dense_col(&space->whole.M, j)[j];

        if (j >= fixed && used && !used[j - fixed])
            continue;
        if (j < space->num_modes || own > 0.0)
            column[(*count)++] = j;
    }
    RITZ_MOVE(*out, column);
    return RITZ_OK;
}

/* V with V'(K - sigma M) V = I, for these columns. */
static ritz_status orthonormalise_columns(const ritz_static_space *space,
                                          int64_t count, const int64_t *column,
                                          ritz_dense *out)
{
    RITZ_OWN(ritz_dense) G = {0}, M = {0}, V = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN_ARRAY double *length = NULL;
    int64_t first = 0;

    RITZ_CHECK_NEW(length, count);
    RITZ_CHECK(ritz_dense_principal(&space->whole.K, count, column, &G));
    RITZ_CHECK(ritz_dense_principal(&space->whole.M, count, column, &M));
    ritz_dense_add(-space->sigma, &M, &G);
    for (int64_t j = 0; j < count; j++)
        length[j] = 1.0 / sqrt(fmax(ritz_dense_col(&G, j)[j], 0.0));
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < count; i++)
            ritz_dense_col(&G, j)[i] *= length[i] * length[j];
    RITZ_CHECK(ritz_general_symmetric(&G, &pairs));
    while (first < count && !(pairs.lambda[first] > RITZ_SQUARED_DEPENDENT))
        first++;
    RITZ_CHECK(ritz_dense_columns(&pairs.Phi, first, count - first, &V));
    for (int64_t j = 0; j < V.ncol; j++)
        for (int64_t i = 0; i < count; i++)
            ritz_dense_col(&V, j)[i] *=
                length[i] / sqrt(pairs.lambda[first + j]);
    RITZ_MOVE(*out, V);
    return RITZ_OK;
}

/* V'A(column, column) V */
static ritz_status project_columns(const ritz_dense *A, int64_t count,
                                   const int64_t *column, const ritz_dense *V,
                                   ritz_dense *out)
{
    RITZ_OWN(ritz_dense) part = {0};

    if (!A->val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_principal(A, count, column, &part));
    return ritz_dense_project(&part, V, out);
}

ritz_status ritz_static_space_plant(const ritz_static_space *space,
                                    const bool *used, ritz_plant *out)
{
    RITZ_OWN(ritz_plant)
    plant = {.damping = space->damping, .noise = space->noise};
    RITZ_OWN_ARRAY int64_t *column = NULL;
    RITZ_OWN(ritz_dense) V = {0}, all = {0};
    int64_t count = 0;

    RITZ_CHECK(choose_columns(space, used, &count, &column));
    RITZ_CHECK(orthonormalise_columns(space, count, column, &V));
    RITZ_CHECK(
        project_columns(&space->whole.K, count, column, &V, &plant.base.K));
    RITZ_CHECK(
        project_columns(&space->whole.M, count, column, &V, &plant.base.M));
    RITZ_CHECK(
        project_columns(&space->whole.D, count, column, &V, &plant.base.D));
    RITZ_CHECK(ritz_dense_new(space->whole.K.nrow, V.ncol, &all));
    ritz_dense_spread(&V, column, &all);
    RITZ_CHECK(ritz_io_project(&space->io, &all, &plant.io));
    RITZ_CHECK(ritz_dampers_project(&space->dampers, &all, &plant.dampers));
    RITZ_MOVE(*out, plant);
    return RITZ_OK;
}

void ritz_static_space_free(ritz_static_space *space)
{
    ritz_structure_free(&space->whole);
    ritz_io_free(&space->io);
    ritz_dampers_free(&space->dampers);
    *space = (ritz_static_space){0};
}
