/* Joints of a scene: a table says what each type of them takes. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "scene/yaml.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Keys of a joint. */
enum {
    KEY_NAME,
    KEY_BETWEEN,
    KEY_TYPE,
    KEY_AXIS,
    KEY_AXES,
    KEY_ANGLES,
    KEY_ANGLES2,
    KEY_POSITIONS,
    KEY_STATE,
    KEY_STIFFNESS,
    KEY_DAMPING,
    KEY_OFFSET,
    KEY_TOLERANCE,
    NUM_KEYS
};

/* What a type of joint takes. */
typedef struct joint_kind {
    char name[16];      /* as scenes write it */
    const char *called; /* in sentences */
    unsigned keys;      /* bits 1 << KEY_..., in addition to the first 3 */
    unsigned required;  /* of those */
    int64_t freedoms;   /* relative motions that it leaves */
    int64_t sweeps;     /* of them are set in a configuration */
    int sweep_key[2];
    bool one, many; /* whether a number, a list states a stiffness */
} joint_kind;

enum { /* bits of keys */
       AXIS = 1 << KEY_AXIS,
       AXES = 1 << KEY_AXES,
       ANGLES = 1 << KEY_ANGLES,
       ANGLES2 = 1 << KEY_ANGLES2,
       POSITIONS = 1 << KEY_POSITIONS,
       STATE = 1 << KEY_STATE,
       STIFFNESS = 1 << KEY_STIFFNESS,
       DAMPING = 1 << KEY_DAMPING,
       OFFSET = 1 << KEY_OFFSET,
       TOLERANCE = 1 << KEY_TOLERANCE,
       CAGE = STATE | STIFFNESS | DAMPING,
};

static const joint_kind kinds[] = {
    [RITZ_JOINT_FIXED] = {"fixed", "fixed joint", .keys = TOLERANCE},
    [RITZ_JOINT_HINGE] = {"hinge", "hinge", AXIS | ANGLES | CAGE, AXIS,
                          .freedoms = 1, .sweeps = 1, .sweep_key = {KEY_ANGLES},
                          .one = true},
    [RITZ_JOINT_SLIDER] = {"slider", "slider", AXIS | POSITIONS | CAGE, AXIS,
                           .freedoms = 1, .sweeps = 1,
                           .sweep_key = {KEY_POSITIONS}, .one = true},
    [RITZ_JOINT_UNIVERSAL] = {"universal", "universal joint",
                              AXES | ANGLES | ANGLES2 | CAGE, AXES,
                              .freedoms = 2, .sweeps = 2,
                              .sweep_key = {KEY_ANGLES, KEY_ANGLES2},
                              .one = true, .many = true},
    [RITZ_JOINT_SPHERICAL] = {"spherical", "spherical joint", CAGE,
                              .freedoms = 3, .one = true},
    [RITZ_JOINT_BUSHING] = {"bushing", "bushing",
                            AXES | STIFFNESS | DAMPING | TOLERANCE, STIFFNESS,
                            .freedoms = 6, .many = true},
    [RITZ_JOINT_RIGID] = {"rigid", "rigid joint", OFFSET, .freedoms = 0},
};

/* |a x b| of unit vectors: the sine between them. */
static double sine_between(const double *a, const double *b)
{
    double x = a[1] * b[2] - a[2] * b[1];
    double y = a[2] * b[0] - a[0] * b[2];
    double z = a[0] * b[1] - a[1] * b[0];

    return sqrt(x * x + y * y + z * z);
}

static ritz_status take_axes(const ritz_yaml *yaml, const yaml_node_t *node,
                             void *field)
{
    double *axes = (double *)field;
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count != 2, yaml, node,
                   "2 axes are expected here, not %" PRId64, count);
    for (int64_t k = 0; k < 2; k++)
        RITZ_CHECK(ritz_yaml_direction(yaml, ritz_yaml_item(yaml, node, k),
                                       axes + 3 * k));
    RITZ_REFUSE_AT(sine_between(axes, axes + 3) <= RITZ_PARALLEL_AXES, yaml,
                   node, "the two axes are parallel");
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

static const ritz_yaml_key keys[NUM_KEYS] = {
    [KEY_NAME] = {"name", true, RITZ_YAML_BY_HAND,
                  .offset = offsetof(ritz_joint, name), .take = take_name},
    [KEY_BETWEEN] = {.name = "between", .required = true},
    [KEY_TYPE] = {"type", true, RITZ_YAML_WORD,
                  RITZ_YAML_FIELD(ritz_joint, type),
                  .words = {"joint type", sizeof kinds / sizeof *kinds,
                            kinds[0].name, sizeof *kinds}},
    [KEY_AXIS] = {"axis", false, RITZ_YAML_BY_HAND,
                  .offset = offsetof(ritz_joint, axis),
                  .take = ritz_yaml_direction},
    [KEY_AXES] = {"axes", false, RITZ_YAML_BY_HAND,
                  .offset = offsetof(ritz_joint, axis), .take = take_axes},
    [KEY_ANGLES] = {.name = "angles_deg"},
    [KEY_ANGLES2] = {.name = "angles2_deg"},
    [KEY_POSITIONS] = {.name = "positions"},
    [KEY_STATE] = {.name = "state"},
    [KEY_STIFFNESS] = {.name = "stiffness"},
    [KEY_DAMPING] = {.name = "damping"},
    [KEY_OFFSET] = {"offset", false, RITZ_YAML_REALS,
                    .offset = offsetof(ritz_joint, offset), .count = 3},
    [KEY_TOLERANCE] = {"tolerance", false, RITZ_YAML_POSITIVE,
                       .offset = offsetof(ritz_joint, tolerance)},
};

/* ---- what holds a joint in the motions that its type leaves ------------- */

static const char states[][8] = {
    [RITZ_FREE] = "free",
    [RITZ_LOCKED] = "locked",
    [RITZ_CAGED] = "caged",
};

/* One word for all freedoms, or, where there are two axes, one for each. */
static ritz_status read_states(const ritz_yaml *yaml, const yaml_node_t *node,
                               ritz_joint *joint)
{
    const joint_kind *kind = &kinds[joint->type];
    ritz_names names = {"state", sizeof states / sizeof *states, states[0],
                        sizeof *states};
    bool many = kind->many && node->type == YAML_SEQUENCE_NODE;
    int64_t count = 0;

    if (many)
        RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(many && count != joint->num_freedoms, yaml, node,
                   "%" PRId64 " states are expected here, not %" PRId64,
                   joint->num_freedoms, count);
    for (int64_t k = 0; k < joint->num_freedoms; k++) {
        int64_t at = 0;

        RITZ_CHECK(ritz_yaml_word(
            yaml, many ? ritz_yaml_item(yaml, node, k) : node, &names, &at));
        joint->freedom[k].state = (ritz_freedom_state)at;
    }
    return RITZ_OK;
}

/* A number for all freedoms, or one for each: as the type of joint has it. */
static ritz_status read_numbers(const ritz_yaml *yaml, const yaml_node_t *node,
                                const ritz_joint *joint, const char *what,
                                double number[RITZ_MOST_FREEDOMS])
{
    const joint_kind *kind = &kinds[joint->type];
    bool many =
        !kind->one || (kind->many && node && node->type == YAML_SEQUENCE_NODE);

    for (int k = 0; k < RITZ_MOST_FREEDOMS; k++)
        number[k] = 0.0;
    if (!node)
        return RITZ_OK;
    if (many)
        RITZ_CHECK(ritz_yaml_reals(yaml, node, joint->num_freedoms, number));
    else
        RITZ_CHECK(ritz_yaml_real(yaml, node, number));
    for (int64_t k = 0; k < joint->num_freedoms; k++) {
        number[k] = number[many ? k : 0];
        RITZ_REFUSE_AT(number[k] < 0.0, yaml,
                       many ? ritz_yaml_item(yaml, node, k) : node,
                       "%s %g is negative", what, number[k]);
        RITZ_REFUSE_AT(many && number[k] > 0.0 &&
                           joint->freedom[k].state != RITZ_CAGED,
                       yaml, ritz_yaml_item(yaml, node, k),
                       "%s %g stands for an axis that is %s, not caged", what,
                       number[k], states[joint->freedom[k].state]);
    }
    return RITZ_OK;
}

/* Stiffness without a cage, and a cage without stiffness, are mistakes. */
static ritz_status check_cage(const ritz_yaml *yaml, const yaml_node_t *node,
                              const yaml_node_t *const *value,
                              const ritz_joint *joint)
{
    static const int numbers[] = {KEY_STIFFNESS, KEY_DAMPING};
    const char *called = kinds[joint->type].called;
    bool caged = false, held = false;

    for (int64_t k = 0; k < joint->num_freedoms; k++) {
        const ritz_freedom *freedom = &joint->freedom[k];

        caged = caged || freedom->state == RITZ_CAGED;
        held = held || freedom->stiffness > 0.0 || freedom->damping > 0.0;
    }
    for (int k = 0; k < 2; k++)
        RITZ_REFUSE_AT(value[numbers[k]] && !caged, yaml, value[numbers[k]],
                       "'%s' is for a caged %s, '%s' is %s",
                       keys[numbers[k]].name, called, joint->name,
                       states[joint->freedom[0].state]);
    RITZ_REFUSE_AT(caged && !held, yaml, node,
                   "caged %s '%s' has neither stiffness nor damping", called,
                   joint->name);
    return RITZ_OK;
}

static ritz_status read_freedoms(const ritz_yaml *yaml, const yaml_node_t *node,
                                 const yaml_node_t *const *value,
                                 ritz_joint *joint)
{
    double k[RITZ_MOST_FREEDOMS], c[RITZ_MOST_FREEDOMS];

    for (int64_t i = 0; i < joint->num_freedoms; i++)
        joint->freedom[i].state =
            joint->type == RITZ_JOINT_BUSHING ? RITZ_CAGED : RITZ_FREE;
    if (value[KEY_STATE])
        RITZ_CHECK(read_states(yaml, value[KEY_STATE], joint));
    RITZ_CHECK(read_numbers(yaml, value[KEY_STIFFNESS], joint, "stiffness", k));
    RITZ_CHECK(read_numbers(yaml, value[KEY_DAMPING], joint, "damping", c));
    for (int64_t i = 0; i < joint->num_freedoms; i++)
        if (joint->freedom[i].state == RITZ_CAGED) {
            joint->freedom[i].stiffness = k[i];
            joint->freedom[i].damping = c[i];
        }
    return check_cage(yaml, node, value, joint);
}

/* ---- axes of plane models ----------------------------------------------- */

/*
 * Check that the axis of a joint between plane models is normal to the plane,
 * or lies in it. An axis that departs from this by the digits of scene files is
 * corrected, so that motion in the plane is not mixed with motion out of it.
 */
static ritz_status settle_axis(const ritz_yaml *yaml, const yaml_node_t *node,
                               const ritz_joint *joint, bool lies, bool normal,
                               double *axis)
{
    static const char *const wanted[] = {"normal to it", "in it",
                                         "in it or normal to it"};
    const int n = (int)joint->plane - 1;
    const double other[] = {n == 0, n == 1, n == 2};

    if (lies && fabs(axis[n]) <= RITZ_PARALLEL_AXES) {
        const double left = sqrt(1.0 - axis[n] * axis[n]);

        axis[n] = 0.0;
        for (int i = 0; i < 3; i++)
            axis[i] /= left;
        return RITZ_OK;
    }
    RITZ_REFUSE_AT(!normal || sine_between(axis, other) > RITZ_PARALLEL_AXES,
                   yaml, node,
                   "the models lie in a plane, and the axis of a %s must be %s",
                   kinds[joint->type].called, wanted[lies + (lies && normal)]);
    for (int i = 0; i < 3; i++)
        axis[i] = i == n ? copysign(1.0, axis[i]) : 0.0;
    return RITZ_OK;
}

/* A hinge must turn about the normal, a slider must slide in the plane. */
static ritz_status settle_plane(const ritz_yaml *yaml, const yaml_node_t *node,
                                const yaml_node_t *const *value,
                                ritz_joint *joint)
{
    const yaml_node_t *axes = value[KEY_AXES] ? value[KEY_AXES] : node;

    if (joint->plane == RITZ_PLANE_NONE)
        return RITZ_OK;
    RITZ_REFUSE_AT(joint->type == RITZ_JOINT_UNIVERSAL, yaml, node,
                   "the models lie in a plane, where nothing turns about the "
                   "two axes of a universal joint: a hinge is meant");
    if (joint->type == RITZ_JOINT_HINGE)
        return settle_axis(yaml, value[KEY_AXIS], joint, false, true,
                           joint->axis[0]);
    if (joint->type == RITZ_JOINT_SLIDER)
        return settle_axis(yaml, value[KEY_AXIS], joint, true, false,
                           joint->axis[0]);
    for (int k = 0; k < 2 && joint->type == RITZ_JOINT_BUSHING; k++)
        RITZ_CHECK(settle_axis(yaml, axes, joint, true, true, joint->axis[k]));
    return RITZ_OK;
}

/* ---- a joint ------------------------------------------------------------ */

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

/* The settings under one key; without a list the only one is 0. */
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

/* Sweeps are named after their joint: "wrist", "wrist.2". */
static ritz_status read_sweeps(const ritz_yaml *yaml, const yaml_node_t *node,
                               const yaml_node_t *const *value,
                               ritz_joint *joint, ritz_scene *scene)
{
    static const char *const endings[] = {"", ".2"};
    const joint_kind *kind = &kinds[joint->type];

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
            .turns = kind->sweep_key[k] != KEY_POSITIONS,
        };
        memcpy(sweep->name, joint->name, sizeof sweep->name);
        memcpy(sweep->name + strlen(joint->name), endings[k],
               strlen(endings[k]) + 1);
        RITZ_CHECK(read_settings(yaml, value[kind->sweep_key[k]], kind->called,
                                 sweep));
    }
    return RITZ_OK;
}

/* Refuse keys that the type of joint would ignore, and missing ones. */
static ritz_status check_keys(const ritz_yaml *yaml, const yaml_node_t *node,
                              const ritz_joint *joint,
                              const yaml_node_t *const *value)
{
    const joint_kind *kind = &kinds[joint->type];

    for (int k = KEY_TYPE + 1; k < NUM_KEYS; k++)
        RITZ_REFUSE_AT(value[k] && !(kind->keys >> k & 1), yaml, value[k],
                       "'%s' does not belong to a %s", keys[k].name,
                       kind->called);
    for (int k = 0; k < NUM_KEYS; k++)
        RITZ_REFUSE_AT(!value[k] && (kind->required >> k & 1), yaml, node,
                       "%s '%s' has no %s", kind->called, joint->name,
                       keys[k].name);
    return RITZ_OK;
}

static ritz_status read_joint(const ritz_yaml *yaml, const yaml_node_t *node,
                              ritz_scene *scene, ritz_joint *joint)
{
    const yaml_node_t *value[NUM_KEYS];

    ritz_yaml_locate(node, &joint->line, &joint->column);
    joint->axis[0][0] = joint->axis[1][1] = 1.0;
    joint->plane = scene->plane;
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_KEYS, keys, joint, value));
    RITZ_CHECK(read_between(yaml, value[KEY_BETWEEN], scene, joint->between));
    RITZ_CHECK(check_keys(yaml, node, joint, value));
    RITZ_CHECK(settle_plane(yaml, node, value, joint));
    joint->num_freedoms = kinds[joint->type].freedoms;
    RITZ_CHECK(read_freedoms(yaml, node, value, joint));
    return read_sweeps(yaml, node, value, joint, scene);
}

/* No joint may have the name of another one's second sweep. */
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

        RITZ_CHECK(read_joint(yaml, item, scene, joint));
        RITZ_CHECK(ritz_yaml_distinct(yaml, item, "joint", k, scene->joint,
                                      sizeof *joint));
    }
    return check_sweeps(yaml, node, scene);
}
