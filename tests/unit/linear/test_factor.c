#include "linear/factor.h"
#include "testing.h"

#include <ritz/matrix.h>

#include <float.h>
#include <stdlib.h>

/* Chain of n springs of stiffness k, its first end clamped or free. */
static ritz_status chain(int64_t n, double k, int clamped, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    int64_t *row = calloc((size_t)(3 * n), sizeof *row);
    int64_t *col = calloc((size_t)(3 * n), sizeof *col);
    double *val = calloc((size_t)(3 * n), sizeof *val);
    int64_t count = 0;

    for (int64_t i = 0; i < n; i++) {
        double left = i > 0 || clamped ? k : 0.0;
        double right = i + 1 < n ? k : 0.0;

        for (int64_t d = -1; d <= 1; d++) {
            if (i + d < 0 || i + d >= n)
                continue;
            row[count] = i;
            col[count] = i + d;
            val[count++] = d == 0 ? left + right : -k;
        }
    }
    status = ritz_sparse_from_triplets(n, n, count, row, col, val, out);
    free(row);
    free(col);
    free(val);
    return status;
}

/*
 * A force at the free end moves mass i by (i + 1) / k. The condition number is
 * below 4 n^2 / 2, its rounding below that times eps. 100 columns are more than
 * one block.
 */
static void chain_is_as_soft_as_its_springs_in_series(void **state)
{
    enum { SIZE = 200, COLUMNS = 100 };

    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0};
    double bound = 2.0 * SIZE * SIZE * DBL_EPSILON * SIZE;

    (void)state;
    assert_ok(chain(SIZE, 3.0, 1, &A));
    assert_ok(ritz_factor_spd(&A, &F));
    assert_ok(ritz_dense_new(SIZE, COLUMNS, &X));
    for (int64_t j = 0; j < COLUMNS; j++)
        ritz_dense_col(&X, j)[SIZE - 1] = 3.0 * (double)(j + 1);
    assert_ok(ritz_factor_solve(F, &X));
    for (int64_t j = 0; j < COLUMNS; j++)
        for (int64_t i = 0; i < SIZE; i++)
            assert_near(ritz_dense_col(&X, j)[i] / (double)(j + 1),
                        (double)(i + 1), bound);
}

/* Both solves have the rounding errors of the chain, see above. */
static void two_blocks_are_solved_as_one_by_one(void **state)
{
    enum { SIZE = 90, BLOCK = 8 * SIZE };
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    double x[2 * BLOCK], y[2 * BLOCK], room[2 * BLOCK];
    const double bound = 2.0 * SIZE * SIZE * DBL_EPSILON * SIZE;

    (void)state;
    assert_ok(chain(SIZE, 3.0, 1, &A));
    assert_ok(ritz_factor_spd(&A, &F));
    for (int i = 0; i < 2 * BLOCK; i++)
        x[i] = y[i] = (double)(i % 13) / 12.0;
    ritz_factor_solve_two(F, x, room);
    ritz_factor_solve_rows(F, y);
    ritz_factor_solve_rows(F, y + BLOCK);
    for (int i = 0; i < 2 * BLOCK; i++)
        assert_near(x[i], y[i], bound);
}

/* Units make no matrix singular: 1e-40 N/m beside 1 N/m. */
static void units_do_not_matter(void **state)
{
    const int64_t at[] = {0, 1};
    const double val[] = {1.0, 1e-40};
    double x[] = {3.0, 3.0};
    ritz_dense X = {2, 1, x};
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;

    (void)state;
    assert_ok(ritz_sparse_from_triplets(2, 2, 2, at, at, val, &A));
    assert_ok(ritz_factor_spd(&A, &F));
    assert_ok(ritz_factor_solve(F, &X));
    assert_near(x[0], 3.0, 3.0 * DBL_EPSILON);
    assert_near(x[1], 3e40, 3e40 * 4.0 * DBL_EPSILON);
}

/* A dense block, so that CHOLMOD takes its supernodal path: n I + ones. */
static ritz_status full(int64_t n, double diagonal, ritz_sparse *out)
{
    ritz_status status = ritz_sparse_new(n, n, n * n, out);

    for (int64_t j = 0; status == RITZ_OK && j < n; j++) {
        out->colptr[j + 1] = (j + 1) * n;
        for (int64_t i = 0; i < n; i++) {
            out->rowind[i + j * n] = i;
            out->val[i + j * n] = 1.0 + (i == j ? diagonal : 0.0);
        }
    }
    return status;
}

/* (d I + 1 1')^-1 1 = 1 / (d + n), to eps times the condition 1 + n / d. */
static void full_matrices_are_solved(void **state)
{
    enum { SIZE = 150 };

    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0};

    (void)state;
    assert_ok(full(SIZE, 50.0, &A));
    assert_ok(ritz_factor_spd(&A, &F));
    assert_ok(ritz_dense_new(SIZE, 1, &X));
    for (int64_t i = 0; i < SIZE; i++)
        X.val[i] = 1.0;
    assert_ok(ritz_factor_solve(F, &X));
    for (int64_t i = 0; i < SIZE; i++)
        assert_near(X.val[i], 1.0 / 200.0, SIZE * DBL_EPSILON * 4.0 / 200.0);
}

/* Rounding makes the last pivot of a free chain zero, tiny or negative. */
static void free_bodies_are_refused(void **state)
{
    const double k[] = {1.0, 0.1, 1.1 / 3.0, 7e9, 1e-7};
    const int64_t n[] = {2, 11, 51, 250, 3001};

    (void)state;
    for (size_t i = 0; i < 25; i++) {
        RITZ_OWN(ritz_sparse) A = {0};
        ritz_factor *F = NULL;
        int64_t weak = -1;

        assert_ok(chain(n[i % 5], k[i / 5], 0, &A));
        assert_fails(ritz_factor_spd_weak(&A, &F, &weak), RITZ_ERR_SINGULAR,
                     "is a rigid-body motion left free?");
        assert_null(F);
        assert_true(weak >= 0 && weak < n[i % 5]);
    }
}

/* Row 1 has a negative or no stiffness, and only it. */
static void the_weak_row_is_named(void **state)
{
    const int64_t at[] = {0, 1, 2};
    const double d[] = {0.0, -1.0};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        const double val[] = {1.0, d[k], 2.0};
        RITZ_OWN(ritz_sparse) A = {0};
        ritz_factor *F = NULL;
        int64_t weak = -1;

        assert_ok(ritz_sparse_from_triplets(3, 3, 3, at, at, val, &A));
        assert_fails(ritz_factor_spd_weak(&A, &F, &weak), RITZ_ERR_SINGULAR,
                     "not positive definite");
        assert_int_equal(weak, 1);
    }
}

/* n^2 = 1e10 is far from 1 / eps: a long chain is soft, not singular. */
static void long_chains_are_not_singular(void **state)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;

    (void)state;
    assert_ok(chain(100000, 1.0, 1, &A));
    assert_ok(ritz_factor_spd(&A, &F));
}

static void what_is_no_such_matrix_is_refused(void **state)
{
    const int64_t at[] = {0, 1};
    const double val[] = {1.0, nan("")};
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;

    (void)state;
    assert_ok(ritz_sparse_from_triplets(2, 3, 1, at, at, val, &A));
    assert_fails(ritz_factor_spd(&A, &F), RITZ_ERR_ARGUMENT, "2 x 3 matrix");
    ritz_sparse_free(&A);
    assert_ok(ritz_sparse_from_triplets(2, 2, 2, at, at, val, &A));
    assert_fails(ritz_factor_spd(&A, &F), RITZ_ERR_ARGUMENT,
                 "entry (1, 1) is not finite");
    ritz_sparse_free(&A);
    assert_ok(chain(3, 1.0, 1, &A));
    assert_ok(ritz_factor_spd(&A, &F));
    assert_ok(ritz_dense_new(2, 1, &X));
    assert_fails(ritz_factor_solve(F, &X), RITZ_ERR_ARGUMENT,
                 "factor of 3 rows meets 2");
}

static void nothing_is_factored_too(void **state)
{
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;

    (void)state;
    assert_ok(ritz_sparse_new(0, 0, 0, &A));
    assert_ok(ritz_factor_spd(&A, &F));
    assert_ok(ritz_dense_new(0, 2, &X));
    assert_ok(ritz_factor_solve(F, &X));
}

/* A chain from its middle outwards, which no method of ordering would choose. */
static void a_given_order_is_kept(void **state)
{
    enum { N = 41 };
    int64_t order[N];
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *F = NULL, *again = NULL;
    RITZ_OWN(ritz_dense) X = {0};

    (void)state;
    for (int64_t k = 0; k < N; k++)
        order[k] = N / 2 + (k % 2 ? -1 : 1) * ((k + 1) / 2);
    assert_ok(chain(N, 4.0, 1, &A));
    assert_ok(ritz_factor_spd_ordered(&A, order, &F));
    assert_ok(ritz_factor_spd_ordered(&A, ritz_factor_order(F), &again));
    assert_memory_equal(ritz_factor_order(F), ritz_factor_order(again),
                        N * sizeof *order);
    assert_ok(ritz_dense_new(N, 1, &X));
    X.val[N - 1] = 1.0;
    assert_ok(ritz_factor_solve(F, &X));
    for (int64_t i = 0; i < N; i++)
        assert_near(X.val[i], (double)(i + 1) / 4.0,
                    2.0 * N * N * DBL_EPSILON * N);
}

static ritz_status factor_and_solve(const ritz_sparse *A)
{
    double x[5] = {1.0};
    ritz_dense X = {5, 1, x};
    RITZ_OWN(ritz_factor) *F = NULL;

    RITZ_CHECK(ritz_factor_spd(A, &F));
    return ritz_factor_solve(F, &X);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_sparse) A = {0};

    (void)state;
    assert_ok(chain(5, 4.0, 1, &A));
    assert_survives_every_allocation(factor_and_solve(&A));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(chain_is_as_soft_as_its_springs_in_series),
    cmocka_unit_test(two_blocks_are_solved_as_one_by_one),
    cmocka_unit_test(units_do_not_matter),
    cmocka_unit_test(full_matrices_are_solved),
    cmocka_unit_test(free_bodies_are_refused),
    cmocka_unit_test(the_weak_row_is_named),
    cmocka_unit_test(long_chains_are_not_singular),
    cmocka_unit_test(what_is_no_such_matrix_is_refused),
    cmocka_unit_test(nothing_is_factored_too),
    cmocka_unit_test(a_given_order_is_kept),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(factor, tests, NULL, NULL)
