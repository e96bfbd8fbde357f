/*
 * Which grids belong together, for pictures: cells of a mesh and no mechanics.
 *
 * Kinds and the order of grids in a cell are those of VTK, which most viewers
 * share.
 */
#ifndef RITZ_ELEMENTS_H
#define RITZ_ELEMENTS_H

#include <ritz/status.h>

#include <stdint.h>

#pragma GCC visibility push(default)

typedef enum ritz_cell {
    RITZ_CELL_POINT = 1, /* of pictures alone: where there is no element */
    RITZ_CELL_LINE = 3,
    RITZ_CELL_TRIANGLE = 5,
    RITZ_CELL_QUAD = 9,
    RITZ_CELL_TETRA = 10,
    RITZ_CELL_HEXA = 12,
    RITZ_CELL_WEDGE = 13,
    RITZ_CELL_TRIANGLE6 = 22, /* from here on with nodes between corners */
    RITZ_CELL_QUAD8 = 23,
    RITZ_CELL_TETRA10 = 24,
    RITZ_CELL_HEXA20 = 25,
    RITZ_CELL_WEDGE15 = 26,
} ritz_cell;

/* Cell k has grids grid[first[k]] to grid[first[k + 1] - 1]. */
typedef struct ritz_elements {
    int64_t count;
    int64_t *kind;  /* count, of ritz_cell */
    int64_t *first; /* count + 1; NULL if count is 0 */
    int64_t *grid;  /* first[count], ids */
} ritz_elements;

/** Grids of a kind of cell, and those at its corners; 0 if it is none. */
int64_t ritz_cell_size(int64_t kind);
int64_t ritz_cell_corners(int64_t kind);

/** The kind that has its corners alone: QUAD of QUAD8. */
int64_t ritz_cell_linear(int64_t kind);

ritz_status ritz_elements_copy(const ritz_elements *elements,
                               ritz_elements *out);

/**
 * Leave out cells with a grid that is not among some.
 *
 * @param[in] count,id  ids that there are, ascending
 * @return how many were left out
 */
int64_t ritz_elements_keep(ritz_elements *elements, int64_t count,
                           const int64_t *id);

/**
 * Whether kinds are known and sizes fit them, and all grids are there.
 *
 * @return RITZ_ERR_FORMAT with what is wrong
 */
ritz_status ritz_elements_check(const ritz_elements *elements, int64_t count,
                                const int64_t *id);

void ritz_elements_free(ritz_elements *elements);

#pragma GCC visibility pop

#endif
