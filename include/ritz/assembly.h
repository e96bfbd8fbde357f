/*
 * Assembly: components joined at a configuration, C(alpha) q = 0.
 *
 * At settings 0 the basic axes of both bodies of a joint are parallel and their
 * port origins coincide; a positive angle turns the second body right-handed
 * about the axis, given in the basic frame of the first, and a positive
 * position moves it along the axis. A setting is degrees or a length.
 */
#ifndef RITZ_ASSEMBLY_H
#define RITZ_ASSEMBLY_H

#include <ritz/basis.h>
#include <ritz/constrained.h>
#include <ritz/model.h>
#include <ritz/ranking.h>
#include <ritz/scene.h>

#pragma GCC visibility push(default)

/* Some reduced components. */
typedef struct ritz_bodies {
    int64_t count;
    ritz_reduced *item;
} ritz_bodies;

/** @p count empty ones. */
ritz_status ritz_bodies_new(int64_t count, ritz_bodies *out);
void ritz_bodies_free(ritz_bodies *bodies);

/* A scene with its models loaded and reduced: the result of stage one. */
typedef struct ritz_stage {
    const ritz_scene *scene; /* borrowed */
    int64_t count;
    ritz_reduced *body;      /* one for each component of the scene */
    int64_t num_coordinates; /* Q, of all bodies side by side */
    int64_t *first;          /* of each body's coordinates among them */
    double *scale; /* Q, 1 / sqrt(M_jj), or 1 / sqrt(K_jj) if it has no mass */
    ritz_io io;    /* the scene's inputs and outputs, for Q */
    ritz_dampers
        dampers; /* "body/name", for Q; the bodies' D and K hold them */
} ritz_stage;

/**
 * Load the models of a scene and reduce each as it says. A model that is
 * reduced already is taken as it is, and then the scene names no basis.
 *
 * Attached are the ports that the scene names, or else those of every joint
 * and input.
 */
ritz_status ritz_stage_new(const ritz_scene *scene, ritz_stage *out);

/**
 * The model of component @p k of a scene, its ports checked: a full one, or one
 * that is reduced already; the other stays empty.
 */
ritz_status ritz_stage_load(const ritz_scene *scene, int64_t k,
                            ritz_component *full, ritz_reduced *reduced);

/**
 * Reduce that full model as @p item says, which may be the scene's own or
 * another: its basis, modes, up_to_hz, attach and choice are used.
 */
ritz_status ritz_stage_reduce(const ritz_scene *scene, int64_t k,
                              const ritz_scene_component *item,
                              const ritz_component *component,
                              ritz_reduced *out);

/**
 * A stage of bodies that are there already, in the order of the scene.
 *
 * @param[in,out] body  scene->num_components, moved into the stage: on success
 *                      left empty, on failure still the caller's; their
 *                      dampers are installed
 */
ritz_status ritz_stage_from(const ritz_scene *scene, ritz_reduced *body,
                            ritz_stage *out);

/**
 * Constraint rows C q = 0 of all that joints lock at some settings, c x Q.
 *
 * Columns are those of scaled coordinates, rows of one joint and kind
 * (translations, rotations) are divided by the largest norm among them, so that
 * singular values tell rank apart from rounding.
 *
 * @param[in] setting  one for each sweep of the scene
 * @param[in] scale    Q, as that of the stage; NULL: each is 1
 */
ritz_status ritz_stage_constraints(const ritz_stage *stage,
                                   const double *setting, const double *scale,
                                   ritz_dense *out);

/**
 * The system at some settings: null space P of the constraints, their rank by
 * singular values above 1e-9 of the largest, then its modes as coordinates.
 *
 * @cost O(Q^2 c + e^3)
 */
ritz_status ritz_stage_assemble(const ritz_stage *stage, const double *setting,
                                ritz_configuration *out);

/**
 * The bodies of a stage at some settings before they are joined, with their
 * constraints, for ritz_simulate_constrained().
 *
 * @param[in] joined   the system at these settings
 * @param[in] damping  stated for the system; NULL: none. Violations have none
 * @return RITZ_ERR_ARGUMENT if a body has force columns or structural damping
 */
ritz_status ritz_stage_unjoined(const ritz_stage *stage, const double *setting,
                                const ritz_configuration *joined,
                                const ritz_damping *damping,
                                ritz_unjoined *out);

/* An axis of a joint in a closed loop that differs slightly from a direction
   with which the loop can move. */
typedef struct ritz_near_axis {
    int64_t joint;   /* of the scene */
    int which;       /* 0; 1: the second axis of a universal joint */
    double angle;    /* between the axis and that direction, rad */
    bool taken;      /* that direction is used; false: the given axis is used,
                      and locks the motion */
    double exact[3]; /* that direction, in the axes that the scene uses */
    int64_t others;  /* further axes of its loops that differ */
} ritz_near_axis;

typedef struct ritz_near_axes {
    int64_t count, room;
    ritz_near_axis *item;
} ritz_near_axes;

/**
 * List axes in closed loops that a scene gives with too few digits, at one
 * setting of its joints. If the angle is at most 1e-4 rad, the axis is
 * corrected; if it is at most 1e-2 rad, the given axis is used and locks a
 * motion. Angles below 1e-9 are not listed.
 */
ritz_status ritz_stage_near_axes(const ritz_stage *stage, const double *setting,
                                 ritz_near_axes *out);
void ritz_near_axes_free(ritz_near_axes *axes);

/** As ritz_stage_near_axes, for a scene whose bodies are not reduced; its
 * models are read if joints close a loop. */
ritz_status ritz_scene_near_axes(const ritz_scene *scene, const double *setting,
                                 ritz_near_axes *out);

/**
 * Ranges of each body's coordinates in the coordinates of all bodies.
 *
 * @param[out] out  stage->count, freed by the caller
 */
ritz_status ritz_stage_blocks(const ritz_stage *stage, ritz_block **out);

/** The system at every configuration of the scene, or at @p at alone. A spin of
 * constant rate is in its K, D and inputs; of a rate that changes it is at
 * rest. */
ritz_status ritz_assemble(const ritz_stage *stage, const char *at,
                          ritz_system *out);

/** Additional input of a system with a constant spin: the value 1 is the
 * centrifugal load. */
#define RITZ_SPIN_INPUT "centrifugal"

/**
 * Spin terms of a scene, those that its spin model keeps, in the coordinates of
 * a system of the stage.
 *
 * @return RITZ_ERR_ARGUMENT if there is no spin, a body has no inertia
 *         invariants, a load is missing, or a stiffening is of another origin
 */
ritz_status ritz_stage_spin(const ritz_stage *stage,
                            const ritz_configuration *at, ritz_spin_terms *out);

/** The first product of rates for which body @p k of a spinning scene needs a
 * geometric stiffness and names none; RITZ_NUM_STIFFENINGS if none is
 * missing. */
ritz_status ritz_stage_missing_stiffening(const ritz_stage *stage,
                                          const ritz_configuration *at,
                                          int64_t k, int *out);

/**
 * Rates that limit the model of a scene that spins. `stable` is the rate at
 * which the stiffness of its spin model stops being definite; NaN if bodies are
 * free. `negligible` is the rate below which leaving out stiffening changes no
 * frequency up to the end of the band (of all modes if there is no band) by
 * more than @p error.
 *
 * A flexible body needs the stiffening `tip` if outboard bodies pull at it. If
 * it names none, the stiffness due to that pull is estimated; `negligible`
 * includes the estimate, but the model does not.
 *
 * @param[out] without_pull  a rate for each body, up to which leaving out that
 *                       estimate changes no frequency by more than @p error;
 *                       HUGE_VAL: there is no such pull, or `tip` has it;
 *                       NULL: not wanted
 * @return RITZ_ERR_ARGUMENT as ritz_stage_spin
 */
ritz_status ritz_stage_spin_limits(const ritz_stage *stage,
                                   const double *setting, double error,
                                   ritz_spin_limits *out, double *without_pull);

/** The first joint of a scene that closes a loop; -1: none does. Centrifugal
 * forces of outboard bodies are those without the joints that close loops. */
ritz_status ritz_stage_spin_loop(const ritz_stage *stage, int64_t *out);

/** Mass of all bodies that joints hold outboard of body @p k of a scene that
 * spins. */
ritz_status ritz_stage_spin_outboard(const ritz_stage *stage,
                                     const ritz_configuration *at, int64_t k,
                                     double *out);

/* Which dof of which body a dof of the full-order system is. */
typedef struct ritz_master {
    int64_t body, dof;
} ritz_master;

/**
 * The full-order system at some settings as one component: constraints
 * eliminated sparsely, dofs of all bodies side by side, in the basic frame of
 * the first body. Grids are renumbered where two bodies use one number: those
 * of body k, from 0, by k times the next power of ten.
 *
 * Whatever basis the scene names, the full model is taken.
 *
 * @param[out] where  out->num_dofs, the body and dof of each of its dofs,
 *                    ascending; the caller's to free; NULL: not wanted
 * @return RITZ_ERR_ARGUMENT if a model is reduced already
 */
ritz_status ritz_assemble_full(const ritz_scene *scene, const double *setting,
                               ritz_component *out, ritz_master **where);

/**
 * T of the system at a configuration, n x e, over the dofs of the full-order
 * system there: rows of T_c P_c of each body. With it the system's matrices are
 * those of the full one condensed, since ports move in both as T says.
 *
 * @return RITZ_ERR_ARGUMENT if a body has no T, or one of other dofs
 */
ritz_status ritz_stage_basis(const ritz_stage *stage,
                             const ritz_configuration *at, int64_t n,
                             const ritz_master *master, ritz_dense *out);

/* A component at one side of a joint, and what messages call it. */
typedef struct ritz_joined {
    const char *name;
    const ritz_component *component;
} ritz_joined;

/** A neighbour without mass and stiffness, for @p attached dofs. */
ritz_status ritz_neighbour_new(int64_t attached, ritz_neighbour *out);

/**
 * Add the neighbour at the other side of a joint to those of a component: its
 * mass and stiffness, condensed through the joint to the component's port.
 * A motion that the joint leaves free is not loaded.
 *
 * @param[in]     setting   of all sweeps of the scene; NULL if it has none
 * @param[in]     near      which side is the component that is loaded
 * @param[in]     attached  its dofs, those of the joint's port among them
 * @param[in,out] sum       attached x attached
 * @return RITZ_ERR_ARGUMENT if ports do not fit or are not attached,
 *         RITZ_ERR_SINGULAR if the other body moves while its port is held
 */
ritz_status ritz_joint_neighbour(const ritz_joint *joint, const double *setting,
                                 const ritz_joined side[static 2], int near,
                                 const ritz_dofs *attached,
                                 ritz_neighbour *sum);

void ritz_neighbour_free(ritz_neighbour *neighbour);

void ritz_stage_free(ritz_stage *stage);

/*
 * COMPARE: component modes projection and assembly model reduction over all
 * configurations of an articulated system [LeeTsuha1992], and its relatives:
 * P&A (no augmentation), EP&A and Krylov P&A [McDaniel2000, chapter 3].
 */

/* A flexible mode of the second system that represents no kept mode. */
typedef struct ritz_stray {
    int64_t mode; /* flexible mode of stage 2, as assembled */
    double hertz;
    int64_t like; /* flexible mode of stage 1 that it is most like; -1: none */
    double mac;   /* with it */
    bool removed; /* from the second system; the bodies still contain it */
} ritz_stray;

/* Errors of stage two at one configuration. */
typedef struct ritz_compare_row {
    double *setting; /* one for each sweep */
    bool listed;     /* false: between listed angles, for checking only */
    int64_t num_rigid, num_flexible; /* of the stage-1 system */
    int64_t num_kept; /* flexible modes that matter: listed, they are kept;
                               between, they would have been */
    int64_t *kept;    /* num_kept indices into the flexible modes, ascending */
    int64_t num_completed; /* of those, kept only as a cluster is never split */
    int64_t num_equal; /* modes kept only because their value equals the least
                          value above the threshold */
    double cut_hertz[2], cut_value[2]; /* a pair of which one mode is kept, [0],
                                          and the other is left out, [1]; 0:
                                          none */
    int64_t num_joined;     /* flexible modes that damping couples to others and
                              that are ranked with them as one cluster */
    int64_t num_vectors;    /* Krylov vectors kept instead of modes */
    int64_t order;          /* of the stage-2 system, strays removed */
    double frequency_error; /* worst relative, of those modes; NaN: no mode */
    double allowed;         /* what rounding allows it, c eps lambda_max /
                               lambda_k with c = 20 e; NaN between */
    double rigid_error;     /* largest |omega| of a rigid mode of stage 2, Hz */
    double gain_error;      /* relative, of the flexible static gain */
    double response_error;  /* relative to the largest |H|, in the band */
    double damping_error;   /* worst relative error of the damping ratios of
                               those modes; NaN: nothing damps them */
    double mac;             /* smallest, of those modes; NaN: no mode */
    int64_t num_moments;    /* Krylov: the first of them are kept, */
    double moment_error;    /* and this is the worst, relative; NaN: none */
    int64_t num_strays;
    ritz_stray *stray;
} ritz_compare_row;

enum { RITZ_ATTACHED_SIZE = 4096 };

/* Static corrections for one set of forces, and the errors with them. */
typedef struct ritz_candidate {
    ritz_augment level;
    int64_t num_forces;            /* number of attached forces */
    int64_t *force;                /* num_forces indices among all forces that
                                      can be attached, ascending */
    char name[RITZ_ATTACHED_SIZE]; /* "inputs, rotor/boom:3" */
    int64_t *order;                /* of each body */
    int64_t total;                 /* of all bodies */
    int64_t largest;               /* order of a system, at any configuration */
    double gain_listed, gain_between; /* worst relative errors of the static
                                         gain; NaN: none */
    /* [0] worst relative error of the largest singular value of H(i w), [1] of
       the smallest one that is not zero, over the band and all listed
       configurations; NaN where there is no response */
    double deviation[2];
    double hertz[2];            /* frequency of each worst error  [Hz] */
    char at[2][RITZ_NAME_SIZE]; /* and its configuration */
    bool chosen;
} ritz_candidate;

/* The larger of the two deviations; NaN where there is no response. */
double ritz_candidate_worst(const ritz_candidate *candidate);

/* The search for the fewest attached forces that are accurate enough. */
typedef struct ritz_attached_search {
    int64_t pool;  /* distinct forces to choose from; 0: no search */
    int64_t tried; /* sets of forces that were tried */
    int64_t below; /* every set of at most this many forces was tried, and none
                      meets the tolerance */
} ritz_attached_search;

/* The largest error between listed angles, and whether to add that angle:
 * if it is above 1e-3 and ten times the worst of its kind at listed ones. */
typedef struct ritz_suggestion {
    int64_t row; /* between listed angles, with the worst error; -1: none */
    const char *measure;  /* "response", "frequency", "gain" or "damping" */
    double error, listed; /* there, and worst at listed configurations */
    bool worth;           /* add it */
} ritz_suggestion;

typedef struct ritz_comparison {
    ritz_stage second;                       /* bodies after stage two */
    ritz_system first_system, second_system; /* listed configurations */
    int64_t num_rows;
    ritz_compare_row *row; /* listed ones first, then those between */
    int64_t num_bodies;
    int64_t composite;      /* vectors before dependent ones were removed */
    bool removed;           /* whether stage two removed anything at all */
    ritz_dense *V;          /* num_bodies, r_c x s_c */
    int64_t num_candidates; /* where components are augmented, or by choice */
    ritz_candidate *candidate;
    ritz_attached_search search;
    int64_t dropped;  /* vectors that were removed from bodies because they made
                         extraneous modes */
    double next_drop; /* increase of the relative errors if one more vector were
                         removed; NaN: none need be removed, or none can be */
    ritz_suggestion suggestion;
    bool interrupted;     /* stop->asked ended the work: both systems and `row`
                             have only the configurations that were done */
    int64_t num_composed; /* the bodies keep modes of so many configurations,
                             the first ones of the scene's list */
} ritz_comparison;

/** Both stages. @cost an eigenproblem of the stage-1 order a configuration */
ritz_status ritz_compare(const ritz_stage *stage, ritz_comparison *out);

/* asked() is called between configurations; if it returns true, the work ends
   with the configurations that are done. */
typedef struct ritz_stop {
    bool (*asked)(void *context);
    void *context;
} ritz_stop;

/**
 * Both stages, until @p stop ends them. If it ends stage one, the
 * configurations that are done are compared as if the scene listed no others.
 * If it ends the measurement of errors, the systems are without those
 * configurations whose errors are not measured. The first configuration is
 * always done.
 */
ritz_status ritz_compare_until(const ritz_stage *stage, const ritz_stop *stop,
                               ritz_comparison *out);

/* The second stage at one composite tolerance. */
typedef struct ritz_tolerance_row {
    double tolerance;
    int64_t *order;  /* of each body */
    int64_t total;   /* of all bodies */
    int64_t largest; /* order of a system, at any configuration */
    bool removed;    /* whether stage two removed anything */
    double frequency_error, gain_error, response_error,
        damping_error; /* worst over all listed configurations; NaN: none */
} ritz_tolerance_row;

/**
 * The effect of the composite tolerance: orders and largest errors at each of
 * @p count tolerances, everything else as the scene says.
 *
 * @param[out] out  count rows, to be freed by ritz_tolerances_free
 * @return RITZ_ERR_ARGUMENT if a tolerance is not between 0 and 1
 */
ritz_status ritz_compare_tolerances(const ritz_stage *stage,
                                    const ritz_comparison *comparison,
                                    int64_t count, const double *tolerance,
                                    ritz_tolerance_row **out);

/*
 * The composite set of each body with its directions in the order in which they
 * matter: any number of the first is a subspace for stage two.
 */
typedef struct ritz_composite {
    int64_t num_bodies;
    ritz_dense *V;     /* of each, r_c x s_c: rigid motions, then directions */
    int64_t *rigid;    /* of each, how many are rigid motions */
    int64_t num_steps; /* directions of all bodies */
    int64_t *step;     /* num_steps: the body whose next direction matters most
                          of those that are left */
} ritz_composite;

/**
 * Directions of the modes up to the band's end at all configurations, then of
 * static solutions for inputs and outputs, then of all that stage one has.
 *
 * Modes that are to be ranked (scene.select) weigh as much as their value in
 * the ranking, others weigh 1. Where the scene augments, static solutions
 * come with the modes, not after them. A body that does not move rigidly with
 * the system has its first direction before any other.
 *
 * A truncated set keeps no mode exactly; it is for searches that measure each.
 *
 * @return RITZ_ERR_ARGUMENT if there is no band or no configuration, or as
 *         ritz_compare
 * @cost   an eigenproblem of the stage-1 order a configuration, and of each
 *         body a singular value decomposition, r_c rows and a column for each
 *         mode and configuration
 */
ritz_status ritz_composite_new(const ritz_stage *stage, ritz_composite *out);
void ritz_composite_free(ritz_composite *composite);

void ritz_tolerances_free(int64_t count, ritz_tolerance_row **rows);
void ritz_comparison_free(ritz_comparison *comparison);

/* Modes followed from configuration to configuration by their shapes. */

typedef enum ritz_track_kind {
    RITZ_TRACK_SWAP,    /* two tracks change places in frequency */
    RITZ_TRACK_TIE,     /* a second mode has nearly the same MAC */
    RITZ_TRACK_AVOIDED, /* two modes turn into mixtures of each other */
    RITZ_TRACK_LOST,    /* no mode with MAC of 0.5 or more */
} ritz_track_kind;

/* An event between one configuration and the next. */
typedef struct ritz_track_event {
    ritz_track_kind kind;
    int64_t from, to; /* configurations */
    int64_t mode[2];  /* flexible modes of `from`; [1] -1: one is concerned */
    int64_t other[2]; /* what they become, or for a tie the two candidates; -1:
                         none */
    double mac[2];    /* of mode[0] with other[0], and of the second pair: swap
                         and avoided mode[1] with other[1], tie mode[0] with
                         other[1] */
    double shared;    /* avoided: of the two planes; else NaN */
    double hertz;     /* of mode[0] */
} ritz_track_event;

/*
 * Flexible modes only. Those of one cluster, relative gap below 1e-6, at any
 * configuration share one track: what is repeated is followed as one subspace.
 */
typedef struct ritz_tracking {
    int64_t num_configurations;
    int64_t *before;  /* the configuration that each is followed from; -1 */
    int64_t *first;   /* num_configurations + 1, where modes of each begin */
    int64_t *track;   /* of each mode, from 0, ascending as tracks first appear;
                         -1: a negative square of dual-craig-bampton, which is
                         no mode */
    int64_t *cluster; /* of each mode, the first mode of its cluster */
    double *hertz;
    double *mac; /* with its like in `before`; NaN where it has none */
    int64_t num_tracks;
    int64_t num_events, room; /* of events */
    ritz_track_event *event;
} ritz_tracking;

/**
 * Follow the flexible modes of a system over its configurations. Modes are
 * vectors of the coordinates of all bodies, each fixed in its own, so that
 *
 *     MAC_ij = (sum_c (P_c' M_c P'_c)_ij)^2 <= 1
 *
 * needs no rotation; between clusters it is the mean squared cosine of the
 * angles of their spaces. Each configuration is followed from the nearest of
 * the thousand listed before it: that which differs in the fewest sweeps, then
 * by least.
 *
 * @param[in] stage     whose coordinates the system's are
 * @param[in] up_to_hz  events above are passed over; 0: none is
 * @cost O(Q^2 e) a configuration
 */
ritz_status ritz_track(const ritz_stage *stage, const ritz_system *system,
                       double up_to_hz, ritz_tracking *out);

void ritz_tracking_free(ritz_tracking *tracking);

#pragma GCC visibility pop

#endif
