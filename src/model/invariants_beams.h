/*
 * Straight beams with consistent mass, found in M where a line cell joins two
 * grids, and what the form of invariants_mass.h leaves out of them.
 *
 * A beam along e from grid 1 to grid 2, of length L and mass mu, moves at xi =
 * x / L by
 *
 *     u = sum_i e n_i s_i + H_i l_i + L K_i t_i,   s_i = e . u_i,
 *                                    l_i = u_i - e s_i,   t_i = theta_i x e
 *
 *     n_1 = 1 - xi     H_1 = 1 - 3 xi^2 + 2 xi^3     K_1 = xi - 2 xi^2 + xi^3
 *     n_2 = xi         H_2 = 3 xi^2 - 2 xi^3         K_2 = xi^3 - xi^2
 *
 * Its mass matrix has no terms of s with l and t, but the invariants have. The
 * block of M that joins its grids shows that it is such a beam: its terms of l
 * with t give mu, those of t with t and of l with l agree, and all else is
 * along the axis or a multiple of I. Terms of s with s are taken as M holds
 * them, all others from mu and the integrals of the functions above.
 */
#ifndef RITZ_MODEL_INVARIANTS_BEAMS_H
#define RITZ_MODEL_INVARIANTS_BEAMS_H

#include "model/equations.h"

typedef struct ritz_beam {
    int64_t node[2];       /* ascending; -1: a grid whose dofs are all held */
    int64_t grid[2];       /* index in the grids */
    int64_t row[2][6];     /* of the dofs of both in M; -1: absent */
    const double *axes[2]; /* displacement axes, row by row; borrowed */
    bool known[2]; /* whether M has the columns of that node; one rank of
                              several has some of them */
    double e[3], L;
    double mu;    /* 0: it is no such beam */
    double axial; /* term of s_1 with s_2 */
} ritz_beam;

typedef struct ritz_beams {
    int64_t count;
    ritz_beam *beam; /* by node[0], then node[1]; each pair once */
} ritz_beams;

/**
 * Pairs of nodes that line cells join, and nodes that one such cell joins to a
 * grid without dofs; which of them are beams is not known.
 *
 * @param[in] row  6 rows of each of the nodes, -1 where a dof is absent
 */
ritz_status ritz_beams_list(const ritz_elements *elements,
                            const ritz_nodes *nodes, const int64_t *row,
                            ritz_beams *out);

/** The pair of nodes @p i and @p j, one of which may be -1; NULL if no line cell
 * joins them. @cost O(log count) */
ritz_beam *ritz_beams_find(const ritz_beams *beams, int64_t i, int64_t j);

/**
 * Find out whether a pair is a beam from the block of M that joins its nodes,
 * along their own axes.
 *
 * @param[in] column  0 or 1: which node's columns these are
 * @param[in] block   6 x 6, row by row: rows of the other node
 */
void ritz_beam_fit(int column, const double block[static 36], ritz_beam *beam);

/**
 * The same of a node that is joined to a held grid, from what is left of its
 * own block without other beams.
 */
void ritz_beam_fit_held(const double block[static 36], ritz_beam *beam);

/** Take what a beam puts into the block of node @p end alone out of it. */
void ritz_beam_take_out(const ritz_beam *beam, int end, double block[36]);

/** Leave out pairs that are no beams. */
void ritz_beams_keep(ritz_beams *beams);

/*
 * S_a has 6 rows for each beam, e_a s_1, e_a s_2, l_1a, l_2a, t_1a, t_2a: parts
 * of its motion along basic axis a. The products lack S_a' C S_b.
 */

/** S_a of each column of T. */
ritz_status ritz_beams_along(const ritz_beams *beams, const ritz_dense *T,
                             int a, ritz_dense *out);

/** C S. */
ritz_status ritz_beams_weigh(const ritz_beams *beams, const ritz_dense *S,
                             ritz_dense *out);

/**
 * What the positions X_a' m T_b lack, of a = 1 to 3.
 *
 * @param[in]  S    S_b
 * @param[in]  CS   C S_b
 * @param[out] out  3 x r
 */
ritz_status ritz_beams_place(const ritz_beams *beams, const ritz_nodes *nodes,
                             const ritz_dense *S, const ritz_dense *CS,
                             ritz_dense *out);

void ritz_beams_free(ritz_beams *beams);

/**
 * Sum over translations p and q that nodes i and j have of (a_ip . a_jq)^2, at
 * least 1: the number of directions that both have.
 */
double ritz_shared_directions(const double *axes_i, const int64_t *row_i,
                              const double *axes_j, const int64_t *row_j);

#endif
