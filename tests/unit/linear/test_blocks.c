#include "linear/blocks.h"

#include "base/team.h"
#include "testing.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

enum { B = RITZ_BLOCK, SQUARE = RITZ_SQUARE, N = 1000, BLOCKS = 3 };

/* Numbers between -1 and 1. */
static void fill(int64_t count, double *x)
{
    for (int64_t i = 0; i < count; i++)
        x[i] = sin((double)(i + 1));
}

typedef struct products {
    ritz_blocks on;
    double *V, *X, *Y;
    double *block[BLOCKS]; /* of V */
    double C[BLOCKS * SQUARE];
} products;

static void begin(int threads, products *p)
{
    ritz_set_threads(threads);
    p->on = (ritz_blocks){0};
    assert_ok(ritz_blocks_new(N, ritz_team_ready(threads), BLOCKS, &p->on));
    p->V = calloc((size_t)BLOCKS * N * B, sizeof *p->V);
    p->X = calloc((size_t)N * B, sizeof *p->X);
    p->Y = calloc((size_t)N * B, sizeof *p->Y);
    assert_true(p->V && p->X && p->Y);
    for (int64_t k = 0; k < BLOCKS; k++)
        p->block[k] = p->V + k * N * B;
    fill((int64_t)BLOCKS * N * B, p->V);
    fill((int64_t)N * B, p->X);
}

static void end(products *p)
{
    free(p->V);
    free(p->X);
    free(p->Y);
    ritz_blocks_free(&p->on);
    ritz_set_threads(1);
}

/* (V_p'X)_ij by a plain sum. */
static double plain_inner(const double *V, const double *X, int i, int j)
{
    double sum = 0.0;

    for (int64_t r = 0; r < N; r++)
        sum += V[r * B + i] * X[r * B + j];
    return sum;
}

static void projections_are_sums_over_all_rows(void **state)
{
    const double bound = N * N * DBL_EPSILON;

    (void)state;
    for (int threads = 1; threads <= 3; threads++) {
        products p;
        double G[SQUARE];

        begin(threads, &p);
        ritz_blocks_project(&p.on, BLOCKS, p.block, 1, p.X, p.C);
        ritz_blocks_inner(&p.on, p.V, p.X, G);
        for (int k = 0; k < BLOCKS * SQUARE; k++)
            assert_near(p.C[k],
                        plain_inner(p.V + (int64_t)(k / SQUARE) * N * B, p.X,
                                    k % SQUARE / B, k % B),
                        bound);
        for (int k = 0; k < SQUARE; k++)
            assert_near(G[k], p.C[k], bound);
        end(&p);
    }
}

/* Products of two blocks at once have the same bits as those of one block at a
   time. */
static void two_blocks_are_multiplied_as_one_by_one(void **state)
{
    enum { V_BLOCKS = BLOCKS - 1, ALL = 2 * V_BLOCKS * SQUARE };
    products p;
    ritz_blocks on = {0};
    double C[ALL];
    double *X = NULL;
    double *Y = NULL;

    (void)state;
    begin(2, &p);
    assert_ok(ritz_blocks_new(N, ritz_team_ready(2), 2 * V_BLOCKS, &on));
    X = calloc((size_t)2 * N * B, sizeof *X);
    Y = calloc((size_t)2 * N * B, sizeof *Y);
    assert_true(X && Y);
    fill((int64_t)2 * N * B, X);
    memcpy(Y, X, (size_t)2 * N * B * sizeof *X);
    ritz_blocks_project(&on, V_BLOCKS, p.block, 2, X, C);
    ritz_blocks_add(&on, V_BLOCKS, p.block, 2, C, X);
    for (int64_t q = 0; q < 2; q++) {
        ritz_blocks_project(&on, V_BLOCKS, p.block, 1, Y + q * N * B, p.C);
        assert_memory_equal(p.C, C + q * V_BLOCKS * SQUARE,
                            V_BLOCKS * SQUARE * sizeof *C);
        ritz_blocks_add(&on, V_BLOCKS, p.block, 1, p.C, Y + q * N * B);
    }
    assert_memory_equal(X, Y, (size_t)2 * N * B * sizeof *X);
    free(X);
    free(Y);
    ritz_blocks_free(&on);
    end(&p);
}

/* Row r of vector j of X + V C. */
static double plain_sum(const products *p, int64_t r, int j)
{
    double sum = p->X[r * B + j];

    for (int k = 0; k < BLOCKS; k++)
        for (int i = 0; i < B; i++)
            sum += p->V[(k * N + r) * B + i] * p->C[k * SQUARE + i * B + j];
    return sum;
}

static void blocks_are_combined_row_by_row(void **state)
{
    const double bound = 100.0 * 24.0 * DBL_EPSILON;

    (void)state;
    for (int threads = 1; threads <= 3; threads++) {
        products p;
        double *room = NULL;

        begin(threads, &p);
        fill((int64_t)BLOCKS * SQUARE, p.C);
        memcpy(p.Y, p.X, (size_t)(N * B) * sizeof *p.Y);
        ritz_blocks_add(&p.on, BLOCKS, p.block, 1, p.C, p.Y);
        for (int64_t k = 0; k < (int64_t)N * B; k++)
            assert_near(p.Y[k], plain_sum(&p, k / B, (int)(k % B)), bound);
        memset(p.X, 0, (size_t)(N * B) * sizeof *p.X);
        memset(p.Y, 0, (size_t)(N * B) * sizeof *p.Y);
        ritz_blocks_add(&p.on, BLOCKS, p.block, 1, p.C, p.Y);
        room = calloc((size_t)ritz_blocks_room(&p.on, 1), sizeof *room);
        assert_non_null(room);
        ritz_blocks_combine(&p.on, BLOCKS, 1, 0, p.C, room, p.block);
        for (int64_t k = 0; k < (int64_t)N * B; k++)
            assert_near(p.V[k], p.Y[k], bound);
        free(room);
        end(&p);
    }
}

/* X := X R^-1 with R'R = X'X has orthonormal columns. */
static void cholesky_of_the_inner_products_orthonormalises(void **state)
{
    products p;
    double G[SQUARE], R[SQUARE], U[SQUARE];

    (void)state;
    begin(2, &p);
    for (int64_t r = 0; r < N; r++)
        for (int64_t j = 0; j < B; j++)
            p.X[r * B + j] = cos((double)(r * (j + 1)));
    ritz_blocks_inner(&p.on, p.X, p.X, G);
    assert_true(ritz_square_factor(G, R, 0.0));
    ritz_square_invert(R, U);
    ritz_blocks_transform(&p.on, U, p.X);
    ritz_blocks_inner(&p.on, p.X, p.X, G);
    for (int k = 0; k < SQUARE; k++) /* condition of X is near 1 */
        assert_near(G[k], k % (B + 1) == 0 ? 1.0 : 0.0, N * DBL_EPSILON);
    ritz_square_multiply(R, U);
    for (int k = 0; k < SQUARE; k++)
        assert_near(U[k], k % (B + 1) == 0 ? 1.0 : 0.0, 64 * DBL_EPSILON);
    end(&p);
}

static void a_dependent_vector_is_refused_by_the_cholesky_factor(void **state)
{
    double G[SQUARE], R[SQUARE];

    (void)state;
    for (int k = 0; k < SQUARE; k++) /* x_0 = x_1, the others orthonormal */
        G[k] = k % (B + 1) == 0 || k == 1 || k == B ? 1.0 : 0.0;
    assert_false(ritz_square_factor(G, R, 1e-12));
}

/* Row k of R is row order[k] of A, and stored zeros are not copied. */
static void rows_of_a_matrix_follow_the_order(void **state)
{
    int64_t row[] = {0, 1, 0, 1, 2, 2};
    int64_t col[] = {0, 0, 1, 1, 2, 0};
    double val[] = {2.0, -1.0, -1.0, 3.0, 5.0, 0.0};
    const int64_t order[] = {2, 0, 1};
    const double expected[] = {10.0, 1.0, 2.0};
    RITZ_OWN(ritz_sparse) A = {0};
    ritz_row_matrix R = {0};
    ritz_blocks on = {0};
    double X[3 * B], Y[3 * B];

    (void)state;
    assert_ok(ritz_sparse_from_triplets(3, 3, 6, row, col, val, &A));
    assert_ok(ritz_row_matrix_new(&A, order, &R));
    assert_int_equal(R.start[3], 5);
    assert_ok(ritz_blocks_new(3, 1, 1, &on));
    for (int k = 0; k < 3 * B; k++)
        X[k] = k / B == 0 ? 2.0 : 1.0; /* (1, 1, 2) in the order of A */
    ritz_blocks_multiply(&on, &R, X, Y);
    for (int k = 0; k < 3 * B; k++)
        assert_near(Y[k], expected[k / B], 0.0);
    /* |x|'|A||x| = 2 + 1 + 1 + 3 + 5 2^2 */
    assert_near(ritz_row_matrix_terms(&R, X, 3), 27.0, 0.0);
    ritz_row_matrix_free(&R);
    ritz_blocks_free(&on);
}

static ritz_status copy_and_restore(const ritz_sparse *A, const int64_t *order,
                                    ritz_sparse *out)
{
    RITZ_OWN(ritz_row_matrix) R = {0};

    RITZ_CHECK(ritz_row_matrix_new(A, order, &R));
    return ritz_row_matrix_restore(&R, order, out);
}

static ritz_status copy_and_restore_once(const ritz_sparse *A,
                                         const int64_t *order)
{
    RITZ_OWN(ritz_sparse) back = {0};

    return copy_and_restore(A, order, &back);
}

/* Rows of A have different lengths, and one is empty. */
static void a_matrix_is_restored_from_its_rows(void **state)
{
    int64_t row[] = {0, 1, 3, 0, 1, 4, 0, 3, 1, 4};
    int64_t col[] = {0, 0, 0, 1, 1, 1, 3, 3, 4, 4};
    double val[] = {2.0, -1.0, 0.1, -1.0, 3.0, 0.3, 0.1, 5.0, 0.3, 7.0};
    const int64_t order[] = {4, 2, 0, 3, 1};
    RITZ_OWN(ritz_sparse) A = {0}, back = {0};

    (void)state;
    assert_ok(ritz_sparse_from_triplets(5, 5, 10, row, col, val, &A));
    assert_ok(copy_and_restore(&A, order, &back));
    assert_memory_equal(back.colptr, A.colptr, 6 * sizeof *A.colptr);
    assert_memory_equal(back.rowind, A.rowind, 10 * sizeof *A.rowind);
    assert_memory_equal(back.val, A.val, 10 * sizeof *A.val);
    assert_survives_every_allocation(copy_and_restore_once(&A, order));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(projections_are_sums_over_all_rows),
    cmocka_unit_test(two_blocks_are_multiplied_as_one_by_one),
    cmocka_unit_test(blocks_are_combined_row_by_row),
    cmocka_unit_test(cholesky_of_the_inner_products_orthonormalises),
    cmocka_unit_test(a_dependent_vector_is_refused_by_the_cholesky_factor),
    cmocka_unit_test(rows_of_a_matrix_follow_the_order),
    cmocka_unit_test(a_matrix_is_restored_from_its_rows),
};

TEST_MODULE(blocks, tests, NULL, NULL)
