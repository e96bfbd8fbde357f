#include "testing.h"

#include "base/tolerances.h"
#include "linear/general.h"

#include <ritz/matrix.h>

#include <float.h>

static const double pi = 3.14159265358979323846;

/*
 * A chain of n equal masses and springs, fixed at one end, has lambda_1 =
 * 4 sin^2(pi / (4 n + 2)), here 1e-4 of the largest. Its dofs are out of order,
 * so that LAPACK mixes them: it errs by some eps of the largest eigenvalue.
 */
static void low_modes_of_dense_pencils_keep_their_digits(void **)
{
    enum { N = 149, STRIDE = 37 };
    const double root = sin(pi / (4.0 * N + 2.0));
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) P = {0};

    assert_ok(ritz_dense_new(N, N, &K));
    assert_ok(ritz_dense_new(N, N, &M));
    for (int64_t i = 0; i < N; i++) {
        const int64_t at = i * STRIDE % N, next = (i + 1) * STRIDE % N;

        ritz_dense_col(&M, at)[at] = 1.0;
        ritz_dense_col(&K, at)[at] = i + 1 < N ? 2.0 : 1.0;
        if (i + 1 < N)
            ritz_dense_col(&K, at)[next] = ritz_dense_col(&K, next)[at] = -1.0;
    }
    assert_ok(ritz_eigen_dense(&K, &M, &P));
    /* Rayleigh's quotient of x errs by eps of itself and by |dx|^2 of the
       largest, |dx| being some eps of the largest over the gap: 1e-12 */
    assert_near(P.lambda[0] / (4.0 * root * root), 1.0, 64 * DBL_EPSILON);
}

/*
 * light - s - heavy - k - heavy - s - light. The antisymmetric pair are roots
 * of m M l^2 - ((s + 2 k) m + s M) l + 2 k s = 0, the lower 2e-14 of the
 * higher: LAPACK alone errs by eps of that, a percent here.
 */
static void heavy_and_light_masses_keep_the_lowest_mode(void **state)
{
    const double m = 1.3, M = 1.7e8, s = 9e5, k = 1.1;
    double stiffness[16] = {s, -s, 0,     0,  -s, s + k, -k, 0,
                            0, -k, s + k, -s, 0,  0,     -s, s};
    double mass[16] = {m, 0, 0, 0, 0, M, 0, 0, 0, 0, M, 0, 0, 0, 0, m};
    const ritz_dense K_d = {.nrow = 4, .ncol = 4, .val = stiffness};
    const ritz_dense M_d = {.nrow = 4, .ncol = 4, .val = mass};
    double b = (s + 2.0 * k) * m + s * M;
    double high = (b + sqrt(b * b - 8.0 * m * M * k * s)) / (2.0 * m * M);
    double low = 2.0 * k * s / (m * M * high);
    RITZ_OWN(ritz_pairs) P = {0};

    (void)state;
    assert_ok(ritz_eigen_dense(&K_d, &M_d, &P));
    assert_int_equal(P.num_rigid, 1);
    /* what rounding of K leaves: eps |x|'|K||x| = eps 4 s / 2 M */
    assert_near(P.lambda[1], low, 16.0 * DBL_EPSILON * s / M);
    assert_near(P.lambda[3], high, 16.0 * DBL_EPSILON * high);
}

/* No digit changes, and eigenvalues ascend. */
static void modal_coordinates_are_taken_as_they_are(void **)
{
    double stiffness[9] = {3.1, 0, 0, 0, 0.0, 0, 0, 0, -12.7};
    double mass[9] = {1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0};
    const ritz_dense K = {3, 3, stiffness}, M = {3, 3, mass};
    const double lambda[] = {-12.7, 0.0, 3.1};
    const double Phi[] = {0, 0, 1.0, 0, 1.0, 0, 1.0, 0, 0};
    RITZ_OWN(ritz_pairs) P = {0};

    assert_ok(ritz_eigen_dense(&K, &M, &P));
    assert_memory_equal(P.lambda, lambda, sizeof lambda);
    assert_memory_equal(P.Phi.val, Phi, sizeof Phi);
    assert_true(P.residual[0] == 0.0);
}

/* Residuals of the modes that are kept are those of all modes, to the rounding of
   products; without them there are none, and not 0. */
static void residuals_are_computed_of_the_modes_that_are_kept(void **)
{
    enum { N = 3, KEPT = 2 };
    double stiffness[] = {2.0, -1.0, 0, -1.0, 2.0, -1.0, 0, -1.0, 1.0};
    double mass[] = {1.0, 0, 0, 0, 1.3, 0, 0, 0, 0.7};
    const ritz_dense K = {N, N, stiffness}, M = {N, N, mass};
    const ritz_span lowest = {.modes = KEPT};
    RITZ_OWN(ritz_sparse) K_s = {0}, M_s = {0};
    RITZ_OWN(ritz_pairs) all = {0}, some = {0}, none = {0};

    assert_ok(ritz_sparse_from_dense(&K, &K_s));
    assert_ok(ritz_sparse_from_dense(&M, &M_s));
    assert_ok(ritz_eigen_dense(&K, &M, &all));
    assert_ok(ritz_eigen_sparse(&K_s, &M_s, &lowest, &some));
    assert_ok(ritz_eigen_unchecked(&K, &M, &none));
    assert_int_equal(some.Phi.ncol, KEPT);
    for (int64_t k = 0; k < KEPT; k++) {
        assert_near(some.residual[k], all.residual[k], 8.0 * DBL_EPSILON);
        assert_true(isnan(none.residual[k]));
    }
}

/* An entry off the diagonal is not overlooked in either matrix, nor is a dof
   without mass, whose eigenvalue is infinite. */
static void nearly_modal_coordinates_are_solved_as_any_other(void **)
{
    double diagonal[4] = {1.0, 0, 0, 1.0}, coupled[4] = {1.0, 0.5, 0.5, 1.0};
    double massless[4] = {1.0, 0, 0, 0.0};
    const ritz_dense I = {2, 2, diagonal}, C = {2, 2, coupled};
    const ritz_dense none = {2, 2, massless};
    RITZ_OWN(ritz_pairs) stiff = {0}, heavy = {0}, less = {0};

    assert_ok(ritz_eigen_dense(&C, &I, &stiff));
    assert_near(stiff.lambda[0], 0.5, 4 * DBL_EPSILON);
    assert_near(stiff.lambda[1], 1.5, 4 * DBL_EPSILON);
    assert_ok(ritz_eigen_dense(&I, &C, &heavy));
    assert_near(heavy.lambda[0], 1.0 / 1.5, 4 * DBL_EPSILON);
    assert_near(heavy.lambda[1], 1.0 / 0.5, 4 * DBL_EPSILON);
    assert_ok(ritz_eigen_dense(&I, &none, &less));
    assert_int_equal(less.Phi.ncol, 1);
}

typedef struct spectrum {
    int64_t count;
    double lambda[10];
    double lambda_max;
    int64_t rigid;
} spectrum;

static const spectrum spectra[] = {
    {0, {0}, 0.0, 0},
    {1, {0.0}, 0.0, 1},                    /* a free mass */
    {3, {0.0, 0.0, 1.0}, 1.0, 2},          /* exact zeros */
    {4, {-3e-4, 1e-4, 1e4, 2e4}, 1e12, 2}, /* rounding, both signs */
    {3, {4e-3, 4.0, 9.0}, 4e9, 0},         /* boom: 0.01 Hz, 0.3 Hz, 25 kHz */
    {3, {12.4, 485.0, 3800.0}, 1e16, 0},   /* beam of 5000 elements */
    {4, {-1e-2, 3e-2, 4e5, 5e5}, 1e9, 2},  /* K rounded to ten digits */
    {3, {-5.0, 100.0, 200.0}, 1e6, 0},     /* buckled: negative */
    {8, {1e-2, 1e-2, 1e-2, 2e-2, 2e-2, 3e-2, 4e3, 5e3}, 1e9, 6}, /* a body */
    {9,
     {0, 0, 0, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 4e3},
     1e10,
     8},                           /* with two hinges */
    {3, {1e-3, 4e5, 5e5}, 6e5, 1}, /* of a reduced model: lambda_max is low */
    {3, {22.0, 204.0, 2e13}, 2e13, 0}, /* a link much stiffer than the rest */
};

static void only_a_gap_makes_a_mode_rigid(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof spectra / sizeof *spectra; k++) {
        const spectrum *s = &spectra[k];
        int64_t rigid = ritz_eigen_rigid(s->count, s->lambda, s->lambda_max);

        if (rigid != s->rigid)
            fail_msg("spectrum %zu has %d rigid modes, not %d", k, (int)rigid,
                     (int)s->rigid);
    }
}

static void hertz_keep_their_sign(void **state)
{
    (void)state;
    assert_near(ritz_eigen_hertz(4.0 * pi * pi), 1.0, DBL_EPSILON);
    assert_near(ritz_eigen_hertz(-4.0 * pi * pi), -1.0, DBL_EPSILON);
    assert_near(ritz_eigen_lambda(2.0), 16.0 * pi * pi, 4e-14);
}

static void a_mass_that_is_not_definite_is_refused(void **state)
{
    ritz_pairs P = {0};
    double k[] = {1.0, 0.0, 0.0, 1.0};
    double m[] = {1.0, 0.0, 0.0, -1.0};
    double none[4] = {1.0};
    ritz_dense K = {2, 2, k};
    ritz_dense M = {2, 2, m};
    ritz_dense one = {2, 2, none};

    (void)state;
    assert_fails(ritz_eigen_dense(&K, &M, &P), RITZ_ERR_SINGULAR,
                 "mass is not positive definite");
    assert_fails(ritz_eigen_dense(&one, &one, &P), RITZ_ERR_SINGULAR,
                 "neither is the stiffness of the motions without mass");
    k[3] = nan("");
    assert_fails(ritz_eigen_dense(&K, &one, &P), RITZ_ERR_ARGUMENT,
                 "entry (1, 1) of a matrix is not finite");
    assert_null(P.lambda);
}

/* Of two of order n each is off by some n eps |A|. */
static void eigenvalues_alone_equal_those_with_vectors(void **state)
{
    enum { N = 30 };
    uint64_t seed = 7;
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double lambda[N];

    (void)state;
    assert_ok(ritz_dense_new(N, N, &A));
    for (int64_t k = 0; k < N * N; k++)
        A.val[k] = ritz_general_noise(&seed);
    ritz_dense_symmetrise(&A);
    assert_ok(ritz_general_symmetric(&A, &pairs));
    assert_ok(ritz_general_symmetric_values(&A, lambda));
    for (int64_t k = 0; k < N; k++)
        assert_near(lambda[k], pairs.lambda[k], N * 2.3e-16 * N);
    A.nrow = 1;
    assert_fails(ritz_general_symmetric_values(&A, lambda), RITZ_ERR_ARGUMENT,
                 "stiffness is 1 x 30");
    A.nrow = N;
}

/* Gram matrices of columns that depend on each other more and more. The bound is
   never above LAPACK's estimate, and where it is not enough, it is the estimate
   that is returned. */
static void conditions_are_bounded_from_below(void **state)
{
    enum { N = 20, LAST = 30 };
    const double enough = RITZ_WELL_CONDITIONED;
    uint64_t seed = 11;
    int64_t cheap = 0, estimated = 0;

    (void)state;
    for (int t = 0; t < LAST; t++) {
        RITZ_OWN(ritz_dense) X = {0}, G = {0}, H = {0};
        double rcond = 0.0, bound = 0.0;

        assert_ok(ritz_dense_new(N, N, &X));
        for (int64_t k = 0; k < N * N; k++)
            X.val[k] = pow(2.0, -t) * ritz_general_noise(&seed) +
                       (double)(k % N) + (k % (N + 1) == 0) * pow(2.0, 4.0 - t);
        assert_ok(ritz_dense_mul_tn(&X, &X, &G));
        for (int64_t j = 0; j < N; j++)
            ritz_dense_col(&G, j)[j] *= 1.0 + 64.0 * N * DBL_EPSILON;
        assert_ok(ritz_dense_copy(&G, &H));
        assert_ok(ritz_general_cholesky(&G, &rcond));
        assert_ok(ritz_general_cholesky_above(&H, enough, &bound));
        assert_memory_equal(G.val, H.val, N * N * sizeof *G.val);
        assert_true((bound > enough) == (rcond > enough));
        assert_true(bound <= rcond * (1.0 + 64.0 * N * DBL_EPSILON));
        cheap += bound != rcond;
        estimated += bound == rcond;
    }
    assert_true(cheap > 0 && estimated > 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(conditions_are_bounded_from_below),
    cmocka_unit_test(modal_coordinates_are_taken_as_they_are),
    cmocka_unit_test(nearly_modal_coordinates_are_solved_as_any_other),
    cmocka_unit_test(residuals_are_computed_of_the_modes_that_are_kept),
    cmocka_unit_test(low_modes_of_dense_pencils_keep_their_digits),
    cmocka_unit_test(heavy_and_light_masses_keep_the_lowest_mode),
    cmocka_unit_test(only_a_gap_makes_a_mode_rigid),
    cmocka_unit_test(eigenvalues_alone_equal_those_with_vectors),
    cmocka_unit_test(hertz_keep_their_sign),
    cmocka_unit_test(a_mass_that_is_not_definite_is_refused),
};

TEST_MODULE(eigen_dense, tests, NULL, NULL)
