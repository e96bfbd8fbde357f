/* A scene's answer without columns that its tolerance can do without. */
#include "testing.h"

#include "answers.h"
#include "fit/fitter.h"
#include "fit_scenes.h"
#include "folder.h"
#include "project.h"

#include <string.h>

static const ritz_method *const one[] = {&ritz_method_craig_bampton};

/* Two beams, ready to be fitted. */
static void open_beams(int64_t left, int64_t right, const char *tolerance,
                       answer *out)
{
    const ritz_fit_request request = fit_scenes_by(one, 1, tolerance);

    fit_scenes_store_beams(left, right);
    answer_open(fit_scenes_beams, &request, out);
}

/* The system of that candidate is as large as it says, and holds. */
static void assert_is_what_it_says(answer *a, const ritz_fit_candidate *c)
{
    answer_system(a, c);
    assert_int_equal(answer_columns(a), c->columns);
    assert_int_equal(a->path.row[0].columns, c->columns);
    assert_true(a->path.row[0].feasible);
    for (int64_t k = 0; k < a->system.num_configurations; k++) {
        const ritz_configuration *at = &a->system.configuration[k];

        assert_int_equal(at->K.ncol, c->order);
        for (int64_t j = 0; j < at->errors.count; j++)
            assert_true(ritz_measure_holds(&at->errors.item[j]));
    }
}

/* The beam is driven and seen across: what moves along it is left out. */
static void what_moves_along_a_beam_driven_across_is_left_out(void **state)
{
    RITZ_OWN(answer) a = {0};
    const ritz_fit_candidate *c = NULL;

    (void)state;
    open_beams(5, 6, "response=1e-5", &a);
    assert_ok(ritz_fitter_search(a.fitter, &a.fit));
    c = answer_chosen(&a);
    assert_true(c->left_out > 0);
    assert_true(c->order < answer_smallest_whole(&a));
    assert_non_null(strstr(a.fit.why, "of its basis being left out"));
    assert_true(find_measure(&c->errors, "response-relative")->value <= 1e-5);
    assert_is_what_it_says(&a, c);
}

/* No column of the least that each body can have may go. */
static void what_has_nothing_to_spare_stays(void **state)
{
    const int64_t none[] = {0, 0};
    RITZ_OWN(answer) a = {0};
    RITZ_OWN(ritz_fit_candidate) less = {0};

    (void)state;
    open_beams(3, 3, "response=1", &a);
    assert_ok(ritz_fitter_try(a.fitter, one[0], none, &a.whole));
    assert_ok(ritz_fit_trim(a.fitter, &a.whole, &less));
    assert_int_equal(less.order, 0);
}

/* A cut that no path of this scene has. */
static void a_cut_of_another_scene_is_refused(void **state)
{
    const int64_t modes[] = {1, 1};
    RITZ_OWN(answer) a = {0};
    ritz_bodies body = {0};

    (void)state;
    open_beams(2, 2, "response=1", &a);
    assert_ok(ritz_fitter_try(a.fitter, one[0], modes, &a.whole));
    a.whole.columns = 1;
    a.whole.left_out = 100;
    assert_fails(ritz_fit_make_bodies(a.fitter, &a.whole, true, &body),
                 RITZ_ERR_ARGUMENT, "no cut of it has 1 columns");
}

static ritz_status trim(ritz_fitter *fitter, const ritz_fit_candidate *from)
{
    RITZ_OWN(ritz_fit_candidate) less = {0};

    return ritz_fit_trim(fitter, from, &less);
}

static void every_allocation_may_fail(void **state)
{
    const int64_t modes[] = {1, 1};
    RITZ_OWN(answer) a = {0};

    (void)state;
    open_beams(2, 1, "response=1", &a);
    assert_ok(ritz_fitter_try(a.fitter, one[0], modes, &a.whole));
    assert_true(a.whole.feasible);
    assert_survives_every_allocation(trim(a.fitter, &a.whole));
}

/* As in Rubin's basis: the first two move together freely, and the second is
   called normal. Without it the first would be held. */
static void what_moves_rigidly_stays_whatever_it_is_called(void **state)
{
    static const double stiffness[] = {1, -1, 0, -1, 1, 0, 0, 0, 5};
    ritz_column_kind called[] = {RITZ_COLUMN_CONSTRAINT, RITZ_COLUMN_NORMAL,
                                 RITZ_COLUMN_NORMAL};
    ritz_column_kind kind[3];
    ritz_reduced body = {.columns = {.kind = called}};

    (void)state;
    assert_ok(ritz_dense_new(3, 3, &body.K));
    assert_ok(ritz_dense_new(3, 3, &body.M));
    memcpy(body.K.val, stiffness, sizeof stiffness);
    for (int64_t j = 0; j < 3; j++)
        ritz_dense_col(&body.M, j)[j] = 1.0;
    assert_ok(ritz_fit_kinds(&body, kind));
    assert_int_equal(kind[0], RITZ_COLUMN_CONSTRAINT);
    assert_int_equal(kind[1], RITZ_COLUMN_RIGID);
    assert_int_equal(kind[2], RITZ_COLUMN_NORMAL);
    body.columns.kind = NULL;
    ritz_dense_free(&body.K);
    ritz_dense_free(&body.M);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_moves_along_a_beam_driven_across_is_left_out),
    cmocka_unit_test(what_has_nothing_to_spare_stays),
    cmocka_unit_test(a_cut_of_another_scene_is_refused),
    cmocka_unit_test(what_moves_rigidly_stays_whatever_it_is_called),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(fit_trim, tests, folder_make, folder_remove)
