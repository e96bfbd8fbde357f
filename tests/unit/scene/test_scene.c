/* Scenes as text: what is read, and the sentences of refusals. */
#include "testing.h"

#include "scene_texts.h"

#include <ritz/scene.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void components_of_the_example_are_read(void **)
{
    RITZ_OWN(ritz_scene) scene = scene_of_text(EXAMPLE);

    assert_string_equal(scene.name, "dual-spin spacecraft, cruise");
    assert_int_equal(scene.num_components, 3);
    assert_string_equal(scene.component[0].name, "rotor");
    assert_string_equal(scene.component[0].model, "rotor.h5");
    assert_string_equal(scene.component[0].basis, "macneal-rubin");
    assert_int_equal(scene.component[0].modes, -1);
    assert_near(scene.component[0].up_to_hz, 20.0, 0.0);
    assert_string_equal(scene.component[0].attach, "bearing");
    assert_int_equal(scene.component[0].line, 3);
    assert_int_equal(scene.component[0].column, 3);
    assert_int_equal(scene.component[1].modes, 12);
    assert_near(scene.component[1].up_to_hz, 0.0, 0.0);
    assert_null(scene.component[1].attach);
    assert_string_equal(scene.component[2].basis, "rigid");
}

static void the_rest_of_the_example_is_read(void **)
{
    RITZ_OWN(ritz_scene) scene = scene_of_text(EXAMPLE);

    assert_int_equal(scene.num_inputs, 1);
    assert_string_equal(scene.input[0].name, "torque_rotor");
    assert_string_equal(scene.input[0].at.port, "bearing");
    assert_int_equal(scene.input[0].component, 6);
    assert_int_equal(scene.input[0].grid, 0);
    assert_near(scene.input[0].scale, 1.0, 0.0);
    assert_int_equal(scene.num_outputs, 1);
    assert_int_equal(scene.output[0].at.component, 2);
    assert_int_equal(scene.output[0].derivative, 0);
    assert_near(scene.output[0].limit, 1e-3, 0.0);
    assert_near(scene.band_hz[1], 10.0, 0.0);
    assert_int_equal(scene.damping.kind, RITZ_DAMPING_MODAL);
    assert_near(scene.damping.zeta, 0.002, 0.0);
    assert_string_equal(scene.select_by, "hankel");
    assert_near(scene.select_tolerance, 1e-3, 0.0);
    assert_near(scene.composite_tolerance, 1e-12, 0.0);
    assert_int_equal(scene.num_reference, 0);
    assert_int_equal(scene.augment, RITZ_AUGMENT_SYSTEM);
}

static void a_scene_needs_a_name_and_a_component_only(void **)
{
    ritz_scene scene =
        scene_of_text("{components: {a: {model: a}}, scene: one}");

    assert_string_equal(scene.component[0].basis, "");
    assert_int_equal(scene.num_joints, 0);
    assert_int_equal(scene.num_configurations, 1);
    assert_near(scene.band_hz[1], 0.0, 0.0);
    assert_int_equal(scene.damping.kind, RITZ_DAMPING_NONE);
    assert_string_equal(scene.select_by, "hankel");
    assert_near(scene.select_tolerance, 1e-3, 0.0);
    assert_int_equal(scene.augment, RITZ_AUGMENT_NONE);
    assert_ok(ritz_scene_settings(&scene, "", NULL));
    ritz_scene_free(&scene);
    assert_null(scene.component);
    ritz_scene_free(&scene);
}

static void all_keys_of_inputs_and_outputs_are_read(void **)
{
    ritz_scene scene = scene_of_text(
        SMALL "inputs: [{name: f, at: b/x, component: 1, grid: 7, scale: -2}]\n"
              "outputs:\n"
              "- {name: v, at: a/x, component: 2, quantity: velocity}\n"
              "- {name: w, at: c/y, component: 3, quantity: acceleration,\n"
              "   grid: 9}\n");

    assert_int_equal(scene.input[0].grid, 7);
    assert_near(scene.input[0].scale, -2.0, 0.0);
    assert_int_equal(scene.output[0].derivative, 1);
    assert_true(isnan(scene.output[0].limit));
    assert_int_equal(scene.output[1].derivative, 2);
    assert_int_equal(scene.output[1].grid, 9);
    assert_int_equal(scene.output[1].line, 9);
    ritz_scene_free(&scene);
}

static void dampings_of_every_kind_are_read(void **)
{
    ritz_scene bands = scene_of_text(
        SMALL "damping: {bands: [[0, 5, 0.002], [5, 20, 0.005]]}\n");
    RITZ_OWN(ritz_scene)
    rayleigh = scene_of_text(SMALL "damping: {rayleigh: [0.1, 2.0e-5]}\n");
    RITZ_OWN(ritz_scene)
    modes = scene_of_text(SMALL "damping: {modes: [0.01, 0.02, 0.015]}\n");
    ritz_scene fit = scene_of_text(
        SMALL "damping: {rayleigh_fit: [[1, 0.01], [10, 0.02]]}\n");
    ritz_damping stated = {0};

    assert_int_equal(bands.damping.kind, RITZ_DAMPING_BANDS);
    assert_int_equal(bands.damping.count, 2);
    assert_near(bands.damping.band[1][2], 0.005, 0.0);
    assert_int_equal(rayleigh.damping.kind, RITZ_DAMPING_RAYLEIGH);
    assert_near(rayleigh.damping.b, 2e-5, 0.0);
    assert_int_equal(modes.damping.kind, RITZ_DAMPING_MODES);
    assert_int_equal(modes.damping.count, 3);
    assert_near(modes.damping.ratio[2], 0.015, 0.0);
    /* two points are met: the text says the same */
    assert_ok(ritz_damping_parse("fit 1 0.01 10 0.02", &stated));
    assert_memory_equal(&fit.damping, &stated, sizeof stated);
    assert_true(fit.damping.a > 0.1);
    ritz_scene_free(&fit);
    ritz_scene_free(&bands);
}

static void references_are_configurations_of_the_scene(void **)
{
    ritz_scene scene = scene_of_text(
        SMALL HINGES "composite: {tolerance: 1.0e-6,\n"
                     "  reference: [{p: 10, q: 7.5}, {q: 5, p: 0}]}\n"
                     "select: {by: gregory}\n");
    RITZ_OWN(ritz_scene) all = scene_of_text(SMALL HINGES "composite: union\n");

    assert_near(scene.composite_tolerance, 1e-6, 0.0);
    assert_int_equal(scene.num_reference, 2);
    assert_int_equal(scene.reference[0], 5);
    assert_int_equal(scene.reference[1], 1);
    assert_string_equal(scene.select_by, "gregory");
    assert_int_equal(all.num_reference, 0);
    ritz_scene_free(&scene);
}

static void an_anchor_can_be_used_again(void **)
{
    ritz_scene scene = scene_of_text(
        "scene: two alike\n"
        "components:\n"
        "  a: &wing {model: wing.h5, basis: guyan, attach: [r, t]}\n"
        "  b: *wing\n");

    assert_string_equal(scene.component[1].name, "b");
    assert_string_equal(scene.component[1].model, "wing.h5");
    assert_string_equal(scene.component[1].attach, "r,t");
    assert_int_equal(scene.component[1].line, 4);
    ritz_scene_free(&scene);
}

static void texts_that_are_no_yaml_are_refused(void **)
{
    static const refusal cases[] = {
        {"", "s:1:1: the file is empty"},
        {"# only a comment\n", "s:1:1: the file is empty"},
        {"scene: [a\nb: c\n", "s:2:2: did not find expected ',' or ']' while "
                              "parsing a flow sequence"},
        {"scene: 'a\n", "s:2:1: found unexpected end of stream while scanning "
                        "a quoted scalar"},
        {"scene: *a\n", "s:1:8: found undefined alias"},
        {"a: 1\nscene: \xff\n", "s:2:8: invalid leading UTF-8 octet"},
        {"scene: a\n\tb: c\n", "s:2:1: found a tab character that violates "
                               "indentation while scanning a plain scalar"},
        {"scene: a\n---\nscene: b\n",
         "s:3:1: a second document begins here, a scene is one"},
        {"just words\n",
         "s:1:1: a mapping is expected here, not a word or number"},
        {"- scene\n", "s:1:1: a mapping is expected here, not a list"},
        {"&a [*a]\n", "s:1:1: a mapping is expected here, not a list"},
        {"&a {scene: *a}\n",
         "s:1:1: a word or number is expected here, not a mapping"},
        {"scene: \"a\\0b\"\n", "s:1:8: a NUL character stands in a text"},
        {"scene: !!binary abc\n", "s:1:8: the tag 'tag:yaml.org,2002:binary' "
                                  "means nothing here"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void bad_keys_are_refused(void **)
{
    static const refusal cases[] = {
        {"scene: a\ncomponents: {a: {model: m, modez: 2}}\n",
         "s:2:28: unknown key 'modez', is 'modes' meant?"},
        {"scene: a\ncomponents: {a: {modez: 2, modes: 1}}\n",
         "s:2:18: unknown key 'modez', is 'model' meant?"},
        {"scene: a\ncomponents: {a: {model: m, q: 2}}\n",
         "s:2:28: unknown key 'q', there is model, basis, order, "
         "stiffening, modes, "
         "up_to_hz, attach, shift_hz, loads, inner, interface_modes, gramian, "
         "operator, damping, engine, among_hz, band_hz, remainder, count, "
         "accuracy, sides"},
        {"scene: a\ncomponent: {a: {model: m}}\n",
         "s:2:1: unknown key 'component', is 'components' meant?"},
        {"scene: a\nscene: b\n", "s:2:1: key 'scene' is given twice"},
        {"scene: a\n", "s:1:1: key 'components' is missing"},
        {"components: {a: {model: m}}\n", "s:1:1: key 'scene' is missing"},
        {"scene: a\ncomponents:\n  a: {basis: rigid}\n",
         "s:3:6: key 'model' is missing"},
        {"[a]: b\n", "s:1:1: a word or number is expected here, not a list"},
        {"<<: {a: b}\n",
         "s:1:1: unknown key '<<', there is scene, plane, components, joints, "
         "configurations, inputs, outputs, band_hz, damping, spin, "
         "spin_model, select, "
         "composite, augment, extraneous"},
        {SMALL "joints: [{between: [a/x, b/x], type: fixed}]\n",
         "s:6:10: key 'name' is missing"},
        {SMALL "joints: [{name: p, type: fixed}]\n",
         "s:6:10: key 'between' is missing"},
        {SMALL "joints: [{name: p, between: [a/x, b/x]}]\n",
         "s:6:10: key 'type' is missing"},
        {SMALL "inputs: [{name: u, at: a/x}]\n",
         "s:6:10: key 'component' is missing"},
        {SMALL "inputs: [{name: u, at: a/x, component: 1, limit: 3}]\n",
         "s:6:43: unknown key 'limit', there is name, at, component, grid, "
         "against, scale"},
        {SMALL "outputs: [{name: u, component: 1}]\n",
         "s:6:11: key 'at' is missing"},
        {SMALL "select: {tolerances: 0.1}\n",
         "s:6:10: unknown key 'tolerances', is 'tolerance' meant?"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void bad_components_are_refused(void **)
{
    static const refusal cases[] = {
        {"scene:\n", "s:1:7: a name or value is missing here"},
        {"scene: ''\n", "s:1:8: a name or value is missing here"},
        {"scene: a/b\n", "s:1:8: 'a/b' holds '/' or a control character, a "
                         "name cannot"},
        {"scene: a\ncomponents: {}\n",
         "s:2:13: a scene has 1 to 10000 components, not 0"},
        {"scene: a\ncomponents: [a]\n",
         "s:2:13: a mapping is expected here, not a list"},
        {"scene: a\ncomponents: {'': {model: m}}\n",
         "s:2:14: a name or value is missing here"},
        {"scene: a\ncomponents: {a/b: {model: m}}\n",
         "s:2:14: 'a/b' holds '/' or a control character, a name cannot"},
        {"scene: a\ncomponents: {a: {model: m}, a: {model: n}}\n",
         "s:2:29: component 'a' is given twice"},
        {"scene: a\ncomponents: {a: m}\n",
         "s:2:17: a mapping is expected here, not a word or number"},
        {"scene: a\ncomponents: {a: {model: }}\n",
         "s:2:25: a name or value is missing here"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, modes: 1.5}}\n",
         "s:2:45: '1.5' is not a whole number"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, modes: -1}}\n",
         "s:2:45: -1 modes cannot be kept"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, modes: "
         "99999999999999999999}}\n",
         "s:2:45: '99999999999999999999' is not a whole number"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, up_to_hz: 20Hz}}\n",
         "s:2:48: '20Hz' is not a finite number"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, up_to_hz: .inf}}\n",
         "s:2:48: '.inf' is not a finite number"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, up_to_hz: nan}}\n",
         "s:2:48: 'nan' is not a finite number"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, up_to_hz: 1e999}}\n",
         "s:2:48: '1e999' is not a finite number"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, up_to_hz: 0}}\n",
         "s:2:48: 0 is not above 0"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, modes: 1, "
         "up_to_hz: 2}}\n",
         "s:2:58: 'modes' and 'up_to_hz' are both given, one decides"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void ways_to_reduce_that_make_no_sense_are_refused(void **)
{
    static const refusal cases[] = {
        {"scene: a\ncomponents: {a: {model: m, modes: 1}}\n",
         "s:2:35: 'modes' says how to reduce, which needs a 'basis' too"},
        {"scene: a\ncomponents: {a: {model: m, order: 0}}\n",
         "s:2:35: 0 columns are no model"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, order: 4}}\n",
         "s:2:45: 'order' is how much of a model that is reduced already to "
         "take, and a 'basis' reduces one"},
        {"scene: a\ncomponents: {a: {model: m, attach: [x]}}\n",
         "s:2:36: 'attach' says how to reduce, which needs a 'basis' too"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, attach: []}}\n",
         "s:2:46: no port is listed; without 'attach' those that joints and "
         "inputs use are attached"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, attach: x}}\n",
         "s:2:46: a list is expected here, not a word or number"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, attach: [x, x]}}\n",
         "s:2:50: port 'x' is listed twice"},
        {"scene: a\ncomponents: {a: {model: m, basis: b, attach: ['x,y']}}\n",
         "s:2:47: 'x,y' holds a comma, a port cannot"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void bad_configurations_are_refused(void **)
{
    static const refusal cases[] = {
        {SMALL HINGES "configurations: []\n",
         "s:12:17: no configuration is listed; without 'configurations' every "
         "combination of settings is one"},
        {SMALL HINGES "configurations: [{p: 0, pq: 0}]\n",
         "s:12:25: unknown joint 'pq', is 'p' meant?"},
        {SMALL HINGES "configurations: [{p: 0}]\n",
         "s:12:18: joint 'q' has several settings and none is given here"},
        {SMALL HINGES "configurations: [{p: 0, q: 0, w: 0}]\n",
         "s:12:31: joint 'w' has nothing to set: only hinges, sliders and "
         "universal "
         "joints have"},
        {SMALL HINGES "configurations: [{p: 0, q: 0, p: 1}]\n",
         "s:12:31: joint 'p' is given twice"},
        {SMALL HINGES "configurations: [{p: 0, q: east}]\n",
         "s:12:28: 'east' is not a finite number"},
        {SMALL HINGES "configurations: [{p: 0, q: 1}, {p: 1, q: 1}, "
                      "{q: 1.0, p: 0}]\n",
         "s:12:46: this configuration is listed before"},
        {SMALL HINGES "configurations: [0, 60]\n",
         "s:12:18: a mapping is expected here, not a word or number"},
        {SMALL HINGES "composite: {reference: [{p: 1, q: 0}]}\n",
         "s:12:25: this is none of the scene's configurations"},
        {SMALL HINGES "composite: {reference: [{p: 0, q: 0}, {q: 0, p: 0}]}\n",
         "s:12:39: this reference is listed before"},
        {SMALL HINGES "composite: {reference: []}\n",
         "s:12:24: 1 to 1000 references can be listed, not 0"},
        {SMALL HINGES "composite: onion\n",
         "s:12:12: unknown composite 'onion', is 'union' meant?"},
        {SMALL HINGES "composite: {tolerance: 0}\n",
         "s:12:24: 0 is not between 0 and 1"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void bad_inputs_and_outputs_are_refused(void **)
{
    static const refusal cases[] = {
        {SMALL "inputs: [{name: u, at: a/x, component: 7}]\n",
         "s:6:40: component 7 is none of 1-3, along the axes, and 4-6, about "
         "them"},
        {SMALL "inputs: [{name: u, at: a/x, component: T1}]\n",
         "s:6:40: 'T1' is not a whole number"},
        {SMALL "inputs: [{name: u, at: e/x, component: 1}]\n",
         "s:6:24: unknown component 'e', is 'a' meant?"},
        {SMALL "inputs: [{name: u, at: a/x, component: 1, grid: 0}]\n",
         "s:6:49: 0 is no grid"},
        {SMALL "inputs: [{name: u, at: a/x, component: 1, scale: 0}]\n",
         "s:6:50: a scale of 0 leaves no input"},
        {SMALL "inputs: [{name: u, at: a/x, component: 1},\n"
               "  {name: u, at: a/x, component: 2}]\n",
         "s:7:10: input 'u' is given twice"},
        {SMALL "outputs: [{name: u, at: a/x, component: 1},\n"
               "  {name: u, at: a/x, component: 2}]\n",
         "s:7:10: output 'u' is given twice"},
        {SMALL "outputs: [{name: u, at: a/x, component: 1, limit: 0}]\n",
         "s:6:51: 0 is not above 0"},
        {SMALL "outputs: [{name: u, at: a/x, component: 1, quantity: speed}]\n",
         "s:6:54: unknown quantity 'speed', there is displacement, velocity, "
         "acceleration"},
        {SMALL "outputs: [{name: u/v, at: a/x, component: 1}]\n",
         "s:6:18: 'u/v' holds '/' or a control character, a name cannot"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void bad_options_are_refused(void **)
{
    static const refusal cases[] = {
        {SMALL "band_hz: [5, 5]\n",
         "s:6:10: the band 5 to 5 Hz does not ascend from 0 or above"},
        {SMALL "band_hz: [-1, 5]\n",
         "s:6:10: the band -1 to 5 Hz does not ascend from 0 or above"},
        {SMALL "band_hz: [0, 10, 20]\n",
         "s:6:10: 2 numbers are expected here, not 3"},
        {SMALL "damping: 0.002\n",
         "s:6:10: a mapping is expected here, not a word or number"},
        {SMALL "damping: {}\n",
         "s:6:10: damping is one of modal, modes, bands, "
         "rayleigh and rayleigh_fit"},
        {SMALL "damping: {modal: 0.1, rayleigh: [1, 1]}\n",
         "s:6:10: damping is one of modal, modes, bands, "
         "rayleigh and rayleigh_fit"},
        {SMALL "damping: {model: 0.1}\n",
         "s:6:11: unknown key 'model', is 'modal' meant?"},
        {SMALL "damping: {modal: 0}\n",
         "s:6:18: damping ratio 0 is not above 0"},
        {SMALL "damping: {modal: 1.2}\n",
         "s:6:18: damping ratio 1.2 is overdamped, it must stay below 1"},
        {SMALL "damping: {bands: []}\n",
         "s:6:18: 1 to 8 bands can be given, not 0"},
        {SMALL "damping: {bands: [[0, 5, 0.1], [4, 8, 0.1]]}\n",
         "s:6:32: damping band 4 to 8 Hz begins before 5 Hz, where the one "
         "before it ends"},
        {SMALL "damping: {rayleigh: [0, 0]}\n",
         "s:6:21: rayleigh damping 0 0 is none"},
        {SMALL "damping: {modes: []}\n",
         "s:6:18: 1 to 40 ratios of modes can be given, not 0"},
        {SMALL "damping: {modes: [0.1, 0]}\n",
         "s:6:18: damping ratio 0 is not above 0"},
        {SMALL "damping: {rayleigh_fit: [[1, 0.1]]}\n",
         "s:6:25: 2 to 20 points of a fit can be given, not 1"},
        {SMALL "damping: {rayleigh_fit: [[1, 0.1], [1, 0.2]]}\n",
         "s:6:25: a damping fit needs two different frequencies, all are 1 Hz"},
        {SMALL "select: {tolerance: 1}\n", "s:6:21: 1 is not between 0 and 1"},
        {SMALL "select: {tolerance: -0.5}\n",
         "s:6:21: -0.5 is not between 0 and 1"},
        {SMALL "select: hankel\n",
         "s:6:9: a mapping is expected here, not a word or number"},
        {SMALL "augment: sistem\n",
         "s:6:10: unknown augmentation 'sistem', is 'system' meant?"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static void hostile_texts_end_soon_and_in_one_sentence(void **)
{
    static const struct {
        const char *head, *piece;
        size_t times;
        const char *words;
    } cases[] = {
        {"", "[", 1000000, "s:1:101: more than 100 brackets one in another"},
        {"", "{a: ", 250000, "more than 100 brackets one in another"},
        {"[", "&a x, ", 100000, "more than 1000 anchors"},
        {"", "- ", 300000, "s:1:1: a mapping is expected here, not a list"},
        {"", "? ", 300000, "s:1:3: a word or number is expected here, not a m"},
        {"scene: ", "x", 1000000,
         "s:1:8: 'xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...' is longer than"},
        {"a: &a [x]\nscene: \"", "\\n", 500000, "found unexpected end"},
        {"", "\xc3\xa4", 500000, "a mapping is expected here"},
        {"scene: a\ncomponents: {x: {model: m, basis: b, attach: [y", ", z",
         20000, "did not find expected ',' or ']'"},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *text = repeat_text(cases[k].head, cases[k].piece, cases[k].times);
        ritz_scene scene = {0};

        ritz_status status = ritz_scene_parse("s", text, &scene);

        free(text);
        assert_int_equal(status, RITZ_ERR_FORMAT);
        if (!strstr(ritz_error_message(), cases[k].words))
            fail_msg("case %zu: %s", k, ritz_error_message());
    }
}

/* Ten anchors of ten aliases each: 1e9 words if they were written out. */
static void aliases_of_aliases_do_not_multiply(void **)
{
    char text[2000] = "scene: &a0 lol\ncomponents:\n";
    size_t used = strlen(text);
    ritz_scene scene = {0};

    for (int k = 1; k < 10; k++) {
        used += (size_t)snprintf(
            text + used, sizeof text - used,
            " n%d: &a%d [*a%d,*a%d,*a%d,*a%d,*a%d,*a%d,*a%d,*a%d]\n", k, k,
            k - 1, k - 1, k - 1, k - 1, k - 1, k - 1, k - 1, k - 1);
    }
    assert_fails(ritz_scene_parse("s", text, &scene), RITZ_ERR_FORMAT,
                 "s:3:6: a mapping is expected here, not a list");
}

/* 18 hinges of two angles: 2^18 > 100000. */
static void too_many_combinations_are_refused(void **)
{
    char text[4000] = SMALL "joints:\n";
    size_t used = strlen(text);
    ritz_scene scene = {0};

    for (int k = 0; k < 18; k++) {
        used += (size_t)snprintf(
            text + used, sizeof text - used,
            "- {name: h%d, between: [a/x, b/x], type: hinge, axis: [1, 0, "
            "0], angles_deg: [0, 1]}\n",
            k);
    }
    assert_fails(
        ritz_scene_parse("s", text, &scene), RITZ_ERR_FORMAT,
        "s:1:1: 262144 configurations of 18 settings are too many: list "
        "those wanted under 'configurations'");
}

/* What is cut or damaged is read or refused with one line, never anything else.
 */
static void assert_one_of_two(const char *text)
{
    RITZ_OWN(ritz_scene) scene = {0};

    ritz_record("%s", "");
    if (ritz_scene_parse("s", text, &scene) != RITZ_OK) {
        assert_string_not_equal(ritz_error_message(), "");
        assert_null(strchr(ritz_error_message(), '\n'));
        assert_null(scene.component);
    }
}

static void a_scene_cut_anywhere_is_read_or_refused(void **)
{
    char text[sizeof EXAMPLE];

    for (size_t length = 0; length < sizeof EXAMPLE; length++) {
        memcpy(text, EXAMPLE, length);
        text[length] = '\0';
        assert_one_of_two(text);
    }
}

static void a_damaged_scene_is_read_or_refused(void **)
{
    static const unsigned char yaml[] =
        "[]{}:,-?&*!|>'\"%@`# \n\t0123456789.e/";

    for (uint64_t seed = 1; seed <= 500; seed++) {
        uint64_t x = seed * UINT64_C(0x9e3779b97f4a7c15);
        char text[sizeof EXAMPLE];

        memcpy(text, EXAMPLE, sizeof EXAMPLE);
        for (int k = 0; k < 1 + (int)(seed % 8); k++) {
            unsigned char byte = 0;

            x ^= x << 13; /* xorshift, any will do */
            x ^= x >> 7;
            x ^= x << 17;
            byte = (unsigned char)(x >> 40 & 255);

            if (seed % 2)
                byte = yaml[(x >> 32) % (sizeof yaml - 1)];
            memcpy(&text[x % (sizeof EXAMPLE - 1)], &byte, 1);
        }
        assert_one_of_two(text);
    }
}

static void write_text(const char *path, const void *text, size_t size)
{
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void models_are_found_from_the_scene_s_folder(void **)
{
    static const char text[] = "scene: a\ncomponents:\n"
                               "  a: {model: parts/a.h5}\n"
                               "  b: {model: /b.h5}\n";
    char folder[] = "/tmp/ritz-scene-XXXXXX";
    char path[64];
    char model[64];
    ritz_scene scene = {0};
    ritz_scene again = {0};

    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    snprintf(model, sizeof model, "%s/parts/a.h5", folder);
    write_text(path, text, strlen(text));
    assert_ok(ritz_scene_read(path, &scene));
    assert_string_equal(scene.component[0].model, model);
    assert_string_equal(scene.component[1].model, "/b.h5");
    ritz_scene_free(&scene);
    assert_survives_every_allocation(ritz_scene_read(path, &again));
    ritz_scene_free(&again);

    write_text(path, "scene: a\0b", 10);
    assert_fails(ritz_scene_read(path, &scene), RITZ_ERR_FORMAT,
                 "scene.yaml' is not a text file");
    remove(path);
    assert_fails(ritz_scene_read(path, &scene), RITZ_ERR_FILE, "cannot open");
    rmdir(folder);
}

static void every_failing_allocation_is_survived(void **)
{
    static const char text[] =
        SMALL HINGES "inputs: [{name: u, at: a/x, component: 1}]\n"
                     "configurations: [{p: 0, q: 0}, {p: 3, q: 1}]\n"
                     "composite: {reference: [{p: 3, q: 1}]}\n";
    ritz_scene scene = {0};
    double angle[2];

    assert_survives_every_allocation(ritz_scene_parse("s", text, &scene));
    assert_survives_every_allocation(
        ritz_scene_settings(&scene, "p=1,q=2", angle));
    ritz_scene_free(&scene);
    assert_survives_every_allocation(ritz_scene_parse("s", EXAMPLE, &scene));
    ritz_scene_free(&scene);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(components_of_the_example_are_read),
    cmocka_unit_test(the_rest_of_the_example_is_read),
    cmocka_unit_test(a_scene_needs_a_name_and_a_component_only),
    cmocka_unit_test(all_keys_of_inputs_and_outputs_are_read),
    cmocka_unit_test(dampings_of_every_kind_are_read),
    cmocka_unit_test(references_are_configurations_of_the_scene),
    cmocka_unit_test(an_anchor_can_be_used_again),
    cmocka_unit_test(texts_that_are_no_yaml_are_refused),
    cmocka_unit_test(bad_keys_are_refused),
    cmocka_unit_test(bad_components_are_refused),
    cmocka_unit_test(ways_to_reduce_that_make_no_sense_are_refused),
    cmocka_unit_test(bad_configurations_are_refused),
    cmocka_unit_test(bad_inputs_and_outputs_are_refused),
    cmocka_unit_test(bad_options_are_refused),
    cmocka_unit_test(hostile_texts_end_soon_and_in_one_sentence),
    cmocka_unit_test(aliases_of_aliases_do_not_multiply),
    cmocka_unit_test(too_many_combinations_are_refused),
    cmocka_unit_test(a_scene_cut_anywhere_is_read_or_refused),
    cmocka_unit_test(a_damaged_scene_is_read_or_refused),
    cmocka_unit_test(models_are_found_from_the_scene_s_folder),
    cmocka_unit_test(every_failing_allocation_is_survived),
};

TEST_MODULE(scene, tests, NULL, NULL)
