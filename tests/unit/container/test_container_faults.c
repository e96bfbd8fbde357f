/*
 * Containers on a disk that fails: each system call that writes fails in turn.
 */
#include "testing.h"

#include "faults.h"
#include "samples.h"

#include <ritz/base.h>
#include <ritz/container.h>

#include <stdio.h>
#include <stdlib.h>

static const char path[] = "test_container_faults.h5";
static const ritz_stamp stamp = {.command = "ritz-verb this that"};

static int set_up(void **)
{
    return setenv("RITZ_SYNC", "1", 1);
}

static ritz_status write_sample(const void *what)
{
    const sample_kind *kind = what;

    return kind->make(path, &stamp);
}

/* There are more than five such calls: data sets, the file's head, fsync of
   file and folder, the rename. */
static void no_failed_write_is_lost(void **)
{
    for (int k = 0; k < SAMPLE_KINDS; k++)
        assert_true(faults_try_each(write_sample, &sample_kinds[k], path) > 5);
}

/* A matrix of 300 x 300 values, whose chunks are written one by one. */
static ritz_status write_large(const void *what)
{
    return ritz_container_write_state_space(path, what, &stamp);
}

static void no_failed_write_of_many_chunks_is_lost(void **)
{
    enum { N = 300 };
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_state_space) s = {0};

    assert_ok(ritz_io_new(N, 0, 0, &io));
    assert_ok(ritz_state_space_new(N, &io, &s));
    for (int64_t k = 0; k < (int64_t)N * N; k++)
        s.A.val[k] = -1.0 - (double)k;
    assert_true(faults_try_each(write_large, &s, path) > 5);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_failed_write_is_lost),
    cmocka_unit_test(no_failed_write_of_many_chunks_is_lost),
};

TEST_MODULE(container_faults, tests, set_up, NULL)
