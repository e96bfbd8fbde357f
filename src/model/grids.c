/* Where grids are, along which axes they move, and rigid-body geometry. */
#include "base/alloc.h"
#include "base/search.h"
#include "base/team.h"
#include "model/equations.h"

#include <ritz/model.h>

#include <inttypes.h>

int64_t ritz_grids_find(const ritz_grids *grids, int64_t id)
{
    return ritz_search(grids->count, grids->id, id);
}

/* Displacement axes of a grid, row by row; the basic ones if it has none. */
static const double *axes_of(const ritz_grids *grids, int64_t id)
{
    static const double basic[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    int64_t k = ritz_grids_find(grids, id);

    return k < 0 ? basic : grids->axes + 9 * grids->frame[k];
}

/* One grid of a port, and where in the port's dofs its six directions are. */
typedef struct member {
    int64_t grid;
    int64_t place[6]; /* -1 where it is absent */
    int64_t point;    /* of a scalar point, -1 otherwise */
} member;

/* The port's grids in order of first appearance. */
static int64_t list_port_grids(const ritz_component *component,
                               const ritz_port *port, member *list)
{
    int64_t count = 0;

    for (int64_t i = 0; i < port->dofs.count; i++) {
        ritz_dof dof = component->dof[port->dofs.at[i]];
        int64_t k = 0;

        while (k < count && list[k].grid != dof.grid)
            k++;
        if (k == count)
            list[count++] = (member){dof.grid, {-1, -1, -1, -1, -1, -1}, -1};
        if (dof.component == 0)
            list[k].point = i;
        else
            list[k].place[dof.component - 1] = i;
    }
    return count;
}

/*
 * Three translations or rotations of a grid along basic axes. With the
 * displacement axes as rows of A, u_basic = A' u.
 */
static ritz_status turn_triple(const member *grid, int first,
                               const double *axes, ritz_dense *turn,
                               int64_t *row, ritz_dof *label)
{
    const int64_t *place = grid->place + first;
    bool plain = ritz_axes_basic(axes);
    bool all = place[0] >= 0 && place[1] >= 0 && place[2] >= 0;
    bool none = place[0] < 0 && place[1] < 0 && place[2] < 0;

    RITZ_REFUSE_IF(!plain && !all && !none, RITZ_ERR_ARGUMENT,
                   "grid %" PRId64 " has axes of its own and brings only some "
                   "of its %s",
                   grid->grid, first == 0 ? "translations" : "rotations");
    for (int i = 0; i < 3; i++) {
        if (place[i] < 0)
            continue;
        for (int j = 0; j < 3; j++)
            if (place[j] >= 0)
                ritz_dense_col(turn, place[j])[*row] = axes[3 * j + i];
        label[*row] = (ritz_dof){grid->grid, first + i + 1};
        (*row)++;
    }
    return RITZ_OK;
}

ritz_status ritz_port_turn(const ritz_component *component,
                           const ritz_port *port, ritz_dense *turn,
                           ritz_dof **label)
{
    int64_t p = port->dofs.count;
    int64_t row = 0;
    int64_t count = 0;
    RITZ_OWN_ARRAY member *list = NULL;
    RITZ_OWN(ritz_dense) U = {0};
    RITZ_OWN_ARRAY ritz_dof *names = NULL;

    RITZ_CHECK_NEW(list, p);
    RITZ_CHECK_NEW(names, p);
    RITZ_CHECK(ritz_dense_new(p, p, &U));
    count = list_port_grids(component, port, list);
    for (int64_t k = 0; k < count; k++) {
        const double *axes = axes_of(&component->grids, list[k].grid);

        if (list[k].point >= 0) {
            ritz_dense_col(&U, list[k].point)[row] = 1.0;
            names[row++] = (ritz_dof){list[k].grid, 0};
        }
        RITZ_CHECK_IN(port->name,
                      turn_triple(&list[k], 0, axes, &U, &row, names));
        RITZ_CHECK_IN(port->name,
                      turn_triple(&list[k], 3, axes, &U, &row, names));
    }
    RITZ_MOVE(*turn, U);
    if (label) {
        RITZ_MOVE(*label, names);
    }
    return RITZ_OK;
}

ritz_status ritz_rigid_geometry(const ritz_component *component,
                                const double origin[static 3], ritz_dense *out)
{
    const ritz_grids *grids = &component->grids;
    ritz_dense R = {0};

    RITZ_CHECK(ritz_dense_new(component->num_dofs, 6, &R));
    for (int64_t row = 0; row < component->num_dofs; row++) {
        ritz_dof dof = component->dof[row];
        int64_t k = dof.component == 0 ? -1 : ritz_grids_find(grids, dof.grid);
        double motion[6];

        if (k < 0)
            continue;
        ritz_tie_row(grids, k, dof.component, origin, motion);
        for (int j = 0; j < 6; j++)
            ritz_dense_col(&R, j)[row] = motion[j];
    }
    *out = R;
    return RITZ_OK;
}

void ritz_grids_free(ritz_grids *grids)
{
    RITZ_FREE(grids->id, grids->position, grids->frame, grids->axes);
    *grids = (ritz_grids){0};
}

/* Rows of all grids, three each; grids without any are dropped afterwards. */
ritz_status ritz_nodes_of(int64_t n, const ritz_dof *dof,
                          const ritz_grids *grids, ritz_nodes *out)
{
    RITZ_OWN(ritz_nodes) nodes = {.grids = grids};

    RITZ_CHECK_NEW(nodes.grid, grids->count);
    RITZ_CHECK_NEW(nodes.row, 3 * grids->count);
    for (int64_t k = 0; k < 3 * grids->count; k++)
        nodes.row[k] = -1;
    for (int64_t i = 0; i < n; i++) {
        int64_t c = dof[i].component;
        int64_t k = c < 1 || c > 3 ? -1 : ritz_grids_find(grids, dof[i].grid);

        if (k >= 0)
            nodes.row[3 * k + c - 1] = i;
    }
    for (int64_t k = 0; k < grids->count; k++) {
        const int64_t *row = nodes.row + 3 * k;

        if (row[0] < 0 && row[1] < 0 && row[2] < 0)
            continue;
        for (int p = 0; p < 3; p++)
            nodes.row[3 * nodes.count + p] = row[p];
        nodes.grid[nodes.count++] = k;
    }
    RITZ_MOVE(*out, nodes);
    return RITZ_OK;
}

const double *ritz_nodes_axes(const ritz_nodes *nodes, int64_t node)
{
    return nodes->grids->axes + 9 * nodes->grids->frame[nodes->grid[node]];
}

typedef struct along_task {
    const ritz_nodes *nodes;
    const ritz_dense *T;
    int b;
    ritz_dense *out;
} along_task;

static void take_along(int thread, int64_t from, int64_t to, void *task)
{
    const along_task *t = task;
    const ritz_nodes *nodes = t->nodes;

    (void)thread;
    for (int64_t k = from; k < to; k++) {
        const double *u = ritz_dense_col(t->T, k);
        double *along = ritz_dense_col(t->out, k);

        for (int64_t i = 0; i < nodes->count; i++) {
            const double *axes = ritz_nodes_axes(nodes, i);

            for (int p = 0; p < 3; p++)
                if (nodes->row[3 * i + p] >= 0)
                    along[i] += axes[3 * p + t->b] * u[nodes->row[3 * i + p]];
        }
    }
}

ritz_status ritz_nodes_along(const ritz_nodes *nodes, const ritz_dense *T,
                             int b, ritz_dense *out)
{
    enum { WORTHWHILE = 50000 }; /* entries of `out` for each further thread */
    RITZ_OWN(ritz_dense) along = {0};

    RITZ_CHECK(ritz_dense_new(nodes->count, T->ncol, &along));
    ritz_team_over(ritz_team_ready(1 + nodes->count * T->ncol / WORTHWHILE),
                   T->ncol, take_along, &(along_task){nodes, T, b, &along});
    RITZ_MOVE(*out, along);
    return RITZ_OK;
}

void ritz_nodes_free(ritz_nodes *nodes)
{
    RITZ_FREE(nodes->grid, nodes->row);
    *nodes = (ritz_nodes){0};
}
