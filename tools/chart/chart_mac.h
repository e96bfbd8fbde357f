/* How like mode shapes are: what the files of this chart share. */
#ifndef RITZ_TOOLS_CHART_CHART_MAC_H
#define RITZ_TOOLS_CHART_CHART_MAC_H

#include "chart/chart.h"

/* More modes would not be told apart. */
enum { MAC_MOST_MODES = 60, MAC_LABEL = RITZ_NAME_SIZE + 16 };

/* Shapes of flexible modes, or columns of a basis, and what their rows are. */
typedef struct mac_shapes {
    ritz_dense U;  /* n x count */
    ritz_dense MU; /* the same times the mass of bodies; {0}: U itself */
    double *hertz; /* count; NaN: none */
    int64_t count;
    const ritz_dof *dof;     /* n, borrowed; NULL: rows are not dofs */
    int64_t num_seen;        /* of them in common with others, once matched */
    char (*seen)[MAC_LABEL]; /* n, inputs and outputs; NULL: rows are none */
    char name[2 * PICTURE_WORD]; /* "system.h5, clock=60" */
} mac_shapes;

/* What has modes: a container and, of a system, one configuration of it. */
typedef struct mac_side {
    const chart_file *file;
    const ritz_configuration *at; /* NULL: it is no system */
} mac_side;

/** Shapes at the dofs of a component, a reduced component or a basis. */
ritz_status mac_shapes_of_dofs(const mac_side *side, mac_shapes *out);

/**
 * What inputs drive and outputs see of each mode of anything but a basis.
 *
 * @return RITZ_ERR_ARGUMENT if it has neither
 */
ritz_status mac_shapes_of_channels(const mac_side *side, mac_shapes *out);

/**
 * Coordinates of all bodies of a configuration, and their masses times them.
 *
 * @param[in] body  reduced components, in any order that fits
 * @return RITZ_ERR_ARGUMENT if they are not those it was assembled from
 */
ritz_status mac_shapes_of_bodies(const mac_side *side, int64_t count,
                                 const chart_file *const *body,
                                 mac_shapes *out);

/**
 * Row of each row of a in b, -1 where it is not. Inputs and outputs are divided
 * by the largest that a mode of either has of each: their units do not matter.
 *
 * @param[out] out  to be freed
 * @return RITZ_ERR_ARGUMENT if too little is in common
 */
ritz_status mac_match(mac_shapes *a, mac_shapes *b, int64_t **out);

/** (u_i'M v_j)^2 / (u_i'M u_i v_j'M v_j); NaN: one of them is nothing. */
double mac_of(const mac_shapes *a, const mac_shapes *b, const int64_t *row,
              int64_t i, int64_t j);

void mac_shapes_free(mac_shapes *shapes);

#endif
