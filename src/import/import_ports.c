/* Ports: "NAME=GRIDS[:COMPS]". */
#include "import/import.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_import_split(const char *text, const char *form,
                              char name[RITZ_NAME_SIZE], const char **rest)
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

/* One port as it is put together. */
typedef struct draft {
    const ritz_extended *extended;
    bool whole;   /* grids bring all of their translations and rotations */
    bool want[7]; /* directions; none: every dof of a grid */
    bool choosy;
    bool *taken; /* rows that the port has already */
    ritz_port port;
    int64_t num_grids; /* that have a position */
} draft;

/* The digits behind the last ':': 1 to 6, or 0 for scalar points. */
static ritz_status take_components(const char *text, draft *it)
{
    RITZ_REFUSE_IF(!*text, RITZ_ERR_ARGUMENT, "no directions follow ':'");
    for (const char *c = text; *c; c++) {
        int k = *c - '0';

        RITZ_REFUSE_IF(
            k < 0 || k > 6 || it->want[k], RITZ_ERR_ARGUMENT,
            "'%s' are not directions: digits 1 to 6, each once, or 0 "
            "for scalar points",
            text);
        it->want[k] = true;
    }
    RITZ_REFUSE_IF(it->want[0] && text[1], RITZ_ERR_ARGUMENT,
                   "'%s' are not directions: 0, for scalar points, goes alone",
                   text);
    it->choosy = true;
    return RITZ_OK;
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
    ritz_status status = RITZ_OK;
    ritz_port alone = {
        .dofs = {it->port.dofs.count - first, it->port.dofs.at + first}};
    ritz_dense turn = {0};

    memcpy(alone.name, it->port.name, sizeof alone.name);
    RITZ_TRY(ritz_port_turn(&it->extended->view, &alone, &turn, NULL));
done:
    ritz_dense_free(&turn);
    return status;
}

static ritz_status add_grid(int64_t grid, draft *it)
{
    ritz_status status = RITZ_OK;
    const ritz_roster *roster = &it->extended->roster;
    int64_t before = it->port.dofs.count;

    for (int64_t c = 0; c <= 6; c++) {
        int64_t row = ritz_roster_row(roster, (ritz_dof){grid, c});

        if (it->choosy && !it->want[c])
            continue;
        if (row < 0 && it->choosy) {
            status = ritz_roster_miss(roster, (ritz_dof){grid, c});
            goto done;
        }
        if (row >= 0)
            RITZ_TRY(add_row(row, it));
    }
    if (it->port.dofs.count == before) {
        status = ritz_roster_miss(roster, (ritz_dof){grid, 1});
        goto done;
    }
    if (it->whole)
        RITZ_TRY(check_turn(before, it));
    add_position(grid, it);
done:
    return status;
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
    char part[48] = "";
    char *dash = NULL;
    int64_t from = 0;
    int64_t to = 0;
    bool good = length > 0 && length < sizeof part;

    if (good) {
        memcpy(part, text, length);
        dash = strchr(part, '-');
        if (dash)
            *dash++ = '\0';
        good = ritz_text_whole(part, &from) && from > 0 &&
               (!dash || (ritz_text_whole(dash, &to) && to >= from));
    }
    RITZ_REFUSE_IF(!good, RITZ_ERR_ARGUMENT,
                   "'%.*s' is no part of a list of grids such as 1,5,10-20",
                   (int)length, text);
    return dash ? add_range(from, to, it) : add_grid(from, it);
}

static ritz_status fill(const char *text, draft *it)
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
        RITZ_CHECK(take_components(colon + 1, it));
    for (const char *at = grids; at <= end;) {
        size_t length = strcspn(at, ",:");

        RITZ_CHECK(add_part(at, length, it));
        at += length + 1;
    }
    for (int64_t i = 0; i < 3; i++)
        it->port.axes[4 * i] = 1.0;
    return RITZ_OK;
}

/* A port's list has room for all rows until it is known; then it is cut. */
static ritz_status shorten(ritz_dofs *dofs)
{
    ritz_dofs fit = {0};
    ritz_status status = ritz_dofs_copy(dofs, &fit);

    if (status == RITZ_OK) {
        ritz_dofs_free(dofs);
        *dofs = fit;
    }
    return status;
}

ritz_status ritz_import_port(const char *text, bool whole,
                             const ritz_extended *extended, ritz_port *out)
{
    ritz_status status = RITZ_OK;
    draft it = {.extended = extended, .whole = whole};

    RITZ_NEW(it.taken, extended->view.num_dofs);
    RITZ_NEW(it.port.dofs.at, extended->view.num_dofs);
    RITZ_TRY(fill(text, &it));
    RITZ_TRY(shorten(&it.port.dofs));
    *out = it.port;
    it.port = (ritz_port){0};
done:
    free(it.taken);
    ritz_dofs_free(&it.port.dofs);
    return status;
}

/* The six dofs of a grid that was made for a port. */
static ritz_status make_tied(const ritz_import_grid *grid,
                             const ritz_extended *extended, ritz_port *out)
{
    char text[RITZ_NAME_SIZE + 32];

    snprintf(text, sizeof text, "%s=%" PRId64 ":123456", grid->port, grid->id);
    return ritz_import_port(text, true, extended, out);
}

static ritz_status add_port(ritz_port *port, ritz_component *component)
{
    ritz_status status = RITZ_OK;
    int64_t count = component->num_ports;

    component->port[component->num_ports++] = *port;
    for (int64_t j = 0; j < count; j++)
        RITZ_FAIL_IF(strcmp(component->port[j].name, port->name) == 0,
                     RITZ_ERR_ARGUMENT, "there are two ports '%s'", port->name);
done:
    *port = (ritz_port){0};
    return status;
}

ritz_status ritz_import_ports(const ritz_import_request *request,
                              const ritz_import_report *report,
                              const ritz_extended *extended,
                              ritz_component *component)
{
    ritz_port port = {0};

    RITZ_CHECK_NEW(component->port, request->num_ports + report->num_grids);
    for (int64_t k = 0; k < request->num_ports; k++) {
        RITZ_CHECK_IN(request->port[k], ritz_import_port(request->port[k], true,
                                                         extended, &port));
        RITZ_CHECK(add_port(&port, component));
    }
    for (int64_t k = 0; k < report->num_grids; k++) {
        RITZ_CHECK_IN(report->grid[k].port,
                      make_tied(&report->grid[k], extended, &port));
        RITZ_CHECK(add_port(&port, component));
    }
    return RITZ_OK;
}
