/* State spaces, dense or sparse, as pencils A - s E. */
#ifndef RITZ_MODEL_SPACE_H
#define RITZ_MODEL_SPACE_H

#include "linear/pencil.h"

#include <ritz/model.h>

/** The pencil A - s E of a dense or sparse state space. */
ritz_status ritz_pencil_of_space(const ritz_state_space *model,
                                 ritz_pencil *out);

/**
 * Whether x'E x decreases along every motion, because E = E' and -(A + A') are
 * positive definite. No pole of the pencil is then right of the axis, nor one
 * of the projected pencil V'A V, V'E V.
 */
ritz_status ritz_pencil_is_dissipative(const ritz_pencil *pencil, bool *out);

/**
 * H = D + C (s E - A)^-1 B at a point: num_outputs x num_inputs, row by row.
 *
 * @return RITZ_ERR_SINGULAR if s is a pole
 * @cost   a complex factorisation of A - s E, unless the last was at the same s
 */
ritz_status ritz_space_transfer(const ritz_state_space *model,
                                ritz_pencil *pencil, double _Complex s,
                                double _Complex *H);

/**
 * As ritz_pencil_nearest, the poles nearest to 0; if 0 is a pole, those nearest
 * to a point next to it.
 */
ritz_status ritz_space_slowest(ritz_pencil *pencil, int64_t count,
                               ritz_pencil_pairs *out);

#endif
