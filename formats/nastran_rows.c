/* Finds the grid and direction, or the scalar point, of each coordinate of a
 * reduced component. */
#include "formats/nastran_rows.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>

/* Whether q_j is the displacement of this row of T. */
static bool is_displacement(const ritz_dense *T, int64_t row, int64_t j)
{
    for (int64_t k = 0; k < T->ncol; k++)
        if (ritz_dense_col(T, k)[row] != (k == j ? 1.0 : 0.0))
            return false;
    return true;
}

static ritz_status find_interface(const ritz_reduced *reduced,
                                  const char *format, ritz_nastran_rows *rows)
{
    const ritz_columns *columns = &reduced->columns;

    for (int64_t j = 0; j < rows->order; j++) {
        const int64_t row = columns->dof[j];
        char name[RITZ_DOF_NAME_SIZE];

        if (row < 0)
            continue;
        RITZ_REFUSE_IF(
            columns->kind[j] != RITZ_COLUMN_CONSTRAINT ||
                !is_displacement(&reduced->T, row, j),
            RITZ_ERR_ARGUMENT,
            "%s is attached, but no coordinate is its displacement, as %s "
            "wants it: reduce by craig-bampton or guyan",
            ritz_dof_name(reduced->dof[row], name), format);
        rows->dof[j] = reduced->dof[row];
        rows->num_interface++;
    }
    RITZ_REFUSE_IF(rows->num_interface == 0, RITZ_ERR_ARGUMENT,
                   "no coordinate is the displacement of a grid, by which "
                   "%s is joined to a model: reduce by craig-bampton or "
                   "guyan with a port attached",
                   format);
    return RITZ_OK;
}

/* The largest number of a grid or a point of the full component. */
static int64_t find_largest(const ritz_reduced *reduced)
{
    int64_t largest = 0;

    for (int64_t k = 0; k < reduced->num_dofs; k++)
        if (reduced->dof[k].grid > largest)
            largest = reduced->dof[k].grid;
    for (int64_t k = 0; k < reduced->recovery.count; k++)
        if (reduced->recovery.dof[k].grid > largest)
            largest = reduced->recovery.dof[k].grid;
    for (int64_t k = 0; k < reduced->grids.count; k++)
        if (reduced->grids.id[k] > largest)
            largest = reduced->grids.id[k];
    return largest;
}

/* Numbers of scalar points begin after the next power of ten above all grids
   or, if there is no room, after the last grid. */
static ritz_status number_points(const ritz_reduced *reduced,
                                 ritz_nastran_rows *rows)
{
    const int64_t count = rows->order - rows->num_interface;
    const int64_t largest = find_largest(reduced);
    int64_t base = 1000;
    int64_t next = 0;

    while (base <= largest && base <= RITZ_NASTRAN_MOST_ID)
        base *= 10;
    if (base + count > RITZ_NASTRAN_MOST_ID)
        base = largest;
    RITZ_REFUSE_IF(base + count > RITZ_NASTRAN_MOST_ID, RITZ_ERR_ARGUMENT,
                   "grid %" PRId64 " leaves no numbers up to %d for %" PRId64
                   " scalar points",
                   largest, RITZ_NASTRAN_MOST_ID, count);
    rows->first_point = base + 1;
    for (int64_t j = 0; j < rows->order; j++)
        if (rows->dof[j].grid == 0)
            rows->dof[j].grid = rows->first_point + next++;
    return RITZ_OK;
}

typedef struct row_place {
    ritz_dof dof;
    int64_t j;
} row_place;

static int compare_places(const void *left, const void *right)
{
    return ritz_dof_compare(&((const row_place *)left)->dof,
                            &((const row_place *)right)->dof);
}

static ritz_status sort_coordinates(ritz_nastran_rows *rows)
{
    RITZ_OWN_ARRAY row_place *place = NULL;

    RITZ_CHECK_NEW(place, rows->order);
    for (int64_t j = 0; j < rows->order; j++)
        place[j] = (row_place){rows->dof[j], j};
    qsort(place, (size_t)rows->order, sizeof *place, compare_places);
    for (int64_t k = 0; k < rows->order; k++)
        rows->at[k] = place[k].j;
    return RITZ_OK;
}

ritz_status ritz_nastran_rows_new(const ritz_reduced *reduced,
                                  const char *format, ritz_nastran_rows *out)
{
    RITZ_OWN(ritz_nastran_rows) rows = {.order = reduced->K.nrow};

    RITZ_REFUSE_IF(!reduced->T.val || !reduced->dof, RITZ_ERR_ARGUMENT,
                   "it was made --without-basis: whose displacements its "
                   "coordinates are is not known");
    RITZ_CHECK_NEW(rows.dof, rows.order);
    RITZ_CHECK_NEW(rows.at, rows.order);
    RITZ_CHECK(find_interface(reduced, format, &rows));
    RITZ_CHECK(number_points(reduced, &rows));
    RITZ_CHECK(sort_coordinates(&rows));
    RITZ_MOVE(*out, rows);
    return RITZ_OK;
}

void ritz_nastran_rows_free(ritz_nastran_rows *rows)
{
    RITZ_FREE(rows->dof, rows->at);
    *rows = (ritz_nastran_rows){0};
}

static bool in_interface(const ritz_nastran_rows *rows, int64_t grid)
{
    for (int64_t k = 0; k < rows->num_interface; k++)
        if (rows->dof[rows->at[k]].grid == grid)
            return true;
    return false;
}

ritz_status ritz_nastran_rows_say(const ritz_nastran_rows *rows,
                                  ritz_export_report *report)
{
    const int64_t points = rows->order - rows->num_interface;

    RITZ_CHECK(ritz_export_say(report,
                               "%" PRId64 " dofs of interface grids, along the "
                               "axes of each grid (its CD)",
                               rows->num_interface));
    if (points > 0)
        RITZ_CHECK(ritz_export_say(
            report,
            "%" PRId64 " other coordinates are SPOINT %" PRId64 " to %" PRId64
            ", in the order of columns",
            points, rows->first_point, rows->first_point + points - 1));
    return RITZ_OK;
}

ritz_status ritz_nastran_rows_say_ports(const ritz_nastran_rows *rows,
                                        const ritz_reduced *reduced,
                                        const char *words,
                                        ritz_export_report *report)
{
    for (int64_t p = 0; p < reduced->num_ports; p++) {
        const ritz_port_map *port = &reduced->port[p];
        bool all = true;

        for (int64_t k = 0; k < port->count; k++)
            all = all && in_interface(rows, port->dof[k].grid);
        if (!all)
            RITZ_CHECK(
                ritz_export_say(report, "port '%s' %s", port->name, words));
    }
    return RITZ_OK;
}
