/*
 * A loop around a plant: with the plant y = G u and a controller v = F e,
 *
 *     e = some of y,   u = w - v where v acts, or w + v of positive feedback,
 *
 * the response from w to y is G (I + F G)^-1, found in frequency from the
 * responses of both, whose own structure is not lost [Sirlin1992], and in
 * states where poles are wanted.
 *
 * (The middle form of that paper's equation for H(s) multiplies G and F in the
 * wrong order: G (I + F G)^-1 F is meant.)
 */
#ifndef RITZ_CLOSED_LOOP_H
#define RITZ_CLOSED_LOOP_H

#include <ritz/response.h>
#include <ritz/state_space.h>

#pragma GCC visibility push(default)

/* What goes in and comes out of a model, by name; borrowed. */
typedef struct ritz_ends {
    int64_t num_inputs, num_outputs;
    const char (*input)[RITZ_NAME_SIZE];
    const char (*output)[RITZ_NAME_SIZE];
} ritz_ends;

/* Which signal of the plant meets which of the controller. */
typedef struct ritz_loop {
    int64_t num_measured; /* inputs of the controller */
    int64_t *measured;    /* the plant's output that each is */
    int64_t num_driven;   /* outputs of the controller */
    int64_t *driven;      /* the plant's input that each adds to */
    bool positive;        /* feedback; else negative */
} ritz_loop;

/**
 * Join by name: each input of the controller is called as an output of the
 * plant, each output as an input of the plant, unless a pair says otherwise.
 *
 * @param[in] pair  "OUT=IN", as a signal flows: an output of the plant into the
 *                  controller, or one of the controller into the plant
 * @return RITZ_ERR_ARGUMENT naming what is not joined, or twice
 */
ritz_status ritz_loop_match(const ritz_ends *plant, const ritz_ends *controller,
                            int64_t num_pairs, const char *const *pair,
                            ritz_loop *out);

/**
 * Whether all signals of a loop exist; names are not asked.
 *
 * @return RITZ_ERR_ARGUMENT naming what does not
 */
ritz_status ritz_loop_check(const ritz_loop *loop, const ritz_ends *plant,
                            const ritz_ends *controller);

/**
 * The closed loop as one model, from the plant's inputs to its outputs; states
 * are the plant's, then the controller's.
 *
 * @return RITZ_ERR_ARGUMENT if the loop does not fit; RITZ_ERR_SINGULAR if the
 *         loop has no answer: what passes through both at once makes a circle
 */
ritz_status ritz_closed_loop(const ritz_state_space *plant,
                             const ritz_state_space *controller,
                             const ritz_loop *loop, ritz_state_space *out);

/* A loop at one frequency. */
typedef struct ritz_loop_values {
    double _Complex gain; /* F G of a loop of one signal, its sign turned by
                             positive feedback; NaN where there are more */
    double largest_gain;  /* singular value of F G */
    double sensitivity;   /* largest singular value of (I + F G)^-1 */
} ritz_loop_values;

/**
 * Close it at one frequency.
 *
 * @param[in]  G  of the plant, row by row, outputs x inputs
 * @param[in]  F  of the controller, row by row, num_driven x num_measured
 * @param[out] H  as G: G (I + F G)^-1; NULL: not wanted
 * @return RITZ_ERR_SINGULAR if I + F G is
 * @cost   O((num_driven + inputs)(num_driven^2 + num_driven outputs))
 */
ritz_status ritz_loop_at(const ritz_loop *loop, int64_t num_outputs,
                         int64_t num_inputs, const double _Complex *G,
                         const double _Complex *F, double _Complex *H,
                         ritz_loop_values *values);

/**
 * The closed loop as something that responds: sampled, followed to a tolerance
 * and searched for peaks as every other. All is borrowed until it is freed.
 *
 * @param[in] plant, controller  made ready for the range
 * @param[in] pole   of the closed loop, around which a grid is refined beside
 *                   those of both; NULL: not known
 */
ritz_status ritz_loop_responder(const ritz_loop *loop, ritz_responder *plant,
                                ritz_responder *controller, int64_t num_poles,
                                const double _Complex *pole,
                                ritz_responder **out);

/* How far a loop is from its end, in the range of the points that were looked
   at. NaN: it is not of one signal, or does not cross there. */
typedef struct ritz_margins {
    double gain_up, gain_up_hz;         /* least factor above 1 that ends it */
    double gain_down, gain_down_hz;     /* largest factor below 1 that does */
    double phase, phase_hz;             /* least lag or lead  [degrees] */
    double sensitivity, sensitivity_hz; /* largest |(I + F G)^-1| */
    double gain, gain_hz;               /* largest |F G| */
} ritz_margins;

/** Crossings are found between points, by bisection, and peaks too. */
ritz_status ritz_loop_margins(const ritz_loop *loop, ritz_responder *plant,
                              ritz_responder *controller, int64_t count,
                              const double *hertz, ritz_margins *out);

void ritz_loop_free(ritz_loop *loop);

#pragma GCC visibility pop

#endif
