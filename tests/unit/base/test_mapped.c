/* Files that are mapped, and changed by others meanwhile. */
#include "testing.h"

#include "base/mapped.h"
#include "base/team.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const char path[] = "test_mapped.bin";

enum { SIZE = (5 << 20) + 1, FAR = 5 << 20 };

static int tear_down(void **)
{
    remove(path);
    return 0;
}

static void write_bytes(int64_t size)
{
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    for (int64_t k = 0; k < size; k++)
        putc((int)(k % 251) + 1, file);
    assert_int_equal(fclose(file), 0);
}

/* The first test: until it calls ritz_map_files(), nothing is mapped. */
static void nothing_is_mapped_unless_a_program_wants_it(void **)
{
    ritz_mapped *mapped = NULL;

    write_bytes(SIZE);
    mapped = ritz_mapped_new(path);
    assert_null(mapped);
    ritz_map_files();
    mapped = ritz_mapped_new(path);
    assert_non_null(mapped);
    ritz_mapped_free(&mapped);
    assert_null(mapped);
}

static void a_map_has_the_bytes_of_the_file(void **)
{
    ritz_mapped *mapped = NULL;
    const char *bytes = NULL;
    int64_t size = 0;

    ritz_map_files();
    write_bytes(SIZE);
    mapped = ritz_mapped_new(path);
    bytes = ritz_mapped_bytes(mapped, &size);
    assert_int_equal(size, SIZE);
    for (int64_t k = 0; k < SIZE; k++)
        assert_int_equal((unsigned char)bytes[k], k % 251 + 1);
    assert_int_equal(bytes[SIZE], 0);
    assert_false(ritz_mapped_changed(mapped));
    ritz_mapped_free(&mapped);
}

/* Small files, those that fill their last page, and what is no file. */
static void others_are_left_to_be_copied(void **)
{
    ritz_mapped *mapped = NULL;

    ritz_map_files();
    write_bytes(1 << 20);
    mapped = ritz_mapped_new(path);
    assert_null(mapped);
    write_bytes(FAR);
    mapped = ritz_mapped_new(path);
    assert_null(mapped);
    mapped = ritz_mapped_new("/dev/null");
    assert_null(mapped);
    mapped = ritz_mapped_new("there is no such file");
    assert_null(mapped);
}

static void a_longer_file_is_noticed(void **)
{
    ritz_mapped *mapped = NULL;

    ritz_map_files();
    write_bytes(SIZE);
    mapped = ritz_mapped_new(path);
    assert_int_equal(truncate(path, SIZE + 1), 0);
    assert_true(ritz_mapped_changed(mapped));
    ritz_mapped_free(&mapped);
}

static void a_rewritten_file_is_noticed(void **)
{
    const struct timespec times[2] = {{.tv_sec = 1}, {.tv_sec = 1}};
    ritz_mapped *mapped = NULL;

    ritz_map_files();
    write_bytes(SIZE);
    mapped = ritz_mapped_new(path);
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
    assert_true(ritz_mapped_changed(mapped));
    ritz_mapped_free(&mapped);
}

#ifndef __SANITIZE_ADDRESS__ /* it lets no program handle SIGBUS */

static void *add_bytes(void *argument)
{
    const char *bytes = argument;
    static int64_t sum;

    sum = 0;
    for (int64_t k = FAR - 9000; k < FAR; k++)
        sum += bytes[k];
    return &sum;
}

/* In the thread of the program, and in another one. */
static void a_shortened_file_reads_as_zeros(void **)
{
    for (int apart = 0; apart < 2; apart++) {
        ritz_mapped *mapped = NULL;
        char *bytes = NULL;
        const char *at = NULL;
        int64_t size = 0;
        void *sum = NULL;
        pthread_t thread;

        ritz_map_files();
        write_bytes(SIZE);
        mapped = ritz_mapped_new(path);
        at = ritz_mapped_bytes(mapped, &size);
        memcpy(&bytes, &at, sizeof bytes);
        assert_int_equal(truncate(path, 100), 0);
        if (apart) {
            assert_true(ritz_team_start(add_bytes, bytes, &thread));
            assert_int_equal(pthread_join(thread, &sum), 0);
        } else {
            sum = add_bytes(bytes);
        }
        assert_int_equal(*(int64_t *)sum, 0);
        assert_true(ritz_mapped_changed(mapped));
        ritz_mapped_free(&mapped);
    }
}

#endif

static void the_ninth_map_is_left_to_be_copied(void **)
{
    enum { MOST = 8 };
    ritz_mapped *mapped[MOST] = {0};

    ritz_map_files();
    write_bytes(SIZE);
    for (int k = 0; k < MOST; k++) {
        mapped[k] = ritz_mapped_new(path);
        assert_non_null(mapped[k]);
    }
    assert_null(ritz_mapped_new(path));
    ritz_mapped_free(&mapped[3]);
    mapped[3] = ritz_mapped_new(path);
    assert_non_null(mapped[3]);
    for (int k = 0; k < MOST; k++)
        ritz_mapped_free(&mapped[k]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(nothing_is_mapped_unless_a_program_wants_it),
    cmocka_unit_test(a_map_has_the_bytes_of_the_file),
    cmocka_unit_test(others_are_left_to_be_copied),
    cmocka_unit_test(a_longer_file_is_noticed),
    cmocka_unit_test(a_rewritten_file_is_noticed),
#ifndef __SANITIZE_ADDRESS__
    cmocka_unit_test(a_shortened_file_reads_as_zeros),
#endif
    cmocka_unit_test(the_ninth_map_is_left_to_be_copied),
};

TEST_MODULE(mapped, tests, NULL, tear_down)
