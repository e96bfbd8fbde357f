/* Parts of ritz_elimination_new: the rows of G_m, found one after the other. */
#ifndef RITZ_MODEL_ELIMINATION_ROWS_H
#define RITZ_MODEL_ELIMINATION_ROWS_H

#include <ritz/equations.h>

/* A row of G_m while it is found. */
typedef struct ritz_elimination_row {
    int64_t count;
    int64_t *col; /* among all dofs */
    double *val;
} ritz_elimination_row;

typedef struct ritz_eliminator {
    const ritz_equations *equations;
    int64_t num_all;
    const ritz_dof *dof;
    int64_t *at;       /* of each term of the equations, its dof among all */
    int64_t *equation; /* of each dof among all, -1 if it is not dependent */
    ritz_elimination_row *found; /* of each equation */
    double *sum;                 /* among all dofs, zero between uses */
    bool *used;                  /* the same of places in `sum` */
    int64_t *list;               /* these places */
    int64_t num_used;
    int64_t *member;  /* of each equation, place in the circle at hand or -1 */
    int64_t num_kept; /* entries of all rows found */
} ritz_eliminator;

/**
 * Find the rows of equations that need each other, in a circle, or of one.
 *
 * @param[in] circle  count equations; all others that they need are found
 * @return RITZ_ERR_SINGULAR if they leave a dof undetermined
 */
ritz_status ritz_eliminator_settle(ritz_eliminator *s, int64_t count,
                                   const int64_t *circle);

#endif
