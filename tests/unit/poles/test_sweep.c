/* Sums over modes for many frequencies at once, held to those of
   ritz_poles_add and ritz_residual_add, which take one after the other. */
#include "testing.h"

#include "base/alloc.h"
#include "poles/poles.h"

#include <ritz/verify.h>

#include <complex.h>
#include <math.h>
#include <string.h>

enum { MODES = 12, RIGID = 2, INPUTS = 2, OUTPUTS = 3, POINTS = 150 };
enum { VALUES = INPUTS * OUTPUTS };

static const double eps = 2.2204460492503131e-16;

static void fill(uint64_t seed, ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        A->val[k] = ritz_random_next(&seed) - 0.5;
}

/* Participations of displacements, of velocities and of accelerations. */
static void open_io(ritz_io *io)
{
    assert_ok(ritz_io_new(MODES, INPUTS, OUTPUTS, io));
    fill(1, &io->B);
    fill(2, &io->C);
    fill(3, &io->Cv);
    fill(4, &io->Ca);
    for (int64_t k = 0; k < MODES; k++) {
        ritz_dense_col(&io->Cv, k)[0] = 0.0;
        for (int64_t i = 0; i < OUTPUTS; i++)
            ritz_dense_col(&io->Ca, k)[i] *= 1e-2;
    }
}

/* Modes of 1, 2, 3, ... Hz behind the rigid ones. */
static void open_poles(double zeta, ritz_poles *poles)
{
    *poles = (ritz_poles){.count = MODES, .num_rigid = RIGID};
    poles->lambda = ritz_zalloc(MODES, sizeof *poles->lambda);
    poles->rate = ritz_zalloc(MODES, sizeof *poles->rate);
    poles->q = ritz_zalloc(MODES * INPUTS, sizeof *poles->q);
    open_io(&poles->io);
    for (int64_t k = RIGID; k < MODES; k++) {
        poles->lambda[k] = ritz_eigen_lambda((double)(k - RIGID + 1));
        poles->rate[k] = 2.0 * zeta * sqrt(poles->lambda[k]);
    }
}

/* From 0.05 Hz in steps of 0.05, and the resonances among them. */
static void take_hertz(double *hertz)
{
    for (int64_t p = 0; p < POINTS; p++)
        hertz[p] = 0.05 * (double)(p + 1);
}

/* Terms of both are the same but for the order of two products: they differ by
   some eps of the sum of their sizes, of which 1e3 is more than enough. */
static void assert_same(const double _Complex *one, const double _Complex *all)
{
    for (int64_t e = 0; e < POINTS * VALUES; e++)
        assert_near(cabs(one[e] - all[e]), 0.0, 1e3 * eps);
}

static void sums_over_modes_are_those_of_one_frequency(void **state)
{
    RITZ_OWN(ritz_poles) poles = {0};
    double hertz[POINTS];
    double _Complex one[POINTS * VALUES] = {0}, all[POINTS * VALUES] = {0};

    (void)state;
    open_poles(0.01, &poles);
    take_hertz(hertz);
    for (int64_t p = 0; p < POINTS; p++)
        assert_ok(ritz_poles_add(&poles, hertz[p], one + p * VALUES));
    assert_ok(ritz_poles_add_all(&poles, POINTS, hertz, all));
    assert_true(cabs(one[0]) > 1e-3);
    assert_same(one, all);
}

/* Without damping 1 Hz is a pole: it is refused, unless the mode takes part in
   nothing. */
static void an_undamped_pole_is_refused_if_it_matters(void **state)
{
    RITZ_OWN(ritz_poles) poles = {0};
    double hertz[POINTS];
    double _Complex one[POINTS * VALUES] = {0}, all[POINTS * VALUES] = {0};

    (void)state;
    open_poles(0.0, &poles);
    for (int64_t p = 0; p < POINTS; p++)
        hertz[p] = 0.25 * (double)(p + 1) / 37.0;
    hertz[70] = 1.0;
    assert_fails(ritz_poles_add_all(&poles, POINTS, hertz, all),
                 RITZ_ERR_SINGULAR, "is the frequency of an undamped mode");
    for (int64_t j = 0; j < INPUTS; j++)
        ritz_dense_col(&poles.io.B, j)[RIGID] = 0.0;
    memset(all, 0, sizeof all);
    for (int64_t p = 0; p < POINTS; p++)
        assert_ok(ritz_poles_add(&poles, hertz[p], one + p * VALUES));
    assert_ok(ritz_poles_add_all(&poles, POINTS, hertz, all));
    assert_same(one, all);
}

/* At rest rigid motion has an acceleration alone. */
static void rigid_motion_at_rest_is_left_to_one_frequency(void **state)
{
    RITZ_OWN(ritz_poles) poles = {0};
    double hertz[POINTS];
    double _Complex one[POINTS * VALUES] = {0}, all[POINTS * VALUES] = {0};

    (void)state;
    open_poles(0.01, &poles);
    for (int64_t k = 0; k < RIGID; k++)
        for (int64_t i = 0; i < OUTPUTS; i++)
            ritz_dense_col(&poles.io.C, k)[i] =
                ritz_dense_col(&poles.io.Cv, k)[i] = 0.0;
    take_hertz(hertz);
    hertz[0] = 0.0;
    for (int64_t p = 0; p < POINTS; p++)
        assert_ok(ritz_poles_add(&poles, hertz[p], one + p * VALUES));
    assert_ok(ritz_poles_add_all(&poles, POINTS, hertz, all));
    assert_same(one, all);
}

/* A rate d changes the response of 1 / (lambda - w^2 + i w a) by the difference
   of two sums over modes. */
static void changes_by_ratios_are_differences_of_sums(void **state)
{
    RITZ_OWN(ritz_poles) with = {0}, without = {0};
    RITZ_OWN(ritz_residual)
    rest = {.num_inputs = INPUTS,
            .num_outputs = OUTPUTS,
            .num_damped = MODES,
            .a = 0.3,
            .unit = 1.0};
    double hertz[POINTS];
    double _Complex a[POINTS * VALUES] = {0}, b[POINTS * VALUES] = {0};
    double _Complex all[POINTS * VALUES] = {0};

    (void)state;
    open_poles(0.01, &with);
    open_poles(0.0, &without);
    rest.lambda = ritz_zalloc(MODES, sizeof *rest.lambda);
    rest.rate = ritz_zalloc(MODES, sizeof *rest.rate);
    open_io(&rest.modes);
    for (int64_t k = 0; k < MODES; k++) {
        rest.lambda[k] = with.lambda[k];
        rest.rate[k] = with.rate[k];
        with.rate[k] += rest.a;
        without.rate[k] = rest.a;
    }
    take_hertz(hertz);
    assert_ok(ritz_poles_add_all(&with, POINTS, hertz, a));
    assert_ok(ritz_poles_add_all(&without, POINTS, hertz, b));
    assert_ok(ritz_residual_add_all(&rest, POINTS, hertz, all));
    for (int64_t e = 0; e < POINTS * VALUES; e++)
        a[e] -= b[e];
    assert_same(a, all);
}

static void no_allocation_is_forgotten(void **state)
{
    RITZ_OWN(ritz_poles) poles = {0};
    const double hertz = 0.5;
    double _Complex H[VALUES] = {0};

    (void)state;
    open_poles(0.01, &poles);
    assert_survives_every_allocation(ritz_poles_add_all(&poles, 1, &hertz, H));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(sums_over_modes_are_those_of_one_frequency),
    cmocka_unit_test(an_undamped_pole_is_refused_if_it_matters),
    cmocka_unit_test(rigid_motion_at_rest_is_left_to_one_frequency),
    cmocka_unit_test(changes_by_ratios_are_differences_of_sums),
    cmocka_unit_test(no_allocation_is_forgotten),
};

TEST_MODULE(sweep, tests, NULL, NULL)
