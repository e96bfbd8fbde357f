/* The limit of memory, and what is refused because of it. */
#include "testing.h"

#include "lattice.h"

#include "base/memory.h"
#include "linear/inertia.h"

#include <ritz/matrix.h>

#include <stdint.h>
#include <string.h>

static const int64_t mebibyte = INT64_C(1) << 20;

static int no_limit(void **state)
{
    (void)state;
    ritz_set_memory(0);
    return 0;
}

static void the_usual_limit_is_part_of_the_machine(void **state)
{
    const int64_t usual = ritz_memory_limit();

    (void)state;
    assert_true(usual > 64 * mebibyte); /* this test would not run with less */
    ritz_set_memory(3 * mebibyte);
    assert_int_equal(ritz_memory_limit(), 3 * mebibyte);
    ritz_set_memory(0);
    assert_int_equal(ritz_memory_limit(), usual);
}

/* What is in use counts: a process holds more than 1 MiB. */
static void the_number_needed_is_named(void **state)
{
    (void)state;
    assert_ok(ritz_memory_admit("the factor", mebibyte));
    assert_fails(ritz_memory_admit("the factor", INT64_MAX / 2),
                 RITZ_ERR_MEMORY,
                 "the factor needs 4294967296.0 GiB of memory");
    ritz_set_memory(mebibyte);
    assert_fails(ritz_memory_admit("the basis", mebibyte / 2), RITZ_ERR_MEMORY,
                 "the basis needs 0.5 MiB of memory beside");
    assert_non_null(strstr(ritz_error_message(), "1 MiB are allowed"));
    assert_ok(ritz_memory_admit("the basis", mebibyte / 64 - 1));
}

/* A factor of 12^3 rows has more than 100 000 entries. */
static void a_factor_that_does_not_fit_is_refused(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_ldl) *F = NULL;

    (void)state;
    lattice_new(12, 1.0, &K, &M);
    ritz_set_memory(mebibyte);
    assert_fails(ritz_factor_spd(&K, &L), RITZ_ERR_MEMORY, "the factor needs ");
    assert_null(L);
    assert_fails(ritz_ldl_new(&K, NULL, &F), RITZ_ERR_MEMORY,
                 "the factor needs ");
    assert_null(F);
}

/* A count holds only a part of its factor in memory; that part is compared with
   the limit. */
static void a_count_that_does_not_fit_is_refused(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    ritz_counter *counter = NULL;
    int64_t below = -1;

    (void)state;
    lattice_new(12, 1.0, &K, &M);
    assert_ok(ritz_counter_new(&K, &M, NULL, &counter));
    ritz_set_memory(mebibyte);
    assert_fails(ritz_counter_below(counter, 3.0, &below), RITZ_ERR_MEMORY,
                 "the factor of a count needs ");
    assert_int_equal(below, -1);
    ritz_set_memory(0);
    assert_ok(ritz_counter_below(counter, 3.0, &below));
    ritz_counter_free(&counter);
}

/* Raise the limit; count the calls. */
static ritz_status raise_limit(void *of)
{
    ++*(int *)of;
    ritz_set_memory(0);
    return RITZ_OK;
}

static ritz_status fail_to_relieve(void *of)
{
    (void)of;
    return ritz_fail(RITZ_ERR_FILE, "no disk");
}

/* The relief is called only where a count does not fit, and counts are the same
   after it. */
static void a_count_that_does_not_fit_calls_for_relief(void **state)
{
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    ritz_counter *counter = NULL;
    int64_t below[2] = {-1, -2};
    int calls = 0;

    (void)state;
    lattice_new(12, 1.0, &K, &M);
    assert_ok(ritz_counter_new(&K, &M, NULL, &counter));
    ritz_counter_relieve(counter, (ritz_relief){raise_limit, &calls});
    assert_ok(ritz_counter_below(counter, 3.0, &below[0]));
    assert_int_equal(calls, 0);
    ritz_set_memory(mebibyte);
    assert_ok(ritz_counter_below(counter, 3.0, &below[1]));
    assert_int_equal(calls, 1);
    assert_int_equal(below[0], below[1]);
    ritz_counter_relieve(counter, (ritz_relief){fail_to_relieve, NULL});
    ritz_set_memory(mebibyte);
    assert_fails(ritz_counter_below(counter, 3.0, &below[1]), RITZ_ERR_FILE,
                 "no disk");
    ritz_counter_free(&counter);
}

/* The limit decides what is refused, and nothing else. */
static void what_fits_has_the_same_bits(void **state)
{
    const ritz_span span = {.modes = 6};
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) free = {0}, limited = {0}, none = {0};

    (void)state;
    lattice_new(10, 1.0, &K, &M);
    assert_ok(ritz_eigen_sparse(&K, &M, &span, &free));
    ritz_set_memory(1024 * mebibyte);
    assert_ok(ritz_eigen_sparse(&K, &M, &span, &limited));
    assert_memory_equal(free.Phi.val, limited.Phi.val,
                        (size_t)(free.Phi.nrow * free.Phi.ncol) *
                            sizeof *free.Phi.val);
    ritz_set_memory(mebibyte);
    assert_fails(ritz_eigen_sparse(&K, &M, &span, &none), RITZ_ERR_MEMORY,
                 "are allowed (--memory)");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test_teardown(the_usual_limit_is_part_of_the_machine, no_limit),
    cmocka_unit_test_teardown(the_number_needed_is_named, no_limit),
    cmocka_unit_test_teardown(a_factor_that_does_not_fit_is_refused, no_limit),
    cmocka_unit_test_teardown(a_count_that_does_not_fit_is_refused, no_limit),
    cmocka_unit_test_teardown(a_count_that_does_not_fit_calls_for_relief,
                              no_limit),
    cmocka_unit_test_teardown(what_fits_has_the_same_bits, no_limit),
};

TEST_MODULE(memory, tests, NULL, NULL)
