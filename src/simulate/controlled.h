/* Marches of closed loops. */
#ifndef RITZ_SIMULATE_CONTROLLED_H
#define RITZ_SIMULATE_CONTROLLED_H

#include "simulate/motion.h"

#include <ritz/controlled.h>

/** Numbers of steps in the sample and in the delay.
 * @return RITZ_ERR_ARGUMENT if they are not whole */
ritz_status ritz_controlled_counts(const ritz_controlled *controlled,
                                   double step, int64_t *period,
                                   int64_t *delay);

/** Refuse a model, a request and a controller that do not fit each other. */
ritz_status ritz_controlled_check(ritz_model subject,
                                  const ritz_simulation_request *request,
                                  const ritz_controlled *controlled);

/** The motion of a plant in first-order form. With a controller, it has at most
 * RITZ_LOOP_POLES states, and it is not sparse. */
ritz_status ritz_motion_states(const ritz_motion *motion, const ritz_io *io,
                               ritz_state_space *out);

/**
 * The march of split and sampled loops: that of the plant, with the controller
 * between its steps.
 *
 * @param[in] motion  borrowed, as all of @p controlled
 */
ritz_status ritz_split_start(const ritz_motion *motion,
                             const ritz_controlled *controlled,
                             const ritz_integrator *integrator, double step,
                             double rho, ritz_march *out);

/** How many numbers of a split march a step, or a sample, maps: x, v and its
 * other memory, without sums such as work. */
int64_t ritz_split_order(const ritz_march *march);

/** z := the map of z without inputs, over one sample. */
ritz_status ritz_split_map(ritz_march *march, double *z);

/** The march by one exponential of @p closed, which is copied. */
ritz_status ritz_exact_start(const ritz_motion *motion,
                             const ritz_state_space *plant,
                             const ritz_controlled *controlled, double step,
                             ritz_march *out);

/* Diagnostics of all closed loops: outputs of the controller, the norm of its
   states, and its work. */
typedef struct ritz_loop_notes {
    int64_t count;
    char (*name)[RITZ_NAME_SIZE];
    const char **list; /* the names, as a march takes them */
    int64_t num_states;
    const double *states; /* of the controller, borrowed */
    double *acting;       /* its outputs that act at present */
    const double *work;   /* borrowed */
} ritz_loop_notes;

ritz_status ritz_loop_notes_new(const ritz_state_space *controller, bool work,
                                ritz_loop_notes *out);
void ritz_loop_notes_fill(const ritz_loop_notes *notes, double *out);
void ritz_loop_notes_free(ritz_loop_notes *notes);

#endif
