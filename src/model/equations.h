/*
 * Constraint equations, made term by term and eliminated; the ties between dofs
 * of rigid bodies and averages that state them; grids as points; rows by name;
 * mass properties.
 */
#ifndef RITZ_MODEL_EQUATIONS_H
#define RITZ_MODEL_EQUATIONS_H

#include <ritz/model.h>

/* Rows by name: sorted, so that a name is found in O(log n). */
typedef struct ritz_row_place {
    ritz_dof dof; /* first: places are compared as dofs are */
    int64_t row;
} ritz_row_place;

typedef struct ritz_roster {
    int64_t count;
    ritz_row_place *place;
} ritz_roster;

/** Roster of @p count dofs; a repeated one is refused. */
ritz_status ritz_roster_new(int64_t count, const ritz_dof *dof,
                            ritz_roster *out);

/** Row of a dof, -1 if there is none. */
int64_t ritz_roster_row(const ritz_roster *roster, ritz_dof dof);

/** First place whose grid is not below @p grid; count if there is none. */
int64_t ritz_roster_from(const ritz_roster *roster, int64_t grid);
void ritz_roster_free(ritz_roster *roster);

/** What follows is stated by @p from. */
ritz_status ritz_equations_cite_next(ritz_equations *equations,
                                     ritz_equation_source from);

/** Begin an equation, of the latest source. */
ritz_status ritz_equations_begin(ritz_equations *equations, ritz_dof dependent);

/** Add a term to the latest equation; one of share 0 is none. */
ritz_status ritz_equations_add(ritz_equations *equations, ritz_dof dof,
                               double share);

enum { RITZ_CITATION_SIZE = 200 };

/** "RBE2 600 ('deck.bdf', line 12)"; returns @p text. */
const char *ritz_equations_cite(const ritz_equations *equations, int64_t source,
                                char text[static RITZ_CITATION_SIZE]);

/** The equation that eliminates @p dof, -1 if none does. @cost O(count) */
int64_t ritz_equations_find(const ritz_equations *equations, ritz_dof dof);

/* All dofs in terms of those that stay: u = G u_n. */
typedef struct ritz_elimination {
    ritz_dofs kept; /* n of all, ascending */
    ritz_dofs gone; /* the others, ascending */
    ritz_sparse G;  /* all x n; row kept.at[j] is that of the identity */
} ritz_elimination;

/**
 * Solve the equations for their dependent dofs. Dependents may depend on each
 * other, in chains or in circles.
 *
 * @param[in] dof    count distinct names; every dof of the equations is there
 * @param[in] fixed  count, u = 0 there: none of these may be dependent; NULL
 * @return RITZ_ERR_FORMAT if a dof is dependent twice, dependent and fixed, or
 *         not there; RITZ_ERR_SINGULAR if a circle leaves its dofs undetermined
 * @cost   O(count + entries of G), and the cube of the longest circle
 */
ritz_status ritz_elimination_new(const ritz_equations *equations, int64_t count,
                                 const ritz_dof *dof, const bool *fixed,
                                 ritz_elimination *out);

void ritz_elimination_free(ritz_elimination *elimination);

/*
 * How a dof follows a rigid motion [t; r] about a point, along basic axes, and
 * the ties between dofs.
 */

/* Some dofs of one grid that has a position. */
typedef struct ritz_tie {
    int64_t grid; /* index in the grids */
    uint8_t mask; /* bit c: direction c, 1 to 6 */
    double weight;
} ritz_tie;

typedef struct ritz_ties {
    int64_t count, room;
    ritz_tie *tie;
} ritz_ties;

ritz_status ritz_ties_add(ritz_ties *list, ritz_tie tie);
int64_t ritz_ties_dofs(const ritz_ties *list);
void ritz_ties_free(ritz_ties *list);

static inline bool ritz_tie_has(const ritz_tie *tie, int64_t c)
{
    return (((unsigned)tie->mask >> (unsigned)c) & 1U) != 0;
}

/** u(grid, c) = out . [t; r] of a motion about @p origin. */
void ritz_tie_row(const ritz_grids *grids, int64_t grid, int64_t c,
                  const double origin[static 3], double out[static 6]);

/** Factor by which a dof is scaled, so that lengths cancel. */
static inline double ritz_tie_scale(ritz_dof dof, double length)
{
    return dof.component > 3 ? length : 1.0;
}

/**
 * Equations of a rigid body: dependents follow the independent dofs, six that
 * hold it.
 *
 * @return RITZ_ERR_SINGULAR if these six leave it free to move
 */
ritz_status ritz_tie_rigid(const ritz_grids *grids, const ritz_ties *from,
                           const ritz_ties *to, ritz_equations *equations);

/*
 * A weighted average over dofs u of ties,
 *
 *     [t; r] = A u,   A = argmin |W^1/2 (S q - u)|,   A S = I
 *
 * with S the rows of rigid motion about the point; weights of rotations are
 * multiplied by the square of the mean distance, so that lengths may be in any
 * unit. For the rows of A that are not determined see `loose`.
 */
typedef struct ritz_average {
    int64_t num_loose; /* motions that leave all dofs as they are */
    double loose[36];  /* these, 6 x num_loose, rotations times length */
    double length;     /* by which rotations were multiplied */
    ritz_dof *dof;     /* columns of A */
    ritz_dense A;      /* 6 x dofs of the ties */
} ritz_average;

/** @return RITZ_ERR_MEMORY, RITZ_ERR_CONVERGENCE */
ritz_status ritz_average_new(const ritz_grids *grids, const ritz_ties *over,
                             const double origin[static 3], ritz_average *out);

/** Whether the motion @p row . [t; r] is determined. */
bool ritz_average_tells(const ritz_average *average,
                        const double row[static 6]);

void ritz_average_free(ritz_average *average);

/* The grids of a body as points: where the translations of each one are. */
typedef struct ritz_nodes {
    const ritz_grids *grids; /* borrowed */
    int64_t count;           /* of grids with at least one translation */
    int64_t *grid;           /* count, index in grids, ascending */
    int64_t *row;            /* count x 3, of each translation; -1: absent */
} ritz_nodes;

/**
 * The nodes among @p n rows that @p dof names; rows of scalar points and of
 * grids that are not in @p grids are passed over.
 */
ritz_status ritz_nodes_of(int64_t n, const ritz_dof *dof,
                          const ritz_grids *grids, ritz_nodes *out);

/** Displacement axes of a node, row by row. */
const double *ritz_nodes_axes(const ritz_nodes *nodes, int64_t node);

/** Whether axes, row by row, are the basic ones. */
static inline bool ritz_axes_basic(const double *axes)
{
    for (int k = 0; k < 9; k++)
        if (axes[k] != (k % 4 == 0 ? 1.0 : 0.0))
            return false;
    return true;
}

/**
 * Translations of the nodes along basic axis @p b for each column of @p T; an
 * absent translation is zero.
 *
 * @param[out] out  count x r
 */
ritz_status ritz_nodes_along(const ritz_nodes *nodes, const ritz_dense *T,
                             int b, ritz_dense *out);

void ritz_nodes_free(ritz_nodes *nodes);

/** R'MR, 6 x 6, of the rigid motions R about the basic origin; {0}: there is no
 * grid. */
ritz_status ritz_inertia_momenta(const ritz_component *component,
                                 ritz_dense *out);

/** Mass, centre and inertia from A = R'MR, with R the rigid motions about the
 * basic origin. */
void ritz_inertia_read(const ritz_dense *A, ritz_inertia *inertia);

#endif
