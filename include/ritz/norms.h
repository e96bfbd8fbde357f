/* Norms of systems: how large a model, or the difference of two, can answer. */
#ifndef RITZ_NORMS_H
#define RITZ_NORMS_H

#include <ritz/state_space.h>

#pragma GCC visibility push(default)

typedef struct ritz_norm {
    double value;
    double hertz; /* H-infinity: where it stands; HUGE_VAL: far out */
    double lower; /* value is at least this, proven */
    char engine[RITZ_NAME_SIZE];
} ritz_norm;

/**
 * H-infinity norm: the largest singular value of H(i w) over all w, to @p
 * tolerance relative.
 *
 * First values are met: at 0, far out, at every pole, and between them where
 * they are high; the largest is `lower`. Up to 600 states SLICOT AB13DD then
 * decides by eigenvalues of Hamiltonian matrices whether there is a larger one.
 * Of more states, whose Hamiltonians would cost 100 n^3 each, and where AB13DD
 * does not come to an end, `value` is `lower`, and `engine` says so: a peak
 * between poles that none of them shows can be missed.
 *
 * @return RITZ_ERR_ARGUMENT if a pole is not left of the axis, as
 *         ritz_gramians_of_space decides: it is infinite
 * @cost   O(n^3), some hundred times; beyond 600 states O(n^2) for each pole
 * @see    [Bruinsma1990]
 */
ritz_status ritz_norm_infinity(const ritz_state_space *model, double tolerance,
                               ritz_norm *out);

/**
 * H2 norm, sqrt(trace(C W_c C')), by the factor of W_c.
 *
 * @return RITZ_ERR_ARGUMENT if a pole is not left of the axis, or D is not 0:
 *         it is infinite
 * @cost   O(n^3)
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

#pragma GCC visibility pop

#endif
