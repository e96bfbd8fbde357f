/* Ports: how many dofs, whose, where, and whether the body is behind them. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/general.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/*
 * Ports. What a port can hold is the rank of the rigid motions R_p of its dofs,
 * rotations about its origin and lengths over its size: six if it is a body's
 * full support, five if its grids lie on one line and bring translations only.
 * The measure is sqrt(smallest / largest eigenvalue of R_p'R_p) over the
 * motions that the component itself has, less than six in plane models.
 */

/* The k-th dof of a port. */
static ritz_dof port_dof(const ritz_checker *it, const ritz_port *port,
                         int64_t k)
{
    return it->component->dof[port->dofs.at[k]];
}

static double find_distance(const double *a, const double *b)
{
    double square = 0.0;

    for (int i = 0; i < 3; i++)
        square += pow(a[i] - b[i], 2.0);
    return sqrt(square);
}

/* R_p of one port: about its origin, lengths over size. */
static ritz_status find_motions(const ritz_checker *it, const ritz_port *port,
                                ritz_dense *out)
{
    const ritz_component *c = it->component;
    RITZ_OWN(ritz_dense) R = {0}, S = {0};
    double size = 0.0;
    int64_t p = port->dofs.count;

    for (int64_t k = 0; k < p; k++) {
        int64_t g = ritz_grids_find(&c->grids, port_dof(it, port, k).grid);

        if (g >= 0)
            size = fmax(size,
                        find_distance(&c->grids.position[3 * g], port->origin));
    }
    size = size > RITZ_SAME * it->size ? size : 1.0;
    RITZ_CHECK(ritz_rigid_geometry(c, port->origin, &R));
    RITZ_CHECK(ritz_dense_new(p, 6, &S));
    for (int64_t j = 0; j < 6; j++)
        for (int64_t k = 0; k < p; k++) {
            bool turns = port_dof(it, port, k).component > 3;

            /* per unit of size, and rotations as arcs at that distance */
            ritz_dense_col(&S, j)[k] = ritz_dense_col(&R, j)[port->dofs.at[k]] /
                                       (j >= 3 && !turns ? size : 1.0);
        }
    RITZ_MOVE(*out, S);
    return RITZ_OK;
}

/* Keep the columns of motions that the component has at all. */
static int64_t drop_absent(const ritz_checker *it, ritz_dense *S)
{
    int64_t kept = 0;

    for (int64_t j = 0; j < 6; j++) {
        if (!(ritz_dense_col_max(&it->R, j) > RITZ_MOTION_PRESENT))
            continue;
        if (kept < j)
            memcpy(ritz_dense_col(S, kept), ritz_dense_col(S, j),
                   (size_t)S->nrow * sizeof *S->val);
        kept++;
    }
    S->ncol = kept;
    return kept;
}

/* How well the worst motion is held, and how many are not. */
static ritz_status measure_hold(const ritz_checker *it, const ritz_port *port,
                                double *worst, int64_t *loose)
{
    RITZ_OWN(ritz_dense) S = {0}, A = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t k = 0;

    *loose = 0;
    *worst = 1.0;
    RITZ_CHECK(find_motions(it, port, &S));
    k = drop_absent(it, &S);
    if (k == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul_tn(&S, &S, &A));
    RITZ_CHECK(ritz_general_symmetric(&A, &pairs));
    for (int64_t j = 0; j < k; j++) {
        double ratio = pairs.lambda[j] / pairs.lambda[k - 1];

        ratio = pairs.lambda[j] > 0.0 ? sqrt(ratio) : 0.0;
        *worst = fmin(*worst, ratio);
        *loose += !(ratio > RITZ_PORT_HELD);
    }
    return RITZ_OK;
}

static bool has_rotation(const ritz_checker *it, const ritz_port *port)
{
    for (int64_t k = 0; k < port->dofs.count; k++)
        if (port_dof(it, port, k).component > 3)
            return true;
    return false;
}

/* Ports that leave a motion loose although they have dofs enough. */
static ritz_status check_collinear(ritz_checker *it)
{
    const ritz_component *c = it->component;
    char where[RITZ_WHERE_SIZE] = "";
    double worst = 1.0;
    int64_t most = 0;

    for (int64_t p = 0; p < c->num_ports; p++) {
        const ritz_port *port = &c->port[p];
        double held = 1.0;
        int64_t loose = 0;

        if (port->dofs.count < 6 || has_rotation(it, port))
            continue;
        RITZ_CHECK(measure_hold(it, port, &held, &loose));
        worst = fmin(worst, held);
        most = loose > most ? loose : most;
        if (loose > 0)
            ritz_checker_list(where, port->name);
    }
    if (most == 0)
        ritz_checker_say(it, "port-collinear", worst, RITZ_PORT_HELD, RITZ_PASS,
                         where, "no port has its grids on one line");
    else
        ritz_checker_say(it, "port-collinear", worst, RITZ_PORT_HELD, RITZ_WARN,
                         where,
                         "grids on one line, translations only: %" PRId64
                         " rotation%s not held",
                         most, most == 1 ? " is" : "s are");
    return RITZ_OK;
}

static void check_count(ritz_checker *it)
{
    const ritz_component *c = it->component;
    char where[RITZ_WHERE_SIZE] = "";
    int64_t fewest = INT64_MAX;
    int64_t points = 0;

    for (int64_t p = 0; p < c->num_ports; p++) {
        const ritz_port *port = &c->port[p];

        if (port->dofs.count > 0 && port_dof(it, port, 0).component == 0) {
            points++;
            continue;
        }
        if (port->dofs.count < fewest)
            fewest = port->dofs.count;
        if (port->dofs.count < 6)
            ritz_checker_list(where, port->name);
    }
    if (points == c->num_ports)
        return;
    ritz_checker_say(it, "port-dofs", (double)fewest, 6.0,
                     fewest < 6 ? RITZ_WARN : RITZ_PASS, where,
                     fewest < 6 ? "a port of fewer than six dofs cannot hold a "
                                  "body in space"
                                : "every port has six dofs or more");
}

/* Dofs that two ports have. */
static ritz_status check_dependent(ritz_checker *it)
{
    const ritz_component *c = it->component;
    RITZ_OWN_ARRAY int64_t *owners = NULL;
    RITZ_OWN_ARRAY bool *flag = NULL;

    RITZ_CHECK_NEW(owners, c->num_dofs);
    RITZ_CHECK_NEW(flag, c->num_dofs);
    for (int64_t p = 0; p < c->num_ports; p++)
        for (int64_t k = 0; k < c->port[p].dofs.count; k++) {
            int64_t row = c->port[p].dofs.at[k];

            flag[row] = ++owners[row] > 1;
        }
    ritz_checker_flagged(
        it, "port-dependent", flag, RITZ_WARN, "no dof belongs to two ports",
        "dofs of two ports: joints at both would hold them twice");
    return RITZ_OK;
}

/* Pairs of grids of one port that have the same position. */
static int64_t count_coincident(const ritz_checker *it, const ritz_port *port,
                                char where[RITZ_WHERE_SIZE])
{
    const ritz_grids *grids = &it->component->grids;
    int64_t count = 0;

    for (int64_t a = 0; a < port->dofs.count; a++)
        for (int64_t b = 0; b < a; b++) {
            int64_t i = ritz_grids_find(grids, port_dof(it, port, a).grid);
            int64_t j = ritz_grids_find(grids, port_dof(it, port, b).grid);
            char name[RITZ_DOF_NAME_SIZE];

            if (i < 0 || j < 0 || i == j ||
                port_dof(it, port, a).component !=
                    port_dof(it, port, b).component)
                continue;
            if (find_distance(&grids->position[3 * i],
                              &grids->position[3 * j]) > RITZ_SAME * it->size)
                continue;
            count++;
            snprintf(name, sizeof name, "grid %" PRId64, grids->id[i]);
            if (!strstr(where, name))
                ritz_checker_list(where, name);
        }
    return count;
}

static void check_places(ritz_checker *it)
{
    const ritz_component *c = it->component;
    enum { LARGEST = 6000 }; /* pairs are compared: larger ports are not */
    char where[RITZ_WHERE_SIZE] = "";
    int64_t count = 0;

    for (int64_t p = 0; p < c->num_ports; p++)
        if (c->port[p].dofs.count <= LARGEST)
            count += count_coincident(it, &c->port[p], where);
    ritz_checker_say(it, "port-positions", (double)count, 0.0,
                     count == 0 ? RITZ_PASS : RITZ_WARN, where,
                     count == 0 ? "all grids of a port have different positions"
                                : "grids of one port with the same position: a "
                                  "joint cannot distinguish them");
}

/* Port dofs that meet no stiffness, or lie in a part that is not the body. */
static ritz_status check_disconnected(ritz_checker *it)
{
    const ritz_component *c = it->component;
    RITZ_OWN_ARRAY bool *flag = NULL;

    RITZ_CHECK_NEW(flag, c->num_dofs);
    for (int64_t p = 0; p < c->num_ports; p++)
        for (int64_t k = 0; k < c->port[p].dofs.count; k++) {
            int64_t row = c->port[p].dofs.at[k];
            bool stiff = it->rigid;

            for (int64_t q = c->K.colptr ? c->K.colptr[row] : 0;
                 c->K.colptr && !stiff && q < c->K.colptr[row + 1]; q++)
                stiff = c->K.val[q] != 0.0;
            flag[row] = !stiff || it->part[row] != it->largest;
        }
    ritz_checker_flagged(
        it, "port-disconnected", flag, RITZ_FAIL,
        "every port dof is connected to the body",
        "port dofs that nothing connects to the body: it is not held there");
    return RITZ_OK;
}

ritz_status ritz_check_ports(ritz_checker *it)
{
    check_count(it);
    if (it->placed)
        RITZ_CHECK(check_collinear(it));
    RITZ_CHECK(check_dependent(it));
    if (it->placed)
        check_places(it);
    return check_disconnected(it);
}
