/*
 * A scene: which components, joints, configurations, inputs, outputs, band and
 * tolerance are wanted. Read from YAML through libyaml's document interface, so
 * that every refusal names file, line and column. docs/scene.md has every key.
 */
#ifndef RITZ_SCENE_H
#define RITZ_SCENE_H

#include <ritz/basis.h>
#include <ritz/container.h>
#include <ritz/model.h>
#include <ritz/spin.h>

#pragma GCC visibility push(default)

/* Geometric stiffness of a component that spins: names of its loads. */
typedef enum ritz_stiffening {
    RITZ_STIFFENING_XX, /* for w_x^2 in the component's basic frame, ... */
    RITZ_STIFFENING_YY,
    RITZ_STIFFENING_ZZ,
    RITZ_STIFFENING_XY, /* for w_x w_y, ... */
    RITZ_STIFFENING_YZ,
    RITZ_STIFFENING_XZ,
    RITZ_STIFFENING_TIP, /* for a unit of tension by outboard bodies */
    RITZ_NUM_STIFFENINGS,
} ritz_stiffening;

/* "spin_zz", "tip". */
extern const char ritz_stiffening_word[RITZ_NUM_STIFFENINGS][16];

typedef struct ritz_scene_component {
    char name[RITZ_NAME_SIZE];
    char *model; /* path, relative ones taken from the scene's folder */
    char basis[RITZ_NAME_SIZE]; /* a method; "" with a reduced model */
    int64_t order;   /* of a nested reduced model its first columns; 0: all */
    int64_t modes;   /* -1: none given */
    double up_to_hz; /* 0: none given */
    char *attach;    /* ports with commas between; NULL: those of the scene */
    ritz_choice choice; /* further options of the basis */
    char stiffening[RITZ_NUM_STIFFENINGS][RITZ_NAME_SIZE]; /* "": none */
    int64_t line, column; /* where it stands, for later refusals */
} ritz_scene_component;

/* "rotor/bearing": a component of the scene and a port of it, by name. */
typedef struct ritz_scene_place {
    int64_t component; /* index in the scene */
    char port[RITZ_NAME_SIZE];
} ritz_scene_place;

/* The plane in which all bodies of a scene lie and move. */
typedef enum ritz_plane {
    RITZ_PLANE_NONE, /* no plane: motion in space */
    RITZ_PLANE_YZ,
    RITZ_PLANE_XZ,
    RITZ_PLANE_XY,
} ritz_plane;

/*
 * Joints between two ports. All types but fixed ones hold one grid on each
 * side. In space that grid needs six dofs; in a plane it needs those that the
 * joint constrains there. src/assembly/joints.c has the equations.
 */
typedef enum ritz_joint_type {
    RITZ_JOINT_FIXED,     /* grids in pairs */
    RITZ_JOINT_HINGE,     /* turns about one axis */
    RITZ_JOINT_SLIDER,    /* slides along one axis */
    RITZ_JOINT_UNIVERSAL, /* turns about two axes, one of each body */
    RITZ_JOINT_SPHERICAL, /* turns about every axis */
    RITZ_JOINT_BUSHING,   /* six springs and no constraint */
    RITZ_JOINT_RIGID,     /* moves as one, at an offset */
} ritz_joint_type;

typedef enum ritz_freedom_state {
    RITZ_FREE,
    RITZ_LOCKED, /* where the setting puts it */
    RITZ_CAGED,  /* on a spring and a damper, unstressed at the setting */
} ritz_freedom_state;

/* A relative motion of the second body that the type of a joint leaves. */
typedef struct ritz_freedom {
    ritz_freedom_state state;
    double stiffness, damping; /* caged; force or moment per length or radian */
} ritz_freedom;

enum { RITZ_MOST_FREEDOMS = 6 };

typedef struct ritz_joint {
    char name[RITZ_NAME_SIZE];
    ritz_joint_type type;
    ritz_plane plane; /* the scene's */
    ritz_scene_place between[2];
    /* unit, basic axes of the first body; [1] of a universal joint: of the
       second. A bushing's first axis and one in its first plane */
    double axis[2][3];
    double offset[3]; /* rigid: second origin from the first, basic axes of the
                         first body */
    int64_t num_freedoms;
    ritz_freedom freedom[RITZ_MOST_FREEDOMS]; /* about first then second axis;
                        bushing: along its axes, then about them */
    int64_t num_sweeps, sweep; /* sweep, sweep + 1, ... of the scene are its */
    double tolerance; /* of positions of paired grids, absolute; 0: default */
    int64_t line, column;
} ritz_joint;

/* What a joint is set to: degrees of rotation, or a position along an axis. */
typedef struct ritz_sweep {
    char name[RITZ_NAME_SIZE]; /* the joint's; "wrist.2" for a second axis */
    int64_t joint;
    bool turns;      /* degrees, not lengths */
    int64_t count;   /* at least one, [0] if the scene gives none */
    double *setting; /* count */
} ritz_sweep;

typedef struct ritz_scene_io {
    char name[RITZ_NAME_SIZE];
    ritz_scene_place at;
    int64_t component; /* 1-6, about or along the component's basic axes */
    int64_t num_also, also[5]; /* inputs: further directions, at once */
    ritz_scene_place against; /* inputs: where it acts reversed; port "" none */
    int64_t grid;             /* of the port; 0: its only one */
    int64_t
        derivative; /* outputs: 0 displacement, 1 velocity, 2 acceleration */
    double scale;   /* inputs: factor, 1 */
    double limit;   /* outputs: NaN if none */
    int64_t line, column;
} ritz_scene_io;

/* Which system modes the second stage is made from. */
typedef enum ritz_selection {
    RITZ_SELECT_RANKED, /* by select_by; by band where nothing can be ranked */
    RITZ_SELECT_BAND,   /* every flexible mode in band_hz */
    RITZ_SELECT_LISTED, /* select_mode, the same at each configuration */
    RITZ_SELECT_KRYLOV, /* none: Krylov vectors in their place */
} ritz_selection;

/* At which level static corrections are made. */
typedef enum ritz_augment {
    RITZ_AUGMENT_NONE,
    RITZ_AUGMENT_SYSTEM,
    RITZ_AUGMENT_COMPONENT,
} ritz_augment;

/* The forces for which static corrections are made; 0: as the level implies. */
enum {
    RITZ_ATTACHED_INPUTS = 1,
    RITZ_ATTACHED_INTERFACE = 2, /* each dof of the ports that joints hold */
    RITZ_ATTACHED_OUTPUTS = 4,   /* a unit force where each output measures */
    RITZ_ATTACHED_DAMPERS = 8,   /* along each damper, of bodies and joints */
    RITZ_ATTACHED_AUTO = 16,     /* the smallest set that is accurate enough;
                                    chosen from the sets that are named as well,
                                    or from all */
};

/* A single force that a scene attaches by name: that of an input or an output,
   or unit forces at a place: "PORT", "PORT:DIRECTION" or "GRID:DIRECTION" of a
   component. */
typedef struct ritz_scene_force {
    int64_t input, output; /* index; -1: it is no input, or no output */
    ritz_scene_place at;
    int64_t line, column;
} ritz_scene_force;

/* What becomes of modes of the second system that stand for no kept one. */
typedef enum ritz_extraneous {
    RITZ_EXTRANEOUS_KEEP,
    RITZ_EXTRANEOUS_REMOVE,
    RITZ_EXTRANEOUS_OUT_OF_BAND, /* removed outside band_hz alone */
    RITZ_EXTRANEOUS_COMPACT,     /* bodies lose the vectors that make such
                                    modes */
} ritz_extraneous;

/* How the whole scene turns, in the basic frame of its first body. */
typedef struct ritz_scene_spin {
    bool given;
    double axis[3];    /* unit */
    double through[3]; /* a point of the axis */
    ritz_spin_rate rate;
    double negligible; /* relative change of a frequency; 1e-3 */
    ritz_spin_model model;
    int64_t line, column;
} ritz_scene_spin;

typedef struct ritz_scene {
    char *path; /* of the file, for messages */
    char name[RITZ_NAME_SIZE];
    ritz_plane plane;
    int64_t num_components;
    ritz_scene_component *component;
    int64_t num_joints;
    ritz_joint *joint;
    int64_t num_sweeps; /* setting k of a configuration is one of sweep[k] */
    ritz_sweep *sweep;
    int64_t num_configurations; /* every combination if the scene lists none */
    double *setting; /* num_configurations x num_sweeps, row by row */
    int64_t num_inputs;
    ritz_scene_io *input;
    int64_t num_outputs;
    ritz_scene_io *output;
    double band_hz[2]; /* [0, 0] if none */
    ritz_damping damping;
    ritz_scene_spin spin;
    ritz_selection select;
    char select_by[RITZ_NAME_SIZE]; /* ranking; "hankel" */
    double select_tolerance;        /* 1e-3 */
    int64_t num_select_modes;       /* listed: flexible modes, from 0 */
    int64_t *select_mode;           /* ascending */
    int64_t select_vectors;         /* krylov: vectors at a configuration */
    bool select_outputs;            /* krylov: outputs start the block too */
    double composite_tolerance;     /* of dependent columns, 1e-12 */
    int64_t num_reference; /* composite from these configurations only; */
    int64_t *reference;    /* 0: union over all */
    ritz_augment augment;
    int attached; /* sum of RITZ_ATTACHED_...; 0: as the level implies */
    int64_t num_attached_forces; /* forces named one by one, in addition to
                                    `attached` */
    ritz_scene_force *attached_force;
    double attached_tolerance; /* auto: largest relative error of the largest
                                  singular value and of the smallest one that is
                                  not zero; 1e-3 */
    ritz_extraneous extraneous;
    double extraneous_tolerance; /* compact: increase of the relative errors
                                    that is allowed; 1e-3 */
    const ritz_source *source;   /* from which models are loaded; containers
                                    unless replaced after reading */
} ritz_scene;

/**
 * Read and check a scene. Unknown and repeated keys, wrong types, numbers that
 * are not finite, missing components, bad angles are refused as
 * "scene.yaml:12:9: unknown key 'modez', is 'modes' meant?". Bases, rankings
 * and ports are words here, looked up by who uses them.
 *
 * @return RITZ_ERR_FILE, RITZ_ERR_FORMAT
 */
ritz_status ritz_scene_read(const char *path, ritz_scene *out);

/** The same from text; relative models are left as they are; @p path is used
 * in messages alone. */
ritz_status ritz_scene_parse(const char *path, const char *text,
                             ritz_scene *out);

/**
 * Index of a sweep by its name, "clock" or "wrist.2".
 *
 * @return RITZ_ERR_ARGUMENT if no sweep has that name, or the joint has no
 *         setting
 */
ritz_status ritz_scene_sweep(const ritz_scene *scene, const char *name,
                             int64_t *out);

/**
 * Row of settings for "clock=60,slide=0.5" (--at): sweeps not named take their
 * only setting. Settings need not be in the scene's lists.
 *
 * @param[out] setting  num_sweeps
 * @return RITZ_ERR_ARGUMENT
 */
ritz_status ritz_scene_settings(const ritz_scene *scene, const char *at,
                                double *setting);

/**
 * What becomes of extraneous modes: "keep", "remove", "out-of-band" or
 * "compact".
 *
 * @return RITZ_ERR_ARGUMENT if it is none of them, or there is no band
 */
ritz_status ritz_scene_set_extraneous(ritz_scene *scene, const char *word);

/**
 * Put "scene.yaml:12:9: input 'torque': " before the sentence of a failure that
 * showed only once models were loaded; return @p status.
 *
 * @param[in] kind,name  "input" and "torque"
 */
ritz_status ritz_scene_context(const ritz_scene *scene, ritz_status status,
                               int64_t line, int64_t column, const char *kind,
                               const char *name);

/** "consistent", "inconsistent" or "ruthless". */
const char *ritz_spin_model_name(ritz_spin_model model);

void ritz_scene_free(ritz_scene *scene);

#pragma GCC visibility pop

#endif
