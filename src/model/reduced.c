/* Reduced components: projection of a component on a basis. */
#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "model/congruences.h"
#include "model/equations.h"

#include <ritz/model.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Residual flexibility without mass has zero rows and columns in M and D. */
static void clear_massless(const ritz_columns *columns, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            if (columns->kind[i] == RITZ_COLUMN_MASSLESS ||
                columns->kind[j] == RITZ_COLUMN_MASSLESS)
                ritz_dense_col(A, j)[i] = 0.0;
}

/*
 * A column that combines massless dofs alone has a mass that is rounding. An
 * eigenvalue above 1/eps times the largest of motions with mass cannot be told
 * from an infinite one: such a mass is set to zero.
 */
static void clear_rounding(const ritz_fastest *fastest, const ritz_dense *K,
                           ritz_dense *M)
{
    const double limit = fastest->massless ? fastest->ratio / DBL_EPSILON : 0.0;

    for (int64_t j = 0; j < M->ncol && limit > 0.0; j++) {
        if (ritz_dense_col(K, j)[j] <= limit * fabs(ritz_dense_col(M, j)[j]))
            continue;
        for (int64_t i = 0; i < M->nrow; i++)
            ritz_dense_col(M, j)[i] = ritz_dense_col(M, i)[j] = 0.0;
    }
}

/*
 * Rigid-body motions store no energy: entries of T'KT that are rounding of
 * |T|'|K||T| for them become 0. Otherwise rounding would be the only stiffness
 * of a statically determinate interface, and would mix flexible motion into the
 * rigid modes of every system with this body. Rigid-body motions do not
 * dissipate energy either, so T'K4T is treated in the same way.
 */
static void settle_rigid(const ritz_columns *columns, const ritz_dense *most,
                         ritz_dense *Kr)
{
    for (int64_t j = 0; j < Kr->ncol; j++)
        for (int64_t i = 0; i < Kr->nrow; i++)
            if ((ritz_may_be_rigid(columns->kind[i]) ||
                 ritz_may_be_rigid(columns->kind[j])) &&
                fabs(ritz_dense_col(Kr, j)[i]) <=
                    RITZ_SUM_ROUNDING * ritz_dense_col(most, j)[i])
                ritz_dense_col(Kr, j)[i] = 0.0;
    ritz_dense_symmetrise(Kr);
}

static ritz_status copy_grids(const ritz_grids *grids, ritz_grids *out)
{
    int64_t n = grids->count, frames = grids->num_frames;
    RITZ_OWN(ritz_grids) copy = {.count = n, .num_frames = frames};

    RITZ_CHECK_COPY(copy.id, grids->id, n);
    RITZ_CHECK_COPY(copy.position, grids->position, 3 * n);
    RITZ_CHECK_COPY(copy.frame, grids->frame, n);
    RITZ_CHECK_COPY(copy.axes, grids->axes, 9 * frames);
    RITZ_MOVE(*out, copy);
    return RITZ_OK;
}

/* Names of the rows of T: dofs, grids, elements, recovered dofs. */
static ritz_status copy_rows(int64_t n, const ritz_dof *dof,
                             const ritz_grids *grids,
                             const ritz_elements *elements,
                             const ritz_recovery *recovery, ritz_reduced *out)
{
    RITZ_CHECK_COPY(out->dof, dof, n);
    RITZ_CHECK(copy_grids(grids, &out->grids));
    RITZ_CHECK(ritz_elements_copy(elements, &out->elements));
    return ritz_recovery_copy(recovery, &out->recovery);
}

ritz_status ritz_port_map_of(const ritz_component *component,
                             const ritz_port *port, const ritz_dense *T,
                             ritz_port_map *map)
{
    const ritz_grids *grids = &component->grids;
    RITZ_OWN(ritz_dense) turn = {0}, rows = {0};

    memcpy(map->name, port->name, sizeof map->name);
    memcpy(map->origin, port->origin, sizeof map->origin);
    memcpy(map->axes, port->axes, sizeof map->axes);
    map->count = port->dofs.count;
    RITZ_CHECK(ritz_port_turn(component, port, &turn, &map->dof));
    if (T) {
        RITZ_CHECK(ritz_dense_rows(T, port->dofs.count, port->dofs.at, &rows));
        RITZ_CHECK(ritz_dense_mul(&turn, &rows, &map->map));
    } else {
        RITZ_MOVE(map->map, turn);
    }
    RITZ_CHECK_NEW(map->position, 3 * map->count);
    for (int64_t i = 0; i < map->count; i++) {
        int64_t k = ritz_grids_find(grids, map->dof[i].grid);

        if (k >= 0)
            memcpy(map->position + 3 * i, grids->position + 3 * k,
                   3 * sizeof *map->position);
    }
    return RITZ_OK;
}

static ritz_status map_ports(const ritz_component *component,
                             const ritz_dense *T, ritz_reduced *reduced)
{
    RITZ_CHECK_NEW(reduced->port, component->num_ports);
    for (int64_t k = 0; k < component->num_ports; k++) {
        reduced->num_ports++;
        RITZ_CHECK(ritz_port_map_of(component, &component->port[k], T,
                                    &reduced->port[k]));
    }
    return RITZ_OK;
}

static ritz_status keep_names(const ritz_component *component,
                              const ritz_basis *basis, ritz_reduced *reduced)
{
    reduced->origin = basis->origin;
    reduced->num_dofs = component->num_dofs;
    memcpy(reduced->units, component->units, sizeof reduced->units);
    memcpy(reduced->remark, basis->remark, sizeof reduced->remark);
    memcpy(reduced->damping, component->damping, sizeof reduced->damping);
    RITZ_CHECK(ritz_columns_pick(&basis->columns, basis->columns.count, NULL,
                                 &reduced->columns));
    RITZ_CHECK(ritz_dense_copy(&basis->T, &reduced->T));
    return copy_rows(component->num_dofs, component->dof, &component->grids,
                     &component->elements, &component->recovery, reduced);
}

static ritz_status refuse_basis(const ritz_component *component,
                                const ritz_basis *basis)
{
    RITZ_REFUSE_IF(basis->states, RITZ_ERR_ARGUMENT,
                   "the basis of '%s' is of states, it makes a state space and "
                   "no masses and stiffnesses",
                   basis->origin.method);
    RITZ_REFUSE_IF(basis->W.val, RITZ_ERR_ARGUMENT,
                   "the basis of '%s' has left vectors of its own, it makes a "
                   "state space and no symmetric masses and stiffnesses",
                   basis->origin.method);
    RITZ_REFUSE_IF(basis->T.nrow != component->num_dofs, RITZ_ERR_ARGUMENT,
                   "the basis is for %lld dofs, the component has %lld",
                   (long long)basis->T.nrow, (long long)component->num_dofs);
    return RITZ_OK;
}

static ritz_status project_quantities(int64_t count,
                                      const ritz_quantity *quantity,
                                      const ritz_dense *T, ritz_reduced *out)
{
    RITZ_CHECK(ritz_quantities_project(count, quantity, T, &out->quantity));
    out->num_quantities = count;
    return RITZ_OK;
}

ritz_status ritz_congruences_reduce(const ritz_component *component,
                                    const ritz_basis *basis,
                                    ritz_congruences *sums, ritz_reduced *out)
{
    const ritz_columns *columns = &basis->columns;
    const ritz_dense *T = &basis->T;
    RITZ_OWN(ritz_reduced) reduced = {0};

    RITZ_CHECK(refuse_basis(component, basis));
    RITZ_CHECK(keep_names(component, basis, &reduced));
    if (sums->rigid.val)
        ritz_inertia_read(&sums->rigid, &reduced.inertia);
    settle_rigid(columns, &sums->K_terms, &sums->K);
    clear_rounding(&sums->fastest, &sums->K, &sums->M);
    clear_massless(columns, &sums->M);
    clear_massless(columns, &sums->D);
    if (sums->K4.val)
        settle_rigid(columns, &sums->K4_terms, &sums->K4);
    RITZ_MOVE(reduced.K, sums->K);
    RITZ_MOVE(reduced.M, sums->M);
    RITZ_MOVE(reduced.D, sums->D);
    RITZ_MOVE(reduced.K4, sums->K4);
    RITZ_MOVE(reduced.load, sums->load);
    RITZ_MOVE(reduced.num_loads, sums->num_loads);
    RITZ_MOVE(reduced.invariants, sums->invariants);
    RITZ_CHECK(ritz_dampers_project(&component->dampers, T, &reduced.dampers));
    RITZ_CHECK(map_ports(component, T, &reduced));
    RITZ_CHECK(ritz_io_project(&component->io, T, &reduced.io));
    RITZ_CHECK(project_quantities(component->num_quantities,
                                  component->quantity, T, &reduced));
    RITZ_MOVE(*out, reduced);
    return RITZ_OK;
}

ritz_status ritz_reduce(const ritz_component *component,
                        const ritz_basis *basis, ritz_reduced *out)
{
    RITZ_OWN(ritz_congruences) sums = {0};
    RITZ_OWN(ritz_dense) G = {0};
    bool twofold = false;

    RITZ_CHECK(refuse_basis(component, basis));
    if (basis->T.ncol > 0 && basis->T.nrow > 0)
        RITZ_CHECK(ritz_dense_mul_tn(&basis->T, &basis->T, &G));
    RITZ_CHECK(ritz_congruences_twofold(&G, &twofold));
    RITZ_CHECK(ritz_congruences_of(component, basis->columns.kind, &basis->T,
                                   twofold, &sums));
    for (int64_t j = 0; j < component->num_dofs; j++)
        ritz_fastest_add(ritz_sparse_diagonal(&component->K, j),
                         ritz_sparse_diagonal(&component->M, j), &sums.fastest);
    return ritz_congruences_reduce(component, basis, &sums, out);
}

static ritz_status project_ports(const ritz_reduced *from, const ritz_dense *V,
                                 ritz_reduced *to)
{
    RITZ_CHECK_NEW(to->port, from->num_ports);
    for (int64_t k = 0; k < from->num_ports; k++) {
        const ritz_port_map *port = &from->port[k];
        ritz_port_map *copy = &to->port[k];

        to->num_ports++;
        *copy = *port;
        copy->dof = NULL;
        copy->position = NULL;
        copy->map = (ritz_dense){0};
        RITZ_CHECK_COPY(copy->dof, port->dof, port->count);
        RITZ_CHECK_COPY(copy->position, port->position, 3 * port->count);
        RITZ_CHECK(ritz_dense_mul(&port->map, V, &copy->map));
    }
    return RITZ_OK;
}

ritz_status ritz_reduced_project(const ritz_reduced *reduced,
                                 const ritz_dense *V, ritz_reduced *out)
{
    RITZ_OWN(ritz_reduced)
    second = {.origin = reduced->origin,
              .inertia = reduced->inertia,
              .num_dofs = reduced->num_dofs};
    ritz_fastest fastest = {0};

    memcpy(second.units, reduced->units, sizeof second.units);
    memcpy(second.remark, reduced->remark, sizeof second.remark);
    memcpy(second.damping, reduced->damping, sizeof second.damping);
    RITZ_CHECK(ritz_columns_new(V->ncol, &second.columns));
    for (int64_t j = 0; j < V->ncol; j++)
        second.columns.kind[j] = RITZ_COLUMN_SYSTEM;
    RITZ_CHECK(ritz_dense_congruence(&reduced->K, V, &second.K));
    RITZ_CHECK(ritz_dense_congruence(&reduced->M, V, &second.M));
    for (int64_t j = 0; j < reduced->M.ncol; j++)
        ritz_fastest_add(ritz_dense_col(&reduced->K, j)[j],
                         ritz_dense_col(&reduced->M, j)[j], &fastest);
    clear_rounding(&fastest, &second.K, &second.M);
    if (reduced->D.val)
        RITZ_CHECK(ritz_dense_project(&reduced->D, V, &second.D));
    if (reduced->K4.val)
        RITZ_CHECK(ritz_dense_congruence(&reduced->K4, V, &second.K4));
    RITZ_CHECK(
        ritz_loads_project(reduced->num_loads, reduced->load, V, &second.load));
    second.num_loads = reduced->num_loads;
    RITZ_CHECK(ritz_dampers_project(&reduced->dampers, V, &second.dampers));
    RITZ_CHECK(project_ports(reduced, V, &second));
    RITZ_CHECK(ritz_io_project(&reduced->io, V, &second.io));
    RITZ_CHECK(project_quantities(reduced->num_quantities, reduced->quantity, V,
                                  &second));
    RITZ_CHECK(
        ritz_invariants_project(&reduced->invariants, V, &second.invariants));
    if (reduced->T.val) {
        RITZ_CHECK(ritz_dense_mul(&reduced->T, V, &second.T));
        RITZ_CHECK(copy_rows(reduced->num_dofs, reduced->dof, &reduced->grids,
                             &reduced->elements, &reduced->recovery, &second));
    }
    RITZ_MOVE(*out, second);
    return RITZ_OK;
}

ritz_status ritz_reduced_install(ritz_reduced *reduced)
{
    return ritz_dampers_install(&reduced->dampers, &reduced->K, &reduced->D);
}

const ritz_port_map *ritz_reduced_port(const ritz_reduced *reduced,
                                       const char *name)
{
    const ritz_names names = {"port", reduced->num_ports, (char *)reduced->port,
                              sizeof *reduced->port};
    int64_t k = ritz_names_seek(&names, name);

    return k < 0 ? NULL : &reduced->port[k];
}

void ritz_port_map_free(ritz_port_map *port)
{
    RITZ_FREE(port->dof, port->position);
    ritz_dense_free(&port->map);
    *port = (ritz_port_map){0};
}

void ritz_reduced_free(ritz_reduced *reduced)
{
    ritz_dense_free(&reduced->K);
    ritz_dense_free(&reduced->M);
    ritz_dense_free(&reduced->D);
    ritz_dense_free(&reduced->K4);
    RITZ_FREE_EACH(ritz_reduced_load, reduced->num_loads, reduced->load);
    ritz_dampers_free(&reduced->dampers);
    ritz_columns_free(&reduced->columns);
    RITZ_FREE_EACH(ritz_port_map, reduced->num_ports, reduced->port);
    ritz_io_free(&reduced->io);
    RITZ_FREE_EACH(ritz_quantity, reduced->num_quantities, reduced->quantity);
    ritz_invariants_free(&reduced->invariants);
    ritz_dense_free(&reduced->T);
    free(reduced->dof);
    ritz_grids_free(&reduced->grids);
    ritz_elements_free(&reduced->elements);
    ritz_recovery_free(&reduced->recovery);
    ritz_measures_free(&reduced->estimates);
    ritz_measures_free(&reduced->errors);
    ritz_nested_free(&reduced->nested);
    *reduced = (ritz_reduced){0};
}

void ritz_nested_free(ritz_nested *nested)
{
    RITZ_FREE(nested->order, nested->error);
    ritz_dense_free(&nested->value);
    *nested = (ritz_nested){0};
}
