/* What a floating body is made from, and its reference condition. */
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
 * W and U of a body whose V, frame and reference are there.
 *
 * @return RITZ_ERR_ARGUMENT as ritz_floating_of says of references
 */
ritz_status ritz_floating_refer(const floating_source *s, ritz_floating *f);

/** Column 3 + i of N, 6 x 6: R N has the rotations about @p c, in place of those
 * about the basic origin, times @p scale. */
void ritz_floating_spin(const double *c, int i, double scale, ritz_dense *N);

#endif
