/* The smallest scene that meets a tolerance: what is caught, what comes out. */
#include "testing.h"

#include "answers.h"
#include "dualspin.h"
#include "fit_scenes.h"
#include "folder.h"

static const ritz_method *const one[] = {&ritz_method_craig_bampton};

/*
 * At right angles the two bodies do not feel what they feel between: what is
 * made for the listed angles alone is caught at random ones.
 */
static void what_meets_the_listed_angles_alone_is_caught(void **state)
{
    ritz_fit_request request = fit_scenes_by(one, 1, "flexible=1e-1");
    RITZ_OWN(answer) a = {0};
    int64_t caught = 0;

    (void)state;
    dualspin_or_skip();
    request.num_between = 4;
    fit_scenes_store_spacecraft();
    answer_search(fit_scenes_spacecraft, &request, &a);
    assert_true(a.fit.chosen >= 0);
    for (int64_t k = 0; k < a.fit.count; k++) {
        const ritz_fit_candidate *c = &a.fit.candidate[k];

        caught += c->unconfirmed;
        assert_false(c->unconfirmed && c->feasible);
    }
    assert_true(caught > 0);
    assert_non_null(strstr(a.fit.why, "met the grid and failed at random"));
}

/* The system has the order that was found, and bodies that are nested. */
static void the_answer_is_a_system_of_nested_bodies(void **state)
{
    const ritz_fit_request request = fit_scenes_by(one, 1, "response=1e-2");
    const ritz_fit_candidate *chosen = NULL;
    RITZ_OWN(answer) a = {0};

    (void)state;
    fit_scenes_store_beams(4, 6);
    answer_search(fit_scenes_beams, &request, &a);
    chosen = answer_chosen(&a);
    answer_system(&a, chosen);
    assert_int_equal(a.system.num_configurations, 1);
    assert_int_equal(a.system.configuration[0].K.ncol, chosen->order);
    for (int k = 0; k < 2; k++)
        assert_true(a.body.item[k].nested.smallest > 0);
    assert_int_equal(answer_columns(&a), chosen->columns);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_meets_the_listed_angles_alone_is_caught),
    cmocka_unit_test(the_answer_is_a_system_of_nested_bodies),
};

TEST_MODULE(fit_scene, tests, folder_make, folder_remove)
