/* Building constraint equations, one term after the other. */
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

#endif
