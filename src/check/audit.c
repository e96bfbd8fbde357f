/* All checks of a model, one after the other. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/general.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Features of the model that checks may need. */
static unsigned find_features(const ritz_checker *it)
{
    const ritz_component *c = it->component;
    unsigned has = 0;

    if (c) {
        if (!it->rigid)
            has |= RITZ_NEEDS_STIFFNESS;
        if (c->D.colptr)
            has |= RITZ_NEEDS_DAMPING;
        if (c->num_ports > 0)
            has |= RITZ_NEEDS_PORTS;
        if (c->num_loads > 0)
            has |= RITZ_NEEDS_LOADS;
    } else if (it->reduced) {
        if (it->model.D.val)
            has |= RITZ_NEEDS_DAMPING;
        if (it->reduced->K4.val)
            has |= RITZ_NEEDS_STRUCTURAL;
        if (it->reduced->num_loads > 0)
            has |= RITZ_NEEDS_LOADS;
    }
    return has;
}

static int64_t count_loads(const ritz_checker *it)
{
    return it->component ? it->component->num_loads
           : it->reduced ? it->reduced->num_loads
                         : 0;
}

static const char *load_name(const ritz_checker *it, int64_t k)
{
    return it->component ? it->component->load[k].name
                         : it->reduced->load[k].name;
}

/* Amounts by load, of those that act. */
static ritz_status take_applied(ritz_checker *it, int64_t count,
                                const ritz_applied *applied)
{
    const int64_t loads = count_loads(it);

    if (count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(it->amount, loads);
    for (int64_t j = 0; j < count; j++) {
        int64_t k = 0;

        while (k < loads && strcmp(load_name(it, k), applied[j].name) != 0)
            k++;
        RITZ_REFUSE_IF(k == loads, RITZ_ERR_ARGUMENT,
                       "there is no geometric stiffness of a load '%s'",
                       applied[j].name);
        RITZ_REFUSE_IF(!isfinite(applied[j].amount), RITZ_ERR_ARGUMENT,
                       "load '%s' is not finite", applied[j].name);
        it->amount[k] += applied[j].amount;
    }
    return RITZ_OK;
}

static ritz_status run_checks(ritz_checker *it, unsigned of, ritz_audit *out)
{
    unsigned has = find_features(it);

    it->usable = true;
    it->room = RITZ_MOST_CHECKS + RITZ_LINES_OF_LOAD * count_loads(it);
    RITZ_CHECK_NEW(it->audit.check, it->room);
    for (const ritz_check_row *row = ritz_checks; row->run; row++)
        if (it->usable && (row->of & of) && (row->needs & has) == row->needs)
            RITZ_CHECK(row->run(it));
    *out = it->audit;
    it->audit = (ritz_audit){0};
    return RITZ_OK;
}

static void ritz_checker_free(ritz_checker *it)
{
    ritz_audit_free(&it->audit);
    RITZ_FREE(it->part, it->mu, it->moves, it->amount);
    ritz_dense_free(&it->R);
    ritz_dense_free(&it->Phi);
    ritz_structure_free(&it->model);
    ritz_modal_model_free(&it->modes);
    ritz_dense_free(&it->L);
    free(it->row);
    ritz_collocated_free(&it->pairs);
}

ritz_status ritz_audit_component(const ritz_component *component,
                                 ritz_audit *out)
{
    return ritz_audit_component_under(component, 0, NULL, out);
}

ritz_status ritz_audit_component_under(const ritz_component *component,
                                       int64_t count,
                                       const ritz_applied *applied,
                                       ritz_audit *out)
{
    RITZ_OWN(ritz_checker) it = {.component = component, .softest = nan("")};

    RITZ_REFUSE_IF(component->num_dofs == 0, RITZ_ERR_ARGUMENT,
                   "the component has no dofs");
    it.rigid =
        !component->K.colptr || component->K.colptr[component->K.ncol] == 0;
    RITZ_CHECK(take_applied(&it, count, applied));
    return run_checks(&it, RITZ_OF_COMPONENT, out);
}

/* Rows of all ports as columns of Lt, and what they are called. */
static int64_t take_ports(const ritz_reduced *reduced, ritz_dense *Lt,
                          char (*row)[RITZ_NAME_SIZE])
{
    char dof[RITZ_DOF_NAME_SIZE];
    int64_t at = 0;

    for (int64_t k = 0; k < reduced->num_ports; k++) {
        const ritz_port_map *port = &reduced->port[k];
        double largest = ritz_dense_max(&port->map);

        for (int64_t i = 0; i < port->count; i++) {
            for (int64_t j = 0; j < Lt->nrow; j++)
                ritz_dense_col(Lt, at)[j] = ritz_dense_col(&port->map, j)[i];
            snprintf(row[at], RITZ_NAME_SIZE, "%.20s, %s", port->name,
                     ritz_dof_name(port->dof[i], dof));
            at += ritz_dense_col_max(Lt, at) > RITZ_NEGLIGIBLE * largest;
        }
    }
    return at;
}

static int64_t take_inputs(const ritz_io *io, ritz_dense *Lt,
                           char (*row)[RITZ_NAME_SIZE])
{
    double largest = ritz_dense_max(&io->B);
    int64_t at = 0;

    for (int64_t j = 0; j < io->num_inputs; j++) {
        memcpy(ritz_dense_col(Lt, at), ritz_dense_col(&io->B, j),
               (size_t)Lt->nrow * sizeof *Lt->val);
        snprintf(row[at], RITZ_NAME_SIZE, "%s", io->input[j]);
        at += ritz_dense_col_max(Lt, at) > RITZ_NEGLIGIBLE * largest;
    }
    return at;
}

/*
 * Rows of the interface: those of all ports or, without ports, what inputs act
 * on; rows that move nothing are left out.
 */
static ritz_status take_interface(ritz_checker *it)
{
    const ritz_reduced *reduced = it->reduced;
    int64_t most = reduced->io.num_inputs + 1;
    RITZ_OWN(ritz_dense) Lt = {0};

    for (int64_t k = 0; k < reduced->num_ports; k++)
        most += reduced->port[k].count;
    RITZ_CHECK(ritz_dense_new(reduced->K.nrow, most, &Lt));
    RITZ_CHECK_NEW(it->row, most);
    if (reduced->num_ports > 0)
        Lt.ncol = take_ports(reduced, &Lt, it->row);
    else
        Lt.ncol = take_inputs(&reduced->io, &Lt, it->row);
    return ritz_general_transpose(&Lt, &it->L);
}

ritz_status ritz_audit_reduced(const ritz_reduced *reduced, ritz_audit *out)
{
    return ritz_audit_reduced_under(reduced, 0, NULL, out);
}

/* Structural damping, of harmonic motion alone, has a check of its own. */
ritz_status ritz_audit_reduced_under(const ritz_reduced *reduced, int64_t count,
                                     const ritz_applied *applied,
                                     ritz_audit *out)
{
    RITZ_OWN(ritz_checker) it = {.reduced = reduced, .definite = true};

    RITZ_CHECK(ritz_damping_parse(reduced->damping, &it.damping));
    RITZ_CHECK(ritz_structure_of_reduced(reduced, &it.model));
    RITZ_CHECK(take_interface(&it));
    RITZ_CHECK(take_applied(&it, count, applied));
    return run_checks(&it, RITZ_OF_REDUCED, out);
}

ritz_status ritz_audit_states(const ritz_state_space *model, ritz_audit *out)
{
    RITZ_OWN(ritz_state_space) made = {0};
    RITZ_OWN(ritz_checker) it = {0};

    it.space = model;
    if (ritz_state_space_is_sparse(model) &&
        ritz_state_space_order(model) > 2 * (int64_t)RITZ_STATE_DOFS)
        return run_checks(&it, RITZ_OF_SPARSE, out);
    RITZ_CHECK(ritz_state_space_dense(model, &made, &it.space));
    RITZ_CHECK(ritz_collocated_of_space(it.space, &it.pairs));
    return run_checks(&it, RITZ_OF_STATES, out);
}
