/*
 * What the lines of an input file say together: grids, rows, supports,
 * equations, and cells for pictures.
 *
 * A node has a row for each direction that one of its elements, or an equation,
 * gives it; nodes of no element have none. Rows are in the order of the nodes.
 *
 *     EQUATION   N                          sum of A_k u(G_k, C_k) = 0
 *                G1, C1, A1, G2, C2, A2     u_1 = -(A2 u_2 + ...) / A1
 *
 * Both programs eliminate the first dof of an equation. [Abaqus2016],
 * [Dhondt2022]
 */
#include "base/alloc.h"
#include "formats/inp.h"
#include "model/equations.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- nodes --------------------------------------------------------------- */

/* By id, then in the order of the deck. */
static int compare_nodes(const void *left, const void *right)
{
    const ritz_inp_node *a = left;
    const ritz_inp_node *b = right;
    int order = (a->id > b->id) - (a->id < b->id);

    return order ? order : (a->order > b->order) - (a->order < b->order);
}

static bool same_position(const ritz_inp_node *a, const ritz_inp_node *b)
{
    return a->x[0] == b->x[0] && a->x[1] == b->x[1] && a->x[2] == b->x[2];
}

/* Sort the nodes; one that is defined again, alike, counts once. */
static ritz_status settle_nodes(ritz_inp *all)
{
    int64_t kept = 0;

    if (all->num_nodes > 1)
        qsort(all->node, (size_t)all->num_nodes, sizeof *all->node,
              compare_nodes);
    for (int64_t k = 0; k < all->num_nodes; k++) {
        const ritz_inp_node *node = &all->node[k];

        if (kept == 0 || all->node[kept - 1].id != node->id)
            all->node[kept++] = *node;
        else if (!same_position(&all->node[kept - 1], node))
            return ritz_inp_refuse(
                all, node->place,
                "node %" PRId64 " was defined at another position", node->id);
    }
    all->num_nodes = kept;
    return RITZ_OK;
}

/* Nodes of a part are in the model by its instance alone. */
static ritz_status check_home(const ritz_inp *all)
{
    const ritz_inp_container *home = &all->home;

    if (all->num_nodes == 0 || !home->is_part)
        return RITZ_OK;
    if (all->instance.line == 0 || !ritz_inp_same(all->instance_of, home->name))
        return ritz_inp_refuse(all, all->node[0].place,
                               "there is no '*INSTANCE' of the part '%.*s', "
                               "which has the nodes",
                               RITZ_INP_QUOTED(home->name));
    return RITZ_OK;
}

static ritz_status place_nodes(const ritz_inp *all, ritz_grids *out)
{
    RITZ_OWN(ritz_grids) grids = {.num_frames = 1};

    RITZ_CHECK_NEW(grids.id, all->num_nodes);
    RITZ_CHECK_NEW(grids.position, 3 * all->num_nodes);
    RITZ_CHECK_NEW(grids.frame, all->num_nodes);
    RITZ_CHECK_NEW(grids.axes, 9);
    for (int k = 0; k < 9; k += 4)
        grids.axes[k] = 1.0;
    grids.count = all->num_nodes;
    for (int64_t k = 0; k < all->num_nodes; k++) {
        grids.id[k] = all->node[k].id;
        for (int64_t i = 0; i < 3; i++) {
            grids.position[3 * k + i] = all->node[k].x[i] + all->shift[i];
            if (!isfinite(grids.position[3 * k + i]))
                return ritz_inp_refuse(all, all->node[k].place,
                                       "node %" PRId64 " is infinitely far "
                                       "away",
                                       all->node[k].id);
        }
    }
    RITZ_MOVE(*out, grids);
    return RITZ_OK;
}

/* ---- elements ------------------------------------------------------------ */

/* A line of three nodes is bent: it is drawn as two. */
static bool is_bent(const ritz_inp_type *type)
{
    return type->cell == RITZ_CELL_LINE && type->size == 3;
}

static void put_cell(ritz_cell kind, int64_t id, int64_t size,
                     const int64_t *grid, ritz_elements *out)
{
    int64_t *end = &out->first[out->count + 1];

    *end = out->first[out->count];
    for (int64_t i = 0; i < size; i++)
        out->grid[(*end)++] = grid[i];
    out->id[out->count] = id;
    out->kind[out->count++] = kind;
}

static ritz_status list_cells(const ritz_inp *all, ritz_elements *out)
{
    int64_t bent = 0;

    for (int64_t k = 0; k < all->num_elements; k++)
        bent += is_bent(all->element[k].type);
    RITZ_CHECK_NEW(out->kind, all->num_elements + bent);
    RITZ_CHECK_NEW(out->first, all->num_elements + bent + 1);
    RITZ_CHECK_NEW(out->id, all->num_elements + bent);
    RITZ_CHECK_NEW(out->grid, all->num_joined + bent);
    for (int64_t k = 0; k < all->num_elements; k++) {
        const ritz_inp_type *type = all->element[k].type;
        const int64_t *grid = all->joined + all->element[k].first;
        int64_t id = all->element[k].id;

        if (is_bent(type)) {
            put_cell(type->cell, id, 2, grid, out);
            put_cell(type->cell, id, 2, grid + 1, out);
        } else if (type->cell) {
            put_cell(type->cell, id, type->size, grid, out);
        }
    }
    return RITZ_OK;
}

/* Set the bits of the directions that elements give to their nodes. A missing
   node is an error, unless the deck includes files that are not read. */
static ritz_status mark_joined(const ritz_inp *all, uint8_t *mask)
{
    for (int64_t k = 0; k < all->num_elements; k++) {
        const ritz_inp_element *element = &all->element[k];

        for (int64_t i = 0; i < element->type->size; i++) {
            const int64_t id = all->joined[element->first + i];
            const int64_t at = ritz_inp_find(all, id);

            if (at >= 0)
                mask[at] |= element->type->mask;
            else if (!all->unfollowed)
                return ritz_inp_refuse(all, element->place,
                                       "there is no node %" PRId64
                                       " of element %" PRId64,
                                       id, element->id);
        }
    }
    return RITZ_OK;
}

/* ---- supports ------------------------------------------------------------ */

/* Store a sentence about an imposed motion. An import fails with it only if the
   supports of the deck are applied to matrices. */
static ritz_status note_imposed(const ritz_inp *all,
                                const ritz_inp_support *support, ritz_deck *out)
{
    if (!support->imposed || out->imposed)
        return RITZ_OK;
    (void)ritz_inp_refuse(all, support->nodes.place,
                          "'*BOUNDARY' moves nodes by what is not zero: "
                          "imposed motion is no part of a component, use a "
                          "port and an input");
    return ritz_deck_keep_sentence(&out->imposed);
}

static ritz_status list_supports(const ritz_inp *all, ritz_deck *out)
{
    RITZ_OWN_ARRAY uint8_t *mask = NULL;
    RITZ_OWN(ritz_inp_marks) marks = {0};

    RITZ_CHECK_NEW(mask, all->num_nodes);
    for (int64_t k = 0; k < all->num_supports; k++) {
        const ritz_inp_support *support = &all->support[k];

        RITZ_CHECK(note_imposed(all, support, out));
        RITZ_CHECK(
            ritz_inp_mark(all, &support->nodes, support->mask, &marks, mask));
    }
    return ritz_deck_list_dofs(&out->grids, mask, &out->num_fixed, &out->fixed);
}

/* ---- constraints --------------------------------------------------------- */

static ritz_status put_equation(const ritz_inp *all,
                                const ritz_inp_constraint *one, uint8_t *mask,
                                ritz_equations *out)
{
    const ritz_inp_term *term = all->term + one->first;

    if (term[0].factor == 0.0)
        return ritz_inp_refuse(all, one->place,
                               "the first factor of '*EQUATION' is zero");
    for (int64_t k = 0; k < one->count; k++) {
        double share = -term[k].factor / term[0].factor;
        ritz_dof dof = {.component = term[k].component};
        int64_t at = 0;

        RITZ_CHECK(ritz_inp_locate(all, &term[k].node, &at));
        dof.grid = all->node[at].id;
        if (!isfinite(share))
            return ritz_inp_refuse(all, one->place,
                                   "factors of '*EQUATION' differ too much");
        mask[at] |= (uint8_t)(1U << (unsigned)dof.component);
        RITZ_CHECK(k == 0 ? ritz_equations_begin(out, dof)
                          : ritz_equations_add(out, dof, share));
    }
    return RITZ_OK;
}

static ritz_status put_constraint(const ritz_inp *all, int64_t k, uint8_t *mask,
                                  ritz_deck *out)
{
    const ritz_inp_constraint *one = &all->constraint[k];
    ritz_equation_source from = {.file = one->place.file,
                                 .line = one->place.line};

    memcpy(from.name, out->constraint[k], sizeof from.name);
    RITZ_CHECK(ritz_equations_cite_next(&out->equations, from));
    if (one->count == 0)
        return ritz_inp_refuse(all, one->place,
                               "'*%s' is not understood: of constraints "
                               "*EQUATION is",
                               one->keyword);
    return put_equation(all, one, mask, &out->equations);
}

/* Equations up to the first constraint that is not understood. */
static ritz_status list_constraints(const ritz_inp *all, uint8_t *mask,
                                    ritz_deck *out)
{
    if (all->num_constraints == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(out->constraint, all->num_constraints);
    for (; out->num_constraints < all->num_constraints; out->num_constraints++)
        snprintf(out->constraint[out->num_constraints], sizeof *out->constraint,
                 "%s %" PRId64, all->constraint[out->num_constraints].keyword,
                 out->num_constraints + 1);
    RITZ_CHECK(ritz_deck_paths(&all->files, &out->equations.num_files,
                               &out->equations.file));
    for (int64_t k = 0; k < all->num_constraints; k++) {
        ritz_status status = put_constraint(all, k, mask, out);

        if (status == RITZ_ERR_FORMAT)
            return ritz_deck_keep_sentence(&out->equations.refused);
        RITZ_CHECK(status);
    }
    return RITZ_OK;
}

/* ---- rows ---------------------------------------------------------------- */

/* Keep a sentence that says why the deck does not tell which rows matrices
 * have, if that is so. */
static ritz_status note_rows(const ritz_inp *all, ritz_deck *out)
{
    ritz_inp_place at = {0};

    if (all->strange.line > 0)
        (void)ritz_inp_refuse(all, at = all->strange,
                              "which rows nodes of '%.*s' elements have is "
                              "not known",
                              RITZ_INP_QUOTED(all->strange_type));
    else if (all->expanded.line > 0 && all->program == RITZ_INP_CALCULIX)
        (void)ritz_inp_refuse(all, at = all->expanded,
                              "CalculiX makes solids of '%s' elements, with "
                              "nodes that the deck does not show",
                              all->expanded_type->name);
    else if (all->expanded.line > 0 && all->program == RITZ_INP_UNKNOWN)
        (void)ritz_inp_refuse(all, at = all->expanded,
                              "'%s' elements have other rows in CalculiX than "
                              "in Abaqus, and no keyword such as *MATRIX "
                              "GENERATE says which of them made the matrices",
                              all->expanded_type->name);
    else if (all->unordered.line > 0 && all->program != RITZ_INP_CALCULIX)
        (void)ritz_inp_refuse(all, at = all->unordered,
                              "the numbers of nodes do not ascend, and it is "
                              "not known in which order Abaqus has their rows");
    return at.line > 0 ? ritz_deck_keep_sentence(&out->unnumbered) : RITZ_OK;
}

ritz_status ritz_inp_build(ritz_inp *all, ritz_deck *out)
{
    RITZ_OWN_ARRAY uint8_t *mask = NULL; /* directions of each node */

    RITZ_CHECK(check_home(all));
    RITZ_CHECK(settle_nodes(all));
    RITZ_CHECK(place_nodes(all, &out->grids));
    RITZ_CHECK_NEW(mask, all->num_nodes);
    RITZ_CHECK(mark_joined(all, mask));
    RITZ_CHECK(list_cells(all, &out->elements));
    out->num_strange = all->num_strange;
    RITZ_CHECK(list_supports(all, out));
    RITZ_CHECK(list_constraints(all, mask, out));
    RITZ_CHECK(
        ritz_deck_list_dofs(&out->grids, mask, &out->num_dofs, &out->dof));
    return note_rows(all, out);
}
