/*
 * The coded database of ANSYS, which CDWRITE makes [Ansys2024]: nodes with
 * their axes, elements and supports. Blocks have a line of Fortran's format
 * and then lines of fixed fields, of which those at the end may be missing:
 *
 *     NBLOCK,6,SOLID                          EBLOCK,19,SOLID
 *     (3i9,6e21.13e3)                         (19i9)
 *     NODE KEY KEY X Y Z THXY THYZ THZX       MAT TYPE REAL SEC ESYS DEATH SOLID
 *                                             SHAPE NODES - ELEMENT NODE ...
 *     N,R5.3,LOC,-1,                          -1
 *
 * A line whose first field is -1 ends a block. EBLOCK without SOLID has the
 * fields ELEMENT TYPE REAL MAT ESYS NODE ..., and the command TYPE,N before it
 * states the element type.
 *
 * Macros are not evaluated: commands that generate or change nodes or elements
 * are refused by name. Commands that are not known are ignored.
 */
#include "formats/cdb_lines.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum {
    MOST_TYPES = 10000, /* element types in a file */
    MOST_NODES = 64,    /* of an element */
    SOLID_FIELDS = 11,  /* before the nodes of an element, EBLOCK,,SOLID */
    PLAIN_FIELDS = 5,   /* before the nodes of an element, other EBLOCK */
};

/* ---- nodes --------------------------------------------------------------- */

static ritz_status add_node(ritz_cdb *all, const ritz_cdb_node *node)
{
    if (node->id < 1)
        return ritz_cdb_refuse(all, node->line,
                               "%" PRId64 " is not a node number", node->id);
    RITZ_CHECK_ROOM(all->node, all->num_nodes, all->nodes_room);
    all->node[all->num_nodes++] = *node;
    return RITZ_OK;
}

/* Read coordinate k (0 to 2) or angle k - 3 of a node. */
static ritz_status take_real_field(const ritz_cdb *all,
                                   const ritz_cdb_form *form, ritz_piece line,
                                   int64_t k, ritz_cdb_node *node)
{
    const ritz_piece field = ritz_cdb_cut_field(
        line, form->wholes * form->whole_width + k * form->real_width,
        form->real_width);
    double *to = k < 3 ? &node->x[k] : &node->angle[k - 3];

    if (!ritz_cdb_read_real(field, to))
        return ritz_cdb_refuse(all, node->line, "'%.*s' is not a number",
                               RITZ_CDB_QUOTED(field));
    return RITZ_OK;
}

static ritz_status take_nodes(ritz_cdb *all, const ritz_cdb_command *command)
{
    enum { REALS = 6 }; /* X Y Z THXY THYZ THZX */
    ritz_cdb_form form = {0};
    ritz_piece line = {"", 0};
    ritz_cdb_node node = {0};
    int64_t whole[RITZ_CDB_MOST_FIELDS], count = 0;

    RITZ_CHECK(ritz_cdb_take_form(all, command, true, &form));
    while (ritz_cdb_take_line(all, &line, &node.line)) {
        if (ritz_cdb_ends_block(line))
            return RITZ_OK;
        RITZ_CHECK(
            ritz_cdb_take_wholes(all, &form, line, node.line, whole, &count));
        node.id = whole[0];
        for (int64_t k = 0; k < form.reals && k < REALS; k++)
            RITZ_CHECK(take_real_field(all, &form, line, k, &node));
        RITZ_CHECK(add_node(all, &node));
    }
    return ritz_cdb_refuse(all, command->line, "'NBLOCK' has no end");
}

/* N has one of the forms
   N,R5.3,LOC,NODE,X,Y,Z   N,R5.3,ANG,NODE,THXY,THYZ,THZX   N,NODE,X,Y,Z,THXY,..
 */
static ritz_status take_node(ritz_cdb *all, const ritz_cdb_command *command)
{
    const ritz_piece form = ritz_cdb_field(command, 1);
    const bool coded = form.length > 0 && ritz_card_upper(form.text[0]) == 'R';
    const bool angles =
        coded && ritz_cdb_is_word(ritz_cdb_field(command, 2), "ANG");
    const int64_t first = coded ? 3 : 1;
    ritz_cdb_node node = {.line = command->line};

    RITZ_CHECK(ritz_cdb_take_whole(all, command, first, &node.id));
    if (node.id == -1)
        return RITZ_OK;
    if (all->turned && !coded)
        return ritz_cdb_refuse(all, command->line,
                               "'N' after CSYS, along other axes, is not read: "
                               "let ANSYS write the model by CDWRITE");
    if (angles &&
        (all->num_nodes == 0 || all->node[all->num_nodes - 1].id != node.id))
        return ritz_cdb_refuse(
            all, command->line,
            "angles of node %" PRId64 " do not follow its position", node.id);
    for (int64_t k = 0; k < 3; k++) {
        RITZ_CHECK(ritz_cdb_take_real(all, command, first + 1 + k,
                                      angles ? &node.angle[k] : &node.x[k]));
        if (!coded)
            RITZ_CHECK(ritz_cdb_take_real(all, command, first + 4 + k,
                                          &node.angle[k]));
    }
    if (!angles)
        return add_node(all, &node);
    memcpy(all->node[all->num_nodes - 1].angle, node.angle, sizeof node.angle);
    return RITZ_OK;
}

/* ---- elements ------------------------------------------------------------ */

static ritz_status take_type(ritz_cdb *all, const ritz_cdb_command *command)
{
    ritz_cdb_type type = {.kind =
                              ritz_cdb_find_kind(ritz_cdb_field(command, 2))};
    ritz_cdb_type *there = NULL;
    int64_t at = 0;

    RITZ_CHECK(ritz_cdb_take_whole(all, command, 1, &type.number));
    there = ritz_cdb_find_type(all, type.number);
    if (there) {
        *there = type;
        return RITZ_OK;
    }
    if (all->num_types == MOST_TYPES)
        return ritz_cdb_refuse(all, command->line,
                               "there are more than %d element types",
                               (int)MOST_TYPES);
    at = ritz_cdb_seek_type(all, type.number);
    RITZ_CHECK_ROOM(all->type, all->num_types, all->types_room);
    memmove(all->type + at + 1, all->type + at,
            (size_t)(all->num_types++ - at) * sizeof *all->type);
    all->type[at] = type;
    return RITZ_OK;
}

/* KEYOPT,TYPE,3,VALUE chooses the directions that nodes of some elements have.
   Other options are ignored. */
static ritz_status take_option(ritz_cdb *all, const ritz_cdb_command *command)
{
    int64_t number = 0, which = 0, value = 0;
    ritz_cdb_type *type = NULL;

    if (!ritz_cdb_read_whole(ritz_cdb_field(command, 1), &number) ||
        !ritz_cdb_read_whole(ritz_cdb_field(command, 2), &which) ||
        which != 3 || !ritz_cdb_read_whole(ritz_cdb_field(command, 3), &value))
        return RITZ_OK;
    type = ritz_cdb_find_type(all, number);
    if (type)
        type->option_3 = value;
    return RITZ_OK;
}

static ritz_status take_open_type(ritz_cdb *all,
                                  const ritz_cdb_command *command)
{
    return ritz_cdb_take_whole(all, command, 1, &all->open_type);
}

static ritz_status add_joined(ritz_cdb *all, int64_t node)
{
    if (node < 0)
        return ritz_cdb_refuse(all, all->element[all->num_elements - 1].line,
                               "%" PRId64 " is not a node number", node);
    RITZ_CHECK_ROOM(all->joined, all->num_joined, all->joined_room);
    all->joined[all->num_joined++] = node;
    all->element[all->num_elements - 1].count++;
    return RITZ_OK;
}

/* Add an element whose first nodes are whole[from] to whole[to - 1]. */
static ritz_status begin_element(ritz_cdb *all, int64_t type, int64_t line,
                                 const int64_t *whole, int64_t from, int64_t to)
{
    const int64_t number = from == SOLID_FIELDS ? from - 1 : 0;

    RITZ_CHECK_ROOM(all->element, all->num_elements, all->elements_room);
    all->element[all->num_elements++] = (ritz_cdb_element){
        .id = number < to && whole[number] > 0 ? whole[number] : 0,
        .type = type,
        .first = all->num_joined,
        .line = line};
    for (int64_t k = from; k < to; k++)
        RITZ_CHECK(add_joined(all, whole[k]));
    return RITZ_OK;
}

/* Read the `due` nodes that the last element lacks from the next lines. */
static ritz_status continue_element(ritz_cdb *all, const ritz_cdb_form *form,
                                    int64_t due)
{
    const int64_t begun = all->element[all->num_elements - 1].line;
    int64_t whole[RITZ_CDB_MOST_FIELDS], count = 0, line = 0;
    ritz_piece text = {"", 0};

    while (due > 0) {
        if (!ritz_cdb_take_line(all, &text, &line))
            return ritz_cdb_refuse(all, begun,
                                   "nodes of this element are missing");
        RITZ_CHECK(ritz_cdb_take_wholes(all, form, text, line, whole, &count));
        if (count == 0)
            return ritz_cdb_refuse(all, line,
                                   "nodes of the element above are missing");
        for (int64_t k = 0; k < count && due > 0; k++, due--)
            RITZ_CHECK(add_joined(all, whole[k]));
    }
    return RITZ_OK;
}

static ritz_status take_solid(ritz_cdb *all, const ritz_cdb_form *form,
                              const int64_t *whole, int64_t count, int64_t line)
{
    const int64_t nodes = count > 8 ? whole[8] : 0;
    const int64_t here = count - SOLID_FIELDS;

    if (count < SOLID_FIELDS || nodes < 0 || nodes > MOST_NODES)
        return ritz_cdb_refuse(all, line,
                               "an element has %" PRId64 " fields and %" PRId64
                               " nodes: at least %d fields and at most %d "
                               "nodes are read",
                               count, nodes, (int)SOLID_FIELDS,
                               (int)MOST_NODES);
    RITZ_CHECK(begin_element(all, whole[1], line, whole, SOLID_FIELDS,
                             SOLID_FIELDS + (here < nodes ? here : nodes)));
    return continue_element(all, form, nodes - here);
}

static ritz_status take_elements(ritz_cdb *all, const ritz_cdb_command *command)
{
    const bool solid = ritz_cdb_is_word(ritz_cdb_field(command, 2), "SOLID");
    int64_t whole[RITZ_CDB_MOST_FIELDS], count = 0, line = 0;
    ritz_piece text = {"", 0};
    ritz_cdb_form form = {0};

    RITZ_CHECK(ritz_cdb_take_form(all, command, false, &form));
    while (ritz_cdb_take_line(all, &text, &line)) {
        if (ritz_cdb_ends_block(text))
            return RITZ_OK;
        RITZ_CHECK(ritz_cdb_take_wholes(all, &form, text, line, whole, &count));
        RITZ_CHECK(solid ? take_solid(all, &form, whole, count, line)
                         : begin_element(all, all->open_type, line, whole,
                                         PLAIN_FIELDS, count));
    }
    return ritz_cdb_refuse(all, command->line, "'EBLOCK' has no end");
}

/* EN and E define single elements. These are counted, but not read.
   EN,R5.5,ATTR,-1 ends a block and defines none. */
static ritz_status count_element(ritz_cdb *all, const ritz_cdb_command *command)
{
    const bool attributes =
        ritz_cdb_is_word(ritz_cdb_field(command, 2), "ATTR");
    int64_t nodes = 0;

    if (attributes && ritz_cdb_read_whole(ritz_cdb_field(command, 3), &nodes) &&
        nodes == -1)
        return RITZ_OK;
    all->num_strange += attributes || ritz_cdb_is_word(command->field[0], "E");
    return RITZ_OK;
}

/* ---- supports and constraints -------------------------------------------- */

/* The bits of the directions that a label names; 0 if it names none. */
static uint8_t mask_of(ritz_piece label)
{
    static const char *const names[] = {"UX",   "UY",   "UZ",
                                        "ROTX", "ROTY", "ROTZ"};

    for (unsigned k = 0; k < sizeof names / sizeof *names; k++)
        if (ritz_cdb_is_word(label, names[k]))
            return (uint8_t)(1U << (k + 1));
    return ritz_cdb_is_word(label, "ALL") ? 0x7e : 0;
}

/* D,NODE,LABEL,VALUE,VALUE2,LAST,STEP,LABEL,..., where NODE may be ALL. */
static ritz_status take_support(ritz_cdb *all, const ritz_cdb_command *command)
{
    enum { VALUE = 3, LAST = 5, LABELS = 7, MOST_LABELS = 5 };
    const bool everywhere = ritz_cdb_is_word(ritz_cdb_field(command, 1), "ALL");
    ritz_cdb_support support = {.line = command->line};
    double value = 0.0;

    support.mask = mask_of(ritz_cdb_field(command, 2));
    for (int64_t k = LABELS; k < LABELS + MOST_LABELS; k++)
        support.mask |= mask_of(ritz_cdb_field(command, k));
    if (support.mask == 0)
        return RITZ_OK;
    if (ritz_cdb_field(command, LAST).length > 0 || (everywhere && all->chosen))
        return ritz_cdb_refuse(all, command->line,
                               "'D' holds nodes of a range or selection, which "
                               "is not read: write the model by CDWRITE");
    if (!everywhere)
        RITZ_CHECK(ritz_cdb_take_whole(all, command, 1, &support.node));
    support.imposed =
        !ritz_cdb_read_real(ritz_cdb_field(command, VALUE), &value) ||
        value != 0.0;
    RITZ_CHECK_ROOM(all->support, all->num_supports, all->supports_room);
    all->support[all->num_supports++] = support;
    return RITZ_OK;
}

static ritz_status take_tie(ritz_cdb *all, const ritz_cdb_command *command)
{
    ritz_cdb_tie tie = {.line = command->line};

    snprintf(tie.name, sizeof tie.name, "%.*s %" PRId64,
             RITZ_CDB_QUOTED(command->field[0]), all->num_ties + 1);
    RITZ_CHECK_ROOM(all->tie, all->num_ties, all->ties_room);
    all->tie[all->num_ties++] = tie;
    return RITZ_OK;
}

/* ---- commands ------------------------------------------------------------ */

/* CSYS,N activates coordinate system N, of which 0 is the global one. LOCAL,
   CLOCAL, CS and CSKP activate the system that they define. */
static ritz_status take_system(ritz_cdb *all, const ritz_cdb_command *command)
{
    int64_t number = 0;

    all->turned = !ritz_cdb_is_word(command->field[0], "CSYS") ||
                  !ritz_cdb_read_whole(ritz_cdb_field(command, 1), &number) ||
                  number != 0;
    return RITZ_OK;
}

/* NSEL,ALL and ALLSEL select all nodes; the other commands select some. */
static ritz_status choose_nodes(ritz_cdb *all, const ritz_cdb_command *command)
{
    const ritz_piece what = ritz_cdb_field(command, 1);
    const bool whole = ritz_cdb_is_word(command->field[0], "ALLSEL");

    all->chosen =
        ritz_cdb_is_word(command->field[0], "CMSEL") ||
        !(ritz_cdb_is_word(what, "ALL") || (whole && what.length == 0));
    return RITZ_OK;
}

/* *IF,...,THEN begins a condition and *ENDIF ends it. */
static ritz_status take_condition(ritz_cdb *all,
                                  const ritz_cdb_command *command)
{
    if (ritz_cdb_is_word(command->field[0], "*IF"))
        all->conditions +=
            ritz_cdb_is_word(command->field[command->count - 1], "THEN");
    else
        all->conditions -= all->conditions > 0;
    return RITZ_OK;
}

/* The name of a command, and the function that reads it. */
typedef struct cdb_verb {
    const char *name;
    ritz_status (*take)(ritz_cdb *all, const ritz_cdb_command *command);
    bool adds; /* it adds nodes, elements, supports or constraints, which is
                  refused within *IF */
} cdb_verb;

static const cdb_verb verbs[] = {
    {"NBLOCK", take_nodes, true},
    {"N", take_node, true},
    {"EBLOCK", take_elements, true},
    {"ET", take_type, false},
    {"KEYOPT", take_option, false},
    {"KEYOP", take_option, false},
    {"TYPE", take_open_type, false},
    {"EN", count_element, true},
    {"E", count_element, true},
    {"D", take_support, true},
    {"CE", take_tie, true},
    {"CP", take_tie, true},
    {"CERIG", take_tie, true},
    {"RBE3", take_tie, true},
    {"CEINTF", take_tie, true},
    {"CSYS", take_system, false},
    {"LOCAL", take_system, false},
    {"CLOCAL", take_system, false},
    {"CS", take_system, false},
    {"CSKP", take_system, false},
    {"NSEL", choose_nodes, false},
    {"CMSEL", choose_nodes, false},
    {"NSLE", choose_nodes, false},
    {"NSLA", choose_nodes, false},
    {"NSLL", choose_nodes, false},
    {"NSLK", choose_nodes, false},
    {"ALLSEL", choose_nodes, false},
    {"*IF", take_condition, false},
    {"*ENDIF", take_condition, false},
};

/* Commands that are refused, as they change the model or read other files. */
static const char *const refused[] = {
    "NGEN",    "FILL",     "NDELE",  "EDELE",  "EMODIF", "DSYM",    "*DOWHILE",
    "*CREATE", "/EOF",     "EGEN",   "NROTAT", "NMODIF", "NSYM",    "ESYM",
    "NSCALE",  "TRANSFER", "NUMMRG", "NUMCMP", "*DO",    "*REPEAT", "*USE",
    "/INPUT",  "CDREAD",   "VMESH",  "AMESH",  "LMESH",  "DDELE"};

static ritz_status take_command(ritz_cdb *all, const ritz_cdb_command *command)
{
    const ritz_piece name = command->field[0];

    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++)
        if (ritz_cdb_is_word(name, refused[k]))
            return ritz_cdb_refuse(all, command->line,
                                   "'%s' changes the model, and Ritz does not "
                                   "evaluate it: let ANSYS write the model by "
                                   "CDWRITE",
                                   refused[k]);
    for (size_t k = 0; k < sizeof verbs / sizeof *verbs; k++) {
        if (!ritz_cdb_is_word(name, verbs[k].name))
            continue;
        if (verbs[k].adds && all->conditions > 0)
            return ritz_cdb_refuse(all, command->line,
                                   "'%s' stands behind '*IF', which is not "
                                   "evaluated: write the model by CDWRITE",
                                   verbs[k].name);
        return verbs[k].take(all, command);
    }
    return RITZ_OK;
}

static void cdb_free(ritz_cdb *all)
{
    RITZ_FREE(all->node, all->type, all->element, all->joined, all->support,
              all->tie);
    ritz_deck_reading_free(&all->reading);
    ritz_deck_files_free(&all->files);
}

static ritz_status parse_cdb(const char *path, const char *bytes, int64_t size,
                             const char *folder, ritz_deck *out)
{
    [[gnu::cleanup(cdb_free)]] ritz_cdb all = {0};
    ritz_piece line = {"", 0};
    int64_t number = 0;

    all.reading.files = &all.files;
    RITZ_CHECK(ritz_deck_begin(&all.reading, path, bytes, size, folder));
    while (ritz_cdb_take_line(&all, &line, &number)) {
        const ritz_piece text = ritz_piece_trim(line);
        ritz_cdb_command command = {0};

        if (text.length == 0 || text.text[0] == '!' || text.text[0] == '(')
            continue;
        ritz_cdb_split_command(text, number, &command);
        RITZ_CHECK(take_command(&all, &command));
    }
    return ritz_cdb_build(&all, out);
}

static bool is_one_of(ritz_piece text, const char *const *words)
{
    while (*words && !ritz_cdb_is_word(text, *words))
        words++;
    return *words != NULL;
}

/* A line near the beginning is a command that only such files have. In a deck
   of Abaqus it could be a line of a heading or the name of a set. */
static bool is_cdb(const char *bytes, int64_t size)
{
    static const char *const own[] = {"/PREP7", "/COM",   "/BATCH",
                                      "NBLOCK", "EBLOCK", NULL};
    static const char *const foreign[] = {"*HEADING", "*NODE",    "*PART",
                                          "*INCLUDE", "*ELEMENT", NULL};
    enum { LINES = 200 };
    ritz_lines text = {.at = bytes, .end = bytes + size};

    while (text.number < LINES && ritz_lines_next(&text)) {
        ritz_cdb_command command = {0};

        ritz_cdb_split_command(
            ritz_piece_trim((ritz_piece){text.line, text.line_end - text.line}),
            0, &command);
        if (is_one_of(command.field[0], own))
            return true;
        if (is_one_of(command.field[0], foreign))
            return false;
    }
    return false;
}

const ritz_deck_format ritz_deck_cdb = {
    .name = "cdb",
    .title = "coded database of ANSYS",
    .reference = "Ansys2024",
    .recognise = is_cdb,
    .parse = parse_cdb,
};
