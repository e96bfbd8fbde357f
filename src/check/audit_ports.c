/* Ports: how many dofs, whose, where, and whether the body is behind them. */
#include "check/audit_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ritz_dof ritz_auditor_dof(const ritz_auditor *it, const ritz_port *port,
                          int64_t k)
{
    return it->component->dof[port->dofs.at[k]];
}

static void check_count(ritz_auditor *it)
{
    const ritz_component *c = it->component;
    char where[RITZ_WHERE_SIZE] = "";
    int64_t fewest = INT64_MAX;
    int64_t points = 0;

    for (int64_t p = 0; p < c->num_ports; p++) {
        const ritz_port *port = &c->port[p];

        if (port->dofs.count > 0 &&
            ritz_auditor_dof(it, port, 0).component == 0) {
            points++;
            continue;
        }
        if (port->dofs.count < fewest)
            fewest = port->dofs.count;
        if (port->dofs.count < 6)
            ritz_auditor_list(where, port->name);
    }
    if (points == c->num_ports)
        return;
    ritz_auditor_say(it, "port-dofs", (double)fewest, 6.0,
                     fewest < 6 ? RITZ_WARN : RITZ_PASS, where,
                     fewest < 6 ? "a port of fewer than six dofs cannot hold a "
                                  "body in space"
                                : "every port has six dofs or more");
}

/* Dofs that two ports have. */
static ritz_status check_dependent(ritz_auditor *it)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    int64_t *owners = NULL;
    bool *flag = NULL;
    char where[RITZ_WHERE_SIZE];
    int64_t count = 0;

    RITZ_NEW(owners, c->num_dofs);
    RITZ_NEW(flag, c->num_dofs);
    for (int64_t p = 0; p < c->num_ports; p++)
        for (int64_t k = 0; k < c->port[p].dofs.count; k++) {
            int64_t row = c->port[p].dofs.at[k];

            flag[row] = ++owners[row] > 1;
        }
    count = ritz_auditor_where(it, flag, where);
    ritz_auditor_say(it, "port-dependent", (double)count, 0.0,
                     count == 0 ? RITZ_PASS : RITZ_WARN, where,
                     count == 0 ? "no dof belongs to two ports"
                                : "dofs of two ports: joints at both would "
                                  "hold them twice");
done:
    free(owners);
    free(flag);
    return status;
}

/* Two grids of one port in one place: a joint cannot tell them apart. */
static int64_t count_double(const ritz_auditor *it, const ritz_port *port,
                            char where[RITZ_WHERE_SIZE])
{
    const ritz_grids *grids = &it->component->grids;
    int64_t count = 0;

    for (int64_t a = 0; a < port->dofs.count; a++)
        for (int64_t b = 0; b < a; b++) {
            int64_t i =
                ritz_grids_find(grids, ritz_auditor_dof(it, port, a).grid);
            int64_t j =
                ritz_grids_find(grids, ritz_auditor_dof(it, port, b).grid);
            double square = 0.0;
            char name[RITZ_DOF_NAME_SIZE];

            if (i < 0 || j < 0 || i == j ||
                ritz_auditor_dof(it, port, a).component !=
                    ritz_auditor_dof(it, port, b).component)
                continue;
            for (int k = 0; k < 3; k++)
                square +=
                    pow(grids->position[3 * i + k] - grids->position[3 * j + k],
                        2.0);
            if (sqrt(square) > RITZ_SAME_PLACE * it->size)
                continue;
            count++;
            snprintf(name, sizeof name, "grid %" PRId64, grids->id[i]);
            if (!strstr(where, name))
                ritz_auditor_list(where, name);
        }
    return count;
}

static void check_places(ritz_auditor *it)
{
    const ritz_component *c = it->component;
    enum { LARGEST = 6000 }; /* pairs are compared: larger ports are not */
    char where[RITZ_WHERE_SIZE] = "";
    int64_t count = 0;

    for (int64_t p = 0; p < c->num_ports; p++)
        if (c->port[p].dofs.count <= LARGEST)
            count += count_double(it, &c->port[p], where);
    ritz_auditor_say(it, "port-positions", (double)count, 0.0,
                     count == 0 ? RITZ_PASS : RITZ_WARN, where,
                     count == 0 ? "the grids of every port lie apart"
                                : "grids of one port in one place: a joint "
                                  "cannot tell them apart");
}

/* Port dofs that meet no stiffness, or lie in a part that is not the body. */
static ritz_status check_disconnected(ritz_auditor *it)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    bool *flag = NULL;
    char where[RITZ_WHERE_SIZE];
    int64_t count = 0;

    RITZ_NEW(flag, c->num_dofs);
    for (int64_t p = 0; p < c->num_ports; p++)
        for (int64_t k = 0; k < c->port[p].dofs.count; k++) {
            int64_t row = c->port[p].dofs.at[k];
            bool stiff = it->rigid;

            for (int64_t q = c->K.colptr ? c->K.colptr[row] : 0;
                 c->K.colptr && !stiff && q < c->K.colptr[row + 1]; q++)
                stiff = c->K.val[q] != 0.0;
            flag[row] = !stiff || it->part[row] != it->largest;
        }
    count = ritz_auditor_where(it, flag, where);
    ritz_auditor_say(it, "port-disconnected", (double)count, 0.0,
                     count == 0 ? RITZ_PASS : RITZ_FAIL, where,
                     count == 0 ? "every port dof is connected to the body"
                                : "port dofs that nothing connects to the "
                                  "body: it is not held there");
done:
    free(flag);
    return status;
}

ritz_status ritz_audit_ports(ritz_auditor *it)
{
    if (it->component->num_ports == 0)
        return RITZ_OK;
    check_count(it);
    if (it->placed)
        RITZ_CHECK(ritz_audit_port_rank(it));
    RITZ_CHECK(check_dependent(it));
    if (it->placed)
        check_places(it);
    return check_disconnected(it);
}
