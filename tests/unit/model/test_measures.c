#include "testing.h"

#include <ritz/model.h>

#include <math.h>

static void three(ritz_measures *out)
{
    assert_ok(ritz_measures_add(out, "mac", 0.9, 0.95, "mode 3"));
    assert_ok(ritz_measures_add(out, "extra-modes", 0.0, nan(""), NULL));
    assert_ok(ritz_measures_add(out, "gain-relative", 0.1, nan(""), ""));
}

static void a_measure_is_found_by_its_whole_name(void **state)
{
    RITZ_OWN(ritz_measures) all = {0};

    (void)state;
    three(&all);
    assert_ptr_equal(ritz_measures_find(&all, "gain-relative"), &all.item[2]);
    assert_true(ritz_measures_value(&all, "mac") == 0.9);
    assert_null(ritz_measures_find(&all, "gain"));
    assert_true(isnan(ritz_measures_value(&all, "gain")));
    assert_null(ritz_measures_find(&(ritz_measures){0}, "mac"));
}

static void a_copy_takes_the_place_of_what_was_there(void **state)
{
    RITZ_OWN(ritz_measures) all = {0};
    RITZ_OWN(ritz_measures) copy = {0};

    (void)state;
    three(&all);
    assert_ok(ritz_measures_add(&copy, "frequency", 1.0, nan(""), NULL));
    assert_ok(ritz_measures_copy(&all, &copy));
    assert_int_equal(copy.count, 3);
    assert_memory_equal(copy.item, all.item, 3 * sizeof *all.item);
    assert_ok(ritz_measures_copy(&copy, &copy));
    assert_memory_equal(copy.item, all.item, 3 * sizeof *all.item);
    assert_ok(ritz_measures_copy(&(ritz_measures){0}, &copy));
    assert_int_equal(copy.count, 0);
}

static void every_allocation_may_fail(void **state)
{
    RITZ_OWN(ritz_measures) all = {0};
    RITZ_OWN(ritz_measures) copy = {0};

    (void)state;
    three(&all);
    assert_survives_every_allocation(ritz_measures_copy(&all, &copy));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_measure_is_found_by_its_whole_name),
    cmocka_unit_test(a_copy_takes_the_place_of_what_was_there),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(measures, tests, NULL, NULL)
