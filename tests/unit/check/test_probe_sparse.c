/*
 * Stability of sparse state spaces: proven by falling energy, judged by the
 * poles near 0, and unstable models.
 */
#include "testing.h"

#include "spaces.h"

#include <ritz/check.h>

#include <stdio.h>

static ritz_probe probe_of(const ritz_state_space *model)
{
    ritz_probe probe = {0};

    assert_ok(ritz_probe_states(model, &probe));
    return probe;
}

static void falling_energy_is_proof(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    char text[2 * RITZ_NAME_SIZE];
    ritz_probe probe = {0};

    assert_ok(spaces_rod(200, 0.05, true, &rod));
    probe = probe_of(&rod);
    assert_int_equal(probe.verdict, RITZ_STABLE);
    assert_int_equal(probe.unseen, 0);
    ritz_probe_print(&probe, text);
    assert_null(strstr(text, "not looked at"));
}

/* The entry 30 makes A + A' indefinite, so that energy proves nothing. The
   check finds 20 poles, all of them stable, and says that it has not looked at
   the other 180. */
static void without_a_proof_the_poles_not_looked_at_are_counted(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    char text[2 * RITZ_NAME_SIZE];
    ritz_probe probe = {0};

    assert_ok(spaces_rod(200, 0.0, false, &rod));
    rod.sA.val[1] = 30.0; /* A(1, 0) */
    rod.sA.val[2] = 1.0 / 30.0;
    probe = probe_of(&rod);
    assert_int_equal(probe.verdict, RITZ_STABLE);
    assert_int_equal(probe.unseen, 180);
    ritz_probe_print(&probe, text);
    assert_non_null(strstr(text, "rightmost of 20 near 0; 180 not looked at"));
    assert_near(probe.pole[0], spaces_rod_pole(200, 0.0, 1), 1e-9);
}

static void unstable_and_marginal_models_are_found(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    ritz_probe probe;

    assert_ok(spaces_rod(200, 0.0, true, &rod));
    rod.sA.val[0] = rod.sA.val[rod.sA.colptr[200] - 1] = -1.0;
    /* insulated rod: a pole at 0 */
    assert_int_equal(probe_of(&rod).verdict, RITZ_MARGINAL);
    /* heated: the pole at 0.8 is not among the 20 poles nearest to 0 */
    rod.sA.val[0] = 0.0;
    probe = probe_of(&rod);
    assert_int_equal(probe.verdict, RITZ_UNSTABLE);
    assert_string_equal(probe.why, "1 real poles are right of the axis");
    /* weakly heated, unsymmetric: an unstable pole near 0 */
    rod.sA.val[0] = -0.999;
    rod.sA.val[1] = 1.5;
    rod.sA.val[2] = 1.0 / 1.5;
    probe = probe_of(&rod);
    assert_int_equal(probe.verdict, RITZ_UNSTABLE);
    assert_true(probe.pole[0] > 0.0);
}

static void too_many_states_for_dense_checks_are_checked_by_poles(void **)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_audit) audit = {0};

    assert_ok(spaces_rod(3100, 0.0, true, &rod));
    assert_ok(ritz_audit_states(&rod, &audit));
    assert_int_equal(audit.count, 1);
    assert_string_equal(audit.check[0].name, "poles");
    assert_int_equal(audit.check[0].verdict, RITZ_PASS);
    assert_string_equal(audit.check[0].says, "all are left of the axis");
}

/* Rounding splits a double pole at 0 into two poles, one of them right of the
   axis: both count as 0. */
static void a_free_chain_is_marginal(void **)
{
    RITZ_OWN(ritz_state_space) chain = {0};
    ritz_probe probe;

    assert_ok(spaces_chains(1, 100, true, &chain));
    probe = probe_of(&chain);
    assert_int_equal(probe.verdict, RITZ_MARGINAL);
    assert_true(probe.pole[0] == 0.0 && probe.pole[1] == 0.0);
}

static ritz_status probe_rod(double wind)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    ritz_probe probe = {0};

    RITZ_CHECK(spaces_rod(9, wind, true, &rod));
    return ritz_probe_states(&rod, &probe);
}

static void every_allocation_may_fail(void **)
{
    assert_survives_every_allocation(probe_rod(0.0));
    assert_survives_every_allocation(probe_rod(0.4));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(falling_energy_is_proof),
    cmocka_unit_test(without_a_proof_the_poles_not_looked_at_are_counted),
    cmocka_unit_test(unstable_and_marginal_models_are_found),
    cmocka_unit_test(too_many_states_for_dense_checks_are_checked_by_poles),
    cmocka_unit_test(a_free_chain_is_marginal),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(probe_sparse, tests, NULL, NULL)
