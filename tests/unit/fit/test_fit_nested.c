/* A scene's answer cut: what its path and its bodies' files say is so. */
#include "testing.h"

#include "answers.h"
#include "dualspin.h"
#include "fit/fitter.h"
#include "fit_scenes.h"
#include "folder.h"
#include "project.h"

#include <ritz/model.h>

#include <stdio.h>
#include <stdlib.h>

/* The same arithmetic with the same columns, written and read in between. */
static void assert_same(const ritz_measures *told, const ritz_measures *found)
{
    assert_true(told->count > 0);
    assert_int_equal(told->count, found->count);
    for (int64_t j = 0; j < told->count; j++) {
        const ritz_measure *m = &told->item[j];

        assert_near(find_measure(found, m->name)->value, m->value,
                    1e-9 * fmax(1.0, fabs(m->value)));
    }
}

static void assert_path_holds(const answer *a)
{
    int64_t order[ANSWER_BODIES];

    for (int64_t t = 0; t < a->path.count; t++) {
        const ritz_fit_candidate *row = &a->path.row[t];
        RITZ_OWN(ritz_measures) found = {0};

        assert_string_equal(row->refusal, "");
        answer_orders(a, row, order);
        answer_measure(a, order, true, &found);
        assert_same(&row->errors, &found);
    }
}

static void cut_beams_are_as_far_off_as_the_path_says(void **state)
{
    const ritz_fit_request request = fit_scenes_quick("response=1e-2");
    const int64_t modes[] = {4, 5};

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        RITZ_OWN(answer) a = {0};

        fit_scenes_store_beams(4, 6);
        if (damped)
            fit_scenes_damp_left();
        answer_make(fit_scenes_beams, &request, &ritz_method_craig_bampton,
                    modes, &a);
        assert_int_equal(a.path.count, 4 + 5 + 1);
        assert_path_holds(&a);
    }
}

static void a_cut_spacecraft_is_as_far_off_as_the_path_says(void **state)
{
    const ritz_fit_request request = fit_scenes_quick("flexible=1e-1");
    const int64_t modes[] = {3, 2};
    RITZ_OWN(answer) a = {0};

    (void)state;
    dualspin_or_skip();
    fit_scenes_store_spacecraft();
    answer_make(fit_scenes_spacecraft, &request, &ritz_method_macneal_rubin,
                modes, &a);
    assert_int_equal(a.fitter->num_places, 2 + 2);
    assert_int_equal(a.path.count, 3 + 2 + 1);
    assert_path_holds(&a);
    assert_int_equal(a.body.item[2].nested.smallest, 0); /* rigid, as it was */
    assert_int_equal(a.body.item[2].K.ncol, 6);
}

/* From the answer down by one column, to those that must stay. */
static void a_path_leads_from_the_answer_to_what_must_stay(void **state)
{
    const ritz_fit_request request = fit_scenes_quick("response=1e-2");
    const int64_t modes[] = {3, 4};
    const int64_t fixed[] = {3, 6}; /* dofs of one port, and of two */
    RITZ_OWN(answer) a = {0};

    (void)state;
    fit_scenes_store_beams(4, 6);
    answer_make(fit_scenes_beams, &request, &ritz_method_craig_bampton, modes,
                &a);
    assert_int_equal(a.path.row[0].order, a.whole.order);
    assert_near(a.path.row[0].ratio, a.whole.ratio, 1e-9);
    for (int64_t t = 0; t < a.path.count; t++) {
        const ritz_fit_candidate *row = &a.path.row[t];

        assert_int_equal(row->columns, a.whole.columns - t);
        assert_int_equal(row->modes[0] + row->modes[1], row->columns);
        assert_int_equal(row->order, a.whole.order - t);
        assert_true(row->worst >= 0);
        assert_int_equal(row->feasible, row->ratio <= 1.0);
    }
    for (int k = 0; k < 2; k++) {
        const ritz_reduced *body = &a.body.item[k];

        assert_int_equal(a.path.row[a.path.count - 1].modes[k], fixed[k]);
        assert_int_equal(body->nested.smallest, fixed[k]);
        assert_int_equal(body->T.ncol, body->K.ncol);
        for (int64_t j = 0; j < body->K.ncol; j++)
            assert_int_equal(ritz_fit_stays(body->columns.kind[j]),
                             j < fixed[k]);
    }
}

/* Every prefix of a body's file, the other body whole. */
static void bodies_note_what_the_system_comes_to(void **state)
{
    const ritz_fit_request request = fit_scenes_quick("response=1e-2");
    const int64_t modes[] = {3, 4};
    RITZ_OWN(answer) a = {0};

    (void)state;
    fit_scenes_store_beams(4, 6);
    answer_make(fit_scenes_beams, &request, &ritz_method_craig_bampton, modes,
                &a);
    for (int k = 0; k < 2; k++)
        for (int64_t r = a.body.item[k].nested.smallest;
             r <= a.body.item[k].K.ncol; r++) {
            int64_t order[] = {0, 0};
            ritz_reduced prefix = {0};
            ritz_measures found = {0};
            char name[96];

            order[k] = r;
            answer_measure(&a, order, true, &found);
            assert_ok(ritz_reduced_prefix(&a.body.item[k], r, &prefix));
            assert_int_equal(prefix.errors.count, found.count);
            for (int64_t j = 0; j < found.count; j++) {
                snprintf(name, sizeof name, "system-%s", found.item[j].name);
                assert_true(isnan(find_measure(&prefix.errors, name)->limit));
                assert_near(find_measure(&prefix.errors, name)->value,
                            found.item[j].value,
                            1e-9 * fmax(1.0, found.item[j].value));
            }
            ritz_measures_free(&found);
            ritz_reduced_free(&prefix);
        }
}

/* Nothing else that could have gone in that row leaves less of an error. */
static void assert_least_went(const answer *a, const int64_t *before,
                              const int64_t *after)
{
    const double least = answer_excess(a, after);

    for (int k = 0; k < 2; k++)
        for (int64_t j = a->body.item[k].nested.smallest; j < before[k]; j++) {
            int64_t order[] = {before[0], before[1]};

            answer_turn(a, k, j, before[k] - 1);
            order[k]--;
            /* the same arithmetic for the one that went */
            assert_true(answer_excess(a, order) >= least * (1.0 - 1e-9));
            answer_turn(a, k, 0, 0);
        }
}

/*
 * By brute force: from the whole, and wherever there are no more than the six
 * that are tried.
 */
static void what_goes_is_what_matters_least(void **state)
{
    const ritz_fit_request request =
        fit_scenes_quick("frequency=1e-3,response=1e-2");
    const int64_t modes[] = {4, 5};
    int64_t before[ANSWER_BODIES];
    int64_t after[ANSWER_BODIES];
    RITZ_OWN(answer) a = {0};

    (void)state;
    fit_scenes_store_beams(5, 4);
    answer_make(fit_scenes_beams, &request, &ritz_method_craig_bampton, modes,
                &a);
    for (int64_t t = 0; t + 1 < a.path.count; t++) {
        if (t > 0 && t + 1 + 6 < a.path.count)
            continue;
        answer_orders(&a, &a.path.row[t], before);
        answer_orders(&a, &a.path.row[t + 1], after);
        assert_least_went(&a, before, after);
    }
}

/* Normal modes of a clamped body alone: there is nothing that must stay. */
static void of_a_body_without_interface_one_column_stays(void **state)
{
    const ritz_fit_request request = fit_scenes_quick("frequency=1e-1");
    const int64_t modes[] = {5, 4};
    RITZ_OWN(answer) a = {0};

    (void)state;
    fit_scenes_store_beams(4, 6);
    answer_make(fit_scenes_beams, &request, &ritz_method_normal_modes, modes,
                &a);
    assert_int_equal(a.body.item[0].nested.smallest, 1);
    assert_int_equal(a.body.item[1].nested.smallest, 3); /* rigid motion */
    assert_int_equal(a.path.count, 4 + 4 + 1);
    assert_int_equal(a.path.row[a.path.count - 1].columns, 1 + 3);
}

static void of_many_cuts_some_are_measured_and_the_smallest_is(void **state)
{
    ritz_fit_request request = fit_scenes_quick("response=1e-2");
    const int64_t modes[] = {4, 5};
    RITZ_OWN(answer) a = {0};

    (void)state;
    request.most_measured = 5; /* 2 x 9 cuts at one place: every fourth */
    fit_scenes_store_beams(4, 6);
    answer_make(fit_scenes_beams, &request, &ritz_method_craig_bampton, modes,
                &a);
    assert_int_equal(a.path.count, 4);
    assert_int_equal(a.path.row[0].columns, 18);
    assert_int_equal(a.path.row[1].columns, 14);
    assert_int_equal(a.path.row[2].columns, 10);
    assert_int_equal(a.path.row[3].columns, 9);
    assert_int_equal(a.body.item[0].nested.count, 2); /* 7 and 3 columns */
    assert_int_equal(a.body.item[1].nested.count, 3); /* 11, 7 and 6 */
    assert_path_holds(&a);
}

static const char tiny[] =
    "scene: tiny\n"
    "components:\n"
    "  left: {model: left.h5, basis: craig-bampton, modes: 1}\n"
    "  right: {model: right.h5, basis: rigid}\n"
    "joints:\n"
    "  - {name: j, between: [left/joint, right/joint], type: fixed}\n"
    "inputs: [{name: f, at: right/tip, component: 2}]\n"
    "outputs: [{name: y, at: right/tip, component: 2}]\n"
    "band_hz: [0, 0.2]\n"
    "damping: {modal: 0.01}\n";

static ritz_status system_once(const answer *a)
{
    RITZ_OWN(ritz_bodies) body = {0};
    RITZ_OWN(ritz_fit_path) path = {0};
    RITZ_OWN(ritz_system) system = {0};

    RITZ_CHECK(ritz_fitter_system(a->fitter, &a->whole, &body, &path, &system));
    return RITZ_OK;
}

static void nesting_survives_every_allocation(void **state)
{
    ritz_fit_request request = fit_scenes_quick("frequency=1e-2");
    const int64_t modes[] = {1};
    RITZ_OWN(answer) a = {0};

    (void)state;
    request.num_random = 1;
    fit_scenes_store_beams(2, 1);
    answer_make(tiny, &request, &ritz_method_craig_bampton, modes, &a);
    assert_int_equal(a.path.count, 2);
    assert_survives_every_allocation(system_once(&a));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(cut_beams_are_as_far_off_as_the_path_says),
    cmocka_unit_test(a_cut_spacecraft_is_as_far_off_as_the_path_says),
    cmocka_unit_test(a_path_leads_from_the_answer_to_what_must_stay),
    cmocka_unit_test(bodies_note_what_the_system_comes_to),
    cmocka_unit_test(what_goes_is_what_matters_least),
    cmocka_unit_test(of_a_body_without_interface_one_column_stays),
    cmocka_unit_test(of_many_cuts_some_are_measured_and_the_smallest_is),
    cmocka_unit_test(nesting_survives_every_allocation),
};

TEST_MODULE(fit_nested, tests, folder_make, folder_remove)
