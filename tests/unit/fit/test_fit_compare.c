/* COMPARE among the methods of a scene: what its bodies hold, how small. */
#include "testing.h"

#include "answers.h"
#include "dualspin.h"
#include "fit/fitter.h"
#include "fit_scenes.h"
#include "folder.h"
#include "frame.h"

static const ritz_method *const compare[] = {&ritz_fit_compare};

static ritz_fit_request alone(const char *tolerance)
{
    return fit_scenes_by(compare, 1, tolerance);
}

/* Two beams, ready to be fitted by it alone. */
static void open_beams(int64_t left, int64_t right, answer *out)
{
    const ritz_fit_request request = alone("response=1e-2");

    fit_scenes_store_beams(left, right);
    answer_open(fit_scenes_beams, &request, out);
}

/* Every pair of numbers of directions that both bodies have. */
static int64_t exhaust(ritz_fitter *fitter, int64_t most)
{
    int64_t least = INT64_MAX;

    for (int64_t i = 0; i <= most; i++)
        for (int64_t j = 0; j <= most; j++) {
            const int64_t modes[] = {i, j};
            RITZ_OWN(ritz_fit_candidate) c = {0};

            assert_ok(ritz_fitter_try(fitter, &ritz_fit_compare, modes, &c));
            if (c.feasible && c.order < least)
                least = c.order;
        }
    return least;
}

static void assert_within_one(const char *text, const char *tolerance,
                              int64_t most)
{
    const ritz_fit_request request = alone(tolerance);
    RITZ_OWN(answer) a = {0};
    int64_t order = 0;
    int64_t least = 0;

    answer_search(text, &request, &a);
    order = answer_chosen(&a)->order;
    least = exhaust(a.fitter, most);
    assert_true(least < INT64_MAX);
    if (order > least + 1)
        fail_msg("%s\nfound %d, exhaustive search %d", a.fit.why, (int)order,
                 (int)least);
}

static void beams_are_fitted_within_one(void **state)
{
    static const struct {
        int64_t left, right;
        const char *tolerance;
    } cases[] = {{4, 6, "response=1e-2"},
                 {7, 3, "frequency=1e-3"},
                 {3, 8, "response=1e-3,gain=1e-2"},
                 {5, 5, "response=1e-2,frequency=1e-2"}};

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        fit_scenes_store_beams(cases[k].left, cases[k].right);
        assert_within_one(fit_scenes_beams, cases[k].tolerance, 8);
    }
}

/* Where modes weigh by what inputs and outputs see of them. */
static void of_a_spacecraft_it_is_the_smallest(void **state)
{
    static const ritz_method *const two[] = {&ritz_method_macneal_rubin,
                                             &ritz_fit_compare};
    const ritz_fit_request request = fit_scenes_by(two, 2, "flexible=1e-1");
    RITZ_OWN(answer) a = {0};

    (void)state;
    dualspin_or_skip();
    fit_scenes_store_spacecraft();
    answer_search(fit_scenes_spacecraft, &request, &a);
    assert_true(a.fit.best[0] >= 0 && a.fit.best[1] >= 0);
    assert_ptr_equal(answer_chosen(&a)->method, &ritz_fit_compare);
    assert_true(a.fit.candidate[a.fit.best[1]].order <
                a.fit.candidate[a.fit.best[0]].order);
}

/* Bodies of the answer have its number of columns and name the method. */
static void its_bodies_are_nested_and_say_so(void **state)
{
    const ritz_fit_candidate *chosen = NULL;
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_beams(4, 6, &a);
    assert_ok(ritz_fitter_search(a.fitter, &a.fit));
    chosen = answer_chosen(&a);
    for (int k = 0; k < 2; k++) /* the first rung: neither is held */
        assert_int_equal(a.fit.candidate[0].modes[k], 1);
    assert_string_equal(a.fit.candidate[0].refusal, "");
    assert_true(chosen->feasible && chosen->making.wall > 0.0);
    answer_system(&a, chosen);
    assert_int_equal(a.system.configuration[0].K.ncol, chosen->order);
    for (int k = 0; k < 2; k++) {
        assert_string_equal(a.body.item[k].origin.method, "compare");
        assert_true(a.body.item[k].nested.smallest > 0);
        assert_true(a.body.item[k].T.ncol == a.body.item[k].K.ncol);
    }
    assert_int_equal(answer_columns(&a), chosen->columns);
}

static void it_is_compared_at_equal_order(void **state)
{
    static const ritz_method *const two[] = {&ritz_method_craig_bampton,
                                             &ritz_fit_compare};
    const ritz_fit_request request = fit_scenes_by(two, 2, "response=1e-2");
    RITZ_OWN(answer) a = {0};
    int64_t at[2] = {-1, -1};

    (void)state;
    fit_scenes_store_beams(4, 6);
    answer_search(fit_scenes_beams, &request, &a);
    assert_ok(ritz_fitter_equal(a.fitter, 10, &a.fit, at));
    for (int m = 0; m < 2; m++) {
        assert_true(at[m] >= 0);
        assert_ptr_equal(a.fit.candidate[at[m]].method, two[m]);
        assert_true(a.fit.candidate[at[m]].order <= 10);
    }
    assert_int_equal(a.fit.candidate[at[1]].order, 10); /* steps are of one */
}

/* Where no methods are named it is among them, of a scene and of no other. */
static void it_is_tried_of_a_scene_without_being_named(void **state)
{
    const ritz_fit_request request = fit_scenes_quick("response=1e-1");
    RITZ_OWN(answer) a = {0};
    int64_t last = 0;

    (void)state;
    fit_scenes_store_beams(2, 2);
    answer_search(fit_scenes_beams, &request, &a);
    last = a.fit.num_methods - 1;
    assert_ptr_equal(a.fit.method[last], &ritz_fit_compare);
    assert_true(a.fit.best[last] >= 0);
}

/* The last rung of its ladder has all that there is, and no more. */
static void its_ladder_ends_with_all_directions(void **state)
{
    RITZ_OWN(answer) a = {0};
    int64_t modes[2] = {0};

    (void)state;
    open_beams(2, 2, &a);
    assert_ok(ritz_fit_second_make(a.fitter, a.fitter->rich_hz, NULL));
    ritz_fit_rung(a.fitter, &ritz_fit_compare,
                  ritz_fit_rungs(a.fitter, &ritz_fit_compare), modes);
    for (int k = 0; k < 2; k++)
        assert_int_equal(modes[k], a.fitter->second.body.item[k].K.ncol);
    assert_ok(ritz_fitter_try(a.fitter, &ritz_fit_compare, modes, &a.whole));
    assert_string_equal(a.whole.refusal, "");
    assert_true(a.whole.feasible);
}

static void assert_refused(ritz_fitter *fitter, const int64_t *modes,
                           const char *words)
{
    RITZ_OWN(ritz_fit_candidate) c = {0};

    assert_ok(ritz_fitter_try(fitter, &ritz_fit_compare, modes, &c));
    assert_false(c.feasible);
    if (!strstr(c.refusal, words))
        fail_msg("'%s' says nothing of '%s'", c.refusal, words);
}

static void what_it_cannot_make_it_refuses(void **state)
{
    static const int64_t none[] = {0, 3};
    static const int64_t many[] = {3, 1000};
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_beams(2, 2, &a);
    assert_refused(a.fitter, none, "'left' would not move at all");
    assert_refused(a.fitter, many, "composite vectors, and not 1000");
}

/* A component has no configurations whose modes it could be made of. */
static void of_a_component_it_is_refused(void **state)
{
    static const int64_t tip = 4; /* across */
    ritz_fit_request request = alone("response=1e-2");
    RITZ_OWN(ritz_component) beam = {0};
    RITZ_OWN(ritz_fitter) *fitter = NULL;
    RITZ_OWN(ritz_fit) fit = {0};

    (void)state;
    request.tolerance.band_hz[1] = 0.2;
    assert_ok(ritz_damping_parse("modal 0.01", &request.tolerance.damping));
    assert_ok(frame_component(2, 0.5, &frame_mcdaniel, true, false, 0, &beam));
    assert_ok(frame_io(&beam, 1, &tip, 1, &tip));
    assert_ok(ritz_fitter_new(&beam, &request, &fitter));
    assert_ok(ritz_fitter_search(fitter, &fit));
    assert_int_equal(fit.chosen, -1);
    assert_non_null(strstr(fit.why, "compare: it is made of the modes of a "
                                    "scene, and this is a component"));
}

static void methods_are_found_by_name(void **state)
{
    (void)state;
    assert_ptr_equal(ritz_fit_method_find("compare"), &ritz_fit_compare);
    assert_ptr_equal(ritz_fit_method_find("rubin"), &ritz_method_rubin);
    assert_null(ritz_fit_method_find("compere"));
    assert_non_null(strstr(ritz_error_message(), "compere"));
}

/* The bodies anew, and one of them cut. */
static ritz_status make_anew(ritz_fitter *fitter)
{
    RITZ_OWN(ritz_reduced) body = {0};

    ritz_fit_second_free(&fitter->second);
    RITZ_CHECK(ritz_fit_second_body(fitter, 1, 2, &body));
    return RITZ_OK;
}

static void it_survives_every_allocation(void **state)
{
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_beams(2, 1, &a);
    assert_survives_every_allocation(make_anew(a.fitter));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(beams_are_fitted_within_one),
    cmocka_unit_test(of_a_spacecraft_it_is_the_smallest),
    cmocka_unit_test(its_bodies_are_nested_and_say_so),
    cmocka_unit_test(it_is_compared_at_equal_order),
    cmocka_unit_test(it_is_tried_of_a_scene_without_being_named),
    cmocka_unit_test(its_ladder_ends_with_all_directions),
    cmocka_unit_test(what_it_cannot_make_it_refuses),
    cmocka_unit_test(of_a_component_it_is_refused),
    cmocka_unit_test(methods_are_found_by_name),
    cmocka_unit_test(it_survives_every_allocation),
};

TEST_MODULE(fit_compare, tests, folder_make, folder_remove)
