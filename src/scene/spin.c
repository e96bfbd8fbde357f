/* Keys of a scene that spins: its axis and rate, and the loads that stiffen its
   components. */
#include "scene/yaml.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>

const char ritz_stiffening_word[RITZ_NUM_STIFFENINGS][16] = {
    [RITZ_STIFFENING_XX] = "spin_xx", [RITZ_STIFFENING_YY] = "spin_yy",
    [RITZ_STIFFENING_ZZ] = "spin_zz", [RITZ_STIFFENING_XY] = "spin_xy",
    [RITZ_STIFFENING_YZ] = "spin_yz", [RITZ_STIFFENING_XZ] = "spin_xz",
    [RITZ_STIFFENING_TIP] = "tip",
};

ritz_status ritz_scene_stiffening(const ritz_yaml *yaml,
                                  const yaml_node_t *node, void *field)
{
    char(*name)[RITZ_NAME_SIZE] = (char(*)[RITZ_NAME_SIZE])field;
    const yaml_node_t *value[RITZ_NUM_STIFFENINGS] = {0};
    ritz_yaml_key keys[RITZ_NUM_STIFFENINGS] = {0};
    bool any = false;

    for (int k = 0; k < RITZ_NUM_STIFFENINGS; k++)
        memcpy(keys[k].name, ritz_stiffening_word[k], sizeof keys[k].name);
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, RITZ_NUM_STIFFENINGS, keys, field,
                                 value));
    for (int k = 0; k < RITZ_NUM_STIFFENINGS; k++) {
        if (value[k])
            RITZ_CHECK(ritz_yaml_name(yaml, value[k], name[k]));
        any = any || value[k];
    }
    RITZ_REFUSE_AT(!any, yaml, node,
                   "no load is named: spin_zz: NAME, or another");
    return RITZ_OK;
}

enum { AXIS, THROUGH, NEGLIGIBLE, RATE, RPM, HZ, PROFILE, RAMP, NUM_KEYS };
enum { TO, SECONDS, NUM_RAMP_KEYS };
enum { MOST_POINTS = 100000 };

static const ritz_yaml_key keys[NUM_KEYS] = {
    [AXIS] = {"axis", true, RITZ_YAML_BY_HAND,
              .offset = offsetof(ritz_scene_spin, axis),
              .take = ritz_yaml_direction},
    [THROUGH] = {"through", false, RITZ_YAML_REALS,
                 .offset = offsetof(ritz_scene_spin, through), .count = 3},
    [NEGLIGIBLE] = {"negligible", false, RITZ_YAML_FRACTION,
                    RITZ_YAML_FIELD(ritz_scene_spin, negligible)},
    [RATE] = {.name = "rate"},
    [RPM] = {.name = "rpm"},
    [HZ] = {.name = "hz"},
    [PROFILE] = {.name = "profile"},
    [RAMP] = {.name = "ramp"},
};

static const ritz_yaml_key ramp_keys[NUM_RAMP_KEYS] = {
    [TO] = {.name = "to", .required = true},
    [SECONDS] = {.name = "seconds", .required = true},
};

static ritz_status check_rate(const ritz_yaml *yaml, const yaml_node_t *node,
                              double rate)
{
    RITZ_REFUSE_AT(fabs(rate) > RITZ_SPIN_FASTEST, yaml, node,
                   "a rate of %g rad/s is beyond %g rad/s", rate,
                   RITZ_SPIN_FASTEST);
    return RITZ_OK;
}

/* The change of a rate within some time. */
static ritz_status check_slope(const ritz_yaml *yaml, const yaml_node_t *node,
                               double change, double seconds)
{
    RITZ_REFUSE_AT(!(fabs(change / seconds) <= RITZ_SPIN_FASTEST), yaml, node,
                   "a change of %g rad/s within %g s is beyond %g rad/s^2",
                   change, seconds, RITZ_SPIN_FASTEST);
    return RITZ_OK;
}

static ritz_status make_room(int64_t count, ritz_spin_rate *rate)
{
    RITZ_CHECK_NEW(rate->time, count);
    RITZ_CHECK_NEW(rate->value, count);
    rate->count = count;
    return RITZ_OK;
}

/* [[0, 0], [10, 6]]: seconds and rad/s. */
static ritz_status take_profile(const ritz_yaml *yaml, const yaml_node_t *node,
                                ritz_spin_rate *rate)
{
    int64_t count = 0;

    RITZ_CHECK(ritz_yaml_list(yaml, node, &count));
    RITZ_REFUSE_AT(count < 2 || count > MOST_POINTS, yaml, node,
                   "a profile has 2 to %d points, not %" PRId64, MOST_POINTS,
                   count);
    RITZ_CHECK(make_room(count, rate));
    for (int64_t k = 0; k < count; k++) {
        const yaml_node_t *item = ritz_yaml_item(yaml, node, k);
        double point[2];

        RITZ_CHECK(ritz_yaml_reals(yaml, item, 2, point));
        RITZ_REFUSE_AT(k > 0 && point[0] <= rate->time[k - 1], yaml, item,
                       "times of a profile ascend, %g does not", point[0]);
        RITZ_CHECK(check_rate(yaml, item, point[1]));
        if (k > 0)
            RITZ_CHECK(check_slope(yaml, item, point[1] - rate->value[k - 1],
                                   point[0] - rate->time[k - 1]));
        rate->time[k] = point[0];
        rate->value[k] = point[1];
    }
    rate->course = RITZ_SPIN_PROFILE;
    return RITZ_OK;
}

/* {to: 6, seconds: 15} */
static ritz_status take_ramp(const ritz_yaml *yaml, const yaml_node_t *node,
                             ritz_spin_rate *rate)
{
    const yaml_node_t *value[NUM_RAMP_KEYS] = {0};

    RITZ_CHECK(make_room(1, rate));
    RITZ_CHECK(
        ritz_yaml_mapping(yaml, node, NUM_RAMP_KEYS, ramp_keys, rate, value));
    RITZ_CHECK(ritz_yaml_real(yaml, value[TO], rate->value));
    RITZ_CHECK(ritz_yaml_real(yaml, value[SECONDS], rate->time));
    RITZ_REFUSE_AT(!(rate->time[0] > 0.0), yaml, value[SECONDS],
                   "a ramp takes some time, not %g s", rate->time[0]);
    RITZ_CHECK(check_rate(yaml, value[TO], rate->value[0]));
    RITZ_CHECK(
        check_slope(yaml, value[SECONDS], rate->value[0], rate->time[0]));
    rate->course = RITZ_SPIN_RAMP;
    return RITZ_OK;
}

static ritz_status take_rate(const ritz_yaml *yaml, const yaml_node_t *node,
                             const yaml_node_t *const *value,
                             ritz_spin_rate *rate)
{
    static const double unit[] = {
        [RATE] = 1.0, [RPM] = RITZ_PI / 30.0, [HZ] = 2.0 * RITZ_PI};
    int given = 0;

    for (int k = RATE; k < NUM_KEYS; k++)
        given += value[k] != NULL;
    RITZ_REFUSE_AT(given != 1, yaml, node,
                   "a spin has one of rate, rpm, hz, profile and ramp");
    if (value[PROFILE])
        return take_profile(yaml, value[PROFILE], rate);
    if (value[RAMP])
        return take_ramp(yaml, value[RAMP], rate);
    RITZ_CHECK(make_room(1, rate));
    for (int k = RATE; k <= HZ; k++)
        if (value[k]) {
            RITZ_CHECK(ritz_yaml_real(yaml, value[k], rate->value));
            rate->value[0] *= unit[k];
            RITZ_CHECK(check_rate(yaml, value[k], rate->value[0]));
        }
    return RITZ_OK;
}

/* Bodies of a plane scene can only turn about the normal of the plane. */
static ritz_status check_plane(const ritz_yaml *yaml, const yaml_node_t *node,
                               const ritz_scene *scene)
{
    static const int normal[] = {
        [RITZ_PLANE_YZ] = 0, [RITZ_PLANE_XZ] = 1, [RITZ_PLANE_XY] = 2};

    RITZ_REFUSE_AT(scene->plane != RITZ_PLANE_NONE &&
                       fabs(scene->spin.axis[normal[scene->plane]]) <
                           1.0 - RITZ_SAME,
                   yaml, node, "bodies in a plane turn about its normal alone");
    return RITZ_OK;
}

ritz_status ritz_scene_spin_part(const ritz_yaml *yaml, const yaml_node_t *node,
                                 ritz_scene *scene)
{
    const yaml_node_t *value[NUM_KEYS] = {0};
    ritz_scene_spin *spin = &scene->spin;

    if (!node)
        return RITZ_OK;
    ritz_yaml_locate(node, &spin->line, &spin->column);
    RITZ_CHECK(ritz_yaml_mapping(yaml, node, NUM_KEYS, keys, spin, value));
    for (int k = 0; k < 3; k++)
        RITZ_REFUSE_AT(fabs(spin->through[k]) > RITZ_SPIN_FARTHEST, yaml,
                       value[THROUGH], "a point at %g is beyond %g",
                       spin->through[k], RITZ_SPIN_FARTHEST);
    RITZ_CHECK(take_rate(yaml, node, value, &spin->rate));
    spin->given = true;
    return check_plane(yaml, value[AXIS], scene);
}

static const char models[][16] = {
    [RITZ_SPIN_CONSISTENT] = "consistent",
    [RITZ_SPIN_INCONSISTENT] = "inconsistent",
    [RITZ_SPIN_RUTHLESS] = "ruthless",
};

const char *ritz_spin_model_name(ritz_spin_model model)
{
    return models[model];
}

ritz_status ritz_scene_spin_model(const ritz_yaml *yaml,
                                  const yaml_node_t *node, ritz_scene *scene)
{
    const ritz_names names = {"spin model", sizeof models / sizeof *models,
                              models[0], sizeof *models};
    int64_t at = 0;

    if (!node)
        return RITZ_OK;
    RITZ_REFUSE_AT(!scene->spin.given, yaml, node,
                   "a spin model goes with a 'spin' alone");
    RITZ_CHECK(ritz_yaml_word(yaml, node, &names, &at));
    scene->spin.model = (ritz_spin_model)at;
    return RITZ_OK;
}
