/*
 * Switched reduced models [McDaniel2000, ch. 5]: the motion takes place in a
 * set of vectors, chosen from a library. At regular intervals the model may
 * switch to another set, with the vectors that then have the largest part in
 * the residual.
 *
 * From one switch to the next the set of vectors psi moves, and the part Z0 of
 * the state that is orthogonal to the set stays constant (5.2.6-9):
 *
 *     Z = psi eta + Z0,   Z = [x; x'],   Z' = psi psi'W (A Z + F)
 *
 * with psi'W psi = I in an inner product W: the mass matrix, or the identity.
 * At each switch the indicator is the share of the residual R that a set
 * captures (5.2.12-14):
 *
 *     E = |psi'W R|^2 / R'W R,   R = A Z0 + F = [x'; M^-1 (B u - D x' - K x)]
 */
#ifndef RITZ_SWITCHED_H
#define RITZ_SWITCHED_H

#include <ritz/simulate.h>

#pragma GCC visibility push(default)

typedef enum ritz_switch_inner {
    RITZ_SWITCH_MASS,      /* W = M */
    RITZ_SWITCH_EUCLIDEAN, /* W = I, as [McDaniel2000] has it */
} ritz_switch_inner;

typedef enum ritz_switch_jump {
    RITZ_SWITCH_OFFSET,  /* Z0 is kept: the state is continuous */
    RITZ_SWITCH_PROJECT, /* Z0 becomes 0: the state is projected in M */
} ritz_switch_jump;

/* How a model is switched. All of it is borrowed. */
typedef struct ritz_switched {
    int64_t num_libraries;
    const ritz_dense *library; /* matrices with the rows of the model: their
                                  columns are the candidates, in this order */
    bool redundant;  /* candidates may be linearly dependent: each keeps its
                           direction, and chosen ones are made orthonormal.
                           false: the library is made orthonormal in its order,
                           and columns that depend on earlier ones are left
                           out */
    double interval; /* s from one switch to the next, a multiple of the step */
    double indicator; /* Emin, above 0 and below 1: vectors are added to a set
                         until E exceeds it */
    bool share_of_library; /* E is relative to the part of R that the whole
                              library captures, not to R. It is meant for
                              libraries that span less than the model, whose E
                              would otherwise not reach Emin */
    double hysteresis; /* the share of a vector of the present set is multiplied
                           by 1 + hysteresis, and the vector is dropped only
                           where E without it exceeds Emin by hysteresis (1 -
                           Emin); 0: only ties go to the present set */
    bool look_ahead;   /* R is computed with the inputs at the start and at the
                        end of the interval, and |psi'W R|^2 and R'W R are sums
                        over both. false: a force that begins during an interval
                        acts on a set that was chosen without it */
    ritz_switch_inner inner;
    ritz_switch_jump jump;
    double dwell; /* s for which a set is kept at least; 0: one interval */
} ritz_switched;

/* Properties of a library, and statistics of a run. */
typedef struct ritz_switched_report {
    int64_t num_given, num_vectors; /* columns given; candidates among them */
    int64_t num_switches;           /* changes of the set */
    int64_t num_fallbacks; /* times that E of the whole library was below Emin,
                              and all vectors were taken */
    double vector_steps;   /* number of vectors, summed over all steps */
    double defect;  /* error with which the condition of stability is met:
                       see docs/methods/switched.md */
    double dwell;   /* shortest with which the library is stable, s; 0: any */
    double outside; /* with RITZ_SWITCH_PROJECT: share of the initial state that
                       is M-orthogonal to the library and lost */
    double left_out; /* largest share of the kinetic energy at a switch that the
                        new set leaves out: it is held, or lost by projection */
    double left_out_at; /* s, time of that switch */
} ritz_switched_report;

/**
 * Simulate a component, reduced component or system by a switched model, each
 * set propagated exactly for inputs held or linear over a step
 * (request->integrator does not matter).
 *
 * Stability is checked once for all sets. V = (x'Kx + x''Mx')/2 never grows
 * without inputs, whatever the sets and times, if and only if
 *
 * - RITZ_SWITCH_OFFSET: D psi = d M psi of each candidate, d >= 0 (and with
 *   RITZ_SWITCH_EUCLIDEAN M psi = mu psi in addition);
 * - RITZ_SWITCH_PROJECT: K psi = k M psi of each candidate.
 *
 * A library that does not meet this condition is refused, except with
 * RITZ_SWITCH_PROJECT, damping, and a dwell time that is long enough. Where R
 * consists of rounding alone, the present set is kept.
 *
 * Diagnostics, of the interval that ends at the stored time: "vectors",
 * "indicator", "leading vector" (from 1; 0: none), "vector-steps", "switches",
 * "fallbacks", "jump of displacement" and "jump of velocity" (at the last
 * change of the set, in M), "energy lost at switches" and "energy gained at switches"
 * (sums). The dissipated energy includes what switches take.
 *
 * @param[out] report  may be NULL; filled on failure too, as far as known
 * @return RITZ_ERR_ARGUMENT if the library does not meet the condition, if an
 *         option is outside its range, or if ritz_simulate refuses the model;
 *         RITZ_ERR_SINGULAR if M is singular
 * @cost   one factor of M and O(n N^2) once, for N vectors of the library;
 *         O(N^2) for a switch, and O(r^3) if the set changes and its r vectors
 *         are not modes; O(r) for a step, or a product of N x r for vectors
 *         that are not modes
 * @see    [McDaniel2000]
 */
ritz_status ritz_simulate_switched(ritz_model subject,
                                   const ritz_simulation_request *request,
                                   const ritz_switched *switched,
                                   ritz_switched_report *report,
                                   ritz_simulation *out);

#pragma GCC visibility pop

#endif
