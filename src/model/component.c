#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "model/equations.h"

#include <ritz/model.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static ritz_status check_matrix(const ritz_sparse *A, int64_t n)
{
    RITZ_REFUSE_IF(A->nrow != n || A->ncol != n, RITZ_ERR_FORMAT,
                   "%" PRId64 " x %" PRId64 " where %" PRId64 " x %" PRId64
                   " is due",
                   A->nrow, A->ncol, n, n);
    return ritz_sparse_check(A, A->colptr[n]);
}

/* How matrices of order n are made symmetric, and the worst asymmetry that was
   found: a matrix and its transpose are averaged. */
typedef struct settling {
    int64_t n;
    bool symmetrise; /* whatever the asymmetry; false: a large one is refused */
    double worst;
    int64_t *work; /* n numbers for ritz_sparse_sweep_asymmetry() */
} settling;

static void settling_free(settling *s)
{
    free(s->work);
}

static ritz_status settle_matrix(ritz_sparse *A, settling *s)
{
    double asymmetry = 0.0;

    RITZ_CHECK(check_matrix(A, s->n));
    asymmetry = ritz_sparse_sweep_asymmetry(A, s->work);
    RITZ_REFUSE_IF(asymmetry > RITZ_SYMMETRIC_SOURCE && !s->symmetrise,
                   RITZ_ERR_FORMAT,
                   "unsymmetric by %.1e of its largest entry, %.0e is let pass "
                   "(--symmetrise averages it away)",
                   asymmetry, RITZ_SYMMETRIC_SOURCE);
    if (asymmetry > 0.0)
        RITZ_CHECK(ritz_sparse_symmetrise(A));
    s->worst = fmax(s->worst, asymmetry);
    return RITZ_OK;
}

/* An absent matrix becomes an empty one. */
static ritz_status complete_matrix(ritz_sparse *A, settling *s)
{
    return A->colptr ? settle_matrix(A, s) : ritz_sparse_new(s->n, s->n, 0, A);
}

/*
 * D alone may be unsymmetric by more than rounding: a rotor's gyroscopic terms
 * are, and D is kept as it came then.
 */
static ritz_status settle_damping(ritz_sparse *D, settling *s)
{
    RITZ_CHECK(check_matrix(D, s->n));
    if (s->symmetrise || ritz_sparse_asymmetry(D) <= RITZ_SYMMETRIC_SOURCE)
        RITZ_CHECK(settle_matrix(D, s));
    return RITZ_OK;
}

static ritz_status settle_matrices(ritz_component *component, bool symmetrise)
{
    RITZ_OWN(settling) s = {component->num_dofs, symmetrise, 0.0, NULL};

    RITZ_CHECK_NEW(s.work, s.n);
    RITZ_REFUSE_IF(!component->M.colptr, RITZ_ERR_FORMAT, "there is no mass");
    RITZ_CHECK_IN("M", settle_matrix(&component->M, &s));
    RITZ_CHECK_IN("K", complete_matrix(&component->K, &s));
    if (component->D.colptr)
        RITZ_CHECK_IN("D", settle_damping(&component->D, &s));
    if (component->K4.colptr)
        RITZ_CHECK_IN("K4", settle_matrix(&component->K4, &s));
    for (int64_t k = 0; k < component->num_loads; k++)
        RITZ_CHECK_IN(component->load[k].name,
                      complete_matrix(&component->load[k].KG, &s));
    component->asymmetry = s.worst;
    return RITZ_OK;
}

static ritz_status check_dofs(const ritz_component *component)
{
    int64_t n = component->num_dofs;
    RITZ_OWN(ritz_roster) roster = {0};

    RITZ_REFUSE_IF(n > 0 && !component->dof, RITZ_ERR_FORMAT,
                   "rows have no names");
    for (int64_t k = 0; k < n; k++)
        RITZ_REFUSE_IF(component->dof[k].component < 0 ||
                           component->dof[k].component > 6,
                       RITZ_ERR_FORMAT,
                       "row %" PRId64 " has direction %" PRId64
                       ", which is not among 0 to 6",
                       k + 1, component->dof[k].component);
    return ritz_roster_new(n, component->dof, &roster);
}

static ritz_status check_grids(const ritz_grids *grids)
{
    for (int64_t k = 0; k < grids->count; k++) {
        RITZ_REFUSE_IF(k > 0 && grids->id[k - 1] >= grids->id[k],
                       RITZ_ERR_FORMAT, "grids do not ascend at %" PRId64,
                       grids->id[k]);
        RITZ_REFUSE_IF(grids->frame[k] < 0 ||
                           grids->frame[k] >= grids->num_frames,
                       RITZ_ERR_FORMAT, "grid %" PRId64 " has no such frame",
                       grids->id[k]);
        for (int i = 0; i < 3; i++)
            RITZ_REFUSE_IF(!isfinite(grids->position[3 * k + i]),
                           RITZ_ERR_FORMAT, "grid %" PRId64 " is nowhere",
                           grids->id[k]);
    }
    return RITZ_OK;
}

static ritz_status check_ports(const ritz_component *component)
{
    for (int64_t k = 0; k < component->num_ports; k++) {
        const ritz_port *port = &component->port[k];

        for (int64_t j = 0; j < k; j++)
            RITZ_REFUSE_IF(strcmp(component->port[j].name, port->name) == 0,
                           RITZ_ERR_FORMAT, "there are two ports '%s'",
                           port->name);
        for (int64_t i = 0; i < port->dofs.count; i++)
            RITZ_REFUSE_IF(port->dofs.at[i] < 0 ||
                               port->dofs.at[i] >= component->num_dofs,
                           RITZ_ERR_FORMAT,
                           "port '%s' holds dof %" PRId64
                           ", which is not among the %" PRId64,
                           port->name, port->dofs.at[i], component->num_dofs);
    }
    return RITZ_OK;
}

static ritz_status check_finite(const ritz_dense *A, const char *what)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        RITZ_REFUSE_IF(!isfinite(A->val[k]), RITZ_ERR_FORMAT,
                       "%s are not finite", what);
    return RITZ_OK;
}

static ritz_status settle_io(ritz_component *component)
{
    ritz_io *io = &component->io;
    int64_t n = component->num_dofs;

    if (!io->B.val)
        return ritz_io_new(n, 0, 0, io);
    RITZ_REFUSE_IF(io->B.nrow != n || io->B.ncol != io->num_inputs,
                   RITZ_ERR_FORMAT, "inputs are of another size");
    RITZ_REFUSE_IF(io->C.ncol != n || io->C.nrow != io->num_outputs ||
                       io->Cv.ncol != n || io->Cv.nrow != io->num_outputs ||
                       io->Ca.ncol != n || io->Ca.nrow != io->num_outputs,
                   RITZ_ERR_FORMAT, "outputs are of another size");
    RITZ_CHECK(check_finite(&io->B, "inputs"));
    RITZ_CHECK(check_finite(&io->C, "outputs"));
    RITZ_CHECK(check_finite(&io->Cv, "outputs"));
    return check_finite(&io->Ca, "outputs");
}

/* The rest, which is checked last. */
static ritz_status settle_rest(ritz_component *component)
{
    RITZ_CHECK(check_grids(&component->grids));
    RITZ_CHECK_IN("elements", ritz_elements_check(&component->elements,
                                                  component->grids.count,
                                                  component->grids.id));
    RITZ_CHECK(check_ports(component));
    RITZ_CHECK(settle_io(component));
    RITZ_CHECK_IN("recovery",
                  ritz_recovery_check(&component->recovery, component->num_dofs,
                                      component->dof));
    RITZ_CHECK(ritz_quantities_check(component->num_quantities,
                                     component->quantity, component->num_dofs));
    return ritz_dampers_check(&component->dampers, component->num_dofs);
}

ritz_status ritz_component_settle(ritz_component *component, bool symmetrise)
{
    RITZ_CHECK(check_dofs(component));
    RITZ_CHECK(settle_matrices(component, symmetrise));
    return settle_rest(component);
}

ritz_status ritz_component_settle_frame(ritz_component *component)
{
    RITZ_CHECK(check_dofs(component));
    return settle_rest(component);
}

ritz_status ritz_component_install(ritz_component *component)
{
    return ritz_dampers_install_sparse(&component->dampers, &component->K,
                                       &component->D);
}

const ritz_port *ritz_component_port(const ritz_component *component,
                                     const char *name)
{
    const ritz_names names = {"port", component->num_ports,
                              (char *)component->port, sizeof *component->port};
    int64_t k = ritz_names_seek(&names, name);

    return k < 0 ? NULL : &component->port[k];
}

/* A dof that several ports share is attached once. */
static void attach_port(const ritz_port *port, bool *taken, ritz_dofs *set)
{
    for (int64_t i = 0; i < port->dofs.count; i++) {
        int64_t dof = port->dofs.at[i];

        if (!taken[dof])
            set->at[set->count++] = dof;
        taken[dof] = true;
    }
}

ritz_status ritz_component_attached(const ritz_component *component,
                                    const char *ports, ritz_dofs *out)
{
    RITZ_OWN(ritz_dofs) set = {0};
    RITZ_OWN_ARRAY bool *taken = NULL;

    RITZ_CHECK_NEW(taken, component->num_dofs);
    RITZ_CHECK_NEW(set.at, component->num_dofs);
    for (int64_t k = 0; !ports && k < component->num_ports; k++)
        attach_port(&component->port[k], taken, &set);
    while (ports && *ports) {
        char name[RITZ_NAME_SIZE];
        size_t length = strcspn(ports, ",");
        const ritz_port *port = NULL;

        RITZ_REFUSE_IF(length >= sizeof name, RITZ_ERR_ARGUMENT,
                       "there is no port '%.40s...'", ports);
        memcpy(name, ports, length);
        name[length] = '\0';
        port = ritz_component_port(component, name);
        if (!port)
            return RITZ_ERR_ARGUMENT;
        attach_port(port, taken, &set);
        ports += length + (ports[length] != '\0');
    }
    RITZ_MOVE(*out, set);
    return RITZ_OK;
}

void ritz_component_free(ritz_component *component)
{
    ritz_sparse_free(&component->K);
    ritz_sparse_free(&component->M);
    ritz_sparse_free(&component->D);
    ritz_sparse_free(&component->K4);
    for (int64_t k = 0; k < component->num_loads; k++)
        ritz_sparse_free(&component->load[k].KG);
    RITZ_FREE(component->load, component->dof);
    ritz_grids_free(&component->grids);
    ritz_elements_free(&component->elements);
    for (int64_t k = 0; k < component->num_ports; k++)
        ritz_dofs_free(&component->port[k].dofs);
    free(component->port);
    ritz_io_free(&component->io);
    ritz_recovery_free(&component->recovery);
    RITZ_FREE_EACH(ritz_quantity, component->num_quantities,
                   component->quantity);
    ritz_dampers_free(&component->dampers);
    *component = (ritz_component){0};
}
