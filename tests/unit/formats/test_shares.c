/* Several threads read from a large file the same matrix, bit for bit, as one
   thread does, and refuse a damaged file with the same sentence. */
#include "testing.h"

#include "foreign.h"
#include "large_files.h"

#include <ritz/import.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Check that one thread and several read the same matrices, or fail alike. */
static ritz_status compare_readings(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_matrices) one = {0}, many = {0};
    char first[400], second[400];
    ritz_status status = large_read(1, bytes, size, &one, first);

    assert_int_equal(large_read(LARGE_THREADS, bytes, size, &many, second),
                     status);
    assert_string_equal(first, second);
    assert_int_equal(one.count, many.count);
    for (int64_t k = 0; k < one.count; k++)
        large_assert_same(&one.matrix[k], &many.matrix[k]);
    return status;
}

/* Compare readings of a file as it is, with one byte changed, and cut short, at
   the end of a line too. */
static void compare_damages(const char *path)
{
    char *bytes = NULL;
    int64_t size = 0;
    int64_t refused = 0;
    int64_t at = 0;
    char good = '\0';

    assert_ok(ritz_bytes_read(path, &size, &bytes));
    assert_true(size > 2 << 20);
    assert_ok(compare_readings(bytes, size));
    at = size / 100 * 31;
    good = bytes[at];
    bytes[at] = 'x';
    refused += compare_readings(bytes, size) != RITZ_OK;
    bytes[at] = '\n';
    (void)compare_readings(bytes, size);
    bytes[at] = good;
    refused += compare_readings(bytes, size / 2) != RITZ_OK;
    assert_true(refused > 0);
    for (at = size / 10 * 9; at > 1 && bytes[at - 1] != '\n';)
        at--;
    (void)compare_readings(bytes, at);
    free(bytes);
    remove(path);
}

static void threads_read_text_output4_as_one_does(void **state)
{
    static const ritz_output4_style styles[] = {
        {.text = true, .digits = 17},
        {.text = true, .digits = 17, .sparse = true},
    };
    RITZ_OWN(ritz_matrix) m = {0};
    (void)state;

    large_matrix(120, &m);
    for (size_t k = 0; k < sizeof styles / sizeof *styles; k++) {
        assert_ok(ritz_output4_write("shares.op4", 1, &m, &styles[k]));
        compare_damages("shares.op4");
    }
}

static void threads_read_binary_output4_as_one_does(void **state)
{
    static const ritz_output4_style styles[] = {{0}, {.sparse = true}};
    RITZ_OWN(ritz_matrix) m = {0};
    (void)state;

    large_matrix(350, &m);
    for (size_t k = 0; k < sizeof styles / sizeof *styles; k++) {
        assert_ok(ritz_output4_write("shares.op4", 1, &m, &styles[k]));
        compare_damages("shares.op4");
    }
}

/* Values whose bytes are records of columns 1, 2, ...: 12 N 1 1 12. */
static void fill_with_records(ritz_sparse *A)
{
    int64_t count = 0;

    for (int64_t j = 0; j < A->ncol; j++) {
        int32_t word[2 * LARGE_ROWS];

        for (int32_t k = 0; k < 2 * LARGE_ROWS; k++)
            word[k] = k % 5 == 1                 ? k / 5 + 1
                      : k % 5 == 2 || k % 5 == 3 ? 1
                                                 : 12;
        memcpy(A->val + count, word, sizeof word);
        for (int64_t i = 0; i < LARGE_ROWS; i++)
            A->rowind[count++] = i;
        A->colptr[j + 1] = count;
    }
}

static void values_like_records_mislead_no_thread(void **state)
{
    static const ritz_output4_style style = {0};
    RITZ_OWN(ritz_matrix) m = {0};
    (void)state;

    large_matrix(350, &m);
    fill_with_records(&m.A);
    assert_ok(ritz_output4_write("shares.op4", 1, &m, &style));
    compare_damages("shares.op4");
}

static void threads_read_matrix_market_as_one_does(void **state)
{
    RITZ_OWN(ritz_matrix) m = {0};
    (void)state;

    large_matrix(120, &m);
    assert_ok(ritz_matrix_market_write("shares.mtx", &m, "a comment"));
    compare_damages("shares.mtx");
}

static void threads_read_coordinates_as_one_does(void **)
{
    RITZ_OWN(ritz_matrix) m = {0};
    char *bytes = NULL;
    int64_t size = 0;

    large_matrix(120, &m);
    large_keep_lower(&m.A);
    assert_ok(ritz_matrix_market_write("shares.mtx", &m, "a comment"));
    assert_ok(ritz_bytes_read("shares.mtx", &size, &bytes));
    large_drop_head(bytes, &size);
    large_write("shares.mtx", bytes, size);
    free(bytes);
    compare_damages("shares.mtx");
    assert_string_equal(foreign_format, "coordinates");
}

/* One card is damaged, and then a second one in another share: the error names
   the first. */
static void threads_read_dmig_as_one_does(void **state)
{
    char *bytes = NULL;
    int64_t size = 0;
    (void)state;

    large_dmig(9000, &bytes, &size);
    assert_ok(compare_readings(bytes, size));
    bytes[size / 2] = 'x';
    assert_int_equal(compare_readings(bytes, size), RITZ_ERR_FORMAT);
    bytes[size * 3 / 4] = 'x';
    assert_int_equal(compare_readings(bytes, size), RITZ_ERR_FORMAT);
    free(bytes);
}

/* Without the minus sign of its row count, the header does not tell how strings
   begin; the first strings do. All shares must read theirs in the same way. */
static void
strings_of_an_unmarked_file_are_read_as_one_thread_does(void **state)
{
    const ritz_output4_style style = {
        .text = true, .digits = 17, .sparse = true};
    RITZ_OWN(ritz_matrix) m = {0};
    RITZ_OWN(ritz_matrices) read = {0};
    char *bytes = NULL;
    char *minus = NULL;
    int64_t size = 0;
    (void)state;

    large_matrix(120, &m);
    assert_ok(ritz_output4_write("shares.op4", 1, &m, &style));
    assert_ok(ritz_bytes_read("shares.op4", &size, &bytes));
    minus = memchr(bytes, '-', 32);
    if (minus)
        *minus = ' ';
    assert_ok(compare_readings(bytes, size));
    assert_ok(foreign_parse(bytes, size, &read));
    assert_memory_equal(read.matrix[0].A.val, m.A.val,
                        (size_t)m.A.colptr[m.A.ncol] * sizeof *m.A.val);
    free(bytes);
    remove("shares.op4");
}

/* The place of a double in the middle of some bytes, or behind it. */
static char *find_value(char *bytes, int64_t size, double value)
{
    for (int64_t k = size / 2; k + 8 <= size; k++) {
        double there = 0.0;

        memcpy(&there, bytes + k, sizeof there);
        if (there == value)
            return bytes + k;
    }
    fail_msg("the file does not hold %g", value);
    return NULL;
}

/* Zeros are counted before they are read, and leave no gap. */
static void zeros_and_nan_in_binary_are_read_as_one_thread_does(void **)
{
    static const double odd[] = {0.0, -0.0, (double)NAN, (double)INFINITY};
    const ritz_output4_style style = {.sparse = true};
    RITZ_OWN(ritz_matrix) m = {0};
    char *bytes = NULL;
    int64_t size = 0;

    large_matrix(350, &m);
    assert_ok(ritz_output4_write("shares.op4", 1, &m, &style));
    assert_ok(ritz_bytes_read("shares.op4", &size, &bytes));
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
        const double value = m.A.val[m.A.colptr[250] + 10];
        RITZ_OWN(ritz_matrices) read = {0};
        char *at = find_value(bytes, size, value);

        memcpy(at, &odd[k], sizeof value);
        assert_int_equal(compare_readings(bytes, size),
                         k < 2 ? RITZ_OK : RITZ_ERR_FORMAT);
        if (k < 2) {
            assert_ok(foreign_parse(bytes, size, &read));
            assert_int_equal(read.matrix[0].A.colptr[350], m.A.colptr[350] - 1);
        } else {
            assert_non_null(strstr(ritz_error_message(), "is not finite"));
        }
        memcpy(at, &value, sizeof value);
    }
    free(bytes);
    remove("shares.op4");
}

/* Every second line of numbers ends in blanks, so that lines cannot be passed by
   their length; lines may end in CR LF. */
static void lines_of_other_lengths_are_read_as_one_thread_does(void **)
{
    static const char *const ends[] = {"\n", "\r\n", "  \n"};
    const ritz_output4_style style = {
        .text = true, .digits = 17, .sparse = true};
    RITZ_OWN(ritz_matrix) m = {0};
    char *bytes = NULL, *longer = NULL;
    int64_t size = 0;

    large_matrix(120, &m);
    assert_ok(ritz_output4_write("shares.op4", 1, &m, &style));
    assert_ok(ritz_bytes_read("shares.op4", &size, &bytes));
    longer = malloc(2 * (size_t)size);
    assert_non_null(longer);
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
        int64_t used = 0;

        for (int64_t i = 0, line = 0; i < size; i++) {
            if (bytes[i] == '\n' && line++ % 2 == 1)
                used += sprintf(longer + used, "%s", ends[k]);
            else
                longer[used++] = bytes[i];
        }
        assert_ok(compare_readings(longer, used));
    }
    free(longer);
    free(bytes);
    remove("shares.op4");
}

/* The second matrix has marks of its own, behind those of the first. */
static void threads_read_each_matrix_of_a_file(void **)
{
    static const ritz_output4_style styles[] = {
        {.text = true, .digits = 17, .sparse = true}, {.sparse = true}};
    ritz_matrix m[2];

    large_matrix(350, &m[0]);
    large_matrix(351, &m[1]);
    for (size_t k = 0; k < sizeof styles / sizeof *styles; k++) {
        RITZ_OWN(ritz_matrices) read = {0};
        char *bytes = NULL;
        char sentence[400];
        int64_t size = 0;

        assert_ok(ritz_output4_write("shares.op4", 2, m, &styles[k]));
        assert_ok(ritz_bytes_read("shares.op4", &size, &bytes));
        assert_ok(compare_readings(bytes, size));
        assert_ok(large_read(LARGE_THREADS, bytes, size, &read, sentence));
        assert_int_equal(read.count, 2);
        assert_memory_equal(read.matrix[1].A.val, m[1].A.val,
                            (size_t)m[1].A.colptr[351] * sizeof *m[1].A.val);
        free(bytes);
    }
    ritz_matrix_free(&m[0]);
    ritz_matrix_free(&m[1]);
    remove("shares.op4");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test_teardown(threads_read_text_output4_as_one_does, large_end),
    cmocka_unit_test_teardown(threads_read_binary_output4_as_one_does,
                              large_end),
    cmocka_unit_test_teardown(values_like_records_mislead_no_thread, large_end),
    cmocka_unit_test_teardown(threads_read_matrix_market_as_one_does,
                              large_end),
    cmocka_unit_test_teardown(threads_read_coordinates_as_one_does, large_end),
    cmocka_unit_test_teardown(threads_read_dmig_as_one_does, large_end),
    cmocka_unit_test_teardown(
        strings_of_an_unmarked_file_are_read_as_one_thread_does, large_end),
    cmocka_unit_test_teardown(
        zeros_and_nan_in_binary_are_read_as_one_thread_does, large_end),
    cmocka_unit_test_teardown(
        lines_of_other_lengths_are_read_as_one_thread_does, large_end),
    cmocka_unit_test_teardown(threads_read_each_matrix_of_a_file, large_end),
};

TEST_MODULE(shares, tests, NULL, NULL)
