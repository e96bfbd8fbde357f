/* What holds a joint in the motions that its type leaves. */
#include "scene/joint_parts.h"

#include <inttypes.h>
#include <math.h>

static const char states[][8] = {
    [RITZ_FREE] = "free",
    [RITZ_LOCKED] = "locked",
    [RITZ_CAGED] = "caged",
};

/* axis / |axis|, scaled first so that no square leaves the range. */
ritz_status ritz_joint_take_axis(const ritz_yaml *yaml, const yaml_node_t *node,
                                 void *field)
{
    double *axis = (double *)field;
    double largest = 0.0;
    double length = 0.0;

    RITZ_CHECK(ritz_yaml_reals(yaml, node, 3, axis));
    for (int i = 0; i < 3; i++)
        largest = fmax(largest, fabs(axis[i]));
    RITZ_REFUSE_AT(largest == 0.0, yaml, node, "the axis has no length");
    for (int i = 0; i < 3; i++)
        axis[i] /= largest;
    length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (int i = 0; i < 3; i++)
        axis[i] /= length;
    return RITZ_OK;
}

/* |a x b| of unit vectors: the sine between them. */
static double sine(const double *a, const double *b)
{
    double x = a[1] * b[2] - a[2] * b[1];
    double y = a[2] * b[0] - a[0] * b[2];
    double z = a[0] * b[1] - a[1] * b[0];

    return sqrt(x * x + y * y + z * z);
}

ritz_status ritz_joint_take_axes(const ritz_yaml *yaml, const yaml_node_t *node,
                                 void *field)
{
    const double parallel = 1e-6; /* axes are written with so many digits */
    double *axes = (double *)field;
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count != 2, yaml, node,
                   "2 axes are expected here, not %" PRId64, count);
    for (int64_t k = 0; k < 2; k++)
        RITZ_CHECK(ritz_joint_take_axis(yaml, ritz_yaml_item(yaml, node, k),
                                        axes + 3 * k));
    RITZ_REFUSE_AT(sine(axes, axes + 3) <= parallel, yaml, node,
                   "the two axes are parallel");
    return RITZ_OK;
}

ritz_status ritz_joint_take_offset(const ritz_yaml *yaml,
                                   const yaml_node_t *node, void *field)
{
    return ritz_yaml_reals(yaml, node, 3, (double *)field);
}

/* One word for all freedoms, or, where there are two axes, one for each. */
static ritz_status read_states(const ritz_yaml *yaml, const yaml_node_t *node,
                               ritz_joint *joint)
{
    const ritz_joint_kind *kind = ritz_joint_kind_of(joint->type);
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
    const ritz_joint_kind *kind = ritz_joint_kind_of(joint->type);
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

/* Numbers that hold nothing, and cages without numbers, are a mistake. */
static ritz_status check_cage(const ritz_yaml *yaml, const yaml_node_t *node,
                              const yaml_node_t *const *value,
                              const ritz_joint *joint)
{
    static const int numbers[] = {RITZ_JOINT_KEY_STIFFNESS,
                                  RITZ_JOINT_KEY_DAMPING};
    const char *called = ritz_joint_kind_of(joint->type)->called;
    bool caged = false, held = false;

    for (int64_t k = 0; k < joint->num_freedoms; k++) {
        const ritz_freedom *freedom = &joint->freedom[k];

        caged = caged || freedom->state == RITZ_CAGED;
        held = held || freedom->stiffness > 0.0 || freedom->damping > 0.0;
    }
    for (int k = 0; k < 2; k++)
        RITZ_REFUSE_AT(value[numbers[k]] && !caged, yaml, value[numbers[k]],
                       "'%s' is for a caged %s, '%s' is %s",
                       ritz_joint_keys[numbers[k]].name, called, joint->name,
                       states[joint->freedom[0].state]);
    RITZ_REFUSE_AT(caged && !held, yaml, node,
                   "caged %s '%s' has neither stiffness nor damping", called,
                   joint->name);
    return RITZ_OK;
}

ritz_status ritz_joint_read_freedoms(const ritz_yaml *yaml,
                                     const yaml_node_t *node,
                                     const yaml_node_t *const *value,
                                     ritz_joint *joint)
{
    double k[RITZ_MOST_FREEDOMS], c[RITZ_MOST_FREEDOMS];

    for (int64_t i = 0; i < joint->num_freedoms; i++)
        joint->freedom[i].state =
            joint->type == RITZ_JOINT_BUSHING ? RITZ_CAGED : RITZ_FREE;
    if (value[RITZ_JOINT_KEY_STATE])
        RITZ_CHECK(read_states(yaml, value[RITZ_JOINT_KEY_STATE], joint));
    RITZ_CHECK(read_numbers(yaml, value[RITZ_JOINT_KEY_STIFFNESS], joint,
                            "stiffness", k));
    RITZ_CHECK(
        read_numbers(yaml, value[RITZ_JOINT_KEY_DAMPING], joint, "damping", c));
    for (int64_t i = 0; i < joint->num_freedoms; i++)
        if (joint->freedom[i].state == RITZ_CAGED) {
            joint->freedom[i].stiffness = k[i];
            joint->freedom[i].damping = c[i];
        }
    return check_cage(yaml, node, value, joint);
}
