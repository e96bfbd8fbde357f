/*
 * Records as Fortran writes them unformatted: length, bytes, length again. Byte
 * order and size of integers follow from the first length. Lengths are integers
 * of 4 bytes, of 8 by some compilers; records of no bytes may stand between
 * others.
 */
#include "formats/output4_binary.h"

#include <inttypes.h>

bool ritz_binary_spelling(const char *bytes, int64_t size, ritz_binary *out)
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
            ritz_binary_load(b.at, b.mark, b.big_endian) != (uint64_t)length)
            continue;
        *out = b;
        return true;
    }
    return false;
}

ritz_status ritz_binary_take(ritz_binary *b, ritz_binary_record *out)
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
        size = ritz_binary_integer(b, b->at, b->mark);
        RITZ_REFUSE_IF(size < 0 || size > left - 2 * b->mark, RITZ_ERR_FORMAT,
                       "byte %td: a record of %" PRId64
                       " bytes begins, but %" PRId64 " are left",
                       b->at - b->begin, size, left - b->mark);
        *out = (ritz_binary_record){b->at + b->mark, size};
        b->at += size + 2 * b->mark;
        RITZ_REFUSE_IF(ritz_binary_integer(b, b->at - b->mark, b->mark) != size,
                       RITZ_ERR_FORMAT,
                       "byte %td: a record of %" PRId64
                       " bytes ends with another length",
                       b->at - b->mark - b->begin, size);
    }
    return RITZ_OK;
}

ritz_status ritz_binary_header(const ritz_binary *b,
                               const ritz_binary_record *from,
                               ritz_output4_header *out)
{
    ritz_output4_header h = {0};
    int64_t n[4] = {0};
    const void *name = from->at + 4 * b->integer;

    for (int64_t k = 0; k < 4 && from->size == 6 * b->integer; k++)
        n[k] = ritz_binary_integer(b, from->at + k * b->integer, b->integer);
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

int64_t ritz_binary_numbers(const ritz_binary *b, int64_t ncol)
{
    ritz_binary ahead = *b;
    int64_t count = 0;

    for (;;) {
        int64_t left = ahead.end - ahead.at;
        int64_t size = 0;

        if (left < 2 * b->mark)
            return count;
        size = ritz_binary_integer(b, ahead.at, b->mark);
        if (size < 0 || size > left - 2 * b->mark)
            return count;
        if (size >= b->integer &&
            ritz_binary_integer(b, ahead.at + b->mark, b->integer) > ncol)
            return count;
        if (size > 3 * b->integer)
            count += (size - 3 * b->integer) / b->real;
        ahead.at += size + 2 * b->mark;
    }
}
