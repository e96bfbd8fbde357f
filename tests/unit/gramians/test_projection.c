#include "testing.h"

#include "gramians/projection.h"
#include "mass_row.h"
#include "masses.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MANY = 150 };

/* Largest difference of Hankel values, relative to the largest value of b. */
static double differ(const ritz_gramians *a, const ritz_gramians *b)
{
    int64_t count = 0, expected = 0;
    double *sigma = NULL, *exact = NULL;
    double most = 0.0;

    assert_ok(ritz_gramians_hankel(a, &count, &sigma));
    assert_ok(ritz_gramians_hankel(b, &expected, &exact));
    assert_true(count > 0 && expected > 0 && exact[0] > 0.0);
    for (int64_t k = 0; k < count || k < expected; k++)
        most = fmax(most, fabs((k < count ? sigma[k] : 0.0) -
                               (k < expected ? exact[k] : 0.0)));
    most /= exact[0];
    free(sigma);
    free(exact);
    return most;
}

/* Gramians by projection, whose Hankel values must agree with those of SLICOT
   within the bound and rounding. */
static ritz_gramians agree(ritz_gramians_request request)
{
    ritz_gramians found = {0};
    RITZ_OWN(ritz_gramians) dense = {0};

    request.engine = RITZ_ENGINE_PROJECTION;
    assert_ok(ritz_gramians_of_component(&request, &found));
    request.engine = RITZ_ENGINE_DENSE;
    assert_ok(ritz_gramians_of_component(&request, &dense));
    assert_true(found.error <= 1e-8);
    assert_near(differ(&found, &dense), 0.0, found.error + 1e-11);
    return found;
}

/* Keep only the first input and the first output. Blocks then have two vectors,
   and a space of few blocks is smaller than the model. */
static void keep_first(ritz_component *row)
{
    for (int64_t i = 0; i < MASS_ROW; i++) {
        ritz_dense_col(&row->io.B, 1)[i] = 0.0;
        for (int64_t k = 1; k < 3; k++)
            ritz_dense_col(&row->io.C, i)[k] = 0.0;
    }
}

static void add_damper(double c, double k, ritz_component *row)
{
    assert_ok(ritz_dampers_new(MASS_ROW, 1, &row->dampers));
    snprintf(row->dampers.name[0], RITZ_NAME_SIZE, "strut");
    row->dampers.c[0] = c;
    row->dampers.k[0] = k;
    ritz_dense_col(&row->dampers.B, 0)[4] = 1.0;
    ritz_dense_col(&row->dampers.B, 0)[9] = -1.0;
}

/*
 * m u'' + d u' + k u = f, y = u: sigma = (sqrt(1 + z^2) +- z) / (4 z k)
 * [Gregory1984]. Their difference is half the static gain 1 / k.
 */
static void an_oscillator_has_closed_form_hankel_values(void **state)
{
    const double m = 2.0, k = 50.0;
    RITZ_OWN(ritz_component) one = {0};

    (void)state;
    assert_ok(masses_component(1, &m, &k, NULL, &one));
    assert_ok(masses_io(&one, 1, (int64_t[]){0}, 1, (int64_t[]){0}));
    for (int power = -3; power <= 1; power++) {
        const double z = pow(10.0, power);
        RITZ_OWN(ritz_gramians) found = {0};
        ritz_gramians_request request =
            mass_row_rayleigh(&one, 2.0 * z * sqrt(k / m), 0.0);
        double root = sqrt(1.0 + z * z), *sigma = NULL;
        double scale = 64.0 * DBL_EPSILON * (root + z) / (4.0 * z * k);
        int64_t count = 0;

        assert_ok(ritz_gramians_projection(&request, &found));
        assert_ok(ritz_gramians_hankel(&found, &count, &sigma));
        assert_int_equal(count, 2);
        assert_near(sigma[0], (root + z) / (4.0 * z * k), scale);
        assert_near(sigma[1], 1.0 / (root + z) / (4.0 * z * k), scale);
        assert_true(found.error == 0.0); /* the space contains the one mode */
        free(sigma);
    }
}

static void values_agree_with_slicot(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    const double ab[][2] = {{0.2, 1e-3}, {1e-3, 1e-5}, {0.0, 1.0}};
    ritz_gramians found = {0};

    (void)state;
    for (int k = 0; k < 3; k++) {
        found = agree(mass_row_rayleigh(&held, ab[k][0], ab[k][1]));
        assert_int_equal(found.T.ncol, 0);
        ritz_gramians_free(&found);
    }
    ritz_dense_col(&held.io.Cv, 3)[0] = 0.7;
    ritz_dense_col(&held.io.Ca, 8)[1] = 0.2;
    ritz_dense_col(&held.io.Ca, 2)[2] = 1.0;
    held.io.limit[0] = 0.1;
    found = agree(mass_row_rayleigh(&held, 0.2, 1e-3));
    ritz_gramians_free(&found);
}

/* The second input is a multiple of the first, and the second output is 0. */
static void dependent_loads_add_no_vectors(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    ritz_gramians found = {0};

    (void)state;
    ritz_dense_col(&held.io.B, 1)[9] = 0.0;
    ritz_dense_col(&held.io.B, 1)[2] = 3.0;
    ritz_dense_col(&held.io.C, 5)[1] = 0.0;
    found = agree(mass_row_rayleigh(&held, 0.5, 0.05));
    assert_true(found.Zc.ncol <= 2L * MASS_ROW);
    ritz_gramians_free(&found);
}

/* With a = 0, and with a > 0, by which the velocity of rigid motion decays. */
static void rigid_motion_is_decoupled(void **state)
{
    RITZ_OWN(ritz_component) body = mass_row(0.0);
    ritz_gramians found = {0};
    ritz_dense part = {0};

    (void)state;
    for (int a = 0; a < 2; a++) {
        found = agree(mass_row_rayleigh(&body, a ? 0.1 : 0.0, 2e-3));
        assert_int_equal(found.T.ncol, 2);
        assert_ok(ritz_dense_mul_tn(&found.W, &found.EZc, &part));
        assert_near(ritz_dense_max(&part), 0.0,
                    1e3 * DBL_EPSILON * ritz_dense_max(&found.EZc));
        ritz_dense_free(&part);
        ritz_gramians_free(&found);
    }
}

/* Forces proportional to the masses of a free body do not deform it. */
static void rigid_motion_alone_has_no_values(void **state)
{
    RITZ_OWN(ritz_component) body = mass_row(0.0);
    const ritz_gramians_request request = mass_row_rayleigh(&body, 0.0, 2e-3);
    RITZ_OWN(ritz_gramians) found = {0};
    double *sigma = NULL;
    int64_t count = -1;

    (void)state;
    for (int64_t i = 0; i < MASS_ROW; i++)
        for (int64_t j = 0; j < 2; j++)
            ritz_dense_col(&body.io.B, j)[i] = ritz_sparse_diagonal(&body.M, i);
    assert_ok(ritz_gramians_projection(&request, &found));
    assert_ok(ritz_gramians_hankel(&found, &count, &sigma));
    for (int64_t k = 0; k < count; k++)
        assert_near(sigma[k], 0.0, 1e-12);
    free(sigma);
}

/* Damping of the request, a D that is a M + b K, and dampers add up. */
static void all_kinds_of_damping_add_up(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    ritz_gramians_request request = mass_row_rayleigh(&held, 0.05, 1e-3);
    ritz_gramians found = {0};

    (void)state;
    assert_ok(ritz_sparse_add(0.1, &held.M, 2e-3, &held.K, &held.D));
    found = agree(request);
    ritz_gramians_free(&found);
    add_damper(8.0, 0.0, &held);
    found = agree(request);
    assert_string_equal(found.damping, "rayleigh 0.05 0.001");
    ritz_gramians_free(&found);
    ritz_sparse_free(&held.D);
    held.dampers.k[0] = 30.0;
    found = agree(request);
    ritz_gramians_free(&found);
}

static void models_with_massless_dofs_agree_with_slicot(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row_massless(3);
    ritz_gramians found = {0};

    (void)state;
    found = agree(mass_row_rayleigh(&held, 0.3, 0.0));
    ritz_gramians_free(&found);
    ritz_dense_col(&held.io.Cv, 8)[1] = 0.5;
    ritz_dense_col(&held.io.Ca, 8)[0] = 0.1;
    found = agree(mass_row_rayleigh(&held, 0.3, 0.0));
    ritz_gramians_free(&found);
}

/* Values differ from those of SLICOT by at most the bound, which is
   returned. */
static double hold_bound(ritz_gramians_request *request, double tolerance)
{
    RITZ_OWN(ritz_gramians) found = {0}, dense = {0};
    double error = 0.0;

    request->tolerance = tolerance;
    assert_ok(ritz_gramians_projection(request, &found));
    request->engine = RITZ_ENGINE_DENSE;
    assert_ok(ritz_gramians_of_component(request, &dense));
    error = differ(&found, &dense);
    assert_true(found.error <= tolerance);
    assert_true(error <= found.error + 1e-11);
    return found.error;
}

/* With spaces smaller than the model: 6 to 10 vectors for 12 masses. */
static void no_value_errs_by_more_than_the_bound(void **state)
{
    const double tolerance[] = {0.9, 0.3, 0.1, 0.03};
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    RITZ_OWN(ritz_component) body = mass_row(0.0);
    double largest = 0.0;

    (void)state;
    keep_first(&held);
    keep_first(&body);
    for (int k = 0; k < 4; k++) {
        ritz_gramians_request request = mass_row_rayleigh(&held, 0.2, 0.02);

        largest = fmax(largest, hold_bound(&request, tolerance[k]));
        request.component = &body;
        hold_bound(&request, tolerance[k]);
    }
    assert_true(largest > 1e-4); /* spaces were not exact */
    ritz_dense_col(&held.io.Cv, 3)[0] = 0.7;
    add_damper(2.0, 5.0, &held);
    for (int k = 0; k < 4; k++) {
        ritz_gramians_request request = mass_row_rayleigh(&held, 0.2, 0.02);

        hold_bound(&request, tolerance[k]);
    }
}

/* A row of 150 equal masses and springs, the first mass held by a spring of
   stiffness `ground`; 0: free. m and k are working memory. */
static ritz_component long_row(double ground, double *m, double *k)
{
    ritz_component row = {0};

    for (int64_t i = 0; i < MANY; i++) {
        m[i] = 1.0;
        k[i] = i > 0 ? 1e4 : ground;
    }
    assert_ok(masses_component(MANY, m, k, NULL, &row));
    assert_ok(masses_io(&row, 1, (int64_t[]){MANY - 1}, 1, (int64_t[]){0}));
    return row;
}

static void few_vectors_give_the_values_of_all_modes(void **state)
{
    double m[MANY], k[MANY];
    RITZ_OWN(ritz_component) row = long_row(1e4, m, k);
    ritz_gramians_request request = mass_row_rayleigh(&row, 0.05, 0.02);
    RITZ_OWN(ritz_gramians) exact = {0}, values = {0};

    (void)state;
    request.engine = RITZ_ENGINE_MODAL;
    assert_ok(ritz_gramians_of_component(&request, &exact));
    for (int power = -2; power >= -11; power -= 3) {
        const double tolerance = pow(10.0, power);
        RITZ_OWN(ritz_gramians) found = {0};
        const char lead[] = "projection, ";
        long vectors = 0;

        request.tolerance = tolerance;
        assert_ok(ritz_gramians_projection(&request, &found));
        assert_true(found.error <= tolerance);
        assert_true(differ(&found, &exact) <= found.error + 1e-13);
        assert_memory_equal(found.engine, lead, strlen(lead));
        vectors = strtol(found.engine + strlen(lead), NULL, 10);
        assert_true(vectors > 0);
        assert_true(vectors < 2 * MANY / 3);
        if (tolerance > 1e-3)
            assert_true(found.error > 1e-8);
    }
    request.values_only = true;
    assert_ok(ritz_gramians_projection(&request, &values));
    assert_int_equal(values.Zc.ncol + values.Zo.ncol + values.EZc.ncol, 0);
    assert_near(differ(&values, &exact), 0.0, 1e-10);
}

/* Rounding must not let rigid motion into the space, however many vectors. */
static void a_free_row_stays_free_of_rigid_motion(void **state)
{
    double m[MANY], k[MANY];
    RITZ_OWN(ritz_component) row = long_row(0.0, m, k);
    ritz_gramians_request request = mass_row_rayleigh(&row, 0.02, 1e-3);
    RITZ_OWN(ritz_gramians) exact = {0}, found = {0};

    (void)state;
    request.engine = RITZ_ENGINE_MODAL;
    assert_ok(ritz_gramians_of_component(&request, &exact));
    request.tolerance = 1e-10;
    assert_ok(ritz_gramians_projection(&request, &found));
    assert_true(found.error <= 1e-10);
    assert_true(differ(&found, &exact) <= found.error + 1e-12);
}

/* W'E T = I, and the bound of a balanced basis includes that of the values. */
static void balancing_uses_projected_gramians(void **state)
{
    enum { KEPT = 6 };
    double m[MANY], k[MANY];
    RITZ_OWN(ritz_component) row = long_row(1e4, m, k);
    ritz_gramians_request request = mass_row_rayleigh(&row, 0.05, 0.02);
    RITZ_OWN(ritz_gramians) found = {0};
    RITZ_OWN(ritz_balanced) balanced = {0};
    RITZ_OWN(ritz_dense) ET = {0}, G = {0};

    (void)state;
    request.tolerance = 1e-6;
    assert_ok(ritz_gramians_projection(&request, &found));
    assert_ok(ritz_gramians_balance(&found, KEPT, 0.0, &balanced));
    assert_int_equal(balanced.kept, KEPT);
    assert_near(balanced.bound,
                ritz_hankel_bound(balanced.count, balanced.sigma, KEPT) +
                    found.error * balanced.sigma[0],
                1e-15 * balanced.bound);
    assert_ok(ritz_dense_copy(&balanced.T, &ET)); /* masses are 1: E = I */
    assert_ok(ritz_dense_mul_tn(&balanced.W, &ET, &G));
    for (int64_t j = 0; j < KEPT; j++)
        for (int64_t i = 0; i < KEPT; i++)
            assert_near(ritz_dense_col(&G, j)[i], i == j ? 1.0 : 0.0, 1e-9);
}

static void refuse(const ritz_gramians_request *request, ritz_status expected,
                   const char *words)
{
    ritz_gramians none = {0};

    assert_fails(ritz_gramians_projection(request, &none), expected, words);
    assert_null(none.core[0].val);
}

static void damping_of_another_form_is_refused(void **state)
{
    RITZ_OWN(ritz_component) held = mass_row(100.0), body = mass_row(0.0);
    ritz_gramians_request request = mass_row_rayleigh(&held, 0.0, 0.0);
    const int64_t at[] = {6};
    const double pull[] = {1.0};
    bool fits = true;

    (void)state;
    request.damping = (ritz_damping){.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    refuse(&request, RITZ_ERR_ARGUMENT, "take engine 'modal'");
    assert_ok(ritz_projection_fits(&request, &fits));
    assert_false(fits);
    request.damping = (ritz_damping){0};
    refuse(&request, RITZ_ERR_ARGUMENT, "there is no damping");
    assert_ok(ritz_projection_fits(&request, &fits));
    assert_false(fits);
    assert_ok(ritz_sparse_from_triplets(MASS_ROW, MASS_ROW, 1, at, at, pull,
                                        &held.D));
    refuse(&request, RITZ_ERR_ARGUMENT, "the damping matrix is not a M + b K");
    assert_ok(ritz_projection_fits(&request, &fits));
    assert_false(fits);
    ritz_sparse_free(&held.D);
    assert_ok(ritz_sparse_add(-0.1, &held.M, 0.0, &held.K, &held.D));
    refuse(&request, RITZ_ERR_ARGUMENT, "does not damp every motion");
    request = mass_row_rayleigh(&body, 0.1, 0.1);
    assert_ok(ritz_projection_fits(&request, &fits));
    assert_true(fits);
    add_damper(2.0, 0.0, &body);
    ritz_dense_col(&body.dampers.B, 0)[9] = 0.0;
    refuse(&request, RITZ_ERR_ARGUMENT,
           "damping couples rigid motion to deformation");
}

/* Too few vectors allowed, a tolerance below 0, and a state space. */
static void impossible_requests_are_refused(void **state)
{
    double m[MANY], k[MANY];
    RITZ_OWN(ritz_component) row = long_row(1e4, m, k);
    ritz_gramians_request request = mass_row_rayleigh(&row, 0.05, 0.02);
    RITZ_OWN(ritz_state_space) model = {0};
    ritz_gramians none = {0};

    (void)state;
    request.most = 40;
    refuse(&request, RITZ_ERR_CONVERGENCE,
           "of the largest, 1.0e-08 is required");
    refuse(&request, RITZ_ERR_CONVERGENCE,
           "the Gramians are not found in a space of 40 vectors");
    request.tolerance = -1.0;
    refuse(&request, RITZ_ERR_ARGUMENT, "a tolerance is between 0 and 1");
    assert_ok(ritz_state_space_of_component(&row, &request.damping, &model));
    assert_fails(
        ritz_gramians_of_space_by(&model, RITZ_ENGINE_PROJECTION, NULL, &none),
        RITZ_ERR_ARGUMENT, "a state space has no modes");
}

static void no_allocation_failure_leaks(void **state)
{
    const double m[] = {1.0, 0.5, 2.0, 1.0}, k[] = {0.0, 3.0, 4.0, 2.0};
    RITZ_OWN(ritz_component) body = {0};
    ritz_gramians_request request = {0};
    RITZ_OWN(ritz_gramians) found = {0};

    (void)state;
    assert_ok(masses_component(4, m, k, NULL, &body));
    assert_ok(masses_io(&body, 1, (int64_t[]){2}, 1, (int64_t[]){1}));
    assert_ok(ritz_dampers_new(4, 1, &body.dampers));
    body.dampers.c[0] = 1.0;
    ritz_dense_col(&body.dampers.B, 0)[1] = 1.0;
    ritz_dense_col(&body.dampers.B, 0)[2] = -1.0;
    request = mass_row_rayleigh(&body, 0.3, 0.01);
    request.tolerance = 0.9;
    assert_survives_every_allocation(
        ritz_gramians_projection(&request, &found));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_oscillator_has_closed_form_hankel_values),
    cmocka_unit_test(values_agree_with_slicot),
    cmocka_unit_test(dependent_loads_add_no_vectors),
    cmocka_unit_test(rigid_motion_is_decoupled),
    cmocka_unit_test(rigid_motion_alone_has_no_values),
    cmocka_unit_test(all_kinds_of_damping_add_up),
    cmocka_unit_test(models_with_massless_dofs_agree_with_slicot),
    cmocka_unit_test(no_value_errs_by_more_than_the_bound),
    cmocka_unit_test(few_vectors_give_the_values_of_all_modes),
    cmocka_unit_test(a_free_row_stays_free_of_rigid_motion),
    cmocka_unit_test(balancing_uses_projected_gramians),
    cmocka_unit_test(damping_of_another_form_is_refused),
    cmocka_unit_test(impossible_requests_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(projection, tests, NULL, NULL)
