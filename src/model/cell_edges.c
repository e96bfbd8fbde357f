#include "model/cell_edges.h"

#include <stddef.h>

static const ritz_cell_edges edges_of[] = {
    {RITZ_CELL_LINE, 1, {{0, 1}}},
    {RITZ_CELL_TRIANGLE, 3, {{0, 1}, {1, 2}, {2, 0}}},
    {RITZ_CELL_QUAD, 4, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
    {RITZ_CELL_TETRA, 6, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
    {RITZ_CELL_HEXA,
     12,
     {{0, 1},
      {1, 2},
      {2, 3},
      {3, 0},
      {4, 5},
      {5, 6},
      {6, 7},
      {7, 4},
      {0, 4},
      {1, 5},
      {2, 6},
      {3, 7}}},
    {RITZ_CELL_WEDGE,
     9,
     {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
};

const ritz_cell_edges *ritz_cell_edges_of(int64_t kind)
{
    static const ritz_cell_edges none = {0};
    const ritz_cell linear = ritz_cell_shape_of(kind)->linear;

    for (size_t k = 0; k < sizeof edges_of / sizeof *edges_of; k++)
        if (edges_of[k].linear == linear)
            return &edges_of[k];
    return &none;
}
