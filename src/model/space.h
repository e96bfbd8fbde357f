/* State spaces, dense or sparse, as methods use them. */
#ifndef RITZ_MODEL_SPACE_H
#define RITZ_MODEL_SPACE_H

#include "linear/pencil.h"

#include <ritz/model.h>

/** The pencil A - s E of a model, of a dense one too. */
ritz_status ritz_pencil_of_space(const ritz_state_space *model,
                                 ritz_pencil *out);

/**
 * Whether x'E x of every motion falls: E = E' and -(A + A') are positive
 * definite. Then no pole is right of the axis, nor one of V'A V and V'E V.
 */
ritz_status ritz_pencil_is_dissipative(const ritz_pencil *pencil, bool *out);

/**
 * H = D + C (s E - A)^-1 B at a point, num_outputs x num_inputs row by row.
 *
 * @return RITZ_ERR_SINGULAR if s is a pole
 * @cost   a complex factor of A - s E, unless it is factored there
 */
ritz_status ritz_space_transfer(const ritz_state_space *model,
                                ritz_pencil *pencil, double _Complex s,
                                double _Complex *H);

/**
 * The poles nearest to 0, or to points next to it where 0 is a pole, as
 * ritz_pencil_nearest.
 */
ritz_status ritz_space_slowest(ritz_pencil *pencil, int64_t count,
                               ritz_pencil_pairs *out);

#endif
