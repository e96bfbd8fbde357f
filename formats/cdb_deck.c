/*
 * Makes a deck of what the lines of a coded database say: grids with their
 * axes, cells for pictures, and supports. A node has a row for each direction
 * that one of its elements gives it. Only the mapping file of the matrices says
 * in which order their rows are.
 *
 * Axes of a node are turned by THXY about z, then by THYZ about the new x, then
 * by THZX about the new y: their columns are Rz(THXY) Rx(THYZ) Ry(THZX).
 */
#include "base/alloc.h"
#include "formats/cdb.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bits of directions. */
enum { PLANE = 0x06, SOLID = 0x0e, FRAME = 0x46, ALL_SIX = 0x7e };

/* ---- nodes --------------------------------------------------------------- */

static int compare_nodes(const void *left, const void *right)
{
    const ritz_cdb_node *a = left;
    const ritz_cdb_node *b = right;
    const int order = (a->id > b->id) - (a->id < b->id);

    return order ? order : (a->line > b->line) - (a->line < b->line);
}

/* Sort the nodes; of one that is defined again, the last holds. */
static void settle_nodes(ritz_cdb *all)
{
    int64_t kept = 0;

    if (all->num_nodes > 1)
        qsort(all->node, (size_t)all->num_nodes, sizeof *all->node,
              compare_nodes);
    for (int64_t k = 0; k < all->num_nodes; k++)
        if (k + 1 == all->num_nodes || all->node[k + 1].id != all->node[k].id)
            all->node[kept++] = all->node[k];
    all->num_nodes = kept;
}

static bool is_turned(const ritz_cdb_node *node)
{
    return node->angle[0] != 0.0 || node->angle[1] != 0.0 ||
           node->angle[2] != 0.0;
}

/* Row i of the axes is the i-th column of Rz(a) Rx(b) Ry(c). */
static void turn_axes(const double angle[static 3], double out[static 9])
{
    const double degree = acos(-1.0) / 180.0;
    const double ca = cos(angle[0] * degree), sa = sin(angle[0] * degree);
    const double cb = cos(angle[1] * degree), sb = sin(angle[1] * degree);
    const double cc = cos(angle[2] * degree), sc = sin(angle[2] * degree);
    const double R[9] = {ca * cc - sa * sb * sc,
                         -sa * cb,
                         ca * sc + sa * sb * cc,
                         sa * cc + ca * sb * sc,
                         ca * cb,
                         sa * sc - ca * sb * cc,
                         -cb * sc,
                         sb,
                         cb * cc};

    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++)
            out[3 * i + j] = R[3 * j + i];
}

/* Neighbours often have the same axes: a frame is made where angles change. */
static ritz_status place_nodes(const ritz_cdb *all, ritz_grids *out)
{
    RITZ_OWN(ritz_grids) grids = {.num_frames = 1};
    const ritz_cdb_node *last = NULL;
    int64_t frames = 1;

    for (int64_t k = 0; k < all->num_nodes; k++)
        frames += is_turned(&all->node[k]);
    RITZ_CHECK_NEW(grids.id, all->num_nodes);
    RITZ_CHECK_NEW(grids.position, 3 * all->num_nodes);
    RITZ_CHECK_NEW(grids.frame, all->num_nodes);
    RITZ_CHECK_NEW(grids.axes, 9 * frames);
    for (int k = 0; k < 9; k += 4)
        grids.axes[k] = 1.0;
    grids.count = all->num_nodes;
    for (int64_t k = 0; k < all->num_nodes; k++) {
        const ritz_cdb_node *node = &all->node[k];

        grids.id[k] = node->id;
        memcpy(grids.position + 3 * k, node->x, sizeof node->x);
        if (!is_turned(node))
            continue;
        if (!last || last->angle[0] != node->angle[0] ||
            last->angle[1] != node->angle[1] ||
            last->angle[2] != node->angle[2])
            turn_axes(node->angle, grids.axes + 9 * grids.num_frames++);
        grids.frame[k] = grids.num_frames - 1;
        last = node;
    }
    RITZ_MOVE(*out, grids);
    return RITZ_OK;
}

/* ---- elements ------------------------------------------------------------ */

/* A cell of an element. It has corners only where nodes between them are
   missing, or where corners coincide. */
typedef struct cdb_cell {
    ritz_cell kind; /* 0: none */
    int64_t count;
    int64_t grid[20];
} cdb_cell;

static void pick_nodes(const int64_t *node, ritz_cell kind, int64_t count,
                       const char *order, cdb_cell *out)
{
    out->kind = kind;
    out->count = count;
    for (int64_t k = 0; k < count; k++)
        out->grid[k] = node[order[k] - 'A'];
}

/* Bricks whose corners coincide, as K = L and O = P of a wedge. A pyramid stays
   a brick. */
static void cut_brick(const int64_t *n, cdb_cell *out)
{
    const bool wedge = n[2] == n[3] && n[6] == n[7];
    const bool top = n[4] == n[5] && n[5] == n[6] && n[6] == n[7];

    if (wedge && top)
        pick_nodes(n, RITZ_CELL_TETRA, 4, "ABCE", out);
    else if (wedge)
        pick_nodes(n, RITZ_CELL_WEDGE, 6, "ABCEFG", out);
    else
        pick_nodes(n, RITZ_CELL_HEXA, 8, "ABCDEFGH", out);
}

static void cut_corners(ritz_cell linear, const int64_t *n, cdb_cell *out)
{
    if (linear == RITZ_CELL_HEXA)
        cut_brick(n, out);
    else if (linear == RITZ_CELL_QUAD && n[2] == n[3])
        pick_nodes(n, RITZ_CELL_TRIANGLE, 3, "ABC", out);
    else if (linear == RITZ_CELL_QUAD)
        pick_nodes(n, RITZ_CELL_QUAD, 4, "ABCD", out);
    else
        pick_nodes(n, RITZ_CELL_TETRA, 4, "ABCD", out);
}

/* Whether the nodes are all there and no corner coincides with the next. */
static bool is_whole_cell(const int64_t *n, int64_t size, int64_t corners)
{
    for (int64_t k = 0; k < size; k++)
        if (n[k] == 0 || (k > 0 && k < corners && n[k] == n[k - 1]))
            return false;
    return true;
}

static bool has_node(const ritz_cdb *all, int64_t id)
{
    const ritz_cdb_node key = {.id = id};
    int64_t from = 0, to = all->num_nodes;

    while (from < to) {
        const int64_t middle = (from + to) / 2;

        if (all->node[middle].id < key.id)
            from = middle + 1;
        else
            to = middle;
    }
    return from < all->num_nodes && all->node[from].id == id;
}

/* The cell of an element of a known kind; false if it lacks nodes. */
static bool find_cell(const ritz_cdb *all, const ritz_cdb_element *element,
                      const ritz_cdb_kind *kind, cdb_cell *out)
{
    const ritz_cell_shape *shape = ritz_cell_shape_of(kind->cell);
    const int64_t corners = kind->cell == RITZ_CELL_LINE ? 2 : shape->corners;
    const int64_t *n = NULL;

    *out = (cdb_cell){0};
    if (!kind->cell)
        return true;
    if (element->count < corners)
        return false;
    n = all->joined + element->first;
    if (kind->cell == RITZ_CELL_LINE)
        pick_nodes(n, RITZ_CELL_LINE, 2, "AB", out);
    else if (element->count >= kind->size &&
             is_whole_cell(n, kind->size, corners))
        pick_nodes(n, kind->cell, kind->size, "ABCDEFGHIJKLMNOPQRST", out);
    else
        cut_corners(shape->linear, n, out);
    for (int64_t k = 0; k < out->count; k++)
        if (!has_node(all, out->grid[k]))
            return false;
    return true;
}

static const ritz_cdb_kind *kind_of(const ritz_cdb *all,
                                    const ritz_cdb_element *element)
{
    const ritz_cdb_type *type = ritz_cdb_find_type(all, element->type);

    return type ? type->kind : NULL;
}

static ritz_status list_cells(const ritz_cdb *all, ritz_deck *out)
{
    ritz_elements *cells = &out->elements;

    RITZ_CHECK_NEW(cells->kind, all->num_elements);
    RITZ_CHECK_NEW(cells->first, all->num_elements + 1);
    RITZ_CHECK_NEW(cells->grid, all->num_joined);
    RITZ_CHECK_NEW(cells->id, all->num_elements);
    out->num_strange = all->num_strange;
    for (int64_t k = 0; k < all->num_elements; k++) {
        const ritz_cdb_kind *kind = kind_of(all, &all->element[k]);
        const int64_t first = cells->first[cells->count];
        cdb_cell cell = {0};

        if (!kind || !find_cell(all, &all->element[k], kind, &cell)) {
            out->num_strange++;
            continue;
        }
        if (!cell.kind)
            continue;
        memcpy(cells->grid + first, cell.grid,
               (size_t)cell.count * sizeof *cell.grid);
        cells->id[cells->count] = all->element[k].id;
        cells->kind[cells->count++] = cell.kind;
        cells->first[cells->count] = first + cell.count;
    }
    return RITZ_OK;
}

/* ---- rows ---------------------------------------------------------------- */

static int64_t find_grid(const ritz_deck *deck, int64_t id)
{
    return id == 0 ? -1 : ritz_grids_find(&deck->grids, id);
}

/* RITZ_CDB_MASS21: with KEYOPT(3) = 2 it has no rotations, with 3 it is plane,
   with 4 it is plane without a rotation. */
static uint8_t mask_of(const ritz_cdb_type *type)
{
    static const uint8_t mass[] = {ALL_SIX, ALL_SIX, SOLID, FRAME, PLANE};

    if (type->kind->number != RITZ_CDB_MASS21)
        return type->kind->mask;
    return type->option_3 >= 0 && type->option_3 <= 4 ? mass[type->option_3]
                                                      : ALL_SIX;
}

static void mark_joined(const ritz_cdb *all, const ritz_deck *deck,
                        uint8_t *mask)
{
    for (int64_t k = 0; k < all->num_elements; k++) {
        const ritz_cdb_element *element = &all->element[k];
        const ritz_cdb_type *type = ritz_cdb_find_type(all, element->type);
        const int64_t count =
            type && type->kind
                ? (element->count < type->kind->size ? element->count
                                                     : type->kind->size)
                : 0;

        for (int64_t i = 0; i < count; i++) {
            const int64_t at = find_grid(deck, all->joined[element->first + i]);

            if (at >= 0)
                mask[at] |= mask_of(type);
        }
    }
}

static ritz_status note_imposed(const ritz_cdb *all,
                                const ritz_cdb_support *support, ritz_deck *out)
{
    if (!support->imposed || out->imposed)
        return RITZ_OK;
    (void)ritz_cdb_refuse(all, support->line,
                          "'D' imposes a motion that is not zero, which no "
                          "component has: use a port and an input");
    return ritz_deck_keep_sentence(&out->imposed);
}

static ritz_status list_supports(const ritz_cdb *all, ritz_deck *out)
{
    RITZ_OWN_ARRAY uint8_t *mask = NULL;
    uint8_t everywhere = 0;

    RITZ_CHECK_NEW(mask, out->grids.count);
    for (int64_t k = 0; k < all->num_supports; k++) {
        const ritz_cdb_support *support = &all->support[k];
        const int64_t at = find_grid(out, support->node);

        RITZ_CHECK(note_imposed(all, support, out));
        if (support->node == 0)
            everywhere |= support->mask;
        else if (at >= 0)
            mask[at] |= support->mask;
        else
            return ritz_cdb_refuse(all, support->line,
                                   "'D' holds node %" PRId64
                                   ", which does not exist",
                                   support->node);
    }
    for (int64_t k = 0; k < out->grids.count; k++)
        mask[k] |= everywhere;
    return ritz_deck_list_dofs(&out->grids, mask, &out->num_fixed, &out->fixed);
}

/* ---- constraints --------------------------------------------------------- */

/* Elements that tie nodes join the commands that do. */
static ritz_status add_tying_elements(ritz_cdb *all)
{
    for (int64_t k = 0; k < all->num_elements; k++) {
        const ritz_cdb_kind *kind = kind_of(all, &all->element[k]);
        ritz_cdb_tie tie = {.line = all->element[k].line};

        if (!kind || !kind->ties)
            continue;
        snprintf(tie.name, sizeof tie.name, "MPC%" PRId64 " %" PRId64,
                 kind->number, all->num_ties + 1);
        RITZ_CHECK_ROOM(all->tie, all->num_ties, all->ties_room);
        all->tie[all->num_ties++] = tie;
    }
    return RITZ_OK;
}

/* Constraints are listed, none is understood. */
static ritz_status list_constraints(ritz_cdb *all, ritz_deck *out)
{
    RITZ_CHECK(add_tying_elements(all));
    if (all->num_ties == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(out->constraint, all->num_ties);
    for (; out->num_constraints < all->num_ties; out->num_constraints++)
        memcpy(out->constraint[out->num_constraints],
               all->tie[out->num_constraints].name, RITZ_NAME_SIZE);
    (void)ritz_cdb_refuse(all, all->tie[0].line,
                          "'%s' is not understood: constraints of ANSYS are "
                          "not read, export matrices without their dofs",
                          all->tie[0].name);
    return ritz_deck_keep_sentence(&out->equations.refused);
}

ritz_status ritz_cdb_build(ritz_cdb *all, ritz_deck *out)
{
    RITZ_OWN_ARRAY uint8_t *mask = NULL;

    settle_nodes(all);
    RITZ_CHECK(place_nodes(all, &out->grids));
    RITZ_CHECK_NEW(mask, all->num_nodes);
    mark_joined(all, out, mask);
    RITZ_CHECK(list_cells(all, out));
    RITZ_CHECK(list_supports(all, out));
    RITZ_CHECK(list_constraints(all, out));
    RITZ_CHECK(
        ritz_deck_list_dofs(&out->grids, mask, &out->num_dofs, &out->dof));
    (void)ritz_fail(RITZ_ERR_FORMAT,
                    "ANSYS orders rows for its solver: name them with --dofs "
                    "and the mapping file");
    return ritz_deck_keep_sentence(&out->unnumbered);
}
