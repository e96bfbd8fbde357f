#include "testing.h"

#include "base/alloc.h"
#include "project.h"

#include <ritz/verify.h>

#include <float.h>
#include <stdio.h>

static const ritz_verify_request none = RITZ_VERIFY_NONE;

RITZ_PAIR_OF(ritz_state_space);

/* y = gain / (s + 1) u, and of `rigid` so much / s^2 beside, all diagonal. */
static void first_order(double gain, double rigid, ritz_state_space *out)
{
    ritz_io io = {0};
    int64_t n = rigid != 0.0 ? 3 : 1;

    assert_ok(ritz_io_new(0, 1, 1, &io));
    snprintf(io.input[0], sizeof io.input[0], "u");
    snprintf(io.output[0], sizeof io.output[0], "y");
    assert_ok(ritz_state_space_new(n, &io, out));
    ritz_io_free(&io);
    out->A.val[0] = -1.0;
    out->B.val[0] = 1.0;
    out->C.val[0] = gain;
    if (n == 3) {
        ritz_dense_col(&out->A, 2)[1] = 1.0;
        out->B.val[2] = 1.0;
        out->C.val[1] = rigid;
    }
}

static double value(const ritz_measures *all, const char *name)
{
    const ritz_measure *m = ritz_measures_find(all, name);

    if (!m)
        fail_msg("no measure %s", name);
    return m ? m->value : nan("");
}

/* G = 1/(s + 1), G_r = 0.9 G: every relative error is 0.1. */
static void a_tenth_missing_is_a_tenth_by_every_measure(void **)
{
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};
    ritz_verify_request request = none;
    RITZ_OWN(ritz_measures) found = {0};

    first_order(1.0, 0.0, &full);
    first_order(0.9, 0.0, &reduced);
    request.band_hz[1] = 1.0;
    assert_ok(verify_states(&full, &reduced, &request, &found));
    /* 1e-8, the tolerance of the norm, and rounding of 1 - 0.9 */
    assert_near(value(&found, "h-infinity"), 0.1, 1.1e-8 * 0.1);
    assert_near(value(&found, "h-infinity-relative"), 0.1, 2.1e-8 * 0.1);
    assert_near(value(&found, "h2-relative"), 0.1, 1e-14);
    assert_near(value(&found, "response-relative"), 0.1, 1e-14);
    assert_near(value(&found, "static-gain-relative"), 0.1, 1e-14);
    assert_near(value(&found, "growth-relative"), -1.0, 1e-14);
    assert_null(ritz_measures_find(&found, "h-infinity-bound"));
}

static void the_error_is_held_to_the_bound_that_came_with_it(void **)
{
    /* the error is 0.1; the slack is of 1e-8 */
    static const struct {
        double bound;
        bool holds;
    } table[] = {{0.2, true}, {0.1, true}, {0.0999, false}};

    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};
        RITZ_OWN(ritz_measures) found = {0};

        first_order(1.0, 0.0, &full);
        first_order(0.9, 0.0, &reduced);
        assert_ok(ritz_measures_add(&reduced.estimates, "h-infinity-bound",
                                    table[k].bound, nan(""), NULL));
        assert_ok(verify_states(&full, &reduced, &none, &found));
        assert_int_equal(
            ritz_measure_holds(ritz_measures_find(&found, "h-infinity-bound")),
            table[k].holds);
    }
}

/*
 * Poles at -0.01 +- 789 i with entries of 3e4 in A, whose states are rotated:
 * the peak is known to a relative eps |A| / 0.01. An error within that is no
 * violation of a proven bound; one of a hundred times as much is.
 */
static void a_bound_is_not_missed_by_rounding_beside_a_slow_pole(void **)
{
    const double slow = 0.01, w = 789.0, fast = 3e4;
    const double cosine = 0.6, sine = 0.8;
    /* eps |A| / slow of the peak 1 / slow; |A| is about sqrt(2) fast */
    const double rounding = DBL_EPSILON * fast / slow / slow;
    static const struct {
        double part;
        bool holds;
    } table[] = {{0.1, true}, {100.0, false}};

    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        ritz_state_space_pair of = {0};
        RITZ_OWN(ritz_measures) found = {0};

        for (int which = 0; which < 2; which++) {
            const double d = which * slow * table[k].part * rounding * slow;
            const double S[3][3] = {
                {-slow - d, w, 0.0}, {-w, -slow - d, 0.0}, {0.0, 0.0, -fast}};
            const double Q[3][3] = {
                {1.0, 0.0, 0.0}, {0.0, cosine, sine}, {0.0, -sine, cosine}};
            ritz_io io = {0};

            assert_ok(ritz_io_new(0, 1, 1, &io));
            snprintf(io.input[0], sizeof io.input[0], "u");
            snprintf(io.output[0], sizeof io.output[0], "y");
            assert_ok(ritz_state_space_new(3, &io, &of[which]));
            ritz_io_free(&io);
            for (int64_t j = 0; j < 3; j++)
                for (int64_t i = 0; i < 3; i++)
                    for (int64_t e = 0; e < 9; e++)
                        ritz_dense_col(&of[which].A, j)[i] +=
                            Q[i][e / 3] * S[e / 3][e % 3] * Q[j][e % 3];
            of[which].B.val[0] = of[which].C.val[0] = 1.0;
        }
        assert_ok(ritz_measures_add(&of[1].estimates, "h-infinity-bound", 1e-14,
                                    nan(""), NULL));
        assert_ok(verify_states(&of[0], &of[1], &none, &found));
        if (ritz_measure_holds(ritz_measures_find(
                &found, "h-infinity-bound")) != table[k].holds)
            fail_msg("%g: %g where %g is asked", table[k].part,
                     value(&found, "h-infinity"),
                     ritz_measures_find(&found, "h-infinity-bound")->limit);
        ritz_state_space_pair_free(&of);
    }
}

static void outputs_are_divided_by_their_limits(void **)
{
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};
    RITZ_OWN(ritz_measures) found = {0};

    first_order(1.0, 0.0, &full);
    first_order(0.9, 0.0, &reduced);
    full.limit[0] = 0.25;
    assert_ok(verify_states(&full, &reduced, &none, &found));
    assert_near(value(&found, "h-infinity"), 0.4, 1.1e-8 * 0.4);
    assert_near(value(&found, "h-infinity-relative"), 0.1, 2.1e-8 * 0.1);
}

static void rigid_motions_of_both_are_left_out_of_norms(void **)
{
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0}, held = {0};
    ritz_verify_request request = none;
    ritz_measures found = {0};

    first_order(1.0, 5.0, &full);
    first_order(0.9, 5.0, &reduced);
    first_order(0.9, 0.0, &held);
    assert_ok(verify_states(&full, &reduced, &none, &found));
    /* to tell poles apart rounds by some eps */
    assert_near(value(&found, "h-infinity"), 0.1, 2e-8 * 0.1);
    assert_non_null(strstr(ritz_measures_find(&found, "h-infinity")->where,
                           "less 2 poles"));
    assert_null(ritz_measures_find(&found, "static-gain-relative"));
    ritz_measures_free(&found);
    assert_ok(verify_states(&full, &held, &none, &found));
    assert_null(ritz_measures_find(&found, "h-infinity"));
    ritz_measures_free(&found);
    request.limit[RITZ_MEASURE_INFINITY_RELATIVE] = 1.0;
    assert_fails(verify_states(&full, &held, &request, &found),
                 RITZ_ERR_ARGUMENT, "2 poles of the full model and 0");
    request = none;
    request.limit[RITZ_MEASURE_GAIN] = 1.0;
    assert_fails(verify_states(&full, &reduced, &request, &found),
                 RITZ_ERR_ARGUMENT, "a pole is at 0");
}

static void what_reaches_an_output_at_once_has_no_h2_norm(void **)
{
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};
    ritz_verify_request request = none;
    ritz_measures found = {0};

    first_order(1.0, 0.0, &full);
    first_order(0.9, 0.0, &reduced);
    reduced.D.val[0] = 0.1; /* which makes the gain that of the full model */
    assert_ok(verify_states(&full, &reduced, &none, &found));
    assert_null(ritz_measures_find(&found, "h2-relative"));
    assert_near(value(&found, "h-infinity"), 0.1, 1.1e-8 * 0.1);
    assert_non_null(
        strstr(ritz_measures_find(&found, "h-infinity")->where, "infinite"));
    assert_near(value(&found, "static-gain-relative"), 0.0, 1e-15);
    ritz_measures_free(&found);
    request.limit[RITZ_MEASURE_H2] = 1.0;
    assert_fails(verify_states(&full, &reduced, &request, &found),
                 RITZ_ERR_ARGUMENT, "there is no H2 norm");
}

static void growth_fails_unless_the_full_model_grows_too(void **)
{
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};
    RITZ_OWN(ritz_measures) found = {0};

    first_order(1.0, 0.0, &full);
    first_order(0.9, 0.0, &reduced);
    reduced.A.val[0] = 1.0;
    assert_ok(verify_states(&full, &reduced, &none, &found));
    assert_false(
        ritz_measure_holds(ritz_measures_find(&found, "growth-relative")));
    ritz_measures_free(&found);
    full.A.val[0] = 1.0;
    assert_ok(verify_states(&full, &reduced, &none, &found));
    assert_true(
        ritz_measure_holds(ritz_measures_find(&found, "growth-relative")));
}

static void models_of_other_names_are_refused(void **)
{
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};
    ritz_verify_request request = none;
    ritz_measures found = {0};

    first_order(1.0, 0.0, &full);
    first_order(0.9, 0.0, &reduced);
    request.limit[RITZ_MEASURE_RESPONSE] = 1.0;
    assert_fails(verify_states(&full, &reduced, &request, &found),
                 RITZ_ERR_ARGUMENT, "needs --band-hz");
    request.band_hz[0] = 3.0;
    request.band_hz[1] = 2.0;
    assert_fails(verify_states(&full, &reduced, &request, &found),
                 RITZ_ERR_ARGUMENT,
                 "a band from 3 to 2 Hz is not a band of frequencies");
    snprintf(reduced.output[0], sizeof reduced.output[0], "z");
    assert_fails(verify_states(&full, &reduced, &none, &found),
                 RITZ_ERR_ARGUMENT, "output 1 is 'y'");
}

static ritz_status verify_and_drop(const ritz_state_space *full,
                                   const ritz_state_space *reduced)
{
    ritz_verify_request request = none;
    RITZ_OWN(ritz_measures) found = {0};
    ritz_status status = RITZ_OK;

    request.band_hz[1] = 1.0;
    status = verify_states(full, reduced, &request, &found);
    return status;
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(ritz_state_space) full = {0}, reduced = {0};

    first_order(1.0, 5.0, &full);
    first_order(0.9, 5.0, &reduced);
    assert_survives_every_allocation(verify_and_drop(&full, &reduced));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_tenth_missing_is_a_tenth_by_every_measure),
    cmocka_unit_test(the_error_is_held_to_the_bound_that_came_with_it),
    cmocka_unit_test(a_bound_is_not_missed_by_rounding_beside_a_slow_pole),
    cmocka_unit_test(outputs_are_divided_by_their_limits),
    cmocka_unit_test(rigid_motions_of_both_are_left_out_of_norms),
    cmocka_unit_test(what_reaches_an_output_at_once_has_no_h2_norm),
    cmocka_unit_test(growth_fails_unless_the_full_model_grows_too),
    cmocka_unit_test(models_of_other_names_are_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(verify_states, tests, NULL, NULL)
