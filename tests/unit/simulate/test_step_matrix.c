/* Matrices of a step as blocks of modes and a low rank. */
#include "testing.h"

#include "linear/general.h"
#include "simulate/step_matrix.h"

#include <math.h>

enum { MODES = 30, STATES = 2 * MODES + 1 };

/* Modes of 1 to 20 Hz with 1 % of damping, and a lag that measures the sum of
   positions and acts on all: one signal each way. */
typedef struct rig {
    ritz_dense A, Q, D;
    double lambda[MODES];
    ritz_step_matrix_modes modes;
} rig;

static void rig_free(rig *r)
{
    ritz_dense_free(&r->A);
    ritz_dense_free(&r->Q);
    ritz_dense_free(&r->D);
}

static void set(ritz_dense *A, int64_t i, int64_t j, double value)
{
    ritz_dense_col(A, j)[i] = value;
}

/* D_ij += d, and so in A and in the power that D dissipates. */
static void add_damping(int64_t n, int64_t i, int64_t j, double d, rig *r)
{
    ritz_dense_col(&r->D, j)[i] += d;
    ritz_dense_col(&r->A, n + j)[n + i] -= d;
    ritz_dense_col(&r->Q, n + j)[n + i] += d;
}

static ritz_status make_rig(int64_t n, double gain, rig *r)
{
    RITZ_CHECK(ritz_dense_new(2 * n + 1, 2 * n + 1, &r->A));
    RITZ_CHECK(ritz_dense_new(2 * n + 1, 2 * n + 1, &r->Q));
    RITZ_CHECK(ritz_dense_new(n, n, &r->D));
    for (int64_t k = 0; k < n; k++) {
        const double w = 6.3 * (1.0 + 19.0 * (double)k / (double)n);

        r->lambda[k] = w * w;
        set(&r->A, k, n + k, 1.0);
        set(&r->A, n + k, k, -w * w);
        set(&r->A, 2 * n, k, 1.0);
        set(&r->A, n + k, 2 * n, -gain);
        add_damping(n, k, k, 0.02 * w, r);
    }
    set(&r->A, 2 * n, 2 * n, -30.0);
    r->modes = (ritz_step_matrix_modes){n, r->lambda, &r->D, 2 * n + 1};
    return RITZ_OK;
}

/* Largest difference between products with E, relative to their largest entry,
   and between values of W, relative to that of the dense form. */
static void assert_same_as_dense(const rig *r, double h,
                                 const ritz_step_matrix *E,
                                 const ritz_step_matrix *W, double bound)
{
    RITZ_OWN(ritz_dense) X = {0}, form = {0};
    double z[STATES], y[STATES], due[STATES], size = 0.0, off = 0.0, value = 0;
    const int64_t n = r->A.nrow;
    uint64_t seed = 5;

    assert_ok(ritz_exponential(&r->A, h, 1, &r->Q, &X, &form));
    for (int64_t k = 0; k < n; k++)
        z[k] = ritz_general_noise(&seed) / (k < n / 2 ? sqrt(r->lambda[k]) : 1);
    ritz_step_matrix_apply(E, z, y);
    for (int64_t i = 0; i < n; i++) {
        due[i] = 0.0;
        for (int64_t j = 0; j < n; j++) {
            due[i] += ritz_dense_col(&X, j)[i] * z[j];
            value += z[i] * ritz_dense_col(&form, j)[i] * z[j];
        }
        size = fmax(size, fabs(due[i]));
        off = fmax(off, fabs(due[i] - y[i]));
    }
    assert_true(off <= bound * size);
    assert_near(ritz_step_matrix_value(W, z), value, bound * fabs(value));
}

/* |A| h is 0.13 at 1 ms and 13 at 0.1 s: the exponential errs by some eps of
   that, and sums of 61 terms by 61 eps. Ranks are measured: they grow with the
   periods in a step. */
static void few_signals_are_a_low_rank(void **state)
{
    static const int64_t most[3][2] = {{6, 9}, {14, 14}, {24, 32}};
    RITZ_OWN(rig) r = {0};

    (void)state;
    assert_ok(make_rig(MODES, 5.0, &r));
    for (int k = 0; k < 3; k++) {
        const double h = (double[]){1e-3, 1e-2, 1e-1}[k];
        RITZ_OWN(ritz_step_matrix) E = {0}, W = {0};

        assert_ok(ritz_step_matrices(&r.modes, &r.A, h, 1, &r.Q, &E, &W));
        assert_same_as_dense(&r, h, &E, &W, 1e-13);
        assert_in_range(E.rank, 3, most[k][0]);
        assert_in_range(W.rank, 2, most[k][1]);
        assert_true(k == 2 ||
                    ritz_step_matrix_cost(&E) + ritz_step_matrix_cost(&W) <
                        STATES * STATES * 2 / 3);
    }
}

/* A rank of 0: modes alone. */
static void without_a_loop_there_are_blocks_alone(void **state)
{
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_step_matrix) E = {0}, W = {0};

    (void)state;
    assert_ok(make_rig(MODES, 0.0, &r));
    for (int64_t k = 0; k < MODES; k++)
        set(&r.A, 2 * MODES, k, 0.0);
    assert_ok(ritz_step_matrices(&r.modes, &r.A, 1e-2, 1, &r.Q, &E, &W));
    assert_same_as_dense(&r, 1e-2, &E, &W, 1e-13);
    assert_int_equal(W.rank, 0);
    assert_int_equal(E.rank, 1); /* the lag */
}

/* Damping between all modes has no low rank: one product, and half of one. */
static void full_damping_is_kept_as_it_is(void **state)
{
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_step_matrix) E = {0}, W = {0};
    uint64_t seed = 7;

    (void)state;
    assert_ok(make_rig(MODES, 5.0, &r));
    for (int64_t j = 0; j < MODES; j++)
        for (int64_t i = 0; i < j; i++) {
            const double d = 0.1 * ritz_general_noise(&seed);

            add_damping(MODES, i, j, d, &r);
            add_damping(MODES, j, i, d, &r);
        }
    assert_ok(ritz_step_matrices(&r.modes, &r.A, 1e-2, 1, &r.Q, &E, &W));
    assert_same_as_dense(&r, 1e-2, &E, &W, 1e-13);
    assert_true(E.rank == -1 && W.rank == -1);
    assert_int_equal(ritz_step_matrix_cost(&E), STATES * STATES);
    assert_int_equal(ritz_step_matrix_cost(&W), STATES * (STATES + 1) / 2);
}

/* Two dampers, each on all modes, beside the damping of each mode: D less its
   diagonal has full rank, D less the damping of modes has rank 2. */
static void few_dampers_are_a_low_rank(void **state)
{
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_step_matrix) E = {0}, W = {0};

    (void)state;
    assert_ok(make_rig(MODES, 0.0, &r));
    for (int64_t j = 0; j < MODES; j++)
        for (int64_t i = 0; i < MODES; i++)
            add_damping(MODES, i, j,
                        0.05 + 0.05 * cos((double)i) * cos((double)j), &r);
    assert_ok(ritz_step_matrices(&r.modes, &r.A, 1e-2, 1, &r.Q, &E, &W));
    assert_same_as_dense(&r, 1e-2, &E, &W, 1e-13);
    assert_in_range(E.rank, 4, 16); /* measured: 13, and 18 */
    assert_in_range(W.rank, 4, 22);
}

/* A step of 300 periods: W is that of the whole decay, of any rank. */
static void long_steps_are_exact_too(void **state)
{
    RITZ_OWN(rig) r = {0};
    RITZ_OWN(ritz_step_matrix) E = {0}, W = {0};

    (void)state;
    assert_ok(make_rig(MODES, 5.0, &r));
    assert_ok(ritz_step_matrices(&r.modes, &r.A, 15.0, 1, &r.Q, &E, &W));
    assert_same_as_dense(&r, 15.0, &E, &W, 1e-11);
}

static ritz_status step_once(const rig *r)
{
    RITZ_OWN(ritz_step_matrix) E = {0}, W = {0};

    return ritz_step_matrices(&r->modes, &r->A, 1e-2, 1, &r->Q, &E, &W);
}

static void no_allocation_failure_leaks(void **state)
{
    RITZ_OWN(rig) r = {0};

    (void)state;
    assert_ok(make_rig(3, 5.0, &r));
    assert_survives_every_allocation(step_once(&r));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(few_signals_are_a_low_rank),
    cmocka_unit_test(without_a_loop_there_are_blocks_alone),
    cmocka_unit_test(few_dampers_are_a_low_rank),
    cmocka_unit_test(full_damping_is_kept_as_it_is),
    cmocka_unit_test(long_steps_are_exact_too),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(step_matrix, tests, NULL, NULL)
