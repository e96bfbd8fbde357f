/* The smallest scene that meets a tolerance, against exhaustive search. */
#include "testing.h"

#include "dualspin.h"
#include "folder.h"
#include "frame.h"
#include "scenes.h"

#include <ritz/fit.h>

#include <stdio.h>
#include <stdlib.h>

static const ritz_fit_request plain = RITZ_FIT_NONE;
static const ritz_method *const two[] = {&ritz_method_craig_bampton,
                                         &ritz_method_macneal_rubin};

static ritz_fit_request quick(const char *tolerance)
{
    ritz_fit_request request = plain;

    request.num_random = 50;
    request.num_between = 2;
    request.costs = false;
    request.methods = two;
    request.num_methods = 2;
    assert_ok(ritz_tolerance_take(tolerance, &request.tolerance));
    return request;
}

/* A clamped beam of `left` elements, one of `right` fixed to its end. */
static void store_beams(int64_t left, int64_t right)
{
    const int64_t elements[] = {left, right};
    static const char *const file[] = {"left.h5", "right.h5"};

    for (int k = 0; k < 2; k++) {
        frame_section section = frame_mcdaniel;
        ritz_component beam = {0};

        section.offset = k == 0 ? 0.0 : 0.5 * (double)left;
        section.inertia *= k == 0 ? 1.0 : 0.5;
        assert_ok(frame_component(elements[k], 0.5, &section, k == 0, false,
                                  k == 0 ? 0 : 100, &beam));
        assert_ok(add_port(&beam, "joint", k == 0 ? left : 100));
        if (k == 1)
            assert_ok(add_port(&beam, "tip", 100 + right));
        folder_store(file[k], &beam);
        ritz_component_free(&beam);
    }
}

static const char fixed_beams[] =
    "scene: two beams\n"
    "components:\n"
    "  left: {model: left.h5, basis: craig-bampton, modes: 4}\n"
    "  right: {model: right.h5, basis: craig-bampton, modes: 4}\n"
    "joints:\n"
    "  - {name: j, between: [left/joint, right/joint], type: fixed}\n"
    "inputs: [{name: f, at: right/tip, component: 2}]\n"
    "outputs: [{name: y, at: right/tip, component: 2}]\n"
    "band_hz: [0, 0.2]\n"
    "damping: {modal: 0.01}\n";

static const char mixed_beams[] =
    "scene: an arm\n"
    "components:\n"
    "  left: {model: left.h5, basis: craig-bampton, modes: 4}\n"
    "  right: {model: right.h5, basis: craig-bampton, modes: 4}\n"
    "joints:\n"
    "  - {name: j, between: [left/joint, right/joint], type: fixed}\n"
    "inputs: [{name: f, at: right/tip, component: 1}]\n"
    "outputs: [{name: y, at: right/tip, component: 1},"
    " {name: z, at: left/joint, component: 2}]\n"
    "band_hz: [0, 0.5]\n"
    "damping: {modal: 0.01}\n";

static const char driven_beams[] =
    "scene: driven at the joint\n"
    "components:\n"
    "  left: {model: left.h5, basis: craig-bampton, modes: 4}\n"
    "  right: {model: right.h5, basis: craig-bampton, modes: 4}\n"
    "joints:\n"
    "  - {name: j, between: [left/joint, right/joint], type: fixed}\n"
    "inputs: [{name: f, at: left/joint, component: 2}]\n"
    "outputs: [{name: y, at: right/tip, component: 2},"
    " {name: z, at: right/tip, component: 6}]\n"
    "band_hz: [0, 0.3]\n"
    "damping: {modal: 0.005}\n";

/* Every pair of numbers of modes up to `most` each, of every method. */
static int64_t exhaust(ritz_fitter *fitter, const ritz_fit *fit, int64_t most)
{
    int64_t least = INT64_MAX;

    for (int64_t m = 0; m < fit->num_methods; m++)
        for (int64_t i = 0; i <= most; i++)
            for (int64_t j = 0; j <= most; j++) {
                const int64_t modes[] = {i, j};
                ritz_fit_candidate c = {0};

                assert_ok(ritz_fitter_try(fitter, fit->method[m], modes, &c));
                if (c.feasible && c.order < least)
                    least = c.order;
                ritz_fit_candidate_free(&c);
            }
    return least;
}

static void assert_within_one(const ritz_scene *scene,
                              const ritz_fit_request *request, int64_t most)
{
    ritz_fitter *fitter = NULL;
    ritz_fit fit = {0};
    int64_t least = 0;
    int64_t order = 0;

    assert_ok(ritz_fitter_scene(scene, request, &fitter));
    assert_ok(ritz_fitter_search(fitter, &fit));
    if (fit.chosen < 0)
        fail_msg("%s", fit.why);
    order = fit.candidate[fit.chosen].order;
    least = exhaust(fitter, &fit, most);
    assert_true(least < INT64_MAX);
    if (order > least + 1 || order < least)
        fail_msg("%s\nfound %d, exhaustive search %d", fit.why, (int)order,
                 (int)least);
    ritz_fit_free(&fit);
    ritz_fitter_free(&fitter);
}

static void two_beams_are_fitted_within_one(void **state)
{
    const ritz_fit_request request = quick("response=1e-2");
    ritz_scene scene = {0};

    (void)state;
    store_beams(4, 6);
    folder_parse(fixed_beams, &scene);
    assert_within_one(&scene, &request, 6);
    ritz_scene_free(&scene);
}

/* Other lengths, ends and tolerances: each a scene of its own. */
static void other_beams_are_fitted_within_one(void **state)
{
    static const struct {
        int64_t left, right;
        const char *text, *tolerance;
    } cases[] = {
        {7, 3, fixed_beams, "frequency=1e-3"},
        {3, 8, fixed_beams, "response=1e-3,gain=1e-2"},
        {5, 5, driven_beams, "response=1e-2,frequency=1e-2"},
        {4, 7, driven_beams, "frequency=1e-4,response=1e-3"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const ritz_fit_request request = quick(cases[k].tolerance);
        ritz_scene scene = {0};

        store_beams(cases[k].left, cases[k].right);
        folder_parse(cases[k].text, &scene);
        assert_within_one(&scene, &request, 10);
        ritz_scene_free(&scene);
    }
}

static void beams_along_and_across_are_fitted_within_one(void **state)
{
    const ritz_fit_request request = quick("frequency=1e-2,response=1e-1");
    ritz_scene scene = {0};

    (void)state;
    store_beams(6, 3);
    folder_parse(mixed_beams, &scene);
    assert_within_one(&scene, &request, 6);
    ritz_scene_free(&scene);
}

/* The spacecraft at two angles, rotor and stator flexible. */
static void store_spacecraft(ritz_scene *scene)
{
    static const char *const file[] = {"rotor.h5", "stator.h5", "platform.h5"};

    for (int k = 0; k < 3; k++) {
        ritz_component part = {0};

        assert_ok(dualspin_component(k, &part));
        folder_store(file[k], &part);
        ritz_component_free(&part);
    }
    folder_parse(
        "scene: spacecraft\n"
        "components:\n"
        "  rotor: {model: rotor.h5, basis: macneal-rubin, modes: 6}\n"
        "  stator: {model: stator.h5, basis: macneal-rubin, modes: 6}\n"
        "  platform: {model: platform.h5, basis: rigid}\n"
        "joints:\n"
        "  - {name: clock, between: [rotor/bearing, stator/bearing],"
        " type: hinge, axis: [0, 0, 1], angles_deg: [0, 90]}\n"
        "  - {name: cone, between: [stator/scan, platform/scan],"
        " type: hinge, axis: [0, 1, 0], angles_deg: [0]}\n"
        "inputs: [{name: torque, at: rotor/bearing, component: 6,"
        " against: stator/bearing}]\n"
        "outputs: [{name: gyro, at: platform/scan, component: 6}]\n"
        "band_hz: [0, 5]\n"
        "damping: {modal: 0.002}\n",
        scene);
}

static void the_spacecraft_is_fitted_within_one(void **state)
{
    ritz_fit_request request = quick("flexible=1e-1");
    ritz_scene scene = {0};

    (void)state;
    if (!dualspin_is_there()) {
        print_message("RITZ_DATA is not set\n");
        skip();
    }
    request.num_methods = 1;
    request.methods = two + 1;
    store_spacecraft(&scene);
    assert_within_one(&scene, &request, 3);
    ritz_scene_free(&scene);
}

/*
 * At right angles the two bodies do not feel what they feel between: what is
 * made for the listed angles alone is caught at random ones.
 */
static void what_meets_the_listed_angles_alone_is_caught(void **state)
{
    ritz_fit_request request = quick("flexible=1e-1");
    ritz_scene scene = {0};
    ritz_fitter *fitter = NULL;
    ritz_fit fit = {0};
    int64_t caught = 0;

    (void)state;
    if (!dualspin_is_there()) {
        print_message("RITZ_DATA is not set\n");
        skip();
    }
    request.num_methods = 1;
    request.num_between = 4;
    store_spacecraft(&scene);
    assert_ok(ritz_fitter_scene(&scene, &request, &fitter));
    assert_ok(ritz_fitter_search(fitter, &fit));
    assert_true(fit.chosen >= 0);
    for (int64_t k = 0; k < fit.count; k++) {
        const ritz_fit_candidate *c = &fit.candidate[k];

        caught += c->caught;
        assert_false(c->caught && c->feasible);
    }
    assert_true(caught > 0);
    assert_non_null(strstr(fit.why, "met the grid and failed at random"));
    ritz_fit_free(&fit);
    ritz_fitter_free(&fitter);
    ritz_scene_free(&scene);
}

/* The system has the order that was found, and bodies that are nested. */
static void the_answer_is_a_system_of_nested_bodies(void **state)
{
    ritz_fit_request request = quick("response=1e-2");
    ritz_scene scene = {0};
    ritz_fitter *fitter = NULL;
    ritz_fit fit = {0};
    ritz_system system = {0};
    ritz_reduced *body = NULL;
    int64_t columns = 0;

    (void)state;
    request.num_methods = 1;
    store_beams(4, 6);
    folder_parse(fixed_beams, &scene);
    assert_ok(ritz_fitter_scene(&scene, &request, &fitter));
    assert_ok(ritz_fitter_search(fitter, &fit));
    assert_ok(
        ritz_fitter_system(fitter, &fit.candidate[fit.chosen], &body, &system));
    assert_int_equal(system.num_configurations, 1);
    assert_int_equal(system.configuration[0].K.ncol,
                     fit.candidate[fit.chosen].order);
    for (int k = 0; k < 2; k++) {
        columns += body[k].K.ncol;
        assert_true(body[k].nested.smallest > 0);
        ritz_reduced_free(&body[k]);
    }
    assert_int_equal(columns, fit.candidate[fit.chosen].columns);
    free(body);
    ritz_system_free(&system);
    ritz_fit_free(&fit);
    ritz_fitter_free(&fitter);
    ritz_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_beams_are_fitted_within_one),
        cmocka_unit_test(other_beams_are_fitted_within_one),
        cmocka_unit_test(beams_along_and_across_are_fitted_within_one),
        cmocka_unit_test(the_spacecraft_is_fitted_within_one),
        cmocka_unit_test(what_meets_the_listed_angles_alone_is_caught),
        cmocka_unit_test(the_answer_is_a_system_of_nested_bodies),
    };

    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
