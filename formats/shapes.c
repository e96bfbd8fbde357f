/* Shapes of modes and of columns, at points. */
#include "formats/shapes_parts.h"

#include "base/alloc.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Chosen columns, and room for what they are called. */
static ritz_status pick(const ritz_dense *from, const shapes_choice *which,
                        ritz_dense *T, ritz_shapes *out)
{
    RITZ_CHECK(ritz_dense_new(from->nrow, which->count, T));
    RITZ_CHECK_NEW(out->name, which->count + 1);
    out->count = which->count;
    for (int64_t j = 0; j < which->count; j++)
        memcpy(ritz_dense_col(T, j), ritz_dense_col(from, which->at[j]),
               (size_t)T->nrow * sizeof *T->val);
    return RITZ_OK;
}

/* "mode 7, 12.3 Hz" */
static ritz_status pick_modes(const ritz_pairs *pairs,
                              const shapes_choice *which, ritz_dense *Phi,
                              ritz_shapes *out)
{
    RITZ_CHECK(pick(&pairs->Phi, which, Phi, out));
    for (int64_t j = 0; j < which->count; j++) {
        int64_t k = which->at[j];
        double hertz =
            k < pairs->num_rigid ? 0.0 : ritz_eigen_hertz(pairs->lambda[k]);

        snprintf(out->name[j], RITZ_NAME_SIZE, "mode %" PRId64 ", %.4g Hz",
                 k + 1, hertz);
    }
    return RITZ_OK;
}

/* A body that moves by T, with recovered dofs behind its own. */
typedef struct body {
    int64_t num_dofs;
    const ritz_dof *dof;
    const ritz_recovery *recovery;
    const ritz_grids *grids;
    const ritz_elements *elements;
} body;

static ritz_status finish(const body *of, const ritz_dense *T,
                          ritz_shapes *shapes)
{
    ritz_status status = RITZ_OK;
    ritz_dof *all = NULL;
    ritz_dense shape = {0};
    shapes_motion m = {.grids = of->grids, .elements = of->elements};

    RITZ_TRY(ritz_recovery_extend(of->recovery, of->num_dofs, of->dof, T, &all,
                                  &shape));
    m.num_dofs = of->num_dofs + of->recovery->count;
    m.dof = all;
    m.T = &shape;
    RITZ_TRY(shapes_place(&m, shapes));
done:
    free(all);
    ritz_dense_free(&shape);
    return status;
}

static body of_component(const ritz_component *component)
{
    return (body){component->num_dofs, component->dof, &component->recovery,
                  &component->grids, &component->elements};
}

ritz_status ritz_shapes_of_reduced(const ritz_reduced *reduced,
                                   const char *list, ritz_shapes *out)
{
    ritz_status status = RITZ_OK;
    const body whole = {reduced->num_dofs, reduced->dof, &reduced->recovery,
                        &reduced->grids, &reduced->elements};
    ritz_shapes shapes = {0};
    ritz_dampers dampers = {0};
    ritz_dense K = {0}, D = {0}, Phi = {0}, T = {0};
    ritz_pairs pairs = {0};
    shapes_choice which = {0};

    RITZ_FAIL_IF(!reduced->T.val || !reduced->dof, RITZ_ERR_ARGUMENT,
                 "it was reduced --without-basis, which holds the shapes");
    RITZ_TRY(ritz_dense_copy(&reduced->K, &K));
    RITZ_TRY(ritz_dampers_copy(&reduced->dampers, &dampers));
    RITZ_TRY(ritz_dampers_install(&dampers, &K, &D));
    RITZ_TRY(ritz_eigen_dense(&K, &reduced->M, &pairs));
    RITZ_TRY(shapes_choose(list, "mode", pairs.Phi.ncol, &which));
    RITZ_TRY(pick_modes(&pairs, &which, &Phi, &shapes));
    RITZ_TRY(ritz_dense_mul(&reduced->T, &Phi, &T));
    RITZ_TRY(finish(&whole, &T, &shapes));
    *out = shapes;
    shapes = (ritz_shapes){0};
done:
    ritz_shapes_free(&shapes);
    ritz_dampers_free(&dampers);
    ritz_dense_free(&K);
    ritz_dense_free(&D);
    ritz_dense_free(&Phi);
    ritz_dense_free(&T);
    ritz_pairs_free(&pairs);
    free(which.at);
    return status;
}

ritz_status ritz_shapes_of_component(const ritz_component *component,
                                     const char *list, ritz_shapes *out)
{
    enum { USUAL = 10 };
    ritz_status status = RITZ_OK;
    const body whole = of_component(component);
    ritz_shapes shapes = {0};
    ritz_dampers dampers = {0};
    ritz_sparse K = {0}, D = {0};
    ritz_span span = {.modes = USUAL};
    ritz_dense Phi = {0};
    ritz_pairs pairs = {0};
    shapes_choice which = {0};

    if (list)
        RITZ_TRY(shapes_furthest(list, &span.modes));
    if (span.modes > component->num_dofs)
        span.modes = component->num_dofs;
    RITZ_TRY(ritz_sparse_copy(&component->K, &K));
    RITZ_TRY(ritz_dampers_copy(&component->dampers, &dampers));
    RITZ_TRY(ritz_dampers_install_sparse(&dampers, &K, &D));
    RITZ_TRY(ritz_eigen_sparse(&K, &component->M, &span, &pairs));
    RITZ_TRY(shapes_choose(list, "mode",
                           list ? pairs.Phi.ncol : pairs.num_rigid + span.modes,
                           &which));
    if (!list && which.count > pairs.Phi.ncol)
        which.count = pairs.Phi.ncol;
    RITZ_TRY(pick_modes(&pairs, &which, &Phi, &shapes));
    RITZ_TRY(finish(&whole, &Phi, &shapes));
    *out = shapes;
    shapes = (ritz_shapes){0};
done:
    ritz_shapes_free(&shapes);
    ritz_dampers_free(&dampers);
    ritz_sparse_free(&K);
    ritz_sparse_free(&D);
    ritz_dense_free(&Phi);
    ritz_pairs_free(&pairs);
    free(which.at);
    return status;
}

/* "column 3 constraint", "column 9 normal, 12.3 Hz" */
static ritz_status pick_columns(const ritz_basis *basis,
                                const shapes_choice *which, ritz_dense *T,
                                ritz_shapes *out)
{
    RITZ_CHECK(pick(&basis->T, which, T, out));
    for (int64_t j = 0; j < which->count; j++) {
        int64_t k = which->at[j];
        const char *kind = ritz_column_name(basis->columns.kind[k]);
        double hertz = basis->columns.hertz[k];

        if (isfinite(hertz))
            snprintf(out->name[j], RITZ_NAME_SIZE,
                     "column %" PRId64 " %s, %.4g Hz", k + 1, kind, hertz);
        else
            snprintf(out->name[j], RITZ_NAME_SIZE, "column %" PRId64 " %s",
                     k + 1, kind);
    }
    return RITZ_OK;
}

ritz_status ritz_shapes_of_basis(const ritz_basis *basis,
                                 const ritz_component *component,
                                 const char *list, ritz_shapes *out)
{
    ritz_status status = RITZ_OK;
    const body whole = of_component(component);
    ritz_shapes shapes = {0};
    ritz_dense T = {0};
    shapes_choice which = {0};

    RITZ_FAIL_IF(basis->states, RITZ_ERR_ARGUMENT,
                 "a basis of states has no shapes");
    RITZ_FAIL_IF(basis->T.nrow != component->num_dofs, RITZ_ERR_ARGUMENT,
                 "the basis is for %" PRId64
                 " dofs, the component has %" PRId64,
                 basis->T.nrow, component->num_dofs);
    RITZ_TRY(shapes_choose(list, "column", basis->T.ncol, &which));
    RITZ_TRY(pick_columns(basis, &which, &T, &shapes));
    RITZ_TRY(finish(&whole, &T, &shapes));
    *out = shapes;
    shapes = (ritz_shapes){0};
done:
    ritz_shapes_free(&shapes);
    ritz_dense_free(&T);
    free(which.at);
    return status;
}

void ritz_shapes_free(ritz_shapes *shapes)
{
    free(shapes->id);
    free(shapes->position);
    free(shapes->name);
    ritz_elements_free(&shapes->cells);
    ritz_dense_free(&shapes->u);
    ritz_dense_free(&shapes->turn);
    *shapes = (ritz_shapes){0};
}
