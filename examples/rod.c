#include "rod.h"

#include <stdio.h>
#include <stdlib.h>

/* k = EA / l [1 -1; -1 1] or m = rho A l / 6 [2 1; 1 2] of every element. */
static ritz_status assemble_rod(int64_t n, double on, double off,
                                ritz_sparse *out)
{
    int64_t *row = calloc((size_t)(4 * n), sizeof *row);
    int64_t *col = calloc((size_t)(4 * n), sizeof *col);
    double *val = calloc((size_t)(4 * n), sizeof *val);
    ritz_status status = RITZ_ERR_MEMORY;

    for (int64_t k = 0; row && col && val && k < 4 * n; k++) {
        row[k] = k / 4 + (k & 1);
        col[k] = k / 4 + ((k >> 1) & 1);
        val[k] = row[k] == col[k] ? on : off;
    }
    if (row && col && val)
        status =
            ritz_sparse_from_triplets(n + 1, n + 1, 4 * n, row, col, val, out);
    free(row);
    free(col);
    free(val);
    return status;
}

static ritz_status place_grids(int64_t n, ritz_component *rod)
{
    ritz_grids *grids = &rod->grids;

    rod->num_dofs = n + 1;
    rod->dof = calloc((size_t)(n + 1), sizeof *rod->dof);
    grids->id = calloc((size_t)(n + 1), sizeof *grids->id);
    grids->position = calloc((size_t)(3 * (n + 1)), sizeof *grids->position);
    grids->frame = calloc((size_t)(n + 1), sizeof *grids->frame);
    grids->axes = calloc(9, sizeof *grids->axes);
    if (!rod->dof || !grids->id || !grids->position || !grids->frame ||
        !grids->axes)
        return RITZ_ERR_MEMORY;
    grids->count = n + 1;
    grids->num_frames = 1;
    grids->axes[0] = grids->axes[4] = grids->axes[8] = 1.0;
    for (int64_t k = 0; k <= n; k++) {
        grids->id[k] = k + 1;
        grids->position[3 * k] = (double)k;
        rod->dof[k] = (ritz_dof){.grid = k + 1, .component = 1};
    }
    return RITZ_OK;
}

static ritz_status add_end(const char *name, int64_t dof, ritz_port *port)
{
    *port = (ritz_port){.origin = {(double)dof, 0.0, 0.0},
                        .axes = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    snprintf(port->name, sizeof port->name, "%s", name);
    port->dofs.at = calloc(1, sizeof *port->dofs.at);
    if (!port->dofs.at)
        return RITZ_ERR_MEMORY;
    port->dofs.count = 1;
    port->dofs.at[0] = dof;
    return RITZ_OK;
}

ritz_status rod_component(int64_t n, ritz_component *out)
{
    ritz_component rod = {0};
    ritz_status status = place_grids(n, &rod);

    rod.port = calloc(2, sizeof *rod.port);
    rod.num_ports = rod.port ? 2 : 0;
    if (!rod.port)
        status = RITZ_ERR_MEMORY;
    if (status == RITZ_OK)
        status = assemble_rod(n, 1.0, -1.0, &rod.K);
    if (status == RITZ_OK)
        status = assemble_rod(n, 2.0 / 6.0, 1.0 / 6.0, &rod.M);
    if (status == RITZ_OK)
        status = add_end("left", 0, &rod.port[0]);
    if (status == RITZ_OK)
        status = add_end("right", n, &rod.port[1]);
    if (status == RITZ_OK)
        status = ritz_io_new(n + 1, 1, 1, &rod.io);
    if (status == RITZ_OK) {
        snprintf(rod.io.input[0], sizeof rod.io.input[0], "force");
        snprintf(rod.io.output[0], sizeof rod.io.output[0], "tip");
        rod.io.B.val[n] = 1.0;
        rod.io.C.val[n] = 1.0;
        status = ritz_component_settle(&rod, false);
    }
    if (status == RITZ_OK)
        *out = rod;
    else
        ritz_component_free(&rod);
    return status;
}
