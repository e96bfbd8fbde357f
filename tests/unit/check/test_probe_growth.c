/* How large a free motion becomes before it dies: what the probe measures. */
#include "project.h"
#include "spaces.h"
#include "testing.h"

#include "base/alloc.h"
#include "check/check.h"

#include <ritz/check.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Of n columns, without an interface. */
static ritz_check of_columns(int64_t n, const double *K, const double *M,
                             const double *D)
{
    RITZ_OWN(ritz_reduced) model = {0};
    const double *from[] = {K, M, D};
    ritz_dense *to[] = {&model.K, &model.M, &model.D};
    RITZ_OWN(ritz_audit) audit = {0};
    ritz_check check;

    for (int k = 0; k < 3; k++) {
        assert_ok(ritz_dense_new(n, n, to[k]));
        memcpy(to[k]->val, from[k], (size_t)(n * n) * sizeof *K);
    }
    assert_ok(ritz_columns_new(n, &model.columns));
    assert_ok(ritz_io_new(n, 0, 0, &model.io));
    assert_ok(ritz_audit_reduced(&model, &audit));
    check = *find_check(&audit, "energy-growth");
    return check;
}

static ritz_check of_states(int64_t n, const double *A)
{
    double *B = calloc((size_t)n, sizeof *B);
    ritz_state_space model = {0};
    ritz_audit audit = {0};
    ritz_check check;

    assert_non_null(B);
    assert_ok(
        spaces_make(&(spaces_rows){n, 1, 1, A, B, B, NULL, NULL}, &model));
    assert_ok(ritz_audit_states(&model, &audit));
    check = *find_check(&audit, "energy-growth");
    ritz_audit_free(&audit);
    ritz_state_space_free(&model);
    free(B);
    return check;
}

/*
 * Masses 1 and 1 on springs 1 and 2 to the ground and 4 between them; dashpots
 * of 1 and -0.1 to the ground. By SciPy's expm at the same moments:
 * 1.1072573859702 at 0.7045 s, square of the condition of eigenvectors 2.603.
 */
static void energy_is_met_at_fourths_of_octaves(void **)
{
    static const double K[] = {5, -4, -4, 6}, M[] = {1, 0, 0, 1};
    static const double D[] = {1, 0, 0, -0.1};
    ritz_check check = of_columns(2, K, M, D);

    assert_int_equal(check.verdict, RITZ_WARN);
    /* e^(A h) to eps, squared ten times */
    assert_near(check.value, 1.1072573859702, 1e-12);
    assert_string_equal(check.where, "after 0.705 s");
    assert_non_null(strstr(check.says, "energy of a free motion"));
    assert_non_null(strstr(check.says, "2.6 at most"));
}

/* The same beside a mode of 1e4 rad/s, 14 octaves faster. */
static void slow_growth_is_met_beside_a_fast_mode(void **)
{
    static const double K[] = {5, -4, 0, -4, 6, 0, 0, 0, 1e8};
    static const double M[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const double D[] = {1, 0, 0, 0, -0.1, 0, 0, 0, 10};
    ritz_check check = of_columns(3, K, M, D);

    assert_int_equal(check.verdict, RITZ_WARN);
    /* by a fine scan of SciPy's expm the peak is 1.107791; fourths of octaves
       come within a factor of 2^(1/8) of its time, 0.5 % of what it is */
    assert_true(check.value <= 1.107791 && check.value > 1.1022);
}

/*
 * [-1 c; 0 -4] turned by 45 degrees, which no units of states undo:
 * |e^(A t)| is c (e^-t - e^-4t) / 3 for large c, most at t = ln 4 / 3.
 */
static void growth_that_poles_do_not_explain_warns(void **)
{
    const double c[] = {2e4, 3e5};

    for (int k = 0; k < 2; k++) {
        const double A[] = {(-5 - c[k]) / 2, (3 + c[k]) / 2, (3 - c[k]) / 2,
                            (-5 + c[k]) / 2};
        double t = log(4.0) / 3.0, due = c[k] * (exp(-t) - exp(-4.0 * t)) / 3.0;
        ritz_check check = of_states(2, A);

        /* poles -1 and -4 explain 16, and an error of 1e-3 may grow to all;
           poles are known to eps |A| times their condition, c^2 / 3 */
        assert_near(check.limit, 16e6,
                    16e6 * 8.0 * DBL_EPSILON * c[k] * c[k] / 3.0);
        assert_int_equal(check.verdict, k == 0 ? RITZ_PASS : RITZ_WARN);
        /* met within 2^(1/8) of its time: 0.7 % below; terms of 1 beside c */
        assert_true(check.value <= due * due * (1.0 + 1e-3));
        assert_true(check.value >= 0.993 * due * due);
        assert_non_null(strstr(check.says, "square of scaled states"));
    }
}

/* A motor that drives a load in other units, and the load not the motor. */
static void a_coupling_one_way_is_a_matter_of_units(void **)
{
    static const double A[] = {-1, 1e9, 0, -2};
    ritz_check check = of_states(2, A);

    assert_int_equal(check.verdict, RITZ_PASS);
    assert_near(check.value, 1.0, 1e-6);
}

/*
 * Masses of 1 between walls on springs of 1, each with a dashpot of 0.01 to
 * the ground, in displacements and velocities: a velocity of the slowest mode
 * displaces by 1 / w. |s|^2 = 4 sin^2(k pi / 2 (n + 1)).
 */
static void wide_bands_explain_what_grows(void **)
{
    enum { N = 20, STATES = 2 * N };
    const double pi = 3.14159265358979323846;
    double *A = calloc((size_t)STATES * STATES, sizeof *A);
    double fast = sin(N * pi / (2.0 * (N + 1)));
    double slow = sin(pi / (2.0 * (N + 1)));
    ritz_check check;

    assert_non_null(A);
    for (int i = 0; i < N; i++) {
        double *row = A + (size_t)(N + i) * STATES;

        A[i * STATES + N + i] = 1.0;
        row[i] = -2.0;
        row[N + i] = -0.01;
        if (i > 0)
            row[i - 1] = 1.0;
        if (i < N - 1)
            row[i + 1] = 1.0;
    }
    check = of_states(STATES, A);
    assert_int_equal(check.verdict, RITZ_PASS);
    /* n eps of the fastest in the slowest, and twice that squared */
    assert_near(check.limit, 1e6 * pow(fast / slow, 2.0),
                1e6 * pow(fast / slow, 4.0) * STATES * DBL_EPSILON);
    assert_true(check.value > 10.0 && check.value < pow(fast / slow, 2.0));
    free(A);
}

static void more_than_400_states_are_bounded_alone(void **)
{
    enum { N = 401 };
    double *A = calloc((size_t)N * N, sizeof *A);
    ritz_check check;

    assert_non_null(A);
    for (int i = 0; i < N; i++)
        A[i * (N + 1)] = -1.0 - i;
    check = of_states(N, A);
    assert_int_equal(check.verdict, RITZ_PASS);
    assert_string_equal(check.where, "not followed, of more than 400 states");
    assert_non_null(strstr(check.says, "1 at most"));
    free(A);
}

static void growth_survives_every_allocation(void **)
{
    static const double rows[] = {-150002.5, 150001.5, -149998.5, 149997.5};
    static const double B[] = {1, 0};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_audit) audit = {0};

    assert_ok(
        spaces_make(&(spaces_rows){2, 1, 1, rows, B, B, NULL, NULL}, &model));
    assert_survives_every_allocation(ritz_audit_states(&model, &audit));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(energy_is_met_at_fourths_of_octaves),
    cmocka_unit_test(slow_growth_is_met_beside_a_fast_mode),
    cmocka_unit_test(growth_that_poles_do_not_explain_warns),
    cmocka_unit_test(a_coupling_one_way_is_a_matter_of_units),
    cmocka_unit_test(wide_bands_explain_what_grows),
    cmocka_unit_test(more_than_400_states_are_bounded_alone),
    cmocka_unit_test(growth_survives_every_allocation),
};

TEST_MODULE(probe_growth, tests, NULL, NULL)
