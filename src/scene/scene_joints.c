/* Joints of a scene: a table says what each type of them takes. */
#include "scene/joint_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { /* bits of keys */
       AXIS = 1 << RITZ_JOINT_KEY_AXIS,
       AXES = 1 << RITZ_JOINT_KEY_AXES,
       ANGLES = 1 << RITZ_JOINT_KEY_ANGLES,
       ANGLES2 = 1 << RITZ_JOINT_KEY_ANGLES2,
       POSITIONS = 1 << RITZ_JOINT_KEY_POSITIONS,
       STATE = 1 << RITZ_JOINT_KEY_STATE,
       STIFFNESS = 1 << RITZ_JOINT_KEY_STIFFNESS,
       DAMPING = 1 << RITZ_JOINT_KEY_DAMPING,
       OFFSET = 1 << RITZ_JOINT_KEY_OFFSET,
       TOLERANCE = 1 << RITZ_JOINT_KEY_TOLERANCE,
       CAGE = STATE | STIFFNESS | DAMPING,
};

static const ritz_joint_kind kinds[] = {
    [RITZ_JOINT_FIXED] =
        {
            .name = "fixed",
            .called = "fixed joint",
            .keys = TOLERANCE,
        },
    [RITZ_JOINT_HINGE] =
        {
            .name = "hinge",
            .called = "hinge",
            .keys = AXIS | ANGLES | CAGE,
            .required = AXIS,
            .freedoms = 1,
            .sweeps = 1,
            .sweep_key = {RITZ_JOINT_KEY_ANGLES},
            .one = true,
        },
    [RITZ_JOINT_SLIDER] =
        {
            .name = "slider",
            .called = "slider",
            .keys = AXIS | POSITIONS | CAGE,
            .required = AXIS,
            .freedoms = 1,
            .sweeps = 1,
            .sweep_key = {RITZ_JOINT_KEY_POSITIONS},
            .one = true,
        },
    [RITZ_JOINT_UNIVERSAL] =
        {
            .name = "universal",
            .called = "universal joint",
            .keys = AXES | ANGLES | ANGLES2 | CAGE,
            .required = AXES,
            .freedoms = 2,
            .sweeps = 2,
            .sweep_key = {RITZ_JOINT_KEY_ANGLES, RITZ_JOINT_KEY_ANGLES2},
            .one = true,
            .many = true,
        },
    [RITZ_JOINT_SPHERICAL] =
        {
            .name = "spherical",
            .called = "spherical joint",
            .keys = CAGE,
            .freedoms = 3,
            .one = true,
        },
    [RITZ_JOINT_BUSHING] =
        {
            .name = "bushing",
            .called = "bushing",
            .keys = AXES | STIFFNESS | DAMPING | TOLERANCE,
            .required = STIFFNESS,
            .freedoms = 6,
            .many = true,
        },
    [RITZ_JOINT_RIGID] =
        {
            .name = "rigid",
            .called = "rigid joint",
            .keys = OFFSET,
        },
};

const ritz_joint_kind *ritz_joint_kind_of(ritz_joint_type type)
{
    return &kinds[type];
}

static ritz_status take_type(const ritz_yaml *yaml, const yaml_node_t *node,
                             void *field)
{
    ritz_names names = {"joint type", sizeof kinds / sizeof *kinds,
                        kinds[0].name, sizeof *kinds};
    int64_t at = 0;

    RITZ_CHECK(ritz_yaml_word(yaml, node, &names, &at));
    *(ritz_joint_type *)field = (ritz_joint_type)at;
    return RITZ_OK;
}

/* Joints are named in "clock=60,slide=0.5". */
static ritz_status take_name(const ritz_yaml *yaml, const yaml_node_t *node,
                             void *field)
{
    RITZ_CHECK(ritz_yaml_name(yaml, node, field));
    RITZ_REFUSE_AT(strpbrk((const char *)field, ",="), yaml, node,
                   "'%s' holds ',' or '=', the name of a joint cannot",
                   (const char *)field);
    return RITZ_OK;
}

const ritz_yaml_key ritz_joint_keys[RITZ_NUM_JOINT_KEYS] = {
    [RITZ_JOINT_KEY_NAME] = {"name", true, take_name,
                             offsetof(ritz_joint, name)},
    [RITZ_JOINT_KEY_BETWEEN] = {"between", true, NULL, 0},
    [RITZ_JOINT_KEY_TYPE] = {"type", true, take_type,
                             offsetof(ritz_joint, type)},
    [RITZ_JOINT_KEY_AXIS] = {"axis", false, ritz_joint_take_axis,
                             offsetof(ritz_joint, axis)},
    [RITZ_JOINT_KEY_AXES] = {"axes", false, ritz_joint_take_axes,
                             offsetof(ritz_joint, axis)},
    [RITZ_JOINT_KEY_ANGLES] = {"angles_deg", false, NULL, 0},
    [RITZ_JOINT_KEY_ANGLES2] = {"angles2_deg", false, NULL, 0},
    [RITZ_JOINT_KEY_POSITIONS] = {"positions", false, NULL, 0},
    [RITZ_JOINT_KEY_STATE] = {"state", false, NULL, 0},
    [RITZ_JOINT_KEY_STIFFNESS] = {"stiffness", false, NULL, 0},
    [RITZ_JOINT_KEY_DAMPING] = {"damping", false, NULL, 0},
    [RITZ_JOINT_KEY_OFFSET] = {"offset", false, ritz_joint_take_offset,
                               offsetof(ritz_joint, offset)},
    [RITZ_JOINT_KEY_TOLERANCE] = {"tolerance", false, ritz_yaml_positive,
                                  offsetof(ritz_joint, tolerance)},
};

static ritz_status read_between(const ritz_yaml *yaml, const yaml_node_t *node,
                                const ritz_scene *scene,
                                ritz_scene_place between[2])
{
    int64_t count = 0;
    int64_t both = 0;

    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count != 2, yaml, node,
                   "a joint is between 2 ports, not %" PRId64, count);
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(ritz_scene_place_read(yaml, ritz_yaml_item(yaml, node, k),
                                         scene, &between[k]));
    both = between[0].component;
    RITZ_REFUSE_AT(both == between[1].component, yaml, node,
                   "component '%s' is joined to itself",
                   scene->component[both].name);
    return RITZ_OK;
}

/* The settings under one key; without a list there is 0 alone. */
static ritz_status read_settings(const ritz_yaml *yaml, const yaml_node_t *node,
                                 const char *called, ritz_sweep *sweep)
{
    const char *what = sweep->turns ? "angle" : "position";
    int64_t count = 1;
    int64_t again = -1;

    if (node)
        RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count == 0 || count > RITZ_MOST_CONFIGURATIONS, yaml, node,
                   "a %s has 1 to %d %ss, not %" PRId64, called,
                   RITZ_MOST_CONFIGURATIONS, what, count);
    RITZ_CHECK_NEW(sweep->setting, count);
    sweep->count = count;
    if (node)
        RITZ_CHECK(ritz_yaml_reals(yaml, node, count, sweep->setting));
    RITZ_CHECK(ritz_rows_repeated(count, 1, sweep->setting, &again));
    RITZ_REFUSE_AT(again >= 0, yaml, ritz_yaml_item(yaml, node, again),
                   "%s %g is listed twice", what, sweep->setting[again]);
    return RITZ_OK;
}

/* What a joint is set to is named after it: "wrist", "wrist.2". */
static ritz_status read_sweeps(const ritz_yaml *yaml, const yaml_node_t *node,
                               const yaml_node_t *const *value,
                               ritz_joint *joint, ritz_scene *scene)
{
    static const char *const endings[] = {"", ".2"};
    const ritz_joint_kind *kind = &kinds[joint->type];

    joint->sweep = scene->num_sweeps;
    RITZ_REFUSE_AT(kind->sweeps > 1 &&
                       strlen(joint->name) + strlen(".2") >= RITZ_NAME_SIZE,
                   yaml, node,
                   "'%s' is longer than %zu bytes, the name of a %s cannot "
                   "be, as '.2' is put behind it",
                   joint->name, RITZ_NAME_SIZE - sizeof ".2", kind->called);
    for (int64_t k = 0; k < kind->sweeps && k < 2; k++) {
        ritz_sweep *sweep = &scene->sweep[scene->num_sweeps++];

        joint->num_sweeps++;
        *sweep = (ritz_sweep){
            .joint = joint - scene->joint,
            .turns = kind->sweep_key[k] != RITZ_JOINT_KEY_POSITIONS,
        };
        memcpy(sweep->name, joint->name, sizeof sweep->name);
        memcpy(sweep->name + strlen(joint->name), endings[k],
               strlen(endings[k]) + 1);
        RITZ_CHECK(read_settings(yaml, value[kind->sweep_key[k]], kind->called,
                                 sweep));
    }
    return RITZ_OK;
}

/* Which keys a type of joint has; one that it ignored would mislead. */
static ritz_status check_keys(const ritz_yaml *yaml, const yaml_node_t *node,
                              const ritz_joint *joint,
                              const yaml_node_t *const *value)
{
    const ritz_joint_kind *kind = &kinds[joint->type];

    for (int k = RITZ_JOINT_KEY_TYPE + 1; k < RITZ_NUM_JOINT_KEYS; k++)
        RITZ_REFUSE_AT(value[k] && !(kind->keys >> k & 1), yaml, value[k],
                       "'%s' does not belong to a %s", ritz_joint_keys[k].name,
                       kind->called);
    for (int k = 0; k < RITZ_NUM_JOINT_KEYS; k++)
        RITZ_REFUSE_AT(!value[k] && (kind->required >> k & 1), yaml, node,
                       "%s '%s' has no %s", kind->called, joint->name,
                       ritz_joint_keys[k].name);
    return RITZ_OK;
}

static ritz_status read_joint(const ritz_yaml *yaml, const yaml_node_t *node,
                              ritz_scene *scene, ritz_joint *joint)
{
    const yaml_node_t *value[RITZ_NUM_JOINT_KEYS];

    joint->line = (int64_t)node->start_mark.line + 1;
    joint->column = (int64_t)node->start_mark.column + 1;
    joint->axis[0][0] = joint->axis[1][1] = 1.0;
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, RITZ_NUM_JOINT_KEYS,
                                 ritz_joint_keys, joint, value));
    RITZ_CHECK(read_between(yaml, value[RITZ_JOINT_KEY_BETWEEN], scene,
                            joint->between));
    RITZ_CHECK(check_keys(yaml, node, joint, value));
    joint->num_freedoms = kinds[joint->type].freedoms;
    RITZ_CHECK(ritz_joint_read_freedoms(yaml, node, value, joint));
    return read_sweeps(yaml, node, value, joint, scene);
}

/* No joint is called what a second axis of another is; not too many sweeps. */
static ritz_status check_sweeps(const ritz_yaml *yaml, const yaml_node_t *node,
                                const ritz_scene *scene)
{
    const ritz_names joints = {"joint", scene->num_joints,
                               (const char *)scene->joint,
                               sizeof *scene->joint};

    RITZ_REFUSE_AT(scene->num_sweeps > RITZ_MOST_SWEEPS, yaml, node,
                   "%" PRId64 " settings of joints are too many, %d can be",
                   scene->num_sweeps, RITZ_MOST_SWEEPS);
    for (int64_t k = 0; k < scene->num_sweeps; k++) {
        const ritz_sweep *sweep = &scene->sweep[k];
        int64_t at = ritz_names_index(&joints, sweep->name);

        RITZ_REFUSE_AT(at >= 0 && at != sweep->joint, yaml,
                       ritz_yaml_item(yaml, node, at),
                       "joint '%s' has the name of the second axis of '%s'",
                       sweep->name, scene->joint[sweep->joint].name);
    }
    return RITZ_OK;
}

ritz_status ritz_scene_joints(const ritz_yaml *yaml, const yaml_node_t *node,
                              ritz_scene *scene)
{
    int64_t count = 0;

    if (node)
        RITZ_CHECK(ritz_scene_count(yaml, node, &count));
    RITZ_CHECK_NEW(scene->joint, count);
    RITZ_CHECK_NEW(scene->sweep, 2 * count);
    scene->num_joints = count;
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);
        ritz_joint *joint = &scene->joint[k];
        ritz_names before = {"joint", k, scene->joint->name, sizeof *joint};

        RITZ_CHECK(read_joint(yaml, item, scene, joint));
        RITZ_REFUSE_AT(ritz_names_index(&before, joint->name) >= 0, yaml, item,
                       "joint '%s' is given twice", joint->name);
    }
    return check_sweeps(yaml, node, scene);
}
