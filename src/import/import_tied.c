/*
 * Ports of one grid that is made for them, at the mean position of theirs.
 *
 * Rigid: the dofs u of the port's grids follow the new grid, u = S q.
 * Averaged: the new grid is their average, q = A u.
 * Forces on it are spread to the dofs as A' f, and nothing is stiffened.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "import/import.h"
#include "model/equations.h"

#include <lapacke.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A port while it is tied. */
typedef struct ritz_tied {
    const char *text;
    bool rigid;
    const ritz_import_request *request;
    ritz_deck *deck;
    ritz_tying *tying;
    ritz_port port;
    bool *held; /* dofs of all names that ports hold */
    ritz_ties over;
    int64_t id;           /* of the new grid */
    ritz_average average; /* of its dofs */
} ritz_tied;

static void ritz_tied_free(ritz_tied *it)
{
    free(it->held);
    ritz_dofs_free(&it->port.dofs);
    ritz_ties_free(&it->over);
    ritz_average_free(&it->average);
}

enum { SIX = 6 };

/* Name this port as the source of the equations that follow. */
static ritz_status cite_port(const ritz_tied *it)
{
    ritz_equation_source from = {.file = -1};

    snprintf(from.name, sizeof from.name, "%s port %.44s",
             it->rigid ? "rigid" : "averaged", it->port.name);
    return ritz_equations_cite_next(&it->deck->equations, from);
}

/* Refuse dofs that leave rigid motions of their grid undetermined. */
static ritz_status refuse_open(int64_t open)
{
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "its dofs leave %" PRId64 " of six motions open (do its "
                     "grids lie on a line?): name more of them",
                     open);
}

/* ---- averaged ports ----------------------------------------------------- */

/*
 * An averaged port: its grid is the average of its dofs, q = A u, and so that q
 * can be held, six of these depend on it and the others,
 *
 *     A_p u_p + A_r u_r = q,    u_p = A_p^-1 (q - A_r u_r)
 *
 * chosen by QR with column pivoting, which keeps A_p^-1 small. Where the dofs
 * depend on others already, A stands for A G. What ports hold is not chosen.
 */

/* The average over dofs that depend on nothing: A G, and what its columns
 * are; those that a port holds come last. */
typedef struct reach {
    ritz_dense A; /* 6 x k, scaled so that lengths cancel */
    int64_t num_free;
    ritz_dof *dof;
} reach;

static void reach_free(reach *over)
{
    free(over->dof);
    ritz_dense_free(&over->A);
}

/* Columns of A G that are not zero, of dofs held or not, from `first` on;
 * place[j]: column of j there. */
static int64_t place_columns(const ritz_tied *it, const ritz_sparse *turned,
                             const int64_t *row, bool held, int64_t first,
                             int64_t *place)
{
    const ritz_tying *tying = it->tying;

    for (int64_t i = 0; i < it->average.A.ncol; i++)
        for (int64_t p = turned->colptr[row[i]]; p < turned->colptr[row[i] + 1];
             p++) {
            int64_t j = turned->rowind[p];
            int64_t k = tying->by.kept.at[j];

            if (!(tying->mark[k] & RITZ_TIED_FIXED) && it->held[k] == held &&
                place[j] < 0)
                place[j] = first++;
        }
    return first;
}

static void spread_average(const ritz_tied *it, const ritz_sparse *turned,
                           const int64_t *row, const int64_t *place, reach *out)
{
    const ritz_average *average = &it->average;
    const ritz_tying *tying = it->tying;

    for (int64_t i = 0; i < average->A.ncol; i++)
        for (int64_t p = turned->colptr[row[i]]; p < turned->colptr[row[i] + 1];
             p++) {
            int64_t j = place[turned->rowind[p]];
            ritz_dof dof =
                tying->names.dof[tying->by.kept.at[turned->rowind[p]]];
            double share =
                turned->val[p] / ritz_tie_scale(dof, average->length);

            if (j < 0)
                continue;
            out->dof[j] = dof;
            for (int k = 0; k < SIX; k++)
                ritz_dense_col(&out->A, j)[k] +=
                    share * ritz_dense_col(&average->A, i)[k] *
                    (k < 3 ? 1.0 : average->length);
        }
}

static ritz_status substitute_dependents(const ritz_tied *it,
                                         const ritz_sparse *turned, reach *out)
{
    const ritz_tying *tying = it->tying;
    int64_t count = it->average.A.ncol;
    RITZ_OWN_ARRAY int64_t *row = NULL, *place = NULL;
    int64_t found = 0;
    RITZ_OWN(ritz_roster) roster = {0};

    RITZ_CHECK_NEW(row, count);
    RITZ_CHECK_NEW(place, tying->by.kept.count);
    RITZ_CHECK(ritz_roster_new(tying->names.count, tying->names.dof, &roster));
    for (int64_t i = 0; i < count; i++)
        row[i] = ritz_roster_row(&roster, it->average.dof[i]);
    for (int64_t j = 0; j < tying->by.kept.count; j++)
        place[j] = -1;
    out->num_free = place_columns(it, turned, row, false, 0, place);
    found = place_columns(it, turned, row, true, out->num_free, place);
    RITZ_CHECK_NEW(out->dof, found);
    RITZ_CHECK(ritz_dense_new(SIX, found, &out->A));
    spread_average(it, turned, row, place, out);
    return RITZ_OK;
}

/* Motions that the first columns of A leave open, by its triangular factor. */
static int64_t count_open(const ritz_dense *A)
{
    double rcond = 0.0;
    int64_t rank = 0;

    (void)LAPACKE_dtrcon(LAPACK_COL_MAJOR, '1', 'U', 'N', SIX, A->val, SIX,
                         &rcond);
    if (rcond > RITZ_HALF_DIGITS)
        return 0;
    while (rank < SIX - 1 && fabs(ritz_dense_col(A, rank)[rank]) >
                                 RITZ_HALF_DIGITS * fabs(A->val[0]))
        rank++;
    return SIX - rank;
}

static ritz_status check_open(const reach *over, int64_t open)
{
    if (open == 0)
        return RITZ_OK;
    if (over->num_free == over->A.ncol)
        return refuse_open(open);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "six of its dofs are to depend on it, and without those "
                     "that other ports hold %" PRId64 " motions are left open: "
                     "name more of them",
                     open);
}

/* A := Q' A with A_p = Q R in front, by pivoting among the free columns. */
static ritz_status factor_columns(reach *over, lapack_int *order, double *tau)
{
    ritz_dense *A = &over->A;
    int64_t k = over->num_free;

    RITZ_CHECK(check_open(over, k < SIX ? SIX - k : 0));
    for (int64_t j = k; j < A->ncol; j++)
        order[j] = (lapack_int)j + 1;
    RITZ_REFUSE_IF(LAPACKE_dgeqp3(LAPACK_COL_MAJOR, SIX, (lapack_int)k, A->val,
                                  SIX, order, tau) != 0,
                   RITZ_ERR_MEMORY, "no memory for the average");
    if (A->ncol > k)
        RITZ_REFUSE_IF(LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'T', SIX,
                                      (lapack_int)(A->ncol - k), SIX, A->val,
                                      SIX, tau, ritz_dense_col(A, k), SIX) != 0,
                       RITZ_ERR_MEMORY, "no memory for the average");
    return check_open(over, count_open(A));
}

/* X = R_p^-1 [Q', -R_r]: u_p = X [q; u_r]. */
static ritz_status pivot_columns(reach *over, lapack_int *order, ritz_dense *X)
{
    const ritz_dense *A = &over->A;
    lapack_int k = (lapack_int)A->ncol;
    double tau[SIX];

    RITZ_CHECK(factor_columns(over, order, tau));
    RITZ_CHECK(ritz_dense_new(SIX, k, X));
    for (int64_t j = 0; j < SIX; j++)
        ritz_dense_col(X, j)[j] = 1.0;
    RITZ_REFUSE_IF(LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'T', SIX, SIX, SIX,
                                  A->val, SIX, tau, X->val, SIX) != 0,
                   RITZ_ERR_MEMORY, "no memory for the average");
    for (int64_t j = SIX; j < k; j++)
        for (int64_t i = 0; i < SIX; i++)
            ritz_dense_col(X, j)[i] = -ritz_dense_col(A, j)[i];
    RITZ_REFUSE_IF(LAPACKE_dtrtrs(LAPACK_COL_MAJOR, 'U', 'N', 'N', SIX, k,
                                  A->val, SIX, X->val, SIX) != 0,
                   RITZ_ERR_SINGULAR, "the average is singular");
    return RITZ_OK;
}

static ritz_status put_equations(const ritz_tied *it, const ritz_dense *X,
                                 const ritz_dof *dof, const lapack_int *order)
{
    ritz_equations *eq = &it->deck->equations;
    double length = it->average.length;

    for (int64_t i = 0; i < SIX; i++) {
        ritz_dof dependent = dof[order[i] - 1];
        double most = 0.0;

        RITZ_CHECK(ritz_equations_begin(eq, dependent));
        for (int64_t j = 0; j < X->ncol; j++)
            most = fmax(most, fabs(ritz_dense_col(X, j)[i]));
        for (int64_t j = 0; j < X->ncol; j++) {
            ritz_dof of =
                j < SIX ? (ritz_dof){it->id, j + 1} : dof[order[j] - 1];
            double share = ritz_dense_col(X, j)[i];

            if (fabs(share) > RITZ_TIE_ROUNDING * most)
                RITZ_CHECK(
                    ritz_equations_add(eq, of,
                                       share * ritz_tie_scale(of, length) /
                                           ritz_tie_scale(dependent, length)));
        }
    }
    return RITZ_OK;
}

/*
 * Make six of the port's dofs depend on its grid and the others.
 *
 * @param[in] turned  G' of what was solved before the grid was added
 */
static ritz_status tie_average(const ritz_tied *it, const ritz_sparse *turned)
{
    RITZ_OWN(reach) over = {0};
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN_ARRAY lapack_int *order = NULL;

    RITZ_CHECK(substitute_dependents(it, turned, &over));
    RITZ_CHECK_NEW(order, over.A.ncol);
    RITZ_CHECK(pivot_columns(&over, order, &X));
    RITZ_CHECK(cite_port(it));
    return put_equations(it, &X, over.dof, order);
}

/* ---- the dofs that there are -------------------------------------------- */

/* Dofs that a port may name: with stiffness or mass, their own or that of what
 * depends on them, or dependent on such. */
static ritz_status find_present(const ritz_tying *tying,
                                const ritz_sparse *turned, bool *present)
{
    const ritz_elimination *by = &tying->by;
    RITZ_OWN_ARRAY bool *unknown = NULL;

    RITZ_CHECK_NEW(unknown, tying->names.count);
    ritz_tying_unknown(tying, unknown);
    for (int64_t k = 0; k < by->gone.count; k++)
        present[by->gone.at[k]] = !unknown[by->gone.at[k]];
    for (int64_t k = 0; k < tying->names.count; k++)
        for (int64_t p = turned->colptr[k];
             tying->mark[k] & RITZ_TIED_ALIVE && p < turned->colptr[k + 1]; p++)
            present[by->kept.at[turned->rowind[p]]] = true;
    return RITZ_OK;
}

/* These dofs as a component, on which ports can be defined. */
static ritz_status list_present(const ritz_tying *tying,
                                const ritz_sparse *turned, ritz_extended *out)
{
    RITZ_OWN_ARRAY bool *present = NULL;
    RITZ_OWN(ritz_extended) new = {0};

    new.view.grids = tying->deck->grids;
    RITZ_CHECK_NEW(present, tying->names.count);
    RITZ_CHECK_NEW(new.view.dof, tying->names.count);
    RITZ_CHECK(find_present(tying, turned, present));
    for (int64_t k = 0; k < tying->names.count; k++)
        if (present[k])
            new.view.dof[new.view.num_dofs++] = tying->names.dof[k];
    new.num_rows = new.view.num_dofs;
    RITZ_CHECK(ritz_roster_new(new.num_rows, new.view.dof, &new.roster));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
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

/* ---- the new grid ------------------------------------------------------- */

static int64_t largest_id(const ritz_deck *deck, const ritz_row_names *names)
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
    ritz_grids *grids = &it->deck->grids;
    int64_t n = grids->count;
    ritz_dof dof[SIX];

    it->id = largest_id(it->deck, &it->tying->names);
    RITZ_REFUSE_IF(it->id >= INT64_MAX - 1, RITZ_ERR_ARGUMENT,
                   "no id is left for its grid");
    it->id++;
    for (int64_t c = 1; c <= SIX; c++)
        dof[c - 1] = (ritz_dof){it->id, c};
    RITZ_CHECK(ritz_tying_append(SIX, dof, it->tying));
    RITZ_CHECK(ritz_array_extend(&grids->id, n, 1, sizeof *grids->id));
    RITZ_CHECK(ritz_array_extend(&grids->frame, n, 1, sizeof *grids->frame));
    RITZ_CHECK(
        ritz_array_extend(&grids->position, 3 * n, 3, sizeof *grids->position));
    grids->id[n] = it->id;
    memcpy(grids->position + 3 * n, it->port.origin, sizeof it->port.origin);
    grids->count = n + 1;
    return RITZ_OK;
}

static ritz_status tie_rigid(ritz_tied *it)
{
    const ritz_tie whole = {it->deck->grids.count - 1, 0x7e, 1.0};
    RITZ_OWN(ritz_ties) from = {0};

    RITZ_CHECK(ritz_ties_add(&from, whole));
    RITZ_CHECK(cite_port(it));
    return ritz_tie_rigid(&it->deck->grids, &from, &it->over,
                          &it->deck->equations);
}

/* ---- one after the other ------------------------------------------------ */

/* Dofs of ports must not depend on others: mark those of --port and of the
 * grids that were made before. */
static ritz_status find_held(const ritz_extended *present,
                             const ritz_import_report *report, ritz_tied *it)
{
    const ritz_row_names *names = &it->tying->names;
    ritz_port port = {0};
    RITZ_OWN(ritz_roster) roster = {0};

    RITZ_CHECK_NEW(it->held, names->count + SIX);
    RITZ_CHECK(ritz_roster_new(names->count, names->dof, &roster));
    for (int64_t k = 0; k < it->request->num_ports; k++) {
        RITZ_CHECK_IN(
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
    return RITZ_OK;
}

static ritz_status tie_port(ritz_tied *it, const ritz_import_report *report)
{
    RITZ_OWN(ritz_extended) present = {0};
    RITZ_OWN(ritz_sparse) turned = {0};

    RITZ_REFUSE_IF(
        it->deck->grids.count == 0, RITZ_ERR_ARGUMENT,
        "positions of its grids are known from a deck alone: --bulk");
    RITZ_CHECK(ritz_sparse_transpose(&it->tying->by.G, &turned));
    RITZ_CHECK(list_present(it->tying, &turned, &present));
    RITZ_CHECK(ritz_import_port(it->text, false, &present, &it->port));
    RITZ_CHECK(find_held(&present, report, it));
    RITZ_CHECK(group_dofs(&present, it));
    RITZ_CHECK(ritz_average_new(&it->deck->grids, &it->over, it->port.origin,
                                &it->average));
    if (it->average.num_loose > 0)
        RITZ_CHECK(refuse_open(it->average.num_loose));
    RITZ_CHECK(add_grid(it));
    RITZ_CHECK(it->rigid ? tie_rigid(it) : tie_average(it, &turned));
    return ritz_tying_solve(it->tying);
}

ritz_status ritz_tying_ports(const ritz_import_request *request,
                             ritz_deck *deck, ritz_tying *tying,
                             ritz_import_report *report)
{
    int64_t count = request->num_rigid_ports + request->num_averaged_ports;

    RITZ_CHECK_NEW(report->grid, count);
    for (int64_t k = 0; k < count; k++) {
        int64_t j = k - request->num_rigid_ports;
        ritz_import_grid *grid = &report->grid[k];
        RITZ_OWN(ritz_tied)
        it = {.text =
                  j < 0 ? request->rigid_port[k] : request->averaged_port[j],
              .rigid = j < 0,
              .request = request,
              .deck = deck,
              .tying = tying};

        RITZ_CHECK_IN(it.text, tie_port(&it, report));
        memcpy(grid->port, it.port.name, sizeof grid->port);
        grid->id = it.id;
        grid->num_tied = it.port.dofs.count;
        report->num_grids++;
    }
    return RITZ_OK;
}
