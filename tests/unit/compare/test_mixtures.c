/*
 * COMPARE with any mixture of bases: on the dual-spin spacecraft, whatever the
 * two flexible bodies are reduced by, kept modes are exact against the stage-1
 * system, and with components augmented so is the static gain.
 */
#include "testing.h"

#include "dualspin.h"
#include "scenes.h"

#include "compare/compare.h"

#include <ritz/assembly.h>
#include <ritz/basis.h>

#include <stdlib.h>

#define BODIES                                                                 \
    "scene: mixture\n"                                                         \
    "components:\n"                                                            \
    "  rotor: {model: r.h5}\n"                                                 \
    "  stator: {model: s.h5}\n"                                                \
    "  platform: {model: p.h5}\n"                                              \
    "joints:\n"                                                                \
    "  - {name: clock, between: [rotor/bearing, stator/bearing],\n"            \
    "     type: hinge, axis: [0, 0, 1], angles_deg: [0, 120]}\n"               \
    "  - {name: cone, between: [stator/scan, platform/scan], type: hinge,\n"   \
    "     axis: [0, 1, 0]}\n"

static const char text[] =
    BODIES "inputs: [{name: torque, at: rotor/bearing, component: 6}]\n"
           "outputs: [{name: gyro, at: platform/scan, component: 6}]\n"
           "select: {modes: [1, 2, 3, 4, 6]}\n"
           "augment: component\n";

typedef struct choice {
    const char *basis;
    ritz_span span;
} choice;

/* What rotor and stator are reduced by. */
static const choice mixtures[][2] = {
    {{"craig-bampton", {.modes = 14}}, {"macneal-rubin", {.modes = 4}}},
    {{"macneal", {.modes = 14}}, {"craig-bampton", {.modes = 6}}},
    {{"macneal", {.modes = 14}}, {"macneal", {.modes = 4}}},
    {{"rubin", {.modes = 14}}, {"guyan", {.modes = -1}}},
    {{"krylov-cms-free", {.modes = 16}}, {"krylov-cms-fixed", {.modes = 6}}},
    {{"inertia-relief", {.modes = 14}}, {"rigid", {.modes = -1}}},
};

/* Kept modes are those of stage 1 to rounding, at listed angles. */
static void assert_kept(const ritz_comparison *c)
{
    for (int64_t k = 0; k < c->first_system.num_configurations; k++) {
        assert_int_equal(c->row[k].num_kept, 5);
        assert_true(c->row[k].frequency_error <= c->row[k].allowed);
        assert_near(c->row[k].mac, 1.0, 1e-8); /* measured: 3e-11 */
        assert_int_equal(c->second_system.configuration[k].num_rigid, 8);
    }
}

static void any_mixture_of_bases_keeps_its_modes_and_gain(void **)
{
    ritz_component component[3] = {0};

    dualspin_or_skip();
    for (int b = 0; b < 3; b++)
        assert_ok(dualspin_component(b, &component[b]));
    for (size_t m = 0; m < sizeof mixtures / sizeof *mixtures; m++) {
        ritz_scene scene = {0};
        ritz_stage stage = {0};
        ritz_comparison c = {0};
        ritz_reduced body[3] = {0};

        assert_ok(ritz_scene_parse("mixture.yaml", text, &scene));
        for (int b = 0; b < 2; b++)
            assert_ok(reduce_to(&component[b],
                                ritz_method_find(mixtures[m][b].basis),
                                &mixtures[m][b].span, &body[b]));
        assert_ok(reduce_with(&component[2], &ritz_method_rigid, -1, &body[2]));
        assert_ok(ritz_stage_from(&scene, body, &stage));
        assert_ok(ritz_compare(&stage, &c));
        assert_kept(&c);
        for (int64_t k = 0; k < c.num_rows; k++)
            assert_true(c.row[k].gain_error < 1e-8); /* measured: 1e-9 */
        ritz_comparison_free(&c);
        ritz_stage_free(&stage);
        ritz_scene_free(&scene);
    }
    for (int b = 0; b < 3; b++)
        ritz_component_free(&component[b]);
}

/* Inputs and outputs where motions without mass meet. */
static const char massless[] =
    BODIES "inputs:\n"
           "  - {name: f1, at: rotor/bearing, component: 1}\n"
           "  - {name: f4, at: rotor/bearing, component: 4}\n"
           "outputs:\n"
           "  - {name: g1, at: rotor/bearing, component: 1}\n"
           "  - {name: g4, at: stator/bearing, component: 4}\n"
           "select: {modes: [1, 2, 3]}\n";

/*
 * Both bodies by macneal: their M is singular, and forces act where it is. The
 * gain is kept at both levels; without the motions that have no mass it would
 * be wrong by 6e-4.
 */
static void motions_without_mass_are_kept_whole(void **)
{
    static const ritz_augment levels[] = {RITZ_AUGMENT_SYSTEM,
                                          RITZ_AUGMENT_COMPONENT};
    static const int64_t modes[] = {20, 6};
    RITZ_OWN(ritz_scene) scene = {0};

    dualspin_or_skip();
    assert_ok(ritz_scene_parse("massless.yaml", massless, &scene));
    for (int pass = 0; pass < 2; pass++) {
        ritz_stage stage = {0};
        ritz_comparison c = {0};
        ritz_reduced body[3] = {0};

        for (int b = 0; b < 3; b++) {
            ritz_component component = {0};

            assert_ok(dualspin_component(b, &component));
            assert_ok(reduce_with(
                &component, b < 2 ? &ritz_method_macneal : &ritz_method_rigid,
                b < 2 ? modes[b] : -1, &body[b]));
            ritz_component_free(&component);
        }
        scene.augment = levels[pass];
        assert_ok(ritz_stage_from(&scene, body, &stage));
        assert_ok(ritz_compare(&stage, &c));
        assert_true(c.V[0].ncol < c.V[0].nrow);
        for (int k = 0; k < 2; k++) {
            assert_true(c.row[k].gain_error < 1e-8); /* measured: 3e-9 */
            assert_true(c.row[k].frequency_error <= c.row[k].allowed);
        }
        ritz_comparison_free(&c);
        ritz_stage_free(&stage);
    }
}

/* L L' = M, or M + K / lambda where M has two dofs that are nearly one. */
static void a_mass_that_is_nearly_singular_is_filled_up(void **)
{
    static const double correlation[] = {0.5, 1.0 - 1e-15, 1.0};
    const double one[2] = {1.0, 1.0};

    for (int k = 0; k < 3; k++) {
        double m[] = {1.0, correlation[k], correlation[k], 1.0};
        double stiffness[] = {4.0, 0.0, 0.0, 4.0};
        const ritz_reduced body = {.M = {2, 2, m}, .K = {2, 2, stiffness}};
        ritz_dense L = {0};
        bool mixed = false;

        assert_ok(ritz_mass_factor(&body, one, &L, &mixed));
        assert_true(mixed == (k > 0));
        /* 1 + 4 / 4: the lambda of this body is 4 */
        assert_near(L.val[0] * L.val[0], mixed ? 2.0 : 1.0, 1e-15);
        assert_near(L.val[0] * L.val[1], correlation[k], 1e-15);
        ritz_dense_free(&L);
    }
}

static void a_motion_without_mass_and_stiffness_is_refused(void **)
{
    const double one[2] = {1.0, 1.0};
    double m[] = {1.0, 0.0, 0.0, 0.0};
    const ritz_reduced body = {.M = {2, 2, m}, .K = {2, 2, m}};
    RITZ_OWN(ritz_dense) L = {0};
    bool mixed = false;

    assert_fails(ritz_mass_factor(&body, one, &L, &mixed), RITZ_ERR_SINGULAR,
                 "a motion has neither mass nor stiffness");
}

/* The second stage's bodies, given as models: stage one of another scene. */
static void reduced_bodies_are_reduced_once_more(void **)
{
    RITZ_OWN(ritz_scene) scene = {0};
    RITZ_OWN(ritz_stage) stage = {0};
    RITZ_OWN(ritz_comparison) c = {0}, again = {0};
    int64_t modes[] = {0, 1, 2};

    dualspin_or_skip();
    assert_ok(dualspin_stage(&scene, &stage));
    assert_ok(ritz_compare(&stage, &c));
    scene.select = RITZ_SELECT_LISTED;
    scene.num_select_modes = 3;
    scene.select_mode = modes;
    assert_ok(ritz_compare(&c.second, &again));
    scene.select_mode = NULL;
    for (int64_t k = 0; k < 6; k++) {
        assert_true(again.row[k].frequency_error <= again.row[k].allowed);
        assert_true(again.row[k].gain_error < 1e-8);
    }
    assert_true(again.V[0].ncol < c.V[0].ncol);
    ritz_comparison_free(&again);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(any_mixture_of_bases_keeps_its_modes_and_gain),
    cmocka_unit_test(motions_without_mass_are_kept_whole),
    cmocka_unit_test(a_mass_that_is_nearly_singular_is_filled_up),
    cmocka_unit_test(a_motion_without_mass_and_stiffness_is_refused),
    cmocka_unit_test(reduced_bodies_are_reduced_once_more),
};

TEST_MODULE(mixtures, tests, NULL, NULL)
