/* Cells of a mesh. */
#include <ritz/model.h>

#include "base/alloc.h"
#include "base/search.h"

#include <inttypes.h>
#include <stdbool.h>
#include <string.h>

static const ritz_cell_shape shapes[] = {
    {RITZ_CELL_POINT, RITZ_CELL_POINT, 1, 1},
    {RITZ_CELL_LINE, RITZ_CELL_LINE, 2, 2},
    {RITZ_CELL_TRIANGLE, RITZ_CELL_TRIANGLE, 3, 3},
    {RITZ_CELL_QUAD, RITZ_CELL_QUAD, 4, 4},
    {RITZ_CELL_TETRA, RITZ_CELL_TETRA, 4, 4},
    {RITZ_CELL_HEXA, RITZ_CELL_HEXA, 8, 8},
    {RITZ_CELL_WEDGE, RITZ_CELL_WEDGE, 6, 6},
    {RITZ_CELL_TRIANGLE6, RITZ_CELL_TRIANGLE, 6, 3},
    {RITZ_CELL_QUAD8, RITZ_CELL_QUAD, 8, 4},
    {RITZ_CELL_TETRA10, RITZ_CELL_TETRA, 10, 4},
    {RITZ_CELL_HEXA20, RITZ_CELL_HEXA, 20, 8},
    {RITZ_CELL_WEDGE15, RITZ_CELL_WEDGE, 15, 6},
};

const ritz_cell_shape *ritz_cell_shape_of(int64_t kind)
{
    static const ritz_cell_shape none = {0};

    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
        if ((int64_t)shapes[k].kind == kind)
            return &shapes[k];
    return &none;
}

ritz_status ritz_elements_copy(const ritz_elements *elements,
                               ritz_elements *out)
{
    int64_t n = elements->count;
    RITZ_OWN(ritz_elements) copy = {.count = n};

    if (n == 0)
        return RITZ_OK;
    RITZ_CHECK_COPY(copy.kind, elements->kind, n);
    RITZ_CHECK_COPY(copy.first, elements->first, n + 1);
    RITZ_CHECK_COPY(copy.grid, elements->grid, elements->first[n]);
    if (elements->id)
        RITZ_CHECK_COPY(copy.id, elements->id, n);
    RITZ_MOVE(*out, copy);
    return RITZ_OK;
}

static bool all_there(const ritz_elements *elements, int64_t k, int64_t count,
                      const int64_t *id)
{
    for (int64_t i = elements->first[k]; i < elements->first[k + 1]; i++)
        if (ritz_search(count, id, elements->grid[i]) < 0)
            return false;
    return true;
}

int64_t ritz_elements_keep(ritz_elements *elements, int64_t count,
                           const int64_t *id)
{
    int64_t kept = 0, end = 0, all = elements->count;

    for (int64_t k = 0; k < all; k++) {
        int64_t from = elements->first[k];
        int64_t size = elements->first[k + 1] - from;

        if (!all_there(elements, k, count, id))
            continue;
        /* the kept cells end where this one begins, or before */
        memmove(elements->grid + end, elements->grid + from,
                (size_t)size * sizeof *elements->grid);
        elements->kind[kept] = elements->kind[k];
        if (elements->id)
            elements->id[kept] = elements->id[k];
        elements->first[kept++] = end;
        end += size;
    }
    if (all > 0)
        elements->first[kept] = end;
    elements->count = kept;
    if (kept == 0)
        ritz_elements_free(elements);
    return all - kept;
}

ritz_status ritz_elements_check(const ritz_elements *elements, int64_t count,
                                const int64_t *id)
{
    if (elements->count == 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(elements->first[0] != 0, RITZ_ERR_FORMAT,
                   "elements do not begin at their first grid");
    for (int64_t k = 0; k < elements->count; k++) {
        int64_t size = elements->first[k + 1] - elements->first[k];
        int64_t due = ritz_cell_shape_of(elements->kind[k])->size;

        RITZ_REFUSE_IF(due == 0, RITZ_ERR_FORMAT,
                       "element %" PRId64 " is of kind %" PRId64
                       ", which is not known",
                       k + 1, elements->kind[k]);
        RITZ_REFUSE_IF(size != due, RITZ_ERR_FORMAT,
                       "element %" PRId64 " has %" PRId64
                       " grids, its kind has %" PRId64,
                       k + 1, size, due);
        RITZ_REFUSE_IF(!all_there(elements, k, count, id), RITZ_ERR_FORMAT,
                       "element %" PRId64 " has a grid without a position",
                       k + 1);
    }
    return RITZ_OK;
}

void ritz_elements_free(ritz_elements *elements)
{
    RITZ_FREE(elements->kind, elements->first, elements->grid, elements->id);
    *elements = (ritz_elements){0};
}
