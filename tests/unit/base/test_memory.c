/* The limit of memory, and what is refused because of it. */
#include "testing.h"

#include "lattice.h"

#include "base/alloc.h"
#include "base/memory.h"
#include "linear/inertia.h"

#include <ritz/matrix.h>

#include <stdint.h>
#include <stdlib.h>
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

/* What a refusal names as needed in all is enough. */
static void the_number_named_is_enough(void **state)
{
    const int64_t bytes = 64 * mebibyte;
    const char *all = NULL;
    int64_t named = 0;

    (void)state;
    ritz_set_memory(mebibyte);
    assert_fails(ritz_memory_admit("the basis", bytes), RITZ_ERR_MEMORY,
                 "the basis needs 64 MiB of memory beside ");
    all = strstr(ritz_error_message(), " in use, ");
    assert_non_null(all);
    named = strtoll(all + strlen(" in use, "), NULL, 10);
    assert_true(named >= 64);
    ritz_set_memory(named * mebibyte);
    assert_ok(ritz_memory_admit("the basis", bytes));
}

/* Large arrays are compared with the limit where they are allocated, small ones
   and those that were admitted before are not. */
static void a_large_array_that_does_not_fit_is_refused(void **state)
{
    char *array = NULL;

    (void)state;
    ritz_set_memory(mebibyte);
    ritz_monitor_step("the test", 0, 0);
    assert_null(ritz_zalloc(8 * mebibyte, 1));
    assert_non_null(strstr(ritz_error_message(),
                           "an array (last step: the test) needs 8 MiB"));
    assert_null(ritz_alloc(mebibyte, sizeof(double)));
    array = ritz_alloc(mebibyte / 2, 1);
    assert_non_null(array);
    assert_fails(ritz_array_lengthen(&array, 4 * mebibyte, 1), RITZ_ERR_MEMORY,
                 "are allowed (--memory)");
    free(array);
    array = ritz_alloc_admitted(8 * mebibyte, 1);
    assert_non_null(array);
    free(array);
}

/* What an array takes is in use before it is written. */
static void an_array_counts_before_it_is_written(void **state)
{
    const int64_t before = ritz_memory_left();
    char *array = NULL;

    (void)state;
#ifdef RITZ_SANITIZE /* has a malloc() of its own, which counts nothing */
    assert_true(before > 0);
#else
    array = ritz_zalloc(512 * mebibyte, 1);
    assert_non_null(array);
    assert_true(before - ritz_memory_left() > 500 * mebibyte);
#endif
    free(array);
}

/* A factor is refused, too, if what follows it would be. */
static void what_is_foreseen_is_needed(void **state)
{
    const ritz_foresight later = {.beside = 40 * mebibyte,
                                  .after = 50 * mebibyte};
    ritz_foresight before = {0};

    (void)state;
    ritz_set_memory(mebibyte);
    assert_fails(ritz_memory_admit_factor(30 * mebibyte, 20 * mebibyte),
                 RITZ_ERR_MEMORY, "the factor needs 30 MiB");
    before = ritz_memory_foresee(later);
    assert_int_equal(before.beside, 0);
    assert_fails(ritz_memory_admit_factor(30 * mebibyte, 20 * mebibyte),
                 RITZ_ERR_MEMORY,
                 "the factor, with what follows, needs 60 MiB");
    assert_fails(ritz_memory_admit_factor(30 * mebibyte, 0), RITZ_ERR_MEMORY,
                 "the factor, with what follows, needs 50 MiB");
    assert_int_equal(ritz_memory_foresee(before).after, later.after);
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

/* A search for so many pairs of a lattice, with a limit. */
static ritz_status search_within(const ritz_sparse *K, const ritz_sparse *M,
                                 int64_t limit, ritz_pairs *out)
{
    const ritz_span span = {.modes = 40, .uncounted = true};

    ritz_set_memory(limit);
    return ritz_eigen_sparse(K, M, &span, out);
}

/* With the smallest limit that is not refused, a part of the basis is on disk;
   with no limit, none. The bits are the same. */
static void a_basis_on_disk_has_the_same_bits(void **state)
{
    const int64_t step = 2 * mebibyte;
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) free = {0}, limited = {0};
    int64_t limit = 0;

    (void)state;
    unsetenv("TMPDIR"); /* the user's may be in memory */
    lattice_new(20, 1.0, &K, &M);
    assert_ok(search_within(&K, &M, 0, &free));
    limit = ritz_memory_limit() - ritz_memory_left();
    for (int k = 0; k < 200 && !limited.Phi.val; k++) {
        limit += step;
        if (search_within(&K, &M, limit, &limited) != RITZ_OK)
            assert_non_null(
                strstr(ritz_error_message(), "are allowed (--memory)"));
    }
    assert_int_equal(limited.Phi.ncol, free.Phi.ncol);
    assert_memory_equal(free.Phi.val, limited.Phi.val,
                        (size_t)(free.Phi.nrow * free.Phi.ncol) *
                            sizeof *free.Phi.val);
    assert_memory_equal(free.lambda, limited.lambda,
                        (size_t)free.Phi.ncol * sizeof *free.lambda);
#ifndef __SANITIZE_ADDRESS__ /* keeps freed memory, of each refused search */
    assert_true(ritz_disk_used() > 0);
#endif
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test_teardown(the_usual_limit_is_part_of_the_machine, no_limit),
    cmocka_unit_test_teardown(the_number_needed_is_named, no_limit),
    cmocka_unit_test_teardown(the_number_named_is_enough, no_limit),
    cmocka_unit_test_teardown(a_large_array_that_does_not_fit_is_refused,
                              no_limit),
    cmocka_unit_test_teardown(an_array_counts_before_it_is_written, no_limit),
    cmocka_unit_test_teardown(what_is_foreseen_is_needed, no_limit),
    cmocka_unit_test_teardown(a_factor_that_does_not_fit_is_refused, no_limit),
    cmocka_unit_test_teardown(a_count_that_does_not_fit_is_refused, no_limit),
    cmocka_unit_test_teardown(a_count_that_does_not_fit_calls_for_relief,
                              no_limit),
    cmocka_unit_test_teardown(what_fits_has_the_same_bits, no_limit),
    cmocka_unit_test_teardown(a_basis_on_disk_has_the_same_bits, no_limit),
};

TEST_MODULE(memory, tests, NULL, NULL)
