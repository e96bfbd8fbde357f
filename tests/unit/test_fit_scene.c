/* The smallest scene that meets a tolerance: what is caught, what comes out. */
#include "testing.h"

#include "dualspin.h"
#include "fit_scenes.h"
#include "folder.h"
#include "scenes.h"

#include <ritz/fit.h>

#include <stdio.h>
#include <stdlib.h>

static const ritz_method *const two[] = {&ritz_method_craig_bampton,
                                         &ritz_method_macneal_rubin};

static ritz_fit_request quick(const char *tolerance)
{
    ritz_fit_request request = fit_scenes_quick(tolerance);

    request.methods = two;
    request.num_methods = 2;
    return request;
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
    fit_scenes_store_spacecraft();
    folder_parse(fit_scenes_spacecraft, &scene);
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
    ritz_fit_path path = {0};
    ritz_reduced *body = NULL;
    int64_t columns = 0;

    (void)state;
    request.num_methods = 1;
    fit_scenes_store_beams(4, 6);
    folder_parse(fit_scenes_beams, &scene);
    assert_ok(ritz_fitter_scene(&scene, &request, &fitter));
    assert_ok(ritz_fitter_search(fitter, &fit));
    assert_ok(ritz_fitter_system(fitter, &fit.candidate[fit.chosen], &body,
                                 &path, &system));
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
    ritz_fit_path_free(&path);
    ritz_system_free(&system);
    ritz_fit_free(&fit);
    ritz_fitter_free(&fitter);
    ritz_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_meets_the_listed_angles_alone_is_caught),
        cmocka_unit_test(the_answer_is_a_system_of_nested_bodies),
    };

    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
