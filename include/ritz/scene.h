/*
 * A scene: which components, joints, configurations, inputs, outputs, band and
 * tolerance are wanted. Read from YAML through libyaml's document interface, so
 * that every refusal names file, line and column. docs/scene.md has every key.
 */
#ifndef RITZ_SCENE_H
#define RITZ_SCENE_H

#include <ritz/choice.h>
#include <ritz/damping.h>
#include <ritz/dofs.h>
#include <ritz/text.h>

typedef struct ritz_scene_component {
    char name[RITZ_NAME_SIZE];
    char *model; /* path, relative ones taken from the scene's folder */
    char basis[RITZ_NAME_SIZE]; /* a method; "" with a reduced model */
    int64_t modes;              /* -1: none given */
    double up_to_hz;            /* 0: none given */
    char *attach; /* ports with commas between; NULL: those of the scene */
    ritz_choice choice;   /* what the basis is told beside that */
    int64_t line, column; /* where it stands, for later refusals */
} ritz_scene_component;

/* "rotor/bearing": a component of the scene and a port of it, by name. */
typedef struct ritz_scene_place {
    int64_t component; /* index in the scene */
    char port[RITZ_NAME_SIZE];
} ritz_scene_place;

typedef enum ritz_joint_type {
    RITZ_JOINT_FIXED,
    RITZ_JOINT_HINGE,
} ritz_joint_type;

typedef struct ritz_joint {
    char name[RITZ_NAME_SIZE];
    ritz_joint_type type;
    ritz_scene_place between[2];
    double axis[3]; /* unit, basic frame of the first body; hinge only */
    int64_t num_settings;
    double *setting;  /* hinge: at least one, [0] if the scene gives none */
    double tolerance; /* of positions of paired grids, absolute; 0: default */
    int64_t line, column;
} ritz_joint;

typedef struct ritz_scene_io {
    char name[RITZ_NAME_SIZE];
    ritz_scene_place at;
    int64_t component; /* 1-6, about or along the component's basic axes */
    int64_t grid;      /* of the port; 0: its only one */
    int64_t
        derivative; /* outputs: 0 displacement, 1 velocity, 2 acceleration */
    double scale;   /* inputs: factor, 1 */
    double limit;   /* outputs: NaN if none */
    int64_t line, column;
} ritz_scene_io;

typedef enum ritz_augment {
    RITZ_AUGMENT_NONE,
    RITZ_AUGMENT_SYSTEM,
} ritz_augment;

typedef struct ritz_scene {
    char *path; /* of the file, for messages */
    char name[RITZ_NAME_SIZE];
    int64_t num_components;
    ritz_scene_component *component;
    int64_t num_joints;
    ritz_joint *joint;
    int64_t num_sweeps; /* setting k of a configuration is of joint sweep[k] */
    int64_t *sweep;
    int64_t num_configurations; /* every combination if the scene lists none */
    double *setting; /* num_configurations x num_sweeps, row by row */
    int64_t num_inputs;
    ritz_scene_io *input;
    int64_t num_outputs;
    ritz_scene_io *output;
    double band_hz[2]; /* [0, 0] if none */
    ritz_damping damping;
    char select_by[RITZ_NAME_SIZE]; /* ranking; "hankel" */
    double select_tolerance;        /* 1e-3 */
    double composite_tolerance;     /* of dependent columns, 1e-12 */
    int64_t num_reference; /* composite from these configurations only; */
    int64_t *reference;    /* 0: union over all */
    ritz_augment augment;
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
 * Rows of angles for "clock=60,cone=0" (--at): hinges not named take their
 * only angle. Angles need not be in the scene's lists.
 *
 * @param[out] setting  num_sweeps
 * @return RITZ_ERR_ARGUMENT
 */
ritz_status ritz_scene_angles(const ritz_scene *scene, const char *at,
                              double *setting);

/**
 * Put "scene.yaml:12:9: input 'torque': " before the sentence of a failure that
 * showed only once models were loaded; return @p status.
 *
 * @param[in] kind,name  "input" and "torque"
 */
ritz_status ritz_scene_context(const ritz_scene *scene, ritz_status status,
                               int64_t line, int64_t column, const char *kind,
                               const char *name);

void ritz_scene_free(ritz_scene *scene);

#endif
