#include "fixtures/lattice.h"
#include "linear/factor.h"
#include "linear/inertia.h"
#include "linear/ordering.h"
#include "linear/tiles.h"
#include "testing.h"

#include <float.h>
#include <stdlib.h>
#include <sys/vfs.h>

enum { EDGE = 20, POINTS = EDGE * EDGE * EDGE };

static const double ground = 0.01;

/* The largest error of A^-1 (A X); also checks that a second solve gives the
   same bits. */
static double solve_twice(const ritz_sparse *A, ritz_factor *F, int64_t columns)
{
    RITZ_OWN(ritz_dense) X = {0}, Y = {0}, Z = {0};
    double worst = 0.0;

    assert_ok(ritz_dense_new(POINTS, columns, &X));
    for (int64_t i = 0; i < POINTS * columns; i++)
        X.val[i] = sin((double)(i + 1));
    assert_ok(ritz_sparse_mul(A, &X, &Y));
    assert_ok(ritz_dense_copy(&Y, &Z));
    assert_ok(ritz_factor_solve(F, &Y));
    assert_ok(ritz_factor_solve(F, &Z));
    for (int64_t i = 0; i < POINTS * columns; i++)
        worst = fmax(worst, fabs(Y.val[i] - X.val[i]));
    assert_memory_equal(Y.val, Z.val, (size_t)(POINTS * columns) * 8);
    return worst;
}

/* The factor is read back before the next solve, with the same bits, also if it
   is written twice in a row. A folder in memory, or one that does not exist, is
   refused, and the factor can still be used. */
static void a_factor_can_be_in_a_file(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};
    const char *folder = getenv("TMPDIR");
    struct statfs system = {0};

    (void)state;
    unsetenv("TMPDIR"); /* the user's may be in memory */
    lattice_new(EDGE, ground, &K, &M);
    assert_ok(ritz_factor_spd(&K, &F));
    assert_ok(ritz_dense_new(POINTS, 3, &X));
    for (int64_t i = 0; i < 3 * POINTS; i++)
        X.val[i] = cos((double)i);
    assert_ok(ritz_dense_copy(&X, &Y));
    assert_ok(ritz_factor_solve(F, &X));
    for (int pass = 0; pass < 2; pass++) {
        RITZ_OWN(ritz_dense) Z = {0};

        assert_ok(ritz_factor_spill(F));
        assert_ok(ritz_factor_spill(F));
        assert_true(ritz_disk_used() > 8 * (int64_t)POINTS);
        assert_ok(ritz_dense_copy(&Y, &Z));
        assert_ok(ritz_factor_solve(F, &Z));
        assert_memory_equal(X.val, Z.val, (size_t)(3 * POINTS) * 8);
    }
    setenv("TMPDIR", "/no/such/folder", 1);
    assert_fails(ritz_factor_spill(F), RITZ_ERR_FILE,
                 "the factor cannot be written to '/no/such/folder' (TMPDIR)");
    setenv("TMPDIR", "/dev/shm", 1);
    if (statfs("/dev/shm", &system) == 0 && system.f_type == 0x1021994)
        assert_fails(ritz_factor_spill(F), RITZ_ERR_FILE,
                     "'/dev/shm' are in memory, too");
    assert_ok(ritz_factor_solve(F, &Y));
    assert_memory_equal(X.val, Y.val, (size_t)(3 * POINTS) * 8);
    if (folder)
        setenv("TMPDIR", folder, 1);
    else
        unsetenv("TMPDIR");
}

/*
 * The error is at most the condition number, 12.01 / 0.06 = 200, times some
 * eps: 16, as an entry takes part in few sums.
 */
static void every_kernel_and_number_of_threads_solves(void **state)
{
    const char *const bits[] = {"128", "256", "512"};
    const int64_t columns[] = {1, 7, 8, 9, 16, 20};
    const double bound = 200.0 * 16.0 * DBL_EPSILON;
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};

    (void)state;
    lattice_new(EDGE, ground, &K, &M);
    for (int threads = 1; threads <= 3; threads++)
        for (size_t b = 0; b < 3; b++) {
            RITZ_OWN(ritz_factor) *F = NULL;

            setenv("RITZ_TILES", bits[b], 1);
            ritz_set_threads(threads);
            assert_ok(ritz_factor_spd(&K, &F));
            for (size_t c = 0; c < 6; c++)
                assert_near(solve_twice(&K, F, columns[c]), 0.0, bound);
        }
    unsetenv("RITZ_TILES");
    ritz_set_threads(1);
}

/* Each row occurs once in the order, and the two rows of a grid follow each
   other. */
static void an_order_keeps_the_rows_of_a_grid_together(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, both = {0};
    int64_t *order = NULL;
    int64_t *place = calloc(2 * POINTS, sizeof *place);
    int64_t *row = NULL;

    (void)state;
    assert_non_null(place);
    lattice_new(EDGE, ground, &K, &M);
    /* each point has the two dofs 2 i and 2 i + 1, which are coupled */
    assert_ok(
        ritz_sparse_new(2 * POINTS, 2 * POINTS, 4 * K.colptr[POINTS], &both));
    row = both.rowind;
    for (int64_t j = 0; j < 2 * POINTS; j++) {
        for (int64_t p = K.colptr[j / 2]; p < K.colptr[j / 2 + 1]; p++) {
            *row++ = 2 * K.rowind[p];
            *row++ = 2 * K.rowind[p] + 1;
        }
        both.colptr[j + 1] = row - both.rowind;
    }
    assert_ok(ritz_ordering_new(&both, &order));
    for (int64_t k = 0; k < 2 * POINTS; k++)
        place[order[k]] += k + 1;
    for (int64_t i = 0; i < POINTS; i++)
        assert_int_equal(place[2 * i + 1], place[2 * i] + 1);
    for (int64_t k = 0; k < 2 * POINTS; k++)
        assert_int_equal(order[place[k] - 1], k);
    free(order);
    free(place);
}

/* Order a matrix of the pattern of A, and compare with A's order. */
static ritz_status order_alike(const ritz_sparse *A, const int64_t *expected)
{
    RITZ_OWN(ritz_sparse) twice = {0};
    RITZ_OWN_ARRAY int64_t *order = NULL;

    RITZ_CHECK(ritz_sparse_add(1.0, A, 1.0, A, &twice));
    RITZ_CHECK(ritz_ordering_new(&twice, &order));
    assert_memory_equal(order, expected, (size_t)A->nrow * sizeof *order);
    return RITZ_OK;
}

/* Order matrices of one pattern while a new store is lent: it then has one
   order. */
static ritz_status store_once(const ritz_sparse *A, const int64_t *expected)
{
    RITZ_OWN(ritz_orders) *orders = NULL;

    RITZ_CHECK(ritz_orders_new(&orders));
    {
        [[maybe_unused]] RITZ_OWN(ritz_orders_lent) lent =
            ritz_orders_lend(orders);

        RITZ_CHECK(order_alike(A, expected));
        RITZ_CHECK(order_alike(A, expected));
    }
    assert_int_equal(ritz_orders_count(orders), 1);
    return RITZ_OK;
}

/* One order is stored for each pattern, whatever the values, and none when the
   store is no longer lent. */
static void a_store_has_an_order_for_each_pattern(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, less = {0}, M_less = {0};
    RITZ_OWN(ritz_sparse) least = {0}, M_least = {0};
    RITZ_OWN(ritz_orders) *orders = NULL;
    RITZ_OWN_ARRAY int64_t *order = NULL, *other = NULL, *last = NULL;

    (void)state;
    lattice_new(EDGE, ground, &K, &M);
    lattice_new(EDGE - 1, ground, &less, &M_less);
    assert_ok(ritz_ordering_new(&K, &order));
    assert_ok(ritz_ordering_new(&less, &other));
    assert_ok(ritz_orders_new(&orders));
    {
        [[maybe_unused]] RITZ_OWN(ritz_orders_lent) lent =
            ritz_orders_lend(orders);

        for (int k = 0; k < 2; k++) {
            assert_ok(order_alike(&K, order));
            assert_int_equal(ritz_orders_count(orders), 1 + k);
            assert_ok(order_alike(&less, other));
            assert_int_equal(ritz_orders_count(orders), 2);
        }
        assert_ok(store_once(&K, order)); /* `orders` is lent again after it */
        assert_ok(ritz_ordering_new(&M, &last));
        assert_int_equal(ritz_orders_count(orders), 3);
    }
    RITZ_FREE(last);
    last = NULL;
    lattice_new(EDGE - 2, ground, &least, &M_least);
    assert_ok(ritz_ordering_new(&least, &last));
    assert_int_equal(ritz_orders_count(orders), 3);
    assert_survives_every_allocation(store_once(&K, order));
}

/* K - shift M has as many negative pivots as eigenvalues of the pencil are
   below the shift, with a given order and with one that is found. */
static void negative_pivots_count_eigenvalues_below_a_shift(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    double *lambda = lattice_eigenvalues(14, 0.0);
    int64_t *order = NULL;

    (void)state;
    lattice_new(14, 0.0, &K, &M);
    assert_ok(ritz_ordering_new(&K, &order));
    for (int64_t k = 1; k < 2000; k += 331) {
        RITZ_OWN(ritz_sparse) A = {0};
        int64_t below = 0;
        int64_t count = 0;
        const double shift = lambda[k] + 1e-7;

        while (lambda[below] < shift)
            below++;
        assert_ok(ritz_sparse_add(1.0, &K, -shift, &M, &A));
        assert_ok(ritz_inertia_negative(&A, order, &count));
        assert_int_equal(count, below);
        assert_ok(ritz_inertia_negative(&A, NULL, &count));
        assert_int_equal(count, below);
    }
    free(order);
    free(lambda);
}

static ritz_status order_and_count(const ritz_sparse *A)
{
    RITZ_OWN(ritz_factor) *F = NULL;
    int64_t negative = 0;

    RITZ_CHECK(ritz_factor_spd(A, &F));
    return ritz_inertia_negative(A, NULL, &negative);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};

    (void)state;
    lattice_new(13, ground, &K, &M);
    assert_survives_every_allocation(order_and_count(&K));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_factor_can_be_in_a_file),
    cmocka_unit_test(every_kernel_and_number_of_threads_solves),
    cmocka_unit_test(an_order_keeps_the_rows_of_a_grid_together),
    cmocka_unit_test(a_store_has_an_order_for_each_pattern),
    cmocka_unit_test(negative_pivots_count_eigenvalues_below_a_shift),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(supernodal, tests, NULL, NULL)
