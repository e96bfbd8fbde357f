/*
 * Shapes: how the grids of a body move, mode by mode, for pictures. Points,
 * translations and rotations are along the axes of the basic frame.
 */
#ifndef RITZ_SHAPES_H
#define RITZ_SHAPES_H

#include <ritz/component.h>
#include <ritz/elements.h>
#include <ritz/reduced.h>

#pragma GCC visibility push(default)

typedef struct ritz_shapes {
    int64_t num_points;  /* grids with a position and a dof */
    int64_t *id;         /* num_points, ascending */
    double *position;    /* num_points x 3 */
    ritz_elements cells; /* whose `grid` are indices of points; single points
                             if there is no element */
    bool meshed;         /* there were elements */
    int64_t count;       /* of shapes */
    char (*name)[RITZ_NAME_SIZE]; /* "mode 7, 0.1988 Hz" */
    ritz_dense u;          /* 3 num_points x count; an absent direction is 0 */
    ritz_dense turn;       /* the same of rotations; {0}: no grid has any */
    int64_t num_placeless; /* scalar points, and grids without a position */
} ritz_shapes;

/**
 * Modes of a reduced component as it stands, its dampers' springs installed,
 * u = T phi, with dofs that constraints eliminated.
 *
 * @param[in] list  "1-6,9" of its modes, rigid ones first; NULL: all
 * @return RITZ_ERR_ARGUMENT if it was made --without-basis, has no such mode or
 *         nothing that has a place
 */
ritz_status ritz_shapes_of_reduced(const ritz_reduced *reduced,
                                   const char *list, ritz_shapes *out);

/** Lowest modes of a component. @param[in] list  NULL: the first ten */
ritz_status ritz_shapes_of_component(const ritz_component *component,
                                     const char *list, ritz_shapes *out);

/** Columns of a basis of displacements, on the component that it is of. */
ritz_status ritz_shapes_of_basis(const ritz_basis *basis,
                                 const ritz_component *component,
                                 const char *list, ritz_shapes *out);

void ritz_shapes_free(ritz_shapes *shapes);

#pragma GCC visibility pop

#endif
