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
 * to a point next to it. Multiple poles at 0 are found only to a root of
 * rounding.
 */
ritz_status ritz_space_slowest(ritz_pencil *pencil, int64_t count,
                               ritz_pencil_pairs *out);

/* Poles at 0, decoupled (zero_poles.c). */
typedef struct ritz_zero_poles {
    ritz_dense T, W;    /* n x a, W'E T = I; a is 0 without poles at 0 */
    ritz_dense ET, EtW; /* E T, E'W; {0} without poles at 0 */
    double radius; /* all other poles are farther than this from 0; 0: there
                           are no poles at 0  [rad/s] */
} ritz_zero_poles;

/**
 * Right and left vectors of all poles at 0, including Jordan blocks. If there
 * are more than about 20, none is found.
 *
 * @cost  some factorisations, and some 30 solves of 28 columns; two real
 *        factorisations where E and -(A + A') are definite, which proves that
 *        no pole is at 0
 */
ritz_status ritz_zero_poles_find(ritz_pencil *pencil, ritz_zero_poles *out);

/** B := B - E T W'B; for outputs C' := C' - E'W T'C'. */
ritz_status ritz_zero_poles_of_loads(const ritz_zero_poles *z, bool outputs,
                                     ritz_dense *F);

/** X := X - T W'E X, n x count; for outputs X := X - W T'E'X. */
ritz_status ritz_zero_poles_of_states(const ritz_zero_poles *z, bool outputs,
                                      int64_t count, double _Complex *X);

void ritz_zero_poles_free(ritz_zero_poles *z);

#endif
