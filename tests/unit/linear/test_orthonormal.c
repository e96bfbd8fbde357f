#include "testing.h"

#include "frame.h"
#include "linear/orthonormal.h"
#include "project.h"

#include <float.h>

enum { ELEMENTS = 3000, DOFS = 3 * ELEMENTS };

/* A cantilever as thin as 1 : 600; products by K lose eleven digits of the
 * energy of smooth shapes. */
typedef struct fixture {
    ritz_component beam;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){0};
    assert_ok(frame_component(ELEMENTS, 0.02, &frame_mcdaniel, true, false, 1,
                              &f.beam));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    ritz_component_free(&((fixture *)*state)->beam);
    return 0;
}

/* v = s^power, theta = v' of the beam, added to x. */
static void add_shape(double scale, int power, double *x)
{
    const double length = 0.02 * ELEMENTS;

    for (int64_t e = 0; e < ELEMENTS; e++) {
        double s = (double)(e + 1) / ELEMENTS;

        x[3 * e + 1] += scale * pow(s, power);
        x[3 * e + 2] += scale * power * pow(s, power - 1) / length;
    }
}

/* max |V'WV - I| of what is there */
static double error_of(const ritz_orthonormal *set, const ritz_sparse *W)
{
    ritz_dense V = ritz_dense_part(&set->V, 0, set->count);
    ritz_dense G = project(W, &V);
    double worst = 0.0;

    for (int64_t j = 0; j < G.ncol; j++)
        ritz_dense_col(&G, j)[j] -= 1.0;
    worst = ritz_dense_max(&G);
    ritz_dense_free(&G);
    return worst;
}

/* s^2, then s^2 + 1e-6 s^3: what is new is less than two passes leave of s^2,
 * yet it is as orthogonal as the first is normal. Measured: 7e-5, and 1.3e-3
 * after two passes. */
static void what_is_new_is_found_below_the_rounding_of_products(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_orthonormal) set = {0};

    assert_ok(ritz_orthonormal_new(DOFS, &f->beam.K, 1e-10, &set));
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_dense) R = {0};

        assert_ok(ritz_dense_new(DOFS, 1, &R));
        add_shape(1.0, 2, R.val);
        add_shape(k * 1e-6, 3, R.val);
        assert_ok(ritz_orthonormal_append(&set, &R, 1, NULL));
    }
    assert_int_equal(set.count, 2);
    assert_near(error_of(&set, &f->beam.K), 0.0, 4e-4);
}

/* Columns a, 0, 2 a, b, a + b: a pair of them is all. */
static void what_depends_is_left_out_and_named(void **state)
{
    static const double columns[5][3] = {
        {1, 1, 0}, {0, 0, 0}, {2, 2, 0}, {0, 1, -1}, {1, 2, -1}};
    RITZ_OWN(ritz_orthonormal) set = {0};
    RITZ_OWN(ritz_dense) R = {0};
    bool taken[5];
    int count = 0;

    (void)state;
    assert_ok(ritz_orthonormal_new(3, NULL, 1e-10, &set));
    assert_ok(ritz_dense_new(3, 5, &R));
    memcpy(R.val, columns, sizeof columns);
    assert_ok(ritz_orthonormal_append(&set, &R, 5, taken));
    assert_int_equal(set.count, 2);
    assert_int_equal(set.left, 0);
    for (int j = 0; j < 5; j++)
        count += taken[j];
    assert_int_equal(count, 2);
    assert_true(!taken[1]);
}

/* Three columns and room for two: one is left, and then none. */
static void what_is_not_wanted_is_counted(void **state)
{
    static const double columns[3][4] = {
        {1, 1, 0, 0}, {0, 1, 1, 0}, {0, 0, 1, 2}};
    RITZ_OWN(ritz_orthonormal) set = {0};
    ritz_dense R = {0};

    (void)state;
    assert_ok(ritz_orthonormal_new(4, NULL, 1e-10, &set));
    for (int k = 0; k < 2; k++) {
        assert_ok(ritz_dense_new(4, 3, &R));
        memcpy(R.val, columns, sizeof columns);
        assert_ok(ritz_orthonormal_append(&set, &R, 2, NULL));
        assert_int_equal(set.count, 2 + k);
        assert_int_equal(set.left, k == 0 ? 1 : 0);
        ritz_dense_free(&R);
    }
}

/* Nearly dependent columns, 1e-6 apart: both are kept, and orthonormal. */
static void a_weak_column_is_as_orthonormal_as_a_strong_one(void **state)
{
    RITZ_OWN(ritz_orthonormal) set = {0};
    RITZ_OWN(ritz_dense) R = {0};

    (void)state;
    assert_ok(ritz_orthonormal_new(50, NULL, 1e-10, &set));
    assert_ok(ritz_dense_new(50, 4, &R));
    for (int64_t j = 0; j < 4; j++)
        for (int64_t i = 0; i < 50; i++)
            ritz_dense_col(&R, j)[i] =
                1.0 + 1e-6 * cos((double)((i + 1) * (j + 1)));
    assert_ok(ritz_orthonormal_append(&set, &R, 4, NULL));
    assert_int_equal(set.count, 4);
    for (int64_t i = 0; i < 4; i++)
        for (int64_t j = 0; j < 4; j++) {
            double sum = 0.0;

            for (int64_t k = 0; k < 50; k++)
                sum +=
                    ritz_dense_col(&set.V, i)[k] * ritz_dense_col(&set.V, j)[k];
            assert_near(sum, i == j, 50 * DBL_EPSILON);
        }
}

static ritz_status append_two(const ritz_sparse *W)
{
    RITZ_OWN(ritz_orthonormal) set = {0};
    RITZ_OWN(ritz_dense) R = {0};

    RITZ_CHECK(ritz_orthonormal_new(DOFS, W, 1e-10, &set));
    RITZ_CHECK(ritz_dense_new(DOFS, 2, &R));
    add_shape(1.0, 2, R.val);
    add_shape(1.0, 3, ritz_dense_col(&R, 1));
    return ritz_orthonormal_append(&set, &R, 2, NULL);
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;

    assert_survives_every_allocation(append_two(&f->beam.K));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_is_new_is_found_below_the_rounding_of_products),
    cmocka_unit_test(what_depends_is_left_out_and_named),
    cmocka_unit_test(what_is_not_wanted_is_counted),
    cmocka_unit_test(a_weak_column_is_as_orthonormal_as_a_strong_one),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(orthonormal, tests, set_up, tear_down)
