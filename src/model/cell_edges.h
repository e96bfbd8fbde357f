/* Edges of cells, for pictures of lines. */
#ifndef RITZ_MODEL_CELL_EDGES_H
#define RITZ_MODEL_CELL_EDGES_H

#include <ritz/parts.h>

/*
 * The edges of a cell, as pairs of its corners. If a kind of cell has nodes on
 * its edges, they follow the corners in the order of the edges [Schroeder2006].
 */
typedef struct ritz_cell_edges {
    ritz_cell linear;
    int count;
    signed char end[12][2];
} ritz_cell_edges;

/** The edges of a kind of cell, linear or quadratic; none of other kinds. */
const ritz_cell_edges *ritz_cell_edges_of(int64_t kind);

#endif
