#include "testing.h"

#include "gramians/projection.h"
#include "linear/general.h"
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

/* Gramians by projection, whose Hankel values must agree with those of SLICOT
   within the bound and rounding. */
static ritz_gramians agree(ritz_gramians_request request)
{
    ritz_gramians found;

    request.engine = RITZ_ENGINE_PROJECTION;
    found = gramians_like_slicot(request, 1e-11);
    assert_true(found.error <= 1e-8);
    assert_true(found.residual[0] <= 1e-8 && found.residual[1] <= 1e-8);
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

/* The space contains the one mode. */
static void an_oscillator_has_closed_form_hankel_values(void **state)
{
    (void)state;
    assert_true(oscillators_have_closed_form(RITZ_ENGINE_PROJECTION, 0.0) ==
                0.0);
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
    mass_row_damper(8.0, 0.0, &held);
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
    error = hankel_difference(&found, &dense);
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
    mass_row_damper(2.0, 5.0, &held);
    for (int k = 0; k < 4; k++) {
        ritz_gramians_request request = mass_row_rayleigh(&held, 0.2, 0.02);

        hold_bound(&request, tolerance[k]);
    }
}

/* S A S', A symmetric */
static void turn(const ritz_dense *S, ritz_dense *A)
{
    RITZ_OWN(ritz_dense) SA = {0};

    assert_ok(ritz_dense_mul(S, A, &SA));
    ritz_dense_free(A);
    assert_ok(ritz_dense_mul_nt(&SA, S, A));
}

/* |S A S'|, Frobenius norm. */
static double norm_of(const ritz_dense *S, ritz_dense *A)
{
    double sum = 0.0;

    turn(S, A);
    for (int64_t j = 0; j < A->ncol; j++)
        sum += ritz_dense_dot(A, j, A, j);
    return sqrt(sum);
}

/* S of the norm |S R S'| of an equation: S'S = diag(M, K_s^-1) for
   controllability, diag(K_s^-1, w_0^2 K_s^-1) for observability. Blocks of S are
   L' of M = L L' and L^-1 of K_s = L L'. */
static ritz_dense energy_norm(const ritz_low_rank_model *low, int side)
{
    const int64_t n = low->n;
    const double mu = low->Phi.ncol > 0 ? low->lowest : 0.0;
    RITZ_OWN(ritz_dense) M = {0}, K = {0}, L = {0}, inverse = {0};
    ritz_dense S = {0};
    double rcond = 0.0;

    assert_ok(ritz_sparse_dense(&low->M, &M));
    assert_ok(ritz_sparse_dense(&low->K, &K));
    ritz_dense_add(mu, &M, &K);
    assert_ok(ritz_general_cholesky(&M, &rcond));
    assert_ok(ritz_general_cholesky(&K, &rcond));
    for (int64_t j = 1; j < n; j++)
        for (int64_t i = 0; i < j; i++)
            ritz_dense_col(&M, j)[i] = ritz_dense_col(&K, j)[i] = 0.0;
    assert_ok(ritz_dense_identity(n, &inverse));
    assert_ok(ritz_general_transpose(&M, &L));
    assert_ok(ritz_general_solve(&K, false, &inverse));
    assert_ok(ritz_dense_new(2 * n, 2 * n, &S));
    ritz_dense_put(side == RITZ_CONTROLLABLE ? &L : &inverse, 0, 0, &S);
    for (int64_t k = 0; side == RITZ_OBSERVABLE && k < n * n; k++)
        inverse.val[k] *= sqrt(low->lowest);
    ritz_dense_put(&inverse, n, n, &S);
    return S;
}

/* A for controllability, A' for observability. */
static ritz_dense first_order(const ritz_low_rank_model *low, int side)
{
    const int64_t n = low->n;
    RITZ_OWN(ritz_dense) K = {0}, D = {0}, identity = {0};
    ritz_dense A = {0};

    assert_ok(ritz_sparse_dense(&low->K, &K));
    assert_ok(ritz_sparse_dense(&low->D, &D));
    assert_ok(ritz_dense_identity(n, &identity));
    for (int64_t k = 0; k < n * n; k++) {
        K.val[k] *= -1.0;
        D.val[k] *= -1.0;
    }
    assert_ok(ritz_dense_new(2 * n, 2 * n, &A));
    ritz_dense_put(&identity, side == RITZ_CONTROLLABLE ? 0 : n,
                   side == RITZ_CONTROLLABLE ? n : 0, &A);
    ritz_dense_put(&K, side == RITZ_CONTROLLABLE ? n : 0,
                   side == RITZ_CONTROLLABLE ? 0 : n, &A);
    ritz_dense_put(&D, n, n, &A);
    return A;
}

/* Norm of A Z (E Z)' + E Z (A Z)' + W W' relative to that of W W', from whole
   matrices; E is symmetric. */
static double residual_of(const ritz_low_rank_model *low, int side,
                          const ritz_gramians *found)
{
    const int64_t n = low->n;
    const ritz_dense *Z = side == RITZ_CONTROLLABLE ? &found->Zc : &found->Zo;
    const ritz_dense *const W = low->W[side];
    RITZ_OWN(ritz_dense) S = energy_norm(low, side);
    RITZ_OWN(ritz_dense) A = first_order(low, side);
    RITZ_OWN(ritz_dense) E = {0}, M = {0}, EZ = {0}, AZ = {0}, F = {0};
    RITZ_OWN(ritz_dense) FF = {0}, R = {0}, Rt = {0};
    double load = 0.0;

    assert_ok(ritz_dense_identity(2 * n, &E));
    assert_ok(ritz_sparse_dense(&low->M, &M));
    ritz_dense_put(&M, n, n, &E);
    assert_ok(ritz_dense_mul(&E, Z, &EZ));
    assert_ok(ritz_dense_mul(&A, Z, &AZ));
    assert_ok(ritz_dense_mul_nt(&AZ, &EZ, &R));
    assert_ok(ritz_general_transpose(&R, &Rt));
    assert_ok(ritz_dense_new(2 * n, W[RITZ_BELOW].ncol, &F));
    ritz_dense_put(&W[RITZ_ABOVE], 0, 0, &F);
    ritz_dense_put(&W[RITZ_BELOW], n, 0, &F);
    assert_ok(ritz_dense_mul_nt(&F, &F, &FF));
    ritz_dense_add(1.0, &Rt, &R);
    ritz_dense_add(1.0, &FF, &R);
    load = norm_of(&S, &FF);
    return norm_of(&S, &R) / load;
}

/* @return the larger residual */
static double hold_residuals(const ritz_component *row, double tolerance)
{
    ritz_gramians_request request = mass_row_rayleigh(row, 0.2, 0.02);
    RITZ_OWN(ritz_projection_model) model = {0};
    RITZ_OWN(ritz_gramians) found = {0};

    request.tolerance = tolerance;
    assert_ok(ritz_projection_model_new(&request, &model));
    assert_ok(ritz_gramians_projection(&request, &found));
    for (int side = 0; side < RITZ_SIDES; side++) {
        assert_true(found.residual[side] <= tolerance);
        /* rounding of the smallest vectors, measured 8e-11 */
        assert_near(found.residual[side], residual_of(&model.low, side, &found),
                    1e-9);
    }
    return fmax(found.residual[0], found.residual[1]);
}

/* With spaces smaller than the model, held and free, with and without a damper
   and outputs of velocities. */
static void residuals_are_those_of_the_large_equations(void **state)
{
    const double tolerance[] = {0.9, 0.3, 0.1, 1e-2};
    RITZ_OWN(ritz_component) held = mass_row(100.0);
    RITZ_OWN(ritz_component) body = mass_row(0.0);
    double largest = 0.0;

    (void)state;
    keep_first(&held);
    keep_first(&body);
    ritz_dense_col(&held.io.Cv, 3)[0] = 0.7;
    for (int k = 0; k < 4; k++) {
        largest = fmax(largest, hold_residuals(&held, tolerance[k]));
        largest = fmax(largest, hold_residuals(&body, tolerance[k]));
    }
    assert_true(largest > 1e-3); /* spaces were not exact */
    ritz_dense_col(&held.io.Cv, 3)[0] = 0.0;
    mass_row_damper(2.0, 5.0, &held);
    largest = 0.0;
    for (int k = 0; k < 4; k++)
        largest = fmax(largest, hold_residuals(&held, tolerance[k]));
    assert_true(largest > 1e-4);
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
        assert_true(hankel_difference(&found, &exact) <= found.error + 1e-13);
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
    assert_near(hankel_difference(&values, &exact), 0.0, 1e-10);
}

/* Most modes are damped beyond critical. Without shifts nearly as many vectors of
   K^-1 M as there are masses would be needed to reach them. */
static void shifts_reach_strongly_damped_modes(void **state)
{
    double m[MANY], k[MANY];
    RITZ_OWN(ritz_component) row = long_row(1e4, m, k);
    ritz_gramians_request request = mass_row_rayleigh(&row, 0.05, 0.5);
    RITZ_OWN(ritz_gramians) exact = {0}, found = {0};
    const char lead[] = "projection, ";
    char *rest = NULL;

    (void)state;
    request.engine = RITZ_ENGINE_MODAL;
    assert_ok(ritz_gramians_of_component(&request, &exact));
    assert_ok(ritz_gramians_projection(&request, &found));
    assert_true(found.residual[0] <= 1e-8 && found.residual[1] <= 1e-8);
    assert_true(fmax(found.residual[0], found.residual[1]) > 1e-14);
    assert_true(hankel_difference(&found, &exact) <= found.error + 1e-13);
    assert_memory_equal(found.engine, lead, strlen(lead));
    assert_true(strtol(found.engine + strlen(lead), &rest, 10) < MANY / 2);
    assert_non_null(strstr(rest, " vectors, "));
    assert_non_null(strstr(rest, " shifts"));
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
    assert_true(hankel_difference(&found, &exact) <= found.error + 1e-12);
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
    mass_row_damper(2.0, 0.0, &body);
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
    request.damping.b = 0.5;
    refuse(&request, RITZ_ERR_CONVERGENCE, "the Gramians leave residuals of ");
    request.tolerance = -1.0;
    refuse(&request, RITZ_ERR_ARGUMENT, "a tolerance is between 0 and 1");
    assert_ok(ritz_state_space_of_component(&row, &request.damping, &model));
    assert_fails(
        ritz_gramians_of_space_by(&model, RITZ_ENGINE_PROJECTION, NULL, &none),
        RITZ_ERR_ARGUMENT, "take engine 'low-rank'");
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

/* A space with a shift. */
static void no_allocation_failure_leaks_with_shifts(void **state)
{
    double m[MANY], k[MANY];
    RITZ_OWN(ritz_component) row = {0};
    ritz_gramians_request request = {0};
    RITZ_OWN(ritz_gramians) found = {0};

    (void)state;
    for (int64_t i = 0; i < 24; i++) {
        m[i] = 1.0;
        k[i] = 1e4;
    }
    assert_ok(masses_component(24, m, k, NULL, &row));
    assert_ok(masses_io(&row, 1, (int64_t[]){23}, 1, (int64_t[]){0}));
    request = mass_row_rayleigh(&row, 0.05, 0.5);
    request.tolerance = 1e-3;
    assert_survives_every_allocation(
        ritz_gramians_projection(&request, &found));
    assert_non_null(strstr(found.engine, "shifts"));
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
    cmocka_unit_test(residuals_are_those_of_the_large_equations),
    cmocka_unit_test(shifts_reach_strongly_damped_modes),
    cmocka_unit_test(few_vectors_give_the_values_of_all_modes),
    cmocka_unit_test(a_free_row_stays_free_of_rigid_motion),
    cmocka_unit_test(balancing_uses_projected_gramians),
    cmocka_unit_test(damping_of_another_form_is_refused),
    cmocka_unit_test(impossible_requests_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
    cmocka_unit_test(no_allocation_failure_leaks_with_shifts),
};

TEST_MODULE(projection, tests, NULL, NULL)
