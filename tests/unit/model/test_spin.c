/*
 * Terms of a spin against sums over the points of a body; rates over time
 * against their definitions.
 */
#include "testing.h"

#include "base/tolerances.h"
#include "base/vector.h"
#include "drafts.h"
#include "model/spin.h"

#include <math.h>

static const double axis[3] = {2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0};
static const double through[3] = {0.3, -0.2, 0.7};

/* v_j . w of the sums: product, and position less c times momentum. */
static void turn(const double v[3], double out[3])
{
    ritz_cross(axis, v, out);
}

/* Grids with masses of their own: an ordinary sum over points. */
typedef struct cloud {
    ritz_component body;
    ritz_dense T;
    double mass[DRAFT_NODES];
} cloud;

static void cloud_free(cloud *c)
{
    ritz_component_free(&c->body);
    ritz_dense_free(&c->T);
}

static ritz_status cloud_new(cloud *out)
{
    draft d = {0};
    RITZ_OWN(cloud) c = {0};

    draft_frame(&d);
    for (int64_t k = 0; k < d.nodes; k++) {
        c.mass[k] = 1.0 + 0.3 * (double)k;
        for (int64_t a = 0; a < 3; a++)
            draft_add(&d, 6 * k + a, 6 * k + a, c.mass[k]);
        d.frame[k] = 0;
    }
    RITZ_CHECK(draft_component(&d, &c.body));
    RITZ_CHECK(ritz_dense_new(c.body.num_dofs, DRAFT_COLUMNS, &c.T));
    for (int64_t k = 0; k < c.T.nrow * c.T.ncol; k++)
        c.T.val[k] = draft_noise(k);
    draft_free(&d);
    RITZ_MOVE(*out, c);
    return RITZ_OK;
}

/* Add the terms of one point by their definitions. */
static void add_point(const cloud *c, int64_t k, double G[DRAFT_COLUMNS][5],
                      double S[DRAFT_COLUMNS][5], double load[2][5])
{
    const double m = c->mass[k];
    double x[3], nx[3], nnx[3];

    for (int a = 0; a < 3; a++)
        x[a] = c->body.grids.position[3 * k + a] - through[a];
    turn(x, nx);
    turn(nx, nnx);
    for (int64_t i = 0; i < DRAFT_COLUMNS; i++) {
        const double *v = ritz_dense_col(&c->T, i) + 6 * k;

        load[0][i] -= m * ritz_dot(v, nnx);
        load[1][i] -= m * ritz_dot(v, nx);
        for (int64_t j = 0; j < DRAFT_COLUMNS; j++) {
            const double *w = ritz_dense_col(&c->T, j) + 6 * k;
            double nv[3], nw[3];

            turn(v, nv);
            turn(w, nw);
            G[i][j] += 2.0 * m * ritz_dot(v, nw);
            S[i][j] -= m * ritz_dot(nv, nw);
        }
    }
}

static void terms_are_sums_over_points(void **)
{
    RITZ_OWN(cloud) c = {0};
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(ritz_spin_terms) terms = {0};
    double G[5][5] = {{0}}, S[5][5] = {{0}}, load[2][5] = {{0}};

    assert_ok(cloud_new(&c));
    assert_ok(ritz_invariants_of(&c.body, &c.T, &invariants));
    assert_ok(ritz_spin_terms_of(&invariants, axis, through, &terms));
    for (int64_t k = 0; k < c.body.grids.count; k++)
        add_point(&c, k, G, S, load);
    for (int64_t i = 0; i < DRAFT_COLUMNS; i++) {
        for (int j = 0; j < 2; j++)
            assert_near(ritz_dense_col(&terms.load, j)[i], load[j][i],
                        draft_rounding);
        for (int64_t j = 0; j < DRAFT_COLUMNS; j++) {
            assert_near(ritz_dense_col(&terms.G, j)[i], G[i][j],
                        draft_rounding);
            assert_near(ritz_dense_col(&terms.S, j)[i], S[i][j],
                        draft_rounding);
        }
    }
}

static void gyroscopic_terms_are_skew_and_softening_symmetric(void **)
{
    RITZ_OWN(cloud) c = {0};
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(ritz_spin_terms) terms = {0};

    assert_ok(cloud_new(&c));
    assert_ok(ritz_invariants_of(&c.body, &c.T, &invariants));
    assert_ok(ritz_spin_terms_of(&invariants, axis, through, &terms));
    assert_true(ritz_dense_asymmetry(&terms.S) < draft_rounding);
    for (int64_t i = 0; i < DRAFT_COLUMNS; i++)
        for (int64_t j = 0; j < DRAFT_COLUMNS; j++)
            assert_near(ritz_dense_col(&terms.G, j)[i],
                        -ritz_dense_col(&terms.G, i)[j], draft_rounding);
}

/* For a rotation about the axis itself S is -J, the Euler load -J and the
   centrifugal load 0; J is the moment of inertia. */
static void a_rigid_turn_has_the_inertia(void **)
{
    RITZ_OWN(cloud) c = {0};
    RITZ_OWN(ritz_invariants) invariants = {0};
    RITZ_OWN(ritz_spin_terms) terms = {0};
    RITZ_OWN(ritz_dense) turned = {0};
    double J = 0.0;

    assert_ok(cloud_new(&c));
    assert_ok(ritz_dense_new(c.T.nrow, 1, &turned));
    for (int64_t k = 0; k < c.body.grids.count; k++) {
        double x[3], nx[3];

        for (int a = 0; a < 3; a++)
            x[a] = c.body.grids.position[3 * k + a] - through[a];
        turn(x, nx);
        for (int a = 0; a < 3; a++) {
            turned.val[6 * k + a] = nx[a];
            turned.val[6 * k + 3 + a] = axis[a];
        }
        J += c.mass[k] * ritz_dot(nx, nx);
    }
    assert_ok(ritz_invariants_of(&c.body, &turned, &invariants));
    assert_ok(ritz_spin_terms_of(&invariants, axis, through, &terms));
    assert_near(terms.inertia, J, draft_rounding * J);
    assert_near(terms.S.val[0], -J, draft_rounding * J);
    assert_near(terms.load.val[1], -J, draft_rounding * J);
    assert_near(terms.load.val[0], 0.0, draft_rounding * J);
    assert_near(terms.G.val[0], 0.0, draft_rounding * J);
}

static void a_spin_model_keeps_only_its_terms(void **)
{
    for (int model = 0; model < 3; model++) {
        RITZ_OWN(ritz_spin_terms) terms = {0};

        assert_ok(ritz_dense_new(1, 1, &terms.G));
        assert_ok(ritz_dense_new(1, 1, &terms.S));
        assert_ok(ritz_dense_new(1, 1, &terms.KG));
        assert_ok(ritz_dense_new(1, 2, &terms.load));
        ritz_spin_terms_keep((ritz_spin_model)model, &terms);
        assert_int_equal(terms.KG.val != NULL, model == RITZ_SPIN_CONSISTENT);
        assert_int_equal(terms.S.val != NULL, model != RITZ_SPIN_RUTHLESS);
        assert_int_equal(terms.G.val != NULL, model != RITZ_SPIN_RUTHLESS);
        assert_non_null(terms.load.val);
    }
}

static void a_body_without_invariants_is_refused(void **)
{
    const ritz_invariants none = {0};
    ritz_spin_terms terms = {0};

    assert_fails(ritz_spin_terms_of(&none, axis, through, &terms),
                 RITZ_ERR_ARGUMENT, "no inertia invariants");
}

/*
 * One dof, K = 9, S = -1, KG = 3 d. Stiffness is definite up to
 * W^2 = 9 / (1 - 3 d), and stiffening is negligible as long as
 * 3 d W^2 <= ((1 + e)^2 - 1) (9 - W^2).
 */
static void limits_are_those_of_one_dof(void **)
{
    double k = 9.0, s = -1.0, kg = 0.1, load[2] = {0.0, 0.0};
    const ritz_dense K = {1, 1, &k};
    const ritz_spin_terms terms = {
        .S = {1, 1, &s}, .KG = {1, 1, &kg}, .load = {1, 2, load}};
    const double d = 1.01 * 1.01 - 1.0;
    ritz_spin_limits limits = {0};

    assert_ok(ritz_spin_limits_of(&terms, &K, NULL, 0.01, &limits));
    assert_near(limits.stable, sqrt(9.0 / 0.9), 1e-14);
    assert_near(limits.negligible, sqrt(9.0 * d / (kg + d)), 1e-14);
    kg = -0.1; /* compression: (1 - e)^2 */
    assert_ok(ritz_spin_limits_of(&terms, &K, NULL, 0.01, &limits));
    assert_near(limits.stable, sqrt(9.0 / 1.1), 1e-14);
    assert_near(limits.negligible,
                sqrt(9.0 * (1.0 - 0.99 * 0.99) / (0.1 + 1.0 - 0.99 * 0.99)),
                1e-14);
}

static void a_model_without_terms_has_no_limits(void **)
{
    double k = 9.0, load[2] = {0.0, 0.0};
    const ritz_dense K = {1, 1, &k};
    const ritz_spin_terms terms = {.load = {1, 2, load}};
    ritz_spin_limits limits = {0};

    assert_ok(ritz_spin_limits_of(&terms, &K, NULL, 0.01, &limits));
    assert_true(isinf(limits.stable) && isinf(limits.negligible));
}

/* The acceleration is the derivative of the rate, and the rate that of the
   angle. Central differences over h have an error of h^2 / 6 times third
   derivatives, which are (2 pi)^2 2 for a ramp of a second. */
static void assert_courses_agree(const ritz_spin_rate *rate, double t)
{
    const double h = 1e-4, bound = 2e-7;

    assert_near(
        (ritz_spin_rate_at(rate, t + h) - ritz_spin_rate_at(rate, t - h)) /
            (2.0 * h),
        ritz_spin_acceleration_at(rate, t), bound);
    assert_near(
        (ritz_spin_angle_at(rate, t + h) - ritz_spin_angle_at(rate, t - h)) /
            (2.0 * h),
        ritz_spin_rate_at(rate, t), bound);
}

static void rates_are_derivatives_of_angles(void **)
{
    double time[] = {1.0, 3.0, 4.0}, value[] = {2.0, -1.0, 5.0};
    const ritz_spin_rate courses[] = {
        {RITZ_SPIN_CONSTANT, 1, time, value},
        {RITZ_SPIN_PROFILE, 3, time, value},
        {RITZ_SPIN_RAMP, 1, time, value},
    };

    for (int k = 0; k < 3; k++) {
        for (int j = 1; j < 12; j++) /* at no corner of a course */
            assert_courses_agree(&courses[k], 0.43 * j);
        assert_near(ritz_spin_angle_at(&courses[k], 0.0), 0.0, 0.0);
    }
}

/* A ramp is the spin-up of [KaneRyanBanerjee1987]: (2/5) (t - (7.5/pi)
   sin(pi t / 7.5)), then 6 rad/s. */
static void a_ramp_is_the_classical_spin_up(void **)
{
    double time = 15.0, value = 6.0;
    const ritz_spin_rate rate = {RITZ_SPIN_RAMP, 1, &time, &value};

    for (int k = 0; k < 15; k++) {
        const double t = 0.5 + k;

        assert_near(ritz_spin_rate_at(&rate, t),
                    0.4 * (t - 7.5 / RITZ_PI * sin(RITZ_PI * t / 7.5)), 1e-14);
    }
    assert_near(ritz_spin_rate_at(&rate, 20.0), 6.0, 1e-15);
    assert_near(ritz_spin_acceleration_at(&rate, 20.0), 0.0, 1e-15);
    assert_near(ritz_spin_angle_at(&rate, 20.0), 45.0 + 30.0, 1e-13);
}

static ritz_status add_and_limit(void *of)
{
    const ritz_invariants *invariants = of;
    RITZ_OWN(ritz_spin_terms) terms = {0}, sum = {0};
    RITZ_OWN(ritz_dense) P = {0}, K = {0};
    ritz_spin_limits limits = {0};

    RITZ_CHECK(ritz_spin_terms_of(invariants, axis, through, &terms));
    RITZ_CHECK(ritz_dense_identity(DRAFT_COLUMNS, &P));
    RITZ_CHECK(ritz_dense_identity(DRAFT_COLUMNS, &K));
    RITZ_CHECK(ritz_dense_copy(&K, &terms.KG));
    RITZ_CHECK(ritz_spin_terms_add(&terms, &P, &sum));
    return ritz_spin_limits_of(&sum, &K, &P, 0.1, &limits);
}

static void every_allocation_may_fail(void **)
{
    RITZ_OWN(cloud) c = {0};
    RITZ_OWN(ritz_invariants) invariants = {0};

    assert_ok(cloud_new(&c));
    assert_ok(ritz_invariants_of(&c.body, &c.T, &invariants));
    assert_survives_every_allocation(add_and_limit(&invariants));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(terms_are_sums_over_points),
    cmocka_unit_test(gyroscopic_terms_are_skew_and_softening_symmetric),
    cmocka_unit_test(a_rigid_turn_has_the_inertia),
    cmocka_unit_test(a_spin_model_keeps_only_its_terms),
    cmocka_unit_test(a_body_without_invariants_is_refused),
    cmocka_unit_test(limits_are_those_of_one_dof),
    cmocka_unit_test(a_model_without_terms_has_no_limits),
    cmocka_unit_test(rates_are_derivatives_of_angles),
    cmocka_unit_test(a_ramp_is_the_classical_spin_up),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(spin, tests, NULL, NULL)
