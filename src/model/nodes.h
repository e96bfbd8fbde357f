/* The grids of a body as points: where the translations of each one are. */
#ifndef RITZ_MODEL_NODES_H
#define RITZ_MODEL_NODES_H

#include <ritz/model.h>

typedef struct ritz_nodes {
    const ritz_grids *grids; /* borrowed */
    int64_t count;           /* of grids with at least one translation */
    int64_t *grid;           /* count, index in grids, ascending */
    int64_t *row;            /* count x 3, of each translation; -1: absent */
} ritz_nodes;

/**
 * The nodes among @p n rows that @p dof names; rows of scalar points and of
 * grids that are not in @p grids are passed over.
 */
ritz_status ritz_nodes_of(int64_t n, const ritz_dof *dof,
                          const ritz_grids *grids, ritz_nodes *out);

/** Displacement axes of a node, row by row. */
const double *ritz_nodes_axes(const ritz_nodes *nodes, int64_t node);

/** Whether axes, row by row, are the basic ones. */
static inline bool ritz_axes_basic(const double *axes)
{
    for (int k = 0; k < 9; k++)
        if (axes[k] != (k % 4 == 0 ? 1.0 : 0.0))
            return false;
    return true;
}

/**
 * Translations of the nodes along basic axis @p b for each column of @p T; an
 * absent translation is zero.
 *
 * @param[out] out  count x r
 */
ritz_status ritz_nodes_along(const ritz_nodes *nodes, const ritz_dense *T,
                             int b, ritz_dense *out);

void ritz_nodes_free(ritz_nodes *nodes);

#endif
