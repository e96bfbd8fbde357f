#include "testing.h"

#include <ritz/matrix.h>

#include <complex.h>
#include <float.h>

typedef struct pencil {
    ritz_sparse K, M;
} pencil;

/* K = [2 -1; -1 1], M = I: the patterns differ. */
static int set_up(void **state)
{
    static pencil p;
    const int64_t row[] = {0, 1, 0, 1};
    const int64_t col[] = {0, 0, 1, 1};
    const int64_t at[] = {0, 1};
    const double k[] = {2.0, -1.0, -1.0, 1.0};
    const double m[] = {1.0, 1.0};

    p = (pencil){0};
    assert_ok(ritz_sparse_from_triplets(2, 2, 4, row, col, k, &p.K));
    assert_ok(ritz_sparse_from_triplets(2, 2, 2, at, at, m, &p.M));
    *state = &p;
    return 0;
}

static int tear_down(void **state)
{
    pencil *p = *state;

    ritz_sparse_free(&p->K);
    ritz_sparse_free(&p->M);
    return 0;
}

/* Z x = b with Z = (1 + i eta) K - w^2 M, by Cramer's rule. */
static void each_shift_solves_its_own_system(void **state)
{
    const pencil *p = *state;
    const ritz_sparse *A[] = {&p->K, &p->M};
    ritz_zldl *F = NULL;

    assert_ok(ritz_zldl_new(2, A, &F));
    for (int s = 0; s < 5; s++) {
        const double _Complex c[] = {1.0 + 0.05 * (double)s *
                                               (double _Complex)_Complex_I,
                                     -0.3 * (double)s};
        const double _Complex a = 2.0 * c[0] + c[1];
        const double _Complex b = -c[0];
        const double _Complex d = c[0] + c[1];
        const double _Complex det = a * d - b * b;
        double _Complex x[] = {1.0, (double _Complex)_Complex_I, 0.0, 1.0};
        double bound = 64.0 * DBL_EPSILON / cabs(det) / cabs(det) * 9.0;

        assert_ok(ritz_zldl_factor(F, c));
        assert_ok(ritz_zldl_solve(F, false, 2, x));
        assert_near(cabs(x[0] - (d - b * (double _Complex)_Complex_I) / det),
                    0.0, bound);
        assert_near(cabs(x[1] - (a * (double _Complex)_Complex_I - b) / det),
                    0.0, bound);
        assert_near(cabs(x[2] + b / det), 0.0, bound);
        assert_near(cabs(x[3] - a / det), 0.0, bound);
    }
    ritz_zldl_free(&F);
    assert_null(F);
}

/* K + s G, G = [0 1; -1 0]: its inverse by Cramer's rule, which one triangle
 * does not give. */
static void an_unsymmetric_matrix_is_solved_whole(void **state)
{
    static const int64_t row[] = {0, 1}, col[] = {1, 0};
    static const double skew[] = {1.0, -1.0};
    const pencil *p = *state;
    const double _Complex s = 0.5 * (double _Complex)_Complex_I;
    const double _Complex c[] = {1.0, s};
    double _Complex x[] = {1.0, 0.0};
    RITZ_OWN(ritz_sparse) G = {0};
    RITZ_OWN(ritz_dense) K = {0};
    const ritz_sparse *const A[] = {&p->K, &G};
    RITZ_OWN(ritz_zldl) *F = NULL;
    double _Complex det = 0.0;

    assert_ok(ritz_sparse_from_triplets(2, 2, 2, row, col, skew, &G));
    assert_ok(ritz_sparse_dense(&p->K, &K));
    det = K.val[0] * K.val[3] - (K.val[2] + s) * (K.val[1] - s);
    assert_ok(ritz_zldl_new(2, A, &F));
    assert_ok(ritz_zldl_factor(F, c));
    assert_ok(ritz_zldl_solve(F, false, 1, x));
    assert_near(cabs(x[0] - K.val[3] / det), 0.0, 1e-15);
    assert_near(cabs(x[1] + (K.val[1] - s) / det), 0.0, 1e-15);
}

/* lambda = (3 - sqrt 5) / 2 is an eigenvalue; damped, it is none. */
static void undamped_resonance_is_refused(void **state)
{
    const pencil *p = *state;
    const ritz_sparse *A[] = {&p->K, &p->M};
    double _Complex c[] = {1.0, -(3.0 - sqrt(5.0)) / 2.0};
    double _Complex x[] = {1.0, 1.0};
    RITZ_OWN(ritz_zldl) *F = NULL;

    assert_ok(ritz_zldl_new(2, A, &F));
    assert_fails(ritz_zldl_factor(F, c), RITZ_ERR_SINGULAR,
                 "the matrix is singular");
    assert_fails(ritz_zldl_solve(F, false, 1, x), RITZ_ERR_ARGUMENT,
                 "needs a factor first");
    c[0] += 0.01 * (double _Complex)_Complex_I;
    assert_ok(ritz_zldl_factor(F, c));
    c[0] = nan("");
    assert_fails(ritz_zldl_factor(F, c), RITZ_ERR_ARGUMENT,
                 "coefficient 1 of the matrices is not finite");
}

static void matrices_of_different_size_are_refused(void **state)
{
    const pencil *p = *state;
    RITZ_OWN(ritz_sparse) B = {0};
    const ritz_sparse *A[] = {&p->K, &B};
    ritz_zldl *F = NULL;

    assert_ok(ritz_sparse_new(3, 3, 0, &B));
    assert_fails(ritz_zldl_new(2, A, &F), RITZ_ERR_ARGUMENT,
                 "3 x 3 matrix stands beside 2 rows");
    assert_fails(ritz_zldl_new(0, A, &F), RITZ_ERR_ARGUMENT, "no matrix");
}

static ritz_status factor(const ritz_sparse *const *A)
{
    const double _Complex c[] = {1.0, 0.5};
    RITZ_OWN(ritz_zldl) *F = NULL;

    RITZ_CHECK(ritz_zldl_new(2, A, &F));
    return ritz_zldl_factor(F, c);
}

static void no_allocation_failure_leaks(void **state)
{
    const pencil *p = *state;
    const ritz_sparse *A[] = {&p->K, &p->M};

    assert_survives_every_allocation(factor(A));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(each_shift_solves_its_own_system),
    cmocka_unit_test(an_unsymmetric_matrix_is_solved_whole),
    cmocka_unit_test(undamped_resonance_is_refused),
    cmocka_unit_test(matrices_of_different_size_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(zldl, tests, set_up, tear_down)
