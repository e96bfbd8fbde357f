#include "fixtures/lattice.h"
#include "linear/slices.h"
#include "testing.h"

#include <float.h>
#include <stdlib.h>

/* Largest entry of |X'M X - I|, M = I. */
static double orthogonality_of(const ritz_dense *X)
{
    RITZ_OWN(ritz_dense) G = {0};
    double worst = 0.0;

    assert_ok(ritz_dense_mul_tn(X, X, &G));
    for (int64_t i = 0; i < X->ncol * X->ncol; i++)
        worst =
            fmax(worst, fabs(G.val[i] - (i % (X->ncol + 1) == 0 ? 1.0 : 0.0)));
    return worst;
}

/* Largest |K x - lambda x| of all pairs. */
static double residual_of(const ritz_sparse *K, const ritz_dense *X,
                          const double *lambda)
{
    RITZ_OWN(ritz_dense) Y = {0};
    double worst = 0.0;

    assert_ok(ritz_sparse_mul(K, X, &Y));
    for (int64_t j = 0; j < X->ncol; j++) {
        double gap = 0.0;

        for (int64_t i = 0; i < X->nrow; i++)
            gap = hypot(gap, Y.val[i + j * X->nrow] -
                                 lambda[j] * X->val[i + j * X->nrow]);
        worst = fmax(worst, gap);
    }
    return worst;
}

/*
 * The k lowest eigenpairs of a cube of edge^3 points; many eigenvalues near
 * borders are threefold or sixfold. Eigenvalues err by the square of the
 * residual and by rounding, some eps times the largest eigenvalue, 12. Vectors
 * are orthogonal to the rounding of a sum over all rows.
 */
static void check_cube(int64_t edge, double sigma, int64_t k, int64_t side)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0};
    ritz_slicing slicing = {.side = side};
    ritz_shifted S = {.K = &K, .M = &M, .sigma = sigma};
    double *exact = lattice_eigenvalues(edge, 0.0);
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    lattice_new(edge, 0.0, &K, &M);
    assert_ok(ritz_sparse_add(1.0, &K, -sigma, &M, &A));
    assert_ok(ritz_factor_spd(&A, &F));
    RITZ_MOVE(S.A, F);
    assert_ok(ritz_slices_lowest(&S, k, &slicing, &X, &lambda, &end));
    assert_int_equal(end, RITZ_LANCZOS_FOUND);
    assert_null(S.A);
    assert_true(X.ncol >= k);
    assert_true(slicing.slices >= k / (4 * side) && slicing.slices > 1);
    assert_true(slicing.proven > k / 2 && slicing.proven <= X.ncol);
    for (int64_t j = 0; j < X.ncol; j++)
        assert_near(lambda[j], exact[j], 12.0 * 64.0 * DBL_EPSILON);
    assert_near(residual_of(&K, &X, lambda), 0.0, 1e-9);
    assert_near(orthogonality_of(&X), 0.0, (double)X.nrow * 4.0 * DBL_EPSILON);
    free(lambda);
    free(exact);
}

static void slices_find_all_multiple_eigenvalues(void **state)
{
    (void)state;
    check_cube(11, 0.0, 120, 20);
    check_cube(11, -0.05, 100, 9);
    ritz_set_threads(2);
    check_cube(13, 0.0, 150, 30);
    ritz_set_threads(1);
}

/* A cube with masses on the first `heavy` points only: it has `heavy` finite
   eigenvalues. */
static void make_light(int64_t heavy, ritz_sparse *K, ritz_sparse *M)
{
    lattice_new(7, 0.1, K, M);
    for (int64_t i = heavy; i < M->nrow; i++)
        M->val[i] = 0.0;
}

static ritz_status find_some(const ritz_sparse *K, const ritz_sparse *M,
                             int64_t k, int64_t *found, ritz_lanczos_end *end)
{
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    ritz_slicing slicing = {.side = 4};
    ritz_shifted S = {.K = K, .M = M};

    RITZ_CHECK(ritz_factor_spd(K, &F));
    RITZ_MOVE(S.A, F);
    RITZ_CHECK(ritz_slices_lowest(&S, k, &slicing, &X, &lambda, end));
    *found = X.ncol;
    return RITZ_OK;
}

/* Of 30 masses 20 modes are found; 31 modes do not exist. */
static void few_masses_exhaust_the_slices(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;
    int64_t found = 0;

    (void)state;
    make_light(30, &K, &M);
    assert_ok(find_some(&K, &M, 20, &found, &end));
    assert_int_equal(end, RITZ_LANCZOS_FOUND);
    assert_true(found >= 20 && found <= 30);
    assert_ok(find_some(&K, &M, 31, &found, &end));
    assert_int_equal(end, RITZ_LANCZOS_EXHAUSTED);
    assert_int_equal(found, 0);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;
    int64_t found = 0;

    (void)state;
    make_light(40, &K, &M);
    assert_survives_allocations(3, find_some(&K, &M, 16, &found, &end));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(slices_find_all_multiple_eigenvalues),
    cmocka_unit_test(few_masses_exhaust_the_slices),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(slices, tests, NULL, NULL)
