/* Files that are mapped into memory are read as copied ones are, by several
   threads, and refused if another program changes them meanwhile. */
#include "testing.h"

#include "base/mapped.h"
#include "large_files.h"

#include <ritz/import.h>

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* 5 MB, enough for a file to be mapped after ritz_map_files(). */
static void a_mapped_file_that_is_changed_is_refused(void **)
{
    const ritz_output4_style style = {.sparse = true};
    RITZ_OWN(ritz_matrix) m = {0}, read = {0}, again = {0};
    RITZ_OWN(ritz_foreign) file = {0};
    FILE *more = NULL;

    large_matrix(720, &m);
    assert_ok(ritz_output4_write("mapped.op4", 1, &m, &style));
    ritz_map_files();
    ritz_set_threads(LARGE_THREADS);
    assert_ok(ritz_foreign_open("mapped.op4", &file));
    assert_non_null(file.mapped);
    assert_ok(ritz_foreign_list(&file));
    assert_ok(ritz_foreign_take(&file, 0, &read));
    assert_memory_equal(read.A.val, m.A.val,
                        (size_t)m.A.colptr[720] * sizeof *m.A.val);
    more = fopen("mapped.op4", "ab");
    assert_non_null(more);
    putc('x', more);
    fclose(more);
    assert_fails(ritz_foreign_take(&file, 0, &again), RITZ_ERR_FILE,
                 "was changed while it was read");
    remove("mapped.op4");
}

static void make_market(char **bytes, int64_t *size)
{
    RITZ_OWN(ritz_matrix) m = {0};

    large_matrix(200, &m);
    assert_ok(ritz_matrix_market_write("mapped.mtx", &m, "a comment"));
    assert_ok(ritz_bytes_read("mapped.mtx", size, bytes));
}

static void make_coordinates(char **bytes, int64_t *size)
{
    RITZ_OWN(ritz_matrix) m = {0};

    large_matrix(200, &m);
    large_keep_lower(&m.A);
    assert_ok(ritz_matrix_market_write("mapped.mtx", &m, "a comment"));
    assert_ok(ritz_bytes_read("mapped.mtx", size, bytes));
    large_drop_head(*bytes, size);
    remove("mapped.mtx");
}

static void make_large_dmig(char **bytes, int64_t *size)
{
    large_dmig(45000, bytes, size);
}

/* Texts of 5 MB, which are mapped after ritz_map_files(). */
static const struct large_text {
    const char *path;
    char comment; /* begins a comment; a blank makes a blank line */
    void (*make)(char **bytes, int64_t *size);
} large_texts[] = {
    {"mapped.mtx", '%', make_market},
    {"mapped.sti", ' ', make_coordinates},
    {"mapped.dmig", '$', make_large_dmig},
};

enum { NUM_LARGE = sizeof large_texts / sizeof *large_texts };

/* The text without its last end of line, and with a comment behind its first
   line that makes its last page hold `rest` bytes, 0 for a full one. No byte
   follows the copy, so that a sanitizer sees who reads beyond it. */
static void fit_text(const struct large_text *text, int64_t rest, char **out,
                     int64_t *size)
{
    const int64_t page = sysconf(_SC_PAGESIZE);
    char *bytes = NULL;
    int64_t head = 0, more = 0;

    text->make(&bytes, size);
    head = (char *)memchr(bytes, '\n', (size_t)*size) - bytes + 1;
    *size -= 1;
    more = 2 + (2 * page + rest - (*size + 2) % page) % page;
    *out = malloc((size_t)(*size + more));
    assert_non_null(*out);
    memcpy(*out, bytes, (size_t)head);
    memset(*out + head, text->comment, (size_t)more);
    (*out)[head + more - 1] = '\n';
    memcpy(*out + head + more, bytes + head, (size_t)(*size - head));
    *size += more;
    free(bytes);
}

/* Write the text and read the file with several threads: the matrix, or the
   refusal, is that of one thread that reads these bytes in memory. */
static ritz_status compare_file(const char *path, const char *bytes,
                                int64_t size, bool maps)
{
    RITZ_OWN(ritz_foreign) file = {0};
    RITZ_OWN(ritz_matrices) copied = {0};
    RITZ_OWN(ritz_matrix) read = {0};
    char sentence[400], digest[RITZ_DIGEST_SIZE];
    const ritz_status wanted = large_read(1, bytes, size, &copied, sentence);
    ritz_status status = RITZ_OK;

    large_write(path, bytes, size);
    ritz_set_threads(LARGE_THREADS);
    assert_ok(ritz_foreign_open(path, &file));
    assert_int_equal(file.mapped != NULL, maps);
    status = ritz_foreign_list(&file);
    if (status == RITZ_OK)
        status = ritz_foreign_take(&file, 0, &read);
    assert_int_equal(status, wanted);
    if (status == RITZ_OK)
        large_assert_same(&read, &copied.matrix[0]);
    else
        assert_string_equal(ritz_error_message(), sentence);
    ritz_digest_bytes(bytes, (size_t)size, digest);
    assert_string_equal(ritz_foreign_digest(&file), digest);
    ritz_set_threads(1);
    remove(path);
    return status;
}

/* The word takes the place of the last value of the text. */
static void spoil_last_value(char *bytes, int64_t size, const char *word)
{
    int64_t at = size - 1;

    while (bytes[at - 1] != ' ')
        at--;
    assert_true(size - at > (int64_t)strlen(word));
    memset(bytes + at, ' ', (size_t)(size - at));
    for (int64_t k = 0; word[k]; k++)
        bytes[at + k] = word[k];
}

/* The text ends one byte before the end of its last page, where the kernel puts
   a zero, or fills the page. */
static void mapped_texts_are_read_as_copied_ones(void **)
{
    static const char *const words[] = {"nan", "1e999"};
    const int64_t page = sysconf(_SC_PAGESIZE);
    const int64_t rests[] = {page - 1, 0};

    ritz_map_files();
    for (size_t k = 0; k < NUM_LARGE; k++)
        for (size_t j = 0; j < sizeof rests / sizeof *rests; j++) {
            const char *path = large_texts[k].path;
            const bool maps = rests[j] > 0;
            char *bytes = NULL;
            int64_t size = 0;

            fit_text(&large_texts[k], rests[j], &bytes, &size);
            assert_int_equal(size % page, rests[j]);
            assert_ok(compare_file(path, bytes, size, maps));
            (void)compare_file(path, bytes, size - 4000, true);
            spoil_last_value(bytes, size, words[j]);
            assert_int_equal(compare_file(path, bytes, size, maps),
                             RITZ_ERR_FORMAT);
            free(bytes);
        }
}

/* Changes that another program makes to a mapped file. */
static void lengthen_file(const char *path, int64_t size)
{
    assert_int_equal(truncate(path, size + 1), 0);
}

/* The file is at no time shorter, as the thread that computes its digest would
   get SIGBUS; its time of modification differs for certain. */
static void blank_file(const char *path, int64_t size)
{
    const struct timespec times[2] = {{.tv_sec = 1}, {.tv_sec = 1}};
    FILE *file = fopen(path, "r+b");

    assert_non_null(file);
    for (int64_t k = 0; k < size; k++)
        putc('\n', file);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

#ifndef __SANITIZE_ADDRESS__ /* it lets no program handle SIGBUS */
static void shorten_file(const char *path, int64_t)
{
    assert_int_equal(truncate(path, 100), 0);
}

static void empty_file(const char *path, int64_t)
{
    assert_int_equal(truncate(path, 0), 0);
}
#endif

/* Change the file before its directory is read, or between that and reading. */
static void change_text(const char *path, int64_t size, bool listed,
                        void (*change)(const char *path, int64_t size))
{
    RITZ_OWN(ritz_foreign) file = {0};
    RITZ_OWN(ritz_matrix) read = {0};

    assert_ok(ritz_foreign_open(path, &file));
    assert_non_null(file.mapped);
    if (listed)
        assert_ok(ritz_foreign_list(&file));
    change(path, size);
    assert_fails(listed ? ritz_foreign_take(&file, 0, &read)
                        : ritz_foreign_list(&file),
                 RITZ_ERR_FILE, "was changed while it was read");
}

static void mapped_texts_that_are_changed_are_refused(void **)
{
    static void (*const changes[])(const char *, int64_t) = {
        lengthen_file,
        blank_file,
#ifndef __SANITIZE_ADDRESS__
        shorten_file,
        empty_file,
#endif
    };

    ritz_map_files();
    ritz_set_threads(LARGE_THREADS);
    for (size_t k = 0; k < NUM_LARGE; k++) {
        const char *path = large_texts[k].path;
        char *bytes = NULL;
        int64_t size = 0;

        fit_text(&large_texts[k], 1, &bytes, &size);
        for (size_t j = 0; j < 2 * sizeof changes / sizeof *changes; j++) {
            large_write(path, bytes, size);
            change_text(path, size, j % 2 == 0, changes[j / 2]);
        }
        remove(path);
        free(bytes);
    }
}

/* Times of modification are not exact, so that a mapped file may change without
   notice. */
static void a_header_of_dmig_that_is_lost_is_missed(void **)
{
    RITZ_OWN(ritz_matrix) read = {0};
    char *bytes = NULL;
    int64_t size = 0;

    large_dmig(10, &bytes, &size);
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_foreign)
        file = {.bytes = bytes, .size = size, .format = &ritz_format_dmig};

        assert_ok(ritz_foreign_list(&file));
        if (k == 0) /* another matrix */
            for (char *at = bytes; (at = strstr(at, "KAA"));)
                *at = 'M';
        else
            memset(bytes, '\n', (size_t)size);
        assert_fails(ritz_foreign_take(&file, 0, &read), RITZ_ERR_FORMAT,
                     k == 0 ? "DMIG 'KAA' has lost its header"
                            : "DMIG 'MAA' has lost its header");
    }
    free(bytes);
}

/* 9 MiB: large enough that several threads read pieces of 4 MiB. */
static void a_file_read_in_pieces_has_its_bytes_and_digest(void **state)
{
    enum { SIZE = 9 << 20 };
    const char *path = "mapped.bin";
    FILE *file = fopen(path, "wb");
    RITZ_OWN(ritz_foreign) foreign = {0};
    char *written = malloc(SIZE);
    char *bytes = NULL;
    char digest[RITZ_DIGEST_SIZE];
    int64_t size = 0;
    (void)state;

    for (int64_t k = 0; k < SIZE; k++)
        written[k] = (char)(k * k >> 7);
    assert_int_equal(fwrite(written, 1, SIZE, file), SIZE);
    assert_int_equal(fclose(file), 0);
    ritz_set_threads(LARGE_THREADS);
    assert_ok(ritz_bytes_read(path, &size, &bytes));
    assert_int_equal(size, SIZE);
    assert_memory_equal(bytes, written, SIZE);
    assert_int_equal(bytes[size], 0);
    assert_ok(ritz_foreign_open(path, &foreign));
    assert_ok(ritz_digest_file(path, digest));
    assert_string_equal(ritz_foreign_digest(&foreign), digest);
    free(bytes);
    free(written);
    remove(path);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test_teardown(a_mapped_file_that_is_changed_is_refused,
                              large_end),
    cmocka_unit_test_teardown(mapped_texts_are_read_as_copied_ones, large_end),
    cmocka_unit_test_teardown(mapped_texts_that_are_changed_are_refused,
                              large_end),
    cmocka_unit_test(a_header_of_dmig_that_is_lost_is_missed),
    cmocka_unit_test_teardown(a_file_read_in_pieces_has_its_bytes_and_digest,
                              large_end),
};

TEST_MODULE(mapped_files, tests, NULL, NULL)
