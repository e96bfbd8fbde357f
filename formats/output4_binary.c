/*
 * OUTPUT4 as Fortran writes unformatted records: length, bytes, length again.
 *
 *     NCOL NROW FORM TYPE NAME(2 words)    24 bytes, or 48 of 8-byte integers
 *     ICOL IROW NW data                    IROW = 0: data are strings
 *
 * Data fill their record: where NW disagrees the record is right.
 */
#include "formats/output4.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The file and how its bytes are meant. */
typedef struct ritz_binary {
    const unsigned char *begin, *at, *end;
    bool big_endian;
    int64_t mark;    /* bytes of a record's length */
    int64_t integer; /* bytes of an integer, the size of a word too */
    int64_t real;    /* bytes of a number in this matrix */
} ritz_binary;

typedef struct ritz_binary_record {
    const unsigned char *at;
    int64_t size;
} ritz_binary_record;

/** @p size bytes as an unsigned number. */
static inline uint64_t load_bits(const unsigned char *at, int64_t size,
                                 bool big_endian)
{
    uint64_t value = 0;

    for (int64_t k = 0; k < size; k++)
        value = value << 8 | at[big_endian ? k : size - 1 - k];
    return value;
}

/** @p size bytes, 4 or 8, as an integer. */
static inline int64_t load_integer(const ritz_binary *b,
                                   const unsigned char *at, int64_t size)
{
    uint64_t bits = load_bits(at, size, b->big_endian);

    return size == 4 ? (int64_t)(int32_t)(uint32_t)bits : (int64_t)bits;
}

/* ---- records ------------------------------------------------------------ */

/*
 * Records as Fortran writes them unformatted: length, bytes, length again. Byte
 * order and size of integers follow from the first length. Lengths are integers
 * of 4 bytes, of 8 by some compilers; records of no bytes may stand between
 * others.
 */

/* How the file is spelled, from the length of its first record. */
static bool find_spelling(const char *bytes, int64_t size, ritz_binary *out)
{
    const void *start = bytes;
    ritz_binary b = {.begin = start};

    b.at = b.begin;
    b.end = b.begin + size;
    for (int k = 0; k < 8 && size >= 4; k++) {
        int64_t length = 0;

        b.big_endian = k & 1;
        b.integer = k & 2 ? 8 : 4;
        b.mark = k & 4 ? 4 : 8;
        length = 6 * b.integer;
        if (size < b.mark ||
            load_bits(b.at, b.mark, b.big_endian) != (uint64_t)length)
            continue;
        *out = b;
        return true;
    }
    return false;
}

/* Take a record that is not empty; its size is -1 at the end of the file. */
static ritz_status take_record(ritz_binary *b, ritz_binary_record *out)
{
    int64_t size = 0;

    while (size == 0) {
        int64_t left = b->end - b->at;

        *out = (ritz_binary_record){.size = -1};
        if (left == 0)
            return RITZ_OK;
        RITZ_REFUSE_IF(left < 2 * b->mark, RITZ_ERR_FORMAT,
                       "byte %td: %" PRId64 " bytes are left, too few for "
                       "a record",
                       b->at - b->begin, left);
        size = load_integer(b, b->at, b->mark);
        RITZ_REFUSE_IF(size < 0 || size > left - 2 * b->mark, RITZ_ERR_FORMAT,
                       "byte %td: a record of %" PRId64
                       " bytes begins, but %" PRId64 " are left",
                       b->at - b->begin, size, left - b->mark);
        *out = (ritz_binary_record){b->at + b->mark, size};
        b->at += size + 2 * b->mark;
        RITZ_REFUSE_IF(
            load_integer(b, b->at - b->mark, b->mark) != size, RITZ_ERR_FORMAT,
            "byte %td: a record of %" PRId64 " bytes ends with another length",
            b->at - b->mark - b->begin, size);
    }
    return RITZ_OK;
}

/* A record as the header of a matrix. */
static ritz_status take_header(const ritz_binary *b,
                               const ritz_binary_record *from,
                               ritz_output4_header *out)
{
    ritz_output4_header h = {0};
    int64_t n[4] = {0};
    const void *name = from->at + 4 * b->integer;

    for (int64_t k = 0; k < 4 && from->size == 6 * b->integer; k++)
        n[k] = load_integer(b, from->at + k * b->integer, b->integer);
    RITZ_REFUSE_IF(n[3] < 1 || n[3] > 4 || n[0] < 0 || n[1] == INT64_MIN,
                   RITZ_ERR_FORMAT,
                   "byte %td: a record of %" PRId64 " bytes begins no matrix",
                   from->at - b->begin, from->size);
    h.ncol = n[0];
    h.nrow = n[1] < 0 ? -n[1] : n[1];
    h.bigmat = n[1] < 0 || n[1] >= 65536;
    h.form = n[2];
    h.type = n[3];
    ritz_output4_name(name, 2 * b->integer, h.name);
    *out = h;
    return RITZ_OK;
}

/* Numbers in the columns ahead, at most: what to make room for. */
static int64_t count_numbers(const ritz_binary *b, int64_t ncol)
{
    ritz_binary ahead = *b;
    int64_t count = 0;

    for (;;) {
        int64_t left = ahead.end - ahead.at;
        int64_t size = 0;

        if (left < 2 * b->mark)
            return count;
        size = load_integer(b, ahead.at, b->mark);
        if (size < 0 || size > left - 2 * b->mark)
            return count;
        if (size >= b->integer &&
            load_integer(b, ahead.at + b->mark, b->integer) > ncol)
            return count;
        if (size > 3 * b->integer)
            count += (size - 3 * b->integer) / b->real;
        ahead.at += size + 2 * b->mark;
    }
}

/* ---- columns ------------------------------------------------------------ */

/* 8 bytes as an unsigned number, in a form that compiles to one instruction. */
static uint64_t load_8(const unsigned char *at, bool big_endian)
{
    uint64_t up = (uint64_t)at[0] | (uint64_t)at[1] << 8 |
                  (uint64_t)at[2] << 16 | (uint64_t)at[3] << 24 |
                  (uint64_t)at[4] << 32 | (uint64_t)at[5] << 40 |
                  (uint64_t)at[6] << 48 | (uint64_t)at[7] << 56;

    return big_endian ? load_bits(at, 8, true) : up;
}

static double load_real(const ritz_binary *b, const unsigned char *at)
{
    double wide = 0.0;
    float narrow = 0.0F;
    uint64_t bits = 0;
    uint32_t half = 0;

    if (b->real == 4) {
        half = (uint32_t)load_bits(at, 4, b->big_endian);
        memcpy(&narrow, &half, sizeof narrow);
        return (double)narrow;
    }
    bits = load_8(at, b->big_endian);
    memcpy(&wide, &bits, sizeof wide);
    return wide;
}

static ritz_status read_numbers(const ritz_binary *b, ritz_output4_build *build,
                                const unsigned char *at, int64_t row,
                                int64_t reals)
{
    int64_t count = reals / build->numbers;
    bool complex = build->numbers == 2;

    RITZ_CHECK(ritz_output4_rows(build, row, count));
    for (int64_t k = 0; k < count; k++) {
        double re = load_real(b, at);
        double im = complex ? load_real(b, at + b->real) : 0.0;

        if (!isfinite(re) || !isfinite(im))
            RITZ_CHECK(ritz_output4_infinite(build, row + k));
        ritz_output4_put(build, row + k, re, im);
        at += build->numbers * b->real;
    }
    return RITZ_OK;
}

/* The strings that fill `data`, by one reading of their headers. */
static ritz_status read_strings(const ritz_binary *b, ritz_output4_build *build,
                                int64_t rule, const ritz_binary_record *data)
{
    int64_t words = data->size / b->integer;
    int64_t integers = ritz_output4_integers(rule);
    const unsigned char *at = data->at;

    for (int64_t left = words; left > 0;) {
        ritz_output4_string string = {0};
        int64_t n[2] = {0};

        for (int64_t k = 0; k < integers && k < left; k++)
            n[k] = load_integer(b, at + k * b->integer, b->integer);
        RITZ_REFUSE_IF(!ritz_output4_decode(build, rule, b->real / b->integer,
                                            n, left, &string),
                       RITZ_ERR_FORMAT,
                       "byte %td: strings of column %" PRId64
                       " of '%s' do not add up to %" PRId64 " words",
                       at - b->begin, build->column + 1, build->header.name,
                       words);
        RITZ_CHECK(read_numbers(b, build, at + integers * b->integer,
                                string.row, string.reals));
        at += string.words * b->integer;
        left -= string.words;
    }
    return RITZ_OK;
}

/* The reading whose strings add up; if none, the first says what is wrong. */
static ritz_status read_sparse(const ritz_binary *b, ritz_output4_build *build,
                               const ritz_binary_record *data)
{
    ritz_status status = RITZ_OK;

    build->sparse = true;
    for (int64_t k = 0; k < RITZ_OUTPUT4_RULES; k++) {
        int64_t rule = ritz_output4_rule(build, k);

        ritz_output4_rewind(build);
        status = read_strings(b, build, rule, data);
        if (status != RITZ_ERR_FORMAT) {
            build->rule = rule;
            return status;
        }
    }
    ritz_output4_rewind(build);
    return read_strings(b, build, ritz_output4_rule(build, 0), data);
}

/* A dense column; NW may count words or numbers, but must fit the record. */
static ritz_status read_dense(const ritz_binary *b, ritz_output4_build *build,
                              const ritz_binary_record *data, int64_t row,
                              int64_t words)
{
    int64_t reals = data->size / b->real;

    RITZ_REFUSE_IF(data->size % (b->real * build->numbers) != 0,
                   RITZ_ERR_FORMAT,
                   "column %" PRId64 " of '%s' holds part of a value",
                   build->column + 1, build->header.name);
    RITZ_REFUSE_IF(
        words != data->size / b->integer && words != reals, RITZ_ERR_FORMAT,
        "column %" PRId64 " of '%s' is said to hold %" PRId64
        " words, but its record %" PRId64,
        build->column + 1, build->header.name, words, data->size / b->integer);
    return read_numbers(b, build, data->at, row, reals);
}

/* One record after the header; `last` if it ends the matrix. */
static ritz_status read_column(ritz_binary *b, ritz_output4_build *build,
                               bool *last)
{
    ritz_binary_record column = {0};
    ritz_binary_record data = {0};
    int64_t n[3] = {0};

    RITZ_CHECK(take_record(b, &column));
    RITZ_REFUSE_IF(column.size < 0, RITZ_ERR_FORMAT,
                   "'%s' ends after column %" PRId64 " of %" PRId64,
                   build->header.name, build->column + 1, build->header.ncol);
    RITZ_REFUSE_IF(column.size < 3 * b->integer, RITZ_ERR_FORMAT,
                   "byte %td: a record of %" PRId64
                   " bytes is no column of '%s'",
                   column.at - b->begin, column.size, build->header.name);
    for (int64_t k = 0; k < 3; k++)
        n[k] = load_integer(b, column.at + k * b->integer, b->integer);
    data.at = column.at + 3 * b->integer;
    data.size = column.size - 3 * b->integer;
    *last = n[0] == build->header.ncol + 1;
    if (*last)
        return RITZ_OK;
    RITZ_CHECK(ritz_output4_column(build, n[0]));
    RITZ_REFUSE_IF(n[1] < 0 || n[1] > build->header.nrow ||
                       data.size % b->integer != 0,
                   RITZ_ERR_FORMAT,
                   "column %" PRId64 " of '%s' begins at row %" PRId64
                   ", but the matrix has %" PRId64 " rows",
                   n[0], build->header.name, n[1], build->header.nrow);
    if (n[1] == 0)
        RITZ_CHECK(read_sparse(b, build, &data));
    else
        RITZ_CHECK(read_dense(b, build, &data, n[1] - 1, n[2]));
    return RITZ_OK;
}

/* The matrix whose header was taken. */
static ritz_status read_columns(ritz_binary *b,
                                const ritz_output4_header *header,
                                ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    ritz_output4_build build = {0};
    bool last = false;

    b->real = header->type % 2 == 1 && b->integer == 4 ? 4 : 8;
    RITZ_TRY(ritz_output4_begin(
        header, b->end - b->begin,
        count_numbers(b, header->ncol) / (header->type > 2 ? 2 : 1), &build));
    while (!last)
        RITZ_TRY(read_column(b, &build, &last));
    build.matrix.digits = b->real == 4 ? 7 : 17;
    snprintf(build.matrix.spelling, sizeof build.matrix.spelling,
             "OUTPUT4 binary, %s, %s-endian, %d-byte integers",
             !build.sparse    ? "dense"
             : header->bigmat ? "bigmat"
                              : "sparse",
             b->big_endian ? "big" : "little", (int)b->integer);
    RITZ_TRY(ritz_output4_end(&build, out));
done:
    ritz_matrix_free(&build.matrix);
    return status;
}

bool ritz_output4_is_binary(const char *bytes, int64_t size)
{
    ritz_binary b = {0};

    return find_spelling(bytes, size, &b);
}

/* ---- directory ---------------------------------------------------------- */

/* Move behind a matrix by its records alone; false if these do not fit. */
static bool skip_columns(ritz_binary *b, const ritz_output4_header *header)
{
    ritz_binary_record column = {0};
    int64_t last = 0;

    while (last <= header->ncol) {
        int64_t number = 0;

        if (take_record(b, &column) != RITZ_OK || !column.at ||
            column.size < 3 * b->integer)
            return false;
        number = load_integer(b, column.at, b->integer);
        if (number <= last || number > header->ncol + 1)
            return false;
        last = number;
    }
    return true;
}

/* Where records do not lead behind a matrix, or values are to be checked, it is
 * read. */
static ritz_status pass_matrix(ritz_binary *b,
                               const ritz_output4_header *header, bool check)
{
    ritz_status status = RITZ_OK;
    ritz_binary ahead = *b;
    ritz_matrix unused = {0};

    if (!check && skip_columns(&ahead, header))
        *b = ahead;
    else
        status = read_columns(b, header, &unused);
    ritz_matrix_free(&unused);
    return status;
}

ritz_status ritz_output4_list_binary(const ritz_foreign *file, bool check,
                                     ritz_listing *out)
{
    ritz_binary b = {0};
    ritz_binary_record first = {0};
    ritz_output4_header header = {0};

    (void)find_spelling(file->bytes, file->size, &b);
    for (;;) {
        int64_t at = b.at - b.begin;

        RITZ_CHECK(take_record(&b, &first));
        if (first.size < 0)
            return RITZ_OK;
        RITZ_CHECK(take_header(&b, &first, &header));
        RITZ_CHECK(ritz_output4_list(out, &header, at, 0));
        RITZ_CHECK(pass_matrix(&b, &header, check));
    }
}

ritz_status ritz_output4_read_binary(const ritz_foreign *file,
                                     const ritz_listed *which, ritz_matrix *out)
{
    ritz_binary b = {0};
    ritz_binary_record first = {0};
    ritz_output4_header header = {0};

    (void)find_spelling(file->bytes, file->size, &b);
    b.at = b.begin + which->at;
    RITZ_CHECK(take_record(&b, &first));
    RITZ_REFUSE_IF(first.size < 0, RITZ_ERR_FORMAT,
                   "byte %td: no matrix begins here", b.at - b.begin);
    RITZ_CHECK(take_header(&b, &first, &header));
    return read_columns(&b, &header, out);
}
