/* The group `elements`: cells of a mesh, for pictures. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>

ritz_status ritz_part_write_elements(hid_t at, const ritz_elements *elements)
{
    ritz_status status = RITZ_OK;
    int64_t n = elements->count;
    hid_t group = 0;

    if (n == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(at, "elements", &group));
    RITZ_TRY(ritz_h5_write(group, "kind", H5T_STD_I64LE, ritz_h5_vector(n),
                           elements->kind));
    RITZ_TRY(ritz_h5_write(group, "first", H5T_STD_I64LE, ritz_h5_vector(n + 1),
                           elements->first));
    RITZ_TRY(ritz_h5_write(group, "grids", H5T_STD_I64LE,
                           ritz_h5_vector(elements->first[n]), elements->grid));
done:
    ritz_h5_close(group);
    return ritz_context(status, "elements");
}

/* Sizes of cells are checked before any grid is looked up by them. */
static ritz_status read_cells(hid_t group, ritz_elements *elements)
{
    int64_t n = 0, grids = 0, first = 0;

    RITZ_CHECK(ritz_h5_count(group, "kind", &n));
    RITZ_CHECK(ritz_h5_count(group, "first", &first));
    RITZ_CHECK(ritz_h5_count(group, "grids", &grids));
    RITZ_REFUSE_IF(n == 0 || first != n + 1, RITZ_ERR_FORMAT,
                   "'first' has %" PRId64 " values for %" PRId64 " elements",
                   first, n);
    RITZ_CHECK_NEW(elements->kind, n);
    RITZ_CHECK_NEW(elements->first, n + 1);
    RITZ_CHECK_NEW(elements->grid, grids);
    elements->count = n;
    RITZ_CHECK(
        ritz_part_read_whole(group, "kind", n, 1, INT64_MAX, elements->kind));
    RITZ_CHECK(
        ritz_part_read_whole(group, "first", n + 1, 0, grids, elements->first));
    RITZ_CHECK(ritz_part_read_whole(group, "grids", grids, INT64_MIN, INT64_MAX,
                                    elements->grid));
    for (int64_t k = 0; k < n; k++)
        RITZ_REFUSE_IF(elements->first[k + 1] < elements->first[k],
                       RITZ_ERR_FORMAT, "'first' does not ascend");
    RITZ_REFUSE_IF(elements->first[n] != grids, RITZ_ERR_FORMAT,
                   "'first' ends at %" PRId64 " of %" PRId64 " grids",
                   elements->first[n], grids);
    return RITZ_OK;
}

ritz_status ritz_part_read_elements(hid_t at, const ritz_grids *grids,
                                    ritz_elements *out)
{
    ritz_status status = RITZ_OK;
    ritz_elements elements = {0};
    hid_t group = 0;

    if (!ritz_h5_has(at, "elements"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(at, "elements", &group));
    RITZ_TRY(read_cells(group, &elements));
    RITZ_TRY(ritz_elements_check(&elements, grids->count, grids->id));
    *out = elements;
    elements = (ritz_elements){0};
done:
    ritz_h5_close(group);
    ritz_elements_free(&elements);
    return ritz_context(status, "elements");
}
