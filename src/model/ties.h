/*
 * How a dof follows a rigid motion [t; r] about a point, along basic axes, and
 * the ties between dofs of rigid bodies and averages.
 */
#ifndef RITZ_MODEL_TIES_H
#define RITZ_MODEL_TIES_H

#include "model/equations.h"

#include <ritz/model.h>

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

#endif
