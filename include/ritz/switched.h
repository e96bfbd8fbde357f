/*
 * Switched reduced models [McDaniel2000, ch. 5]: of a library of vectors, those
 * that matter now carry the motion, and others take their place when they
 * matter more.
 *
 * From one switch to the next a set of vectors psi moves, and what of the state
 * lies beside them stays as it was (5.2.6-9):
 *
 *     Z = psi eta + Z0,   Z = [x; x'],   Z' = psi psi'W (A Z + F)
 *
 * with psi'W psi = I in an inner product W: of the mass, or of coordinates as
 * they are. What a set leaves out of the motion is told at each switch by the
 * indicator (5.2.12-14)
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
    RITZ_SWITCH_OFFSET,  /* none: what lies beside the set stays as it was */
    RITZ_SWITCH_PROJECT, /* what lies beside the set, in M, is lost */
} ritz_switch_jump;

/* How a model is switched. Everything is borrowed. */
typedef struct ritz_switched {
    int64_t num_libraries;
    const ritz_dense *library; /* matrices of the model's rows: their columns
                                  are the candidates, in this order */
    bool redundant;  /* candidates may depend on each other: each keeps its
                           direction, those that are chosen are made orthogonal.
                           Else the library is made orthonormal in its order,
                           and what depends on earlier columns is left out */
    double interval; /* s from one switch to the next, of whole steps */
    double least;    /* Emin, above 0 and below 1 */
    bool within; /* E is the share of what the whole library captures of R, not
                    of R: for libraries that span less than the model, which
                    else are always below Emin */
    double hysteresis; /* a vector of the present set counts 1 + hysteresis
                           times, and is dropped only where E without it
                           exceeds Emin by this share of 1 - Emin; 0: ties
                           alone are decided for the present set */
    bool ahead; /* R is also taken with the inputs that the interval ends with:
                   |psi'W R|^2 and R'W R are sums of both. Else a force that
                   begins after a switch finds the set of before it */
    ritz_switch_inner inner;
    ritz_switch_jump jump;
    double dwell; /* s that a set is kept at least; 0: one interval */
} ritz_switched;

/* What was found of a library, and what a run took. */
typedef struct ritz_switched_report {
    int64_t num_given, num_vectors; /* columns; candidates that are left */
    int64_t num_switches;           /* at which the set changed */
    int64_t num_fallbacks; /* switches at which all vectors were below Emin, and
                              all were taken */
    double vector_steps;   /* sum of vectors over steps */
    double defect;         /* by which the condition of stability is missed:
                              see docs/methods/switched.md */
    double dwell;          /* s that such a library needs; 0: none */
    double outside; /* with RITZ_SWITCH_PROJECT: share of the initial state
                              beside the library, in M, which is lost */
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
 * A library that fails it is refused, or, with RITZ_SWITCH_PROJECT and damping,
 * kept if sets dwell long enough. Where R is rounding, the present set is kept.
 *
 * Diagnostics, of the interval that ends with the time that is stored:
 * "vectors", "indicator", "leading vector" (from 1; 0: none), "vector-steps",
 * "switches", "fallbacks", "jump of displacement" and "jump of velocity" (at
 * the last switch, in M), "energy lost at switches" and "energy gained at
 * switches" (sums). What switches take is in the dissipated energy.
 *
 * @param[out] report  may be NULL; filled on failure too, as far as known
 * @return RITZ_ERR_ARGUMENT if the library fails the condition, an option makes
 *         no sense, request->coordinates is set, or ritz_simulate refuses the
 *         model; RITZ_ERR_SINGULAR if M is singular
 * @cost   once one factor of M and O(n N^2), N the vectors of the library; a
 *         switch O(N^2), and O(r^3) where the set changes and its vectors are
 *         no modes; a step O(r), or one product of N x r where they are none
 * @see    [McDaniel2000]
 */
ritz_status ritz_simulate_switched(ritz_model subject,
                                   const ritz_simulation_request *request,
                                   const ritz_switched *switched,
                                   ritz_switched_report *report,
                                   ritz_simulation *out);

#pragma GCC visibility pop

#endif
