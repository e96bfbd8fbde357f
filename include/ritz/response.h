/*
 * Frequency responses H(i omega) from inputs to outputs: on a grid, or at
 * points chosen so that interpolation between them is within a tolerance.
 * An engine computes H at one frequency.
 */
#ifndef RITZ_RESPONSE_H
#define RITZ_RESPONSE_H

#include <ritz/model.h>

#include <stdbool.h>

#pragma GCC visibility push(default)

typedef struct ritz_response {
    int64_t count; /* of frequencies */
    double *hertz; /* ascending */
    int64_t num_inputs, num_outputs;
    char (*input)[RITZ_NAME_SIZE];
    char (*output)[RITZ_NAME_SIZE];
    double _Complex *H;          /* H[(k * num_outputs + i) * num_inputs + j] */
    char method[RITZ_NAME_SIZE]; /* the engine: "modal", "direct", ... */
    char damping[RITZ_DAMPING_SIZE];
    char interpolation[RITZ_NAME_SIZE]; /* "cubic": made for it; "" not said */
    double tolerance;     /* between points, of the largest |H| of a channel; 0:
                         not kept */
    int64_t num_singular; /* values at each point; 0: not computed */
    double *singular;     /* count x num_singular, descending */
    double singular_peak[2]; /* hertz and value of the largest, between the
                                points too, HUGE_VAL where nothing damps it;
                                0, 0: not looked for */
} ritz_response;

/* The frequencies at which a response is requested. */
typedef struct ritz_grid {
    double from_hz, to_hz; /* 0 <= from < to */
    int64_t count;         /* evenly spaced in frequency, at least 2 */
    bool log;              /* evenly spaced in its logarithm; from > 0 */
    bool refine;           /* and at, and around, every resonance inside */
    const double *hertz;   /* count points instead of all that, ascending */
} ritz_grid;

/**
 * Frequencies of a grid; with `refine`, for each mode (omega, zeta) inside the
 * range also its peak and points from 0.25 to 8 half-power widths on both
 * sides, so that no peak falls between points.
 */
ritz_status ritz_grid_points(const ritz_grid *grid, int64_t num_modes,
                             const double *omega, const double *zeta,
                             int64_t *count, double **out);

/**
 * The response at a frequency between stored points: each channel is
 * interpolated by a cubic through two points on either side, in the first and
 * the last interval through the outermost four points, and by a polynomial
 * through all points if there are fewer than four. The `tolerance` of a
 * response refers to this interpolation.
 *
 * @param[in] hertz  within the range of the points
 * @param[out] out   num_outputs x num_inputs, row by row
 * @return RITZ_ERR_ARGUMENT outside the range, without points, or if one of the
 *         points used occurs twice
 */
ritz_status ritz_response_at(const ritz_response *response, double hertz,
                             double _Complex *out);

void ritz_response_free(ritz_response *response);

typedef struct ritz_response_request {
    ritz_model model;      /* that responds */
    double from_hz, to_hz; /* the range of later requests */
    double up_to_hz;       /* highest frequency of the modes that are summed for
                              a component; 0: three times to_hz. Damping ratios
                              act on all modes whatever this is, except for
                              components of more than 2000 dofs with D or K4 */
    double tolerance; /* of engines that approximate, relative to the largest
                         |H| of a channel; 0: 1e-9, except that modal only
                         remarks on its error */
} ritz_response_request;

/* A model made ready to respond at any frequency of its range: opaque. */
typedef struct ritz_responder ritz_responder;

typedef struct ritz_response_engine {
    const char *name;    /* as typed on the command line */
    const char *summary; /* one line for --list */
    const char *reference;
    /* what a newcomer chooses by: for which models, at what cost, what is
       guaranteed, where it fails */
    const char *when, *cost, *holds, *fails;
    int takes; /* sum of ritz_model_kind */
    ritz_status (*make)(const ritz_response_request *request,
                        ritz_responder *out);
} ritz_response_engine;

/** All engines, ended by NULL. */
extern const ritz_response_engine *const ritz_response_engines[];

/**
 * Solves with the full matrices of a component at each point. Damping ratios
 * act on all modes; for components of more than 2000 dofs that have D or K4,
 * only on the modes up to `up_to_hz`. Rayleigh damping is exact. With D, K4 or
 * Rayleigh damping a free body is refused at 0 Hz.
 */
extern const ritz_response_engine ritz_response_engine_direct;

/**
 * A sum over modes. For a dense model it includes all modes, with the damping
 * ratios given and those of Phi'D Phi; where D couples modes, a system of all
 * modes is solved at each point. For a component it includes the modes up to
 * `up_to_hz`; the modes above contribute a series in w^2 that begins with their
 * residual flexibility and is damped by a M + b K and by ratios.
 *
 * Where other damping acts on a component, the sum is compared with the direct
 * engine at some resonances and between them. A remark states the difference;
 * if it exceeds a tolerance, the engine returns RITZ_ERR_CONVERGENCE.
 *
 * Rigid modes contribute 1/(-w^2): a point at 0 Hz is refused if they are
 * controllable and observable.
 */
extern const ritz_response_engine ritz_response_engine_modal;

/** Engine called @p name; NULL and a sentence with the nearest if none. */
const ritz_response_engine *ritz_response_engine_find(const char *name);

/**
 * The engine that `auto` stands for.
 *
 * @param[out] why  a sentence without its end; not to be freed
 */
const ritz_response_engine *
ritz_response_engine_choose(const ritz_response_request *request,
                            const char **why);

/**
 * Prepare a model: modes, factors, interpolants, all that points share.
 *
 * @return RITZ_ERR_ARGUMENT if the engine is not for such a model;
 *         RITZ_ERR_CONVERGENCE if it cannot keep the tolerance
 */
ritz_status ritz_responder_new(const ritz_response_engine *engine,
                               const ritz_response_request *request,
                               ritz_responder **out);

/**
 * The same or, if the engine does not converge on a component, by direct; the
 * remark says so.
 */
ritz_status ritz_responder_or_direct(const ritz_response_engine *engine,
                                     const ritz_response_request *request,
                                     ritz_responder **out);

/**
 * H at one frequency.
 *
 * @param[out] H  num_outputs x num_inputs, row by row
 * @return RITZ_ERR_SINGULAR on an undamped pole, or at 0 Hz where a rigid
 *         motion is driven and observed; RITZ_ERR_ARGUMENT above the range of a
 *         component
 */
ritz_status ritz_responder_at(ritz_responder *responder, double hertz,
                              double _Complex *H);

/** Remark on the preparation of a responder: "" if there is none. */
const char *ritz_responder_remark(const ritz_responder *responder);

/** How rounding of a component's stiffness affects its responses; `motions` is
 * 0 where it does no harm. */
ritz_rounded ritz_responder_rounded(const ritz_responder *responder);

/**
 * How far H is uncertain, relative to the largest |H| of a channel, because the
 * effect of damping ratios on the modes that are not summed is known only
 * approximately. 0 where all modes are computed, which is up to 2000 dofs.
 */
double ritz_responder_uncertainty(const ritz_responder *responder);

/** The points of a grid, which must lie in the range that was asked for. */
ritz_status ritz_responder_sample(ritz_responder *responder,
                                  const ritz_grid *grid, ritz_response *out);

/**
 * H at the points of a grid, and at as many more points as ritz_response_at
 * needs to interpolate H within @p tolerance of the largest |H| of each
 * channel. Among the points are the peak of every pole and the dip of every
 * zero that is near enough to the imaginary axis to make one.
 *
 * @return RITZ_ERR_SINGULAR as above; RITZ_ERR_CONVERGENCE if the tolerance
 *         needs too many points
 * @cost   some 40 points a resonance at a tolerance of 1e-3, some 200 at 1e-6
 */
ritz_status ritz_responder_follow(ritz_responder *responder,
                                  const ritz_grid *grid, double tolerance,
                                  ritz_response *out);

void ritz_responder_free(ritz_responder **responder);

/**
 * A measured response as a responder. Between its points it is interpolated by
 * ritz_response_at; frequencies outside their range are refused. It has no
 * states, so that the stability of a loop around it is not known.
 *
 * @param[in] response  borrowed; at least two points
 */
ritz_status ritz_measured_responder(const ritz_response *response,
                                    ritz_responder **out);

/** Inputs and outputs of a response, names only; borrowed. */
ritz_io ritz_response_io(const ritz_response *response);

/**
 * Read a table of text: hertz, and for each channel real and imaginary part, or
 * magnitude and degrees, as its header line says; three columns without a
 * header are hertz, real and imaginary part from u1 to y1. ritz-export --to tsv
 * writes such a table. The header may be without its '#'.
 *
 * @return RITZ_ERR_FILE; RITZ_ERR_FORMAT with the line, if frequencies do not
 *         ascend, a channel is missing or occurs twice, or a row is no row of
 *         finite numbers
 */
ritz_status ritz_response_read_table(const char *path, ritz_response *out);

/** Whether a file is text, so that it may be such a table but no container. */
bool ritz_response_table_seems(const char *path);

/**
 * All at once: the points of @p grid if @p tolerance is 0, else those that keep
 * it.
 *
 * @param[in] engine    NULL: the one that `auto` stands for, or direct
 * @param[in] up_to_hz  as in a request
 * @return RITZ_ERR_SINGULAR if a point lies on an undamped pole
 */
ritz_status ritz_response_of(ritz_model model,
                             const ritz_response_engine *engine,
                             double up_to_hz, double tolerance,
                             const ritz_grid *grid, ritz_response *out);

/*
 * Singular values of a response of several inputs and outputs: the largest is
 * the largest response to a unit input of any direction and phase.
 */

/*
 * Scales of signals: outputs are divided by theirs, usually the limit of each;
 * inputs are multiplied by theirs, usually the largest size of each. NULL,
 * or NaN in place of a number: 1.
 */
typedef struct ritz_scales {
    const double *output, *input;
} ritz_scales;

/** Of one H, row by row: min(outputs, inputs) of them, descending.
 * @return RITZ_ERR_CONVERGENCE */
ritz_status ritz_singular_values(int64_t num_outputs, int64_t num_inputs,
                                 const double _Complex *H,
                                 const ritz_scales *scales, double *sigma);

/** Numerical rank of H: the most singular values at any of @p points that are
 * not zero relative to the largest of all; @p most are stored for each point,
 * descending. */
int64_t ritz_singular_rank(int64_t points, int64_t most, const double *sigma);

/**
 * At every point of a response; kept in it, in place of others.
 *
 * @param[in] scales  NULL: none
 */
ritz_status ritz_singular_of(const ritz_scales *scales,
                             ritz_response *response);

/**
 * The largest singular value and its frequency, between the points too: around
 * local maxima it is searched for until it no longer grows.
 * Responses that have points at every resonance, as refined ones have, leave
 * no peak between two that are lower.
 *
 * @param[in] responder  of the same model; NULL: points alone
 * @param[out] value     HUGE_VAL at a pole that nothing damps
 */
ritz_status ritz_singular_peak(const ritz_response *response,
                               const ritz_scales *scales,
                               ritz_responder *responder, double *hertz,
                               double *value);

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

/* Which signal of the plant is connected to which of the controller. */
typedef struct ritz_loop {
    int64_t num_measured; /* inputs of the controller */
    int64_t *measured;    /* the plant's output that each is */
    int64_t num_driven;   /* outputs of the controller */
    int64_t *driven;      /* the plant's input that each adds to */
    bool positive;        /* feedback; else negative */
} ritz_loop;

/**
 * Join by name: each input of the controller is called as an output of the
 * plant, each output as an input of the plant, unless a pair says otherwise. If
 * plant and controller have one input and one output each, and one of them has
 * the default names u1 and y1, they are joined whatever the names of the other.
 *
 * @param[in] pair  "OUT=IN", as a signal flows: an output of the plant into the
 *                  controller, or one of the controller into the plant
 * @return RITZ_ERR_ARGUMENT naming what is not joined, or twice
 */
ritz_status ritz_loop_match(const ritz_io *plant, const ritz_io *controller,
                            int64_t num_pairs, const char *const *pair,
                            ritz_loop *out);

/**
 * Check that all signals of a loop exist; their names are not compared.
 *
 * @return RITZ_ERR_ARGUMENT naming what does not
 */
ritz_status ritz_loop_check(const ritz_loop *loop, const ritz_io *plant,
                            const ritz_io *controller);

/**
 * The closed loop as one model, from the plant's inputs to its outputs; states
 * are the plant's, then the controller's.
 *
 * @return RITZ_ERR_ARGUMENT if the loop does not fit; RITZ_ERR_SINGULAR if the
 *         loop has no solution: the feedthroughs of both form a singular loop
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
 * Close the loop at one frequency.
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

/* Stability margins of a loop, in the range of the points that were evaluated.
   NaN: the loop has several signals, or no crossing there. */
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
