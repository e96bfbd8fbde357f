/*
 * Resolvents: many points in one call agree with single ones, for dense and
 * diagonal matrices; maxima of many brackets are found together.
 */
#include "testing.h"

#include "base/complex.h"
#include "linear/resolvent.h"
#include "linear/search.h"

#include <complex.h>
#include <float.h>
#include <stdlib.h>

enum { INPUTS = 3, OUTPUTS = 2, POINTS = 170 };

static double at_random(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 40) / 0x1p24 - 0.5;
}

/* Entries up to 1; resolvent_of subtracts n on the diagonal of A, which moves
   poles away from 0. */
static void fill(int64_t n, int64_t m, bool diagonal, ritz_dense *A)
{
    uint64_t seed = 7;

    assert_ok(ritz_dense_new(n, m, A));
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < n; i++)
            if (!diagonal || i == j)
                ritz_dense_col(A, j)[i] = at_random(&seed);
}

/* @param[in] kind  0: full, 1: a pencil, 2: diagonal, 3: a diagonal pencil */
static void resolvent_of(int64_t n, int kind, ritz_resolvent *out)
{
    RITZ_OWN(ritz_dense) A = {0}, P = {0}, B = {0}, C = {0};

    fill(n, n, kind > 1, &A);
    fill(n, INPUTS, false, &B);
    fill(OUTPUTS, n, false, &C);
    if (kind % 2 == 1)
        fill(n, n, kind > 1, &P);
    for (int64_t i = 0; i < n; i++) {
        ritz_dense_col(&A, i)[i] -= (double)n;
        if (P.val)
            ritz_dense_col(&P, i)[i] += 0.1 * (double)n;
    }
    assert_ok(ritz_resolvent_new(&A, &P, &B, &C, out));
}

static void many_points_agree_with_single_ones(void **)
{
    static const int64_t order[] = {1, 47, 48, 49, 130};
    double _Complex z[POINTS], H[POINTS * INPUTS * OUTPUTS];

    for (int k = 0; k < POINTS; k++)
        z[k] = ritz_complex(0.1, 0.3 * k);
    for (int k = 0; k < 20; k++) {
        RITZ_OWN(ritz_resolvent) r = {0};

        resolvent_of(order[k % 5], k / 5, &r);
        for (int i = 0; i < POINTS * INPUTS * OUTPUTS; i++)
            H[i] = i; /* the call adds to H */
        assert_ok(ritz_resolvent_many(&r, POINTS, z, H));
        for (int i = 0; i < POINTS; i++) {
            double _Complex one[INPUTS * OUTPUTS] = {0};

            assert_true(ritz_resolvent_add(&r, z[i], 0.0, one));
            for (int v = 0; v < INPUTS * OUTPUTS; v++) {
                int at = i * INPUTS * OUTPUTS + v;

                /* sums of 130 terms below 1 / 10, added to numbers up to
                   1020 */
                assert_near(cabs(H[at] - at - one[v]), 0.0,
                            (130 + 1020) * DBL_EPSILON);
            }
        }
    }
}

static ritz_status many_points(int kind)
{
    const double _Complex z[] = {1.0, 2.0};
    double _Complex H[2 * INPUTS * OUTPUTS] = {0};
    const ritz_dense A = {2, 2, (double[]){-1, 0, 1, -2}};
    const ritz_dense P = {2, 2, (double[]){1, 0, 0, 2}};
    const ritz_dense B = {2, INPUTS, (double[]){1, 0, 2, 1, 3, 0}};
    const ritz_dense C = {OUTPUTS, 2, (double[]){1, 0, 0, 1}};
    RITZ_OWN(ritz_resolvent) r = {0};

    RITZ_CHECK(
        ritz_resolvent_new(&A, kind ? &P : &(ritz_dense){0}, &B, &C, &r));
    return ritz_resolvent_many(&r, 2, z, H);
}

/* A curve with peaks at 1, 2, 3, ..., which counts its calls. */
typedef struct hills {
    int calls;
} hills;

static ritz_status hill_at(void *state, double w, double *value)
{
    (void)state;
    *value = -fabs(w - round(w));
    return RITZ_OK;
}

static ritz_status hills_at(void *state, int64_t count, const double *w,
                            double *value)
{
    hills *h = state;

    h->calls++;
    for (int64_t k = 0; k < count; k++)
        value[k] = -fabs(w[k] - round(w[k]));
    return RITZ_OK;
}

static void many_brackets_close_as_single_ones_do(void **)
{
    hills h = {0};
    const ritz_curve one = {hill_at, &h};
    const ritz_curves all = {hills_at, &h};
    ritz_bracket bracket[5];

    for (int k = 0; k < 5; k++)
        bracket[k] = (ritz_bracket){.low = k + 0.7, .high = k + 1.1 + 0.05 * k};
    assert_ok(ritz_curves_between(&all, 1e-9, 5, bracket));
    for (int k = 0; k < 5; k++) {
        double low = k + 0.7, high = k + 1.1 + 0.05 * k, most = 0.0;

        assert_ok(ritz_curve_between(&one, 1e-9, &low, &high, &most));
        assert_true(bracket[k].low == low && bracket[k].high == high);
        assert_near(0.5 * (low + high), k + 1, 2e-9 * (k + 1));
    }
    /* golden sections: 0.618^44 is 6e-10 */
    assert_true(h.calls <= 46);
    assert_ok(ritz_curves_between(&all, 1e-9, 0, bracket));
}

static void every_allocation_may_fail(void **)
{
    assert_survives_every_allocation(many_points(0));
    assert_survives_every_allocation(many_points(1));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(many_points_agree_with_single_ones),
    cmocka_unit_test(many_brackets_close_as_single_ones_do),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(resolvent, tests, NULL, NULL)
