/* Zeros of bodies that are free: of their rigid motions only what is driven and
   seen counts. */
#include "masses.h"
#include "testing.h"

#include <ritz/poles.h>

#include <complex.h>
#include <stdlib.h>

enum { N = 9, NONE = -1 };

/*
 * In x the masses 1 - 0 - 2, in y 4 - 3 - 5, in z three that nothing holds or
 * joins, all of it in coordinates that mix every motion with every other.
 */
typedef struct bodies {
    ritz_dense K, M, D;
    ritz_io io;
    ritz_second_order model;
} bodies;

static const double mass[N] = {2.0, 0.5, 3.0, 1.0, 0.7, 0.2, 4.0, 0.3, 0.9};
static const double stiff[2][2] = {{8.0, 75.0}, {5e4, 3.0}};
static const double rate[2][2] = {{0.2, 0.9}, {7.0, 0.1}};

/* X := Q X of Q = I - 2 v v'/v'v, a reflection that is along no axis. */
static void reflect(int64_t n, double *x, int64_t stride)
{
    double sum = 0.0, size = 0.0;

    for (int64_t i = 0; i < n; i++) {
        double v = 1.0 + 0.37 * (double)(i * i % 7);

        sum += v * x[i * stride];
        size += v * v;
    }
    for (int64_t i = 0; i < n; i++)
        x[i * stride] -= 2.0 * (1.0 + 0.37 * (double)(i * i % 7)) * sum / size;
}

static void mix(ritz_dense *A)
{
    for (int64_t j = 0; j < N; j++)
        reflect(N, A->val + j * N, 1);
    for (int64_t i = 0; i < N; i++)
        reflect(N, A->val + i, N);
    ritz_dense_symmetrise(A);
}

static void join(ritz_dense *A, int64_t i, int64_t j, double k)
{
    ritz_dense_col(A, i)[i] += k;
    ritz_dense_col(A, j)[j] += k;
    ritz_dense_col(A, j)[i] -= k;
    ritz_dense_col(A, i)[j] -= k;
}

/* A damper to the ground at mass `grounded`, if that is one. */
static void bodies_new(bool damped, int64_t grounded, bodies *out)
{
    bodies s = {0};

    assert_ok(ritz_dense_new(N, N, &s.K));
    assert_ok(ritz_dense_new(N, N, &s.M));
    if (damped)
        assert_ok(ritz_dense_new(N, N, &s.D));
    for (int64_t i = 0; i < N; i++)
        ritz_dense_col(&s.M, i)[i] = mass[i];
    for (int body = 0; body < 2; body++)
        for (int arm = 0; arm < 2; arm++) {
            int64_t root = 3L * body, tip = root + 1 + arm;

            join(&s.K, root, tip, stiff[body][arm]);
            if (damped)
                join(&s.D, root, tip, rate[body][arm]);
        }
    if (grounded != NONE)
        ritz_dense_col(&s.D, grounded)[grounded] += 1.5;
    mix(&s.K);
    mix(&s.M);
    if (damped)
        mix(&s.D);
    *out = s;
}

static void bodies_ends(bodies *s, int64_t count, const int64_t *in,
                        const int64_t *seen)
{
    ritz_io_free(&s->io);
    assert_ok(ritz_io_new(N, count, count, &s->io));
    for (int64_t j = 0; j < count; j++) {
        ritz_dense_col(&s->io.B, j)[in[j]] = 1.0;
        reflect(N, ritz_dense_col(&s->io.B, j), 1);
        ritz_dense_col(&s->io.C, seen[j])[j] = 1.0;
        reflect(N, s->io.C.val + j, count);
    }
    s->model =
        (ritz_second_order){.K = &s->K, .M = &s->M, .D = &s->D, .io = &s->io};
}

static void bodies_free(bodies *s)
{
    ritz_dense_free(&s->K);
    ritz_dense_free(&s->M);
    ritz_dense_free(&s->D);
    ritz_io_free(&s->io);
}

/* m s^2 + c s + k = 0, above the axis. */
static double _Complex root_of(double m, double c, double k)
{
    return (-c + csqrt(c * c - 4.0 * m * k)) / (2.0 * m);
}

static void expect_zeros(const bodies *s, int64_t at, int64_t count,
                         const double _Complex *due)
{
    double _Complex *zero = NULL;
    int64_t found = 0;

    assert_ok(ritz_zeros_of(ritz_model_of_dense(&s->model, NULL), at, at,
                            &found, &zero));
    assert_int_equal(found, count);
    for (int64_t k = 0; k < count; k++) {
        double nearest = HUGE_VAL;

        for (int64_t j = 0; j < found; j++)
            nearest = fmin(nearest, cabs(zero[j] - due[k]));
        /* measured 3.4e-12 beside poles of 350 rad/s */
        assert_near(nearest, 0.0, 1e-11 * cabs(due[k]));
    }
    free(zero);
}

/* The arms of the driven root alone, each held there. */
static void zeros_of_a_free_root_are_its_arms(void **state)
{
    const int64_t root = 0;

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        double _Complex due[4];
        bodies s;

        bodies_new(damped, NONE, &s);
        bodies_ends(&s, 1, &root, &root);
        for (int arm = 0; arm < 2; arm++) {
            due[2 * arm] = root_of(mass[1 + arm], damped ? rate[0][arm] : 0.0,
                                   stiff[0][arm]);
            due[2 * arm + 1] = conj(due[2 * arm]);
        }
        expect_zeros(&s, 0, 4, due);
        bodies_free(&s);
    }
}

/* An output sees mass `at` too. */
static void look_also(bodies *s, int64_t output, int64_t at, double factor)
{
    double from[N] = {0};

    from[at] = factor;
    reflect(N, from, 1);
    for (int64_t k = 0; k < N; k++)
        ritz_dense_col(&s->io.C, k)[output] += from[k];
}

/* Driven and seen at the root and one arm: the other arm's zeros, and poles of
   flexible motions of the body beside; no pair of its rigid ones, nor of a
   third body's that is seen and does not move. */
static void of_all_channels_no_rigid_motion_is_left_over(void **state)
{
    const int64_t ends[] = {0, 1};

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        double _Complex *zero = NULL, due = 0.0;
        double nearest = HUGE_VAL;
        int64_t count = 0;
        bodies s;

        bodies_new(damped, NONE, &s);
        bodies_ends(&s, 2, ends, ends);
        look_also(&s, 1, 6, 1.0);
        assert_ok(ritz_zeros_of(ritz_model_of_dense(&s.model, NULL),
                                RITZ_ALL_CHANNELS, RITZ_ALL_CHANNELS, &count,
                                &zero));
        assert_int_equal(count, 2 + 4);
        due = root_of(mass[2], damped ? rate[0][1] : 0.0, stiff[0][1]);
        for (int64_t j = 0; j < count; j++) {
            assert_true(cabs(zero[j]) > 1.0);
            nearest = fmin(nearest, cabs(zero[j] - due));
        }
        /* measured 1.3e-12, beside poles of 350 rad/s */
        assert_near(nearest, 0.0, 1e-10);
        free(zero);
        bodies_free(&s);
    }
}

/* One arm held by a spring of 1e-8 of the stiffest: 2 zeros near 0, its own. */
static void true_zeros_near_rest_stay(void **state)
{
    const double m[] = {2.0, 0.5, 3.0}, k[] = {0.0, 1e4, 1e-4};
    const int64_t ends[] = {1};
    double _Complex *zero = NULL;
    double due = sqrt(k[2] / m[2]);
    ritz_component row = {0};
    int64_t count = 0;

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        const double c[] = {0.0, 0.3, 1e-4};

        assert_ok(masses_component(3, m, k, damped ? c : NULL, &row));
        assert_ok(masses_io(&row, 1, ends, 1, ends));
        assert_ok(ritz_zeros_of(ritz_model_of_component(&row, NULL), 0, 0,
                                &count, &zero));
        assert_int_equal(count, 4);
        for (int j = 0; j < 2; j++)
            /* measured 1.1e-9 of it, beside poles of 158 rad/s */
            assert_near(cabs(zero[j]), due, 1e-6 * due);
        free(zero);
        ritz_component_free(&row);
    }
}

/* A damper at the root takes its rigid motion out of those that are free:
   (m s^2 + c s) of a root alone has a pole at 0 and no zero. */
static void a_loaded_rigid_motion_stays(void **state)
{
    const int64_t root = 0, alone = 6;
    double _Complex due[4];
    bodies s;

    (void)state;
    bodies_new(true, 0, &s);
    bodies_ends(&s, 1, &root, &root);
    for (int arm = 0; arm < 2; arm++) {
        due[2 * arm] = root_of(mass[1 + arm], rate[0][arm], stiff[0][arm]);
        due[2 * arm + 1] = conj(due[2 * arm]);
    }
    expect_zeros(&s, 0, 4, due);
    bodies_ends(&s, 1, &alone, &alone);
    expect_zeros(&s, 0, 0, NULL);
    bodies_free(&s);
}

/* Pushed at the root, seen from there to an arm: the other arm's zeros; s^2
   of the difference cancels the poles of the motion as one. Likewise beside
   another body that moves by itself. */
static void what_an_output_does_not_see_is_no_zero(void **state)
{
    const int64_t root[] = {3, 6}, arm[] = {4, 6};

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        double _Complex due[2], *zero = NULL;
        int64_t count = 0;
        bodies s;

        bodies_new(damped, NONE, &s);
        due[0] = root_of(mass[5], damped ? rate[1][1] : 0.0, stiff[1][1]);
        due[1] = conj(due[0]);
        for (int64_t both = 1; both <= 2; both++) {
            bodies_ends(&s, both, root, arm);
            look_also(&s, 0, root[0], -1.0);
            if (both == 1)
                expect_zeros(&s, 0, 2, due);
        }
        assert_ok(ritz_zeros_of(ritz_model_of_dense(&s.model, NULL),
                                RITZ_ALL_CHANNELS, RITZ_ALL_CHANNELS, &count,
                                &zero));
        assert_int_equal(count, 2 + 4);
        for (int64_t k = 0; k < count; k++)
            assert_true(cabs(zero[k]) > 1.0);
        free(zero);
        bodies_free(&s);
    }
}

/* y = c'q of q'' = b u in the plane, pushed and seen off the middle:
   (1 / m + arm^2 / J) / s^2 has no zero, as long as it is not 0 for all s. */
static void a_rigid_plate_has_none(void **state)
{
    const double inertia[] = {3.0, 3.0, 0.4};
    const double push[] = {1.0, 0.0, 0.3}, across[] = {0.0, 1.0, 0.0};
    ritz_dense K = {0}, M = {0};
    RITZ_OWN(ritz_io) io = {0};
    ritz_second_order model = {.K = &K, .M = &M, .io = &io};
    double _Complex *zero = NULL;
    int64_t count = 1;

    (void)state;
    assert_ok(ritz_dense_new(3, 3, &K));
    assert_ok(ritz_dense_new(3, 3, &M));
    assert_ok(ritz_io_new(3, 1, 1, &io));
    for (int64_t i = 0; i < 3; i++) {
        ritz_dense_col(&M, i)[i] = inertia[i];
        io.B.val[i] = io.C.val[i] = push[i];
    }
    assert_ok(
        ritz_zeros_of(ritz_model_of_dense(&model, NULL), 0, 0, &count, &zero));
    assert_int_equal(count, 0);
    free(zero);
    assert_ok(ritz_zeros_of(ritz_model_of_dense(&model, NULL),
                            RITZ_ALL_CHANNELS, RITZ_ALL_CHANNELS, &count,
                            &zero));
    assert_int_equal(count, 0);
    free(zero);
    memcpy(io.C.val, across, sizeof across);
    assert_fails(
        ritz_zeros_of(ritz_model_of_dense(&model, NULL), 0, 0, &count, &zero),
        RITZ_ERR_SINGULAR, "nothing passes");
    assert_fails(ritz_zeros_of(ritz_model_of_dense(&model, NULL),
                               RITZ_ALL_CHANNELS, RITZ_ALL_CHANNELS, &count,
                               &zero),
                 RITZ_ERR_SINGULAR, "nothing passes");
    ritz_dense_free(&K);
    ritz_dense_free(&M);
}

static ritz_status forget(const bodies *s, const ritz_component *row)
{
    ritz_status status = RITZ_OK;
    double _Complex *zero = NULL;
    int64_t count = 0;

    RITZ_TRY(ritz_zeros_of(ritz_model_of_dense(&s->model, NULL), 0, 0, &count,
                           &zero));
    free(zero);
    zero = NULL;
    RITZ_TRY(
        ritz_zeros_of(ritz_model_of_component(row, NULL), 0, 0, &count, &zero));
done:
    free(zero);
    return status;
}

static void free_bodies_survive_every_allocation(void **state)
{
    const double m[] = {2.0, 0.5}, k[] = {0.0, 8.0}, c[] = {0.0, 0.2};
    const int64_t root = 0;
    RITZ_OWN(ritz_component) row = {0};
    bodies s;

    (void)state;
    bodies_new(true, NONE, &s);
    bodies_ends(&s, 1, &root, &root);
    assert_ok(masses_component(2, m, k, c, &row));
    assert_ok(masses_io(&row, 1, &root, 1, &root));
    assert_survives_every_allocation(forget(&s, &row));
    bodies_free(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(zeros_of_a_free_root_are_its_arms),
    cmocka_unit_test(of_all_channels_no_rigid_motion_is_left_over),
    cmocka_unit_test(true_zeros_near_rest_stay),
    cmocka_unit_test(a_loaded_rigid_motion_stays),
    cmocka_unit_test(what_an_output_does_not_see_is_no_zero),
    cmocka_unit_test(a_rigid_plate_has_none),
    cmocka_unit_test(free_bodies_survive_every_allocation),
};

TEST_MODULE(zeros_free, tests, NULL, NULL)
