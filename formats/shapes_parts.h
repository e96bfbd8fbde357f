/* Parts of shapes.c: which modes, and where their points are. Private. */
#ifndef RITZ_FORMATS_SHAPES_PARTS_H
#define RITZ_FORMATS_SHAPES_PARTS_H

#include <ritz/shapes.h>

/* Modes or columns from 0, as listed. */
typedef struct shapes_choice {
    int64_t count;
    int64_t *at;
} shapes_choice;

/** "1,7-9" of @p most that there are; NULL: all. */
ritz_status shapes_choose(const char *list, const char *what, int64_t most,
                          shapes_choice *out);

/** The largest number of a list, to know how many modes are wanted. */
ritz_status shapes_furthest(const char *list, int64_t *out);

/* Rows of a body and how they move. */
typedef struct shapes_motion {
    int64_t num_dofs;
    const ritz_dof *dof;
    const ritz_grids *grids;
    const ritz_elements *elements;
    const ritz_dense *T; /* num_dofs x shapes */
} shapes_motion;

/** All of the shapes but their names. */
ritz_status shapes_place(const shapes_motion *motion, ritz_shapes *out);

#endif
