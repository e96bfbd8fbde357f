#include "fixtures/lattice.h"
#include "fixtures/pencils.h"
#include "linear/amls.h"
#include "linear/density.h"
#include "linear/enclosure.h"
#include "linear/ordering.h"
#include "testing.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

enum { PENCILS = 90 };

/* --- the tree ------------------------------------------------------------- */

static bool is_below(const ritz_dissection *D, int64_t s, int64_t root)
{
    return D->begin[root] <= s && s <= root;
}

static void substructures_touch_only_their_ancestors(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dissection) D = {0};
    int64_t *node = NULL;

    (void)state;
    lattice_new(9, 0.0, &K, &M);
    assert_ok(ritz_dissection_new(&K, 40, &D));
    assert_true(D.nodes > 20);
    assert_int_equal(D.first[D.nodes], K.nrow);
    node = calloc((size_t)K.nrow, sizeof *node);
    assert_non_null(node);
    for (int64_t s = 0; s < D.nodes; s++) {
        assert_true(D.parent[s] == -1 || D.parent[s] > s);
        assert_true(D.begin[s] <= s);
        for (int64_t p = D.first[s]; p < D.first[s + 1]; p++)
            node[D.row[p]] = s + 1;
    }
    for (int64_t j = 0; j < K.ncol; j++) {
        assert_true(node[j] > 0);
        for (int64_t p = K.colptr[j]; p < K.colptr[j + 1]; p++) {
            const int64_t a = node[K.rowind[p]] - 1;
            const int64_t b = node[j] - 1;

            assert_true(is_below(&D, a, b) || is_below(&D, b, a));
        }
    }
    free(node);
}

/* --- modes ---------------------------------------------------------------- */

static ritz_status find_lowest(const ritz_shifted *S, int64_t k, double cutoff,
                               ritz_dense *X, double **lambda,
                               ritz_lanczos_end *end)
{
    ritz_substructuring how = {.leaf = 30, .cutoff = cutoff};

    return ritz_amls_lowest(S, k, &how, X, lambda, end);
}

/* Largest entry of |X'X - I|, M = I. */
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

/*
 * The k lowest eigenpairs of a cube, many of them multiple. Ritz values are
 * upper bounds. With all modes of substructures they are exact: theta errs by
 * n eps theta_1, and lambda by lambda^2 times that, here less than 1e-11.
 * `error` is measured for the others.
 */
static void check_cube(double sigma, double cutoff, double error)
{
    const int64_t k = 60;
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0};
    double *exact = lattice_eigenvalues(9, 0.0);
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    lattice_new(9, 0.0, &K, &M);
    assert_ok(find_lowest(&(ritz_shifted){.K = &K, .M = &M, .sigma = sigma}, k,
                          cutoff, &X, &lambda, &end));
    assert_int_equal(end, RITZ_LANCZOS_FOUND);
    assert_int_equal(X.ncol, k);
    for (int64_t j = 0; j < k; j++) {
        assert_true(lambda[j] >= exact[j] * (1.0 - 1e-11));
        assert_true(lambda[j] <= exact[j] * (1.0 + error));
    }
    assert_near(orthogonality_of(&X), 0.0, 1e-10);
    free(lambda);
    free(exact);
}

static void all_modes_of_substructures_give_exact_modes(void **state)
{
    (void)state;
    check_cube(0.0, HUGE_VAL, 1e-11);
    check_cube(-0.5, HUGE_VAL, 1e-11);
    ritz_set_threads(2);
    check_cube(0.0, HUGE_VAL, 1e-11);
    ritz_set_threads(1);
}

/* Eigenvalues of this cube reach 12, and the 60th is 1.8. */
static void fewer_modes_of_substructures_give_upper_bounds(void **state)
{
    (void)state;
    check_cube(0.0, 8.0, 0.05);
    check_cube(-0.5, 8.0, 0.05);
}

static void two_runs_have_the_same_bits(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense_pair) X = {0};
    double *lambda[2] = {NULL, NULL};
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    (void)state;
    ritz_set_threads(2);
    lattice_new(11, 0.0, &K, &M);
    for (int r = 0; r < 2; r++)
        assert_ok(find_lowest(&(ritz_shifted){.K = &K, .M = &M}, 20, 6.0, &X[r],
                              &lambda[r], &end));
    ritz_set_threads(1);
    assert_memory_equal(lambda[0], lambda[1], 20 * sizeof(double));
    assert_memory_equal(X[0].val, X[1].val,
                        (size_t)(X[0].nrow * 20) * sizeof(double));
    free(lambda[0]);
    free(lambda[1]);
}

/* A diagonal matrix is substructures without an interface. */
static void uncoupled_masses_are_their_own_modes(void **state)
{
    RITZ_OWN(ritz_sparse) K_0 = {0}, K_1 = {0}, K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0};
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    (void)state;
    lattice_new(8, 0.0, &K_0, &K);
    lattice_new(8, 0.0, &K_1, &M);
    for (int64_t i = 0; i < K.nrow; i++)
        K.val[i] = (double)(K.nrow - i);
    assert_ok(find_lowest(&(ritz_shifted){.K = &K, .M = &M}, 40, 100.0, &X,
                          &lambda, &end));
    assert_int_equal(end, RITZ_LANCZOS_FOUND);
    for (int64_t j = 0; j < 40; j++)
        assert_near(lambda[j], (double)(j + 1),
                    64.0 * DBL_EPSILON * (double)(j + 1));
    free(lambda);
}

/* K with zeros stored above the diagonal, between points that are far apart. */
static void store_zeros(ritz_sparse *K)
{
    const int64_t n = K->nrow;
    RITZ_OWN(ritz_sparse) E = {0}, wide = {0};

    assert_ok(ritz_sparse_new(n, n, n, &E));
    for (int64_t j = 0; j < n; j++) {
        E.rowind[j] = j / 2;
        E.val[j] = 1.0;
        E.colptr[j + 1] = j + 1;
    }
    assert_ok(ritz_sparse_add(1.0, K, 0.0, &E, &wide));
    ritz_sparse_free(K);
    *K = wide;
    wide = (ritz_sparse){0};
}

/* Error of theta: n eps theta_1, as with all modes of substructures. */
static void zeros_in_one_triangle_couple_nothing(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0};
    double *exact = lattice_eigenvalues(9, 0.0);
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    (void)state;
    lattice_new(9, 0.0, &K, &M);
    store_zeros(&K);
    assert_ok(find_lowest(&(ritz_shifted){.K = &K, .M = &M}, 20, HUGE_VAL, &X,
                          &lambda, &end));
    assert_int_equal(end, RITZ_LANCZOS_FOUND);
    for (int64_t j = 0; j < 20; j++)
        assert_near(lambda[j], exact[j], 1e-11 * exact[j]);
    free(lambda);
    free(exact);
}

/* A cube with masses on the first `heavy` points only: it has `heavy` finite
   eigenvalues. */
static void make_light(int64_t heavy, ritz_sparse *K, ritz_sparse *M)
{
    lattice_new(7, 0.1, K, M);
    for (int64_t i = heavy; i < M->nrow; i++)
        M->val[i] = 0.0;
}

static void few_masses_exhaust_the_substructures(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0};
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    (void)state;
    make_light(30, &K, &M);
    assert_ok(find_lowest(&(ritz_shifted){.K = &K, .M = &M}, 31, HUGE_VAL, &X,
                          &lambda, &end));
    assert_int_equal(end, RITZ_LANCZOS_EXHAUSTED);
    assert_null(lambda);
    assert_int_equal(X.ncol, 0);
    assert_ok(find_lowest(&(ritz_shifted){.K = &K, .M = &M}, 30, HUGE_VAL, &X,
                          &lambda, &end));
    assert_int_equal(end, RITZ_LANCZOS_FOUND);
    free(lambda);
}

static void indefinite_stiffness_is_refused(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0};
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    (void)state;
    lattice_new(7, 0.0, &K, &M);
    assert_fails(find_lowest(&(ritz_shifted){.K = &K, .M = &M, .sigma = 3.0}, 5,
                             12.0, &X, &lambda, &end),
                 RITZ_ERR_SINGULAR, "substructure is not positive definite");
    assert_null(lambda);
}

/* A cube of 1331 points: its fronts need more than 1 MiB. */
static void fronts_that_do_not_fit_are_refused_before(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_dense) X = {0};
    ritz_substructuring how = {.leaf = 30, .cutoff = 6.0};
    double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    (void)state;
    lattice_new(11, 0.0, &K, &M);
    ritz_set_memory(1024 * 1024);
    assert_fails(ritz_amls_lowest(&(ritz_shifted){.K = &K, .M = &M}, 20, &how,
                                  &X, &lambda, &end),
                 RITZ_ERR_MEMORY, "elimination of substructures needs ");
    ritz_set_memory(0);
    assert_int_equal(how.nodes, 0); /* nothing was eliminated */
}

/* --- bounds --------------------------------------------------------------- */

static ritz_status prepare_shift(const pencil *p, ritz_shifted *S)
{
    RITZ_OWN(ritz_sparse) A = {0};

    *S = (ritz_shifted){&p->K, &p->M, p->sigma, NULL, 0};
    RITZ_CHECK(ritz_sparse_add(1.0, &p->K, -p->sigma, &p->M, &A));
    return ritz_factor_spd(&A, &S->A);
}

/* The number of pairs whose bounds were compared. `exact` has eigenvalues by
   LAPACK. Both bounds hold for theta up to rounding, 1e-9 of the largest. */
static int64_t check_bounds(const ritz_shifted *S, const ritz_pairs *exact,
                            ritz_dense *X)
{
    const int64_t k = X->ncol;
    RITZ_OWN(ritz_moments) of = {0};
    double lambda[16];
    double lower[16];
    int64_t count = k < exact->Phi.ncol ? k : k - 1;
    const double rounding = 1e-9 / (exact->lambda[0] - S->sigma);

    assert_ok(ritz_vectors_polish(S, X, lambda, NULL));
    assert_ok(ritz_vectors_polish(S, X, lambda, &of));
    while (count > 0 && exact->lambda[count] - exact->lambda[count - 1] <
                            1e-3 * (exact->lambda[count] - S->sigma))
        count--;
    if (count == 0)
        return 0;
    assert_ok(ritz_moments_enclose(
        &of, S->sigma, 0.5 * (exact->lambda[count - 1] + exact->lambda[count]),
        count, lower));
    for (int64_t j = 0; j < count; j++) {
        const double theta = 1.0 / (exact->lambda[j] - S->sigma);

        assert_true(1.0 / (lambda[j] - S->sigma) <= theta + rounding);
        if (lower[j] > S->sigma)
            assert_true(1.0 / (lower[j] - S->sigma) >= theta - rounding);
    }
    return count;
}

static void eigenvalues_lie_within_their_bounds(void **state)
{
    int64_t compared = 0;

    (void)state;
    for (uint64_t seed = 0; seed < PENCILS; seed++) {
        pencil p;
        ritz_shifted S;
        ritz_substructuring how = {.leaf = 10};
        RITZ_OWN(ritz_pairs) exact = {0};
        RITZ_OWN(ritz_dense) X = {0};
        double *lambda = NULL;
        ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

        pencil_new(seed, 90, &p);
        assert_ok(prepare_shift(&p, &S));
        assert_ok(ritz_eigen_dense(&(ritz_dense){p.n, p.n, p.K_d},
                                   &(ritz_dense){p.n, p.n, p.M_d}, &exact));
        if (exact.Phi.ncol > 16) {
            how.cutoff = 2.0 * exact.lambda[16] - p.sigma;
            assert_ok(ritz_amls_lowest(&S, 12, &how, &X, &lambda, &end));
            if (end == RITZ_LANCZOS_FOUND)
                compared += check_bounds(&S, &exact, &X);
        }
        free(lambda);
        ritz_factor_free(&S.A);
        pencil_free(&p);
    }
    assert_true(compared > 2 * PENCILS);
}

/* --- estimates ------------------------------------------------------------ */

/* The standard deviation of the number is sqrt(2 / (8 k)) of it, 5 % here, and
   points of the quadrature lie at ratios of some 1.3. */
static void the_number_of_eigenvalues_is_estimated(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    double *exact = lattice_eigenvalues(11, 0.0);
    ritz_shifted S = {.K = &K, .M = &M};
    double reach = 0.0;

    (void)state;
    lattice_new(11, 0.0, &K, &M);
    assert_ok(ritz_factor_spd(&K, &S.A));
    for (int64_t k = 100; k <= 400; k += 100) {
        assert_ok(ritz_density_reach(&S, k, &reach));
        assert_true(reach > 0.75 * exact[k - 1] && reach < 1.33 * exact[k - 1]);
    }
    assert_ok(ritz_density_reach(&S, 2 * K.nrow, &reach));
    assert_true(isinf(reach));
    ritz_factor_free(&S.A);
    free(exact);
}

/* --- the search ----------------------------------------------------------- */

/* The error that the search states, from its name of the engine. */
static double stated_error(const ritz_pairs *P)
{
    const char *at = strstr(P->engine, "within ");

    assert_non_null(at);
    return strtod(at + strlen("within "), NULL);
}

static void check_search(const ritz_span *span)
{
    int64_t count = span->modes;
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) P = {0};
    double *exact = lattice_eigenvalues(12, 0.0);

    if (span->modes < 0)
        for (count = 0; exact[count] <= ritz_eigen_lambda(span->up_to_hz);)
            count++;
    lattice_new(12, 0.0, &K, &M);
    assert_ok(ritz_eigen_sparse(&K, &M, span, &P));
    assert_non_null(strstr(P.engine, span->engine == RITZ_EIGEN_AMLS
                                         ? "substructures"
                                         : "block Lanczos"));
    assert_true((strstr(P.engine, "if none is missed") != NULL) ==
                span->uncounted);
    assert_true(P.Phi.ncol >= count && P.Phi.ncol < count + 6);
    assert_non_null(P.error);
    assert_true(stated_error(&P) <=
                (span->accuracy > 0.0 ? span->accuracy : 1e-4));
    for (int64_t j = 0; j < P.Phi.ncol; j++) {
        assert_true(P.lambda[j] >= exact[j] * (1.0 - 1e-11));
        assert_true(P.lambda[j] - exact[j] <= P.error[j] * P.lambda[j] + 1e-11);
        assert_true(P.error[j] <= stated_error(&P));
    }
    free(exact);
}

static void a_search_states_how_large_errors_are(void **state)
{
    static const ritz_span way[] = {
        {.modes = 40, .engine = RITZ_EIGEN_AMLS},
        {.modes = 40, .engine = RITZ_EIGEN_AMLS, .uncounted = true},
        {.modes = -1, .up_to_hz = 0.12, .engine = RITZ_EIGEN_AMLS},
        {.modes = 40, .engine = RITZ_EIGEN_AMLS, .accuracy = 1e-6},
        {.modes = 40, .accuracy = 1e-4},
        {.modes = 110, .engine = RITZ_EIGEN_LANCZOS, .accuracy = 1e-4},
        {.modes = 40, .accuracy = 1e-7, .uncounted = true},
        {.modes = -1, .up_to_hz = 0.12, .accuracy = 1e-4},
    };

    (void)state;
    for (size_t k = 0; k < sizeof way / sizeof *way; k++)
        check_search(&way[k]);
}

/* Modes up to a frequency that is above mode `last` of the cube by 1e-8 of it,
   which is far less than the error of its value. The cube has a gap above that
   mode. */
static void check_limit(ritz_span span, int64_t last)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) P = {0};
    double *exact = lattice_eigenvalues(12, 0.0);

    while (exact[last + 1] - exact[last] < 1e-3 * exact[last])
        last++;
    span.modes = -1;
    span.up_to_hz = ritz_eigen_hertz(exact[last]) * (1.0 + 1e-8);
    lattice_new(12, 0.0, &K, &M);
    assert_ok(ritz_eigen_sparse(&K, &M, &span, &P));
    assert_non_null(strstr(P.engine, "within"));
    assert_int_equal(P.Phi.ncol, last + 1);
    for (int64_t j = 0; j <= last; j++)
        assert_true(P.lambda[j] >= exact[j] * (1.0 - 1e-11));
    free(exact);
}

/* An approximate value of such a mode is above the frequency. */
static void a_mode_just_below_the_frequency_is_found(void **state)
{
    static const ritz_span way[] = {
        {.engine = RITZ_EIGEN_AMLS},
        {.engine = RITZ_EIGEN_AMLS, .accuracy = 1e-2},
        {.engine = RITZ_EIGEN_AMLS, .uncounted = true},
        {.engine = RITZ_EIGEN_LANCZOS, .accuracy = 1e-2},
        {.engine = RITZ_EIGEN_LANCZOS, .accuracy = 1e-2, .uncounted = true},
    };

    (void)state;
    for (size_t k = 0; k < sizeof way / sizeof *way; k++) {
        check_limit(way[k], 17);
        check_limit(way[k], 28);
    }
}

static void check_refused(const ritz_span *span, const char *sentence)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) P = {0};

    lattice_new(3, 0.0, &K, &M);
    assert_fails(ritz_eigen_sparse(&K, &M, span, &P), RITZ_ERR_ARGUMENT,
                 sentence);
}

static void engines_without_an_accuracy_refuse_one(void **state)
{
    (void)state;
    check_refused(
        &(ritz_span){.modes = 4, .engine = RITZ_EIGEN_SLICES, .accuracy = 1e-4},
        "modes by spectrum slices have no accuracy to choose");
    check_refused(
        &(ritz_span){.modes = 4, .engine = RITZ_EIGEN_ARPACK, .accuracy = 1e-4},
        "modes by ARPACK have no accuracy to choose");
    check_refused(&(ritz_span){.modes = 4, .accuracy = 1e-12},
                  "an accuracy of 1e-12 is not between 1e-8 and 1e-2");
    check_refused(&(ritz_span){.modes = 4, .accuracy = 0.5},
                  "an accuracy of 0.5 is not between 1e-8 and 1e-2");
}

/* With so many modes the reduced matrix would be as large as the model. */
static void slices_take_over_where_most_modes_are_requested(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) P = {0};
    const ritz_span span = {.modes = 150, .engine = RITZ_EIGEN_AMLS};

    (void)state;
    lattice_new(11, 0.0, &K, &M);
    assert_ok(ritz_eigen_sparse(&K, &M, &span, &P));
    assert_string_equal(P.engine, "spectrum slices");
}

static ritz_status find_some(const ritz_sparse *K, const ritz_sparse *M)
{
    RITZ_OWN(ritz_dense) X = {0};
    RITZ_OWN_ARRAY double *lambda = NULL;
    ritz_lanczos_end end = RITZ_LANCZOS_SLOW;

    return find_lowest(&(ritz_shifted){.K = K, .M = M}, 10, 6.0, &X, &lambda,
                       &end);
}

static ritz_status find_bounded(const ritz_sparse *K, const ritz_sparse *M,
                                const ritz_span *span)
{
    RITZ_OWN(ritz_pairs) P = {0};

    return ritz_eigen_sparse(K, M, span, &P);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0}, K_9 = {0}, M_9 = {0};

    (void)state;
    lattice_new(6, 0.1, &K, &M);
    assert_survives_allocations(5, find_some(&K, &M));
    lattice_new(9, 0.0, &K_9, &M_9);
    assert_survives_allocations(
        23, find_bounded(&K_9, &M_9,
                         &(ritz_span){.modes = 6, .engine = RITZ_EIGEN_AMLS}));
    assert_survives_allocations(
        7,
        find_bounded(&K_9, &M_9, &(ritz_span){.modes = 6, .accuracy = 1e-4}));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(substructures_touch_only_their_ancestors),
    cmocka_unit_test(all_modes_of_substructures_give_exact_modes),
    cmocka_unit_test(fewer_modes_of_substructures_give_upper_bounds),
    cmocka_unit_test(two_runs_have_the_same_bits),
    cmocka_unit_test(uncoupled_masses_are_their_own_modes),
    cmocka_unit_test(zeros_in_one_triangle_couple_nothing),
    cmocka_unit_test(few_masses_exhaust_the_substructures),
    cmocka_unit_test(indefinite_stiffness_is_refused),
    cmocka_unit_test(fronts_that_do_not_fit_are_refused_before),
    cmocka_unit_test(eigenvalues_lie_within_their_bounds),
    cmocka_unit_test(the_number_of_eigenvalues_is_estimated),
    cmocka_unit_test(a_search_states_how_large_errors_are),
    cmocka_unit_test(a_mode_just_below_the_frequency_is_found),
    cmocka_unit_test(engines_without_an_accuracy_refuse_one),
    cmocka_unit_test(slices_take_over_where_most_modes_are_requested),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(amls, tests, NULL, NULL)
