/* Points of shapes, how they move along basic axes, and cells between them. */
#include "formats/shapes_parts.h"

#include "base/alloc.h"
#include "base/search.h"

#include <stdlib.h>
#include <string.h>

/* Grids with a dof, in ascending order; index[k]: point of grid k, or -1. */
static ritz_status list_points(const shapes_motion *m, int64_t *index,
                               ritz_shapes *out)
{
    const ritz_grids *grids = m->grids;

    for (int64_t k = 0; k < grids->count; k++)
        index[k] = -1;
    for (int64_t i = 0; i < m->num_dofs; i++) {
        int64_t k = m->dof[i].component > 0
                        ? ritz_grids_find(grids, m->dof[i].grid)
                        : -1;

        if (k >= 0)
            index[k] = 0;
        else if (i == 0 || m->dof[i].grid != m->dof[i - 1].grid)
            out->num_placeless++;
    }
    for (int64_t k = 0; k < grids->count; k++)
        if (index[k] == 0)
            index[k] = out->num_points++;
    RITZ_REFUSE_IF(out->num_points == 0, RITZ_ERR_ARGUMENT,
                   "no grid has a position: import with --bulk");
    RITZ_CHECK_NEW(out->id, out->num_points);
    RITZ_CHECK_NEW(out->position, 3 * out->num_points);
    for (int64_t k = 0; k < grids->count; k++) {
        if (index[k] < 0)
            continue;
        out->id[index[k]] = grids->id[k];
        memcpy(out->position + 3 * index[k], grids->position + 3 * k,
               3 * sizeof *out->position);
    }
    return RITZ_OK;
}

/* Displacement axis i of a grid brings axes[3 i + j] along basic axis j. */
static void place_motion(const shapes_motion *m, const int64_t *index,
                         ritz_shapes *out)
{
    const ritz_grids *grids = m->grids;

    for (int64_t i = 0; i < m->num_dofs; i++) {
        int64_t c = m->dof[i].component;
        int64_t k = c > 0 ? ritz_grids_find(grids, m->dof[i].grid) : -1;
        const double *axis = NULL;
        ritz_dense *to = c > 3 ? &out->turn : &out->u;

        if (k < 0)
            continue;
        axis = grids->axes + 9 * grids->frame[k] + 3 * ((c - 1) % 3);
        for (int64_t j = 0; j < m->T->ncol; j++)
            for (int b = 0; b < 3; b++)
                ritz_dense_col(to, j)[3 * index[k] + b] +=
                    axis[b] * ritz_dense_col(m->T, j)[i];
    }
}

static bool rotates(const shapes_motion *m)
{
    for (int64_t i = 0; i < m->num_dofs; i++)
        if (m->dof[i].component > 3)
            return true;
    return false;
}

/* Elements by points; a cell for each point if there are none. */
static ritz_status list_cells(const shapes_motion *m, ritz_shapes *out)
{
    ritz_status status = RITZ_OK;
    ritz_elements cells = {0};

    RITZ_TRY(ritz_elements_copy(m->elements, &cells));
    (void)ritz_elements_keep(&cells, out->num_points, out->id);
    for (int64_t i = 0; cells.count > 0 && i < cells.first[cells.count]; i++)
        cells.grid[i] = ritz_search(out->num_points, out->id, cells.grid[i]);
    out->meshed = cells.count > 0;
    if (!out->meshed) {
        cells.count = out->num_points;
        RITZ_NEW(cells.kind, cells.count);
        RITZ_NEW(cells.first, cells.count + 1);
        RITZ_NEW(cells.grid, cells.count);
        for (int64_t k = 0; k < cells.count; k++) {
            cells.kind[k] = RITZ_CELL_POINT;
            cells.grid[k] = k;
            cells.first[k + 1] = k + 1;
        }
    }
    out->cells = cells;
    cells = (ritz_elements){0};
done:
    ritz_elements_free(&cells);
    return status;
}

ritz_status shapes_place(const shapes_motion *m, ritz_shapes *out)
{
    ritz_status status = RITZ_OK;
    int64_t *index = NULL;

    RITZ_NEW(index, m->grids->count);
    RITZ_TRY(list_points(m, index, out));
    RITZ_TRY(ritz_dense_new(3 * out->num_points, m->T->ncol, &out->u));
    if (rotates(m))
        RITZ_TRY(ritz_dense_new(3 * out->num_points, m->T->ncol, &out->turn));
    place_motion(m, index, out);
    RITZ_TRY(list_cells(m, out));
done:
    free(index);
    return status;
}
