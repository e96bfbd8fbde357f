/* Members that say what rows and columns are: dofs, grids, places, columns. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LAST_COMPONENT = 6 };

ritz_status ritz_part_write_labels(hid_t at, int64_t count, const ritz_dof *dof)
{
    ritz_status status = RITZ_OK;
    int64_t *grid = NULL;
    int64_t *component = NULL;
    ritz_h5_shape shape = ritz_h5_vector(count);

    RITZ_NEW(grid, count);
    RITZ_NEW(component, count);
    for (int64_t i = 0; i < count; i++) {
        grid[i] = dof[i].grid;
        component[i] = dof[i].component;
    }
    RITZ_TRY(ritz_h5_write(at, "grid", H5T_STD_I64LE, shape, grid));
    RITZ_TRY(ritz_h5_write(at, "component", H5T_STD_I64LE, shape, component));
done:
    free(grid);
    free(component);
    return status;
}

ritz_status ritz_part_read_labels(hid_t at, int64_t *count, ritz_dof **out)
{
    ritz_status status = RITZ_OK;
    int64_t n = 0;
    int64_t *grid = NULL;
    int64_t *component = NULL;
    ritz_dof *dof = NULL;

    RITZ_TRY(ritz_h5_count(at, "grid", &n));
    RITZ_NEW(grid, n);
    RITZ_NEW(component, n);
    RITZ_NEW(dof, n);
    RITZ_TRY(ritz_part_read_whole(at, "grid", n, INT64_MIN, INT64_MAX, grid));
    RITZ_TRY(
        ritz_part_read_whole(at, "component", n, 0, LAST_COMPONENT, component));
    for (int64_t i = 0; i < n; i++)
        dof[i] = (ritz_dof){grid[i], component[i]};
    *count = n;
    *out = dof;
    dof = NULL;
done:
    free(grid);
    free(component);
    free(dof);
    return status;
}

ritz_status ritz_part_write_dofs(hid_t at, int64_t count, const ritz_dof *dof)
{
    ritz_status status = RITZ_OK;
    hid_t dofs = 0;

    RITZ_TRY(ritz_h5_group(at, "dofs", &dofs));
    RITZ_TRY(ritz_part_write_labels(dofs, count, dof));
done:
    ritz_h5_close(dofs);
    return ritz_context(status, "dofs");
}

ritz_status ritz_part_read_dofs(hid_t at, int64_t *count, ritz_dof **out)
{
    ritz_status status = RITZ_OK;
    hid_t dofs = 0;

    RITZ_TRY(ritz_h5_enter(at, "dofs", &dofs));
    RITZ_TRY_IN("dofs", ritz_part_read_labels(dofs, count, out));
done:
    ritz_h5_close(dofs);
    return status;
}

ritz_status ritz_part_write_grids(hid_t at, const ritz_grids *grids)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;
    int64_t g = grids->count;

    if (g == 0 && grids->num_frames == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(at, "grids", &group));
    RITZ_TRY(ritz_h5_write(group, "id", H5T_STD_I64LE, ritz_h5_vector(g),
                           grids->id));
    RITZ_TRY(ritz_h5_write(group, "position", H5T_IEEE_F64LE,
                           ritz_h5_table(g, 3), grids->position));
    RITZ_TRY(ritz_h5_write(group, "frame", H5T_STD_I64LE, ritz_h5_vector(g),
                           grids->frame));
    RITZ_TRY(ritz_h5_write(group, "frames", H5T_IEEE_F64LE,
                           ritz_h5_stack(grids->num_frames, 3, 3),
                           grids->axes));
done:
    ritz_h5_close(group);
    return ritz_context(status, "grids");
}

static ritz_status check_grids(const ritz_grids *grids)
{
    for (int64_t k = 1; k < grids->count; k++)
        RITZ_REFUSE_IF(grids->id[k - 1] >= grids->id[k], RITZ_ERR_FORMAT,
                       "'id' does not ascend at grid %" PRId64, grids->id[k]);
    for (int k = 0; k < 9; k++)
        RITZ_REFUSE_IF(fabs(grids->axes[k] - (k % 4 == 0 ? 1.0 : 0.0)) > 0.0,
                       RITZ_ERR_FORMAT, "frame 0 is not the basic frame");
    return RITZ_OK;
}

ritz_status ritz_part_read_grids(hid_t at, ritz_grids *out)
{
    ritz_status status = RITZ_OK;
    ritz_grids grids = {0};
    ritz_h5_shape frames = {0};
    hid_t group = 0;

    if (!ritz_h5_has(at, "grids"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(at, "grids", &group));
    RITZ_TRY(ritz_h5_count(group, "id", &grids.count));
    RITZ_TRY(ritz_h5_shape_of(group, "frames", 3, &frames));
    RITZ_FAIL_IF(frames.dims[0] < 1 || frames.dims[1] != 3 ||
                     frames.dims[2] != 3,
                 RITZ_ERR_FORMAT, "'frames' is not f x 3 x 3");
    grids.num_frames = (int64_t)frames.dims[0];
    RITZ_NEW(grids.id, grids.count);
    RITZ_NEW(grids.frame, grids.count);
    RITZ_NEW(grids.position, 3 * grids.count);
    RITZ_NEW(grids.axes, 9 * grids.num_frames);
    RITZ_TRY(ritz_part_read_whole(group, "id", grids.count, INT64_MIN,
                                  INT64_MAX, grids.id));
    RITZ_TRY(ritz_part_read_whole(group, "frame", grids.count, 0,
                                  grids.num_frames - 1, grids.frame));
    RITZ_TRY(ritz_h5_read_real(group, "position", ritz_h5_table(grids.count, 3),
                               false, grids.position));
    RITZ_TRY(ritz_h5_read_real(group, "frames", frames, false, grids.axes));
    RITZ_TRY(check_grids(&grids));
    *out = grids;
    grids = (ritz_grids){0};
done:
    ritz_grids_free(&grids);
    ritz_h5_close(group);
    return ritz_context(status, "grids");
}

ritz_status ritz_part_set_place(hid_t at, const double origin[static 3],
                                const double axes[static 9])
{
    RITZ_CHECK(ritz_part_set_real(at, "origin", 3, origin));
    return ritz_h5_set(at, "axes", H5T_IEEE_F64LE, ritz_h5_table(3, 3), axes);
}

ritz_status ritz_part_get_place(hid_t at, double origin[static 3],
                                double axes[static 9])
{
    RITZ_CHECK(ritz_part_get_real(at, "origin", false, 3, origin));
    return ritz_part_get_real(at, "axes", false, 9, axes);
}

ritz_status ritz_part_write_columns(hid_t at, const ritz_columns *columns)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape shape = ritz_h5_vector(columns->count);
    ritz_name *kind = NULL;
    hid_t group = 0;

    RITZ_NEW(kind, columns->count);
    for (int64_t j = 0; j < columns->count; j++)
        RITZ_TRY(ritz_name_copy(ritz_column_name(columns->kind[j]), kind[j]));
    RITZ_TRY(ritz_h5_group(at, "columns", &group));
    RITZ_TRY(ritz_part_write_words(group, "kind", columns->count, kind));
    RITZ_TRY(ritz_h5_write(group, "dof", H5T_STD_I64LE, shape, columns->dof));
    RITZ_TRY(
        ritz_h5_write(group, "hertz", H5T_IEEE_F64LE, shape, columns->hertz));
    RITZ_TRY(ritz_h5_write(at, "residuals", H5T_IEEE_F64LE, shape,
                           columns->residual));
done:
    free(kind);
    ritz_h5_close(group);
    return ritz_context(status, "columns");
}

static ritz_status read_kinds(hid_t group, ritz_columns *columns)
{
    ritz_status status = RITZ_OK;
    ritz_name *kind = NULL;

    RITZ_NEW(kind, columns->count);
    RITZ_TRY(ritz_part_read_words(group, "kind", columns->count, kind));
    for (int64_t j = 0; j < columns->count; j++)
        RITZ_FAIL_IF(
            !ritz_column_find(kind[j], &columns->kind[j]), RITZ_ERR_FORMAT,
            "column %" PRId64 " is of unknown kind '%s'", j + 1, kind[j]);
done:
    free(kind);
    return status;
}

ritz_status ritz_part_read_columns(hid_t at, int64_t n, int64_t r,
                                   ritz_columns *out)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape shape = ritz_h5_vector(r);
    ritz_columns columns = {0};
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(at, "columns", &group));
    RITZ_TRY(ritz_columns_new(r, &columns));
    RITZ_TRY(read_kinds(group, &columns));
    RITZ_TRY(ritz_part_read_whole(group, "dof", r, -1, n - 1, columns.dof));
    RITZ_TRY(ritz_h5_read_real(group, "hertz", shape, true, columns.hertz));
    RITZ_TRY(ritz_h5_read_real(at, "residuals", shape, true, columns.residual));
    *out = columns;
    columns = (ritz_columns){0};
done:
    ritz_columns_free(&columns);
    ritz_h5_close(group);
    return ritz_context(status, "columns");
}

static const ritz_text_member origin_members[] = {
    {"method", offsetof(ritz_origin, method)},
    {"options", offsetof(ritz_origin, options)},
    {"reference", offsetof(ritz_origin, reference)},
    {"engine", offsetof(ritz_origin, engine)},
    {NULL, 0},
};

ritz_status ritz_part_set_origin(hid_t at, const ritz_origin *origin)
{
    return ritz_part_set_members(at, origin_members, origin);
}

ritz_status ritz_part_get_origin(hid_t at, ritz_origin *out)
{
    return ritz_part_get_members(at, origin_members, out);
}
