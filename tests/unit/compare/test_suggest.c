/*
 * What a comparison advises: which angle to add, and what the composite
 * tolerance trades.
 */
#include "testing.h"

#include "compared.h"
#include "dualspin.h"

#include "compare/compare.h"

enum { LISTED = 2, ROWS = 4 };

/* Two listed rows and two between, with no error at all. */
static void make(ritz_compare_row row[ROWS], ritz_comparison *c)
{
    for (int k = 0; k < ROWS; k++)
        row[k] = (ritz_compare_row){
            .listed = k < LISTED,
            .gain_error = nan(""),
            .response_error = 1e-12,
        };
    *c = (ritz_comparison){.num_rows = ROWS, .row = row};
}

static void an_angle_that_stands_out_is_to_be_added(void **)
{
    ritz_compare_row row[ROWS];
    ritz_comparison c;
    ritz_suggestion s = {0};

    make(row, &c);
    row[0].response_error = 1e-5;
    row[3].response_error = 3e-2;
    ritz_compare_suggest(&c, &s);
    assert_int_equal(s.row, 3);
    assert_string_equal(s.measure, "response");
    assert_true(s.worth);
    assert_near(s.error, 3e-2, 0.0);
    assert_near(s.listed, 1e-5, 0.0);
}

/* Nine times is not ten; 9e-4 is not seen; as large at listed ones: no help. */
static void an_error_that_does_not_stand_out_asks_for_nothing(void **)
{
    static const double cases[][2] = {
        {1e-2, 9e-2}, {1e-9, 9e-4}, {0.5, 0.6}, {0.0, 1e-6}};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_compare_row row[ROWS];
        ritz_comparison c;
        ritz_suggestion s = {0};

        make(row, &c);
        row[1].response_error = cases[k][0];
        row[2].response_error = cases[k][1];
        ritz_compare_suggest(&c, &s);
        assert_int_equal(s.row, 2);
        assert_false(s.worth);
    }
}

/* The gain is worse off than the response: it is the gain that is told. */
static void the_measure_that_stands_out_most_is_told(void **)
{
    ritz_compare_row row[ROWS];
    ritz_comparison c;
    ritz_suggestion s = {0};

    make(row, &c);
    row[2].response_error = 2e-2;
    row[3].gain_error = 7.7;
    ritz_compare_suggest(&c, &s);
    assert_int_equal(s.row, 3);
    assert_string_equal(s.measure, "gain");
    assert_true(s.worth);
}

static void without_rows_between_nothing_is_suggested(void **)
{
    ritz_compare_row row[ROWS];
    ritz_comparison c;
    ritz_suggestion s = {0};

    make(row, &c);
    c.num_rows = LISTED;
    ritz_compare_suggest(&c, &s);
    assert_int_equal(s.row, -1);
    assert_false(s.worth);
}

static void prepare(compared *f)
{
    *f = (compared){0};
    assert_ok(dualspin_stage(&f->scene, &f->stage));
    f->scene.num_configurations = 2; /* 0 and 60 degrees, to be quick */
    assert_ok(ritz_compare(&f->stage, &f->c));
}

/*
 * A looser tolerance never makes a body larger; at the scene's own tolerance
 * the row is the comparison itself; the gain is exact in all of them.
 */
static void a_looser_tolerance_trades_exactness_for_size(void **)
{
    ritz_tolerance_row *rows = NULL;
    compared f;

    dualspin_or_skip();
    prepare(&f);
    {
        const double tolerance[] = {1e-12, f.scene.composite_tolerance, 1e-3};

        assert_ok(ritz_compare_tolerances(&f.stage, &f.c, 3, tolerance, &rows));
    }
    assert_int_equal(rows[1].total, f.c.second.num_coordinates);
    assert_int_equal(rows[1].order[0], f.c.V[0].ncol);
    assert_int_equal(rows[1].largest,
                     f.c.second_system.configuration[0].K.ncol);
    assert_near(rows[1].frequency_error,
                fmax(f.c.row[0].frequency_error, f.c.row[1].frequency_error),
                0.0);
    for (int k = 0; k < 3; k++) {
        assert_true(rows[k].gain_error < 1e-9);
        assert_true(rows[k].removed);
        if (k > 0)
            assert_true(rows[k].total <= rows[k - 1].total);
    }
    assert_true(rows[2].total < rows[0].total);
    assert_true(rows[2].frequency_error > 1e3 * rows[0].frequency_error);
    ritz_tolerances_free(3, &rows);
    compared_release(&f);
}

static void tolerances_beyond_one_are_refused(void **)
{
    const double tolerance[] = {0.1, 1.0};
    ritz_tolerance_row *rows = NULL;
    compared f;

    dualspin_or_skip();
    prepare(&f);
    assert_fails(ritz_compare_tolerances(&f.stage, &f.c, 2, tolerance, &rows),
                 RITZ_ERR_ARGUMENT,
                 "the composite tolerance 1 is not between 0 and 1");
    compared_release(&f);
}

static ritz_status chart_anew(const compared *f)
{
    const double tolerance = 1e-3;
    ritz_tolerance_row *rows = NULL;
    ritz_status status =
        ritz_compare_tolerances(&f->stage, &f->c, 1, &tolerance, &rows);

    ritz_tolerances_free(1, &rows);
    return status;
}

static void no_allocation_failure_leaks(void **)
{
    compared f;

    dualspin_or_skip();
    prepare(&f);
    f.scene.num_configurations = f.c.first_system.num_configurations = 1;
    assert_survives_every_allocation(chart_anew(&f));
    f.c.first_system.num_configurations = 2;
    compared_release(&f);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_angle_that_stands_out_is_to_be_added),
    cmocka_unit_test(an_error_that_does_not_stand_out_asks_for_nothing),
    cmocka_unit_test(the_measure_that_stands_out_most_is_told),
    cmocka_unit_test(without_rows_between_nothing_is_suggested),
    cmocka_unit_test(a_looser_tolerance_trades_exactness_for_size),
    cmocka_unit_test(tolerances_beyond_one_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(suggest, tests, NULL, NULL)
