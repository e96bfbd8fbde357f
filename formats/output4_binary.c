/* NASTRAN OUTPUT4 as binary records. */
#include "formats/bytes.h"
#include "formats/output4_strings.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/*
 * Append @p count real values, little-endian doubles at @p at, from row @p row
 * on, if all are finite and none is zero. There is room for them.
 *
 * @return false, and nothing is appended, if that is not so
 */
static bool put_doubles(ritz_output4_build *build, int64_t row, int64_t count,
                        const char *at)
{
    ritz_triplets *to = &build->entries;
    double *re = to->re + to->count;
    bool usual = true;

    memcpy(re, at, (size_t)count * sizeof *re);
    for (int64_t k = 0; k < count; k++) {
        const bool is = isfinite(re[k]) && re[k] != 0.0;

        to->row[to->count + k] = row + k;
        usual = usual && is;
    }
    if (!usual)
        return false;
    to->counts[build->column + 1] += count;
    to->count += count;
    return true;
}

/* ---- binary ------------------------------------------------------------- */

/*
 * Unformatted records of Fortran: length, bytes, length again.
 *
 *     NCOL NROW FORM TYPE NAME(2 words)    24 bytes, or 48 of 8-byte integers
 *     ICOL IROW NW data                    IROW = 0: data are strings
 *
 * Data fill their record: where NW disagrees the record is right. Byte order
 * and size of integers follow from the first length. Lengths are integers of 4
 * bytes, of 8 by some compilers; records of no bytes may stand between others.
 */

typedef struct ritz_binary_record {
    const char *at;
    int64_t size;
} ritz_binary_record;

/** @p size bytes, 4 or 8, as an integer. */
static inline int64_t load_integer(const ritz_output4_reader *b, const char *at,
                                   int64_t size)
{
    uint64_t bits =
        ritz_bytes_bits((const unsigned char *)at, size, b->big_endian);

    return size == 4 ? (int64_t)(int32_t)(uint32_t)bits : (int64_t)bits;
}

/** @p count integers one after the other. */
static void load_integers(const ritz_output4_reader *b, const char *at,
                          int64_t count, int64_t *out)
{
    for (int64_t k = 0; k < count; k++)
        out[k] = load_integer(b, at + k * b->integer, b->integer);
}

/* How the file is spelled, from the length of its first record. */
static bool find_records(ritz_output4_reader *b)
{
    int64_t size = b->text.end - b->begin;

    for (int k = 0; k < 8 && size >= 4; k++) {
        b->big_endian = k & 1;
        b->integer = k & 2 ? 8 : 4;
        b->mark = k & 4 ? 4 : 8;
        if (size >= b->mark &&
            load_integer(b, b->begin, b->mark) == 6 * b->integer)
            return true;
    }
    return false;
}

/* Take a record that is not empty; its size is -1 at the end of the file. */
static ritz_status take_record(ritz_output4_reader *b, ritz_binary_record *out)
{
    int64_t size = 0;

    while (size == 0) {
        int64_t left = b->text.end - b->text.at;

        *out = (ritz_binary_record){.size = -1};
        if (left == 0)
            return RITZ_OK;
        RITZ_REFUSE_IF(left < 2 * b->mark, RITZ_ERR_FORMAT,
                       "byte %td: %" PRId64 " bytes are left, too few for "
                       "a record",
                       b->text.at - b->begin, left);
        size = load_integer(b, b->text.at, b->mark);
        RITZ_REFUSE_IF(size < 0 || size > left - 2 * b->mark, RITZ_ERR_FORMAT,
                       "byte %td: a record of %" PRId64
                       " bytes begins, but %" PRId64 " are left",
                       b->text.at - b->begin, size, left - b->mark);
        *out = (ritz_binary_record){b->text.at + b->mark, size};
        b->text.at += size + 2 * b->mark;
        RITZ_REFUSE_IF(load_integer(b, b->text.at - b->mark, b->mark) != size,
                       RITZ_ERR_FORMAT,
                       "byte %td: a record of %" PRId64
                       " bytes ends with another length",
                       b->text.at - b->mark - b->begin, size);
    }
    return RITZ_OK;
}

static ritz_status take_record_header(ritz_output4_reader *b,
                                      ritz_output4_header *out, bool *found)
{
    int64_t at = b->text.at - b->begin;
    ritz_binary_record first = {0};
    int64_t n[4] = {0};

    RITZ_CHECK(take_record(b, &first));
    *found = first.size >= 0;
    if (!*found)
        return RITZ_OK;
    if (first.size == 6 * b->integer)
        load_integers(b, first.at, 4, n);
    RITZ_REFUSE_IF(!ritz_output4_set_header(n, first.at + 4 * b->integer,
                                            2 * b->integer, out),
                   RITZ_ERR_FORMAT,
                   "byte %td: a record of %" PRId64 " bytes begins no matrix",
                   first.at - b->begin, first.size);
    out->at = at;
    b->real = out->type % 2 == 1 && b->integer == 4 ? 4 : 8;
    b->digits = b->real == 4 ? 7 : 17;
    b->wide = b->real / b->integer;
    b->widths = 1;
    snprintf(b->format, sizeof b->format, "%s-endian, %d-byte integers",
             b->big_endian ? "big" : "little", (int)b->integer);
    return RITZ_OK;
}

static double load_real(const ritz_output4_reader *b, const char *at)
{
    const unsigned char *bytes = (const unsigned char *)at;

    return b->real == 4 ? ritz_bytes_single(bytes, b->big_endian)
                        : ritz_bytes_double(bytes, b->big_endian);
}

/* One record after the header. */
static ritz_status take_record_column(ritz_output4_reader *b,
                                      const ritz_output4_build *build,
                                      int64_t n[3])
{
    ritz_binary_record column = {0};
    bool whole = false;

    RITZ_CHECK(take_record(b, &column));
    RITZ_REFUSE_IF(column.size < 0, RITZ_ERR_FORMAT,
                   "'%s' ends after column %" PRId64 " of %" PRId64,
                   build->header.name, build->column + 1, build->header.ncol);
    whole = column.size >= 3 * b->integer;
    if (whole)
        load_integers(b, column.at, 3, n);
    RITZ_REFUSE_IF(
        !whole || (n[0] <= build->header.ncol && column.size % b->integer != 0),
        RITZ_ERR_FORMAT,
        "byte %td: a record of %" PRId64 " bytes is no column of '%s'",
        column.at - b->begin, column.size, build->header.name);
    b->data = column.at + 3 * b->integer;
    b->data_end = column.at + column.size;
    if (n[1] == 0)
        n[2] = (b->data_end - b->data) / b->integer;
    return RITZ_OK;
}

static ritz_status read_record_numbers(ritz_output4_reader *b,
                                       ritz_output4_build *build, int64_t row,
                                       int64_t reals)
{
    int64_t numbers = build->header.numbers;

    RITZ_CHECK(ritz_output4_begin_rows(build, row, reals / numbers));
    if (__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ && !b->big_endian &&
        b->real == 8 && numbers == 1 && reals > 0 &&
        put_doubles(build, row, reals, b->data)) {
        b->data += reals * b->real;
        return RITZ_OK;
    }
    for (int64_t k = 0; k < reals; k += numbers) {
        double re = load_real(b, b->data);
        double im = numbers == 2 ? load_real(b, b->data + b->real) : 0.0;

        RITZ_CHECK(ritz_output4_put_value(build, row++, re, im));
        b->data += numbers * b->real;
    }
    return RITZ_OK;
}

static ritz_status take_record_string(ritz_output4_reader *b,
                                      const ritz_output4_build *build,
                                      int64_t words, int64_t left,
                                      ritz_output4_string *out)
{
    int64_t integers = ritz_output4_count_integers(build);
    int64_t n[2] = {0};

    load_integers(b, b->data, integers < left ? integers : left, n);
    RITZ_REFUSE_IF(!ritz_output4_decode_string(build, n, left, out),
                   RITZ_ERR_FORMAT,
                   "byte %td: strings of %s do not add up to %" PRId64 " words",
                   b->data - b->begin, build->where, words);
    b->data += integers * b->integer;
    return RITZ_OK;
}

/* NW may count words or numbers, but must fit the record. */
static ritz_status read_record_dense(ritz_output4_reader *b,
                                     ritz_output4_build *build,
                                     const int64_t n[3])
{
    int64_t size = b->data_end - b->data;
    int64_t words = size / b->integer;
    int64_t reals = size / b->real;

    RITZ_REFUSE_IF(n[1] < 0 || n[1] > build->header.nrow, RITZ_ERR_FORMAT,
                   "%s begins at row %" PRId64 ", but the matrix has %" PRId64
                   " rows",
                   build->where, n[1], build->header.nrow);
    RITZ_REFUSE_IF(size % (b->real * build->header.numbers) != 0,
                   RITZ_ERR_FORMAT, "%s holds part of a value", build->where);
    RITZ_REFUSE_IF(n[2] != words && n[2] != reals, RITZ_ERR_FORMAT,
                   "%s is said to hold %" PRId64
                   " words, but its record %" PRId64,
                   build->where, n[2], words);
    return read_record_numbers(b, build, n[1] - 1, reals);
}

/* ---- the usual strings -------------------------------------------------- */

/*
 * Nearly all large files hold real doubles behind pairs of integers, in the
 * byte order of the processor. Their strings, which may be single values, are
 * gone through in one loop each for counting and reading.
 */
static bool is_usual(const ritz_output4_reader *b,
                     const ritz_output4_build *build)
{
    return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ && !b->big_endian &&
           b->integer == 4 && b->real == 8 && build->header.numbers == 1 &&
           build->wide == 2 && build->rule == RITZ_OUTPUT4_BIGMAT;
}

/* A string at @p at, of which the column has @p left words. @return how many
 * values it has, at least 1; 0 if it is not possible */
static inline int64_t take_usual(const char *at, int64_t left, int64_t nrow,
                                 int64_t *row)
{
    int32_t pair[2];
    int64_t values = 0;

    if (left < 4)
        return 0;
    memcpy(pair, at, sizeof pair);
    values = pair[0] / 2;
    *row = (int64_t)pair[1] - 1;
    return pair[0] % 2 == 1 && pair[0] > 1 && 2 * values + 2 <= left &&
                   *row >= 0 && *row + values <= nrow
               ? values
               : 0;
}

static int64_t count_usual(const char *at, int64_t words, int64_t nrow)
{
    int64_t count = 0;

    for (int64_t left = words; left > 0;) {
        int64_t row = 0;
        const int64_t values = take_usual(at, left, nrow, &row);

        if (values == 0)
            return -1;
        count += values;
        at += 8 * (values + 1);
        left -= 2 * (values + 1);
    }
    return count;
}

/* Copy values; false if one is zero or not finite. */
static inline bool copy_values(const char *at, int64_t row, int64_t count,
                               int64_t *rows, double *values)
{
    const uint64_t exponent = UINT64_C(0x7ff0000000000000);
    uint64_t unusual = 0;

    for (int64_t k = 0; k < count; k++) {
        uint64_t bits = 0;

        memcpy(&bits, at + 8 * k, 8);
        unusual |= (uint64_t)(bits << 1 == 0) |
                   (uint64_t)((bits & exponent) == exponent);
        memcpy(&values[k], &bits, 8);
        rows[k] = row + k;
    }
    return unusual == 0;
}

/* The column is left to others, as it was, if it has anything unusual. */
static bool read_usual(ritz_output4_reader *b, ritz_output4_build *build,
                       int64_t words)
{
    const int64_t nrow = build->header.nrow;
    ritz_triplets *to = &build->entries;
    const char *at = b->data;
    int64_t below = build->below, count = to->count;

    if (!is_usual(b, build))
        return false;
    for (int64_t left = words; left > 0;) {
        int64_t row = 0;
        const int64_t values = take_usual(at, left, nrow, &row);

        if (values == 0 || row < below || values > to->room - count ||
            !copy_values(at + 8, row, values, to->row + count, to->re + count))
            return false;
        below = row + values;
        count += values;
        at += 8 * (values + 1);
        left -= 2 * (values + 1);
    }
    b->data = at;
    build->below = below;
    to->counts[build->column + 1] = count - to->count;
    to->count = count;
    return true;
}

static int64_t count_record(ritz_output4_reader *b,
                            const ritz_output4_build *build, const int64_t n[3])
{
    const int64_t integers = ritz_output4_count_integers(build);
    int64_t reals = 0;

    if (n[1] != 0)
        return (b->data_end - b->data) / (b->real * build->header.numbers);
    if (is_usual(b, build))
        return count_usual(b->data, n[2], build->header.nrow);
    for (int64_t left = n[2]; left > 0;) {
        ritz_output4_string string = {0};
        int64_t header[2] = {0};

        load_integers(b, b->data, integers < left ? integers : left, header);
        if (!ritz_output4_decode_string(build, header, left, &string))
            return -1;
        b->data += integers * b->integer + string.reals * b->real;
        reals += string.reals;
        left -= string.words;
    }
    return reals / build->header.numbers;
}

const ritz_output4_spelling ritz_output4_binary = {
    .name = "binary",
    .recognise = find_records,
    .take_header = take_record_header,
    .take_column = take_record_column,
    .read_dense = read_record_dense,
    .take_string = take_record_string,
    .read_numbers = read_record_numbers,
    .count_column = count_record,
    .read_usual = read_usual,
};
