#include "fixtures/lattice.h"
#include "linear/factor.h"
#include "testing.h"

#include <float.h>
#include <stdlib.h>

enum { EDGE = 13 };

static int64_t count_lower(const double *lambda, int64_t n, double tau)
{
    int64_t count = 0;

    while (count < n && lambda[count] < tau)
        count++;
    return count;
}

/* Largest |A x - b| over |A| max |x| of a solve with nine right-hand sides,
   where |A| <= 12. A second solve must give the same bits. */
static double residual_of(const ritz_sparse *A, ritz_factor *F)
{
    RITZ_OWN(ritz_dense) X = {0}, Y = {0}, B = {0};
    double gap = 0.0;
    double size = 0.0;

    assert_ok(ritz_dense_new(A->nrow, 9, &X));
    for (int64_t i = 0; i < A->nrow * 9; i++)
        X.val[i] = sin((double)(i + 1));
    assert_ok(ritz_dense_copy(&X, &B));
    assert_ok(ritz_dense_copy(&X, &Y));
    assert_ok(ritz_factor_solve(F, &X));
    assert_ok(ritz_factor_solve(F, &Y));
    assert_memory_equal(X.val, Y.val, (size_t)(A->nrow * 9) * 8);
    ritz_dense_free(&Y);
    assert_ok(ritz_sparse_mul(A, &X, &Y));
    for (int64_t i = 0; i < A->nrow * 9; i++) {
        gap = fmax(gap, fabs(Y.val[i] - B.val[i]));
        size = fmax(size, 12.0 * fabs(X.val[i]));
    }
    return gap / size;
}

/*
 * The number of negative pivots is that of the eigenvalues of the cube below
 * the shift, for shifts between eigenvalues. The residual of a solve is at most
 * the backward error that is allowed.
 */
static void signs_count_eigenvalues(void **state)
{
    const double tau[] = {-0.1, 0.5, 2.05, 3.33, 5.77, 6.3, 9.01, 12.5};
    const int64_t n = (int64_t)EDGE * EDGE * EDGE;
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    double *lambda = lattice_eigenvalues(EDGE, 0.0);

    (void)state;
    lattice_new(EDGE, 0.0, &K, &M);
    for (int threads = 1; threads <= 3; threads++)
        for (size_t k = 0; k < sizeof tau / sizeof *tau; k++) {
            RITZ_OWN(ritz_sparse) A = {0};
            RITZ_OWN(ritz_factor) *F = NULL;
            int64_t negative = -1;

            ritz_set_threads(threads);
            assert_ok(ritz_sparse_add(1.0, &K, -tau[k], &M, &A));
            assert_ok(ritz_factor_signed(&A, NULL, &negative, &F));
            assert_int_equal(negative, count_lower(lambda, n, tau[k]));
            assert_near(residual_of(&A, F), 0.0, 1e-12);
        }
    ritz_set_threads(1);
    free(lambda);
}

/* With the order of another factor solves are accurate, and the order of the
   new factor is a permutation of all rows. */
static void a_given_order_serves_any_shift(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, A = {0};
    RITZ_OWN(ritz_factor) *L = NULL, *F = NULL;
    RITZ_OWN(ritz_dense) met = {0};
    int64_t negative = -1;

    (void)state;
    lattice_new(EDGE, 0.1, &K, &M);
    assert_ok(ritz_factor_spd(&K, &L));
    assert_ok(ritz_sparse_add(1.0, &K, -4.2, &M, &A));
    assert_ok(ritz_factor_signed(&A, ritz_factor_order(L), &negative, &F));
    assert_near(residual_of(&A, F), 0.0, 1e-12);
    assert_ok(ritz_dense_new(K.nrow, 1, &met));
    for (int64_t k = 0; k < K.nrow; k++)
        met.val[ritz_factor_order(F)[k]] += 1.0;
    for (int64_t k = 0; k < K.nrow; k++)
        assert_true(met.val[k] == 1.0);
}

/* [a 1; 1 a] */
static ritz_status factor_pair(double a)
{
    const int64_t row[] = {0, 1, 0, 1};
    const int64_t col[] = {0, 0, 1, 1};
    const double val[] = {a, 1.0, 1.0, a};
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    int64_t negative = -1;

    RITZ_CHECK(ritz_sparse_from_triplets(2, 2, 4, row, col, val, &A));
    return ritz_factor_signed(&A, NULL, &negative, &F);
}

/* Its leading minor a is zero or small. */
static void small_leading_minors_are_refused(void **state)
{
    (void)state;
    assert_ok(factor_pair(0.5));
    assert_int_equal(factor_pair(0.0), RITZ_ERR_SINGULAR);
    assert_string_equal(ritz_error_message(),
                        "the matrix or a leading part of it is singular");
    assert_int_equal(factor_pair(1e-14), RITZ_ERR_SINGULAR);
    assert_non_null(
        strstr(ritz_error_message(), "the factor has a backward error of"));
}

static ritz_status factor_cube(const ritz_sparse *A)
{
    RITZ_OWN(ritz_factor) *F = NULL;
    int64_t negative = 0;

    return ritz_factor_signed(A, NULL, &negative, &F);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, A = {0};

    (void)state;
    lattice_new(5, 0.1, &K, &M);
    assert_ok(ritz_sparse_add(1.0, &K, -4.2, &M, &A));
    assert_survives_every_allocation(factor_cube(&A));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(signs_count_eigenvalues),
    cmocka_unit_test(a_given_order_serves_any_shift),
    cmocka_unit_test(small_leading_minors_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(signed, tests, NULL, NULL)
