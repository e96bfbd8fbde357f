/*
 * A scene too large for its full system is compared with a rich first stage:
 * the answer has to be that which the full system gives. Small scenes are
 * fitted both ways.
 */
#include "testing.h"

#include "answers.h"
#include "dualspin.h"
#include "fit_scenes.h"
#include "folder.h"

#include "fit/fitter.h"

#include <inttypes.h>
#include <stdlib.h>

static const ritz_method *const two[] = {&ritz_method_craig_bampton,
                                         &ritz_method_macneal_rubin};

/* A rich stage finds what the full system does, and what it finds holds there:
   of the full system's own errors. */
static void assert_same_both_ways(const char *text, ritz_fit_request request)
{
    answer a[2] = {0};
    ritz_fit_candidate again = {0};
    const ritz_fit_candidate *full = NULL, *rich = NULL;
    char what[256];

    answer_search(text, &request, &a[0]);
    request.most_full = 10;
    answer_search(text, &request, &a[1]);
    ritz_fitter_describe(a[1].fitter, sizeof what, what);
    assert_non_null(strstr(what, "a rich first stage"));
    full = answer_chosen(&a[0]);
    rich = answer_chosen(&a[1]);
    if (llabs(full->order - rich->order) > 1)
        fail_msg("%" PRId64 " against the full system, %" PRId64
                 " against a rich stage",
                 full->order, rich->order);
    assert_ok(ritz_fitter_try(a[0].fitter, rich->method, rich->modes, &again));
    assert_true(again.feasible);
    /* a tenth of the tolerance is what the rich stage may leave */
    assert_near(again.ratio, rich->ratio, 0.1);
    ritz_fit_candidate_free(&again);
    answer_free(&a[0]);
    answer_free(&a[1]);
}

static void beams_are_fitted_as_against_their_full_system(void **state)
{
    static const struct {
        int64_t left, right;
        const char *text, *tolerance;
    } cases[] = {
        {10, 14, fit_scenes_beams, "response=1e-2"},
        {7, 9, fit_scenes_beams, "frequency=1e-3"},
        {9, 12, fit_scenes_driven, "frequency=1e-4,response=1e-3"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        fit_scenes_store_beams(cases[k].left, cases[k].right);
        assert_same_both_ways(cases[k].text,
                              fit_scenes_by(two, 2, cases[k].tolerance));
    }
}

/* 10 * 6.4e-5 is the finest tolerance that eight times the band serves. */
static void fine_tolerances_ask_for_a_richer_stage(void **state)
{
    ritz_verify_request limits = RITZ_VERIFY_NONE;

    (void)state;
    limits.limit[RITZ_MEASURE_RESPONSE] = 1e-2;
    assert_near(ritz_fit_rich_to(&limits), 8.0, 0.0);
    limits.limit[RITZ_MEASURE_FREQUENCY] = 1.6e-4;
    assert_near(ritz_fit_rich_to(&limits), 16.0, 1e-12);
    limits.limit[RITZ_MEASURE_MAC] = 1.0 - 1e-9;
    assert_near(ritz_fit_rich_to(&limits), 32.0, 0.0);
}

static void
a_turning_spacecraft_is_fitted_as_against_its_full_system(void **state)
{
    (void)state;
    dualspin_or_skip();
    fit_scenes_store_spacecraft();
    assert_same_both_ways(fit_scenes_spacecraft,
                          fit_scenes_by(two + 1, 1, "flexible=1e-1"));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(beams_are_fitted_as_against_their_full_system),
    cmocka_unit_test(fine_tolerances_ask_for_a_richer_stage),
    cmocka_unit_test(a_turning_spacecraft_is_fitted_as_against_its_full_system),
};

TEST_MODULE(fit_rich, tests, folder_make, folder_remove)
