/* Several threads read from a large file the same matrix, bit for bit, as one
   thread does, and refuse a damaged file with the same sentence. */
#include "testing.h"

#include "base/mapped.h"
#include "foreign.h"

#include <ritz/import.h>

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { THREADS = 3, ROWS = 1000 };

static int one_thread(void **state)
{
    (void)state;
    ritz_set_threads(1);
    return 0;
}

/* ROWS rows; every seventh entry is zero, and so is all of column 5. */
static void make_matrix(int64_t ncol, ritz_matrix *out)
{
    ritz_sparse *A = &out->A;
    int64_t count = 0;

    *out = (ritz_matrix){.name = "KAA", .digits = 17};
    assert_ok(ritz_sparse_new(ROWS, ncol, ROWS * ncol, A));
    for (int64_t j = 0; j < ncol; j++) {
        for (int64_t i = 0; i < ROWS && j != 5; i++) {
            if ((i + j) % 7 == 0)
                continue;
            A->rowind[count] = i;
            A->val[count++] = sin((double)(i + ROWS * j + 1)) *
                              pow(10.0, (double)(i % 40 - 20));
        }
        A->colptr[j + 1] = count;
    }
}

static void write_text(const char *path, const char *bytes, int64_t size)
{
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, (size_t)size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* Read the bytes of a file with that number of threads. sentence: why it
   failed, "" if it did not. */
static ritz_status read_by(int threads, const char *bytes, int64_t size,
                           ritz_matrices *out, char sentence[400])
{
    ritz_status status = RITZ_OK;

    ritz_set_threads(threads);
    status = foreign_parse(bytes, size, out);
    ritz_set_threads(1);
    snprintf(sentence, 400, "%s",
             status == RITZ_OK ? "" : ritz_error_message());
    return status;
}

static void assert_same_matrix(const ritz_matrix *a, const ritz_matrix *b)
{
    size_t nnz = (size_t)a->A.colptr[a->A.ncol];

    assert_int_equal(a->A.nrow, b->A.nrow);
    assert_int_equal(a->A.ncol, b->A.ncol);
    assert_int_equal(a->digits, b->digits);
    assert_int_equal(a->symmetric, b->symmetric);
    assert_string_equal(a->spelling, b->spelling);
    assert_memory_equal(a->A.colptr, b->A.colptr,
                        (size_t)(a->A.ncol + 1) * sizeof *a->A.colptr);
    assert_memory_equal(a->A.rowind, b->A.rowind, nnz * sizeof *a->A.rowind);
    assert_memory_equal(a->A.val, b->A.val, nnz * sizeof *a->A.val);
}

/* Check that one thread and several read the same matrices, or fail alike. */
static ritz_status compare_readings(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_matrices) one = {0}, many = {0};
    char first[400], second[400];
    ritz_status status = read_by(1, bytes, size, &one, first);

    assert_int_equal(read_by(THREADS, bytes, size, &many, second), status);
    assert_string_equal(first, second);
    assert_int_equal(one.count, many.count);
    for (int64_t k = 0; k < one.count; k++)
        assert_same_matrix(&one.matrix[k], &many.matrix[k]);
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

    make_matrix(120, &m);
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

    make_matrix(350, &m);
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
        int32_t word[2 * ROWS];

        for (int32_t k = 0; k < 2 * ROWS; k++)
            word[k] = k % 5 == 1                 ? k / 5 + 1
                      : k % 5 == 2 || k % 5 == 3 ? 1
                                                 : 12;
        memcpy(A->val + count, word, sizeof word);
        for (int64_t i = 0; i < ROWS; i++)
            A->rowind[count++] = i;
        A->colptr[j + 1] = count;
    }
}

static void values_like_records_mislead_no_thread(void **state)
{
    static const ritz_output4_style style = {0};
    RITZ_OWN(ritz_matrix) m = {0};
    (void)state;

    make_matrix(350, &m);
    fill_with_records(&m.A);
    assert_ok(ritz_output4_write("shares.op4", 1, &m, &style));
    compare_damages("shares.op4");
}

static void threads_read_matrix_market_as_one_does(void **state)
{
    RITZ_OWN(ritz_matrix) m = {0};
    (void)state;

    make_matrix(120, &m);
    assert_ok(ritz_matrix_market_write("shares.mtx", &m, "a comment"));
    compare_damages("shares.mtx");
}

/* Keep the lower triangle alone: coordinates have one triangle or both. */
static void keep_lower(ritz_sparse *A)
{
    int64_t count = 0;

    for (int64_t j = 0; j < A->ncol; j++) {
        const int64_t first = A->colptr[j];

        A->colptr[j] = count;
        for (int64_t k = first; k < A->colptr[j + 1]; k++)
            if (A->rowind[k] >= j) {
                A->rowind[count] = A->rowind[k];
                A->val[count++] = A->val[k];
            }
    }
    A->colptr[A->ncol] = count;
}

/* The entries of a file of Matrix Market, without its head. */
static void drop_head(char *bytes, int64_t *size)
{
    char *at = bytes;

    while (*at == '%')
        at = strchr(at, '\n') + 1;
    at = strchr(at, '\n') + 1; /* sizes */
    *size -= at - bytes;
    memmove(bytes, at, (size_t)*size);
}

static void threads_read_coordinates_as_one_does(void **)
{
    RITZ_OWN(ritz_matrix) m = {0};
    char *bytes = NULL;
    int64_t size = 0;

    make_matrix(120, &m);
    keep_lower(&m.A);
    assert_ok(ritz_matrix_market_write("shares.mtx", &m, "a comment"));
    assert_ok(ritz_bytes_read("shares.mtx", &size, &bytes));
    drop_head(bytes, &size);
    write_text("shares.mtx", bytes, size);
    free(bytes);
    compare_damages("shares.mtx");
    assert_string_equal(foreign_format, "coordinates");
}

/* Cards of DMIG with one term in each column. */
static void make_dmig(int cols, char **bytes, int64_t *size)
{
    enum { LINE = 80 };
    char *text = calloc(3 * (size_t)cols + 4, LINE);
    int64_t used = 0;

    assert_non_null(text);
    used += sprintf(text,
                    "DMIG    KAA            0       9       2       0"
                    "                %8d\n",
                    cols);
    for (int j = 1; j <= cols; j++)
        used += sprintf(text + used,
                        "DMIG*   KAA     %16d%16d\n*       %16d%16d%16.9E\n", j,
                        1, j % 97 + 1, 3, sin((double)j));
    *bytes = text;
    *size = used;
}

/* One card is damaged, and then a second one in another share: the error names
   the first. */
static void threads_read_dmig_as_one_does(void **state)
{
    char *bytes = NULL;
    int64_t size = 0;
    (void)state;

    make_dmig(9000, &bytes, &size);
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

    make_matrix(120, &m);
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

    make_matrix(350, &m);
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

    make_matrix(120, &m);
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

    make_matrix(350, &m[0]);
    make_matrix(351, &m[1]);
    for (size_t k = 0; k < sizeof styles / sizeof *styles; k++) {
        RITZ_OWN(ritz_matrices) read = {0};
        char *bytes = NULL;
        char sentence[400];
        int64_t size = 0;

        assert_ok(ritz_output4_write("shares.op4", 2, m, &styles[k]));
        assert_ok(ritz_bytes_read("shares.op4", &size, &bytes));
        assert_ok(compare_readings(bytes, size));
        assert_ok(read_by(THREADS, bytes, size, &read, sentence));
        assert_int_equal(read.count, 2);
        assert_memory_equal(read.matrix[1].A.val, m[1].A.val,
                            (size_t)m[1].A.colptr[351] * sizeof *m[1].A.val);
        free(bytes);
    }
    ritz_matrix_free(&m[0]);
    ritz_matrix_free(&m[1]);
    remove("shares.op4");
}

/* 5 MB, which are mapped once a program wants it. */
static void a_mapped_file_that_is_changed_is_refused(void **)
{
    const ritz_output4_style style = {.sparse = true};
    RITZ_OWN(ritz_matrix) m = {0}, read = {0}, again = {0};
    RITZ_OWN(ritz_foreign) file = {0};
    FILE *more = NULL;

    make_matrix(720, &m);
    assert_ok(ritz_output4_write("shares.op4", 1, &m, &style));
    ritz_map_files();
    ritz_set_threads(THREADS);
    assert_ok(ritz_foreign_open("shares.op4", &file));
    assert_non_null(file.mapped);
    assert_ok(ritz_foreign_list(&file));
    assert_ok(ritz_foreign_take(&file, 0, &read));
    assert_memory_equal(read.A.val, m.A.val,
                        (size_t)m.A.colptr[720] * sizeof *m.A.val);
    more = fopen("shares.op4", "ab");
    assert_non_null(more);
    putc('x', more);
    fclose(more);
    assert_fails(ritz_foreign_take(&file, 0, &again), RITZ_ERR_FILE,
                 "was changed while it was read");
    remove("shares.op4");
}

/* ---- texts that are mapped ----------------------------------------------- */

static void make_market(char **bytes, int64_t *size)
{
    RITZ_OWN(ritz_matrix) m = {0};

    make_matrix(200, &m);
    assert_ok(ritz_matrix_market_write("shares.mtx", &m, "a comment"));
    assert_ok(ritz_bytes_read("shares.mtx", size, bytes));
}

static void make_coordinates(char **bytes, int64_t *size)
{
    RITZ_OWN(ritz_matrix) m = {0};

    make_matrix(200, &m);
    keep_lower(&m.A);
    assert_ok(ritz_matrix_market_write("shares.mtx", &m, "a comment"));
    assert_ok(ritz_bytes_read("shares.mtx", size, bytes));
    drop_head(*bytes, size);
    remove("shares.mtx");
}

static void make_large_dmig(char **bytes, int64_t *size)
{
    make_dmig(45000, bytes, size);
}

/* Texts of 5 MB, which are mapped once a program wants it. */
static const struct large_text {
    const char *path;
    char comment; /* begins a line that is not read; a blank: it is blank */
    void (*make)(char **bytes, int64_t *size);
} large_texts[] = {
    {"shares.mtx", '%', make_market},
    {"shares.sti", ' ', make_coordinates},
    {"shares.dmig", '$', make_large_dmig},
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

/* Write the text and read the file by several threads: it is the same matrix, or
   the same refusal, as of one thread that reads these bytes in memory. */
static ritz_status compare_file(const char *path, const char *bytes,
                                int64_t size, bool maps)
{
    RITZ_OWN(ritz_foreign) file = {0};
    RITZ_OWN(ritz_matrices) copied = {0};
    RITZ_OWN(ritz_matrix) read = {0};
    char sentence[400], digest[RITZ_DIGEST_SIZE];
    const ritz_status wanted = read_by(1, bytes, size, &copied, sentence);
    ritz_status status = RITZ_OK;

    write_text(path, bytes, size);
    ritz_set_threads(THREADS);
    assert_ok(ritz_foreign_open(path, &file));
    assert_int_equal(file.mapped != NULL, maps);
    status = ritz_foreign_list(&file);
    if (status == RITZ_OK)
        status = ritz_foreign_take(&file, 0, &read);
    assert_int_equal(status, wanted);
    if (status == RITZ_OK)
        assert_same_matrix(&read, &copied.matrix[0]);
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

/* Behind the last byte there is one zero of its page, or nothing. */
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

/* What another program does to a file that is mapped. */
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
    ritz_set_threads(THREADS);
    for (size_t k = 0; k < NUM_LARGE; k++) {
        const char *path = large_texts[k].path;
        char *bytes = NULL;
        int64_t size = 0;

        fit_text(&large_texts[k], 1, &bytes, &size);
        for (size_t j = 0; j < 2 * sizeof changes / sizeof *changes; j++) {
            write_text(path, bytes, size);
            change_text(path, size, j % 2 == 0, changes[j / 2]);
        }
        remove(path);
        free(bytes);
    }
}

/* As a file that is mapped may change unnoticed: its time is not exact. */
static void a_header_of_dmig_that_is_lost_is_missed(void **)
{
    RITZ_OWN(ritz_matrix) read = {0};
    char *bytes = NULL;
    int64_t size = 0;

    make_dmig(10, &bytes, &size);
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
    const char *path = "shares.bin";
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
    ritz_set_threads(THREADS);
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
    cmocka_unit_test_teardown(threads_read_text_output4_as_one_does,
                              one_thread),
    cmocka_unit_test_teardown(threads_read_binary_output4_as_one_does,
                              one_thread),
    cmocka_unit_test_teardown(values_like_records_mislead_no_thread,
                              one_thread),
    cmocka_unit_test_teardown(threads_read_matrix_market_as_one_does,
                              one_thread),
    cmocka_unit_test_teardown(threads_read_coordinates_as_one_does, one_thread),
    cmocka_unit_test_teardown(threads_read_dmig_as_one_does, one_thread),
    cmocka_unit_test_teardown(
        strings_of_an_unmarked_file_are_read_as_one_thread_does, one_thread),
    cmocka_unit_test_teardown(
        zeros_and_nan_in_binary_are_read_as_one_thread_does, one_thread),
    cmocka_unit_test_teardown(
        lines_of_other_lengths_are_read_as_one_thread_does, one_thread),
    cmocka_unit_test_teardown(threads_read_each_matrix_of_a_file, one_thread),
    cmocka_unit_test_teardown(a_mapped_file_that_is_changed_is_refused,
                              one_thread),
    cmocka_unit_test_teardown(mapped_texts_are_read_as_copied_ones, one_thread),
    cmocka_unit_test_teardown(mapped_texts_that_are_changed_are_refused,
                              one_thread),
    cmocka_unit_test(a_header_of_dmig_that_is_lost_is_missed),
    cmocka_unit_test_teardown(a_file_read_in_pieces_has_its_bytes_and_digest,
                              one_thread),
};

TEST_MODULE(shares, tests, NULL, NULL)
