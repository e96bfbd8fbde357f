#include "linear/eigen_sparse.h"
#include "linear/residuals.h"
#include "linear/sharpen.h"
#include "testing.h"

#include <float.h>
#include <math.h>

static const double pi = 3.14159265358979323846;

/*
 * A chain of n masses of 1 and n springs of 1, one end held, the other free:
 *
 *     lambda_j = 4 sin^2 a_j,   x_ij = 2 / sqrt(2 n + 1) sin(2 i a_j),
 *     a_j = (2 j - 1) pi / (2 (2 n + 1)),   i, j = 1 .. n
 *
 * K and M have no rounding errors. The magnitudes of the terms of x_1'K x_1 add
 * up to 4, x_1'K x_1 itself is lambda_1, about (pi / (2 n + 1))^2.
 */
enum { MASSES = 6000 };

typedef struct chain {
    ritz_sparse K, M;
} chain;

static chain new_chain(int64_t n)
{
    chain c = {0};

    assert_ok(ritz_sparse_new(n, n, 3 * n - 2, &c.K));
    assert_ok(ritz_sparse_new(n, n, n, &c.M));
    for (int64_t j = 0, p = 0; j < n; j++) {
        for (int64_t i = j > 0 ? j - 1 : 0; i <= j + 1 && i < n; i++, p++) {
            c.K.rowind[p] = i;
            c.K.val[p] = i != j ? -1.0 : j + 1 < n ? 2.0 : 1.0;
        }
        c.K.colptr[j + 1] = p;
        c.M.rowind[j] = j;
        c.M.val[j] = 1.0;
        c.M.colptr[j + 1] = j + 1;
    }
    return c;
}

static void free_chain(chain *c)
{
    ritz_sparse_free(&c->K);
    ritz_sparse_free(&c->M);
}

static double angle(int64_t n, int64_t j)
{
    return (2.0 * (double)j - 1.0) * pi / (2.0 * (2.0 * (double)n + 1.0));
}

static double exact_value(int64_t n, int64_t j)
{
    return 4.0 * pow(sin(angle(n, j)), 2.0);
}

static double exact_entry(int64_t n, int64_t i, int64_t j)
{
    return 2.0 / sqrt(2.0 * (double)n + 1.0) *
           sin(2.0 * (double)i * angle(n, j));
}

/* Columns of unit mass and eigenvalues of modes 1 .. count. */
static ritz_pairs exact_pairs(int64_t n, int64_t count)
{
    ritz_pairs P = {0};

    assert_ok(ritz_dense_new(n, count, &P.Phi));
    P.lambda = calloc((size_t)count, sizeof *P.lambda);
    P.residual = calloc((size_t)count, sizeof *P.residual);
    assert_true(P.lambda && P.residual);
    for (int64_t j = 0; j < count; j++) {
        P.lambda[j] = exact_value(n, j + 1);
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&P.Phi, j)[i] = exact_entry(n, i + 1, j + 1);
    }
    return P;
}

/* Eigenvalues within `value`, relative, vectors within `entry` of their largest
   entry. */
static void assert_exact(const ritz_pairs *P, int64_t n, double value,
                         double entry)
{
    const double largest = 2.0 / sqrt(2.0 * (double)n + 1.0);

    for (int64_t j = 0; j < P->Phi.ncol; j++) {
        const double *x = ritz_dense_col(&P->Phi, j);
        const double sign = copysign(1.0, x[n - 1] * exact_entry(n, n, j + 1));

        assert_near(P->lambda[j] / exact_value(n, j + 1), 1.0, value);
        for (int64_t i = 0; i < n; i++)
            assert_near(sign * x[i], exact_entry(n, i + 1, j + 1),
                        entry * largest);
    }
}

/* Without twice the digits lambda_1 has an error of 4e-9 (measured). Rounding of
   sums over n masses is sqrt(n) eps, 1.7e-14; of vectors 1e-13, measured. */
static void long_chains_keep_their_digits(void **state)
{
    chain c = new_chain(MASSES);
    ritz_pairs P = {0};

    (void)state;
    assert_ok(ritz_eigen_sparse(&c.K, &c.M, &(ritz_span){.modes = 6}, &P));
    assert_string_equal(P.engine, "block Lanczos");
    assert_int_equal(P.Phi.ncol, 6);
    assert_exact(&P, MASSES, 1e-13, 1e-12);
    ritz_pairs_free(&P);
    free_chain(&c);
}

/* Add 1e-9 of one vector to another, and 1e-9 of itself to each eigenvalue. */
static void blur(ritz_pairs *P)
{
    const int64_t n = P->Phi.nrow, count = P->Phi.ncol;

    for (int64_t j = 0; j < count; j++) {
        P->lambda[j] *= 1.0 + 1e-9;
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&P->Phi, j)[i] +=
                j + 1 < count ? 1e-9 * ritz_dense_col(&P->Phi, j + 1)[i] : 0.0;
    }
    for (int64_t i = 0; i < n; i++)
        ritz_dense_col(&P->Phi, count - 1)[i] -=
            1e-9 * ritz_dense_col(&P->Phi, count - 2)[i];
}

static void blurred_pairs_become_exact(void **state)
{
    enum { COUNT = 2 };
    chain c = new_chain(MASSES);
    ritz_pairs P = exact_pairs(MASSES, COUNT);
    double energy[COUNT] = {0};
    double worst = 0.0;

    (void)state;
    blur(&P);
    assert_ok(ritz_pairs_assess(&c.K, &c.M, &P, energy, &worst));
    P.num_rigid = 0;
    assert_near(energy[0], 4.0, 1e-3);
    assert_ok(ritz_pairs_sharpen(&c.K, &c.M, energy, &P));
    assert_exact(&P, MASSES, 1e-13, 1e-13);
    ritz_pairs_free(&P);
    free_chain(&c);
}

/* A short chain loses nothing, and rigid modes have no digits to lose. */
static void other_pairs_stay_as_they_are(void **state)
{
    enum { SHORT = 50 };
    chain c = new_chain(SHORT);
    ritz_pairs P = exact_pairs(SHORT, 2);
    const double few[] = {4.0, 4.0}, many[] = {1e9, 1e9};

    (void)state;
    P.lambda[0] *= 1.0 + 1e-9;
    assert_ok(ritz_pairs_sharpen(&c.K, &c.M, few, &P));
    assert_true(P.lambda[0] == exact_value(SHORT, 1) * (1.0 + 1e-9));
    P.num_rigid = 2;
    assert_ok(ritz_pairs_sharpen(&c.K, &c.M, many, &P));
    assert_true(P.lambda[0] == exact_value(SHORT, 1) * (1.0 + 1e-9));
    ritz_pairs_free(&P);
    free_chain(&c);
}

static void no_allocation_failure_leaks(void **state)
{
    enum { SHORT = 50 };
    chain c = new_chain(SHORT);
    ritz_pairs P = exact_pairs(SHORT, 3);
    const double energy[] = {1e9, 1e9, 0.0};

    (void)state;
    assert_survives_every_allocation(
        ritz_pairs_sharpen(&c.K, &c.M, energy, &P));
    ritz_pairs_free(&P);
    free_chain(&c);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(long_chains_keep_their_digits),
    cmocka_unit_test(blurred_pairs_become_exact),
    cmocka_unit_test(other_pairs_stay_as_they_are),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(sharpen, tests, NULL, NULL)
