#include "testing.h"

#include <ritz/model.h>

static const double two_pi = 6.28318530717958647692;

static ritz_damping read(const char *text)
{
    ritz_damping damping = {0};

    assert_ok(ritz_damping_parse(text, &damping));
    return damping;
}

static void modal_damping_has_one_ratio(void **state)
{
    ritz_damping damping = read("modal 0.002");

    (void)state;
    assert_int_equal(damping.kind, RITZ_DAMPING_MODAL);
    assert_near(ritz_damping_of_mode(&damping, -1, 0.0), 0.002, 0.0);
    assert_near(ritz_damping_of_mode(&damping, -1, 1e6), 0.002, 0.0);
}

static void bands_give_their_ratio_and_none_outside(void **state)
{
    ritz_damping damping = read("bands 1 5 0.002  5 20 0.005");

    (void)state;
    assert_int_equal(damping.count, 2);
    assert_near(ritz_damping_of_mode(&damping, -1, 0.0), 0.0, 0.0);
    assert_near(ritz_damping_of_mode(&damping, -1, 0.999 * two_pi), 0.0, 0.0);
    assert_near(ritz_damping_of_mode(&damping, -1, 3.0 * two_pi), 0.002, 0.0);
    assert_near(ritz_damping_of_mode(&damping, -1, 4.999 * two_pi), 0.002, 0.0);
    assert_near(ritz_damping_of_mode(&damping, -1, 5.001 * two_pi), 0.005, 0.0);
    assert_near(ritz_damping_of_mode(&damping, -1, 20.001 * two_pi), 0.0, 0.0);
}

/* 4 pi / (2 pi) and 2 * (2 pi) / (2 pi) are exact: 2 Hz is an edge of both. */
static void a_shared_edge_belongs_to_the_upper_band(void **state)
{
    ritz_damping damping = read("bands 0 2 0.1 2 4 0.2");

    (void)state;
    assert_near(ritz_damping_of_mode(&damping, -1, 2.0 * two_pi), 0.2, 0.0);
    assert_near(ritz_damping_of_mode(&damping, -1, 4.0 * two_pi), 0.2, 0.0);
}

/* zeta = (a / omega + b omega) / 2, by hand: (3 / 2 + 0.5 * 2) / 2 = 1.25 */
static void rayleigh_damping_follows_its_hyperbola(void **state)
{
    ritz_damping damping = read("rayleigh 3 0.5");

    (void)state;
    assert_near(ritz_damping_of_mode(&damping, -1, 2.0), 1.25, 0.0);
    assert_near(ritz_damping_of_mode(&damping, -1, 0.0), 0.0, 0.0);
}

static void each_mode_has_its_ratio_and_the_last_is_of_all_above(void **state)
{
    ritz_damping damping = read("modes 0.01 0.02 0.015");
    ritz_damping modal = read("modal 0.3");

    (void)state;
    assert_near(ritz_damping_of_mode(&damping, 0, 5.0), 0.01, 0.0);
    assert_near(ritz_damping_of_mode(&damping, 1, 5.0), 0.02, 0.0);
    assert_near(ritz_damping_of_mode(&damping, 2, 5.0), 0.015, 0.0);
    assert_near(ritz_damping_of_mode(&damping, 900, 5.0), 0.015, 0.0);
    assert_near(ritz_damping_of_mode(&modal, 900, 5.0), 0.3, 0.0);
}

/*
 * Two points are met: with zeta = 1 % at 1 Hz and 2 % at 10 Hz
 * a / w1 + b w1 = 0.02, a / w2 + b w2 = 0.04, by Cramer's rule.
 */
static void two_points_of_a_fit_are_met(void **state)
{
    ritz_damping damping = read("fit 1 0.01 10 0.02");
    double w1 = two_pi;
    double w2 = 10.0 * two_pi;
    double det = w2 / w1 - w1 / w2;
    int64_t at = -1;

    (void)state;
    /* a dozen operations on numbers that cancel to a hundredth */
    assert_near(damping.a, (0.02 * w2 - 0.04 * w1) / det, 1e-14);
    assert_near(damping.b, (0.04 / w1 - 0.02 / w2) / det, 1e-17);
    assert_near(ritz_damping_misfit(&damping, &at), 0.0, 1e-16);
    assert_true(ritz_damping_is_rayleigh(&damping));
    assert_near(ritz_damping_of_mode(&damping, -1, w2), 0.02, 1e-16);
    assert_near(ritz_damping_of_mode(&damping, 3, w1), 0.01, 1e-16);
}

/*
 * scipy.optimize.nnls([[1 / (2 w), w / 2]], zeta) of these points, 1.10: the
 * first is free, the second has b held to 0 and the third a, whose factor is
 * then sum(w / 2 zeta) / sum(w^2 / 4).
 */
static void a_fit_is_least_squares_with_neither_negative(void **state)
{
    ritz_damping both = read("fit 1 0.03 3 0.01 10 0.02 30 0.05");
    ritz_damping falls = read("fit 1 0.1 10 0.002 100 0.0001");
    ritz_damping rises = read("fit 1 0.0001 10 0.01 100 0.3");
    double s = 3.14159265358979323846;
    int64_t at = -1;

    (void)state;
    assert_near(both.a, 0.341080062305, 1e-12);
    assert_near(both.b, 0.0005204621426276, 1e-15);
    assert_near(ritz_damping_misfit(&both, &at), 0.003952669782, 1e-12);
    assert_int_equal(at, 1);
    assert_near(falls.b, 0.0, 0.0);
    assert_true(falls.a > 0.0);
    assert_near(rises.a, 0.0, 0.0);
    assert_near(rises.b,
                (s * 0.0001 + 10 * s * 0.01 + 100 * s * 0.3) /
                    (s * s * (1.0 + 100.0 + 1e4)),
                1e-16);
}

static void no_text_is_no_damping(void **state)
{
    ritz_damping damping = read("");
    char text[RITZ_DAMPING_SIZE] = "x";

    (void)state;
    assert_int_equal(damping.kind, RITZ_DAMPING_NONE);
    assert_near(ritz_damping_of_mode(&damping, -1, 1.0), 0.0, 0.0);
    ritz_damping_print(&damping, text);
    assert_string_equal(text, "");
}

static void printed_text_is_short_and_reads_back(void **state)
{
    static const char *const texts[] = {
        "modal 0.002",
        "modal 0.1",
        "modal 0.30000000000000004",
        "bands 0 5 0.002 5 20 0.005",
        "rayleigh 0.1 2e-05",
        "bands 0 1 .5 1 2 .5 2 3 .5 3 4 .5 4 5 .5 5 6 .5",
        ("bands 0 1.125 0.001 1.125 2.125 0.002 2.125 3.125 0.003 3.125 4.125 "
         "0.004"),
        "modes 0.01 0.02 0.015",
        "fit 1 0.01 10 0.02 100 0.05",
    };

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        ritz_damping damping = read(texts[k]);
        ritz_damping again = {0};
        char text[RITZ_DAMPING_SIZE] = "";

        ritz_damping_print(&damping, text);
        if (!strstr(texts[k], " ."))
            assert_string_equal(text, texts[k]);
        again = read(text);
        assert_memory_equal(&again, &damping, sizeof again);
    }
}

static void bad_damping_is_refused_in_words(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"modal", "damping 'modal' with 0 numbers is not such as 'modal 0.002"},
        {"modal 1 2", "with 2 numbers"},
        {"modal 2%", "'2%' in a damping is not a finite number"},
        {"modal nan", "'nan' in a damping is not a finite number"},
        {"modal 1e999", "'1e999' in a damping is not a finite number"},
        {"modal 0", "damping ratio 0 is not above 0"},
        {"modal -0.1", "damping ratio -0.1 is not above 0"},
        {"modal 1", "damping ratio 1 is overdamped, it must stay below 1"},
        {"nodal 0.1", "unknown damping 'nodal', there is modal, modes, bands"},
        {"bands", "with 0 numbers"},
        {"bands 0 5", "with 2 numbers is not such as 'bands 0 5 0.002 5 20"},
        {"bands 0 5 0.1 5", "with 4 numbers"},
        {"bands 5 5 0.1", "damping band 5 to 5 Hz does not ascend"},
        {"bands -1 5 0.1", "damping band -1 to 5 Hz does not ascend from 0"},
        {"bands 0 5 0.1 4 8 0.1", "4 to 8 Hz begins before 5 Hz"},
        {"bands 0 5 2", "damping ratio 2 is overdamped"},
        {"rayleigh 1", "damping 'rayleigh' with 1 numbers"},
        {"rayleigh 0 0", "rayleigh damping 0 0 is none"},
        {"rayleigh -1 0", "rayleigh damping -1 0 is negative"},
        {"modal 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 "
         "0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1 0.1",
         "is not such as 'modal 0.002'"},
        {"modes", "damping 'modes' with 0 numbers is not such as 'modes 0.01"},
        {"modes 0.01 0", "damping ratio 0 is not above 0"},
        {"modes 0.01 1.5", "damping ratio 1.5 is overdamped"},
        {"modes 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 "
         "1 1 1 1 1 1 1 1 1 1",
         "with 41 numbers"},
        {"fit 1 0.01", "damping 'fit' with 2 numbers is not such as 'fit 1"},
        {"fit 1 0.01 2", "with 3 numbers"},
        {"fit 1 0.01 1 0.02", "needs two different frequencies, all are 1 Hz"},
        {"fit 0 0.01 1 0.02", "a damping fit at 0 Hz: its frequencies are"},
        {"fit 1 0.01 2 0", "damping ratio 0 is not above 0"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_damping damping = {0};

        if (ritz_damping_parse(cases[k].text, &damping) != RITZ_ERR_ARGUMENT)
            fail_msg("'%s' is taken", cases[k].text);
        if (!strstr(ritz_error_message(), cases[k].words))
            fail_msg("'%s': %s", cases[k].text, ritz_error_message());
        assert_int_equal(damping.kind, RITZ_DAMPING_NONE);
    }
}

static void a_text_without_end_is_refused(void **state)
{
    static char text[100000];
    ritz_damping damping = {0};

    (void)state;
    memset(text, '1', sizeof text - 1);
    assert_fails(ritz_damping_parse(text, &damping), RITZ_ERR_ARGUMENT,
                 "1...' is too long");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(modal_damping_has_one_ratio),
    cmocka_unit_test(bands_give_their_ratio_and_none_outside),
    cmocka_unit_test(a_shared_edge_belongs_to_the_upper_band),
    cmocka_unit_test(rayleigh_damping_follows_its_hyperbola),
    cmocka_unit_test(each_mode_has_its_ratio_and_the_last_is_of_all_above),
    cmocka_unit_test(two_points_of_a_fit_are_met),
    cmocka_unit_test(a_fit_is_least_squares_with_neither_negative),
    cmocka_unit_test(no_text_is_no_damping),
    cmocka_unit_test(printed_text_is_short_and_reads_back),
    cmocka_unit_test(bad_damping_is_refused_in_words),
    cmocka_unit_test(a_text_without_end_is_refused),
};

TEST_MODULE(damping, tests, NULL, NULL)
