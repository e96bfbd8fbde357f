/*
 * A scene too large for its full system is compared with a rich first stage:
 * the answer has to be that which the full system gives. Small scenes are
 * fitted both ways.
 */
#include "testing.h"

#include "dualspin.h"
#include "fit_scenes.h"
#include "folder.h"

#include "fit/fit_parts.h"

#include <inttypes.h>
#include <stdlib.h>

static const ritz_method *const two[] = {&ritz_method_craig_bampton,
                                         &ritz_method_macneal_rubin};

static const char across[] =
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

/* A rich stage finds what the full system does, and what it finds holds there:
   of the full system's own errors. */
static void assert_same_both_ways(const char *text, ritz_fit_request request)
{
    ritz_fitter *fitter[2] = {NULL, NULL};
    ritz_fit fit[2] = {0};
    ritz_fit_candidate again = {0};
    const ritz_fit_candidate *full = NULL, *rich = NULL;
    ritz_scene scene = {0};
    char what[256];

    folder_parse(text, &scene);
    for (int k = 0; k < 2; k++) {
        assert_ok(ritz_fitter_scene(&scene, &request, &fitter[k]));
        assert_ok(ritz_fitter_search(fitter[k], &fit[k]));
        if (fit[k].chosen < 0)
            fail_msg("%s", fit[k].why);
        request.most_full = 10;
    }
    ritz_fitter_describe(fitter[1], sizeof what, what);
    assert_non_null(strstr(what, "a rich first stage"));
    full = &fit[0].candidate[fit[0].chosen];
    rich = &fit[1].candidate[fit[1].chosen];
    if (llabs(full->order - rich->order) > 1)
        fail_msg("%" PRId64 " against the full system, %" PRId64
                 " against a rich stage",
                 full->order, rich->order);
    assert_ok(ritz_fitter_try(fitter[0], rich->method, rich->modes, &again));
    assert_true(again.feasible);
    /* a tenth of the tolerance is what the rich stage may leave */
    assert_near(again.excess, rich->excess, 0.1);
    ritz_fit_candidate_free(&again);
    for (int k = 0; k < 2; k++) {
        ritz_fit_free(&fit[k]);
        ritz_fitter_free(&fitter[k]);
    }
    ritz_scene_free(&scene);
}

static void beams_are_fitted_as_against_their_full_system(void **state)
{
    static const struct {
        int64_t left, right;
        const char *text, *tolerance;
    } cases[] = {
        {10, 14, fit_scenes_beams, "response=1e-2"},
        {7, 9, fit_scenes_beams, "frequency=1e-3"},
        {9, 12, across, "frequency=1e-4,response=1e-3"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        ritz_fit_request request = fit_scenes_quick(cases[k].tolerance);

        request.methods = two;
        request.num_methods = 2;
        fit_scenes_store_beams(cases[k].left, cases[k].right);
        assert_same_both_ways(cases[k].text, request);
    }
}

/* 10 * 6.4e-5 is the finest tolerance that eight times the band serves. */
static void fine_tolerances_ask_for_a_richer_stage(void **state)
{
    ritz_verify_request limits = RITZ_VERIFY_NONE;

    (void)state;
    limits.limit_response = 1e-2;
    assert_near(ritz_fit_rich_to(&limits), 8.0, 0.0);
    limits.limit_frequency = 1.6e-4;
    assert_near(ritz_fit_rich_to(&limits), 16.0, 1e-12);
    limits.limit_mac = 1.0 - 1e-9;
    assert_near(ritz_fit_rich_to(&limits), 32.0, 0.0);
}

static void
a_turning_spacecraft_is_fitted_as_against_its_full_system(void **state)
{
    ritz_fit_request request = fit_scenes_quick("flexible=1e-1");

    (void)state;
    if (!dualspin_is_there()) {
        print_message("RITZ_DATA is not set\n");
        skip();
    }
    request.methods = two + 1;
    request.num_methods = 1;
    fit_scenes_store_spacecraft();
    assert_same_both_ways(fit_scenes_spacecraft, request);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beams_are_fitted_as_against_their_full_system),
        cmocka_unit_test(fine_tolerances_ask_for_a_richer_stage),
        cmocka_unit_test(
            a_turning_spacecraft_is_fitted_as_against_its_full_system),
    };

    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
