/*
 * Closed loops in time. Plant and controller are joined as for frequency
 * responses (ritz_loop), e = some of y and u = r - v, or r + v of positive
 * feedback, and propagated in one of three ways:
 *
 * split    each over a step, exactly or by the plant's integrator, with what
 *          the other one puts out held over it: O(n) a step of a modal plant,
 *          of first order in the step [Sirlin1992]
 * exact    both together, by one exponential of the closed loop
 * sampled  the controller acts at its samples alone, and its output, held from
 *          one to the next, may come late: exact between samples
 */
#ifndef RITZ_CONTROLLED_H
#define RITZ_CONTROLLED_H

#include <ritz/check.h>
#include <ritz/response.h>
#include <ritz/simulate.h>

#pragma GCC visibility push(default)

/* Most states of a closed loop whose poles are computed, and of one that is
   propagated by its exponential. */
enum { RITZ_LOOP_POLES = 600, RITZ_LOOP_EXACT = 400 };

/* A controller and how it acts. All is borrowed. */
typedef struct ritz_controlled {
    const ritz_state_space *controller;
    const ritz_loop *loop; /* of it with the model that is simulated */
    bool exact;            /* one exponential; else split, or sampled */
    bool discrete;         /* its A and B lead from one sample to the next */
    double sample; /* s from one sample to the next; 0: it is continuous */
    double delay;  /* s, later than measured its outputs act by this */
    bool any_step; /* a step too that makes the split unstable */
    bool force;    /* a loop too that is unstable itself */
} ritz_controlled;

/* What is known of a loop and of the way it is propagated. */
typedef struct ritz_outlook {
    bool known; /* whether the loop itself, continuous, is stable */
    ritz_probe loop;
    double
        radius; /* spectral, of the map from a step, or a sample, to the next;
                      of `exact` NaN */
    bool grows; /* whether it is above 1 by more than its error */
    bool estimated; /* by the growth of a vector, the map being too large */
    double limit;   /* s: the least step found at which the split is unstable.
                       HUGE_VAL: none up to a whole run; 0: it is at every step;
                       NaN: not looked for, as of `exact` and sampled */
    bool hides;     /* the loop is unstable, and the way it is propagated is
                       not: the run would decay */
} ritz_outlook;

/**
 * A step of which the sample and the delay are multiples: the longest that is
 * no longer than @p step.
 *
 * @return RITZ_ERR_ARGUMENT if there is none of at least a thousandth of it, or
 *         among the next million of numbers of steps
 */
ritz_status ritz_controlled_step(const ritz_controlled *controlled, double step,
                                 double *out);

/**
 * Whether a loop is stable, and whether it is as propagated.
 *
 * `limit` is bracketed by steps 1.25 times each other, from that of the request
 * on upwards, or by halves downwards, and then found by bisection: a narrow band
 * of unstable steps may lie below it. The request's own step is always examined.
 *
 * @return RITZ_ERR_ARGUMENT if the loop does not fit the model;
 *         RITZ_ERR_SINGULAR if the feedthroughs of both form a singular loop
 * @cost   some 25 N^3 for poles, N states; as much for each of some 60 steps
 */
ritz_status ritz_controlled_examine(ritz_model subject,
                                    const ritz_simulation_request *request,
                                    const ritz_controlled *controlled,
                                    ritz_outlook *out);

/** RITZ_ERR_ARGUMENT, and the sentence, if a loop with such an outlook is not
 * simulated unless by `force` or `any_step`. */
ritz_status ritz_controlled_refuse(const ritz_simulation_request *request,
                                   const ritz_controlled *controlled,
                                   const ritz_outlook *outlook);

/**
 * Simulate a closed loop, at rest the controller, before its first sample with
 * outputs of 0.
 *
 * The work is that of inputs and controller. Diagnostics are what the
 * controller puts out (as it acts, without the sign of the feedback), the norm
 * of its states, and its part of the work.
 *
 * @param[in] seen  of ritz_controlled_examine; NULL: it is examined, and
 *                  refused, here
 * @return RITZ_ERR_ARGUMENT as ritz_simulate and ritz_controlled_refuse, if an
 *         impulse is measured directly, if the
 *         step does not divide sample and delay, or if `exact` is of too many
 *         states
 * @cost   a step of split: that of the integrator, and O((n + m) p + m^2) of m
 *         states of the controller and p of its signals; of exact O((n + m)^2)
 */
ritz_status ritz_simulate_controlled(ritz_model subject,
                                     const ritz_simulation_request *request,
                                     const ritz_controlled *controlled,
                                     const ritz_outlook *seen,
                                     ritz_simulation *out);

#pragma GCC visibility pop

#endif
