#include "fixtures/lattice.h"
#include "linear/block_lanczos.h"
#include "testing.h"

#include <float.h>
#include <stdlib.h>

/* Residual |(lambda - sigma) A^-1 M x - x| / |x| of pair j. */
static double residual_of(const ritz_shifted *S, ritz_dense *Phi, int64_t j,
                          double lambda)
{
    const ritz_dense X = {S->M->nrow, 1, ritz_dense_col(Phi, j)};
    RITZ_OWN(ritz_dense) Y = {0};
    double gap = 0.0;
    double size = 0.0;

    assert_ok(ritz_sparse_mul(S->M, &X, &Y));
    assert_ok(ritz_factor_solve(S->A, &Y));
    for (int64_t i = 0; i < X.nrow; i++) {
        gap = hypot(gap, (lambda - S->sigma) * Y.val[i] - X.val[i]);
        size = hypot(size, X.val[i]);
    }
    return gap / size;
}

/*
 * The k lowest eigenpairs of a cubic lattice, whose eigenvalues are simple,
 * threefold or sixfold. The error of an eigenvalue is the square of the
 * residual, which is negligible, and the rounding of A: some eps of its largest
 * eigenvalue, 12. The residual is smaller than RITZ_LANCZOS_SETTLED, because
 * the vectors have gone through one more inverse iteration.
 */
static void check_cube(int64_t edge, double sigma, ritz_lanczos_plan plan)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, A = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0}, MX = {0}, G = {0};
    double *exact = lattice_eigenvalues(edge, 0.0);
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;
    ritz_shifted S = {&K, &M, sigma, NULL, 0};

    lattice_new(edge, 0.0, &K, &M);
    assert_ok(ritz_sparse_add(1.0, &K, -sigma, &M, &A));
    assert_ok(ritz_factor_spd(&A, &F));
    S.A = F;
    assert_ok(ritz_block_lanczos(&S, &plan, &X, &lambda, &end));
    assert_int_equal(end, RITZ_LANCZOS_FOUND);
    assert_true(X.ncol >= plan.k);
    for (int64_t j = 0; j < X.ncol; j++) {
        assert_near(lambda[j], exact[j], 12.0 * 64.0 * DBL_EPSILON);
        assert_near(residual_of(&S, &X, j, lambda[j]), 0.0, 1e-10);
    }
    assert_true(plan.next > lambda[X.ncol - 1] - 1e-12);
    assert_ok(ritz_sparse_mul(&M, &X, &MX));
    assert_ok(ritz_dense_mul_tn(&X, &MX, &G));
    for (int64_t i = 0; i < X.ncol * X.ncol; i++)
        assert_near(G.val[i], i % (X.ncol + 1) == 0 ? 1.0 : 0.0, 1e-12);
    free(lambda);
    free(exact);
}

static void multiple_eigenvalues_are_all_found(void **state)
{
    (void)state;
    for (int64_t width = 1; width <= 2; width++) {
        check_cube(13, 0.0, (ritz_lanczos_plan){.k = 40, .width = width});
        check_cube(13, -0.1, (ritz_lanczos_plan){.k = 3, .width = width});
        ritz_set_threads(2);
        check_cube(16, 0.0, (ritz_lanczos_plan){.k = 25, .width = width});
        ritz_set_threads(1);
    }
}

/* From 100 modes on a step has sixteen vectors. */
static void many_modes_are_found_sixteen_at_a_time(void **state)
{
    (void)state;
    check_cube(13, 0.0, (ritz_lanczos_plan){.k = 100});
}

/* Largest entry of |G - diag(d)|; d NULL: of |G - I|. */
static double distance_from_diagonal(const ritz_dense *G, const double *d)
{
    double worst = 0.0;

    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t i = 0; i < G->nrow; i++) {
            const double own = d ? d[j] : 1.0;

            worst = fmax(worst,
                         fabs(G->val[i + j * G->nrow] - (i == j ? own : 0.0)));
        }
    return worst;
}

/*
 * Vectors that have converged to 1e-3 only: as they come from Rayleigh-Ritz,
 * they are orthonormal in M, and X'K X is diagonal up to rounding, eps times the
 * largest eigenvalue, 12, times the norm of K^-1. Exact eigenvalues lie between
 * the lower bounds and the Ritz values; their number below the widest gap is
 * known from the closed form.
 */
static void rough_pairs_are_bounded(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0}, Y = {0}, G = {0};
    ritz_lanczos_plan plan = {.k = 40, .settled = 1e-3};
    double *exact = lattice_eigenvalues(13, 0.0);
    double lower[40];
    double rough = 0.0;
    int64_t count = 30;
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    (void)state;
    lattice_new(13, 0.0, &K, &M);
    assert_ok(ritz_factor_spd(&K, &F));
    assert_ok(ritz_block_lanczos(&(ritz_shifted){&K, &M, 0.0, F, 0}, &plan, &X,
                                 &lambda, &end));
    assert_int_equal(end, RITZ_LANCZOS_FOUND);
    assert_int_equal(plan.moments.first.ncol, X.ncol);
    assert_ok(ritz_sparse_mul(&M, &X, &Y));
    assert_ok(ritz_dense_mul_tn(&X, &Y, &G));
    assert_near(distance_from_diagonal(&G, NULL), 0.0, 1e-12);
    ritz_dense_free(&Y);
    ritz_dense_free(&G);
    assert_ok(ritz_sparse_mul(&K, &X, &Y));
    assert_ok(ritz_dense_mul_tn(&X, &Y, &G));
    assert_near(distance_from_diagonal(&G, lambda), 0.0, 1e-12);
    for (int64_t k = 31; k < 40; k++)
        if (exact[k] - exact[k - 1] > exact[count] - exact[count - 1])
            count = k;
    assert_ok(ritz_moments_enclose(&plan.moments, 0.0,
                                   0.5 * (exact[count - 1] + exact[count]),
                                   count, lower));
    for (int64_t j = 0; j < count; j++) {
        assert_true(lower[j] <= exact[j] + 1e-12);
        assert_true(exact[j] <= lambda[j] + 1e-12);
        assert_true(lambda[j] - lower[j] < 1e-4 * exact[j]);
        rough = fmax(rough, lambda[j] - exact[j]);
    }
    assert_true(rough > 1e-13); /* or nothing was bounded */
    ritz_moments_free(&plan.moments);
    free(lambda);
    free(exact);
}

/* Room for 112 vectors, where 212 would do without a restart. */
static void restarts_lose_nothing(void **state)
{
    (void)state;
    for (int64_t width = 1; width <= 2; width++) {
        check_cube(12, 0.0,
                   (ritz_lanczos_plan){.k = 40, .room = 112, .width = width});
        check_cube(12, -0.01,
                   (ritz_lanczos_plan){.k = 20, .room = 80, .width = width});
    }
}

/* Search for k modes of a lattice in which only `heavy` points have mass: it
   has `heavy` finite eigenvalues. */
static ritz_status search_few_masses(int64_t heavy, ritz_lanczos_plan plan,
                                     ritz_dense *X, double **lambda,
                                     ritz_lanczos_end *end)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    ritz_shifted S = {&K, &M, 0.0, NULL, 0};

    lattice_new(9, 0.1, &K, &M);
    for (int64_t i = heavy; i < M.nrow; i++)
        M.val[i] = 0.0;
    RITZ_CHECK(ritz_factor_spd(&K, &F));
    S.A = F;
    return ritz_block_lanczos(&S, &plan, X, lambda, end);
}

static void a_search_ends_when_all_finite_modes_are_found(void **state)
{
    const int64_t heavy[] = {3, 5, 8, 12, 16, 21};

    (void)state;
    for (size_t i = 0; i < 12; i++) {
        const int64_t masses = heavy[i % 6];
        const int64_t width = 1 + (int64_t)i / 6;
        RITZ_OWN(ritz_dense) X = {0}, none = {0};
        double *lambda = NULL;
        double *nothing = NULL;
        ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

        assert_ok(search_few_masses(
            masses, (ritz_lanczos_plan){.k = masses / 2, .width = width}, &X,
            &lambda, &end));
        assert_int_equal(end, RITZ_LANCZOS_FOUND);
        assert_true(X.ncol >= masses / 2 && X.ncol <= masses);
        assert_ok(search_few_masses(
            masses, (ritz_lanczos_plan){.k = masses + 1, .width = width}, &none,
            &nothing, &end));
        assert_int_equal(end, RITZ_LANCZOS_EXHAUSTED);
        assert_null(nothing);
        free(lambda);
    }
}

/* Three eigenvalues, each twenty-fold. The Krylov space of a block of eight
   holds eight vectors of each; the others are found from the random vectors
   that then continue the iteration. */
static void random_vectors_find_eigenvalues_of_high_multiplicity(void **state)
{
    enum { COPIES = 20, DOFS = 3 * COPIES };
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    int64_t row[DOFS];
    double val[DOFS];
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    (void)state;
    for (int64_t i = 0; i < DOFS; i++) {
        row[i] = i;
        val[i] = 1.0;
    }
    assert_ok(ritz_sparse_from_triplets(DOFS, DOFS, DOFS, row, row, val, &M));
    for (int64_t i = 0; i < DOFS; i++)
        val[i] = 1.0 + (double)(i % 3);
    assert_ok(ritz_sparse_from_triplets(DOFS, DOFS, DOFS, row, row, val, &K));
    assert_ok(ritz_factor_spd(&K, &F));
    for (int64_t width = 1; width <= 2; width++) {
        RITZ_OWN(ritz_dense) X = {0};
        double *lambda = NULL;

        assert_ok(ritz_block_lanczos(
            &(ritz_shifted){&K, &M, 0.0, F, 0},
            &(ritz_lanczos_plan){.k = 50, .width = width}, &X, &lambda, &end));
        assert_int_equal(end, RITZ_LANCZOS_FOUND);
        assert_true(X.ncol >= 50);
        for (int64_t j = 0; j < X.ncol; j++) {
            const int64_t kind = j / COPIES;

            assert_near(lambda[j], 1.0 + (double)kind, 1e-13);
        }
        free(lambda);
    }
}

static ritz_status find_few(const ritz_shifted *S)
{
    RITZ_OWN(ritz_dense) X = {0};
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;
    ritz_status status = ritz_block_lanczos(
        S, &(ritz_lanczos_plan){.k = 3, .room = 64, .width = 2}, &X, &lambda,
        &end);

    free(lambda);
    return status;
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_factor) *F = NULL;

    (void)state;
    lattice_new(9, 0.1, &K, &M);
    assert_ok(ritz_factor_spd(&K, &F));
    assert_survives_every_allocation(
        find_few(&(ritz_shifted){&K, &M, 0.0, F, 0}));
}

static ritz_status find_folded(const ritz_sparse *K, const ritz_sparse *M,
                               ritz_factor *F, ritz_dense *X)
{
    RITZ_OWN(ritz_sparse) own_K = {0}, own_M = {0};
    ritz_lanczos_plan plan = {.k = 5, .fold = {&own_K, &own_M}};
    ritz_lanczos_end end = RITZ_LANCZOS_FOUND;
    RITZ_OWN_ARRAY double *lambda = NULL;

    RITZ_CHECK(ritz_sparse_copy(K, &own_K));
    RITZ_CHECK(ritz_sparse_copy(M, &own_M));
    RITZ_CHECK(ritz_block_lanczos(&(ritz_shifted){&own_K, &own_M, 0.0, F, 0},
                                  &plan, X, &lambda, &end));
    assert_memory_equal(own_K.val, K->val,
                        (size_t)K->colptr[K->ncol] * sizeof *K->val);
    assert_memory_equal(own_M.rowind, M->rowind,
                        (size_t)M->colptr[M->ncol] * sizeof *M->rowind);
    return RITZ_OK;
}

static ritz_status find_folded_once(const ritz_sparse *K, const ritz_sparse *M,
                                    ritz_factor *F)
{
    RITZ_OWN(ritz_dense) X = {0};

    return find_folded(K, M, F, &X);
}

/* Folding K and M changes neither them nor a bit of the vectors. Without stored
   zeros M is made of its rows again, with them it is folded. */
static void folded_matrices_change_nothing(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, with_zeros = {0};
    RITZ_OWN(ritz_factor) *F = NULL;
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    ritz_lanczos_plan plan = {.k = 5};
    ritz_lanczos_end end = RITZ_LANCZOS_FOUND;

    (void)state;
    lattice_new(9, 0.1, &K, &M);
    assert_ok(ritz_factor_spd(&K, &F));
    assert_ok(ritz_block_lanczos(&(ritz_shifted){&K, &M, 0.0, F, 0}, &plan, &X,
                                 &lambda, &end));
    assert_ok(find_folded(&K, &M, F, &Y));
    assert_int_equal(X.ncol, Y.ncol);
    assert_memory_equal(X.val, Y.val,
                        (size_t)(X.nrow * X.ncol) * sizeof *X.val);
    ritz_dense_free(&Y);
    assert_ok(ritz_sparse_add(1.0, &M, 0.0, &K, &with_zeros));
    assert_true(with_zeros.colptr[K.ncol] > M.colptr[K.ncol]);
    assert_ok(find_folded(&K, &with_zeros, F, &Y));
    assert_memory_equal(X.val, Y.val,
                        (size_t)(X.nrow * X.ncol) * sizeof *X.val);
    assert_survives_every_allocation(find_folded_once(&K, &M, F));
    assert_survives_every_allocation(find_folded_once(&K, &with_zeros, F));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(multiple_eigenvalues_are_all_found),
    cmocka_unit_test(many_modes_are_found_sixteen_at_a_time),
    cmocka_unit_test(rough_pairs_are_bounded),
    cmocka_unit_test(restarts_lose_nothing),
    cmocka_unit_test(a_search_ends_when_all_finite_modes_are_found),
    cmocka_unit_test(random_vectors_find_eigenvalues_of_high_multiplicity),
    cmocka_unit_test(no_allocation_failure_leaks),
    cmocka_unit_test(folded_matrices_change_nothing),
};

TEST_MODULE(block_lanczos, tests, NULL, NULL)
