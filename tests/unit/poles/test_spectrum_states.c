/*
 * Poles of sparse state spaces: the lowest ones, all up to a frequency, those
 * near a frequency.
 */
#include "testing.h"

#include "spaces.h"

#include <ritz/poles.h>

#include <complex.h>

static const double pi = 3.14159265358979323846;

static void the_lowest_poles_are_those_of_the_closed_form(void **)
{
    static const ritz_span span = {.modes = 5};
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_spectrum) found = {0};

    assert_ok(spaces_rod(500, 0.0, false, &rod));
    assert_ok(ritz_spectrum_of(ritz_model_of_states(&rod), &span, &found));
    assert_int_equal(found.count, 5);
    for (int64_t k = 0; k < 5; k++) {
        double s = spaces_rod_pole(500, 0.0, k + 1);

        assert_near(creal(found.s[k]) / s, 1.0, 1e-9);
        assert_true(found.residual[k] < 1e-11);
    }
    assert_string_equal(found.engine, "MUMPS + ARPACK");
}

static void all_poles_up_to_a_frequency_are_found(void **)
{
    const double limit = -spaces_rod_pole(500, 0.0, 33) * 1.01;
    const ritz_span span = {.modes = -1, .up_to_hz = limit / (2.0 * pi)};
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_spectrum) found = {0};

    assert_ok(spaces_rod(500, 0.0, false, &rod));
    assert_ok(ritz_spectrum_of(ritz_model_of_states(&rod), &span, &found));
    assert_int_equal(found.count, 33);
}

/* Poles are -2 + 2 i sqrt(9999) cos(k pi / 301); k = 1 .. 150 lie above the
   axis. */
static void poles_near_a_frequency_are_found(void **)
{
    const double size = 2.0 * sqrt(9999.0);
    const double near = size * cos(100.2 * pi / 301.0);
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_spectrum) found = {0};

    assert_ok(spaces_rod(300, 100.0, false, &rod));
    assert_ok(ritz_spectrum_near(&rod, near / (2.0 * pi), 3, &found));
    assert_int_equal(found.count, 3);
    for (int k = 0; k < 3; k++) { /* ascending: k = 101, 100, 99 */
        double im = size * cos((101.0 - k) * pi / 301.0);

        assert_near(creal(found.s[k]), -2.0, 1e-9);
        assert_near(cimag(found.s[k]), im, 1e-9);
    }
    ritz_spectrum_free(&found);
    assert_fails(ritz_spectrum_near(&rod, 1.0, 0, &found), RITZ_ERR_ARGUMENT,
                 "no poles are asked for");
}

static void poles_of_a_dense_model_near_a_frequency_are_found(void **)
{
    static const double A[] = {0, 1, 0, -25, -0.1, 0, 0, 0, -3};
    static const double B[] = {0, 1, 1}, C[] = {1, 0, 1};
    static const spaces_rows rows = {3, 1, 1, A, B, C, NULL, NULL};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_spectrum) found = {0};

    assert_ok(spaces_make(&rows, &model));
    assert_ok(ritz_spectrum_near(&model, 0.8, 1, &found));
    assert_int_equal(found.count, 1);
    assert_near(creal(found.s[0]), -0.05, 1e-12);
    assert_near(cimag(found.s[0]), sqrt(25.0 - 0.0025), 1e-12);
}

static ritz_status make(const ritz_state_space *model)
{
    static const ritz_span span = {.modes = -1, .up_to_hz = 0.1};
    RITZ_OWN(ritz_spectrum) found = {0}, near = {0};

    RITZ_CHECK(ritz_spectrum_of(ritz_model_of_states(model), &span, &found));
    return ritz_spectrum_near(model, 0.2, 2, &near);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};

    assert_ok(spaces_rod(12, 0.2, true, &rod));
    assert_survives_every_allocation(make(&rod));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_lowest_poles_are_those_of_the_closed_form),
    cmocka_unit_test(all_poles_up_to_a_frequency_are_found),
    cmocka_unit_test(poles_near_a_frequency_are_found),
    cmocka_unit_test(poles_of_a_dense_model_near_a_frequency_are_found),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(spectrum_states, tests, NULL, NULL)
