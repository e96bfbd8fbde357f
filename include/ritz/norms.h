/* Norms of systems: how large a model, or the difference of two, can answer. */
#ifndef RITZ_NORMS_H
#define RITZ_NORMS_H

#include <ritz/state_space.h>

typedef struct ritz_norm {
    double value;
    double hertz; /* H-infinity: where it stands */
    double lower; /* value is at least this, proven */
    char engine[RITZ_NAME_SIZE];
} ritz_norm;

/**
 * H-infinity norm: the largest singular value of H(i w) over all w, to @p
 * tolerance relative (SLICOT AB13DD, [Bruinsma1990]).
 *
 * @return RITZ_ERR_ARGUMENT if a pole is on or right of the axis: it is infinite
 * @cost   O(n^3), some ten times
 */
ritz_status ritz_norm_infinity(const ritz_state_space *model, double tolerance,
                               ritz_norm *out);

/**
 * H2 norm, sqrt(trace(C W_c C')) (SLICOT AB13BD); infinite if D is not zero.
 *
 * @return RITZ_ERR_ARGUMENT if a pole is on or right of the axis, or D is not 0
 */
ritz_status ritz_norm_two(const ritz_state_space *model, ritz_norm *out);

/**
 * a - b as one state space, of the same inputs and outputs in the same order.
 *
 * @return RITZ_ERR_ARGUMENT if they differ by name or number
 */
ritz_status ritz_state_space_difference(const ritz_state_space *a,
                                        const ritz_state_space *b,
                                        ritz_state_space *out);

#endif
