/* Poles of models with negative eigenvalues, as joints by forces make them. */
#include "testing.h"

#include <ritz/poles.h>

#include <complex.h>
#include <float.h>
#include <math.h>

/* Q diag(lambda) Q', Q = I - 2 v v' / v'v: what is 0 becomes rounding. */
static void turned(int64_t n, const double *lambda, ritz_dense *out)
{
    double square = 0.0;
    ritz_dense Q = {0}, L = {0};

    assert_ok(ritz_dense_new(n, n, &Q));
    assert_ok(ritz_dense_new(n, n, &L));
    for (int64_t i = 0; i < n; i++)
        square += pow(1.0 + 0.37 * (double)i, 2.0);
    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(&L, j)[j] = lambda[j];
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&Q, j)[i] =
                (i == j) - 2.0 * (1.0 + 0.37 * (double)i) *
                               (1.0 + 0.37 * (double)j) / square;
    }
    assert_ok(ritz_dense_congruence(&L, &Q, out));
    ritz_dense_free(&Q);
    ritz_dense_free(&L);
}

/* s^2 + 2 zeta w s + lambda = 0, lambda = -900, -4, 0 three times, 9, 25e6;
   s = +-30 and +-2 without damping, and ratios count from the first that is
   not rigid. */
static void rigid_motion_is_told_behind_negative_eigenvalues(void **state)
{
    enum { N = 7 };
    static const double lambda[N] = {-900, -4, 0, 0, 0, 9, 25e6};
    static const double one[N] = {1, 1, 1, 1, 1, 1, 1};
    /* rounding of lambda is n eps of the largest, of s that over 2 |s| */
    const double bound = N * DBL_EPSILON * 25e6 / 2.0;
    static const double due[4][2] = {{2, 0}, {3, 0.01}, {30, 0}, {5000, 0.03}};
    ritz_dense K = {0}, M = {0}, none = {0};
    const ritz_second_order model = {&K, &M, &none, &none, NULL};
    ritz_damping damping = {0};
    RITZ_OWN(ritz_spectrum) found = {0};
    int64_t at = 0;

    (void)state;
    turned(N, lambda, &K);
    turned(N, one, &M);
    assert_ok(ritz_damping_parse("modes 0.01 0.03", &damping));
    assert_ok(
        ritz_spectrum_of(ritz_model_of_dense(&model, &damping), NULL, &found));
    assert_int_equal(found.num_zero, 6);
    assert_int_equal(found.count, 6);
    for (int k = 0; k < 4; k++) {
        bool grows = due[k][1] == 0.0;

        for (int pair = 0; pair <= grows; pair++, at++) {
            assert_near(cabs(found.s[at]), due[k][0], bound / due[k][0] + 1e-9);
            assert_near(fabs(ritz_spectrum_ratio(found.s[at])),
                        grows ? 1.0 : due[k][1], 1e-12);
        }
    }
    ritz_dense_free(&K);
    ritz_dense_free(&M);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rigid_motion_is_told_behind_negative_eigenvalues),
};

TEST_MODULE(spectrum_forces, tests, NULL, NULL)
