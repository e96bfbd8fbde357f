/* Settings of a joint over time. */
#include "testing.h"

#include "folder.h"

#include <ritz/swept.h>

#include <math.h>

static void a_linear_path_has_one_rate(void **state)
{
    RITZ_OWN(ritz_path) path = {0};
    double at[3], range[2];

    (void)state;
    assert_ok(ritz_path_parse("60:-30:30s", &path));
    ritz_path_at(&path, 10.0, at);
    assert_near(at[0], 30.0, 1e-13);
    assert_near(at[1], -3.0, 1e-15);
    assert_true(at[2] == 0.0);
    ritz_path_range(&path, range);
    assert_true(range[0] == -30.0 && range[1] == 60.0);
}

/* Rates are central differences over 2 h, whose errors are (h^2/6) times the
   derivative two orders higher, and eps/h. */
static void assert_rates(const ritz_path *path, double t, double bound)
{
    const double h = 1e-4;
    double at[3], before[3], after[3];

    ritz_path_at(path, t, at);
    ritz_path_at(path, t - h, before);
    ritz_path_at(path, t + h, after);
    assert_near(at[1], (after[0] - before[0]) / (2.0 * h), bound);
    assert_near(at[2], (after[1] - before[1]) / (2.0 * h), bound);
}

static void a_smooth_path_begins_and_ends_at_rest(void **state)
{
    RITZ_OWN(ritz_path) path = {0};
    double at[3];

    (void)state;
    assert_ok(ritz_path_parse("0:60:3:smooth", &path));
    for (int k = 0; k < 3; k++) { /* before, after, and much later */
        ritz_path_at(&path, (double[]){0.0, 3.0, 7.0}[k], at);
        assert_near(at[0], k == 0 ? 0.0 : 60.0, 1e-12);
        assert_near(at[1], 0.0, 1e-12);
        assert_near(at[2], 0.0, 1e-12);
    }
    ritz_path_at(&path, 1.5, at);
    assert_near(at[0], 30.0, 1e-13);
    assert_near(at[1], 1.875 * 20.0, 1e-12); /* 15/8 of the mean rate */
    for (int k = 1; k < 10; k++)
        assert_rates(&path, 0.3 * k, 1e-5);
}

/* The spline through 0, 1, 0 at 0, 1, 2 with rate 0 at both ends is 3 s^2 - 2
   s^3 on either side, so that its second derivatives are 6, -6, 6. */
static void a_table_is_a_spline_at_rest_at_both_ends(void **state)
{
    RITZ_OWN(ritz_path) path = {0};
    double at[3], range[2];

    (void)state;
    assert_ok(ritz_path_parse(
        folder_write("table.tsv", "# s deg\n0 0\n1 1\n2 0\n"), &path));
    for (int k = 0; k < 3; k++)
        assert_near(path.bend[k], k == 1 ? -6.0 : 6.0, 1e-14);
    ritz_path_at(&path, 0.25, at);
    assert_near(at[0], 3.0 / 16.0 - 2.0 / 64.0, 1e-15);
    ritz_path_at(&path, 1.75, at);
    assert_near(at[0], 3.0 / 16.0 - 2.0 / 64.0, 1e-15);
    for (int k = 1; k < 10; k++)
        if (k != 5) /* here the third derivative jumps */
            assert_rates(&path, 0.2 * k, 1e-6);
    ritz_path_at(&path, 5.0, at);
    assert_true(at[0] == 0.0 && at[1] == 0.0 && at[2] == 0.0);
    ritz_path_range(&path, range);
    assert_true(range[0] == 0.0 && range[1] == 1.0);
}

/* The spline through 0, 0, 1 at 0, 1, 2 is below 0 between the first two
   points. Its second derivatives there are -1.5 and 3, so that it is
   s^2 (s - 1) 3/4, which is least at s = 2/3. */
static void the_range_of_a_table_is_that_of_its_spline(void **state)
{
    RITZ_OWN(ritz_path) path = {0};
    double range[2];

    (void)state;
    assert_ok(
        ritz_path_parse(folder_write("over.tsv", "0 0\n1 0\n2 1\n"), &path));
    assert_near(path.bend[0], -1.5, 1e-14);
    assert_near(path.bend[1], 3.0, 1e-14);
    ritz_path_range(&path, range);
    assert_near(range[0], -1.0 / 9.0, 1e-15);
    assert_near(range[1], 1.0, 1e-15);
}

static void texts_that_are_no_path_are_refused(void **state)
{
    static const char *const texts[][2] = {
        {"0:60", "'0:60' is not FROM:TO:TIME, as 0:60:30s"},
        {"0:60:30s:smooth:1", "is not FROM:TO:TIME"},
        {"0:60:30s:fast", "'fast' in '0:60:30s:fast' is not 'smooth'"},
        {"0:60:30s:", "'' in '0:60:30s:' is not 'smooth'"},
        {"0:x:30s", "'x' in '0:x:30s' is not a finite number"},
        {"nan:60:3", "'nan' in 'nan:60:3' is not a finite number"},
        {"0:1e999:3", "'1e999' in '0:1e999:3' is not a finite number"},
        {":60:3", "'' in ':60:3' is not a finite number"},
        {"0::3", "'' in '0::3' is not a finite number"},
        {"0:60:", "'' in '0:60:' is not a finite number"},
        {"0:60:s", "'s' in '0:60:s' is not a finite number"},
        {"0:60:4m", "'4m' in '0:60:4m' is not a finite number"},
        {"0:60:0s", "the time of '0:60:0s' is 0 s, and must be above 0"},
        {"0:60:-3", "the time of '0:60:-3' is -3 s, and must be above 0"},
        {"60:60:3", "'60:60:3' does not move: it is at 60 all the time"},
    };
    RITZ_OWN(ritz_path) path = {0};

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
        assert_fails(ritz_path_parse(texts[k][0], &path), RITZ_ERR_ARGUMENT,
                     texts[k][1]);
    for (int k = 0; k < 3; k++)
        assert_fails(
            ritz_path_parse((const char *[]){"no-such-file", "5", ""}[k],
                            &path),
            RITZ_ERR_FILE,
            "is neither FROM:TO:TIME, as 0:60:30s, nor a file of times and "
            "settings that can be read");
    assert_fails(ritz_path_parse(folder_write("one.tsv", "0 1\n"), &path),
                 RITZ_ERR_ARGUMENT, "has fewer than two times");
    assert_fails(
        ritz_path_parse(folder_write("twice.tsv", "0 1\n1 2\n1 3\n"), &path),
        RITZ_ERR_ARGUMENT, "has 1 s twice: a joint does not jump");
    assert_fails(ritz_path_parse(folder_write("late.tsv", "1 1\n2 2\n"), &path),
                 RITZ_ERR_ARGUMENT, "begins at 1 s, and the run at 0");
}

static ritz_status read_once(const char *file)
{
    RITZ_OWN(ritz_path) path = {0};

    return ritz_path_parse(file, &path);
}

static void no_allocation_failure_leaks(void **state)
{
    const char *file = folder_write("again.tsv", "0 0\n1 1\n2 0\n");

    (void)state;
    assert_survives_every_allocation(read_once(file));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_linear_path_has_one_rate),
    cmocka_unit_test(a_smooth_path_begins_and_ends_at_rest),
    cmocka_unit_test(a_table_is_a_spline_at_rest_at_both_ends),
    cmocka_unit_test(the_range_of_a_table_is_that_of_its_spline),
    cmocka_unit_test(texts_that_are_no_path_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(path, tests, folder_make, folder_remove)
