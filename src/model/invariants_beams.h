/*
 * Straight beams with consistent mass. They are recognised in M, by the blocks
 * of grids that a line cell joins; and the terms of their inertia invariants
 * that the form of invariants_mass.h lacks are computed.
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
 * Its mass matrix has no products of s with l or t, but the invariants have. A
 * block of M is that of such a beam if the terms of l with t give a mass mu,
 * the terms of t with t and of l with l agree with that mu, and the rest is a e
 * e' + d I for translations and a multiple of e e' for rotations. The terms of
 * s with s are taken from M, all others from mu and the integrals of the
 * functions above.
 */
#ifndef RITZ_MODEL_INVARIANTS_BEAMS_H
#define RITZ_MODEL_INVARIANTS_BEAMS_H

#include "model/equations.h"

typedef struct ritz_beam {
    int64_t node[2];       /* ascending; -1: a grid that has no dof */
    int64_t grid[2];       /* index in the grids */
    int64_t row[2][6];     /* of the dofs of both in M; -1: absent */
    const double *axes[2]; /* displacement axes, row by row; borrowed */
    bool known[2]; /* whether M has the columns of that node; a process of
                              ritz-reduce-slepc has only some columns */
    double e[3], L;
    double mu;    /* mass; 0: the cell is no such beam */
    double axial; /* mass term of s_1 with s_2 */
} ritz_beam;

typedef struct ritz_beams {
    int64_t count;
    ritz_beam *beam; /* by node[0], then node[1]; each pair once */
} ritz_beams;

/**
 * List the pairs of nodes that line cells join, and the nodes that exactly one
 * line cell joins to grids without dofs. ritz_beam_fit then finds which are
 * beams.
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
 * Set the mass of a beam from the block of M that joins its nodes; it stays 0
 * if that is not the block of a beam.
 *
 * @param[in] column  0 or 1: the node whose columns the block has
 * @param[in] block   6 x 6, row by row, along the axes of the nodes; its rows
 *                    are those of the other node
 */
void ritz_beam_fit(int column, const double block[static 36], ritz_beam *beam);

/**
 * Set the mass of a beam between a node and a grid without dofs.
 *
 * @param[in] block  the node's own block of M, less all its other beams
 */
void ritz_beam_fit_held(const double block[static 36], ritz_beam *beam);

/** Subtract the part of a beam from the own block of M of its node @p end. */
void ritz_beam_take_out(const ritz_beam *beam, int end, double block[36]);

/** Remove pairs without a mass from the list. */
void ritz_beams_keep(ritz_beams *beams);

/*
 * The motion of the beams along basic axis a is S_a, with six rows for each
 * beam: e_a s_1, e_a s_2, l_1a, l_2a, t_1a, t_2a. int v_a v_b by
 * invariants_mass.h lacks S_a' C S_b, where C is block diagonal with a 6 x 6
 * block for each beam.
 */

/** S_a of each column of T. */
ritz_status ritz_beams_along(const ritz_beams *beams, const ritz_dense *T,
                             int a, ritz_dense *out);

/** C S. */
ritz_status ritz_beams_weigh(const ritz_beams *beams, const ritz_dense *S,
                             ritz_dense *out);

/**
 * The part of int x_a v_b that invariants_mass.h lacks, for a = 1 to 3.
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
 * How many directions of translation nodes i and j have in common: the sum of
 * (a_ip . a_jq)^2 over the translations p of i and q of j, at least 1.
 */
double ritz_shared_directions(const double *axes_i, const int64_t *row_i,
                              const double *axes_j, const int64_t *row_j);

#endif
