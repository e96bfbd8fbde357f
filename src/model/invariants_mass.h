/*
 * Mass that grids carry, from the blocks of M.
 *
 * Mass dm that moves with grid i by u_i + theta_i x r_i and with grid j by
 * u_j + theta_j x r_j puts into the block of M that joins them
 *
 *     M_ij = |  m I         -f_j~       |    m = int dm,  f = int r dm,
 *            |  f_i~    tr(G) I - G'    |    G = int r_i r_j' dm
 *
 * along basic axes, with v~ w = v x w. Blocks of isoparametric solids and of
 * lumped mass (f = G = 0) have this form, also those of rigid bodies at a grid
 * (i = j), such as offset mass, and of all of these after grids were tied to
 * others rigidly. Of a block of another form only the part with this form is
 * used; m is then a third of the trace of its translations.
 */
#ifndef RITZ_MODEL_INVARIANTS_MASS_H
#define RITZ_MODEL_INVARIANTS_MASS_H

#include "model/equations.h"
#include "model/invariants_beams.h"

/* f and G of the block of nodes i and j. */
typedef struct ritz_mass_arm {
    int64_t at[2];      /* nodes i and j */
    int64_t turning[2]; /* their numbers among turning nodes; -1: f and G need
                           no rotations of that node */
    double f[2][3];     /* f_i and f_j */
    double G[3][3];
} ritz_mass_arm;

typedef struct ritz_nodal_mass {
    ritz_nodes nodes;   /* grids that have a dof */
    ritz_nodes turning; /* nodes of `arm`; `row` is that of their rotations */
    ritz_sparse m;      /* nodes x nodes */
    int64_t count, room;
    ritz_mass_arm *arm; /* count: blocks with f or G */
    ritz_beams beams;   /* beams, of which m and `arm` hold only a part */
} ritz_nodal_mass;

/** The mass of a component's grids; the nodes borrow the grids.
 * @cost O(entries of M) */
ritz_status ritz_nodal_mass_of(const ritz_component *component,
                               ritz_nodal_mass *out);

void ritz_nodal_mass_free(ritz_nodal_mass *mass);

#endif
