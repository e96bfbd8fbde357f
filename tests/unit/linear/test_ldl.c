#include "testing.h"

#include <ritz/matrix.h>

#include <float.h>

/* [2 1; 1 -3] and, apart from it, the saddle [0 1; 1 0]. */
static ritz_status indefinite(double corner, ritz_sparse *out)
{
    const int64_t row[] = {0, 1, 0, 1, 2, 3};
    const int64_t col[] = {0, 0, 1, 1, 3, 2};
    const double val[] = {2.0, 1.0, 1.0, corner, 1.0, 1.0};

    return ritz_sparse_from_triplets(4, 4, 6, row, col, val, out);
}

/* Eigenvalues: one of each sign in either block. */
static void negative_pivots_are_counted(void **state)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_ldl) *F = NULL;
    int64_t negative = -1;

    (void)state;
    assert_ok(indefinite(-3.0, &A));
    assert_ok(ritz_ldl_new(&A, &negative, &F));
    assert_int_equal(negative, 2);
    ritz_ldl_free(&F);
    assert_null(F);
    ritz_sparse_free(&A);
    assert_ok(indefinite(3.0, &A));
    assert_ok(ritz_ldl_new(&A, &negative, &F));
    assert_int_equal(negative, 1);
}

/* A (1, 2, 3, 4)' = (4, -5, 4, 3)'; the condition number is below 4. */
static void solutions_are_exact_to_rounding(void **state)
{
    double x[] = {4.0, -5.0, 4.0, 3.0, 8.0, -10.0, 8.0, 6.0};
    ritz_dense X = {4, 2, x};
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_ldl) *F = NULL;

    (void)state;
    assert_ok(indefinite(-3.0, &A));
    assert_ok(ritz_ldl_new(&A, NULL, &F));
    assert_ok(ritz_ldl_solve(F, &X));
    for (int i = 0; i < 8; i++)
        assert_near(x[i], (i % 4 + 1) * (i < 4 ? 1.0 : 2.0),
                    64.0 * DBL_EPSILON);
}

/* [2 1; 1 1/2] exactly, and off by rounding either way. */
static void singular_matrices_are_refused(void **state)
{
    const double corner[] = {0.5, 0.5 + DBL_EPSILON, 0.5 - DBL_EPSILON};

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        RITZ_OWN(ritz_sparse) A = {0};
        ritz_ldl *F = NULL;

        assert_ok(indefinite(corner[k], &A));
        assert_fails(ritz_ldl_new(&A, NULL, &F), RITZ_ERR_SINGULAR,
                     "the matrix is singular");
        assert_null(F);
    }
}

/* The same matrix in other units has the same inertia and is as regular. */
static void units_do_not_matter(void **state)
{
    const int64_t row[] = {0, 1, 0, 1};
    const int64_t col[] = {0, 0, 1, 1};
    const double val[] = {2e-20, 1.0, 1.0, -3e20};
    double x[] = {0.0, 7e20};
    ritz_dense X = {2, 1, x};
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_ldl) *F = NULL;
    int64_t negative = 0;

    (void)state;
    assert_ok(ritz_sparse_from_triplets(2, 2, 4, row, col, val, &A));
    assert_ok(ritz_ldl_new(&A, &negative, &F));
    assert_int_equal(negative, 1);
    assert_ok(ritz_ldl_solve(F, &X)); /* (1e20, -2)' */
    assert_near(x[0], 1e20, 64.0 * DBL_EPSILON * 1e20);
    assert_near(x[1], -2.0, 64.0 * DBL_EPSILON * 2.0);
}

static void what_is_no_such_matrix_is_refused(void **state)
{
    const int64_t at[] = {0, 1};
    const double val[] = {1.0, HUGE_VAL};
    double x[] = {1.0};
    ritz_dense X = {1, 1, x};
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_ldl) *F = NULL;

    (void)state;
    assert_ok(ritz_sparse_from_triplets(2, 3, 1, at, at, val, &A));
    assert_fails(ritz_ldl_new(&A, NULL, &F), RITZ_ERR_ARGUMENT, "2 x 3 matrix");
    ritz_sparse_free(&A);
    assert_ok(ritz_sparse_from_triplets(2, 2, 2, at, at, val, &A));
    assert_fails(ritz_ldl_new(&A, NULL, &F), RITZ_ERR_ARGUMENT,
                 "entry (1, 1) is not finite");
    ritz_sparse_free(&A);
    assert_ok(indefinite(1.0, &A));
    assert_ok(ritz_ldl_new(&A, NULL, &F));
    assert_fails(ritz_ldl_solve(F, &X), RITZ_ERR_ARGUMENT,
                 "factor of 4 rows meets 1");
    ritz_ldl_free(&F);
    ritz_sparse_free(&A);
    assert_ok(ritz_sparse_new(0, 0, 0, &A));
    assert_ok(ritz_ldl_new(&A, NULL, &F));
}

static ritz_status factor(const ritz_sparse *A)
{
    ritz_ldl *F = NULL;
    ritz_status status = ritz_ldl_new(A, NULL, &F);

    ritz_ldl_free(&F);
    return status;
}

/* What MUMPS allocates for itself is not tested. */
static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_sparse) A = {0};

    (void)state;
    assert_ok(indefinite(-3.0, &A));
    assert_survives_every_allocation(factor(&A));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(negative_pivots_are_counted),
    cmocka_unit_test(solutions_are_exact_to_rounding),
    cmocka_unit_test(singular_matrices_are_refused),
    cmocka_unit_test(units_do_not_matter),
    cmocka_unit_test(what_is_no_such_matrix_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(ldl, tests, NULL, NULL)
