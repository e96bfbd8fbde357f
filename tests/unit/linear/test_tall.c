#include "fixtures/lattice.h"
#include "linear/tall.h"
#include "testing.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* A lattice of 24^3 points; 27 columns are one block of sixteen, one of eight,
   and three more. Entries are 1 at most. */
enum { EDGE = 24, POINTS = EDGE * EDGE * EDGE, COLUMNS = 27, MOST_THREADS = 3 };

static const char *const bits[] = {"128", "256", "512"};

static void fill(int64_t rows, int64_t columns, double shift, ritz_dense *X)
{
    assert_ok(ritz_dense_new(rows, columns, X));
    for (int64_t i = 0; i < rows * columns; i++)
        X->val[i] = sin((double)(i + 1) + shift);
}

/* Entries differ by `terms` eps at most: the number of terms of a sum, times
   the sum of their magnitudes, is a bound of its rounding. */
static void check_near(const ritz_dense *A, const ritz_dense *B, double terms)
{
    assert_int_equal(A->nrow, B->nrow);
    assert_int_equal(A->ncol, B->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        assert_near(A->val[k], B->val[k], terms * DBL_EPSILON);
}

/* G = A'B and A - B H, for numbers of columns from none on. */
static void products_agree_with_plain_ones(void **state)
{
    static const int64_t columns[] = {0, 1, 5, COLUMNS};

    (void)state;
    for (int threads = 1; threads <= MOST_THREADS; threads++)
        for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) {
            RITZ_OWN(ritz_dense) A = {0}, B = {0}, G = {0}, plain = {0};
            RITZ_OWN(ritz_dense) H = {0}, BH = {0}, C = {0};

            ritz_set_threads(threads);
            fill(POINTS, COLUMNS, 0.0, &A);
            fill(POINTS, columns[k], 0.5, &B);
            assert_ok(ritz_tall_inner(&A, &B, &G));
            assert_ok(ritz_dense_mul_tn(&A, &B, &plain));
            check_near(&G, &plain, (double)POINTS * POINTS);
            fill(columns[k], COLUMNS, 0.25, &H);
            assert_ok(ritz_dense_copy(&A, &C));
            ritz_tall_subtract(&B, &H, &C);
            assert_ok(ritz_dense_mul(&B, &H, &BH));
            if (columns[k] > 0)
                ritz_dense_add(-1.0, &BH, &A);
            check_near(&C, &A, 2.0 * (COLUMNS + 1) * (COLUMNS + 1));
        }
    ritz_set_threads(1);
}

/* A L^-T L' = A, L with 2 in its diagonal and 1/8 below it, which is well
   conditioned. */
static void division_is_the_inverse_of_multiplication(void **state)
{
    RITZ_OWN(ritz_dense) L = {0};

    (void)state;
    assert_ok(ritz_dense_new(8, 8, &L));
    for (int64_t j = 0; j < 8; j++)
        for (int64_t i = j; i < 8; i++)
            ritz_dense_col(&L, j)[i] = i == j ? 2.0 : 0.125;
    for (int threads = 1; threads <= MOST_THREADS; threads++) {
        RITZ_OWN(ritz_dense) A = {0}, B = {0}, back = {0};

        ritz_set_threads(threads);
        fill(POINTS, 8, 0.0, &A);
        assert_ok(ritz_dense_copy(&A, &B));
        ritz_tall_divide(&L, &B);
        assert_ok(ritz_dense_mul_nt(&B, &L, &back));
        check_near(&back, &A, 64.0);
    }
    ritz_set_threads(1);
}

/* sum of |v_i| |W|_ij |x_j| */
static double sum_terms(const ritz_sparse *W, const double *v, const double *x)
{
    double sum = 0.0;

    for (int64_t j = 0; j < W->ncol; j++)
        for (int64_t p = W->colptr[j]; p < W->colptr[j + 1]; p++)
            sum += fabs(v[W->rowind[p]] * W->val[p] * x[j]);
    return sum;
}

/* W X and |v|'|W||x| for all kernels, and widths from one column on. */
static void weighed_columns_and_their_terms_are_right(void **state)
{
    static const int64_t columns[] = {1, 4, 13, COLUMNS};
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};

    (void)state;
    lattice_new(EDGE, 1.0, &K, &M);
    for (size_t c = 0; c < 4 * 3; c++) {
        RITZ_OWN(ritz_dense) X = {0}, V = {0}, KX = {0}, Y = {0}, Z = {0};
        double size[COLUMNS];

        ritz_set_threads((int)(1 + c % MOST_THREADS));
        setenv("RITZ_TILES", bits[c % 3], 1);
        fill(POINTS, columns[c / 3], 0.0, &X);
        fill(POINTS, columns[c / 3], 0.5, &V);
        assert_ok(ritz_sparse_mul(&K, &X, &KX));
        assert_ok(ritz_tall_new(POINTS, X.ncol, &Y));
        assert_ok(ritz_tall_new(POINTS, X.ncol, &Z));
        assert_ok(ritz_tall_weigh(&K, &X, &Y));
        assert_ok(ritz_tall_weigh_sizes(&K, &V, &X, &Z, size));
        check_near(&Y, &KX, 7.0 * 13.0);
        check_near(&Z, &KX, 7.0 * 13.0);
        for (int64_t k = 0; k < X.ncol; k++) {
            const double sum =
                sum_terms(&K, ritz_dense_col(&V, k), ritz_dense_col(&X, k));

            assert_near(size[k], sum, POINTS * DBL_EPSILON * sum);
        }
    }
    unsetenv("RITZ_TILES");
    ritz_set_threads(1);
}

/* Sums are added in the order of the threads, whichever ends first. */
static void results_have_the_same_bits_in_every_run(void **state)
{
    RITZ_OWN(ritz_dense) A = {0}, first = {0};

    (void)state;
    ritz_set_threads(MOST_THREADS);
    fill(POINTS, COLUMNS, 0.0, &A);
    assert_ok(ritz_tall_inner(&A, &A, &first));
    for (int k = 0; k < 5; k++) {
        RITZ_OWN(ritz_dense) G = {0};

        assert_ok(ritz_tall_inner(&A, &A, &G));
        assert_memory_equal(G.val, first.val,
                            COLUMNS * COLUMNS * sizeof *G.val);
    }
    ritz_set_threads(1);
}

/* W X and |W||X|: the terms of all columns against those of one entry. */
static void terms_are_those_of_each_row(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0}, KX = {0}, Y = {0}, S = {0};

    (void)state;
    ritz_set_threads(MOST_THREADS);
    lattice_new(EDGE, 1.0, &K, &M);
    fill(POINTS, COLUMNS, 0.0, &X);
    assert_ok(ritz_sparse_mul(&K, &X, &KX));
    assert_ok(ritz_tall_weigh_terms(&K, &X, &Y, &S));
    check_near(&Y, &KX, 7.0 * 13.0);
    for (int64_t j = 0; j < COLUMNS; j++)
        for (int64_t i = 0; i < POINTS; i += 97) {
            const double *x = ritz_dense_col(&X, j);
            double sum = 0.0;

            for (int64_t p = K.colptr[i]; p < K.colptr[i + 1]; p++)
                sum += fabs(K.val[p] * x[K.rowind[p]]);
            assert_near(ritz_dense_col(&S, j)[i], sum, 7.0 * DBL_EPSILON * sum);
        }
    ritz_set_threads(1);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(products_agree_with_plain_ones),
    cmocka_unit_test(division_is_the_inverse_of_multiplication),
    cmocka_unit_test(weighed_columns_and_their_terms_are_right),
    cmocka_unit_test(results_have_the_same_bits_in_every_run),
    cmocka_unit_test(terms_are_those_of_each_row),
};

TEST_MODULE(tall, tests, NULL, NULL)
