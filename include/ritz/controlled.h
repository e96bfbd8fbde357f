/*
 * Closed loops in time. Plant and controller are joined as for frequency
 * responses (ritz_loop): the controller measures outputs e of the plant, and
 * its output v acts on the inputs u = r - v, or r + v with positive feedback.
 * The loop is propagated in one of three ways:
 *
 * split    plant and controller separately over each step, the plant exactly or
 *          by its integrator, each with the output of the other held constant:
 *          O(n) a step for a modal plant, of first order in the step
 *          [Sirlin1992]
 * exact    both together, by one matrix exponential of the closed loop
 * sampled  the controller measures at its samples only, and its output is held
 *          from one sample to the next and may be delayed: exact between
 *          samples
 */
#ifndef RITZ_CONTROLLED_H
#define RITZ_CONTROLLED_H

#include <ritz/check.h>
#include <ritz/response.h>
#include <ritz/simulate.h>

#pragma GCC visibility push(default)

/* Most states of a closed loop whose poles are computed, and of one that is
   propagated by its exponential; most dofs of a component that is integrated
   unreduced in a loop whose poles are computed. */
enum { RITZ_LOOP_POLES = 600, RITZ_LOOP_EXACT = 400, RITZ_LOOP_DOFS = 400 };

/* A controller and how it acts. All of it is borrowed. */
typedef struct ritz_controlled {
    const ritz_state_space *controller;
    const ritz_loop *loop; /* how it is joined to the simulated model */
    bool exact;            /* one exponential; else split, or sampled */
    bool discrete;         /* its A and B lead from one sample to the next */
    double sample; /* s from one sample to the next; 0: it is continuous */
    double delay;  /* s from a sample until the output of it acts */
    bool any_step; /* accept a step at which the split is unstable */
    bool force;    /* accept a loop that is itself unstable */
} ritz_controlled;

/* Stability of a loop, and of the method that propagates it. */
typedef struct ritz_loop_stability {
    bool known; /* whether the continuous loop is stable: `loop` says so */
    ritz_probe loop;
    double radius;  /* spectral radius of the map from one step, or sample, to
                       the next; NaN of `exact` */
    bool grows;     /* radius exceeds 1 by more than its error */
    bool neutral;   /* radius is 1 within its error: the motion neither grows
                       nor decays */
    bool estimated; /* radius is estimated from the growth of a vector, as the
                       map is too large */
    double limit;   /* s: shortest step, of those tried from `from` upwards, at
                       which the split is unstable. HUGE_VAL: none up to the
                       length of the run; 0: the first one; NaN: not computed,
                       if the loop is exact, sampled, unstable by its delay or
                       unstable itself */
    double from;    /* s */
    bool unstable_by_delay; /* grows at finer steps too, and has a delay */
    bool hides_instability; /* the loop is unstable but its propagation is
                               stable: the computed motion would decay */
} ritz_loop_stability;

/**
 * The longest step, of at most @p step, of which the sample and the delay are
 * whole multiples.
 *
 * @return RITZ_ERR_ARGUMENT if no such step is longer than a thousandth of
 *         @p step, or if a million numbers of steps were tried without success
 */
ritz_status ritz_controlled_step(const ritz_controlled *controlled, double step,
                                 double *out);

/**
 * Determine whether a loop is stable, and whether its propagation in time is.
 *
 * `limit` is bracketed by steps that grow by a factor of 1.5, from a part of
 * the shortest time constant upwards, that of the request among them, and then
 * found by bisection: a narrow band of unstable steps below it may be missed.
 *
 * @return RITZ_ERR_ARGUMENT if the loop does not fit the model;
 *         RITZ_ERR_SINGULAR if the feedthroughs of both form a singular loop
 * @cost   about 25 N^3 for the poles of N states, and as much for each of about
 *         60 steps
 */
ritz_status ritz_controlled_examine(ritz_model subject,
                                    const ritz_simulation_request *request,
                                    const ritz_controlled *controlled,
                                    ritz_loop_stability *out);

/**
 * Processor time of a step of a closed loop, measured at rest, in s: the least
 * of several measurements, as of ritz_simulate_step_cost.
 *
 * @return RITZ_ERR_ARGUMENT as ritz_simulate_controlled; whether the loop is
 *         stable is not examined
 */
ritz_status ritz_controlled_step_cost(ritz_model subject,
                                      const ritz_simulation_request *request,
                                      const ritz_controlled *controlled,
                                      double *out);

/**
 * Refuse a loop that is unstable, unless `force` is set, and a step at which
 * the split is unstable, unless `any_step` is set.
 *
 * @return RITZ_ERR_ARGUMENT if the loop or the step is refused
 */
ritz_status ritz_controlled_refuse(const ritz_simulation_request *request,
                                   const ritz_controlled *controlled,
                                   const ritz_loop_stability *stability);

/**
 * Simulate a closed loop. The controller starts at rest, and its outputs are 0
 * before its first sample.
 *
 * The work includes that of the controller. Diagnostics are the outputs of the
 * controller (at the time at which they act, without the sign of the feedback),
 * the norm of its states, and its part of the work.
 *
 * @param[in] stability  of ritz_controlled_examine; NULL: the loop is examined,
 *                  and refused as by ritz_controlled_refuse
 * @return RITZ_ERR_ARGUMENT as ritz_simulate and ritz_controlled_refuse, if an
 *         impulse reaches a measured output by feedthrough, if the step does
 *         not divide sample and delay, or if there are too many states for
 *         `exact`
 * @cost   a step of split costs that of the integrator and O((n + m) p + m^2),
 *         for m states of the controller and p of its signals; a step of exact
 *         O((n + m) k) if the loop adds a rank k to the matrices of a step,
 *         at most O((n + m)^2)
 */
ritz_status ritz_simulate_controlled(ritz_model subject,
                                     const ritz_simulation_request *request,
                                     const ritz_controlled *controlled,
                                     const ritz_loop_stability *stability,
                                     ritz_simulation *out);

#pragma GCC visibility pop

#endif
