/*
 * Input files of Abaqus and CalculiX: what their keywords mean for rows.
 *
 * Nodes, elements, sets of nodes, supports and equations are read. Keywords
 * that change what rows are, and are not understood, are refused by name; ties
 * and the like are kept as constraints, which fail an import only if matrices
 * still have their dofs. All other keywords are passed over.
 *
 * The two programs number the rows of shells and beams differently. A deck
 * belongs to Abaqus if it generates matrices or has parts, which CalculiX does
 * not know, and to CalculiX if it says SOLVER=MATRIXSTORAGE.
 *
 * [Abaqus2016], [Dhondt2022]
 */
#include "formats/inp.h"
#include "base/alloc.h"

#include <ctype.h>
#include <inttypes.h>
#include <string.h>

/* A keyword, and how the lines that it begins are read. */
typedef struct inp_kind {
    const char *name;
    ritz_status (*begin)(ritz_inp *all, const struct inp_kind *kind);
    const char *why; /* it is refused */
} inp_kind;

/* Nodes and elements must be of one part or instance, or of none: those of
   others may have the same numbers. */
static ritz_status check_container(ritz_inp *all)
{
    if (all->home.number < 0)
        all->home = all->open;
    if (all->home.number != all->open.number)
        return ritz_inp_refuse(all, all->keyword.place,
                               "'*%.*s' of a second part, instance or "
                               "assembly: only one may have nodes and "
                               "elements, since their numbers repeat",
                               RITZ_INP_QUOTED(all->keyword.name));
    return RITZ_OK;
}

/* ---- nodes and elements -------------------------------------------------- */

/* ID, X, Y, Z; what follows are directions of normals. */
static ritz_status take_node(ritz_inp *all)
{
    ritz_inp_node node = {.order = all->num_nodes, .place = all->fields.place};

    RITZ_CHECK(ritz_inp_id(all, 0, &node.id));
    for (int64_t i = 0; i < 3; i++)
        RITZ_CHECK(ritz_inp_real(all, i + 1, &node.x[i]));
    if (all->unordered.line == 0 && all->num_nodes > 0 &&
        node.id < all->node[all->num_nodes - 1].id)
        all->unordered = node.place;
    RITZ_CHECK_ROOM(all->node, all->num_nodes, all->nodes_room);
    all->node[all->num_nodes++] = node;
    if (all->into >= 0)
        RITZ_CHECK(ritz_inp_add_range(all, all->into, node.id, node.id, 1));
    return RITZ_OK;
}

static ritz_status begin_nodes(ritz_inp *all, const inp_kind *kind)
{
    const ritz_piece *set = ritz_inp_parameter(&all->keyword, "NSET");
    const ritz_piece *system = ritz_inp_parameter(&all->keyword, "SYSTEM");

    (void)kind;
    if (system && !ritz_inp_is(*system, "R"))
        return ritz_inp_refuse(all, all->keyword.place,
                               "'*NODE' with SYSTEM is not read unless it is "
                               "R: coordinates must be rectangular");
    RITZ_CHECK(check_container(all));
    if (set)
        RITZ_CHECK(ritz_inp_open_set(all, *set, &all->into));
    all->take = take_node;
    return ritz_inp_follow(all);
}

static int64_t count_joined(const ritz_inp *all)
{
    return all->num_joined - all->element[all->num_elements - 1].first;
}

/* ID, then nodes, on as many lines as they take. What follows the nodes of a
   beam is the node that its axes point to. */
static ritz_status take_element(ritz_inp *all)
{
    for (int64_t k = 0; k < all->fields.count; k++) {
        int64_t id = 0;

        RITZ_CHECK(ritz_inp_id(all, k, &id));
        if (all->begun == 0) {
            RITZ_CHECK_ROOM(all->element, all->num_elements,
                            all->elements_room);
            all->element[all->num_elements++] = (ritz_inp_element){
                all->type, id, all->num_joined, all->fields.place};
            all->begun = id;
        } else if (count_joined(all) < all->type->size) {
            RITZ_CHECK_ROOM(all->joined, all->num_joined, all->joined_room);
            all->joined[all->num_joined++] = id;
        } else if (all->type->cell != RITZ_CELL_LINE) {
            return ritz_inp_refuse(all, all->fields.place,
                                   "element %" PRId64 " has more than the %d "
                                   "nodes of a '%s'",
                                   all->begun, (int)all->type->size,
                                   all->type->name);
        }
    }
    if (all->begun > 0 && count_joined(all) == all->type->size)
        all->begun = 0;
    return RITZ_OK;
}

/* Elements of a type that is not known are counted. */
static ritz_status take_strange(ritz_inp *all)
{
    all->num_strange += all->begun == 0;
    all->begun = all->fields.continues;
    return RITZ_OK;
}

static ritz_status begin_elements(ritz_inp *all, const inp_kind *kind)
{
    const ritz_piece *type = ritz_inp_parameter(&all->keyword, "TYPE");
    const ritz_inp_type *known = NULL;

    (void)kind;
    if (!type || type->length == 0)
        return ritz_inp_refuse(all, all->keyword.place,
                               "'*ELEMENT' does not say its TYPE");
    RITZ_CHECK(check_container(all));
    known = ritz_inp_find_type(*type);
    if ((!known || known->mask == 0) && all->strange.line == 0) {
        all->strange = all->keyword.place;
        all->strange_type = *type;
    }
    if (known && known->expanded && all->expanded.line == 0) {
        all->expanded = all->keyword.place;
        all->expanded_type = known;
    }
    all->type = known;
    all->take = known ? take_element : take_strange;
    return ritz_inp_follow(all);
}

static ritz_status begin_set(ritz_inp *all, const inp_kind *kind)
{
    const ritz_piece *name = ritz_inp_parameter(&all->keyword, "NSET");
    const ritz_piece none = {"", 0};

    (void)kind;
    RITZ_CHECK(ritz_inp_open_set(all, name ? *name : none, &all->into));
    if (ritz_inp_parameter(&all->keyword, "ELSET"))
        all->set[all->into].of_elements = true;
    else if (ritz_inp_parameter(&all->keyword, "GENERATE"))
        all->take = ritz_inp_take_ranges;
    else
        all->take = ritz_inp_take_members;
    return RITZ_OK;
}

/* ---- supports and constraints -------------------------------------------- */

/* Directions that a word fixes. */
static const struct fixing {
    const char *word;
    uint8_t mask;
} FIXINGS[] = {
    {"ENCASTRE", 0x7e}, {"PINNED", 0x0e}, {"XSYMM", 0x62},  {"YSYMM", 0x54},
    {"ZSYMM", 0x38},    {"XASYMM", 0x1c}, {"YASYMM", 0x2a}, {"ZASYMM", 0x46},
};

/* Refuse a data line with more than @p first fields. */
static ritz_status check_end(const ritz_inp *all, int64_t first)
{
    for (int64_t k = first; k < all->fields.count; k++)
        if (ritz_inp_field(all, k).length > 0)
            return ritz_inp_refuse(all, all->fields.place,
                                   "'%.*s' in '*%.*s' is one field too many",
                                   RITZ_INP_QUOTED(ritz_inp_field(all, k)),
                                   RITZ_INP_QUOTED(all->keyword.name));
    return RITZ_OK;
}

/* A support is a word such as ENCASTRE, or first direction, last direction,
 * motion. */
static ritz_status take_directions(const ritz_inp *all,
                                   ritz_inp_support *support)
{
    int64_t first = 0, last = 0;
    double motion = 0.0;

    for (size_t k = 0; k < sizeof FIXINGS / sizeof *FIXINGS; k++)
        if (ritz_inp_is(ritz_inp_field(all, 1), FIXINGS[k].word)) {
            support->mask = FIXINGS[k].mask;
            return check_end(all, 2);
        }
    RITZ_CHECK(ritz_inp_direction(all, 1, &first));
    last = first;
    if (ritz_inp_field(all, 2).length > 0)
        RITZ_CHECK(ritz_inp_direction(all, 2, &last));
    if (last < first)
        return ritz_inp_refuse(all, all->fields.place,
                               "'*BOUNDARY' ends at direction %d, before it "
                               "begins, at %d",
                               (int)last, (int)first);
    RITZ_CHECK(ritz_inp_real(all, 3, &motion));
    RITZ_CHECK(check_end(all, 4));
    support->imposed = support->imposed || motion != 0.0;
    for (int64_t c = first; c <= last; c++)
        support->mask |= (uint8_t)(1U << (unsigned)c);
    return RITZ_OK;
}

static ritz_status take_support(ritz_inp *all)
{
    ritz_inp_support support = {.imposed = all->imposed};

    RITZ_CHECK(ritz_inp_name(all, 0, &support.nodes));
    RITZ_CHECK(take_directions(all, &support));
    RITZ_CHECK_ROOM(all->support, all->num_supports, all->supports_room);
    all->support[all->num_supports++] = support;
    return RITZ_OK;
}

/* Which supports matrices obey is clear if one step at most has supports, in
   addition to those of the model. */
static ritz_status begin_supports(ritz_inp *all, const inp_kind *kind)
{
    const ritz_inp_keyword *keyword = &all->keyword;
    const ritz_piece *op = ritz_inp_parameter(keyword, "OP");

    (void)kind;
    if (op && ritz_inp_is(*op, "NEW") && all->supports_before > 0)
        return ritz_inp_refuse(all, keyword->place,
                               "'*BOUNDARY' with OP=NEW removes supports: "
                               "leave out those that do not act");
    if (all->step > 0 && all->step_of_support > 0 &&
        all->step != all->step_of_support)
        return ritz_inp_refuse(all, keyword->place,
                               "'*BOUNDARY' is in a second step: leave out "
                               "the supports that do not act");
    if (all->step_of_matrices > 0 && all->step > all->step_of_matrices)
        return ritz_inp_refuse(all, keyword->place,
                               "'*BOUNDARY' is in a step after the one that "
                               "makes the matrices, which has no such "
                               "support: leave it out");
    if (ritz_inp_parameter(keyword, "LOAD CASE"))
        return ritz_inp_refuse(all, keyword->place,
                               "'*BOUNDARY' with LOAD CASE acts at times: "
                               "leave it out if it does not");
    if (all->step > 0)
        all->step_of_support = all->step;
    all->imposed = ritz_inp_parameter(keyword, "USER") ||
                   ritz_inp_parameter(keyword, "SUBMODEL") ||
                   ritz_inp_parameter(keyword, "BASE NAME");
    all->take = take_support;
    return ritz_inp_follow(all);
}

static ritz_status add_constraint(ritz_inp *all, const char *keyword,
                                  int64_t count, ritz_inp_place place)
{
    RITZ_CHECK_ROOM(all->constraint, all->num_constraints,
                    all->constraints_room);
    all->constraint[all->num_constraints++] =
        (ritz_inp_constraint){.keyword = keyword,
                              .first = all->num_terms,
                              .count = count,
                              .place = place};
    return RITZ_OK;
}

/* The number of terms; then a node, a direction and a factor for each. */
static ritz_status take_equation(ritz_inp *all)
{
    if (all->due == 0) {
        if (all->fields.count > 1 && ritz_inp_field(all, 1).length > 0)
            return ritz_inp_refuse(all, all->fields.place,
                                   "'*EQUATION' has its number of terms alone "
                                   "in the first line");
        RITZ_CHECK(ritz_inp_id(all, 0, &all->due));
        return add_constraint(all, "EQUATION", all->due, all->fields.place);
    }
    for (int64_t k = 0; k < all->fields.count; k += 3) {
        ritz_inp_term term = {0};

        if (all->due == 0 || ritz_inp_field(all, k + 2).length == 0)
            return ritz_inp_refuse(all, all->fields.place,
                                   all->due == 0
                                       ? "'*EQUATION' has more terms than it "
                                         "says"
                                       : "'*EQUATION' has a term without a "
                                         "factor");
        RITZ_CHECK(ritz_inp_name(all, k, &term.node));
        RITZ_CHECK(ritz_inp_direction(all, k + 1, &term.component));
        RITZ_CHECK(ritz_inp_real(all, k + 2, &term.factor));
        RITZ_CHECK_ROOM(all->term, all->num_terms, all->terms_room);
        all->term[all->num_terms++] = term;
        all->due--;
    }
    return RITZ_OK;
}

static ritz_status begin_equations(ritz_inp *all, const inp_kind *kind)
{
    const ritz_inp_keyword *keyword = &all->keyword;

    (void)kind;
    for (int64_t k = 0; k < keyword->count; k++)
        if (!ritz_inp_is(keyword->key[k], "INPUT"))
            return ritz_inp_refuse(all, keyword->place,
                                   "'*EQUATION' with '%.*s' is not read",
                                   RITZ_INP_QUOTED(keyword->key[k]));
    all->take = take_equation;
    return ritz_inp_follow(all);
}

static ritz_status begin_constraint(ritz_inp *all, const inp_kind *kind)
{
    return add_constraint(all, kind->name, 0, all->keyword.place);
}

/* ---- parts, instances and steps ------------------------------------------ */

static void note_abaqus(ritz_inp *all)
{
    if (all->program == RITZ_INP_UNKNOWN)
        all->program = RITZ_INP_ABAQUS;
}

static ritz_status begin_abaqus(ritz_inp *all, const inp_kind *kind)
{
    (void)kind;
    note_abaqus(all);
    if (all->step_of_matrices == 0)
        all->step_of_matrices = all->step;
    return RITZ_OK;
}

static void open_container(ritz_inp *all, bool is_part)
{
    const ritz_piece *name = ritz_inp_parameter(&all->keyword, "NAME");

    note_abaqus(all);
    all->open = (ritz_inp_container){
        .number = ++all->num_containers, .is_part = is_part, .name = {"", 0}};
    if (name)
        all->open.name = *name;
}

static ritz_status begin_part(ritz_inp *all, const inp_kind *kind)
{
    (void)kind;
    open_container(all, true);
    return RITZ_OK;
}

static ritz_status take_shift(ritz_inp *all)
{
    if (all->lines > 0 || all->fields.count > 3)
        return ritz_inp_refuse(all, all->fields.place,
                               "'*INSTANCE' is turned, which is not read: "
                               "its line has three coordinates");
    for (int64_t i = 0; i < 3; i++)
        RITZ_CHECK(ritz_inp_real(all, i, &all->shift[i]));
    return RITZ_OK;
}

static ritz_status begin_instance(ritz_inp *all, const inp_kind *kind)
{
    const ritz_inp_keyword *keyword = &all->keyword;
    const ritz_piece *part = ritz_inp_parameter(keyword, "PART");

    (void)kind;
    if (all->instance.line > 0)
        return ritz_inp_refuse(all, keyword->place,
                               "there is a second '*INSTANCE': only one is "
                               "read, since numbers of nodes repeat");
    if (!part)
        return ritz_inp_refuse(all, keyword->place,
                               "'*INSTANCE' is of another analysis, which is "
                               "not read");
    open_container(all, false);
    all->instance = keyword->place;
    all->instance_name = all->open.name;
    all->instance_of = *part;
    all->take = take_shift;
    return RITZ_OK;
}

static ritz_status begin_outside(ritz_inp *all, const inp_kind *kind)
{
    (void)kind;
    all->open = (ritz_inp_container){0};
    return RITZ_OK;
}

static ritz_status begin_step(ritz_inp *all, const inp_kind *kind)
{
    (void)kind;
    all->step++;
    all->supports_before = all->num_supports;
    return RITZ_OK;
}

static ritz_status begin_refused(ritz_inp *all, const inp_kind *kind)
{
    return ritz_inp_refuse(all, all->keyword.place, "'*%s' %s, and is not read",
                           kind->name, kind->why);
}

/* ---- keywords ------------------------------------------------------------ */

static const inp_kind kinds[] = {
    {"NODE", begin_nodes, NULL},
    {"ELEMENT", begin_elements, NULL},
    {"NSET", begin_set, NULL},
    {"BOUNDARY", begin_supports, NULL},
    {"EQUATION", begin_equations, NULL},
    {"PART", begin_part, NULL},
    {"END PART", begin_outside, NULL},
    {"INSTANCE", begin_instance, NULL},
    {"END INSTANCE", begin_outside, NULL},
    {"STEP", begin_step, NULL},
    {"MATRIX GENERATE", begin_abaqus, NULL},
    {"MATRIX OUTPUT", begin_abaqus, NULL},
    {"SUBSTRUCTURE GENERATE", begin_abaqus, NULL},
    {"COUPLING", begin_constraint, NULL},
    {"DISTRIBUTING COUPLING", begin_constraint, NULL},
    {"EMBEDDED ELEMENT", begin_constraint, NULL},
    {"FASTENER", begin_constraint, NULL},
    {"KINEMATIC COUPLING", begin_constraint, NULL},
    {"MPC", begin_constraint, NULL},
    {"NETWORK MPC", begin_constraint, NULL},
    {"PRE-TENSION SECTION", begin_constraint, NULL},
    {"RIGID BODY", begin_constraint, NULL},
    {"SHELL TO SOLID COUPLING", begin_constraint, NULL},
    {"TIE", begin_constraint, NULL},
    {"CYCLIC SYMMETRY MODEL", begin_refused, "joins sectors of a model"},
    {"ELCOPY", begin_refused, "makes elements"},
    {"ELGEN", begin_refused, "makes elements"},
    {"ENRICHMENT", begin_refused, "adds rows to nodes"},
    {"IMPERFECTION", begin_refused, "moves nodes"},
    {"IMPORT", begin_refused, "takes nodes from another analysis"},
    {"MATRIX ASSEMBLE", begin_refused, "adds matrices to those of elements"},
    {"MATRIX", begin_refused, "states a matrix"},
    {"MATRIX INPUT", begin_refused, "states a matrix"},
    {"MODEL CHANGE", begin_refused, "removes elements"},
    {"NCOPY", begin_refused, "makes nodes"},
    {"NFILL", begin_refused, "makes nodes"},
    {"NGEN", begin_refused, "makes nodes"},
    {"NMAP", begin_refused, "moves nodes"},
    {"PARAMETER", begin_refused, "computes what other lines say"},
    {"RELEASE", begin_refused, "adds rows to nodes"},
    {"SYMMETRIC MODEL GENERATION", begin_refused, "makes nodes and elements"},
    {"SYSTEM", begin_refused, "turns the coordinates of nodes"},
    {"TRANSFORM", begin_refused, "turns the directions of rows"},
    {"USER ELEMENT", begin_refused, "makes a type of elements"},
};

/* What was begun must be complete when the next keyword comes. */
static ritz_status end_data(const ritz_inp *all)
{
    if (all->begun > 0 && all->type)
        return ritz_inp_refuse(all, all->fields.place,
                               "element %" PRId64 " has %d nodes, and a '%s' "
                               "has %d",
                               all->begun, (int)count_joined(all),
                               all->type->name, (int)all->type->size);
    if (all->due > 0)
        return ritz_inp_refuse(
            all, all->fields.place,
            "'*EQUATION' has %" PRId64 " terms less than it says", all->due);
    return RITZ_OK;
}

/* If a keyword ends with a comma by mistake, the first data line is read as its
 * parameters. Refuse the keyword if one of these cannot be a parameter. */
static ritz_status check_continued(const ritz_inp *all)
{
    const ritz_piece odd = all->keyword.odd;

    if (odd.length > 0)
        return ritz_inp_refuse(all, all->keyword.place,
                               "'*%.*s' ends with a comma, but '%.*s' in the "
                               "line that continues it is no parameter",
                               RITZ_INP_QUOTED(all->keyword.name),
                               RITZ_INP_QUOTED(odd));
    return RITZ_OK;
}

static ritz_status begin_data(ritz_inp *all)
{
    const ritz_piece *solver = ritz_inp_parameter(&all->keyword, "SOLVER");

    all->take = NULL;
    all->type = NULL;
    all->into = -1;
    all->begun = all->due = all->lines = 0;
    all->imposed = false;
    if (solver && ritz_inp_is(*solver, "MATRIXSTORAGE")) {
        all->program = RITZ_INP_CALCULIX;
        if (all->step_of_matrices == 0)
            all->step_of_matrices = all->step;
    }
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        if (!ritz_inp_is(all->keyword.name, kinds[k].name))
            continue;
        RITZ_CHECK(check_continued(all));
        return kinds[k].begin(all, &kinds[k]);
    }
    return RITZ_OK;
}

/* The lines of an included file go on with the data above it. */
static ritz_status take_include(ritz_inp *all, ritz_piece line)
{
    const ritz_inp_keyword above = all->keyword;

    RITZ_CHECK(ritz_inp_take_keyword(all, line));
    if (!ritz_inp_parameter(&all->keyword, "INPUT"))
        return ritz_inp_refuse(all, all->keyword.place,
                               "'*INCLUDE' does not say its INPUT");
    RITZ_CHECK(ritz_inp_follow(all));
    all->keyword = above;
    return RITZ_OK;
}

static bool is_include(ritz_piece line)
{
    const char *comma = memchr(line.text, ',', (size_t)line.length);

    line.text++;
    line.length = comma ? comma - line.text : line.length - 1;
    return ritz_inp_is(line, "INCLUDE");
}

static ritz_status read_lines(ritz_inp *all)
{
    ritz_piece line = {0};

    while (ritz_inp_line(all, &line)) {
        if (*line.text == '*' && is_include(line)) {
            RITZ_CHECK(take_include(all, line));
        } else if (*line.text == '*') {
            RITZ_CHECK(end_data(all));
            RITZ_CHECK(ritz_inp_take_keyword(all, line));
            RITZ_CHECK(begin_data(all));
        } else if (all->take) {
            RITZ_CHECK(ritz_inp_split(all, line));
            RITZ_CHECK(all->take(all));
            all->lines++;
        }
    }
    return end_data(all);
}

/* ---- the format ---------------------------------------------------------- */

static void ritz_inp_free(ritz_inp *all)
{
    ritz_deck_reading_free(&all->reading);
    ritz_deck_files_free(&all->files);
    RITZ_FREE(all->fields.field, all->node, all->element, all->joined, all->set,
              all->slot, all->member, all->support, all->term, all->constraint);
}

static ritz_status parse_inp(const char *path, const char *bytes, int64_t size,
                             const char *folder, ritz_deck *out)
{
    RITZ_OWN(ritz_inp) all = {.into = -1, .home = {.number = -1}};

    all.reading.files = &all.files;
    RITZ_CHECK(ritz_deck_begin(&all.reading, path, bytes, size, folder));
    RITZ_CHECK(read_lines(&all));
    return ritz_inp_build(&all, out);
}

/* Whether a line is a keyword. "*KEYWORD" is none: a deck of LS-DYNA, which is
   not read, begins with it. */
static bool begins_deck(ritz_piece line)
{
    ritz_piece word = {line.text + 1, line.length - 1};
    const char *comma = NULL;

    if (line.length < 2 || *line.text != '*' ||
        !isalpha((unsigned char)line.text[1]))
        return false;
    comma = memchr(word.text, ',', (size_t)word.length);
    if (comma)
        word.length = comma - word.text;
    return !ritz_inp_is(word, "KEYWORD");
}

/* The first line that is no comment is a keyword. */
static bool is_inp(const char *bytes, int64_t size)
{
    ritz_lines text = ritz_deck_lines(bytes, size);

    while (ritz_lines_next(&text)) {
        ritz_piece line =
            ritz_piece_trim((ritz_piece){text.line, text.line_end - text.line});

        if (line.length == 0 ||
            (line.length > 1 && line.text[0] == '*' && line.text[1] == '*'))
            continue;
        return begins_deck(line) && !memchr(bytes, '\0', (size_t)size);
    }
    return false;
}

const ritz_deck_format ritz_deck_inp = {
    .name = "inp",
    .title = "input file of Abaqus or CalculiX",
    .reference = "Abaqus2016",
    .recognise = is_inp,
    .parse = parse_inp,
};
