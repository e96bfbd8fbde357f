/*
 * Matrices of a linear user element: in this form Abaqus and CalculiX write a
 * substructure (*SUBSTRUCTURE MATRIX OUTPUT, OUTPUT FILE=USER DEFINED).
 *
 *     *USER ELEMENT, NODES=n, LINEAR
 *     ** ELEMENT NODES
 *     ** 101, 102, 103, ...         numbers of the n nodes, on several lines
 *     1, 2, 3                       directions of the first node and those that
 *     7, 1, 2, 3, 4, 5, 6           follow; others from the 7th node on
 *     *MATRIX, TYPE=STIFFNESS
 *     A11                           rows of the lower triangle, each of which
 *     A21, A22                      begins a line; four numbers to a line
 *     A31, A32, A33
 *     *MATRIX, TYPE=MASS
 *
 * Rows are the directions of the first node, then those of the second and so
 * on. CalculiX repeats a node for each of its directions, so that nodes may
 * come several times; a node with its direction may not. The file may hold
 * several elements, as *ELEMENT MATRIX OUTPUT writes them.
 *
 * [Abaqus2016], *MATRIX, *SUBSTRUCTURE MATRIX OUTPUT and "User-defined
 * elements"; [Dhondt2022], *SUBSTRUCTURE MATRIX OUTPUT.
 */
#include "base/alloc.h"
#include "formats/abaqus.h"
#include "formats/matrix.h"

#include <ritz/import.h>

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>

enum {
    DIRECTIONS = 6,   /* of a node */
    LINE_NUMBERS = 4, /* of a matrix on a line */
};

typedef struct ritz_user_element {
    ritz_lines text;
    int64_t wanted;    /* line of the *MATRIX that is read; 0: none is */
    bool found;        /* it was read */
    int64_t num_nodes; /* that the last *USER ELEMENT declares */
    int64_t num_named, nodes_room;
    int64_t *node;
    int64_t num_dofs, dofs_room;
    ritz_dof *dof; /* of each row */
} ritz_user_element;

static void ritz_user_element_free(ritz_user_element *e)
{
    RITZ_FREE(e->node, e->dof);
}

/* Directions that nodes have, from the node at one place of the list on. */
typedef struct ritz_direction_list {
    int64_t from; /* from 1 */
    int count;
    int64_t at[DIRECTIONS];
} ritz_direction_list;

/* ---- *USER ELEMENT: what the rows are ------------------------------------ */

static ritz_status take_element_parameter(ritz_user_element *e,
                                          ritz_comma_field field, bool *linear)
{
    const ritz_comma_field value = ritz_abaqus_value(&field);

    if (ritz_abaqus_spells(&field, "NODES"))
        return ritz_abaqus_whole(&value, &e->num_nodes);
    if (ritz_abaqus_spells(&field, "LINEAR")) {
        *linear = true;
        return RITZ_OK;
    }
    if (ritz_abaqus_spells(&field, "TYPE") ||
        ritz_abaqus_spells(&field, "COORDINATES"))
        return RITZ_OK; /* nothing of rows */
    RITZ_REFUSE_IF(ritz_abaqus_spells(&field, "UNSYM") ||
                       ritz_abaqus_spells(&field, "UNSYMM"),
                   RITZ_ERR_FORMAT,
                   "an unsymmetric element is not read: is UNSYMM=YES needed "
                   "in its *STEP?");
    return ritz_fail(RITZ_ERR_FORMAT, "'%.*s' of *USER ELEMENT is not read",
                     ritz_abaqus_quoted(&field), field.at);
}

static ritz_status read_element_keyword(ritz_user_element *e, const char *at)
{
    ritz_comma_field field = {0};
    bool linear = false;

    e->num_nodes = 0;
    while (ritz_abaqus_field(&at, e->text.line_end, &field))
        RITZ_CHECK(take_element_parameter(e, field, &linear));
    RITZ_REFUSE_IF(!linear, RITZ_ERR_FORMAT,
                   "a *USER ELEMENT that is not LINEAR has no matrices");
    RITZ_REFUSE_IF(e->num_nodes < 1, RITZ_ERR_FORMAT,
                   "*USER ELEMENT does not say how many NODES it has");
    return RITZ_OK;
}

/* Append the nodes that are listed in one comment line. */
static ritz_status take_nodes(ritz_user_element *e)
{
    const char *at = e->text.line + 2; /* behind the stars */
    ritz_comma_field field = {0};
    int64_t node = 0;

    while (ritz_abaqus_field(&at, e->text.line_end, &field)) {
        RITZ_REFUSE_IF(e->num_named == e->num_nodes, RITZ_ERR_FORMAT,
                       "more nodes than the %" PRId64 " of *USER ELEMENT",
                       e->num_nodes);
        RITZ_CHECK(ritz_abaqus_whole(&field, &node));
        RITZ_CHECK(ritz_abaqus_check_node(node));
        RITZ_CHECK_ROOM(e->node, e->num_named, e->nodes_room);
        e->node[e->num_named++] = node;
    }
    return RITZ_OK;
}

/* Whether a comment is "ELEMENT NODES", after which the nodes are listed. */
static bool is_title_of_nodes(const ritz_lines *text)
{
    const ritz_comma_field title = {text->line + 2, text->line_end};

    return ritz_abaqus_spells(&title, "ELEMENT NODES");
}

/* Read the nodes, which CalculiX lists in comments only. */
static ritz_status read_nodes(ritz_user_element *e)
{
    bool found = false;
    bool more = false;

    e->num_named = 0;
    do {
        more = ritz_abaqus_next(&e->text) && ritz_abaqus_is_comment(&e->text);
        found = more && is_title_of_nodes(&e->text);
    } while (more && !found);
    RITZ_REFUSE_IF(!found, RITZ_ERR_FORMAT,
                   "no comment '** ELEMENT NODES' follows *USER ELEMENT: "
                   "nothing says which nodes its rows are of");
    while (e->num_named < e->num_nodes) {
        RITZ_REFUSE_IF(!ritz_abaqus_next(&e->text) ||
                           !ritz_abaqus_is_comment(&e->text),
                       RITZ_ERR_FORMAT,
                       "the comment names %" PRId64 " of %" PRId64 " nodes",
                       e->num_named, e->num_nodes);
        RITZ_CHECK(take_nodes(e));
    }
    return RITZ_OK;
}

static ritz_status take_directions(const char *at, const char *end,
                                   ritz_direction_list *list)
{
    ritz_comma_field field = {0};

    list->count = 0;
    while (ritz_abaqus_field(&at, end, &field)) {
        RITZ_REFUSE_IF(list->count == DIRECTIONS, RITZ_ERR_FORMAT,
                       "more than six degrees of freedom of a node");
        RITZ_CHECK(ritz_abaqus_whole(&field, &list->at[list->count]));
        RITZ_CHECK(ritz_abaqus_check_direction(list->at[list->count]));
        list->count++;
    }
    RITZ_REFUSE_IF(list->count == 0, RITZ_ERR_FORMAT,
                   "no degree of freedom follows the place of a node");
    return RITZ_OK;
}

/* The rows of the nodes from list->from to the one before `to`. */
static ritz_status add_rows(ritz_user_element *e,
                            const ritz_direction_list *list, int64_t to)
{
    for (int64_t p = list->from; p < to; p++)
        for (int k = 0; k < list->count; k++) {
            RITZ_CHECK_ROOM(e->dof, e->num_dofs, e->dofs_room);
            e->dof[e->num_dofs++] =
                (ritz_dof){.grid = e->node[p - 1], .component = list->at[k]};
        }
    return RITZ_OK;
}

static ritz_status check_distinct_rows(const ritz_user_element *e)
{
    RITZ_OWN_ARRAY ritz_dof *sorted = NULL;
    char name[RITZ_DOF_NAME_SIZE];

    RITZ_CHECK_COPY(sorted, e->dof, e->num_dofs);
    qsort(sorted, (size_t)e->num_dofs, sizeof *sorted, ritz_dof_compare);
    for (int64_t k = 1; k < e->num_dofs; k++)
        RITZ_REFUSE_IF(ritz_dof_compare(&sorted[k - 1], &sorted[k]) == 0,
                       RITZ_ERR_FORMAT, "'%s' is named twice",
                       ritz_dof_name(sorted[k], name));
    return RITZ_OK;
}

/* Lines of directions: those of the first node, then "place, directions". */
static ritz_status read_directions(ritz_user_element *e)
{
    ritz_direction_list list = {.from = 1};
    ritz_comma_field field = {0};

    e->num_dofs = 0;
    RITZ_REFUSE_IF(!ritz_abaqus_next_data(&e->text), RITZ_ERR_FORMAT,
                   "no degrees of freedom follow *USER ELEMENT");
    RITZ_CHECK(take_directions(e->text.line, e->text.line_end, &list));
    while (ritz_abaqus_next_data(&e->text)) {
        const char *at = e->text.line;
        int64_t from = 0;

        (void)ritz_abaqus_field(&at, e->text.line_end, &field); /* is there */
        RITZ_CHECK(ritz_abaqus_whole(&field, &from));
        RITZ_REFUSE_IF(from <= list.from || from > e->num_nodes,
                       RITZ_ERR_FORMAT,
                       "place %" PRId64 " among %" PRId64
                       " nodes does not follow place %" PRId64,
                       from, e->num_nodes, list.from);
        RITZ_CHECK(add_rows(e, &list, from));
        list.from = from;
        RITZ_CHECK(take_directions(at, e->text.line_end, &list));
    }
    RITZ_CHECK(add_rows(e, &list, e->num_nodes + 1));
    return check_distinct_rows(e);
}

static ritz_status read_element(ritz_user_element *e, const char *at)
{
    RITZ_CHECK(read_element_keyword(e, at));
    RITZ_CHECK(read_nodes(e));
    return read_directions(e);
}

/* ---- *MATRIX: its numbers ------------------------------------------------ */

/* Numbers of row i from column j on, as many as a line has. They are put above
 * the diagonal, where columns come in order. */
static ritz_status read_numbers(ritz_user_element *e, int64_t i, int64_t j,
                                int64_t *digits, ritz_triplets *list)
{
    const int64_t left = i + 1 - j;
    const int64_t due = left < LINE_NUMBERS ? left : LINE_NUMBERS;
    ritz_comma_field field = {0};
    char name[RITZ_DOF_NAME_SIZE];
    const char *at = NULL;
    double value = 0.0;
    int64_t count = 0;

    RITZ_REFUSE_IF(!ritz_abaqus_next_data(&e->text), RITZ_ERR_FORMAT,
                   "the matrix ends before row %" PRId64 " of %" PRId64
                   ", '%s', is complete",
                   i + 1, e->num_dofs, ritz_dof_name(e->dof[i], name));
    RITZ_CHECK(ritz_triplets_reserve(list, due));
    at = e->text.line;
    for (; ritz_abaqus_field(&at, e->text.line_end, &field); count++) {
        if (count >= due)
            continue;
        RITZ_CHECK(ritz_abaqus_real(&field, digits, &value));
        ritz_triplets_put_value(list, j + count, i, value, 0.0);
    }
    RITZ_REFUSE_IF(count != due, RITZ_ERR_FORMAT,
                   "the count of numbers on a line of row %" PRId64
                   ", '%s', is %" PRId64 " instead of %" PRId64,
                   i + 1, ritz_dof_name(e->dof[i], name), count, due);
    return RITZ_OK;
}

static ritz_status read_values(ritz_user_element *e, const char *name,
                               ritz_matrix *out)
{
    const int64_t n = e->num_dofs;
    RITZ_OWN(ritz_matrix) new = {.symmetric = true};
    RITZ_OWN(ritz_triplets) list = {0};
    int64_t digits = 1;

    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j <= i; j += LINE_NUMBERS)
            RITZ_CHECK(read_numbers(e, i, j, &digits, &list));
    RITZ_REFUSE_IF(
        ritz_abaqus_next_data(&e->text), RITZ_ERR_FORMAT,
        "more numbers than the lower triangle of %" PRId64 " rows has", n);
    RITZ_CHECK(ritz_triplets_compress(&list, n, n, &new));
    RITZ_CHECK(ritz_matrix_mirror(&new, 1.0, 1.0));
    RITZ_CHECK_COPY(new.row, e->dof, n);
    snprintf(new.name, sizeof new.name, "%s", name);
    snprintf(new.spelling, sizeof new.spelling, "USER ELEMENT");
    new.digits = digits > 17 ? 17 : digits;
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

/* The name of a matrix is its TYPE. */
static ritz_status read_matrix_keyword(const ritz_user_element *e,
                                       const char *at,
                                       char name[RITZ_NAME_SIZE])
{
    ritz_comma_field field = {0};

    name[0] = '\0';
    while (ritz_abaqus_field(&at, e->text.line_end, &field)) {
        const ritz_comma_field value = ritz_abaqus_value(&field);

        RITZ_REFUSE_IF(ritz_abaqus_spells(&field, "INPUT"), RITZ_ERR_FORMAT,
                       "the numbers are in another file, '%.*s'",
                       ritz_abaqus_quoted(&value), value.at);
        RITZ_REFUSE_IF(!ritz_abaqus_spells(&field, "TYPE"), RITZ_ERR_FORMAT,
                       "'%.*s' of *MATRIX is not read",
                       ritz_abaqus_quoted(&field), field.at);
        RITZ_REFUSE_IF(!ritz_abaqus_spells(&value, "STIFFNESS") &&
                           !ritz_abaqus_spells(&value, "MASS"),
                       RITZ_ERR_FORMAT,
                       "TYPE of *MATRIX is neither STIFFNESS nor MASS but "
                       "'%.*s'",
                       ritz_abaqus_quoted(&value), value.at);
        RITZ_CHECK(ritz_abaqus_name(&value, name));
    }
    RITZ_REFUSE_IF(!name[0], RITZ_ERR_FORMAT, "*MATRIX has no TYPE");
    for (char *c = name; *c; c++)
        *c = (char)toupper((unsigned char)*c);
    return RITZ_OK;
}

/* List a matrix, or read it if it is the one wanted. */
static ritz_status take_matrix(ritz_user_element *e, const char *at,
                               ritz_listing *listing, ritz_matrix *out)
{
    ritz_listed item = {.nrow = e->num_dofs,
                        .ncol = e->num_dofs,
                        .symmetric = true,
                        .at = e->text.number};

    RITZ_REFUSE_IF(e->num_dofs == 0, RITZ_ERR_FORMAT,
                   "*MATRIX comes before *USER ELEMENT");
    RITZ_CHECK(read_matrix_keyword(e, at, item.name));
    e->found = item.at == e->wanted;
    if (e->found)
        return read_values(e, item.name, out);
    while (ritz_abaqus_next_data(&e->text))
        continue;
    return listing ? ritz_listing_add(listing, &item) : RITZ_OK;
}

/* ---- the format ---------------------------------------------------------- */

/* All matrices of the file for its list, or those up to the one wanted. */
static ritz_status read_file(ritz_user_element *e, ritz_listing *listing,
                             ritz_matrix *out)
{
    while (!e->found && ritz_abaqus_next_stated(&e->text)) {
        const char *at = e->text.line + 1; /* behind the star */
        ritz_comma_field field = {at, at};

        RITZ_REFUSE_IF(!ritz_abaqus_is_keyword(&e->text), RITZ_ERR_FORMAT,
                       "'%.*s' follows no keyword",
                       ritz_lines_quoted(e->text.line, e->text.line_end),
                       e->text.line);
        (void)ritz_abaqus_field(&at, e->text.line_end, &field);
        if (ritz_abaqus_spells(&field, "USER ELEMENT"))
            RITZ_CHECK(read_element(e, at));
        else if (ritz_abaqus_spells(&field, "MATRIX"))
            RITZ_CHECK(take_matrix(e, at, listing, out));
        else
            return ritz_fail(RITZ_ERR_FORMAT,
                             "'*%.*s' is neither *USER ELEMENT nor *MATRIX",
                             ritz_abaqus_quoted(&field), field.at);
    }
    RITZ_REFUSE_IF(listing && listing->count == 0, RITZ_ERR_FORMAT,
                   "no *MATRIX follows *USER ELEMENT");
    return RITZ_OK;
}

static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    RITZ_OWN(ritz_user_element)
    e = {.text = ritz_abaqus_lines(file->bytes, file->size)};
    ritz_status status = read_file(&e, out, NULL);

    return ritz_abaqus_in_line(status, e.text.number);
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    RITZ_OWN(ritz_user_element)
    e = {.text = ritz_abaqus_lines(file->bytes, file->size),
         .wanted = which->at};
    ritz_status status = read_file(&e, NULL, out);

    RITZ_CHECK(ritz_abaqus_in_line(status, e.text.number));
    RITZ_REFUSE_IF(!e.found, RITZ_ERR_FORMAT,
                   "the matrix '%s' is no longer there", which->name);
    return RITZ_OK;
}

/* The first line that is no comment is *USER ELEMENT with LINEAR. */
static bool recognise_element(const char *bytes, int64_t size)
{
    ritz_lines text = ritz_abaqus_lines(bytes, size);
    ritz_comma_field field = {0};
    const char *at = NULL;
    bool linear = false;

    if (!ritz_abaqus_next_stated(&text) || !ritz_abaqus_is_keyword(&text))
        return false;
    at = text.line + 1;
    if (!ritz_abaqus_field(&at, text.line_end, &field) ||
        !ritz_abaqus_spells(&field, "USER ELEMENT"))
        return false;
    while (!linear && ritz_abaqus_field(&at, text.line_end, &field))
        linear = ritz_abaqus_spells(&field, "LINEAR");
    return linear;
}

const ritz_format ritz_format_user_element = {
    .name = "user-element",
    .summary = "substructures of Abaqus and CalculiX, as USER ELEMENT",
    .reference = "Abaqus2016",
    .recognise = recognise_element,
    .maps = true,
    .list = list_file,
    .read = read_matrix,
};
