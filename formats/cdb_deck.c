/*
 * Makes a deck of a coded database: grids with their axes, cells for pictures,
 * and supports. A node has a dof in each direction that one of its elements
 * gives it. The order of these dofs in the matrices is known from the mapping
 * file of the matrices only.
 *
 * The axes of a node are turned by THXY about z, then by THYZ about the new x,
 * then by THZX about the new y: they are the columns of
 * Rz(THXY) Rx(THYZ) Ry(THZX).
 */
#include "base/alloc.h"
#include "formats/cdb.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- nodes --------------------------------------------------------------- */

static int compare_nodes(const void *left, const void *right)
{
    const ritz_cdb_node *a = left;
    const ritz_cdb_node *b = right;
    const int order = (a->id > b->id) - (a->id < b->id);

    return order ? order : (a->line > b->line) - (a->line < b->line);
}

/* Sort the nodes. Of several definitions of one node, keep the last. */
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

/* Row i of `out` is column i of R = Rz(a) Rx(b) Ry(c), angles in degrees. */
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

/* Consecutive nodes with the same angles share a frame. */
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

/* The cell that draws an element. It is the linear one, of corners alone, if a
   node between corners is missing or corners coincide. */
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

/* Bricks with coinciding corners, in the letters of ANSYS, I to P: a wedge has
   K = L and O = P, a tetrahedron also M = N = O. A pyramid is drawn as a brick.
 */
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

/* Make the cell of an element, which has no cell if its kind has none.
   @param[in] n  nodes of the element
   @return whether the element has the nodes that the cell needs */
static bool make_cell(const ritz_grids *grids, const ritz_cdb_element *element,
                      const ritz_cdb_kind *kind, const int64_t *n,
                      cdb_cell *out)
{
    const ritz_cell_shape *shape = ritz_cell_shape_of(kind->cell);
    const int64_t corners = kind->cell == RITZ_CELL_LINE ? 2 : shape->corners;

    *out = (cdb_cell){0};
    if (!kind->cell)
        return true;
    if (element->count < corners)
        return false;
    if (kind->cell == RITZ_CELL_LINE)
        pick_nodes(n, RITZ_CELL_LINE, 2, "AB", out);
    else if (element->count >= kind->size &&
             is_whole_cell(n, kind->size, corners))
        pick_nodes(n, kind->cell, kind->size, "ABCDEFGHIJKLMNOPQRST", out);
    else
        cut_corners(shape->linear, n, out);
    for (int64_t k = 0; k < out->count; k++)
        if (ritz_grids_find(grids, out->grid[k]) < 0)
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

        if (!kind || !make_cell(&out->grids, &all->element[k], kind,
                                all->joined + all->element[k].first, &cell)) {
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

/* Directions of the nodes of an element type. KEYOPT(3) of MASS21 chooses three
   translations (2), the motions in a plane (3) or its translations (4). */
static uint8_t mask_of(const ritz_cdb_type *type)
{
    static const uint8_t mass[] = {RITZ_CDB_ALL_SIX, RITZ_CDB_ALL_SIX,
                                   RITZ_CDB_SOLID, RITZ_CDB_FRAME,
                                   RITZ_CDB_PLANE};

    if (type->kind->number != RITZ_CDB_MASS21)
        return type->kind->mask;
    return type->option_3 >= 0 && type->option_3 <= 4 ? mass[type->option_3]
                                                      : RITZ_CDB_ALL_SIX;
}

/* Set the bits of the directions that elements give to their nodes. */
static void mark_joined(const ritz_cdb *all, const ritz_deck *deck,
                        uint8_t *mask)
{
    for (int64_t k = 0; k < all->num_elements; k++) {
        const ritz_cdb_element *element = &all->element[k];
        const ritz_cdb_type *type = ritz_cdb_find_type(all, element->type);
        const int64_t size = type && type->kind ? type->kind->size : 0;

        for (int64_t i = 0; i < size && i < element->count; i++) {
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

/* Append the elements that tie nodes to the list of constraints. */
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

/* List the constraints by name. None is evaluated, so that an import to which
   they matter is refused. */
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
