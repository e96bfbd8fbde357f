#include "responses.h"
#include "testing.h"

#include "masses.h"
#include "spring_chain.h"
#include "states.h"

#include "linear/general.h"

#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { MASSES = 10, STATES = 2 * MASSES };

static double at(const ritz_dense *A, int64_t i, int64_t j)
{
    return ritz_dense_col(A, j)[i];
}

/* W of A W + W A' + B B' = 0 by its n^2 equations. */
static void solve_lyapunov(const ritz_dense *A, const ritz_dense *B,
                           ritz_dense *W)
{
    int64_t n = A->nrow;
    ritz_dense L = {0}, x = {0};

    assert_ok(ritz_dense_new(n * n, n * n, &L));
    assert_ok(ritz_dense_new(n * n, 1, &x));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++) {
            for (int64_t k = 0; k < n; k++) {
                ritz_dense_col(&L, k + j * n)[i + j * n] += at(A, i, k);
                ritz_dense_col(&L, i + k * n)[i + j * n] += at(A, j, k);
            }
            for (int64_t k = 0; k < B->ncol; k++)
                x.val[i + j * n] -= at(B, i, k) * at(B, j, k);
        }
    assert_ok(ritz_general_solve(&L, false, &x));
    x.nrow = x.ncol = n;
    *W = x;
    ritz_dense_free(&L);
}

/*
 * Q'W^-1 Q = I with W from its n^2 equations, for both Gramians: the factor of
 * W that the method used never was W. Tolerance measured: 3e-12 at a condition
 * number of W of 2e4.
 */
static void vectors_are_orthonormal_in_the_gramian(void **state)
{
    enum { N = 3 };
    static const double m[N] = {1.0, 2.0, 1.5};
    static const double k[N] = {300.0, 200.0, 100.0};
    static const double c[N] = {3.0, 1.0, 2.0};
    static const int64_t in[] = {2}, seen[] = {0, 1};
    states_fixture local = *(states_fixture *)*state;
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_state_space) full = {0};
    const ritz_damping none = {0};

    assert_ok(masses_component(N, m, k, c, &chain));
    assert_ok(masses_io(&chain, 1, in, 2, seen));
    assert_ok(ritz_state_space_of_component(&chain, &none, &full));
    local.request.component = &chain;
    for (int g = 0; g < 2; g++) {
        ritz_request request = states_asking(&local, 4, false, (ritz_gramian)g);
        RITZ_OWN(ritz_dense)
        A = {0}, B = {0}, W = {0}, X = {0}, one = {0}, Q = {0};
        states_outcome got = {0};

        states_run(&ritz_method_lanczos_one_sided, &request, &got);
        if (g == RITZ_GRAMIAN_INPUTS) {
            assert_ok(ritz_dense_copy(&full.A, &A));
            assert_ok(ritz_dense_copy(&full.B, &B));
            assert_ok(ritz_dense_copy(&got.basis.T, &Q));
        } else { /* of x, left vectors are [W_1; M W_2] */
            assert_ok(ritz_general_transpose(&full.A, &A));
            assert_ok(ritz_general_transpose(&full.C, &B));
            assert_ok(ritz_dense_copy(&got.basis.W, &Q));
            for (int64_t j = 0; j < Q.ncol; j++)
                for (int64_t i = 0; i < N; i++)
                    ritz_dense_col(&Q, j)[N + i] *= m[i];
        }
        solve_lyapunov(&A, &B, &W);
        assert_ok(ritz_dense_copy(&Q, &X));
        assert_ok(ritz_general_solve(&W, false, &X));
        assert_ok(ritz_dense_mul_tn(&Q, &X, &one));
        assert_int_equal(one.ncol, 4);
        for (int64_t j = 0; j < 4; j++)
            for (int64_t i = 0; i < 4; i++)
                assert_near(at(&one, i, j), i == j ? 1.0 : 0.0, 1e-10);
        states_discard(&got);
    }
}

/* W'E T = I, E = [I 0; 0 M] and M = I here; |W| |T| reaches 1e4. */
static void left_and_right_vectors_are_biorthogonal(void **state)
{
    const ritz_method *const methods[] = {&ritz_method_lanczos_one_sided,
                                          &ritz_method_lanczos_two_sided};

    for (int t = 0; t < 3; t++) {
        ritz_request request =
            states_asking(*state, 7, t > 0, RITZ_GRAMIAN_INPUTS);
        RITZ_OWN(ritz_dense) one = {0};
        states_outcome got = {0};

        states_run(methods[t == 2], &request, &got);
        assert_int_equal(got.basis.T.nrow, STATES);
        assert_ok(ritz_dense_mul_tn(&got.basis.W, &got.basis.T, &one));
        for (int64_t j = 0; j < 7; j++)
            for (int64_t i = 0; i < 7; i++)
                assert_near(at(&one, i, j), i == j ? 1.0 : 0.0,
                            STATES * DBL_EPSILON * 1e4);
        states_discard(&got);
    }
}

/* Block k holds indices k p to k p + p - 1: zero off the three diagonals. */
static void assert_block_tridiagonal(const ritz_dense *A, int64_t p,
                                     double tolerance)
{
    double size = ritz_dense_max(A);

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            if (llabs(i / p - j / p) > 1)
                assert_near(at(A, i, j), 0.0, tolerance * size);
}

/*
 * A_r + A_r' = -B_r B_r' (or -C_r'C_r), which is zero but in the first block;
 * A_r block tridiagonal. What is left is rounding of the Gramian: the method
 * bounds it by 1e-3 of the least damping, 1.1e-4 here, and 1e-9 is measured.
 */
static void reduced_matrix_is_skew_and_block_tridiagonal(void **state)
{
    static const int64_t in[] = {9, 4};
    states_fixture *f = *state;
    const double tolerance = 1e-9;

    assert_ok(masses_io(&f->chain, 2, in, 2, in));
    for (int g = 0; g < 2; g++) {
        ritz_request request = states_asking(f, 9, false, (ritz_gramian)g);
        states_outcome got = {0};
        RITZ_OWN(ritz_dense) side = {0}, product = {0};

        states_run(&ritz_method_lanczos_one_sided, &request, &got);
        assert_block_tridiagonal(&got.model.A, 2, tolerance);
        if (g == RITZ_GRAMIAN_INPUTS)
            assert_ok(ritz_dense_copy(&got.model.B, &side));
        else
            assert_ok(ritz_general_transpose(&got.model.C, &side));
        assert_ok(ritz_dense_mul_nt(&side, &side, &product));
        for (int64_t j = 0; j < 9; j++)
            for (int64_t i = 0; i < 9; i++) {
                if (i > 1)
                    assert_near(at(&side, i, j % 2), 0.0, tolerance);
                assert_near(at(&got.model.A, i, j) + at(&got.model.A, j, i),
                            -at(&product, i, j), tolerance);
            }
        states_discard(&got);
    }
}

/* On A^-1 that is so of the inverse: G = A_r^-1, G + G' = -b b', b = G B_r. */
static void on_the_inverse_the_inverse_is_so(void **state)
{
    states_fixture *f = *state;
    ritz_request request = states_asking(f, 8, true, RITZ_GRAMIAN_INPUTS);
    RITZ_OWN(ritz_dense) G = {0}, b = {0};
    states_outcome got = {0};
    const double tolerance = 1e-9; /* measured: 1e-11 of G */

    states_run(&ritz_method_lanczos_one_sided, &request, &got);
    assert_ok(ritz_dense_new(8, 8, &G));
    for (int64_t k = 0; k < 8; k++)
        ritz_dense_col(&G, k)[k] = 1.0;
    assert_ok(ritz_general_solve(&got.model.A, false, &G));
    assert_ok(ritz_dense_mul(&G, &got.model.B, &b));
    assert_block_tridiagonal(&G, 1, tolerance);
    for (int64_t j = 0; j < 8; j++)
        for (int64_t i = 0; i < 8; i++)
            assert_near(at(&G, i, j) + at(&G, j, i), -b.val[i] * b.val[j],
                        tolerance * ritz_dense_max(&G));
    states_discard(&got);
}

/* C A^power B of SISO models, power of either sign. */
static double markov(const ritz_state_space *model, int power)
{
    ritz_dense x = {0}, next = {0}, y = {0};
    double value = 0.0;

    assert_ok(ritz_dense_copy(&model->B, &x));
    for (int k = 0; k < abs(power); k++) {
        if (power < 0) {
            assert_ok(ritz_general_solve(&model->A, false, &x));
            continue;
        }
        assert_ok(ritz_dense_mul(&model->A, &x, &next));
        ritz_dense_free(&x);
        x = next;
        next = (ritz_dense){0};
    }
    assert_ok(ritz_dense_mul(&model->C, &x, &y));
    value = y.val[0];
    ritz_dense_free(&x);
    ritz_dense_free(&y);
    return value;
}

/*
 * k vectors of one side keep k parameters, k of both sides 2k: Markov
 * parameters C A^i B on A, moments C A^-i B on A^-1. A collocated velocity has
 * Markov parameters other than 0. Tolerance measured: 1e-11 of the largest of
 * those compared, the moments grow by 45 a step.
 */
static void parameters_are_kept(void **state)
{
    static const struct {
        const ritz_method *method;
        bool inverse;
        ritz_gramian gramian;
        int kept;
    } cases[] = {
        {&ritz_method_lanczos_one_sided, false, RITZ_GRAMIAN_INPUTS, 6},
        {&ritz_method_lanczos_one_sided, true, RITZ_GRAMIAN_INPUTS, 6},
        {&ritz_method_lanczos_one_sided, false, RITZ_GRAMIAN_OUTPUTS, 6},
        {&ritz_method_lanczos_one_sided, true, RITZ_GRAMIAN_OUTPUTS, 6},
        {&ritz_method_lanczos_two_sided, false, RITZ_GRAMIAN_INPUTS, 12},
        {&ritz_method_lanczos_two_sided, true, RITZ_GRAMIAN_INPUTS, 12},
    };
    static const int64_t tip[] = {9};
    states_fixture *f = *state;
    const ritz_damping none = {0};
    RITZ_OWN(ritz_state_space) full = {0};

    assert_ok(masses_io(&f->chain, 1, tip, 1, tip));
    ritz_dense_col(&f->chain.io.C, 9)[0] = 0.3; /* both, or A^-1 B is 0 */
    ritz_dense_col(&f->chain.io.Cv, 9)[0] = 1.0;
    assert_ok(ritz_state_space_of_component(&f->chain, &none, &full));
    for (size_t t = 0; t < sizeof cases / sizeof *cases; t++) {
        ritz_request request =
            states_asking(f, 6, cases[t].inverse, cases[t].gramian);
        int sign = cases[t].inverse ? -1 : 1;
        states_outcome got = {0};
        double size = 0.0;

        states_run(cases[t].method, &request, &got);
        assert_int_equal(got.model.A.nrow, 6);
        for (int i = 0; i < cases[t].kept; i++) {
            int power = cases[t].inverse ? -1 - i : sign * i;
            double due = markov(&full, power);

            size = fmax(size, fabs(due));
            assert_near(markov(&got.model, power), due, 1e-9 * size);
        }
        /* and no more: the next is off by a good deal */
        assert_true(fabs(markov(&got.model,
                                sign * cases[t].kept + (sign < 0 ? -1 : 0)) -
                         markov(&full, sign * cases[t].kept +
                                           (sign < 0 ? -1 : 0))) > 1e-6 * size);
        states_discard(&got);
    }
}

/*
 * The shipped chain, from the tip to the root: two-sided Lanczos on A^-1 is
 * unstable at 8 and from 10 to 19 of 20 states, one-sided at none, with either
 * Gramian and operator.
 */
static void two_sided_is_unstable_where_one_sided_never_is(void **state)
{
    for (int64_t k = 2; k <= STATES; k++) {
        ritz_request request =
            states_asking(*state, k, true, RITZ_GRAMIAN_INPUTS);
        states_outcome got = {0};
        bool unstable = k == 8 || (k >= 10 && k < STATES);

        states_run(&ritz_method_lanczos_two_sided, &request, &got);
        assert_int_equal(got.model.A.nrow, k);
        assert_int_equal(got.probe.verdict,
                         unstable ? RITZ_UNSTABLE : RITZ_STABLE);
        states_discard(&got);
        for (int g = 0; g < 2; g++)
            for (int inverse = 0; inverse < 2; inverse++) {
                request =
                    states_asking(*state, k, inverse == 1, (ritz_gramian)g);
                states_run(&ritz_method_lanczos_one_sided, &request, &got);
                assert_int_equal(got.model.A.nrow, k);
                assert_int_equal(got.probe.verdict, RITZ_STABLE);
                states_discard(&got);
            }
    }
}

/* Of the whole chain nothing is left out, whichever way: H is the same. */
static void all_states_respond_as_the_chain(void **state)
{
    states_fixture *f = *state;
    const ritz_method *const methods[] = {&ritz_method_lanczos_one_sided,
                                          &ritz_method_lanczos_two_sided};
    const double hertz[] = {0.0, 0.02, 0.1, 0.3, 1.0};
    const ritz_grid grid = {.count = 5, .hertz = hertz};
    const ritz_damping none = {0};
    RITZ_OWN(ritz_state_space) full = {0};
    RITZ_OWN(ritz_response) due = {0};

    assert_ok(ritz_state_space_of_component(&f->chain, &none, &full));
    assert_ok(states_response(&full, &grid, &due));
    assert_near(creal(due.H[0]), 1.0, 1e-13); /* unit springs in a row */
    for (int t = 0; t < 2; t++) {
        ritz_request request =
            states_asking(f, STATES, true, RITZ_GRAMIAN_INPUTS);
        RITZ_OWN(ritz_response) r = {0};
        states_outcome got = {0};

        states_run(methods[t], &request, &got);
        assert_ok(states_response(&got.model, &grid, &r));
        for (int k = 0; k < 5; k++) /* measured: 2e-10 */
            assert_true(cabs(r.H[k] - due.H[k]) < 1e-8);
        states_discard(&got);
    }
}

static double uniform(uint32_t *seed)
{
    *seed = *seed * 1664525U + 1013904223U;
    return (double)(*seed >> 8) / (double)(1 << 24);
}

/* Damping of 1e-4 to 0.3 of stiffness, some springs a thousand times softer. */
static void a_thousand_random_chains_stay_stable(void **state)
{
    states_fixture local = *(states_fixture *)*state;
    uint32_t seed = 1;

    for (int t = 0; t < 1000; t++) {
        int64_t n = 2 + (int64_t)(4.0 * uniform(&seed));
        double scale = pow(10.0, -4.0 + 3.5 * uniform(&seed));
        double m[6], k[6], c[6];
        int64_t in[] = {(int64_t)((double)n * uniform(&seed)), n - 1};
        int64_t seen[] = {(int64_t)((double)n * uniform(&seed))};
        int64_t inputs = t % 3 == 0 && in[0] != in[1] ? 2 : 1;
        RITZ_OWN(ritz_component) chain = {0};
        ritz_request request = {0};
        states_outcome got = {0};

        for (int64_t i = 0; i < n; i++) {
            m[i] = 0.1 + uniform(&seed);
            k[i] = (uniform(&seed) < 0.2 ? 1e-3 : 1.0) + uniform(&seed);
            c[i] = scale * k[i] * uniform(&seed);
        }
        assert_ok(masses_component(n, m, k, c, &chain));
        assert_ok(masses_io(&chain, inputs, in, 1, seen));
        local.request.component = &chain;
        request = states_asking(&local,
                                1 + (int64_t)(2.0 * (double)n * uniform(&seed)),
                                t % 2 == 1, (ritz_gramian)(t / 2 % 2));
        states_run(&ritz_method_lanczos_one_sided, &request, &got);
        if (got.probe.verdict != RITZ_STABLE)
            fail_msg("chain %d: %s, pole %g", t,
                     ritz_stability_name(got.probe.verdict), got.probe.pole[0]);
        states_discard(&got);
    }
}

/*
 * The chain with dampers has modes that a force at its tip hardly reaches: the
 * Gramian's factor falls to 4e-9 of its largest value and then to 8e-17.
 */
static void a_semidefinite_gramian_is_worked_on_its_range(void **state)
{
    static const int64_t tip[] = {29}, root[] = {0};
    states_fixture local = *(states_fixture *)*state;
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = {0};

    assert_ok(chain_component(30, &chain));
    assert_ok(masses_io(&chain, 1, tip, 1, root));
    local.request.component = &chain;
    for (int t = 0; t < 4; t++) {
        states_outcome got = {0};

        request = states_asking(&local, 60, t % 2 == 1, (ritz_gramian)(t / 2));
        states_run(&ritz_method_lanczos_one_sided, &request, &got);
        assert_int_equal(got.model.A.nrow, t < 2 ? 56 : 58);
        assert_string_equal(
            got.basis.remark,
            t < 2 ? "60 states asked for: the inputs control 57 of 60, 56 of "
                    "them above rounding; there are 56"
                  : "60 states asked for: the outputs observe 58 of 60; there "
                    "are 58");
        assert_int_equal(got.probe.verdict, RITZ_STABLE);
        states_discard(&got);
    }
    for (int64_t k = 1; k < 57; k += 5) {
        states_outcome got = {0};

        request = states_asking(&local, k, k % 2 == 1, RITZ_GRAMIAN_INPUTS);
        states_run(&ritz_method_lanczos_one_sided, &request, &got);
        assert_int_equal(got.probe.verdict, RITZ_STABLE);
        states_discard(&got);
    }
}

#define TEST(name)                                                             \
    cmocka_unit_test_setup_teardown(name, states_set_up, states_tear_down)

static const struct CMUnitTest tests[] = {
    TEST(vectors_are_orthonormal_in_the_gramian),
    TEST(left_and_right_vectors_are_biorthogonal),
    TEST(reduced_matrix_is_skew_and_block_tridiagonal),
    TEST(on_the_inverse_the_inverse_is_so),
    TEST(parameters_are_kept),
    TEST(two_sided_is_unstable_where_one_sided_never_is),
    TEST(all_states_respond_as_the_chain),
    TEST(a_thousand_random_chains_stay_stable),
    TEST(a_semidefinite_gramian_is_worked_on_its_range),
};

TEST_MODULE(lanczos, tests, NULL, NULL)
