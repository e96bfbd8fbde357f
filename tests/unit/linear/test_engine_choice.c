#include "linear/engine_choice.h"

#include "testing.h"

#include <math.h>
#include <string.h>

/* A solid of 54,852 dofs. */
static const ritz_search_size solid = {
    .n = 54852, .k = 500, .entries = 2.75e7, .operations = 2.38e10};

static bool all_fits(int64_t bytes)
{
    return bytes >= 0;
}

static bool a_gigabyte_fits(int64_t bytes)
{
    return bytes <= 1000000000;
}

static bool nothing_fits(int64_t bytes)
{
    return bytes < 0;
}

static ritz_eigen_engine choose(const ritz_search_size *size,
                                bool (*fits)(int64_t), const char **reason)
{
    return ritz_engine_choose(size, fits, reason);
}

static void the_fastest_engine_is_chosen(void **state)
{
    const ritz_eigen_engine engines[] = {RITZ_EIGEN_LANCZOS, RITZ_EIGEN_SLICES,
                                         RITZ_EIGEN_AMLS};
    const double accuracies[] = {0.0, 1e-4};

    (void)state;
    for (int64_t k = 20; k < 4000; k *= 2)
        for (int a = 0; a < 2; a++) {
            ritz_search_size size = solid;
            const char *reason = NULL;
            ritz_eigen_engine best = RITZ_EIGEN_AUTO;

            size.k = k;
            size.accuracy = accuracies[a];
            best = choose(&size, all_fits, &reason);
            assert_string_equal(reason, "the fastest by prediction");
            for (int e = 0; e < 3; e++)
                assert_true(ritz_engine_cost_of(best, &size).operations <=
                            ritz_engine_cost_of(engines[e], &size).operations);
        }
}

static void slices_are_chosen_where_a_basis_does_not_fit(void **state)
{
    ritz_search_size size = solid;
    const char *reason = NULL;

    (void)state;
    size.accuracy = 1e-4; /* block Lanczos would be faster, and needs 1.0 GB */
    assert_int_equal(choose(&size, all_fits, &reason), RITZ_EIGEN_LANCZOS);
    assert_int_equal(choose(&size, a_gigabyte_fits, &reason),
                     RITZ_EIGEN_SLICES);
    assert_string_equal(reason, "the fastest that fits into memory");
    assert_int_equal(choose(&size, nothing_fits, &reason), RITZ_EIGEN_SLICES);
    assert_string_equal(reason, "it needs the least memory");
}

static void
few_modes_need_no_slices_and_no_accuracy_no_substructures(void **state)
{
    ritz_search_size size = solid;

    (void)state;
    size.k = 200;
    assert_true(
        isinf(ritz_engine_cost_of(RITZ_EIGEN_SLICES, &size).operations));
    assert_true(isinf(ritz_engine_cost_of(RITZ_EIGEN_AMLS, &size).operations));
    size.accuracy = 1e-4;
    assert_true(
        isfinite(ritz_engine_cost_of(RITZ_EIGEN_AMLS, &size).operations));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_fastest_engine_is_chosen),
    cmocka_unit_test(slices_are_chosen_where_a_basis_does_not_fit),
    cmocka_unit_test(few_modes_need_no_slices_and_no_accuracy_no_substructures),
};

TEST_MODULE(engine_choice, tests, NULL, NULL)
