/*
 * Degrees of freedom: what a row of a component is, and sets of rows.
 *
 * Rows are counted from 0 inside the library. Users never see row numbers:
 * messages name grid and direction, "grid 101 T3".
 */
#ifndef RITZ_DOFS_H
#define RITZ_DOFS_H

#include <ritz/status.h>

#include <stdint.h>

#pragma GCC visibility push(default)

/* Directions of a grid: 1-3 translations, 4-6 rotations, 0 a scalar point. */
typedef struct ritz_dof {
    int64_t grid;
    int64_t component;
} ritz_dof;

typedef struct ritz_dofs {
    int64_t count;
    int64_t *at; /* count distinct row numbers, from 0, in the owner's order */
} ritz_dofs;

/**
 * The rows of 0..n-1 that are not in @p set, ascending.
 *
 * @return RITZ_ERR_ARGUMENT if a member of @p set is out of range or repeated
 */
ritz_status ritz_dofs_complement(const ritz_dofs *set, int64_t n,
                                 ritz_dofs *out);

/** Copy of @p set. */
ritz_status ritz_dofs_copy(const ritz_dofs *set, ritz_dofs *out);

/** Room for the text that ritz_dof_name writes. */
enum { RITZ_DOF_NAME_SIZE = 40 };

/** "grid 101 T3", "grid 101 R1", "point 2001"; returns @p text. */
const char *ritz_dof_name(ritz_dof dof, char text[RITZ_DOF_NAME_SIZE]);

/** Order of two ritz_dof, for qsort and bsearch: by grid, then direction. */
int ritz_dof_compare(const void *left, const void *right);

/**
 * Sort a list and keep each dof once.
 *
 * @return how many are left
 * @cost   O(n log n)
 */
int64_t ritz_dof_distinct(int64_t count, ritz_dof *dof);

void ritz_dofs_free(ritz_dofs *set);

#pragma GCC visibility pop

#endif
