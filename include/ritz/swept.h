/*
 * Motion of a system while one of its joints is turned, or slid, through a
 * range: the model changes with the setting a of that joint. See
 * docs/methods/swept.md for the equations.
 *
 * The coordinates of all bodies are u = T(a(t)) q. T spans motions that the
 * joints allow at a: its columns are the lowest modes of the system at a, made
 * continuous in a. Rates of T add terms to the equations of motion, which a
 * program that only exchanges matrices from step to step leaves out.
 */
#ifndef RITZ_SWEPT_H
#define RITZ_SWEPT_H

#include <ritz/assembly.h>
#include <ritz/simulate.h>

#pragma GCC visibility push(default)

/* How a setting changes over time, in degrees or lengths. */
typedef enum ritz_path_kind {
    RITZ_PATH_LINEAR, /* at one rate to the end */
    RITZ_PATH_SMOOTH, /* with 10 s^3 - 15 s^4 + 6 s^5, then constant */
    RITZ_PATH_TABLE,  /* a cubic spline at rest at both ends, then constant */
} ritz_path_kind;

typedef struct ritz_path {
    ritz_path_kind kind;
    double from, to, seconds;
    int64_t count;               /* of a table */
    double *time, *value, *bend; /* count: times ascending, settings, and the
                                     second derivatives of the spline */
} ritz_path;

/**
 * "0:60:30s", at one rate from 0 to 60 in 30 s; "0:60:30s:smooth"; or a file of
 * times and settings, two columns.
 *
 * @return RITZ_ERR_ARGUMENT if the text is none of these, or the setting does
 *         not change; RITZ_ERR_FILE, RITZ_ERR_FORMAT
 */
ritz_status ritz_path_parse(const char *text, ritz_path *out);

/** Setting, and its first and second derivative, at a time >= 0. */
void ritz_path_at(const ritz_path *path, double t, double out[static 3]);

/** Least and largest setting. */
void ritz_path_range(const ritz_path *path, double out[static 2]);

void ritz_path_free(ritz_path *path);

/*
 * Model over a range of a setting a; x = unit a is an angle in radians or a
 * length. At equally spaced knots x, the model has
 *
 *     F = [T; S T; D_r],
 *
 * where S has the rows of joint springs and D_r is the damping of ratios. Cubic
 * splines interpolate F between the knots, with errors of order 4 in T, 3 in
 * T_x and 2 in T_xx.
 *
 * If a hinge turns by more than 360 degrees, the knots cover one turn: T(x + 2
 * pi) = T(x) turn, so that the cost does not grow with the number of turns.
 */
typedef struct ritz_swept_model {
    char sweep[RITZ_NAME_SIZE]; /* "clock" */
    double unit;                /* x divided by the setting */
    int64_t order;              /* r */
    int64_t count;              /* number of knots, at least 5 */
    double first, spacing;      /* of x */
    int64_t num_springs;
    double *stiffness, *damping; /* num_springs */
    bool has_ratios;             /* F has rows D_r */
    ritz_dense turn; /* r x r, orthogonal; {0}: knots cover the whole range */
    ritz_dense F, bend; /* r columns for each knot; second derivatives */
    ritz_dense M, K, D; /* Q x Q, of all bodies; D {0}: none */
    ritz_dense G, H;    /* Q x Q, phi'M N phi and phi'N'M N phi, N phi = n x phi
                        of the bodies that turn with x; {0}: none turns */
    ritz_io io;         /* for Q */
    int64_t num_bodies;
    bool *turns;          /* num_bodies: the body turns with x */
    ritz_dense V;         /* N x Q: the coordinates of all bodies are V u; {0}:
                           they are u */
    ritz_dense start;     /* e x r: q = start' x0, with x0 in all e modes of the
                           system at the start */
    ritz_dense start_B;   /* e x inputs, in the same modes */
    int64_t start_rigid;  /* number of rigid motions among these modes */
    double *start_lambda; /* e: their eigenvalues, rigid ones 0 */
    double start_hz[2]; /* lowest flexible and highest frequency at the start */
    double error;       /* of the spline between knots, as measured by
                           ritz_stage_sweep */
} ritz_swept_model;

/* What model ritz_stage_sweep is to compute. */
typedef struct ritz_sweep_request {
    int64_t sweep;               /* its index in the scene */
    const double *setting;       /* of all sweeps, at the start; borrowed */
    double range[2];             /* of the setting of that sweep */
    int64_t modes;               /* r; 0: modes up to up_to_hz */
    double up_to_hz;             /* 0, with modes = 0: all modes */
    const ritz_damping *damping; /* NULL: that of bodies and joints alone */
    const ritz_stage *origin; /* x0 is in the modes of this stage, whose bodies
                                    were projected on V to give those of the
                                    stage; NULL: of the stage itself */
    const ritz_dense *V;      /* one for each body; NULL if `origin` is */
} ritz_sweep_request;

/**
 * The model of a stage over a range of one of its sweeps. The spacing of knots
 * is halved until the spline, half way between knots, differs from the basis
 * that is computed there by less than 1e-7. The difference is measured for each
 * column, in the norm of mass, and in that of stiffness divided by the
 * frequency of the last mode. T is aligned from knot to knot by Procrustes'
 * rotation in the inner product of the mass.
 *
 * @return RITZ_ERR_ARGUMENT if a mode leaves or enters the band within the
 *         range (the sentence has the mode and the setting); if the space of r
 *         modes is not continuous, because mode r changes places with mode r +
 *         1; if constraints lose rank; if there is structural damping, a body
 *         with force columns, or a body that turns and whose inertia is not
 *         known; or as ritz_stage_assemble
 * @cost   an assembly for each setting
 */
ritz_status ritz_stage_sweep(const ritz_stage *stage,
                             const ritz_sweep_request *asked,
                             ritz_swept_model *out);

void ritz_swept_model_free(ritz_swept_model *model);

/* Shares of the initial state that a basis does not span, 0 to 1; 0 if the
   initial value itself is zero. */
typedef struct ritz_swept_lost {
    double displacement, velocity; /* in the norm of the mass */
    double strain;                 /* of the strain energy of displacements */
    bool all; /* a state is given, and the basis spans less than 1e-6 of it */
} ritz_swept_lost;

/**
 * Shares of an initial state that the basis does not span: d'd / x0'x0 with
 * d = x0 - S S'x0, S = start.
 *
 * @param[in] x0, v0  of all modes at the start; NULL: zero
 */
ritz_status ritz_swept_lost_state(const ritz_swept_model *model,
                                  const double *x0, const double *v0,
                                  ritz_swept_lost *out);

/**
 * The share of the strain energy of an input's static response that the basis
 * does not span.
 *
 * @param[out] out  NaN if the input excites rigid motions, or no elastic mode
 */
ritz_status ritz_swept_lost_force(const ritz_swept_model *model, int64_t input,
                                  double *out);

/**
 * Simulate while the setting follows a path, by the trapezoidal rule with the
 * matrices at the end of each step.
 *
 * Diagnostics are the setting, the work of the actuator, and the part of the
 * kinetic energy that is due to rates of T, which a program without these terms
 * does not include. The work of the run includes that of the actuator.
 *
 * @param[in] terms  false: leave out the rates of T, as a program does that
 *                   only exchanges matrices
 * @param[in] request  its integrator must be the trapezoidal one; x0 and v0 are
 *                     of all modes at the start. If coordinates are requested,
 *                     they are those of all bodies, u or V u
 * @return RITZ_ERR_ARGUMENT if the path leaves the range of the model, if a
 *         hinge turns by more than a quarter turn in a step, if the path
 *         ends before the run while the setting still moves, or if the basis
 *         spans less than 1e-6 of the initial state
 * @cost   O(r^3) a step, and O(Q^2 r) each time x passes a knot
 */
ritz_status ritz_simulate_swept(const ritz_swept_model *model,
                                const ritz_path *path, bool terms,
                                const ritz_simulation_request *request,
                                ritz_simulation *out);

#pragma GCC visibility pop

#endif
