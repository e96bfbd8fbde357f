/*
 * Ports of one grid that is made for them, at the mean position of theirs.
 *
 * Rigid: the dofs u of the port's grids follow the new grid, u = S q.
 * Averaged: the new grid is their average, q = A u, see import_tied_average.c.
 * Forces on it are spread to the dofs as A' f, and nothing is stiffened.
 */
#include "import/import_tied.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIX = 6 };

/* ---- the dofs that there are ------------------------------------------- */

/* Whether all that a dependent dof follows is known. */
static bool is_known(const ritz_tying *tying, const ritz_sparse *turned,
                     int64_t dof)
{
    for (int64_t p = turned->colptr[dof]; p < turned->colptr[dof + 1]; p++) {
        int64_t k = tying->by.kept.at[turned->rowind[p]];

        if (tying->outside[k] && !tying->fixed[k])
            return false;
    }
    return true;
}

/* Dofs that a port may name: with stiffness or mass, their own or that of what
 * depends on them, or dependent on such. */
static ritz_status find_present(const ritz_tying *tying,
                                const ritz_sparse *turned, bool *present)
{
    ritz_status status = RITZ_OK;
    const ritz_elimination *by = &tying->by;
    bool *gone = NULL;

    RITZ_NEW(gone, tying->names.count);
    for (int64_t k = 0; k < by->gone.count; k++)
        gone[by->gone.at[k]] = true;
    for (int64_t k = 0; k < tying->names.count; k++) {
        if (gone[k])
            present[k] = is_known(tying, turned, k);
        if (!tying->alive[k])
            continue;
        for (int64_t p = turned->colptr[k]; p < turned->colptr[k + 1]; p++)
            present[by->kept.at[turned->rowind[p]]] = true;
    }
done:
    free(gone);
    return status;
}

/* The same as a component of which ports can be made. */
static ritz_status list_present(const ritz_tying *tying,
                                const ritz_sparse *turned, ritz_extended *out)
{
    ritz_status status = RITZ_OK;
    bool *present = NULL;
    ritz_extended new = {0};

    new.view.grids = tying->deck->grids;
    RITZ_NEW(present, tying->names.count);
    RITZ_NEW(new.view.dof, tying->names.count);
    RITZ_TRY(find_present(tying, turned, present));
    for (int64_t k = 0; k < tying->names.count; k++)
        if (present[k])
            new.view.dof[new.view.num_dofs++] = tying->names.dof[k];
    new.num_rows = new.view.num_dofs;
    RITZ_TRY(ritz_roster_new(new.num_rows, new.view.dof, &new.roster));
    *out = new;
    new = (ritz_extended){0};
done:
    free(present);
    ritz_extended_free(&new);
    return status;
}

static ritz_status group_dofs(const ritz_extended *extended, ritz_tied *it)
{
    const ritz_grids *grids = &it->deck->grids;
    ritz_tie tie = {.weight = 1.0};

    for (int64_t i = 0; i < it->port.dofs.count; i++) {
        ritz_dof dof = extended->view.dof[it->port.dofs.at[i]];
        int64_t k = ritz_grids_find(grids, dof.grid);

        RITZ_REFUSE_IF(k < 0 || dof.component == 0, RITZ_ERR_ARGUMENT,
                       "'%" PRId64
                       "' has no position: those of grids are known "
                       "from the deck alone (--bulk)",
                       dof.grid);
        if (i > 0 && k != tie.grid) {
            RITZ_CHECK(ritz_ties_add(&it->over, tie));
            tie.mask = 0;
        }
        tie.grid = k;
        tie.mask |= (uint8_t)(1U << (unsigned)dof.component);
    }
    return ritz_ties_add(&it->over, tie);
}

/* ---- the new grid ------------------------------------------------------ */

static int64_t largest_id(const ritz_deck *deck, const ritz_names *names)
{
    int64_t most = 0;

    for (int64_t k = 0; k < names->count; k++)
        if (names->dof[k].grid > most)
            most = names->dof[k].grid;
    if (deck->num_points > 0 && deck->point[deck->num_points - 1] > most)
        most = deck->point[deck->num_points - 1];
    if (deck->grids.id[deck->grids.count - 1] > most)
        most = deck->grids.id[deck->grids.count - 1];
    return most;
}

/* Its id is above all others, so that grids still ascend. */
static ritz_status add_grid(ritz_tied *it)
{
    ritz_status status = RITZ_OK;
    ritz_grids *grids = &it->deck->grids;
    int64_t n = grids->count;
    int64_t *id = NULL, *frame = NULL;
    double *position = NULL;
    ritz_dof dof[SIX];

    it->id = largest_id(it->deck, &it->tying->names);
    RITZ_FAIL_IF(it->id >= INT64_MAX - 1, RITZ_ERR_ARGUMENT,
                 "no id is left for its grid");
    it->id++;
    RITZ_NEW(id, n + 1);
    RITZ_NEW(frame, n + 1);
    RITZ_NEW(position, 3 * (n + 1));
    memcpy(id, grids->id, (size_t)n * sizeof *id);
    memcpy(frame, grids->frame, (size_t)n * sizeof *frame);
    memcpy(position, grids->position, 3 * (size_t)n * sizeof *position);
    id[n] = it->id;
    memcpy(position + 3 * n, it->port.origin, sizeof it->port.origin);
    for (int64_t c = 1; c <= SIX; c++)
        dof[c - 1] = (ritz_dof){it->id, c};
    RITZ_TRY(ritz_tying_append(SIX, dof, it->tying));
    free(grids->id);
    free(grids->frame);
    free(grids->position);
    grids->id = id;
    grids->frame = frame;
    grids->position = position;
    grids->count = n + 1;
    id = frame = NULL;
    position = NULL;
done:
    free(id);
    free(frame);
    free(position);
    return status;
}

/* ---- rigid ------------------------------------------------------------- */

ritz_status ritz_tied_cite(const ritz_tied *it)
{
    ritz_equation_source from = {.file = -1};

    snprintf(from.name, sizeof from.name, "%s port %.44s",
             it->rigid ? "rigid" : "averaged", it->port.name);
    return ritz_equations_cite_next(&it->deck->equations, from);
}

static ritz_status tie_rigid(ritz_tied *it)
{
    ritz_status status = RITZ_OK;
    const ritz_tie whole = {it->deck->grids.count - 1, 0x7e, 1.0};
    ritz_ties from = {0};

    RITZ_TRY(ritz_ties_add(&from, whole));
    RITZ_TRY(ritz_tied_cite(it));
    RITZ_TRY(ritz_tie_rigid(&it->deck->grids, &from, &it->over,
                            &it->deck->equations));
done:
    ritz_ties_free(&from);
    return status;
}

ritz_status ritz_tied_refuse(int64_t open)
{
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "its dofs leave %" PRId64 " of six motions open (do its "
                     "grids lie on a line?): name more of them",
                     open);
}

/* ---- one after the other ----------------------------------------------- */

/* What ports hold must not depend: that of --port, and grids made before. */
static ritz_status find_held(const ritz_extended *present,
                             const ritz_import_report *report, ritz_tied *it)
{
    ritz_status status = RITZ_OK;
    const ritz_names *names = &it->tying->names;
    ritz_port port = {0};
    ritz_roster roster = {0};

    RITZ_NEW(it->held, names->count + SIX);
    RITZ_TRY(ritz_roster_new(names->count, names->dof, &roster));
    for (int64_t k = 0; k < it->request->num_ports; k++) {
        RITZ_TRY_IN(
            it->request->port[k],
            ritz_import_port(it->request->port[k], false, present, &port));
        for (int64_t i = 0; i < port.dofs.count; i++)
            it->held[ritz_roster_row(
                &roster, present->view.dof[port.dofs.at[i]])] = true;
        ritz_dofs_free(&port.dofs);
    }
    for (int64_t k = 0; k < report->num_grids; k++)
        for (int64_t c = 1; c <= SIX; c++)
            it->held[ritz_roster_row(&roster,
                                     (ritz_dof){report->grid[k].id, c})] = true;
done:
    ritz_roster_free(&roster);
    return status;
}

static ritz_status tie(ritz_tied *it, const ritz_import_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_extended present = {0};
    ritz_sparse turned = {0};

    RITZ_FAIL_IF(it->deck->grids.count == 0, RITZ_ERR_ARGUMENT,
                 "positions of its grids are known from a deck alone: --bulk");
    RITZ_TRY(ritz_sparse_transpose(&it->tying->by.G, &turned));
    RITZ_TRY(list_present(it->tying, &turned, &present));
    RITZ_TRY(ritz_import_port(it->text, false, &present, &it->port));
    RITZ_TRY(find_held(&present, report, it));
    RITZ_TRY(group_dofs(&present, it));
    RITZ_TRY(ritz_average_new(&it->deck->grids, &it->over, it->port.origin,
                              &it->average));
    if (it->average.num_loose > 0)
        RITZ_TRY(ritz_tied_refuse(it->average.num_loose));
    RITZ_TRY(add_grid(it));
    RITZ_TRY(it->rigid ? tie_rigid(it) : ritz_tied_average(it, &turned));
    RITZ_TRY(ritz_tying_solve(it->tying));
done:
    ritz_extended_free(&present);
    ritz_sparse_free(&turned);
    return status;
}

static ritz_status add_port(ritz_tied *it, ritz_import_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_import_grid *grid = &report->grid[report->num_grids];

    RITZ_TRY_IN(it->text, tie(it, report));
    memcpy(grid->port, it->port.name, sizeof grid->port);
    grid->id = it->id;
    grid->num_tied = it->port.dofs.count;
    report->num_grids++;
done:
    free(it->held);
    ritz_dofs_free(&it->port.dofs);
    ritz_ties_free(&it->over);
    ritz_average_free(&it->average);
    return status;
}

ritz_status ritz_tying_ports(const ritz_import_request *request,
                             ritz_deck *deck, ritz_tying *tying,
                             ritz_import_report *report)
{
    int64_t count = request->num_rigid_ports + request->num_averaged_ports;

    RITZ_CHECK_NEW(report->grid, count);
    for (int64_t k = 0; k < count; k++) {
        int64_t j = k - request->num_rigid_ports;
        ritz_tied it = {.text = j < 0 ? request->rigid_port[k]
                                      : request->averaged_port[j],
                        .rigid = j < 0,
                        .request = request,
                        .deck = deck,
                        .tying = tying};

        RITZ_CHECK(add_port(&it, report));
    }
    return RITZ_OK;
}
