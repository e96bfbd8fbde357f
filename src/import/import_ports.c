/* Ports, inputs, outputs and dampers: texts that name dofs of a component. */
#include "base/alloc.h"
#include "base/text.h"
#include "import/import.h"
#include "model/equations.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- ports "NAME=GRIDS[:COMPS]" ----------------------------------------- */

/*
 * Split "NAME=REST".
 *
 * @param[out] rest  points behind the '='
 * @return RITZ_ERR_ARGUMENT with @p form, what it should look like
 */
static ritz_status ritz_import_split(const char *text, const char *form,
                                     char name[RITZ_NAME_SIZE],
                                     const char **rest)
{
    const char *equals = strchr(text, '=');
    char copy[RITZ_NAME_SIZE] = "";

    RITZ_REFUSE_IF(!equals || !equals[1], RITZ_ERR_ARGUMENT,
                   "'%.80s' is not of the form %s", text, form);
    RITZ_REFUSE_IF((size_t)(equals - text) >= sizeof copy, RITZ_ERR_ARGUMENT,
                   "'%.40s...': a name has at most %d letters", text,
                   RITZ_NAME_SIZE - 1);
    memcpy(copy, text, (size_t)(equals - text));
    RITZ_CHECK(ritz_name_copy(copy, name));
    *rest = equals + 1;
    return RITZ_OK;
}

/* A port while it is read. */
typedef struct draft {
    const ritz_extended *extended;
    bool whole;   /* grids bring all of their translations and rotations */
    bool want[7]; /* directions; none: every dof of a grid */
    bool choosy;
    bool *taken; /* rows that the port has already */
    ritz_port port;
    int64_t num_grids; /* that have a position */
} draft;

static void draft_free(draft *it)
{
    free(it->taken);
    ritz_dofs_free(&it->port.dofs);
}

/* A dof that follows others cannot be held: say what it follows. */
static ritz_status refuse_dependent(const ritz_extended *extended, ritz_dof dof)
{
    const ritz_equations *eq = extended->equations;
    int64_t e = eq ? ritz_equations_find(eq, dof) : -1;
    char name[RITZ_DOF_NAME_SIZE];
    char cited[RITZ_CITATION_SIZE] = "others";
    char grids[120] = "";
    int used = 0;
    int64_t last = -1;

    for (int64_t k = e < 0 ? 0 : eq->first[e];
         e >= 0 && k < eq->first[e + 1] && used < 60; k++) {
        if (eq->dof[k].grid == last)
            continue;
        last = eq->dof[k].grid;
        used += snprintf(grids + used, sizeof grids - (size_t)used,
                         "%s%" PRId64, used > 0 ? ", " : "", last);
    }
    if (e >= 0)
        ritz_equations_cite(eq, eq->source[e], cited);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "'%s' depends on %s and cannot be attached: attach what "
                     "it follows, grid %s%s",
                     ritz_dof_name(dof, name), cited, grids,
                     used >= 60 ? ", ..." : "");
}

static ritz_status add_row(int64_t row, draft *it)
{
    ritz_dof dof = it->extended->view.dof[row];

    if (it->taken[row])
        return ritz_fail(RITZ_ERR_ARGUMENT, "'%" PRId64 "' is listed twice",
                         dof.grid);
    if (row >= it->extended->num_rows)
        return refuse_dependent(it->extended, dof);
    it->taken[row] = true;
    it->port.dofs.at[it->port.dofs.count++] = row;
    return RITZ_OK;
}

/* A part of the origin, the mean of the positions. */
static void add_position(int64_t grid, draft *it)
{
    const ritz_grids *grids = &it->extended->view.grids;
    int64_t k = ritz_grids_find(grids, grid);

    if (k < 0)
        return;
    it->num_grids++;
    for (int i = 0; i < 3; i++)
        it->port.origin[i] +=
            (grids->position[3 * k + i] - it->port.origin[i]) /
            (double)it->num_grids;
}

/* Axes of its own need all three translations or rotations, or none. */
static ritz_status check_turn(int64_t first, const draft *it)
{
    ritz_port alone = {
        .dofs = {it->port.dofs.count - first, it->port.dofs.at + first}};
    RITZ_OWN(ritz_dense) turn = {0};

    memcpy(alone.name, it->port.name, sizeof alone.name);
    return ritz_port_turn(&it->extended->view, &alone, &turn, NULL);
}

static ritz_status add_grid(int64_t grid, draft *it)
{
    const ritz_roster *roster = &it->extended->roster;
    int64_t before = it->port.dofs.count;

    for (int64_t c = 0; c <= 6; c++) {
        int64_t row = ritz_roster_row(roster, (ritz_dof){grid, c});

        if (it->choosy && !it->want[c])
            continue;
        if (row < 0 && it->choosy)
            return ritz_roster_miss(roster, (ritz_dof){grid, c});
        if (row >= 0)
            RITZ_CHECK(add_row(row, it));
    }
    if (it->port.dofs.count == before)
        return ritz_roster_miss(roster, (ritz_dof){grid, 1});
    if (it->whole)
        RITZ_CHECK(check_turn(before, it));
    add_position(grid, it);
    return RITZ_OK;
}

/* Grids from..to that exist, or points if directions are 0. */
static ritz_status add_range(int64_t from, int64_t to, draft *it)
{
    const ritz_roster *roster = &it->extended->roster;
    int64_t before = it->port.dofs.count;
    int64_t last = from - 1;

    for (int64_t k = ritz_roster_from(roster, from);
         k < roster->count && roster->place[k].dof.grid <= to; k++) {
        ritz_dof dof = roster->place[k].dof;
        bool fits = !it->choosy || it->want[0] == (dof.component == 0);

        if (dof.grid == last || !fits)
            continue;
        RITZ_CHECK(add_grid(dof.grid, it));
        last = dof.grid;
    }
    RITZ_REFUSE_IF(it->port.dofs.count == before, RITZ_ERR_ARGUMENT,
                   "there is nothing from %" PRId64 " to %" PRId64, from, to);
    return RITZ_OK;
}

/* "5" must exist; of "10-20" those are taken that do. */
static ritz_status add_part(const char *text, size_t length, draft *it)
{
    int64_t from = 0;
    int64_t to = 0;

    RITZ_REFUSE_IF(!ritz_text_range(text, length, &from, &to),
                   RITZ_ERR_ARGUMENT,
                   "'%.*s' is no part of a list of grids such as 1,5,10-20",
                   (int)length, text);
    return to > 0 ? add_range(from, to, it) : add_grid(from, it);
}

static ritz_status fill_port(const char *text, draft *it)
{
    const char *grids = NULL;
    const char *colon = NULL;
    const char *end = NULL;

    RITZ_CHECK(
        ritz_import_split(text, "NAME=GRIDS[:COMPS]", it->port.name, &grids));
    RITZ_REFUSE_IF(strchr(it->port.name, ','), RITZ_ERR_ARGUMENT,
                   "'%s' holds ',', the name of a port cannot", it->port.name);
    colon = strchr(grids, ':');
    end = colon ? colon : grids + strlen(grids);
    if (colon)
        RITZ_CHECK(ritz_import_directions(colon + 1, it->want));
    it->choosy = colon;
    for (const char *at = grids; at <= end;) {
        size_t length = strcspn(at, ",:");

        RITZ_CHECK(add_part(at, length, it));
        at += length + 1;
    }
    for (int64_t i = 0; i < 3; i++)
        it->port.axes[4 * i] = 1.0;
    return RITZ_OK;
}

ritz_status ritz_import_port(const char *text, bool whole,
                             const ritz_extended *extended, ritz_port *out)
{
    RITZ_OWN(draft) it = {.extended = extended, .whole = whole};
    ritz_dofs fit = {0}; /* without the room for all rows */

    RITZ_CHECK_NEW(it.taken, extended->view.num_dofs);
    RITZ_CHECK_NEW(it.port.dofs.at, extended->view.num_dofs);
    RITZ_CHECK(fill_port(text, &it));
    RITZ_CHECK(ritz_dofs_copy(&it.port.dofs, &fit));
    *out = it.port;
    out->dofs = fit;
    return RITZ_OK;
}

/* Count the port that was put behind the others. */
static ritz_status add_port(ritz_component *component)
{
    const ritz_port *port = &component->port[component->num_ports++];

    for (int64_t j = 0; j + 1 < component->num_ports; j++)
        RITZ_REFUSE_IF(strcmp(component->port[j].name, port->name) == 0,
                       RITZ_ERR_ARGUMENT, "there are two ports '%s'",
                       port->name);
    return RITZ_OK;
}

static ritz_status add_ports(const ritz_import_request *request,
                             const ritz_import_report *report,
                             const ritz_extended *extended,
                             ritz_component *component)
{
    RITZ_CHECK_NEW(component->port, request->num_ports + report->num_grids);
    for (int64_t k = 0; k < request->num_ports; k++) {
        RITZ_CHECK_IN(request->port[k],
                      ritz_import_port(request->port[k], true, extended,
                                       &component->port[k]));
        RITZ_CHECK(add_port(component));
    }
    for (int64_t k = 0; k < report->num_grids; k++) {
        const ritz_import_grid *grid = &report->grid[k];
        char text[RITZ_NAME_SIZE + 32];

        snprintf(text, sizeof text, "%s=%" PRId64 ":123456", grid->port,
                 grid->id);
        RITZ_CHECK_IN(grid->port,
                      ritz_import_port(text, true, extended,
                                       &component->port[component->num_ports]));
        RITZ_CHECK(add_port(component));
    }
    return RITZ_OK;
}

/* ---- inputs and outputs ------------------------------------------------- */

/*
 * Inputs "NAME=GRID:COMP[*SCALE][,...]" and outputs
 * "NAME=GRID:COMP[*SCALE][,...][/vel|/acc][@LIMIT]", along basic axes. Terms
 * between commas are added: "3:1,4:1*-1" is a pair of opposite forces, or a
 * relative displacement.
 *
 * With u_b = t' u the displacement of a grid along a basic axis, a force along
 * it is the row vector t in B, as it does the work t' u; an output is t in C.
 * If constraints eliminate dofs, u = G u_n, these become G' t and t' G.
 */

/* A direction of a grid along a basic axis, as a combination of dofs. */
typedef struct aim {
    int64_t count;
    int64_t row[3];
    double share[3];
} aim;

static ritz_status take_aim(const ritz_extended *extended, ritz_dof dof,
                            aim *out)
{
    const ritz_roster *roster = &extended->roster;
    ritz_port port = {.name = ""};
    int64_t rows[3];
    int64_t first = dof.component > 3 ? 4 : 1;
    RITZ_OWN(ritz_dense) turn = {0};
    RITZ_OWN_ARRAY ritz_dof *label = NULL;

    port.dofs.at = rows;
    if (dof.component == 0) {
        rows[0] = ritz_roster_row(roster, dof);
        port.dofs.count = rows[0] >= 0;
    }
    for (int64_t c = first; dof.component > 0 && c < first + 3; c++) {
        int64_t row = ritz_roster_row(roster, (ritz_dof){dof.grid, c});

        if (row >= 0)
            rows[port.dofs.count++] = row;
    }
    if (port.dofs.count == 0)
        return ritz_roster_miss(roster, dof);
    RITZ_CHECK(ritz_port_turn(&extended->view, &port, &turn, &label));
    *out = (aim){0};
    for (int64_t k = 0; k < port.dofs.count; k++)
        for (int64_t j = 0;
             label[k].component == dof.component && j < port.dofs.count; j++) {
            out->row[out->count] = rows[j];
            out->share[out->count++] = ritz_dense_col(&turn, j)[k];
        }
    return out->count == 0 ? ritz_roster_miss(roster, dof) : RITZ_OK;
}

/* Add `scale` times t to a column of B (stride 1) or a row of C (stride: number
 * of outputs). */
static void add_aim(const ritz_extended *extended, const aim *to, double scale,
                    int64_t stride, double *into)
{
    for (int64_t i = 0; i < to->count; i++)
        ritz_extended_add(extended, to->row[i], scale * to->share[i], stride,
                          into);
}

/* "GRID:COMP" of `length` letters. */
static ritz_status take_dof(const char *text, size_t length, ritz_dof *out)
{
    char grid[RITZ_NAME_SIZE];
    char *component = NULL;

    RITZ_REFUSE_IF(!ritz_text_part(text, length, ':', grid, &component) ||
                       !component || !ritz_text_whole(grid, &out->grid) ||
                       out->grid < 1 ||
                       !ritz_text_whole(component, &out->component) ||
                       out->component < 0 || out->component > 6,
                   RITZ_ERR_ARGUMENT,
                   "'%.*s' is no grid and direction such as 101:3 (0 for a "
                   "scalar point)",
                   (int)length, text);
    return RITZ_OK;
}

/* Add scale t of "GRID:COMP", of `length` letters, as add_aim does. */
static ritz_status add_direction(const char *text, size_t length,
                                 const ritz_extended *extended, double scale,
                                 int64_t stride, double *into)
{
    ritz_dof dof = {0};
    aim to = {0};

    RITZ_CHECK(take_dof(text, length, &dof));
    RITZ_CHECK(take_aim(extended, dof, &to));
    add_aim(extended, &to, scale, stride, into);
    return RITZ_OK;
}

/* Parse the first `length` letters as a number. */
static ritz_status take_number(const char *text, size_t length, double *out)
{
    char copy[RITZ_NAME_SIZE];
    char *more = NULL;

    RITZ_REFUSE_IF(!ritz_text_part(text, length, '*', copy, &more) || more ||
                       !ritz_text_real(copy, out) || *out == 0.0,
                   RITZ_ERR_ARGUMENT, "'%.*s' is no number other than zero",
                   (int)length, text);
    return RITZ_OK;
}

/* Add a term "GRID:COMP[*SCALE]". */
static ritz_status add_term(const char *text, size_t length,
                            const ritz_extended *extended, int64_t stride,
                            double *into)
{
    const char *star = memchr(text, '*', length);
    size_t before = star ? (size_t)(star - text) : length;
    double scale = 1.0;

    if (star)
        RITZ_CHECK(take_number(star + 1, length - before - 1, &scale));
    return add_direction(text, before, extended, scale, stride, into);
}

/* Add terms "GRID:COMP[*SCALE][,...]"; terms that cancel each other are
   refused. */
static ritz_status add_terms(const char *text, size_t length,
                             const ritz_extended *extended, int64_t stride,
                             double *into)
{
    const char *end = text + length;
    double largest = 0.0;

    for (const char *at = text; at <= end;) {
        const char *comma = memchr(at, ',', (size_t)(end - at));
        size_t part = (size_t)((comma ? comma : end) - at);

        RITZ_CHECK(add_term(at, part, extended, stride, into));
        at += part + 1;
    }
    for (int64_t i = 0; i < extended->num_rows; i++)
        largest = fmax(largest, fabs(into[stride * i]));
    RITZ_REFUSE_IF(largest == 0.0 && memchr(text, ',', length),
                   RITZ_ERR_ARGUMENT, "the terms of '%.*s' cancel each other",
                   (int)length, text);
    return RITZ_OK;
}

static ritz_status make_input(const char *text, const ritz_extended *extended,
                              int64_t k, ritz_io *io)
{
    const char *rest = NULL;

    RITZ_CHECK(ritz_import_split(text, "NAME=GRID:COMP[*SCALE][,...]",
                                 io->input[k], &rest));
    return add_terms(rest, strlen(rest), extended, 1,
                     ritz_dense_col(&io->B, k));
}

/* Cut "@LIMIT" off the end, if it is there, and parse it. */
static ritz_status take_limit(const char *text, size_t *length, double *limit)
{
    const char *at = strchr(text, '@');

    if (!at)
        return RITZ_OK;
    RITZ_CHECK(take_number(at + 1, strlen(at + 1), limit));
    RITZ_REFUSE_IF(*limit < 0.0, RITZ_ERR_ARGUMENT,
                   "a limit is positive, '%g' is not", *limit);
    *length = (size_t)(at - text);
    return RITZ_OK;
}

/* The quantity of an output: displacement unless a word follows '/'. */
static ritz_status take_quantity(const char *text, size_t *length, ritz_io *io,
                                 ritz_dense **out)
{
    const struct {
        const char *word;
        ritz_dense *matrix;
    } table[] = {{"vel", &io->Cv}, {"acc", &io->Ca}};
    const char *slash = memchr(text, '/', *length);
    size_t left = 0;

    *out = &io->C;
    if (!slash)
        return RITZ_OK;
    left = *length - (size_t)(slash + 1 - text);
    for (size_t k = 0; k < sizeof table / sizeof *table; k++)
        if (left == strlen(table[k].word) &&
            memcmp(slash + 1, table[k].word, left) == 0) {
            *out = table[k].matrix;
            *length = (size_t)(slash - text);
            return RITZ_OK;
        }
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "'%.*s' is neither 'vel' nor 'acc', and displacement is "
                     "put out without a word",
                     (int)left, slash + 1);
}

static ritz_status make_output(const char *text, const ritz_extended *extended,
                               int64_t k, ritz_io *io)
{
    const char *rest = NULL;
    size_t length = 0;
    ritz_dense *C = NULL;

    RITZ_CHECK(ritz_import_split(
        text, "NAME=GRID:COMP[*SCALE][,...][/vel|/acc][@LIMIT]", io->output[k],
        &rest));
    length = strlen(rest);
    RITZ_CHECK(take_limit(rest, &length, &io->limit[k]));
    RITZ_CHECK(take_quantity(rest, &length, io, &C));
    return add_terms(rest, length, extended, C->nrow, C->val + k);
}

static ritz_status check_names(int64_t count, char (*name)[RITZ_NAME_SIZE],
                               const char *what)
{
    char twice[RITZ_NAME_SIZE];

    RITZ_CHECK(
        ritz_names_repeated(count, (const char(*)[RITZ_NAME_SIZE])name, twice));
    RITZ_REFUSE_IF(*twice, RITZ_ERR_ARGUMENT, "there are two %s '%s'", what,
                   twice);
    return RITZ_OK;
}

/* Add the inputs and outputs of options, then those of matrices. */
static ritz_status add_io(const ritz_import_request *request,
                          const ritz_deck *deck,
                          const ritz_import_report *report,
                          const ritz_extended *extended,
                          const ritz_io_files *files, ritz_io *io)
{
    int64_t inputs = 0;
    int64_t outputs = 0;

    RITZ_CHECK(ritz_io_files_size(files, &inputs, &outputs));
    RITZ_CHECK(ritz_io_new(extended->num_rows, request->num_inputs + inputs,
                           request->num_outputs + outputs, io));
    for (int64_t k = 0; k < request->num_inputs; k++)
        RITZ_CHECK_IN(request->input[k],
                      make_input(request->input[k], extended, k, io));
    for (int64_t k = 0; k < request->num_outputs; k++)
        RITZ_CHECK_IN(request->output[k],
                      make_output(request->output[k], extended, k, io));
    RITZ_CHECK(ritz_io_files_add(request, deck, report, extended, files, io));
    RITZ_CHECK(check_names(io->num_inputs, io->input, "inputs"));
    return check_names(io->num_outputs, io->output, "outputs");
}

/* ---- dampers ------------------------------------------------------------ */

/*
 * Dampers "NAME=GRID:COMP[,GRID:COMP]*C[*K]", along basic axes as inputs are:
 * b is the row vector of the first place, less that of the second.
 */

static const char form[] = "NAME=GRID:COMP[,GRID:COMP]*C[*K]";

/* "C" or "C*K". */
static ritz_status take_constants(const char *text, double *c, double *k)
{
    char copy[RITZ_NAME_SIZE];
    char *star = NULL;

    RITZ_REFUSE_IF(!ritz_text_part(text, strlen(text), '*', copy, &star) ||
                       !ritz_text_real(copy, c) ||
                       (star && !ritz_text_real(star, k)),
                   RITZ_ERR_ARGUMENT,
                   "'%.40s' is neither C nor C*K, two finite numbers", text);
    RITZ_REFUSE_IF(*c < 0.0, RITZ_ERR_ARGUMENT,
                   "a damper's c is not negative, '%g' is", *c);
    return RITZ_OK;
}

static ritz_status make_damper(const char *text, const ritz_extended *extended,
                               int64_t j, ritz_dampers *dampers)
{
    const char *rest = NULL;
    const char *star = NULL;
    const char *comma = NULL;
    double *b = ritz_dense_col(&dampers->B, j);
    double largest = 0.0;

    RITZ_CHECK(ritz_import_split(text, form, dampers->name[j], &rest));
    star = strchr(rest, '*');
    RITZ_REFUSE_IF(!star, RITZ_ERR_ARGUMENT, "'%s' is not of the form %s", text,
                   form);
    RITZ_CHECK(take_constants(star + 1, &dampers->c[j], &dampers->k[j]));
    comma = memchr(rest, ',', (size_t)(star - rest));
    RITZ_CHECK(add_direction(rest, (size_t)((comma ? comma : star) - rest),
                             extended, 1.0, 1, b));
    if (comma)
        RITZ_CHECK(add_direction(comma + 1, (size_t)(star - comma - 1),
                                 extended, -1.0, 1, b));
    for (int64_t i = 0; i < dampers->B.nrow; i++)
        largest = fmax(largest, fabs(b[i]));
    RITZ_REFUSE_IF(largest == 0.0, RITZ_ERR_ARGUMENT,
                   "nothing moves between '%.*s'", (int)(star - rest), rest);
    return RITZ_OK;
}

static ritz_status add_dampers(const ritz_import_request *request,
                               const ritz_extended *extended,
                               ritz_component *component)
{
    ritz_dampers *dampers = &component->dampers;

    if (request->num_dampers == 0)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_dampers_new(component->num_dofs, request->num_dampers, dampers));
    for (int64_t j = 0; j < request->num_dampers; j++)
        RITZ_CHECK_IN(request->damper[j],
                      make_damper(request->damper[j], extended, j, dampers));
    return ritz_dampers_check(dampers, component->num_dofs);
}

/* ---- all of them -------------------------------------------------------- */

ritz_status ritz_import_attach(const ritz_import_request *request,
                               const ritz_deck *deck,
                               const ritz_import_report *report,
                               const ritz_io_files *files,
                               ritz_component *component)
{
    RITZ_OWN(ritz_extended) extended = {0};

    RITZ_CHECK(ritz_extended_new(component, &deck->equations, &extended));
    RITZ_CHECK_IN("port", add_ports(request, report, &extended, component));
    RITZ_CHECK(add_io(request, deck, report, &extended, files, &component->io));
    RITZ_CHECK_IN("damper", add_dampers(request, &extended, component));
    return ritz_context(ritz_quantity_files_add(request, deck, report,
                                                &extended, files, component),
                        "recovery");
}
