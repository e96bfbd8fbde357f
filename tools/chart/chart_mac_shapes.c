/* Shapes at dofs, and by what inputs and outputs see; and which rows match. */
#include "chart/chart_mac.h"

#include <ritz/eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Flexible modes of a model, in its own coordinates. */
typedef struct modes {
    ritz_dense Phi;
    double *hertz;
} modes;

static void free_modes(modes *m)
{
    ritz_dense_free(&m->Phi);
    free(m->hertz);
}

static ritz_status keep_flexible(const ritz_pairs *pairs, modes *out)
{
    int64_t first = pairs->num_rigid;
    int64_t count = pairs->Phi.ncol - first;

    count = count < MAC_MOST_MODES ? count : MAC_MOST_MODES;
    RITZ_REFUSE_IF(count < 1, RITZ_ERR_ARGUMENT, "there is no flexible mode");
    RITZ_CHECK(ritz_dense_columns(&pairs->Phi, first, count, &out->Phi));
    out->hertz = calloc((size_t)count, sizeof *out->hertz);
    RITZ_REFUSE_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < count; k++)
        out->hertz[k] = ritz_eigen_hertz(pairs->lambda[first + k]);
    return RITZ_OK;
}

/* Coordinates of a configuration are its modes, rigid ones first. */
static ritz_status modes_at(const ritz_configuration *at, modes *out)
{
    int64_t e = at->K.ncol, first = at->num_rigid;
    int64_t count = e - first < MAC_MOST_MODES ? e - first : MAC_MOST_MODES;

    RITZ_REFUSE_IF(count < 1, RITZ_ERR_ARGUMENT, "there is no flexible mode");
    RITZ_CHECK(ritz_dense_new(e, count, &out->Phi));
    out->hertz = calloc((size_t)count, sizeof *out->hertz);
    RITZ_REFUSE_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < count; k++) {
        ritz_dense_col(&out->Phi, k)[first + k] = 1.0;
        out->hertz[k] = ritz_eigen_hertz(at->lambda[first + k]);
    }
    return RITZ_OK;
}

static ritz_status modes_of(const mac_side *side, modes *out)
{
    ritz_status status = RITZ_OK;
    const ritz_span span = {.modes = MAC_MOST_MODES};
    const model *m = &side->file->model;
    ritz_pairs pairs = {0};

    if (side->at)
        return modes_at(side->at, out);
    if (m->kind == MODEL_REDUCED)
        RITZ_TRY(ritz_eigen_dense(&m->reduced.K, &m->reduced.M, &pairs));
    else
        RITZ_TRY(
            ritz_eigen_sparse(&m->component.K, &m->component.M, &span, &pairs));
    RITZ_TRY(keep_flexible(&pairs, out));
done:
    ritz_pairs_free(&pairs);
    return status;
}

static void name_side(const mac_side *side, mac_shapes *out)
{
    snprintf(out->name, sizeof out->name, "%.80s%s%.80s",
             chart_base(side->file->path), side->at ? ", " : "",
             side->at ? side->at->at : "");
}

static ritz_status columns_of(const ritz_basis *b, mac_shapes *out)
{
    int64_t count = b->T.ncol < MAC_MOST_MODES ? b->T.ncol : MAC_MOST_MODES;

    RITZ_CHECK(ritz_dense_columns(&b->T, 0, count, &out->U));
    out->hertz = calloc((size_t)count + 1, sizeof *out->hertz);
    RITZ_REFUSE_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < count; k++)
        out->hertz[k] = b->columns.hertz[k];
    out->count = count;
    return RITZ_OK;
}

ritz_status mac_shapes_of_dofs(const mac_side *side, mac_shapes *out)
{
    ritz_status status = RITZ_OK;
    const model *m = &side->file->model;
    modes found = {0};

    name_side(side, out);
    if (m->kind == MODEL_BASIS)
        return ritz_context(columns_of(&m->basis, out), side->file->path);
    RITZ_FAIL_IF(m->kind == MODEL_REDUCED && !m->reduced.dof, RITZ_ERR_ARGUMENT,
                 "it was made without its basis, it has no shapes");
    RITZ_TRY(modes_of(side, &found));
    out->count = found.Phi.ncol;
    out->hertz = found.hertz;
    found.hertz = NULL;
    if (m->kind == MODEL_REDUCED) {
        RITZ_TRY(ritz_dense_mul(&m->reduced.T, &found.Phi, &out->U));
        out->dof = m->reduced.dof;
    } else {
        out->U = found.Phi;
        found.Phi = (ritz_dense){0};
        out->dof = m->component.dof;
    }
done:
    free_modes(&found);
    return ritz_context(status, side->file->path);
}

/* Rows: inputs, then displacements, velocities and accelerations of outputs. */
static ritz_status stack(const ritz_io *io, mac_shapes *out)
{
    static const char *const kind[] = {"output", "velocity", "acceleration"};
    const ritz_dense *const C[] = {&io->C, &io->Cv, &io->Ca};
    int64_t n = io->num_inputs + 3 * io->num_outputs, row = 0;

    RITZ_CHECK(ritz_dense_new(n, out->count, &out->U));
    out->seen = calloc((size_t)n + 1, sizeof *out->seen);
    RITZ_REFUSE_IF(!out->seen, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t j = 0; j < io->num_inputs; j++, row++) {
        snprintf(out->seen[row], MAC_LABEL, "input %s", io->input[j]);
        for (int64_t k = 0; k < out->count; k++)
            ritz_dense_col(&out->U, k)[row] = ritz_dense_col(&io->B, j)[k];
    }
    for (int t = 0; t < 3; t++)
        for (int64_t i = 0; i < io->num_outputs; i++, row++) {
            snprintf(out->seen[row], MAC_LABEL, "%s %s", kind[t],
                     io->output[i]);
            for (int64_t k = 0; k < out->count; k++)
                ritz_dense_col(&out->U, k)[row] = ritz_dense_col(C[t], k)[i];
        }
    return RITZ_OK;
}

ritz_status mac_shapes_of_channels(const mac_side *side, mac_shapes *out)
{
    ritz_status status = RITZ_OK;
    const model *m = &side->file->model;
    const ritz_io *io = side->at                   ? &side->at->io
                        : m->kind == MODEL_REDUCED ? &m->reduced.io
                                                   : &m->component.io;
    ritz_io seen = {0};
    modes found = {0};

    name_side(side, out);
    RITZ_FAIL_IF(m->kind == MODEL_BASIS || io->num_inputs + io->num_outputs < 1,
                 RITZ_ERR_ARGUMENT,
                 "it has no inputs and outputs, by which its modes could be "
                 "compared with those of a system");
    RITZ_TRY(modes_of(side, &found));
    RITZ_TRY(ritz_io_project(io, &found.Phi, &seen));
    out->count = found.Phi.ncol;
    out->hertz = found.hertz;
    found.hertz = NULL;
    RITZ_TRY(stack(&seen, out));
done:
    ritz_io_free(&seen);
    free_modes(&found);
    return ritz_context(status, side->file->path);
}

void mac_shapes_free(mac_shapes *s)
{
    ritz_dense_free(&s->U);
    ritz_dense_free(&s->MU);
    free(s->hertz);
    free(s->seen);
    *s = (mac_shapes){0};
}
