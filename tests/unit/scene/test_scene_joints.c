/* Joints of scenes, and their settings. */
#include "testing.h"

#include "scene_texts.h"

#include <ritz/scene.h>

#include <stdio.h>
#include <stdlib.h>

static void joints_of_the_example_are_read(void **)
{
    RITZ_OWN(ritz_scene) scene = scene_of_text(EXAMPLE);

    assert_int_equal(scene.num_joints, 2);
    assert_int_equal(scene.joint[0].type, RITZ_JOINT_HINGE);
    assert_int_equal(scene.joint[0].between[0].component, 0);
    assert_string_equal(scene.joint[0].between[0].port, "bearing");
    assert_int_equal(scene.joint[1].between[1].component, 2);
    assert_string_equal(scene.joint[1].between[1].port, "scan");
    assert_near(scene.joint[1].axis[0][1], 1.0, 0.0);
    assert_int_equal(scene.joint[0].num_freedoms, 1);
    assert_int_equal(scene.joint[0].freedom[0].state, RITZ_FREE);
    assert_string_equal(scene.sweep[0].name, "clock");
    assert_true(scene.sweep[0].turns);
    assert_int_equal(scene.sweep[0].count, 6);
    assert_near(scene.sweep[0].setting[5], 300.0, 0.0);
    assert_int_equal(scene.joint[1].line, 8);
    assert_int_equal(scene.joint[1].column, 5);
    assert_int_equal(scene.num_sweeps, 2);
    assert_int_equal(scene.num_configurations, 2);
    assert_near(scene.setting[0], 0.0, 0.0);
    assert_near(scene.setting[2], 60.0, 0.0);
    assert_near(scene.setting[3], 0.0, 0.0);
}

static void settings_combine_with_the_last_joint_fastest(void **)
{
    static const double expected[6][2] = {{0, 0},  {0, 5},  {0, 7.5},
                                          {10, 0}, {10, 5}, {10, 7.5}};
    RITZ_OWN(ritz_scene) scene = scene_of_text(SMALL HINGES);

    assert_int_equal(scene.num_joints, 3);
    assert_int_equal(scene.num_sweeps, 2);
    assert_int_equal(scene.sweep[1].joint, 1);
    assert_int_equal(scene.joint[1].sweep, 1);
    assert_int_equal(scene.joint[2].num_sweeps, 0);
    assert_int_equal(scene.num_configurations, 6);
    assert_memory_equal(scene.setting, expected, sizeof expected);
}

/* (3, 4, 0) / 5; the squares of 3e300 and 3e-300 are out of the range of
   doubles. */
static void an_axis_gets_length_one(void **)
{
    static const char *const axes[] = {"3, 4, 0", "3e300, 4e300, 0",
                                       "3.0e-300, 4.0e-300, -0"};

    for (int k = 0; k < 3; k++) {
        char text[400];
        ritz_scene scene = {0};

        snprintf(text, sizeof text,
                 SMALL "joints: [{name: p, between: [a/x, b/x], type: hinge, "
                       "axis: [%s]}]\n",
                 axes[k]);
        scene = scene_of_text(text);
        assert_near(scene.joint[0].axis[0][0], 0.6, 4e-16); /* 4 roundings */
        assert_near(scene.joint[0].axis[0][1], 0.8, 4e-16);
        assert_near(scene.joint[0].axis[0][2], 0.0, 0.0);
        assert_int_equal(scene.sweep[0].count, 1);
        assert_near(scene.sweep[0].setting[0], 0.0, 0.0);
        ritz_scene_free(&scene);
    }
}

static void angles_are_given_by_name(void **)
{
    RITZ_OWN(ritz_scene) scene = scene_of_text(EXAMPLE);
    double angle[2] = {-1.0, -1.0};

    assert_ok(ritz_scene_settings(&scene, "clock=61.5", angle));
    assert_near(angle[0], 61.5, 0.0);
    assert_near(angle[1], 0.0, 0.0);
    assert_ok(ritz_scene_settings(&scene, "cone=-3,clock=1e1", angle));
    assert_near(angle[0], 10.0, 0.0);
    assert_near(angle[1], -3.0, 0.0);
}

static void bad_angles_are_refused_and_nothing_is_written(void **)
{
    static const struct {
        const char *at, *words;
    } cases[] = {
        {"", "joint 'p' has several settings and none is given here"},
        {"p=1", "joint 'q' has several settings and none is given here"},
        {"p", "'p' is not JOINT=SETTING"},
        {"=1", "'=1' is not JOINT=SETTING"},
        {"p=1,", "'' is not JOINT=SETTING"},
        {"p=", "'' of joint 'p' is not a finite number"},
        {"p=60deg", "'60deg' of joint 'p' is not a finite number"},
        {"p=nan", "'nan' of joint 'p' is not a finite number"},
        {"p=1,p=2", "joint 'p' is given twice"},
        {"w=1",
         "joint 'w' has nothing to set: only hinges, sliders and universal "
         "joints have"},
        {"pp=1", "unknown joint 'pp', is 'p' meant?"},
        {"elbow=1", "unknown joint 'elbow', there is p, q"},
    };
    RITZ_OWN(ritz_scene) scene = scene_of_text(SMALL HINGES);
    double angle[2] = {-1.0, -1.0};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(ritz_scene_settings(&scene, cases[k].at, angle),
                         RITZ_ERR_ARGUMENT);
        assert_string_equal(ritz_error_message(), cases[k].words);
        assert_near(angle[0], -1.0, 0.0);
    }
}

/* A joint p between two ports, with `rest` as its other keys. */
#define JOINT(between, rest)                                                   \
    SMALL "joints:\n- {name: p, between: " between ", " rest "}\n"

static void bad_joints_are_refused(void **)
{
    static const refusal cases[] = {
        {JOINT("[a/x]", "type: fixed"),
         "s:7:22: a joint is between 2 ports, not 1"},
        {JOINT("a/x", "type: fixed"),
         "s:7:22: a list is expected here, not a word or number"},
        {JOINT("[a/x, b]", "type: fixed"),
         "s:7:28: 'b' is not COMPONENT/PORT, such as rotor/bearing"},
        {JOINT("[a/x, b/]", "type: fixed"),
         "s:7:28: 'b/' is not COMPONENT/PORT, such as rotor/bearing"},
        {JOINT("[a/x, b/y/z]", "type: fixed"),
         "s:7:28: 'y/z' holds '/' or a control character, a name cannot"},
        {JOINT("[a/x, bb/x]", "type: fixed"),
         "s:7:28: unknown component 'bb', is 'b' meant?"},
        {JOINT("[a/x, wing/x]", "type: fixed"),
         "s:7:28: unknown component 'wing', there is a, b, c"},
        {JOINT("[a/x, a/y]", "type: fixed"),
         "s:7:22: component 'a' is joined to itself"},
        {JOINT("[a/x, b/x]", "type: hing"),
         "s:7:40: unknown joint type 'hing', is 'hinge' meant?"},
        {JOINT("[a/x, b/x]", "type: ball"),
         "s:7:40: unknown joint type 'ball', there is fixed, hinge, slider, "
         "universal, spherical, bushing, rigid"},
        {JOINT("[a/x, b/x]", "type: fixed") "- {name: p, between: [a/y, c/y], "
                                            "type: fixed}\n",
         "s:8:3: joint 'p' is given twice"},
        {SMALL "joints: [{name: 'p=1', between: [a/x, b/x], type: fixed}]\n",
         "s:6:17: 'p=1' holds ',' or '=', the name of a joint cannot"},
        {SMALL "joints: {name: p}\n",
         "s:6:9: a list is expected here, not a mapping"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void bad_axes_and_angles_are_refused(void **)
{
    static const refusal cases[] = {
        {JOINT("[a/x, b/x]", "type: hinge"), "s:7:3: hinge 'p' has no axis"},
        {JOINT("[a/x, b/x]", "type: hinge, axis: [0, 0, 0]"),
         "s:7:53: the axis has no length"},
        {JOINT("[a/x, b/x]", "type: hinge, axis: [0, 1]"),
         "s:7:53: 3 numbers are expected here, not 2"},
        {JOINT("[a/x, b/x]", "type: hinge, axis: z"),
         "s:7:53: a list is expected here, not a word or number"},
        {JOINT("[a/x, b/x]", "type: hinge, axis: [0, 1, one]"),
         "s:7:60: 'one' is not a finite number"},
        {JOINT("[a/x, b/x]", "type: fixed, axis: [0, 0, 1]"),
         "s:7:53: 'axis' does not belong to a fixed joint"},
        {JOINT("[a/x, b/x]", "type: fixed, angles_deg: [0]"),
         "s:7:59: 'angles_deg' does not belong to a fixed joint"},
        {JOINT("[a/x, b/x]", "type: hinge, axis: [0, 0, 1], tolerance: 1"),
         "s:7:75: 'tolerance' does not belong to a hinge"},
        {JOINT("[a/x, b/x]", "type: fixed, tolerance: -1"),
         "s:7:58: -1 is not above 0"},
        {JOINT("[a/x, b/x]", "type: hinge, axis: [0, 0, 1], angles_deg: []"),
         "s:7:76: a hinge has 1 to 100000 angles, not 0"},
        {JOINT("[a/x, b/x]", "type: hinge, axis: [0, 0, 1], angles_deg: 0"),
         "s:7:76: a list is expected here, not a word or number"},
        {JOINT("[a/x, b/x]",
               "type: hinge, axis: [0, 0, 1], angles_deg: [0, 60, 60.0]"),
         "s:7:84: angle 60 is listed twice"},
        {JOINT("[a/x, b/x]",
               "type: hinge, axis: [0, 0, 1], angles_deg: [0, -0]"),
         "s:7:80: angle -0 is listed twice"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void keys_that_a_joint_does_not_take_are_refused(void **)
{
    static const struct {
        const char *type, *key;
    } cases[] = {
        {"fixed", "axis: [1, 0, 0]"},
        {"fixed", "state: free"},
        {"hinge", "positions: [0]"},
        {"hinge", "angles2_deg: [0]"},
        {"hinge", "offset: [0, 0, 1]"},
        {"slider", "angles_deg: [0]"},
        {"slider", "axes: [[1, 0, 0], [0, 1, 0]]"},
        {"universal", "axis: [1, 0, 0]"},
        {"universal", "positions: [0]"},
        {"spherical", "axis: [1, 0, 0]"},
        {"spherical", "angles_deg: [0]"},
        {"bushing", "state: caged"},
        {"bushing", "offset: [0, 0, 1]"},
        {"rigid", "stiffness: 1"},
        {"rigid", "tolerance: 1"},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[400], words[100];
        ritz_scene scene = {0};
        const char *type = cases[k].type;

        snprintf(text, sizeof text, JOINT("[a/x, b/x]", "type: %s, %s"), type,
                 cases[k].key);
        snprintf(words, sizeof words, "s:7:%zu: '%.*s' does not belong to a %s",
                 strlen("- {name: p, between: [a/x, b/x], type: , : ") +
                     strlen(type) + strcspn(cases[k].key, ":") + 1,
                 (int)strcspn(cases[k].key, ":"), cases[k].key, type);
        assert_fails(ritz_scene_parse("s", text, &scene), RITZ_ERR_FORMAT,
                     words);
    }
}

static void joints_of_every_type_are_read(void **)
{
    static const char text[] = SMALL
        "joints:\n"
        "- {name: s, between: [a/x, b/x], type: slider, axis: [0, 3, 4],\n"
        "   positions: [0, -0.5], state: caged, stiffness: 8, damping: 2}\n"
        "- {name: u, between: [a/x, b/x], type: universal, angles2_deg: [5,"
        " 6],\n   axes: [[0, 0, 2], [0, 3, 0]], state: [locked, caged],"
        " stiffness: 3}\n"
        "- {name: v, between: [a/x, b/x], type: universal, angles_deg: [1],\n"
        "   axes: [[0, 0, 2], [0, 3, 4]], state: caged, damping: [1, 0]}\n"
        "- {name: h, between: [a/x, b/x], type: hinge, axis: [0, 0, 1],\n"
        "   state: locked, angles_deg: [7]}\n"
        "- {name: o, between: [a/x, b/x], type: spherical, state: caged,\n"
        "   stiffness: 4}\n"
        "- {name: b, between: [a/x, b/x], type: bushing, tolerance: 0.1,\n"
        "   stiffness: [1, 2, 3, 4, 0, 6], damping: [0, 0, 0, 0, 5, 0]}\n"
        "- {name: r, between: [a/x, b/x], type: rigid, offset: [1, -2, 3]}\n";
    ritz_scene scene = scene_of_text(text);
    static const char *const names[] = {"s", "u", "u.2", "v", "v.2", "h"};
    double row[6] = {0.0};

    assert_int_equal(scene.num_sweeps, 6);
    for (int k = 0; k < 6; k++) {
        assert_string_equal(scene.sweep[k].name, names[k]);
        assert_int_equal(scene.sweep[k].turns, k > 0);
    }
    assert_int_equal(scene.num_configurations, 2 * 2);
    assert_near(scene.sweep[0].setting[1], -0.5, 0.0);
    assert_near(scene.joint[0].axis[0][2], 0.8, 4e-16); /* 4 roundings */
    assert_int_equal(scene.joint[0].freedom[0].state, RITZ_CAGED);
    assert_near(scene.joint[0].freedom[0].stiffness, 8.0, 0.0);
    assert_near(scene.joint[0].freedom[0].damping, 2.0, 0.0);
    assert_int_equal(scene.joint[1].num_freedoms, 2);
    assert_int_equal(scene.joint[1].sweep, 1);
    assert_int_equal(scene.joint[1].freedom[0].state, RITZ_LOCKED);
    assert_near(scene.joint[1].freedom[0].stiffness, 0.0, 0.0);
    assert_near(scene.joint[1].freedom[1].stiffness, 3.0, 0.0);
    assert_near(scene.joint[2].axis[1][1], 0.6, 4e-16);
    assert_near(scene.joint[2].freedom[0].damping, 1.0, 0.0);
    assert_int_equal(scene.joint[3].freedom[0].state, RITZ_LOCKED);
    assert_int_equal(scene.joint[4].num_freedoms, 3);
    assert_near(scene.joint[4].freedom[2].stiffness, 4.0, 0.0);
    assert_int_equal(scene.joint[5].num_freedoms, 6);
    assert_int_equal(scene.joint[5].freedom[4].state, RITZ_CAGED);
    assert_near(scene.joint[5].freedom[5].stiffness, 6.0, 0.0);
    assert_near(scene.joint[5].freedom[4].damping, 5.0, 0.0);
    assert_near(scene.joint[5].tolerance, 0.1, 0.0);
    assert_near(scene.joint[6].offset[1], -2.0, 0.0);
    assert_ok(ritz_scene_settings(&scene, "u.2=6,s=0.25", row));
    assert_near(row[0], 0.25, 0.0);
    assert_near(row[2], 6.0, 0.0);
    assert_near(row[3], 1.0, 0.0);
    ritz_scene_free(&scene);
    assert_survives_every_allocation(ritz_scene_parse("s", text, &scene));
    ritz_scene_free(&scene);
}

static void bad_freedoms_of_joints_are_refused(void **)
{
    static const refusal cases[] = {
        {JOINT("[a/x, b/x]", "type: slider"), "s:7:3: slider 'p' has no axis"},
        {JOINT("[a/x, b/x]", "type: universal"),
         "s:7:3: universal joint 'p' has no axes"},
        {JOINT("[a/x, b/x]", "type: bushing"),
         "s:7:3: bushing 'p' has no stiffness"},
        {JOINT("[a/x, b/x]", "type: universal, axes: [[1, 0, 0]]"),
         "s:7:57: 2 axes are expected here, not 1"},
        {JOINT("[a/x, b/x]", "type: universal, axes: [[1, 0, 0], [0, 0, 0]]"),
         "s:7:69: the axis has no length"},
        {JOINT("[a/x, b/x]", "type: universal, axes: [[1, 0, 0], [-2, 0, 0]]"),
         "s:7:57: the two axes are parallel"},
        {JOINT("[a/x, b/x]", "type: slider, axis: [1, 0, 0], positions: []"),
         "s:7:76: a slider has 1 to 100000 positions, not 0"},
        {JOINT("[a/x, b/x]",
               "type: slider, axis: [1, 0, 0], positions: [1, 1]"),
         "s:7:80: position 1 is listed twice"},
        {JOINT("[a/x, b/x]",
               "type: slider, axis: [1, 0, 0], positions: [.nan]"),
         "s:7:77: '.nan' is not a finite number"},
        {JOINT("[a/x, b/x]", "type: spherical, state: open"),
         "s:7:58: unknown state 'open', there is free, locked, caged"},
        {JOINT("[a/x, b/x]", "type: spherical, state: [free, free]"),
         "s:7:58: a word or number is expected here, not a list"},
        {JOINT("[a/x, b/x]", "type: universal, axes: [[1, 0, 0], [0, 1, 0]], "
                             "state: [free]"),
         "s:7:88: 2 states are expected here, not 1"},
        {JOINT("[a/x, b/x]", "type: spherical, stiffness: 4"),
         "s:7:62: 'stiffness' is for a caged spherical joint, 'p' is free"},
        {JOINT("[a/x, b/x]",
               "type: hinge, axis: [0, 0, 1], state: locked, damping: 4"),
         "s:7:88: 'damping' is for a caged hinge, 'p' is locked"},
        {JOINT("[a/x, b/x]", "type: spherical, state: caged"),
         "s:7:3: caged spherical joint 'p' has neither stiffness nor damping"},
        {JOINT("[a/x, b/x]", "type: bushing, stiffness: [0, 0, 0, 0, 0, 0]"),
         "s:7:3: caged bushing 'p' has neither stiffness nor damping"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void bad_stiffnesses_of_joints_are_refused(void **)
{
    static const refusal cases[] = {
        {JOINT("[a/x, b/x]", "type: spherical, state: caged, stiffness: -4"),
         "s:7:76: stiffness -4 is negative"},
        {JOINT("[a/x, b/x]", "type: spherical, state: caged, stiffness: 1, "
                             "damping: -1.0e-3"),
         "s:7:88: damping -0.001 is negative"},
        {JOINT("[a/x, b/x]", "type: spherical, state: caged, stiffness: .inf"),
         "s:7:76: '.inf' is not a finite number"},
        {JOINT("[a/x, b/x]", "type: bushing, stiffness: 5"),
         "s:7:60: a list is expected here, not a word or number"},
        {JOINT("[a/x, b/x]", "type: bushing, stiffness: [1, 2, 3]"),
         "s:7:60: 6 numbers are expected here, not 3"},
        {JOINT("[a/x, b/x]", "type: bushing, stiffness: [1, 2, 3, 4, -5, 6]"),
         "s:7:73: stiffness -5 is negative"},
        {JOINT("[a/x, b/x]", "type: universal, axes: [[1, 0, 0], [0, 1, 0]], "
                             "state: [free, caged], stiffness: [1, 2]"),
         "s:7:115: stiffness 1 stands for an axis that is free, not caged"},
        {JOINT("[a/x, b/x]", "type: rigid, offset: [1, 2]"),
         "s:7:55: 3 numbers are expected here, not 2"},
        {SMALL "joints:\n"
               "- {name: u, between: [a/x, b/x], type: universal, axes: "
               "[[1, 0, 0], [0, 1, 0]]}\n"
               "- {name: u.2, between: [b/x, c/x], type: fixed}\n",
         "s:8:3: joint 'u.2' has the name of the second axis of 'u'"},
        {SMALL "joints: [{name: "
               "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
               "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx, "
               "between: [a/x, b/x], type: universal, axes: [[1, 0, 0], [0, "
               "1, 0]]}]\n",
         "s:6:10: "
         "'xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
         "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx' "
         "is longer than 61 bytes, the name of a universal joint cannot be, "
         "as '.2' is put behind it"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void too_many_settings_are_refused(void **)
{
    char *text =
        repeat_text(SMALL "joints:\n",
                    "- {name: 0000, between: [a/x, b/x], type: universal, "
                    "axes: [[1, 0, 0], [0, 1, 0]]}\n",
                    501);
    char *name = text;
    ritz_scene scene = {0};

    for (int k = 0; k < 501; k++) { /* each joint has its own name */
        char number[16];

        name = strstr(name, "name: ") + strlen("name: ");
        snprintf(number, sizeof number, "%04d", k);
        memcpy(name, number, 4);
    }
    assert_fails(ritz_scene_parse("s", text, &scene), RITZ_ERR_FORMAT,
                 "s:7:1: 1002 settings of joints are too many, 1000 can be");
    free(text);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(joints_of_the_example_are_read),
    cmocka_unit_test(settings_combine_with_the_last_joint_fastest),
    cmocka_unit_test(an_axis_gets_length_one),
    cmocka_unit_test(angles_are_given_by_name),
    cmocka_unit_test(bad_angles_are_refused_and_nothing_is_written),
    cmocka_unit_test(bad_joints_are_refused),
    cmocka_unit_test(bad_axes_and_angles_are_refused),
    cmocka_unit_test(keys_that_a_joint_does_not_take_are_refused),
    cmocka_unit_test(joints_of_every_type_are_read),
    cmocka_unit_test(bad_freedoms_of_joints_are_refused),
    cmocka_unit_test(bad_stiffnesses_of_joints_are_refused),
    cmocka_unit_test(too_many_settings_are_refused),
};

TEST_MODULE(scene_joints, tests, NULL, NULL)
