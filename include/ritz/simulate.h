/*
 * Time responses of linear models, and what they cost.
 *
 * Inputs are functions of time from t = 0 on. An integrator evaluates them at
 * the ends of its steps only. Within a step it assumes that they are linear
 * (RITZ_HOLD_FIRST), or constant at the value of its start (RITZ_HOLD_ZERO, as
 * for a sampled controller). `modal` is exact for both, and the errors of other
 * integrators are relative to it.
 *
 * Structural damping K4 is refused: i K4 is defined for harmonic motion only.
 * In a time response it would cause motion before there is an input.
 */
#ifndef RITZ_SIMULATE_H
#define RITZ_SIMULATE_H

#include <ritz/model.h>
#include <ritz/response.h>
#include <ritz/spin.h>
#include <ritz/system.h>

#include <stdbool.h>

#pragma GCC visibility push(default)

typedef enum ritz_hold {
    RITZ_HOLD_FIRST,
    RITZ_HOLD_ZERO,
} ritz_hold;

typedef enum ritz_signal_kind {
    RITZ_SIGNAL_ZERO,
    RITZ_SIGNAL_STEP,    /* the amplitude, from t = 0 on */
    RITZ_SIGNAL_IMPULSE, /* of that area, at t = 0: a jump of the velocity */
    RITZ_SIGNAL_SINE,    /* sin(2 pi hertz[0] t) */
    RITZ_SIGNAL_CHIRP,   /* from hertz[0] to hertz[1], linear over the run */
    RITZ_SIGNAL_TABLE,   /* linear between its points, 0 outside */
} ritz_signal_kind;

typedef struct ritz_signal {
    ritz_signal_kind kind;
    double amplitude;
    double hertz[2];
    int64_t count;        /* of a table */
    double *time, *value; /* count, times ascending */
} ritz_signal;

/**
 * "step", "impulse", "sine:F" or "chirp:F0,F1", each followed by "*A" for an
 * amplitude other than 1. Any other text names a file of two columns, time and
 * value, in which '#' begins a comment. If a time occurs twice, the signal
 * jumps to the second value.
 *
 * @return RITZ_ERR_ARGUMENT if the text is not valid; RITZ_ERR_FILE,
 *         RITZ_ERR_FORMAT
 */
ritz_status ritz_signal_parse(const char *text, ritz_signal *out);

/** Read a signal from a file of two columns, time and value.
 * @return RITZ_ERR_FILE, RITZ_ERR_FORMAT */
ritz_status ritz_signal_read(const char *path, ritz_signal *out);

/** Whether a text names a file: it begins with none of these words. */
bool ritz_signal_is_file(const char *text);

/** Value at @p t >= 0 in a run of @p seconds; 0 for an impulse. */
double ritz_signal_at(const ritz_signal *signal, double t, double seconds);

void ritz_signal_free(ritz_signal *signal);

struct ritz_motion;
struct ritz_march;

/* A way from one time to the next, as a table row. */
typedef struct ritz_integrator {
    const char *name;
    const char *summary;
    const char *accuracy;    /* order in the step */
    const char *stability;   /* for which steps */
    const char *dissipation; /* what it dissipates in addition to the damping
                                of the model */
    const char *fails;
    const char *reference; /* key in docs/references.bib */
    bool takes_sparse;     /* full components, without modes */
    bool takes_states;     /* first-order models */
    bool is_explicit;      /* bounded by 2/omega_max */
    /** @return RITZ_ERR_ARGUMENT, RITZ_ERR_SINGULAR: no way with this step */
    ritz_status (*start)(const struct ritz_motion *motion, double step,
                         double rho, struct ritz_march *out);
} ritz_integrator;

/** All of them, ended by NULL. */
extern const ritz_integrator *const ritz_integrators[];

extern const ritz_integrator ritz_integrator_modal;
extern const ritz_integrator ritz_integrator_trapezoidal;
extern const ritz_integrator ritz_integrator_generalised_alpha;
extern const ritz_integrator ritz_integrator_central_difference;

/* A simulation that is wanted. Everything is borrowed. */
typedef struct ritz_simulation_request {
    const ritz_integrator *integrator;
    double seconds, step; /* the last step ends at `seconds` or just beyond */
    ritz_hold hold;
    double rho;      /* generalised-alpha, at infinite frequency, 0 to 1 */
    double up_to_hz; /* of a component by its modes */
    int64_t every;   /* steps from one that is written to the next; 0: 1 */
    const ritz_signal *signal; /* one of each input, in their order; NULL: 0 */
    const double *x0, *v0;     /* of the model's coordinates; NULL: at rest.
                                  Of a state space x0 are its states */
    bool coordinates;          /* store the coordinates of a dense model */
    bool (*stop)(void *context); /* asked before each step; true ends the run
                                    early. NULL: it runs to its end */
    void *context;
    /* A run of the same model and request that ended early, which is continued:
       results are identical to those of a run without an end. NULL: the run
       begins at t = 0 */
    const struct ritz_simulation *from;
} ritz_simulation_request;

#define RITZ_SIMULATION_NONE                                                   \
    {                                                                          \
        .integrator = &ritz_integrator_modal, .rho = 0.8                       \
    }

/*
 * A time response. Energies are of second-order models only:
 *
 *     balance = kinetic + potential + dissipated - work - (at the start)
 *
 * is the energy that the integrator adds or removes. It is rounding for
 * `modal`, whose integrals are exact, and for `trapezoidal`, which satisfies
 * the balance exactly.
 */
typedef struct ritz_simulation {
    int64_t count;
    double *seconds; /* count, from 0, ascending */
    int64_t num_inputs, num_outputs;
    char (*input)[RITZ_NAME_SIZE];
    char (*output)[RITZ_NAME_SIZE];
    double *u; /* u[k * num_inputs + j], without impulses */
    double *y; /* y[k * num_outputs + i] */
    double *kinetic, *potential, *dissipated, *work, *balance; /* count, or
                                                                  all NULL */
    double energy_rounding;  /* energies below it are rounding; 0: not known */
    int64_t num_diagnostics; /* values of the method, such as the violation of
                                constraints */
    char (*diagnostic)[RITZ_NAME_SIZE]; /* their names */
    double *diagnosis;                  /* diagnosis[k * num_diagnostics + j] */
    int64_t num_coordinates; /* of the model; 0: they are not stored */
    double *q, *v, *a;       /* q, q' and q'': q[k * num_coordinates + j] */
    int64_t num_blocks;      /* 0: coordinates belong to the simulated model */
    ritz_block *block;       /* else to bodies, one after the other */
    char spin[4 * RITZ_NAME_SIZE]; /* spin of the frame, as `spin` of a
                                      system; "": it is at rest */
    int64_t num_state;             /* 0: the run came to its end */
    double *state;                 /* from which the run is continued */
    char integrator[RITZ_NAME_SIZE];
    char hold[RITZ_NAME_SIZE]; /* "first", "zero" */
    double step;
    int64_t order; /* coordinates that were integrated */
    char damping[RITZ_DAMPING_SIZE];
} ritz_simulation;

/**
 * Simulate. Motions without mass of a small dense model are eliminated
 * statically. A full component is represented by its modes up to
 * request->up_to_hz, to which the static response of all other modes is added;
 * or it is integrated implicitly with one sparse factor, with Rayleigh damping
 * or that of its D. A state space is propagated by the exponential of A, or by
 * the trapezoidal rule.
 *
 * The coordinates of a dense model are computed as additional outputs of the
 * same integration.
 *
 * An impulse changes the state at once. Where an output depends on the input
 * directly, as accelerations do, it has an impulse too, which is left out.
 *
 * A run that request->stop ends early is no failure: it has the times until its
 * end, and a state.
 *
 * @return RITZ_ERR_ARGUMENT if the step is above the stability limit of an
 *         explicit integrator (the sentence has the limit), if there is
 *         structural damping, if a motion without mass is damped, if
 *         request->from is not of this model and request, or if the request is
 *         contradictory; RITZ_ERR_CONVERGENCE if the motion grows without bound
 * @cost   modal: O(r^3) once and O(r) a step, O(r^2) if D couples modes;
 *         the others O(r^3) once and O(r^2) a step; for a full component one
 *         factor, and one solve a step
 */
ritz_status ritz_simulate(ritz_model subject,
                          const ritz_simulation_request *request,
                          ritz_simulation *out);

/* The accuracy that ritz_simulate_accurate reached. */
typedef struct ritz_accuracy {
    double error;     /* largest of the outputs that must be accurate */
    int64_t num_left; /* outputs that need not be: see below */
    int64_t left;     /* the worst of them; -1: none */
    double rounding;  /* of that output: its difference, relative to the
                         largest value that the motion could give it */
} ritz_accuracy;

/**
 * Simulate with a step that is halved until the outputs differ by less than
 * @p tolerance from those of `modal` at half that step, relative to the largest
 * value of each output. The difference includes the error of holding inputs
 * within a step. A full component with an implicit integrator is compared with
 * the same integrator at half the step. The first step is request->step; if
 * that is 0, a fiftieth of the run, or a tenth of the shortest period of a sine
 * or chirp.
 *
 * An output that does not respond consists of rounding, to whose largest value
 * no error is relative. An output that is not accurate is therefore left out if
 * it is below 64 eps of the largest value that the motion could give it, or if
 * its difference is below 1e-9 of that value and three halvings in a row have
 * not halved it. That value is |c| |x| + |cv| |x'| + |ca| |x''|, |x|^2 = x'M x,
 * |c|^2 = c M^-1 c' with the diagonal of M, so that it does not depend on
 * units; for a state space it is sum |c_j| |x_j|.
 *
 * Only the last run, with the step that was found, may end early or be
 * continued.
 *
 * @param[out] reached  may be NULL
 * @return RITZ_ERR_CONVERGENCE if request->stop ends the search, or if the
 *         accuracy is not reached with 2^23 steps and 2^28 values
 */
ritz_status ritz_simulate_accurate(ritz_model subject,
                                   const ritz_simulation_request *request,
                                   double tolerance, ritz_accuracy *reached,
                                   ritz_simulation *out);

/**
 * Simulate a model in a frame that turns at a rate which may change, from a
 * start in that frame: x0, v0, displacements, velocities and accelerations are
 * relative to it. Diagnostics are the rate, its derivative, the angle, the work
 * of the drive that imposes the rate (`work` includes it), and the energy of
 * stiffening, W^2 x'KG x / 2.
 * Kinetic energy is that in the frame at rest, with that of the spin itself.
 *
 * @param[in] terms  in the coordinates of the model
 * @return RITZ_ERR_ARGUMENT if the integrator is not trapezoidal, or sizes
 *         disagree; RITZ_ERR_CONVERGENCE, as ritz_simulate
 * @cost   O(r^3) a step while the rate changes, O(r^2) while it does not
 */
ritz_status ritz_simulate_spun(ritz_model subject, const ritz_spin_terms *terms,
                               const ritz_spin_rate *rate,
                               const ritz_simulation_request *request,
                               ritz_simulation *out);

/**
 * Largest difference of the outputs at the same times, of each output relative
 * to its largest value in @p exact; of outputs that stay 0, not counted.
 *
 * @return RITZ_ERR_ARGUMENT if times or outputs disagree
 */
ritz_status ritz_simulation_difference(const ritz_simulation *exact,
                                       const ritz_simulation *other,
                                       double *out);

void ritz_simulation_free(ritz_simulation *simulation);

/*
 * What a model costs a simulator. step_explicit is the largest stable step of
 * central differences that take the damping forces from half a step before, as
 * explicit codes do: 2/s, s the largest root of det(s^2 M - s D - K); never
 * above 2/omega_max, which it is without damping. (Our own central-difference
 * solves for the damping forces and is stable to 2/omega_max.) step_accurate is
 * that at which the trapezoidal rule makes periods at the band's end longer by
 * a thousandth: (w h)^2 / 12 = 1e-3. seconds_per_second is processor time, and
 * so changes from run to run.
 */
typedef struct ritz_cost {
    double highest_hz;               /* of the model; 0 if it is rigid */
    double step_explicit;            /* s; HUGE_VAL of a rigid undamped model */
    double step_accurate;            /* s */
    double seconds_per_second;       /* measured: processor time to simulate one
                                  second by `integrator` at `step` */
    double step;                     /* s: step_accurate */
    char integrator[RITZ_NAME_SIZE]; /* "trapezoidal", full matrices */
    int64_t order;                   /* r */
} ritz_cost;

/**
 * @param[in] band_hz  its end is to be resolved; NULL or an end of 0: the
 *                     highest frequency of the model, of a rigid one 1 Hz
 * @return RITZ_ERR_ARGUMENT as ritz_simulate, or if the band makes no sense
 * @cost   O(r^3) and some 20 ms of steps
 */
ritz_status ritz_simulate_cost(ritz_model model, const double band_hz[2],
                               ritz_cost *out);

/** Processor time, s, of one step of any integrator: the least of several. */
ritz_status ritz_simulate_step_cost(ritz_model model,
                                    const ritz_integrator *integrator,
                                    double step, double *out);

/**
 * An estimate, not measured on the model: the same at each step if the mass
 * matrix is made anew and factored (r^3 / 3 flops, at the rate that one factor
 * of this size runs at), as simulators of bodies that rotate do.
 */
ritz_status ritz_simulate_refactor_cost(int64_t order, double *out);

#pragma GCC visibility pop

#endif
