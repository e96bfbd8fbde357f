/*
 * Scenes of plane models: bodies lie in a plane and move in it by two
 * translations and a rotation about its normal n. Joints have no relations for
 * motion out of the plane, so each dof must be one of those three motions, and
 * all grids must have the same coordinate along n.
 */
#include "assembly/assembly.h"

#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>

/* "xy"; "" without a plane. */
static const char *name_plane(ritz_plane plane)
{
    static const char *const names[] = {[RITZ_PLANE_NONE] = "",
                                        [RITZ_PLANE_YZ] = "yz",
                                        [RITZ_PLANE_XZ] = "xz",
                                        [RITZ_PLANE_XY] = "xy"};

    return names[plane];
}

bool ritz_plane_has(ritz_plane plane, int64_t component)
{
    const bool turns = component > 3;
    const int64_t axis = turns ? component - 3 : component;

    return plane == RITZ_PLANE_NONE || turns == (axis == (int64_t)plane);
}

/* How far a dof's unit axis departs from the plane: for a translation its
   component along the normal, for a rotation its largest component in the
   plane. */
static double stray_of(ritz_plane plane, const double *axis, bool turns)
{
    const double across = fabs(axis[plane - 1]);
    double along = 0.0;

    for (int i = 0; i < 3; i++)
        if (i != (int)plane - 1)
            along = fmax(along, fabs(axis[i]));
    return turns ? along : across;
}

static ritz_status check_dof(ritz_plane plane, ritz_dof dof, const double *axes)
{
    char name[RITZ_DOF_NAME_SIZE];
    const double *axis = axes + 3 * ((dof.component - 1) % 3);

    RITZ_REFUSE_IF(
        stray_of(plane, axis, dof.component > 3) > RITZ_PARALLEL_AXES,
        RITZ_ERR_ARGUMENT,
        "%s moves out of the plane %s, in which all models of the scene lie",
        ritz_dof_name(dof, name), name_plane(plane));
    return RITZ_OK;
}

/* Extent of a set of points, along the normal and in the plane. */
typedef struct extent {
    int64_t low, high; /* grids of the least and the largest coordinate along
                          the normal; -1: none */
    double least[3], most[3];
} extent;

static void add_point(ritz_plane plane, int64_t grid, const double *x,
                      extent *all)
{
    const int n = (int)plane - 1;
    const bool first = all->low < 0;

    if (first || x[n] < all->least[n])
        all->low = grid;
    if (first || x[n] > all->most[n])
        all->high = grid;
    for (int i = 0; i < 3; i++) {
        all->least[i] = first ? x[i] : fmin(all->least[i], x[i]);
        all->most[i] = first ? x[i] : fmax(all->most[i], x[i]);
    }
}

static ritz_status check_extent(ritz_plane plane, const extent *all)
{
    const int n = (int)plane - 1;
    const double across = all->most[n] - all->least[n];
    double size = 0.0;

    for (int i = 0; i < 3; i++)
        size = fmax(size, all->most[i] - all->least[i]);
    RITZ_REFUSE_IF(across > RITZ_PORT_MATCH * size, RITZ_ERR_ARGUMENT,
                   "grids %" PRId64 " and %" PRId64
                   " lie %.3g apart across the plane %s",
                   all->low, all->high, across, name_plane(plane));
    return RITZ_OK;
}

ritz_status ritz_plane_check_dofs(ritz_plane plane, int64_t count,
                                  const ritz_dof *dof, const ritz_grids *grids)
{
    static const double basic[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    extent all = {.low = -1};

    if (plane == RITZ_PLANE_NONE)
        return RITZ_OK;
    for (int64_t i = 0; i < count; i++) {
        const int64_t k =
            dof[i].component > 0 ? ritz_grids_find(grids, dof[i].grid) : -1;

        if (dof[i].component > 0)
            RITZ_CHECK(
                check_dof(plane, dof[i],
                          k < 0 ? basic : grids->axes + 9 * grids->frame[k]));
        if (k >= 0)
            add_point(plane, dof[i].grid, grids->position + 3 * k, &all);
    }
    return check_extent(plane, &all);
}

ritz_status ritz_plane_check_port(ritz_plane plane, const ritz_port_map *port)
{
    static const double basic[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    extent all = {.low = -1};

    if (plane == RITZ_PLANE_NONE)
        return RITZ_OK;
    for (int64_t i = 0; i < port->count; i++)
        if (port->dof[i].component > 0) {
            RITZ_CHECK_IN(port->name, check_dof(plane, port->dof[i], basic));
            add_point(plane, port->dof[i].grid, port->position + 3 * i, &all);
        }
    return ritz_context(check_extent(plane, &all), port->name);
}
