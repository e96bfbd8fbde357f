#include "fixtures/lattice.h"
#include "linear/inertia.h"
#include "linear/residuals.h"
#include "testing.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* A lattice of 24^3 points, 7 entries a row except at the faces: 93 312
   entries, enough for a second thread. */
enum { EDGE = 24, POINTS = EDGE * EDGE * EDGE, COLUMNS = 11 };

static const char *const bits[] = {"128", "256", "512"};

static void fill_columns(int64_t rows, ritz_dense *X)
{
    assert_ok(ritz_dense_new(rows, COLUMNS, X));
    for (int64_t i = 0; i < rows * COLUMNS; i++)
        X->val[i] = sin((double)(i + 1));
}

/* The first `count` columns of A, so that the result is not square. */
static void take_columns(const ritz_sparse *A, int64_t count, ritz_sparse *out)
{
    int64_t *at = calloc((size_t)A->nrow, sizeof *at);

    assert_non_null(at);
    for (int64_t i = 0; i < A->nrow; i++)
        at[i] = i;
    assert_ok(ritz_sparse_extract(A, A->nrow, at, count, at, out));
    free(at);
}

/* Y = A X within rounding. Each entry is a sum of at most 7 terms whose
   magnitudes add up to at most 7 + 6, the row sum of |A|, as |x| <= 1. */
static void check_product(const ritz_sparse *A, const ritz_dense *X,
                          const ritz_dense *Y)
{
    for (int64_t k = 0; k < COLUMNS; k++) {
        RITZ_OWN(ritz_dense) y = {0};

        assert_ok(ritz_dense_new(A->nrow, 1, &y));
        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
                y.val[A->rowind[p]] += A->val[p] * X->val[j + k * A->ncol];
        for (int64_t i = 0; i < A->nrow; i++)
            assert_near(Y->val[i + k * A->nrow], y.val[i],
                        7.0 * 13.0 * DBL_EPSILON);
    }
}

static void products_agree_for_all_threads_and_kernels(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, A = {0};
    RITZ_OWN(ritz_dense) X = {0};

    (void)state;
    lattice_new(EDGE, 1.0, &K, &M);
    take_columns(&K, POINTS - 100, &A);
    fill_columns(A.ncol, &X);
    for (int threads = 1; threads <= 3; threads++)
        for (size_t b = 0; b < 3; b++) {
            RITZ_OWN(ritz_dense) Y = {0};

            setenv("RITZ_TILES", bits[b], 1);
            ritz_set_threads(threads);
            assert_ok(ritz_sparse_mul(&A, &X, &Y));
            check_product(&A, &X, &Y);
        }
    unsetenv("RITZ_TILES");
    ritz_set_threads(1);
}

/* All kernels give the same bits, and A X is right to rounding of the result,
   although terms of magnitude 12 in all cancel to 1/3 in most rows. */
static void twofold_products_are_the_same_everywhere(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, A = {0};
    RITZ_OWN(ritz_dense) X = {0}, first = {0};

    (void)state;
    lattice_new(EDGE, 1.0 / 3.0, &K, &M);
    take_columns(&K, POINTS - 100, &A);
    fill_columns(A.ncol, &X);
    for (int64_t i = 0; i < A.ncol * COLUMNS; i++)
        X.val[i] = 1.0 + 1e-9 * X.val[i];
    for (int threads = 1; threads <= 3; threads++)
        for (size_t b = 0; b < 3; b++) {
            RITZ_OWN(ritz_dense) Y = {0};

            setenv("RITZ_TILES", bits[b], 1);
            ritz_set_threads(threads);
            assert_ok(ritz_sparse_mul_twofold(&A, &X, &Y));
            if (!first.val)
                assert_ok(ritz_dense_copy(&Y, &first));
            assert_memory_equal(Y.val, first.val,
                                (size_t)(A.nrow * COLUMNS) * sizeof *Y.val);
        }
    unsetenv("RITZ_TILES");
    ritz_set_threads(1);
    for (int64_t k = 0; k < COLUMNS; k++) {
        long double *y = calloc((size_t)A.nrow, sizeof *y);

        assert_non_null(y);
        for (int64_t j = 0; j < A.ncol; j++)
            for (int64_t p = A.colptr[j]; p < A.colptr[j + 1]; p++)
                y[A.rowind[p]] +=
                    (long double)A.val[p] * (long double)X.val[j + k * A.ncol];
        for (int64_t i = 0; i < A.nrow; i++) /* y too has been rounded */
            assert_near(first.val[i + k * A.nrow], (double)y[i],
                        14.0 * (double)LDBL_EPSILON +
                            DBL_EPSILON * fabs((double)y[i]));
        free(y);
    }
}

/* |x|'|A||y| */
static double sum_terms(const ritz_sparse *A, const double *x, const double *y)
{
    double sum = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            sum += fabs(x[A->rowind[p]] * A->val[p] * y[j]);
    return sum;
}

/* Columns in any order, more than are taken at a time. */
static void terms_are_sums_of_magnitudes(void **state)
{
    enum { MANY = 2 * COLUMNS };
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0}, terms = {0};
    int64_t at[MANY];

    (void)state;
    lattice_new(EDGE, 1.0, &K, &M);
    fill_columns(POINTS, &X);
    for (int64_t k = 0; k < MANY; k++)
        at[k] = (7 * k + 3) % COLUMNS;
    for (int threads = 1; threads <= 3; threads++) {
        RITZ_OWN(ritz_dense) most = {0};

        ritz_set_threads(threads);
        assert_ok(ritz_sparse_terms(&K, &X, MANY, at, &most));
        for (int64_t k = 0; k < MANY; k++)
            for (int64_t i = 0; i < COLUMNS; i++) {
                const double sum = sum_terms(&K, ritz_dense_col(&X, i),
                                             ritz_dense_col(&X, at[k]));

                assert_near(ritz_dense_col(&most, k)[i], sum,
                            POINTS * DBL_EPSILON * sum);
            }
    }
    ritz_set_threads(1);
    assert_survives_every_allocation(
        ritz_sparse_terms(&K, &X, MANY, at, &terms));
}

/* R = K X - M X Lambda against two products. Terms of |x|'|A||x| are positive,
   so that their relative rounding is less than eps times the number of rows;
   each row of R has at most 27 terms of K and of M. */
static void residuals_are_differences_of_products(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0}, KX = {0}, MX = {0};
    double terms[2][COLUMNS], lambda[COLUMNS];

    (void)state;
    lattice_new(EDGE, 1.0, &K, &M);
    fill_columns(POINTS, &X);
    for (int k = 0; k < COLUMNS; k++)
        lambda[k] = 0.5 * k - 1.0;
    assert_ok(ritz_sparse_mul(&K, &X, &KX));
    assert_ok(ritz_sparse_mul(&M, &X, &MX));
    for (int threads = 1; threads <= 3; threads++) {
        RITZ_OWN(ritz_dense) R = {0};

        ritz_set_threads(threads);
        assert_ok(
            ritz_pairs_subtract(&K, &M, &X, lambda, &R, terms[0], terms[1]));
        for (int64_t k = 0; k < COLUMNS; k++) {
            const double *x = ritz_dense_col(&X, k);
            double size = 0.0;

            for (int a = 0; a < 2; a++) {
                const double sum = sum_terms(a == 0 ? &K : &M, x, x);

                assert_near(terms[a][k], sum, POINTS * DBL_EPSILON * sum);
            }
            for (int64_t i = 0; i < POINTS; i++)
                size = fmax(size, fabs(x[i]));
            size *= ritz_sparse_max(&K) + fabs(lambda[k]) * ritz_sparse_max(&M);
            for (int64_t i = 0; i < POINTS; i++)
                assert_near(ritz_dense_col(&R, k)[i],
                            ritz_dense_col(&KX, k)[i] -
                                lambda[k] * ritz_dense_col(&MX, k)[i],
                            4.0 * 27.0 * 27.0 * DBL_EPSILON * size);
        }
    }
    ritz_set_threads(1);
    {
        RITZ_OWN(ritz_dense) R = {0};

        assert_survives_every_allocation(
            ritz_pairs_subtract(&K, &M, &X, lambda, &R, terms[0], terms[1]));
    }
}

/* L'K X, L being the first 3 columns of X, against the product of K X; sums of
   POINTS terms. */
static void between_is_a_product_of_three(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0}, KX = {0}, C = {0}, wrong = {0};
    ritz_dense L = {0};

    (void)state;
    lattice_new(EDGE, 1.0, &K, &M);
    fill_columns(POINTS, &X);
    L = ritz_dense_part(&X, 0, 3);
    assert_ok(ritz_sparse_mul(&K, &X, &KX));
    assert_ok(ritz_sparse_between(&L, &K, &X, &C));
    assert_int_equal(C.nrow, 3);
    assert_int_equal(C.ncol, COLUMNS);
    for (int64_t j = 0; j < COLUMNS; j++)
        for (int64_t i = 0; i < 3; i++)
            assert_near(ritz_dense_col(&C, j)[i], ritz_dense_dot(&L, i, &KX, j),
                        POINTS * DBL_EPSILON *
                            sum_terms(&K, ritz_dense_col(&L, i),
                                      ritz_dense_col(&X, j)));
    ritz_dense_free(&C);
    assert_survives_every_allocation(ritz_sparse_between(&L, &K, &X, &C));
    assert_ok(ritz_dense_new(POINTS + 1, 1, &wrong));
    assert_int_equal(ritz_sparse_between(&L, &K, &wrong, &C),
                     RITZ_ERR_ARGUMENT);
}

/* The submatrix of every second row and column, in ascending or descending
   order, has the entries of A. */
static void check_every_second(const ritz_sparse *A, bool descending)
{
    enum { HALF = POINTS / 2 };
    RITZ_OWN_ARRAY int64_t *at = NULL;
    RITZ_OWN(ritz_sparse) B = {0};
    int64_t due = 0;

    at = calloc(HALF, sizeof *at);
    assert_non_null(at);
    for (int64_t k = 0; k < HALF; k++)
        at[k] = descending ? POINTS - 1 - 2 * k : 2 * k;
    for (int64_t k = 0; k < HALF; k++)
        for (int64_t p = A->colptr[at[k]]; p < A->colptr[at[k] + 1]; p++)
            due += (A->rowind[p] + at[k]) % 2 == 0;
    assert_ok(ritz_sparse_extract(A, HALF, at, HALF, at, &B));
    assert_ok(ritz_sparse_check(&B, due));
    for (int64_t k = 0; k < HALF; k++)
        for (int64_t p = B.colptr[k]; p < B.colptr[k + 1]; p++) {
            int64_t q = A->colptr[at[k]];

            while (A->rowind[q] != at[B.rowind[p]])
                q++;
            assert_true(B.val[p] == A->val[q]);
        }
}

static void submatrices_keep_the_given_order_of_rows(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};

    (void)state;
    lattice_new(EDGE, 1.0, &K, &M);
    for (int threads = 1; threads <= 2; threads++) {
        ritz_set_threads(threads);
        check_every_second(&K, false);
        check_every_second(&K, true);
    }
    ritz_set_threads(1);
}

/* A count at an eigenvalue of several modes includes any number of these, or
   fails and leaves its result unchanged. */
static void count_at_eigenvalue(ritz_counter *counter, double lambda,
                                int64_t least, int64_t most)
{
    int64_t below = -1;
    const ritz_status status = ritz_counter_below(counter, lambda, &below);

    if (status == RITZ_OK)
        assert_in_range(below, least, most);
    else
        assert_int_equal(status, RITZ_ERR_SINGULAR);
    assert_true(status == RITZ_OK || below == -1);
}

/* Counts after one at an eigenvalue are right. */
static void one_counter_counts_below_many_values(void **state)
{
    enum { SIDE = 5, ALL = SIDE * SIDE * SIDE };
    const double middle = 1.0 + 6.0; /* an eigenvalue: all cosines are 0 */
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    ritz_counter *counter = NULL;
    int64_t below = -1, first = 0, last = 0;

    (void)state;
    lattice_new(SIDE, 1.0, &K, &M);
    lambda = lattice_eigenvalues(SIDE, 1.0);
    for (int64_t k = 0; k < ALL; k++) {
        first += lambda[k] < middle - 1e-9;
        last += lambda[k] < middle + 1e-9;
    }
    assert_true(last > first);
    assert_ok(ritz_counter_new(&K, &M, NULL, &counter));
    for (int64_t k = 1; k < ALL; k++) {
        if (lambda[k] - lambda[k - 1] < 1e-6)
            continue;
        assert_ok(ritz_counter_below(counter, 0.5 * (lambda[k] + lambda[k - 1]),
                                     &below));
        assert_int_equal(below, k);
        if (k % 8 == 0)
            count_at_eigenvalue(counter, middle, first, last);
    }
    assert_ok(ritz_counter_below(counter, 100.0, &below));
    assert_int_equal(below, ALL);
    assert_fails(ritz_counter_below(counter, (double)NAN, &below),
                 RITZ_ERR_ARGUMENT, "cannot be counted");
    assert_survives_every_allocation(ritz_counter_below(counter, 3.9, &below));
    ritz_counter_free(&counter);
    assert_survives_every_allocation(ritz_counter_new(&K, &M, NULL, &counter));
    ritz_counter_free(&counter);
}

/* K = M = I, the first of two vectors not a number. */
static void worst_residual_is_nan_if_any_residual_is(void **state)
{
    const int64_t at[] = {0, 1};
    const double ones[] = {1.0, 1.0};
    double lambda[] = {1.0, 1.0}, residual[2] = {0};
    RITZ_OWN(ritz_sparse) I = {0};
    RITZ_OWN(ritz_dense) Phi = {0};
    ritz_pairs pairs = {.lambda = lambda, .residual = residual};
    double worst = 0.0;

    (void)state;
    assert_ok(ritz_sparse_from_triplets(2, 2, 2, at, at, ones, &I));
    assert_ok(ritz_dense_new(2, 2, &Phi));
    Phi.val[0] = (double)NAN;
    Phi.val[3] = 1.0;
    pairs.Phi = Phi;
    assert_ok(ritz_pairs_assess(&I, &I, &pairs, NULL, &worst));
    assert_true(isnan(residual[0]));
    assert_true(residual[1] == 0.0);
    assert_true(isnan(worst));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(products_agree_for_all_threads_and_kernels),
    cmocka_unit_test(twofold_products_are_the_same_everywhere),
    cmocka_unit_test(terms_are_sums_of_magnitudes),
    cmocka_unit_test(residuals_are_differences_of_products),
    cmocka_unit_test(between_is_a_product_of_three),
    cmocka_unit_test(submatrices_keep_the_given_order_of_rows),
    cmocka_unit_test(one_counter_counts_below_many_values),
    cmocka_unit_test(worst_residual_is_nan_if_any_residual_is),
};

TEST_MODULE(products, tests, NULL, NULL)
