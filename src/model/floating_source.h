/* The data from which a floating body is made, for the files that make it. */
#ifndef RITZ_MODEL_FLOATING_SOURCE_H
#define RITZ_MODEL_FLOATING_SOURCE_H

#include "model/equations.h"
#include "model/floating.h"
#include "model/modal.h"

/* The reduced component, and what is derived from it to make a body. */
typedef struct floating_source {
    const ritz_reduced *reduced;
    int64_t count;         /* dofs, and recovered ones behind them */
    ritz_dof *dof;         /* count */
    ritz_dense T;          /* count x r */
    ritz_structure model;  /* with dampers, and stated damping in D */
    ritz_nodes move, turn; /* rows of translations, and of rotations */
} floating_source;

/**
 * Compute W and U from V, the frame and the reference condition of @p f.
 *
 * * @return RITZ_ERR_ARGUMENT if the body does not allow this reference
 * condition:
 *         see ritz_floating_of
 */
ritz_status ritz_floating_refer(const floating_source *s, ritz_floating *f);

/** Set column 3 + i of N, 6 x 6, so that this column of R N is @p scale times
 * the rotation about the point @p c along axis i. */
void ritz_floating_spin(const double *c, int i, double scale, ritz_dense *N);

#endif
