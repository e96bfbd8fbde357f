/* Scenes as text: how they spin, and which loads stiffen their components. */
#include "testing.h"

#include "base/tolerances.h"
#include "scene_texts.h"

#include <math.h>

#define BLADE "scene: s\ncomponents:\n  a: {model: a.h5}\n"

static void a_rate_may_be_in_any_unit(void **)
{
    static const struct {
        const char *text;
        double rate;
    } cases[] = {
        {BLADE "spin: {axis: [0, 0, 2], rate: 3}\n", 3.0},
        {BLADE "spin: {axis: [0, 0, 1], rpm: 30}\n", RITZ_PI},
        {BLADE "spin: {axis: [0, 0, 1], hz: -0.5}\n", -RITZ_PI},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RITZ_OWN(ritz_scene) scene = scene_of_text(cases[k].text);

        assert_true(scene.spin.given);
        assert_int_equal(scene.spin.rate.course, RITZ_SPIN_CONSTANT);
        assert_near(scene.spin.rate.value[0], cases[k].rate, 1e-15);
        assert_near(scene.spin.axis[2], 1.0, 0.0);
        assert_int_equal(scene.spin.model, RITZ_SPIN_CONSISTENT);
    }
}

static void a_course_is_read(void **)
{
    RITZ_OWN(ritz_scene)
    profile = scene_of_text(BLADE "spin: {axis: [3, 0, 4], through: [1, 2, 3],"
                                  " profile: [[0, 1], [2, 5], [3, 4]]}\n"
                                  "spin_model: ruthless\n");
    RITZ_OWN(ritz_scene)
    ramp = scene_of_text(
        BLADE "spin: {axis: [0, 1, 0], ramp: {to: 6, seconds: 15}}\n");

    assert_int_equal(profile.spin.rate.course, RITZ_SPIN_PROFILE);
    assert_int_equal(profile.spin.rate.count, 3);
    assert_near(ritz_spin_rate_at(&profile.spin.rate, 2.5), 4.5, 1e-15);
    assert_near(profile.spin.axis[0], 0.6, 1e-15);
    assert_near(profile.spin.through[2], 3.0, 0.0);
    assert_int_equal(profile.spin.model, RITZ_SPIN_RUTHLESS);
    assert_string_equal(ritz_spin_model_name(profile.spin.model), "ruthless");
    assert_int_equal(ramp.spin.rate.course, RITZ_SPIN_RAMP);
    assert_near(ritz_spin_rate_at(&ramp.spin.rate, 20.0), 6.0, 0.0);
}

/* An axis of any length has a direction, and a negligible change a default. */
static void axes_and_errors_are_read(void **)
{
    RITZ_OWN(ritz_scene)
    usual = scene_of_text(BLADE "spin: {axis: [0, 0, 1e200], rate: 1}\n");
    RITZ_OWN(ritz_scene)
    given = scene_of_text(BLADE "spin: {axis: [0, 3e-200, 4e-200], rate: 1, "
                                "negligible: 0.02}\n");

    assert_near(usual.spin.axis[2], 1.0, 0.0);
    assert_near(usual.spin.negligible, 1e-3, 0.0);
    assert_near(given.spin.axis[1], 0.6, 1e-15);
    assert_near(given.spin.negligible, 0.02, 0.0);
}

static void stiffening_is_read(void **)
{
    RITZ_OWN(ritz_scene)
    scene = scene_of_text("scene: s\ncomponents:\n  a: {model: a.h5, "
                          "stiffening: {spin_zz: z, spin_xy: c, tip: t}}\n");
    const char(*name)[RITZ_NAME_SIZE] = scene.component[0].stiffening;

    assert_false(scene.spin.given);
    assert_string_equal(name[RITZ_STIFFENING_ZZ], "z");
    assert_string_equal(name[RITZ_STIFFENING_XY], "c");
    assert_string_equal(name[RITZ_STIFFENING_TIP], "t");
    assert_string_equal(name[RITZ_STIFFENING_XX], "");
}

static void bad_spins_are_refused(void **)
{
    static const refusal cases[] = {
        {BLADE "spin: {rate: 3}\n", "s:4:7: key 'axis' is missing"},
        {BLADE "spin: {axis: [0, 0, 0], rate: 3}\n",
         "s:4:14: the axis has no length"},
        {BLADE "spin: {axis: [0, 0, 1], rate: 1e200}\n",
         "s:4:31: a rate of 1e+200 rad/s is beyond 1e+15 rad/s"},
        {BLADE "spin: {axis: [0, 0, 1], through: [0, 1e300, 0], rate: 1}\n",
         "s:4:34: a point at 1e+300 is beyond 1e+15"},
        {BLADE "spin: {axis: [0, 0, 1], rpm: -1e17}\n",
         "s:4:30: a rate of -1.0472e+16 rad/s is beyond 1e+15 rad/s"},
        {BLADE "spin: {axis: [0, 0, 1], rate: .nan}\n",
         "s:4:31: '.nan' is not a finite number"},
        {BLADE "spin: {axis: [0, 0, 1], rate: inf}\n",
         "s:4:31: 'inf' is not a finite number"},
        {BLADE "spin: {axis: [0, 0, 1], rate: fast}\n",
         "s:4:31: 'fast' is not a finite number"},
        {BLADE "spin: {axis: [0, 0, 1], profile: [[0, 0], [1, 1e16]]}\n",
         "s:4:43: a rate of 1e+16 rad/s is beyond 1e+15 rad/s"},
        {BLADE "spin: {axis: [0, 0, 1], profile: [[0, 0], [1e-20, 1]]}\n",
         "s:4:43: a change of 1 rad/s within 1e-20 s is beyond 1e+15 rad/s^2"},
        {BLADE "spin: {axis: [0, 0, 1], ramp: {to: 1e16, seconds: 1}}\n",
         "s:4:36: a rate of 1e+16 rad/s is beyond 1e+15 rad/s"},
        {BLADE "spin: {axis: [0, 0, 1], ramp: {to: 1, seconds: -2}}\n",
         "s:4:48: a ramp takes some time, not -2 s"},
        {BLADE "spin: {axis: [0, 0, 1], ramp: {to: 1, seconds: 1e-20}}\n",
         "s:4:48: a change of 1 rad/s within 1e-20 s is beyond 1e+15 rad/s^2"},
        {BLADE "spin: {axis: [0, 0, 1], rate: 1, negligible: 0}\n",
         "s:4:46: 0 is not between 0 and 1"},
        {BLADE "spin: {axis: [0, 0, 1]}\n",
         "s:4:7: a spin has one of rate, rpm, hz, profile and ramp"},
        {BLADE "spin: {axis: [0, 0, 1], rate: 1, hz: 2}\n",
         "s:4:7: a spin has one of rate, rpm, hz, profile and ramp"},
        {BLADE "spin: {axis: [0, 0, 1], profile: [[0, 1]]}\n",
         "s:4:34: a profile has 2 to 100000 points, not 1"},
        {BLADE "spin: {axis: [0, 0, 1], profile: [[0, 1], [0, 2]]}\n",
         "s:4:43: times of a profile ascend, 0 does not"},
        {BLADE "spin: {axis: [0, 0, 1], ramp: {to: 1, seconds: 0}}\n",
         "s:4:48: a ramp takes some time, not 0 s"},
        {"scene: s\nplane: xy\ncomponents:\n  a: {model: a.h5}\n"
         "spin: {axis: [1, 0, 0], rate: 1}\n",
         "s:5:14: bodies in a plane turn about its normal alone"},
        {BLADE "spin_model: consistent\n",
         "s:4:13: a spin model goes with a 'spin' alone"},
        {BLADE "spin: {axis: [0, 0, 1], rate: 3}\nspin_model: consistant\n",
         "s:5:13: unknown spin model 'consistant', is 'consistent' meant?"},
        {"scene: s\ncomponents:\n  a: {model: a.h5, stiffening: {}}\n",
         "s:3:32: no load is named: spin_zz: NAME, or another"},
        {"scene: s\ncomponents:\n  a: {model: a.h5, stiffening: "
         "{spin_zx: z}}\n",
         "s:3:33: unknown key 'spin_zx', is 'spin_xx' meant?"},
    };

    ASSERT_ALL_REFUSED(cases);
}

static ritz_status read_spin(void *text)
{
    RITZ_OWN(ritz_scene) scene = {0};

    return ritz_scene_parse("s", text, &scene);
}

static void every_allocation_may_fail(void **)
{
    char profile[] =
        BLADE "spin: {axis: [0, 0, 1], profile: [[0, 1], [2, 5]]}\n";

    assert_survives_every_allocation(read_spin(profile));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_rate_may_be_in_any_unit),
    cmocka_unit_test(a_course_is_read),
    cmocka_unit_test(axes_and_errors_are_read),
    cmocka_unit_test(stiffening_is_read),
    cmocka_unit_test(bad_spins_are_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(scene_spin, tests, NULL, NULL)
