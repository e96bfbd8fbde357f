/*
 * Motions of a system while one of its joints is turned, or slid, through a
 * range: the model changes with the setting a of that joint. See
 * docs/methods/swept.md for the equations.
 *
 * With the coordinates u of all bodies side by side, u = T(a(t)) q, where T
 * spans motions that the joints allow at a: its columns are lowest modes of the
 * system there, made continuous over a. What a program that only exchanges
 * matrices leaves out are the rates of T.
 */
#ifndef RITZ_SWEPT_H
#define RITZ_SWEPT_H

#include <ritz/assembly.h>
#include <ritz/simulate.h>

#pragma GCC visibility push(default)

/* How a setting changes over time, in degrees or lengths. */
typedef enum ritz_path_kind {
    RITZ_PATH_LINEAR, /* at one rate, to its end */
    RITZ_PATH_SMOOTH, /* with 10 s^3 - 15 s^4 + 6 s^5, then constant */
    RITZ_PATH_TABLE,  /* a cubic spline at rest at both ends, then constant */
} ritz_path_kind;

typedef struct ritz_path {
    ritz_path_kind kind;
    double from, to, seconds;
    int64_t count;               /* of a table */
    double *time, *value, *bend; /* count: times ascending, settings, and the
                                     second rates of the spline */
} ritz_path;

/**
 * "0:60:30s", at one rate from 0 to 60 in 30 s; "0:60:30s:smooth"; or a file of
 * times and settings, two columns.
 *
 * @return RITZ_ERR_ARGUMENT if it is none of them or does not move;
 *         RITZ_ERR_FILE, RITZ_ERR_FORMAT
 */
ritz_status ritz_path_parse(const char *text, ritz_path *out);

/** Setting, rate and second rate at a time >= 0. */
void ritz_path_at(const ritz_path *path, double t, double out[static 3]);

/** Least and largest setting. */
void ritz_path_range(const ritz_path *path, double out[static 2]);

void ritz_path_free(ritz_path *path);

/*
 * The model over a range of a setting. x = unit a is radians or a length. At
 * equally spaced x there are
 *
 *     F = [T; S T; D_r],   S the rows of joint springs, D_r that of ratios
 *
 * and between them cubic splines: errors of order 4 in T, 3 in T_x and 2 in
 * T_xx.
 */
typedef struct ritz_swept_model {
    char sweep[RITZ_NAME_SIZE]; /* "clock" */
    double unit;                /* x over the setting */
    int64_t order;              /* r */
    int64_t count;              /* of knots, at least 5 */
    double first, spacing;      /* of x */
    int64_t num_springs;
    double *stiffness, *damping; /* num_springs */
    bool has_ratios;             /* F has rows D_r */
    ritz_dense F, bend; /* knot by knot r columns; second derivatives */
    ritz_dense M, K, D; /* Q x Q, of all bodies; D {0}: none */
    ritz_dense G, H;    /* Q x Q, phi'M N phi and phi'N'M N phi, N phi = n x phi
                        of the bodies that turn with x; {0}: none turns */
    ritz_io io;         /* for Q */
    ritz_dense start;   /* e x r: q = start' x0 at the start, x0 of all modes */
    double start_hz[2]; /* lowest flexible frequency, and the highest, there */
    double error;       /* of the spline between knots, measured: see
                           ritz_stage_sweep */
} ritz_swept_model;

/* A model that is wanted. */
typedef struct ritz_sweep_request {
    int64_t sweep;               /* of the scene */
    const double *setting;       /* of all sweeps, at the start; borrowed */
    double range[2];             /* of that sweep */
    int64_t modes;               /* r; 0: by frequency */
    double up_to_hz;             /* modes up to here; 0, without modes: all */
    const ritz_damping *damping; /* NULL: none but the bodies' and joints' */
    const ritz_stage *origin; /* x0 is of this stage, which the bodies V_c were
                                    cut from; NULL: of the stage itself */
    const ritz_dense *V;      /* of each body of it; NULL with that */
} ritz_sweep_request;

/**
 * The model of a stage over a range of one of its sweeps. Angles are halved
 * until the spline, at the angles half way between its knots, differs from the
 * basis that is computed there by less than 1e-7: by column in the mass norm,
 * and in that of stiffness over the frequency of the last mode. T is aligned
 * from knot to knot by Procrustes' rotation in the mass of space.
 *
 * @return RITZ_ERR_ARGUMENT if a mode leaves or enters the band within the
 *         range, by name and setting; if the r modes are not continuous, as
 *         mode r changes places with mode r + 1; if constraints lose rank; if
 *         there is structural damping, a body with force columns, or one that
 *         turns and whose inertia is not known; or as ritz_stage_assemble
 * @cost   an assembly for each angle
 */
ritz_status ritz_stage_sweep(const ritz_stage *stage,
                             const ritz_sweep_request *asked,
                             ritz_swept_model *out);

void ritz_swept_model_free(ritz_swept_model *model);

/**
 * Simulate while the setting follows a path, by the trapezoidal rule with the
 * matrices at the end of each step.
 *
 * Of diagnostics there are the setting, the work of the actuator, and the
 * kinetic energy that the rates of T make, which a program without the terms
 * does not see. The work of the run includes that of the actuator.
 *
 * @param[in] terms  false: without the rates of T, as a naive program does
 * @param[in] request  its integrator must be the trapezoidal one; x0 and v0 are
 *                     of all modes at the start
 * @return RITZ_ERR_ARGUMENT if the path leaves the range of the model, or ends
 *         before the run although it does not come to rest
 * @cost   O(r^3) a step, and O(Q^2 r) each time x passes a knot
 */
ritz_status ritz_simulate_swept(const ritz_swept_model *model,
                                const ritz_path *path, bool terms,
                                const ritz_simulation_request *request,
                                ritz_simulation *out);

#pragma GCC visibility pop

#endif
