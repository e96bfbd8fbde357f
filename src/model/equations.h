/* Constraint equations: made term by term, and eliminated. */
#ifndef RITZ_MODEL_EQUATIONS_H
#define RITZ_MODEL_EQUATIONS_H

#include <ritz/model.h>

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

#endif
