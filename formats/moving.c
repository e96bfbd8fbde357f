/* Moves the points of a reduced component, and puts quantities such as stresses
 * on its cells. */
#include "base/alloc.h"

#include <ritz/export.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PARTS = 31 };

/* A cell and the number of its element. */
typedef struct numbered_cell {
    int64_t id, cell;
} numbered_cell;

static int compare_cells(const void *left, const void *right)
{
    const numbered_cell *a = left;
    const numbered_cell *b = right;

    if (a->id != b->id)
        return a->id < b->id ? -1 : 1;
    return (a->cell > b->cell) - (a->cell < b->cell);
}

static int64_t count_rows(const ritz_reduced *reduced)
{
    int64_t count = 0;

    for (int64_t k = 0; k < reduced->num_quantities; k++)
        count += reduced->quantity[k].count;
    return count;
}

/* Index in `order` of the first cell whose element has at least the number
   `id`. */
static int64_t find_first_cell(const ritz_elements *cells, const int64_t *order,
                               int64_t id)
{
    int64_t low = 0, high = cells->count;

    while (low < high) {
        int64_t middle = low + (high - low) / 2;

        if (cells->id[order[middle]] < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static ritz_status sort_cells(ritz_moving *m)
{
    const ritz_elements *cells = &m->columns.cells;
    RITZ_OWN_ARRAY numbered_cell *sorted = NULL;

    RITZ_CHECK_NEW(sorted, cells->count);
    RITZ_CHECK_NEW(m->order, cells->count);
    for (int64_t k = 0; k < cells->count; k++)
        sorted[k] = (numbered_cell){cells->id ? cells->id[k] : 0, k};
    if (cells->count > 0)
        qsort(sorted, (size_t)cells->count, sizeof *sorted, compare_cells);
    for (int64_t k = 0; k < cells->count; k++)
        m->order[k] = sorted[k].cell;
    return RITZ_OK;
}

/* ---- fields ------------------------------------------------------------- */

static ritz_status add_field(const char *name, const char *part,
                             ritz_shapes *frame, int64_t *room, int64_t *out)
{
    int64_t held = *room;

    RITZ_CHECK_ROOM(frame->field, frame->num_fields, held);
    *room = held;
    snprintf(frame->field[frame->num_fields], RITZ_FIELD_NAME_SIZE, "%s%s%s",
             name, *part ? " " : "", part);
    *out = frame->num_fields++;
    return RITZ_OK;
}

/* Number of different parts ("sx") that the rows have; at most MOST_PARTS +
   1. */
static int64_t count_parts(const ritz_quantity *q)
{
    int64_t count = 0;

    for (int64_t i = 0; i < q->count && count <= MOST_PARTS; i++) {
        int64_t j = 0;

        while (strcmp(q->part[j], q->part[i]) != 0)
            j++;
        count += j == i;
    }
    return count;
}

/* Add the fields of quantity k: one for all of its rows and, if its rows have
   different parts, one for each part. `first` is the index of its first row
   among the rows of all quantities. */
static ritz_status list_fields(const ritz_quantity *q, int64_t k, int64_t first,
                               int64_t *room, ritz_moving *m)
{
    const int64_t parts = count_parts(q);

    m->whole[k] = -1;
    for (int64_t i = 0; i < q->count; i++)
        m->field[first + i] = -1;
    if (ritz_quantity_of_grids(q->kind) || !m->columns.cells.id)
        return RITZ_OK;
    RITZ_CHECK(add_field(q->name, "", &m->frame, room, &m->whole[k]));
    for (int64_t i = 0; i < q->count && parts > 1 && parts <= MOST_PARTS; i++) {
        int64_t j = 0;

        while (strcmp(q->part[j], q->part[i]) != 0)
            j++;
        if (j < i)
            m->field[first + i] = m->field[first + j];
        else if (*q->part[i])
            RITZ_CHECK(add_field(q->name, q->part[i], &m->frame, room,
                                 &m->field[first + i]));
    }
    return RITZ_OK;
}

static void find_cells(const ritz_quantity *q, int64_t first, ritz_moving *m)
{
    const ritz_elements *cells = &m->columns.cells;

    for (int64_t i = 0; i < q->count; i++) {
        int64_t id = q->place[i];

        if (ritz_quantity_of_grids(q->kind))
            continue;
        if (cells->id && id > 0) {
            m->first[first + i] = find_first_cell(cells, m->order, id);
            m->last[first + i] = find_first_cell(cells, m->order, id + 1);
        }
        m->num_lost += m->first[first + i] == m->last[first + i];
    }
}

static ritz_status find_fields(ritz_moving *m)
{
    const ritz_reduced *reduced = m->reduced;
    const int64_t rows = count_rows(reduced);
    int64_t first = 0, room = 0;

    RITZ_CHECK(sort_cells(m));
    RITZ_CHECK_NEW(m->first, rows);
    RITZ_CHECK_NEW(m->last, rows);
    RITZ_CHECK_NEW(m->field, rows);
    RITZ_CHECK_NEW(m->whole, reduced->num_quantities);
    for (int64_t k = 0; k < reduced->num_quantities; k++) {
        const ritz_quantity *q = &reduced->quantity[k];

        RITZ_CHECK(list_fields(q, k, first, &room, m));
        find_cells(q, first, m);
        first += q->count;
    }
    return RITZ_OK;
}

ritz_status ritz_moving_new(const ritz_reduced *reduced, ritz_moving *out)
{
    RITZ_OWN(ritz_moving) m = {.reduced = reduced};
    ritz_shapes *frame = &m.frame;

    RITZ_CHECK(ritz_shapes_of_motion(reduced, &m.columns));
    RITZ_CHECK(find_fields(&m));
    frame->num_points = m.columns.num_points;
    frame->id = m.columns.id;
    frame->position = m.columns.position;
    frame->cells = m.columns.cells;
    frame->meshed = m.columns.meshed;
    frame->count = 1;
    memcpy(frame->units, m.columns.units, sizeof frame->units);
    RITZ_CHECK_NEW(frame->name, 1);
    snprintf(frame->name[0], sizeof frame->name[0], "displacement");
    RITZ_CHECK(ritz_dense_new(3 * frame->num_points, 1, &frame->u));
    if (m.columns.turn.val)
        RITZ_CHECK(ritz_dense_new(3 * frame->num_points, 1, &frame->turn));
    RITZ_CHECK_NEW(frame->of_cell, frame->num_fields * frame->cells.count);
    RITZ_MOVE(*out, m);
    return RITZ_OK;
}

/* ---- a frame ------------------------------------------------------------ */

/* y = A q */
static void combine_columns(const ritz_dense *A, const double *q, double *y)
{
    memset(y, 0, (size_t)A->nrow * sizeof *y);
    for (int64_t j = 0; j < A->ncol; j++) {
        const double *column = ritz_dense_col(A, j);

        for (int64_t i = 0; i < A->nrow; i++)
            y[i] += column[i] * q[j];
    }
}

void ritz_moving_to(ritz_moving *moving, const double *q)
{
    ritz_shapes *frame = &moving->frame;

    combine_columns(&moving->columns.u, q, frame->u.val);
    if (frame->turn.val)
        combine_columns(&moving->columns.turn, q, frame->turn.val);
    for (int64_t k = 0; k < frame->num_fields * frame->cells.count; k++)
        frame->of_cell[k] = nan("");
}

/* A cell keeps the value of the largest magnitude. */
static void put_value(ritz_shapes *frame, int64_t field, int64_t cell,
                      double value)
{
    double *at = NULL;

    if (field < 0)
        return;
    at = &frame->of_cell[field * frame->cells.count + cell];
    if (isnan(*at) || fabs(value) > fabs(*at))
        *at = value;
}

void ritz_moving_paint(ritz_moving *moving, int64_t k, const double *y)
{
    const ritz_reduced *reduced = moving->reduced;
    int64_t row = 0;

    for (int64_t j = 0; j < k; j++)
        row += reduced->quantity[j].count;
    for (int64_t i = 0; i < reduced->quantity[k].count; i++, row++)
        for (int64_t c = moving->first[row]; c < moving->last[row]; c++) {
            const int64_t cell = moving->order[c];

            put_value(&moving->frame, moving->whole[k], cell, y[i]);
            put_value(&moving->frame, moving->field[row], cell, y[i]);
        }
}

void ritz_moving_free(ritz_moving *moving)
{
    ritz_shapes *frame = &moving->frame;

    RITZ_FREE(frame->name, frame->field, frame->of_cell, moving->first,
              moving->last, moving->order, moving->field, moving->whole);
    ritz_dense_free(&frame->u);
    ritz_dense_free(&frame->turn);
    ritz_shapes_free(&moving->columns);
    *moving = (ritz_moving){0};
}
