#include "testing.h"

#include "gramians/modes.h"
#include "mass_row.h"
#include "masses.h"

static void refuse(const ritz_gramians_request *request, ritz_status expected,
                   const char *words)
{
    ritz_gramians none = {0};

    assert_int_equal(ritz_gramians_low_rank(request, &none), expected);
    if (!strstr(ritz_error_message(), words))
        fail_msg("'%s' is not in '%s'", words, ritz_error_message());
    assert_null(none.Zc.val);
}

static void damping_that_is_no_matrix_is_refused(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    ritz_gramians_request request = mass_row_rayleigh(&held, 0.0, 0.0);

    (void)state;
    request.damping = (ritz_damping){.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    refuse(&request, RITZ_ERR_ARGUMENT, "take engine 'modal'");
    request.damping = (ritz_damping){0};
    refuse(&request, RITZ_ERR_ARGUMENT, "there is no damping");
    request = mass_row_rayleigh(&held, 0.1, 0.1);
    request.tolerance = -1.0;
    refuse(&request, RITZ_ERR_ARGUMENT, "a tolerance is between 0 and 1");
    request.tolerance = 0.0;
    assert_ok(ritz_sparse_copy(&held.K, &held.K4));
    refuse(&request, RITZ_ERR_ARGUMENT, "structural damping");
}

/* A dashpot that drives, one that leaves modes undamped, one to ground. */
static void motion_that_does_not_decay_is_refused(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0), body = mass_row(0.0);
    ritz_gramians_request request = {.component = &held};
    const int64_t at[] = {6};
    const double drive[] = {-1.0}, pull[] = {1.0};

    (void)state;
    assert_ok(ritz_sparse_from_triplets(MASS_ROW, MASS_ROW, 1, at, at, drive,
                                        &held.D));
    refuse(&request, RITZ_ERR_ARGUMENT, "is not damped, or even fed, by D");
    assert_ok(ritz_sparse_from_triplets(MASS_ROW, MASS_ROW, 1, at, at, pull,
                                        &body.D));
    request.component = &body;
    refuse(&request, RITZ_ERR_ARGUMENT,
           "damping couples rigid motion to deformation");
}

static void what_has_no_states_is_refused(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row_massless(8);
    ritz_gramians_request request = mass_row_rayleigh(&held, 0.1, 1e-3);

    (void)state;
    refuse(&request, RITZ_ERR_ARGUMENT, "grid 4 T1 has no mass but is damped");
    request = mass_row_rayleigh(&held, 0.1, 0.0);
    ritz_dense_col(&held.io.Cv, 8)[1] = 1.0;
    refuse(&request, RITZ_ERR_ARGUMENT,
           "an output is the velocity of a dof without mass");
}

static void no_allocation_failure_leaks(void **state)
{
    const double m[] = {1.0, 0.0, 2.0}, k[] = {0.0, 3.0, 4.0};
    RITZ_OWN(ritz_component) body = {0};
    ritz_gramians_request request = {0};
    RITZ_OWN(ritz_gramians) low = {0};

    (void)state;
    assert_ok(masses_component(3, m, k, NULL, &body));
    assert_ok(masses_io(&body, 1, (int64_t[]){2}, 1, (int64_t[]){1}));
    ritz_dense_col(&body.io.Ca, 0)[0] = 1.0;
    request = mass_row_rayleigh(&body, 0.3, 0.0);
    assert_survives_every_allocation(ritz_gramians_low_rank(&request, &low));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(damping_that_is_no_matrix_is_refused),
    cmocka_unit_test(motion_that_does_not_decay_is_refused),
    cmocka_unit_test(what_has_no_states_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(low_rank_limits, tests, NULL, NULL)
