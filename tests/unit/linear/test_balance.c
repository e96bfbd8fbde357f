#include "testing.h"

#include "linear/general.h"

#include <ritz/basis.h>

#include <float.h>

/* A fixed sequence of numbers in (-1, 1), the same everywhere. */
static double noise(uint64_t *seed)
{
    *seed =
        *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

static void fill(int64_t nrow, int64_t ncol, uint64_t seed, ritz_dense *out)
{
    assert_ok(ritz_dense_new(nrow, ncol, out));
    for (int64_t k = 0; k < nrow * ncol; k++)
        out->val[k] = noise(&seed);
}

/* Factors diag(c) and diag(o): the values are c_k o_k. */
static void diagonal(int64_t n, const double *c, const double *o,
                     ritz_gramians *out)
{
    assert_ok(ritz_dense_new(n, n, &out->Zc));
    assert_ok(ritz_dense_new(n, n, &out->Zo));
    for (int64_t k = 0; k < n; k++) {
        ritz_dense_col(&out->Zc, k)[k] = c[k];
        ritz_dense_col(&out->Zo, k)[k] = o[k];
    }
}

/* Largest |A'B - diag(d)|, d NULL: the identity. */
static double off(const ritz_dense *A, const ritz_dense *B, const double *d)
{
    double worst = 0.0;

    for (int64_t i = 0; i < A->ncol; i++)
        for (int64_t j = 0; j < B->ncol; j++) {
            double due = i == j ? d ? d[i] : 1.0 : 0.0;

            worst = fmax(worst, fabs(ritz_dense_dot(A, i, B, j) - due));
        }
    return worst;
}

/*
 * X'Y = [1 0; 1 d][1 0; 1 d] = [1 0; 1 + d, d^2] turned by rotations: the sum
 * of squares and the product of both values are known, the smaller one to a
 * few eps although the product itself is known to eps of the larger alone.
 */
static void small_values_of_a_product_are_as_good_as_its_factors(void **unused)
{
    const double d = 1e-10;
    const double X[] = {1.0, 0.0, 1.0, d}; /* columns */
    const double Y[] = {1.0, 1.0, 0.0, d};
    ritz_dense left = {2, 2, NULL}, right = {2, 2, NULL};
    RITZ_OWN(ritz_product_svd) svd = {0};
    double large = sqrt(1.0 + (1.0 + d) * (1.0 + d));
    double small = d * d / large;

    (void)unused;
    assert_ok(ritz_dense_new(2, 2, &left));
    assert_ok(ritz_dense_new(2, 2, &right));
    memcpy(left.val, X, sizeof X);
    memcpy(right.val, Y, sizeof Y);
    assert_ok(ritz_product_svd_new(&left, &right, true, &svd));
    assert_int_equal(svd.count, 2);
    assert_near(svd.s[0], large, 8 * DBL_EPSILON * large);
    /* large^2 is short of small^2 < eps; a few roundings of the factors */
    assert_near(svd.s[1], small, 16 * DBL_EPSILON * small);
    ritz_dense_free(&left);
    ritz_dense_free(&right);
}

/* All shapes, n l k: U and V have orthonormal columns and X'Y V = U diag(s). */
static void a_product_is_what_its_svd_says(void **unused)
{
    static const int64_t shape[][3] = {{7, 4, 3}, {7, 3, 4}, {3, 7, 5},
                                       {3, 5, 7}, {5, 1, 6}, {1, 4, 4},
                                       {6, 6, 6}};

    (void)unused;
    for (size_t t = 0; t < sizeof shape / sizeof *shape; t++) {
        RITZ_OWN(ritz_dense) X = {0}, Y = {0}, P = {0}, PV = {0}, US = {0};
        RITZ_OWN(ritz_product_svd) svd = {0};

        fill(shape[t][0], shape[t][1], 3 + t, &X);
        fill(shape[t][0], shape[t][2], 30 + t, &Y);
        assert_ok(ritz_product_svd_new(&X, &Y, true, &svd));
        assert_ok(ritz_dense_mul_tn(&X, &Y, &P));
        assert_ok(ritz_dense_mul(&P, &svd.V, &PV));
        assert_ok(ritz_dense_copy(&svd.U, &US));
        for (int64_t j = 0; j < US.ncol; j++)
            for (int64_t i = 0; i < US.nrow; i++)
                ritz_dense_col(&US, j)[i] *= svd.s[j];
        assert_near(off(&svd.U, &svd.U, NULL), 0.0, 50 * DBL_EPSILON);
        assert_near(off(&svd.V, &svd.V, NULL), 0.0, 50 * DBL_EPSILON);
        /* sums of seven products of seven */
        for (int64_t k = 0; k < PV.nrow * PV.ncol; k++)
            assert_near(PV.val[k], US.val[k], 200 * DBL_EPSILON * svd.s[0]);
        for (int64_t k = 1; k < svd.count; k++)
            assert_true(svd.s[k] <= svd.s[k - 1]);
    }
}

/* W'E T = I, and the Gramians W'E W_c E'W and T'W_o T, W_o for x, are S. */
static void balancing_makes_both_gramians_equal_and_diagonal(void **unused)
{
    RITZ_OWN(ritz_gramians) g = {0};
    RITZ_OWN(ritz_balanced) b = {0};
    RITZ_OWN(ritz_dense)
    E = {0}, ET = {0}, c = {0}, o = {0}, EtZo = {0};

    (void)unused;
    fill(9, 6, 1, &g.Zc);
    fill(9, 5, 2, &g.Zo);
    fill(9, 9, 3, &E);
    for (int64_t i = 0; i < 9; i++)
        ritz_dense_col(&E, i)[i] += 4.0;
    assert_ok(ritz_dense_mul(&E, &g.Zc, &g.EZc));
    assert_ok(ritz_gramians_balance(&g, -1, 0.0, &b));
    assert_int_equal(b.count, 5);
    assert_int_equal(b.kept, 5);
    assert_near(b.bound, 0.0, 0.0);
    assert_ok(ritz_dense_mul(&E, &b.T, &ET));
    assert_near(off(&b.W, &ET, NULL), 0.0, 1e-13); /* measured: 2e-15 */
    assert_ok(ritz_dense_mul_tn(&g.EZc, &b.W, &c));
    assert_ok(ritz_dense_mul_tn(&E, &g.Zo, &EtZo));
    assert_ok(ritz_dense_mul_tn(&EtZo, &b.T, &o));
    assert_near(off(&c, &c, b.sigma), 0.0, 1e-12 * b.sigma[0]);
    assert_near(off(&o, &o, b.sigma), 0.0, 1e-12 * b.sigma[0]);
}

/* What is kept of values 8 4 4 4 2 1e-3. */
static void equal_values_are_kept_or_dropped_whole(void **unused)
{
    static const double c[] = {8, 4, 4, 4, 2, 1e-3};
    static const double one[] = {1, 1, 1, 1, 1, 1};
    static const struct {
        int64_t order;
        double tolerance;
        int64_t kept;
        double bound;
    } expected[] = {
        {-1, 0, 6, 0},       {0, 0, 0, 28.002},   {1, 0, 1, 12.002},
        {2, 0, 1, 12.002},   {3, 0, 1, 12.002},   {4, 0, 4, 4.002},
        {99, 0, 6, 0},       {-1, 0.5, 4, 4.002}, {-1, 0.51, 1, 12.002},
        {2, 0.1, 1, 12.002}, {5, 1e-2, 5, 2e-3},
    };
    RITZ_OWN(ritz_gramians) g = {0};

    (void)unused;
    diagonal(6, c, one, &g);
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++) {
        RITZ_OWN(ritz_balanced) b = {0};

        assert_ok(ritz_gramians_balance(&g, expected[k].order,
                                        expected[k].tolerance, &b));
        assert_int_equal(b.count, 6);
        assert_int_equal(b.kept, expected[k].kept);
        assert_int_equal(b.T.ncol, b.kept);
        assert_int_equal(b.W.ncol, b.kept);
        assert_near(b.bound, expected[k].bound, 1e-12);
    }
}

/* 1e-14 is above 4 eps, 1e-17 below; 0 is nothing. */
static void a_value_of_rounding_is_never_balanced(void **unused)
{
    static const double c[] = {1, 1e-14, 1e-17, 0};
    static const double one[] = {1, 1, 1, 1};
    RITZ_OWN(ritz_gramians) g = {0};
    RITZ_OWN(ritz_balanced) b = {0};
    int64_t count = 0;
    RITZ_OWN_ARRAY double *sigma = NULL;

    (void)unused;
    diagonal(4, c, one, &g);
    assert_ok(ritz_gramians_hankel(&g, &count, &sigma));
    assert_int_equal(count, 4);
    assert_near(sigma[2], 1e-17, 1e-31);
    assert_near(sigma[3], 0.0, 0.0);
    assert_ok(ritz_gramians_balance(&g, -1, 0.0, &b));
    assert_int_equal(b.count, 2);
    assert_int_equal(b.kept, 2);
}

/* The first value is huge in one factor, tiny in the other: W'E T still is I of
   what is balanced, and what rounding leaves no direction is not. */
static void factors_that_hide_values_in_rounding_give_fewer(void **unused)
{
    const double c[] = {1e8, 1e-8}, o[] = {1e-8, 1e8};
    const double s = sqrt(0.5);
    RITZ_OWN(ritz_gramians) g = {0};
    RITZ_OWN(ritz_balanced) b = {0};
    ritz_dense turn = {2, 2, NULL}, Zc = {0};

    (void)unused;
    diagonal(2, c, o, &g);
    assert_ok(ritz_dense_new(2, 2, &turn));
    for (int k = 0; k < 4; k++) /* the states of Z_c turned by 45 degrees */
        turn.val[k] = k == 2 ? -s : s;
    assert_ok(ritz_dense_mul(&turn, &g.Zc, &Zc));
    ritz_dense_free(&g.Zc);
    g.Zc = Zc;
    assert_ok(ritz_gramians_balance(&g, -1, 0.0, &b));
    assert_true(b.count >= 1);
    assert_near(off(&b.W, &b.T, NULL), 0.0, 1e-12);
    ritz_dense_free(&turn);
}

static void the_bound_counts_a_repeated_value_once(void **unused)
{
    const double sigma[] = {3, 2, 2, 1, 1 - 1e-12, 0.5, 0.5 - 1e-7};

    (void)unused;
    assert_near(ritz_hankel_bound(7, sigma, 0), 14.0, 1e-6);
    assert_near(ritz_hankel_bound(7, sigma, 1), 8.0, 1e-6);
    assert_near(ritz_hankel_bound(7, sigma, 3), 4.0, 1e-6);
    assert_near(ritz_hankel_bound(7, sigma, 5), 2.0, 1e-6);
    assert_near(ritz_hankel_bound(7, sigma, 7), 0.0, 0.0);
    assert_near(ritz_hankel_bound(0, NULL, 0), 0.0, 0.0);
}

static void nothing_reached_is_nothing_balanced(void **unused)
{
    static const double zero[] = {0, 0};
    ritz_gramians g = {0}, empty = {0};
    RITZ_OWN(ritz_balanced) b = {0};

    (void)unused;
    diagonal(2, zero, zero, &g);
    assert_ok(ritz_gramians_balance(&g, -1, 0.0, &b));
    assert_int_equal(b.count, 0);
    assert_int_equal(b.T.ncol, 0);
    assert_int_equal(b.T.nrow, 2);
    ritz_balanced_free(&b);
    assert_ok(ritz_gramians_balance(&empty, -1, 0.0, &b));
    assert_int_equal(b.count, 0);
    ritz_balanced_free(&b);
    ritz_gramians_free(&g);
    ritz_gramians_free(&g);
}

static void what_cannot_be_balanced_is_refused_in_words(void **unused)
{
    static const double one[] = {1, 1};
    RITZ_OWN(ritz_gramians) g = {0};
    ritz_balanced b = {0};
    RITZ_OWN(ritz_dense) longer = {0};
    ritz_product_svd svd = {0};

    (void)unused;
    diagonal(2, one, one, &g);
    assert_fails(ritz_gramians_balance(&g, -1, 1.0, &b), RITZ_ERR_ARGUMENT,
                 "a tolerance of Hankel values is 1, it must be at least 0");
    assert_fails(ritz_gramians_balance(&g, -1, nan(""), &b), RITZ_ERR_ARGUMENT,
                 "a tolerance of Hankel values is nan");
    fill(3, 2, 1, &longer);
    assert_fails(ritz_product_svd_new(&g.Zo, &longer, true, &svd),
                 RITZ_ERR_ARGUMENT, "do not fit each other");
    g.Zo.val[1] = HUGE_VAL;
    assert_fails(ritz_gramians_balance(&g, -1, 0.0, &b), RITZ_ERR_ARGUMENT,
                 "balancing: a factor of a product is not finite");
}

static ritz_status balance_once(const ritz_gramians *g)
{
    RITZ_OWN(ritz_balanced) b = {0};
    int64_t count = 0;
    RITZ_OWN_ARRAY double *sigma = NULL;

    RITZ_CHECK(ritz_gramians_hankel(g, &count, &sigma));
    return ritz_gramians_balance(g, 2, 0.0, &b);
}

static void balancing_survives_every_allocation(void **unused)
{
    RITZ_OWN(ritz_gramians) g = {0};

    (void)unused;
    fill(5, 3, 1, &g.Zc);
    fill(5, 4, 2, &g.Zo);
    assert_survives_every_allocation(balance_once(&g));
}

/* Inputs that reach nothing, or outputs that see nothing: no columns. */
static void a_factor_without_columns_has_no_values(void **state)
{
    (void)state;
    for (int side = 0; side < 2; side++) {
        RITZ_OWN(ritz_gramians) none = {0};
        RITZ_OWN(ritz_product_svd) svd = {0};
        RITZ_OWN_ARRAY double *sigma = NULL;
        int64_t count = -1;

        fill(5, side == 0 ? 0 : 3, 1, &none.Zc);
        fill(5, side == 0 ? 3 : 0, 1, &none.Zo);
        assert_ok(ritz_gramians_hankel(&none, &count, &sigma));
        assert_int_equal(count, 0);
        assert_ok(ritz_product_svd_new(&none.Zo, &none.Zc, true, &svd));
        assert_int_equal(svd.U.nrow, none.Zo.ncol);
        assert_int_equal(svd.V.nrow, none.Zc.ncol);
        assert_int_equal(svd.U.ncol + svd.V.ncol, 0);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_factor_without_columns_has_no_values),
    cmocka_unit_test(small_values_of_a_product_are_as_good_as_its_factors),
    cmocka_unit_test(a_product_is_what_its_svd_says),
    cmocka_unit_test(balancing_makes_both_gramians_equal_and_diagonal),
    cmocka_unit_test(equal_values_are_kept_or_dropped_whole),
    cmocka_unit_test(a_value_of_rounding_is_never_balanced),
    cmocka_unit_test(factors_that_hide_values_in_rounding_give_fewer),
    cmocka_unit_test(the_bound_counts_a_repeated_value_once),
    cmocka_unit_test(nothing_reached_is_nothing_balanced),
    cmocka_unit_test(what_cannot_be_balanced_is_refused_in_words),
    cmocka_unit_test(balancing_survives_every_allocation),
};

TEST_MODULE(balance, tests, NULL, NULL)
