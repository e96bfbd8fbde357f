#include "linear/first_shift.h"

#include "base/tolerances.h"
#include "testing.h"

#include "bar.h"
#include "fixtures/lattice.h"

#include <float.h>

/* Rounding of powers and products. */
static const double rounding = 16.0 * DBL_EPSILON;

/* From one corner of the cube to the other there are 3 (m - 1) springs. */
static void a_shift_falls_with_the_fourth_power_of_the_length(void **state)
{
    enum { EDGE = 20, LEVELS = 3 * (EDGE - 1) + 1 };
    const double expected = 2.0 * RITZ_FIRST_BENDING / pow(LEVELS, 4.0);
    ritz_sparse K = {0}, M = {0};
    double s = 0.0;

    (void)state;
    lattice_new(EDGE, 1.0, &K, &M);
    assert_ok(ritz_first_shift(&K, 2.0, 10, &s));
    assert_near(s, expected, rounding * expected);
    ritz_sparse_free(&K);
    ritz_sparse_free(&M);
}

static void a_long_bar_has_a_shift_that_follows_its_modes(void **state)
{
    enum { LONG = 6000, MODES = 40 };
    const double part = (double)MODES / (LONG + 1);
    const double expected = RITZ_FIRST_LEAST * pow(part, 2.0 / 3.0);
    RITZ_OWN(ritz_component) bar = {0};
    double s = 0.0;

    (void)state;
    assert_ok(bar_component(LONG, &bar));
    assert_ok(ritz_first_shift(&bar.K, 1.0, MODES, &s));
    assert_near(s, expected, rounding * expected);
}

static void a_short_body_has_the_largest_shift(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};
    double s = 0.0;

    (void)state;
    assert_ok(bar_component(5, &bar));
    assert_ok(ritz_first_shift(&bar.K, 3.0, 2, &s));
    assert_near(s, 3.0 * RITZ_FIRST_SHIFT, 0.0);
}

static void a_shift_survives_every_allocation(void **state)
{
    RITZ_OWN(ritz_component) bar = {0};
    double s = 0.0;

    (void)state;
    assert_ok(bar_component(6000, &bar));
    assert_survives_every_allocation(ritz_first_shift(&bar.K, 1.0, 2, &s));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_shift_falls_with_the_fourth_power_of_the_length),
    cmocka_unit_test(a_long_bar_has_a_shift_that_follows_its_modes),
    cmocka_unit_test(a_short_body_has_the_largest_shift),
    cmocka_unit_test(a_shift_survives_every_allocation),
};

TEST_MODULE(first_shift, tests, NULL, NULL)
