#include "linear/engine_choice.h"

#include "testing.h"

#include <math.h>

/* A solid of 54,852 dofs. */
static const ritz_search_size solid = {
    .n = 54852, .k = 500, .entries = 2.75e7, .operations = 2.38e10};

static void the_fastest_engine_is_chosen(void **state)
{
    const ritz_eigen_engine engines[] = {RITZ_EIGEN_LANCZOS, RITZ_EIGEN_SLICES,
                                         RITZ_EIGEN_AMLS};
    const double accuracies[] = {0.0, 1e-4};

    (void)state;
    for (int64_t k = 20; k < 4000; k *= 2)
        for (int a = 0; a < 2; a++) {
            ritz_search_size size = solid;
            ritz_eigen_engine best = RITZ_EIGEN_AUTO;

            size.k = k;
            size.accuracy = accuracies[a];
            best = ritz_engine_choose(&size);
            for (int e = 0; e < 3; e++)
                assert_true(ritz_engine_cost(best, &size) <=
                            ritz_engine_cost(engines[e], &size));
        }
}

/* Figures of docs/methods/eigen.md: block Lanczos takes 20.2 s and 500 modes,
   slices 21.1 s; on a solid of 10,944 dofs 800 modes 7.6 s and 4.5 s. */
static void measured_models_have_the_faster_engine(void **state)
{
    const ritz_search_size small = {
        .n = 10896, .k = 800, .entries = 2.8e6, .operations = 9.3e8};

    (void)state;
    assert_int_equal(ritz_engine_choose(&solid), RITZ_EIGEN_LANCZOS);
    assert_int_equal(ritz_engine_choose(&small), RITZ_EIGEN_SLICES);
}

static void
few_modes_need_no_slices_and_no_accuracy_no_substructures(void **state)
{
    ritz_search_size size = solid;

    (void)state;
    size.k = 200;
    assert_true(isinf(ritz_engine_cost(RITZ_EIGEN_SLICES, &size)));
    assert_true(isinf(ritz_engine_cost(RITZ_EIGEN_AMLS, &size)));
    size.accuracy = 1e-4;
    assert_true(isfinite(ritz_engine_cost(RITZ_EIGEN_AMLS, &size)));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_fastest_engine_is_chosen),
    cmocka_unit_test(measured_models_have_the_faster_engine),
    cmocka_unit_test(few_modes_need_no_slices_and_no_accuracy_no_substructures),
};

TEST_MODULE(engine_choice, tests, NULL, NULL)
