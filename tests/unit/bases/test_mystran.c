/*
 * MYSTRAN's own Craig-Bampton matrices of the outboard frame, made again from
 * its KGG and MGG (third-party files, RITZ_EXTERNAL_DATA).
 */
#include "testing.h"

#include "scenes.h"
#include "solvers.h"

#include <ritz/basis.h>

#include <float.h>

/* G = |T|'|K||T|: eps of it is what rounding of K's entries does to T'KT. */
static void measure_rounding(const ritz_sparse *K, const ritz_dense *T,
                             ritz_dense *G)
{
    RITZ_OWN(ritz_sparse) size = {0};
    RITZ_OWN(ritz_dense) above = {0}, part = {0};

    assert_ok(ritz_sparse_copy(K, &size));
    assert_ok(ritz_dense_copy(T, &above));
    for (int64_t k = 0; k < size.colptr[size.ncol]; k++)
        size.val[k] = fabs(size.val[k]);
    for (int64_t k = 0; k < above.nrow * above.ncol; k++)
        above.val[k] = fabs(above.val[k]);
    assert_ok(ritz_sparse_mul(&size, &above, &part));
    assert_ok(ritz_dense_mul_tn(&above, &part, G));
}

/* Largest of a column, and the sum of its sizes. */
static double largest(const ritz_dense *A, int64_t j)
{
    double most = 0.0;

    for (int64_t i = 0; i < A->nrow; i++)
        most = fmax(most, fabs(ritz_dense_col(A, j)[i]));
    return most;
}

static double total(const ritz_dense *A, int64_t j)
{
    double sum = 0.0;

    for (int64_t i = 0; i < A->nrow; i++)
        sum += fabs(ritz_dense_col(A, j)[i]);
    return sum;
}

/* Rounding of T'KT at i, j, of both programs; an eigensolver rounds all modes
 * as the worst. */
static double rounding(const ritz_dense *G, int64_t i, int64_t j)
{
    double most = ritz_dense_col(G, j)[i];

    for (int64_t k = 24; i >= 24 && j >= 24 && k < 40; k++)
        most = fmax(most, ritz_dense_col(G, k)[k]);
    return 2.0 * DBL_EPSILON * most;
}

/*
 * How far column i of T may be off that of another program: rounding dK turns
 * either towards mode j by x_i' dK x_j / (lambda_i - lambda_j); constraint
 * modes answer at lambda = 0.
 */
static double turn_of(const ritz_reduced *ours, const ritz_dense *G, int64_t i)
{
    const double own = i < 24 ? 0.0 : ritz_dense_col(&ours->K, i)[i];
    double sum = 0.0;

    for (int64_t j = 24; j < 40; j++)
        if (j != i)
            sum += rounding(G, i, j) /
                   fabs(own - ritz_dense_col(&ours->K, j)[j]) *
                   largest(&ours->T, j);
    return sum;
}

/* 1 or -1, as columns of PHIXG and T have it; constraint modes have no sign. */
static void find_signs(const ritz_dense *A, const ritz_dense *B, double *s)
{
    for (int64_t j = 0; j < A->ncol; j++) {
        double dot = 0.0;

        for (int64_t i = 0; i < A->nrow; i++)
            dot += ritz_dense_col(A, j)[i] * ritz_dense_col(B, j)[i];
        s[j] = dot < 0.0 ? -1.0 : 1.0;
        assert_true(j >= 24 || s[j] > 0.0);
    }
}

/*
 * MYSTRAN's coordinates are the 24 of the grids in ascending order, then 16
 * modes of unit mass: ours, but for the signs of modes.
 */
static void mystran_reduces_to_the_same_matrices(void **state)
{
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_reduced) ours = {0};
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, T = {0}, G = {0}, MT = {0};
    double s[40] = {0}, off[40] = {0};

    (void)state;
    if (!solvers_import(&solvers_mystran[1], &component)) {
        skip();
        return;
    }
    assert_ok(reduce_with(&component, &ritz_method_craig_bampton, 16, &ours));
    solvers_read(SOLVERS "mystran_outboard_cb.op4:KXX", &K);
    solvers_read(SOLVERS "mystran_outboard_cb.op4:MXX", &M);
    solvers_read(SOLVERS "mystran_outboard_cb.op4:PHIXG", &T);
    assert_int_equal(ours.K.ncol, 40);
    assert_int_equal(K.ncol, 40);
    find_signs(&T, &ours.T, s);
    measure_rounding(&component.K, &ours.T, &G);
    assert_ok(ritz_sparse_mul(&component.M, &ours.T, &MT));
    for (int64_t j = 0; j < 40; j++) {
        off[j] = turn_of(&ours, &G, j);
        for (int64_t i = 0; i < T.nrow; i++)
            assert_near(ritz_dense_col(&ours.T, j)[i] * s[j],
                        ritz_dense_col(&T, j)[i], off[j]);
    }
    for (int64_t j = 0; j < 40; j++)
        for (int64_t i = 0; i < 40; i++) {
            assert_near(ritz_dense_col(&ours.K, j)[i] * s[i] * s[j],
                        ritz_dense_col(&K, j)[i], rounding(&G, i, j));
            assert_near(ritz_dense_col(&ours.M, j)[i] * s[i] * s[j],
                        ritz_dense_col(&M, j)[i],
                        off[i] * total(&MT, j) + off[j] * total(&MT, i));
        }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(mystran_reduces_to_the_same_matrices),
};

TEST_MODULE(mystran, tests, NULL, NULL)
