/* Responses of modes that few dampers couple. */
#include "testing.h"

#include "poles/poles.h"

#include <ritz/verify.h>

#include <complex.h>

enum { MODES = 12, DAMPERS = 2, POINTS = 200 };

static const double pi = 3.14159265358979323846;

/* A number in [-1, 1), the same for one k. */
static double noise(int k)
{
    uint64_t state = (uint64_t)k;

    return 2.0 * ritz_random_next(&state) - 1.0;
}

/* Modes of 1 to MODES rad/s with `columns` dampers of ratios near 1, and modal
   damping. */
typedef struct damped_modes {
    ritz_dense K, M, D;
    ritz_io io;
    ritz_poles poles;
} damped_modes;

static void open_modes(int columns, double zeta, damped_modes *out)
{
    const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = zeta};
    ritz_second_order model = {&out->K, &out->M, &out->D, NULL, &out->io};

    assert_ok(ritz_dense_new(MODES, MODES, &out->K));
    assert_ok(ritz_dense_new(MODES, MODES, &out->M));
    assert_ok(ritz_dense_new(MODES, MODES, &out->D));
    assert_ok(ritz_io_new(MODES, 2, 1, &out->io));
    for (int j = 0; j < MODES; j++) {
        ritz_dense_col(&out->K, j)[j] = (double)((j + 1) * (j + 1));
        ritz_dense_col(&out->M, j)[j] = 1.0;
        ritz_dense_col(&out->io.B, 0)[j] = noise(j);
        ritz_dense_col(&out->io.B, 1)[j] = 1.0;
        ritz_dense_col(&out->io.C, j)[0] = noise(100 + j);
        for (int i = 0; i < MODES; i++)
            for (int k = 0; k < columns; k++)
                ritz_dense_col(&out->D, j)[i] +=
                    noise(1000 * (k + 1) + i) * noise(1000 * (k + 1) + j);
    }
    assert_ok(ritz_poles_of_dense(&model, zeta > 0.0 ? &damping : NULL, 0.0,
                                  &out->poles));
}

static void damped_modes_free(damped_modes *m)
{
    ritz_dense_free(&m->K);
    ritz_dense_free(&m->M);
    ritz_dense_free(&m->D);
    ritz_io_free(&m->io);
    ritz_poles_free(&m->poles);
}

/* Responses to both inputs at w rad/s, with L or without it. */
static void solve_at(damped_modes *m, double w, bool few, double _Complex *q)
{
    const ritz_dense L = m->poles.L;

    if (!few)
        m->poles.L = (ritz_dense){0};
    assert_ok(
        ritz_poles_solve(&m->poles, false, &m->poles.io.B, w / (2.0 * pi), q));
    m->poles.L = L;
}

/* With modal damping of 1e-3 and dampers of ratios near 1, three digits cancel
   of sixteen; at the poles without dampers too. */
static void few_dampers_give_the_whole_system_s_response(void **state)
{
    RITZ_OWN(damped_modes) m = {0};

    (void)state;
    open_modes(DAMPERS, 1e-3, &m);
    assert_int_equal(m.poles.L.ncol, DAMPERS);
    for (int k = 0; k < POINTS; k++) {
        const double w = 0.1 * k;
        double _Complex few[2 * MODES], whole[2 * MODES];
        double largest = 0.0;

        solve_at(&m, w, true, few);
        solve_at(&m, w, false, whole);
        for (int j = 0; j < 2 * MODES; j++)
            largest = fmax(largest, cabs(whole[j]));
        for (int j = 0; j < 2 * MODES; j++)
            assert_near(cabs(few[j] - whole[j]), 0.0, 1e-11 * largest);
    }
}

/* b = L: L'Z^-1 L = s / (1 + i w s) with s = sum L_j^2 / (j^2 - w^2). */
static void one_damper_has_a_closed_form(void **state)
{
    RITZ_OWN(damped_modes) m = {0};
    const double w = 2.5;
    double _Complex q[2 * MODES], sum = 0.0, expected = 0.0;
    double s = 0.0;

    (void)state;
    open_modes(1, 0.0, &m);
    assert_int_equal(m.poles.L.ncol, 1);
    for (int j = 0; j < MODES; j++) {
        const double l = ritz_dense_col(&m.poles.L, 0)[j];

        assert_near(fabs(l), fabs(noise(1000 + j)), 1e-14);
        s += l * l / ((double)((j + 1) * (j + 1)) - w * w);
        ritz_dense_col(&m.poles.io.B, 0)[j] = l;
    }
    solve_at(&m, w, true, q);
    for (int j = 0; j < MODES; j++)
        sum += ritz_dense_col(&m.poles.L, 0)[j] * q[j];
    expected = s / ritz_complex(1.0, w * s);
    assert_near(cabs(sum - expected), 0.0, 1e-12 * cabs(expected));
}

/* At an undamped pole that a damper holds the whole system is solved, whose
   response is finite; that of a mode without a damper is infinite. */
static void poles_without_dampers_are_left_to_the_whole_system(void **state)
{
    RITZ_OWN(damped_modes) m = {0};
    double _Complex few[2 * MODES], whole[2 * MODES];
    bool solved = true;

    (void)state;
    open_modes(1, 0.0, &m);
    assert_ok(ritz_few_dampers_solve(&m.poles, &m.poles.io.B, 3.0 / (2.0 * pi),
                                     &solved, few));
    assert_false(solved);
    solve_at(&m, 3.0, true, few);
    solve_at(&m, 3.0, false, whole);
    assert_memory_equal(few, whole, sizeof few);
    for (int k = 0; k < MODES; k++) /* mode 3 has no damper */
        ritz_dense_col(&m.poles.D, 2)[k] = ritz_dense_col(&m.poles.D, k)[2] =
            0.0;
    ritz_dense_col(&m.poles.L, 0)[2] = 0.0;
    assert_fails(
        ritz_poles_solve(&m.poles, false, &m.poles.io.B, 3.0 / (2.0 * pi), few),
        RITZ_ERR_SINGULAR, "is infinite: an undamped mode");
}

/* A matrix of full rank, and one that gives energy, are no few dampers. */
static void other_matrices_have_no_such_factor(void **state)
{
    RITZ_OWN(damped_modes) m = {0};
    RITZ_OWN(ritz_dense) L = {0};

    (void)state;
    open_modes(MODES, 1e-3, &m);
    assert_int_equal(m.poles.L.ncol, 0);
    ritz_poles_free(&m.poles);
    memset(m.D.val, 0, MODES * MODES * sizeof *m.D.val);
    ritz_dense_col(&m.D, 0)[0] = 1.0;
    ritz_dense_col(&m.D, 1)[0] = ritz_dense_col(&m.D, 0)[1] = 1.0;
    assert_ok(ritz_few_dampers(&m.D, &L));
    assert_int_equal(L.ncol, 0);
}

static ritz_status solve_once(damped_modes *m)
{
    double _Complex q[2 * MODES];
    RITZ_OWN(ritz_dense) L = {0};

    RITZ_CHECK(ritz_few_dampers(&m->D, &L));
    return ritz_poles_solve(&m->poles, false, &m->poles.io.B, 0.3, q);
}

static void few_dampers_survive_every_allocation(void **state)
{
    RITZ_OWN(damped_modes) m = {0};

    (void)state;
    open_modes(DAMPERS, 1e-3, &m);
    assert_survives_every_allocation(solve_once(&m));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(few_dampers_give_the_whole_system_s_response),
    cmocka_unit_test(one_damper_has_a_closed_form),
    cmocka_unit_test(poles_without_dampers_are_left_to_the_whole_system),
    cmocka_unit_test(other_matrices_have_no_such_factor),
    cmocka_unit_test(few_dampers_survive_every_allocation),
};

TEST_MODULE(few_dampers, tests, NULL, NULL)
