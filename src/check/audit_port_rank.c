/*
 * Ports. What a port can hold is the rank of the rigid motions R_p of its dofs,
 * rotations about its origin and lengths over its size: six if it is a body's
 * full support, five if its grids lie on one line and bring translations only.
 * The measure is sqrt(smallest / largest eigenvalue of R_p'R_p) over the
 * motions that the component itself has, less than six in plane models.
 */
#include "check/audit_parts.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const double held_above = 1e-6;

/* R_p of one port: about its origin, lengths over size. */
static ritz_status find_motions(const ritz_auditor *it, const ritz_port *port,
                                ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    ritz_dense R = {0}, S = {0};
    double size = 0.0;
    int64_t p = port->dofs.count;

    for (int64_t k = 0; k < p; k++) {
        int64_t g =
            ritz_grids_find(&c->grids, ritz_auditor_dof(it, port, k).grid);
        double square = 0.0;

        for (int i = 0; g >= 0 && i < 3; i++)
            square += pow(c->grids.position[3 * g + i] - port->origin[i], 2.0);
        size = fmax(size, sqrt(square));
    }
    size = size > RITZ_SAME_PLACE * it->size ? size : 1.0;
    RITZ_TRY(ritz_rigid_geometry(c, port->origin, &R));
    RITZ_TRY(ritz_dense_new(p, 6, &S));
    for (int64_t j = 0; j < 6; j++)
        for (int64_t k = 0; k < p; k++) {
            bool turns = ritz_auditor_dof(it, port, k).component > 3;

            /* per unit of size, and rotations as arcs at that distance */
            ritz_dense_col(&S, j)[k] = ritz_dense_col(&R, j)[port->dofs.at[k]] /
                                       (j >= 3 && !turns ? size : 1.0);
        }
    *out = S;
    S = (ritz_dense){0};
done:
    ritz_dense_free(&R);
    ritz_dense_free(&S);
    return status;
}

/* Keep the columns of motions that the component has at all. */
static int64_t drop_absent(const ritz_auditor *it, ritz_dense *S)
{
    int64_t kept = 0;

    for (int64_t j = 0; j < 6; j++) {
        bool present = false;

        for (int64_t i = 0; i < it->R.nrow; i++)
            present = present || fabs(ritz_dense_col(&it->R, j)[i]) > 1e-9;
        if (!present)
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
static ritz_status measure(const ritz_auditor *it, const ritz_port *port,
                           double *worst, int64_t *loose)
{
    ritz_status status = RITZ_OK;
    ritz_dense S = {0}, A = {0}, I = {0};
    ritz_pairs pairs = {0};
    int64_t k = 0;

    *loose = 0;
    *worst = 1.0;
    RITZ_TRY(find_motions(it, port, &S));
    k = drop_absent(it, &S);
    if (k == 0)
        goto done;
    RITZ_TRY(ritz_dense_mul_tn(&S, &S, &A));
    RITZ_TRY(ritz_dense_new(k, k, &I));
    for (int64_t j = 0; j < k; j++)
        ritz_dense_col(&I, j)[j] = 1.0;
    RITZ_TRY(ritz_eigen_dense(&A, &I, &pairs));
    for (int64_t j = 0; j < k; j++) {
        double ratio = pairs.lambda[j] / pairs.lambda[k - 1];

        ratio = pairs.lambda[j] > 0.0 ? sqrt(ratio) : 0.0;
        *worst = fmin(*worst, ratio);
        *loose += !(ratio > held_above);
    }
done:
    ritz_dense_free(&S);
    ritz_dense_free(&A);
    ritz_dense_free(&I);
    ritz_pairs_free(&pairs);
    return status;
}

static bool has_rotation(const ritz_auditor *it, const ritz_port *port)
{
    for (int64_t k = 0; k < port->dofs.count; k++)
        if (ritz_auditor_dof(it, port, k).component > 3)
            return true;
    return false;
}

/* Ports that leave a motion loose although they have dofs enough. */
ritz_status ritz_audit_port_rank(ritz_auditor *it)
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
        RITZ_CHECK(measure(it, port, &held, &loose));
        worst = fmin(worst, held);
        most = loose > most ? loose : most;
        if (loose > 0)
            ritz_auditor_list(where, port->name);
    }
    if (most == 0)
        ritz_auditor_say(it, "port-collinear", worst, held_above, RITZ_PASS,
                         where, "no port has its grids on one line");
    else
        ritz_auditor_say(it, "port-collinear", worst, held_above, RITZ_WARN,
                         where,
                         "grids on one line, translations only: %" PRId64
                         " rotation%s not held",
                         most, most == 1 ? " is" : "s are");
    return RITZ_OK;
}
