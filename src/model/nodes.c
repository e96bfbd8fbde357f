#include "model/nodes.h"

#include "base/alloc.h"

#include <stdlib.h>

/* Rows of all grids, three each; grids without any are dropped afterwards. */
static void place_rows(int64_t n, const ritz_dof *dof, ritz_nodes *nodes)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < 3 * nodes->count; k++)
        nodes->row[k] = -1;
    for (int64_t i = 0; i < n; i++) {
        int64_t c = dof[i].component;
        int64_t k =
            c < 1 || c > 3 ? -1 : ritz_grids_find(nodes->grids, dof[i].grid);

        if (k >= 0)
            nodes->row[3 * k + c - 1] = i;
    }
    for (int64_t k = 0; k < nodes->count; k++) {
        const int64_t *row = nodes->row + 3 * k;

        if (row[0] < 0 && row[1] < 0 && row[2] < 0)
            continue;
        for (int p = 0; p < 3; p++)
            nodes->row[3 * kept + p] = row[p];
        nodes->grid[kept++] = k;
    }
    nodes->count = kept;
}

ritz_status ritz_nodes_of(int64_t n, const ritz_dof *dof,
                          const ritz_grids *grids, ritz_nodes *out)
{
    RITZ_OWN(ritz_nodes) nodes = {.grids = grids, .count = grids->count};

    RITZ_CHECK_NEW(nodes.grid, grids->count);
    RITZ_CHECK_NEW(nodes.row, 3 * grids->count);
    place_rows(n, dof, &nodes);
    RITZ_MOVE(*out, nodes);
    return RITZ_OK;
}

const double *ritz_nodes_axes(const ritz_nodes *nodes, int64_t node)
{
    return nodes->grids->axes + 9 * nodes->grids->frame[nodes->grid[node]];
}

ritz_status ritz_nodes_along(const ritz_nodes *nodes, const ritz_dense *T,
                             int b, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) along = {0};

    RITZ_CHECK(ritz_dense_new(nodes->count, T->ncol, &along));
    for (int64_t k = 0; k < T->ncol; k++) {
        const double *from = ritz_dense_col(T, k);
        double *to = ritz_dense_col(&along, k);

        for (int64_t i = 0; i < nodes->count; i++) {
            const double *axes = ritz_nodes_axes(nodes, i);

            for (int p = 0; p < 3; p++)
                if (nodes->row[3 * i + p] >= 0)
                    to[i] += axes[3 * p + b] * from[nodes->row[3 * i + p]];
        }
    }
    RITZ_MOVE(*out, along);
    return RITZ_OK;
}

void ritz_nodes_free(ritz_nodes *nodes)
{
    free(nodes->grid);
    free(nodes->row);
    *nodes = (ritz_nodes){0};
}
