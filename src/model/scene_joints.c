/* Joints of a scene: fixed ones, and hinges with an axis and angles. */
#include "model/scene_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char types[][16] = {
    [RITZ_JOINT_FIXED] = "fixed",
    [RITZ_JOINT_HINGE] = "hinge",
};

static ritz_status take_type(const ritz_yaml *yaml, const yaml_node_t *node,
                             void *field)
{
    ritz_status status = RITZ_OK;
    ritz_names names = {"joint type", sizeof types / sizeof *types, types[0],
                        sizeof *types};
    int64_t at = 0;

    RITZ_TRY(ritz_yaml_word(yaml, node, &names, &at));
    *(ritz_joint_type *)field = (ritz_joint_type)at;
done:
    return status;
}

/* Hinges are named in "clock=60,cone=0". */
static ritz_status take_name(const ritz_yaml *yaml, const yaml_node_t *node,
                             void *field)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_yaml_name(yaml, node, field));
    RITZ_REFUSE_IF(strpbrk((const char *)field, ",="), yaml, node,
                   "'%s' holds ',' or '=', the name of a joint cannot",
                   (const char *)field);
done:
    return status;
}

/* axis / |axis|, scaled first so that no square leaves the range. */
static ritz_status take_axis(const ritz_yaml *yaml, const yaml_node_t *node,
                             void *field)
{
    ritz_status status = RITZ_OK;
    double *axis = (double *)field;
    double largest = 0.0;
    double length = 0.0;

    RITZ_TRY(ritz_yaml_reals(yaml, node, 3, axis));
    for (int i = 0; i < 3; i++)
        largest = fmax(largest, fabs(axis[i]));
    RITZ_REFUSE_IF(largest == 0.0, yaml, node, "the axis has no length");
    for (int i = 0; i < 3; i++)
        axis[i] /= largest;
    length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (int i = 0; i < 3; i++)
        axis[i] /= length;
done:
    return status;
}

enum { NAME, BETWEEN, TYPE, AXIS, ANGLES, TOLERANCE, NUM_KEYS };

static const ritz_yaml_key keys[NUM_KEYS] = {
    [NAME] = {"name", true, take_name, offsetof(ritz_joint, name)},
    [BETWEEN] = {"between", true, NULL, 0},
    [TYPE] = {"type", true, take_type, offsetof(ritz_joint, type)},
    [AXIS] = {"axis", false, take_axis, offsetof(ritz_joint, axis)},
    [ANGLES] = {"angles_deg", false, NULL, 0},
    [TOLERANCE] = {"tolerance", false, ritz_yaml_positive,
                   offsetof(ritz_joint, tolerance)},
};

static ritz_status read_between(const ritz_yaml *yaml, const yaml_node_t *node,
                                const ritz_scene *scene,
                                ritz_scene_place between[2])
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;
    int64_t both = 0;

    RITZ_TRY(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_IF(count != 2, yaml, node,
                   "a joint is between 2 ports, not %" PRId64, count);
    for (int k = 0; k < 2; k++)
        RITZ_TRY(ritz_scene_place_read(yaml, ritz_yaml_item(yaml, node, k),
                                       scene, &between[k]));
    both = between[0].component;
    RITZ_REFUSE_IF(both == between[1].component, yaml, node,
                   "component '%s' is joined to itself",
                   scene->component[both].name);
done:
    return status;
}

/* Without a list there is angle 0 alone. */
static ritz_status read_angles(const ritz_yaml *yaml, const yaml_node_t *node,
                               ritz_joint *joint)
{
    ritz_status status = RITZ_OK;
    int64_t count = 1;
    int64_t again = -1;

    if (node)
        RITZ_TRY(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_IF(count == 0 || count > RITZ_MOST_CONFIGURATIONS, yaml, node,
                   "a hinge has 1 to %d angles, not %" PRId64,
                   RITZ_MOST_CONFIGURATIONS, count);
    RITZ_NEW(joint->setting, count);
    joint->num_settings = count;
    if (node)
        RITZ_TRY(ritz_yaml_reals(yaml, node, count, joint->setting));
    RITZ_TRY(ritz_rows_repeated(count, 1, joint->setting, &again));
    RITZ_REFUSE_IF(again >= 0, yaml, ritz_yaml_item(yaml, node, again),
                   "angle %g is listed twice", joint->setting[again]);
done:
    return status;
}

/* Which keys a type of joint has; one that it ignored would mislead. */
static ritz_status check_keys(const ritz_yaml *yaml, const yaml_node_t *node,
                              const ritz_joint *joint,
                              const yaml_node_t *const *value)
{
    static const int others[][2] = {
        [RITZ_JOINT_FIXED] = {AXIS, ANGLES},
        [RITZ_JOINT_HINGE] = {TOLERANCE, TOLERANCE},
    };
    ritz_status status = RITZ_OK;

    for (int k = 0; k < 2; k++) {
        int other = others[joint->type][k];

        RITZ_REFUSE_IF(value[other], yaml, value[other],
                       "'%s' does not belong to a %s joint", keys[other].name,
                       types[joint->type]);
    }
    RITZ_REFUSE_IF(joint->type == RITZ_JOINT_HINGE && !value[AXIS], yaml, node,
                   "hinge '%s' has no axis", joint->name);
done:
    return status;
}

static ritz_status read_joint(const ritz_yaml *yaml, const yaml_node_t *node,
                              const ritz_scene *scene, ritz_joint *joint)
{
    ritz_status status = RITZ_OK;
    const yaml_node_t *value[NUM_KEYS];

    joint->line = (int64_t)node->start_mark.line + 1;
    joint->column = (int64_t)node->start_mark.column + 1;
    RITZ_TRY(ritz_yaml_mapping(yaml, node, NUM_KEYS, keys, joint, value));
    RITZ_TRY(read_between(yaml, value[BETWEEN], scene, joint->between));
    RITZ_TRY(check_keys(yaml, node, joint, value));
    if (joint->type == RITZ_JOINT_HINGE)
        RITZ_TRY(read_angles(yaml, value[ANGLES], joint));
done:
    return status;
}

/* hinge[k] of all joints that are hinges, in the order of the scene. */
static ritz_status find_hinges(const ritz_yaml *yaml, const yaml_node_t *node,
                               ritz_scene *scene)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(scene->sweep, scene->num_joints);
    for (int64_t k = 0; k < scene->num_joints; k++)
        if (scene->joint[k].type == RITZ_JOINT_HINGE)
            scene->sweep[scene->num_sweeps++] = k;
    RITZ_REFUSE_IF(scene->num_sweeps > RITZ_MOST_SWEEPS, yaml, node,
                   "%" PRId64 " hinges are too many, %d can be",
                   scene->num_sweeps, RITZ_MOST_SWEEPS);
done:
    return status;
}

ritz_status ritz_scene_joints(const ritz_yaml *yaml, const yaml_node_t *node,
                              ritz_scene *scene)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;

    if (node)
        RITZ_TRY(ritz_scene_count(yaml, node, &count));
    RITZ_NEW(scene->joint, count);
    scene->num_joints = count;
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);
        ritz_joint *joint = &scene->joint[k];
        ritz_names before = {"joint", k, scene->joint->name, sizeof *joint};

        RITZ_TRY(read_joint(yaml, item, scene, joint));
        RITZ_REFUSE_IF(ritz_names_index(&before, joint->name) >= 0, yaml, item,
                       "joint '%s' is given twice", joint->name);
    }
    RITZ_TRY(find_hinges(yaml, node, scene));
done:
    return status;
}
