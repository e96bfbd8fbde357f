/* What is said where no model meets the tolerance. */
#include "testing.h"

#include "answers.h"
#include "fit_scenes.h"
#include "folder.h"
#include "project.h"

#include "fit/fitter.h"

#include <math.h>

enum { METHODS = 2, LARGEST = 12 };

static const ritz_method *const methods[METHODS] = {&ritz_method_craig_bampton,
                                                    &ritz_method_macneal_rubin};

/* Two beams of 10 and 12 elements under a tolerance that wants all of them. */
static void fit(answer *out)
{
    ritz_fit_request request =
        fit_scenes_by(methods, METHODS, "frequency=1e-9");

    request.largest = LARGEST;
    fit_scenes_store_beams(10, 12);
    answer_search(fit_scenes_beams, &request, out);
    assert_int_equal(out->fit.chosen, -1);
}

/* Bounds rule most of them out; of the largest the error is said. */
static void the_largest_of_a_method_that_fails_is_measured(void **state)
{
    RITZ_OWN(answer) a = {0};
    int64_t screened = 0;

    (void)state;
    fit(&a);
    for (int64_t k = 0; k < a.fit.count; k++)
        screened += a.fit.candidate[k].ruled_out;
    assert_true(screened > 0);
    for (int64_t m = 0; m < METHODS; m++) {
        const ritz_fit_candidate *c = &a.fit.candidate[a.fit.reached[m]];

        assert_false(c->ruled_out);
        assert_true(find_measure(&c->errors, "frequency-relative")->value >
                    1e-9);
        for (int64_t k = 0; k < a.fit.count; k++)
            if (a.fit.candidate[k].method == c->method &&
                !a.fit.candidate[k].refusal[0])
                assert_true(a.fit.candidate[k].order <= c->order);
    }
    assert_non_null(
        strstr(a.fit.why, "no method meets the tolerance; nearest"));
}

/* Errors of the modes that are there say little where others are missing. */
static void what_misses_fewer_modes_is_nearer(void **state)
{
    static const struct {
        double missing, limit, ratio;
        bool ruled_out;
    } table[] = {/* each farther than the one before */
                 {0.0, 0.0, 30.0, false}, {0.0, 0.0, 40.0, false},
                 {0.0, 0.0, 1e6, false},  {1.0, 0.0, 2.0, false},
                 {3.0, 0.0, 4.0, false},  {3.0, 0.0, 5.0, false},
                 {0.0, 0.0, 1.5, true},   {0.0, 0.0, 1.6, true}};
    enum { ROWS = sizeof table / sizeof *table };
    ritz_fit_candidate row[ROWS] = {0};

    (void)state;
    for (int k = 0; k < ROWS; k++) {
        row[k].ratio = table[k].ratio;
        row[k].ruled_out = table[k].ruled_out;
        if (!table[k].ruled_out)
            assert_ok(ritz_measures_add(&row[k].errors, "missing-modes",
                                        table[k].missing, table[k].limit, ""));
    }
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < ROWS; j++)
            assert_int_equal(ritz_fit_is_nearer(&row[i], &row[j]), i < j);
    /* where modes may be missing the other errors decide */
    row[3].errors.item[0].limit = 1.0;
    assert_true(ritz_fit_is_nearer(&row[3], &row[0]));
    row[4].errors.item[0].limit = nan("");
    assert_true(ritz_fit_is_nearer(&row[4], &row[0]));
    for (int k = 0; k < ROWS; k++)
        ritz_fit_candidate_free(&row[k]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_largest_of_a_method_that_fails_is_measured),
    cmocka_unit_test(what_misses_fewer_modes_is_nearer),
};

TEST_MODULE(fit_unmet, tests, folder_make, folder_remove)
