/* How a joint of a scene is read: what keys it has, what its type takes. */
#ifndef RITZ_SCENE_JOINT_PARTS_H
#define RITZ_SCENE_JOINT_PARTS_H

#include "scene/scene_parts.h"

/* Keys of a joint. */
enum {
    RITZ_JOINT_KEY_NAME,
    RITZ_JOINT_KEY_BETWEEN,
    RITZ_JOINT_KEY_TYPE,
    RITZ_JOINT_KEY_AXIS,
    RITZ_JOINT_KEY_AXES,
    RITZ_JOINT_KEY_ANGLES,
    RITZ_JOINT_KEY_ANGLES2,
    RITZ_JOINT_KEY_POSITIONS,
    RITZ_JOINT_KEY_STATE,
    RITZ_JOINT_KEY_STIFFNESS,
    RITZ_JOINT_KEY_DAMPING,
    RITZ_JOINT_KEY_OFFSET,
    RITZ_JOINT_KEY_TOLERANCE,
    RITZ_NUM_JOINT_KEYS
};

extern const ritz_yaml_key ritz_joint_keys[RITZ_NUM_JOINT_KEYS];

/* What a type of joint takes. */
typedef struct ritz_joint_kind {
    char name[16];      /* as scenes write it */
    const char *called; /* in sentences */
    unsigned keys;      /* bits 1 << RITZ_JOINT_KEY_..., beside the first 3 */
    unsigned required;  /* of those */
    int64_t freedoms;   /* relative motions that it leaves */
    int64_t sweeps;     /* of them are set in a configuration */
    int sweep_key[2];
    bool one, many; /* whether a number, a list states a stiffness */
} ritz_joint_kind;

const ritz_joint_kind *ritz_joint_kind_of(ritz_joint_type type);

/**
 * States, stiffnesses and dampings of a joint's freedoms, whose values are
 * @p value by key, NULL where absent.
 */
ritz_status ritz_joint_read_freedoms(const ritz_yaml *yaml,
                                     const yaml_node_t *node,
                                     const yaml_node_t *const *value,
                                     ritz_joint *joint);

/* Fields: double[3], of length 1; double[2][3], of length 1, not parallel. */
ritz_yaml_take ritz_joint_take_axis;
ritz_yaml_take ritz_joint_take_axes;
ritz_yaml_take ritz_joint_take_offset; /* double[3] */

#endif
