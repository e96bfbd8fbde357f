/* Edges of cells, for pictures of lines. */
#ifndef RITZ_MODEL_CELL_EDGES_H
#define RITZ_MODEL_CELL_EDGES_H

#include <ritz/parts.h>

/*
 * Corners at the ends of the edges of a cell. The node between the ends of edge
 * k, if cells of the kind have one, is the k-th behind the corners
 * [Schroeder2006].
 */
typedef struct ritz_cell_edges {
    ritz_cell linear;
    int count;
    signed char end[12][2];
} ritz_cell_edges;

/** The edges of a kind of cell, linear or not; none if there is no such kind. */
const ritz_cell_edges *ritz_cell_edges_of(int64_t kind);

#endif
