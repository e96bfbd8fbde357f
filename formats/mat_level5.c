/*
 * MAT Level 5: a head of 128 bytes, and then data elements,
 *
 *     type (4 bytes), number of bytes (4 bytes), the bytes, padded to 8
 *
 * or, of up to 4 bytes, number and type in one word and the bytes behind. At
 * the top there are arrays, or arrays deflated.
 */
#include "formats/mat.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum {
    HEAD = 128,
    VERSION = 124,
    LEVEL_5 = 0x0100,
    MOST_RATIO = 1032, /* that deflate can reach */
};

/* The version, whichever way its bytes lie; 0 if that is no such file. */
static int version_of(const char *bytes, int64_t size, bool *swap)
{
    const unsigned char *at = (const unsigned char *)bytes + VERSION;

    if (size < HEAD || !bytes[0] || !bytes[1] || !bytes[2] || !bytes[3])
        return 0;
    if (memcmp(at + 2, "IM", 2) != 0 && memcmp(at + 2, "MI", 2) != 0)
        return 0;
    *swap = at[2] == 'M'; /* it was written as a number, "MI" of big endian */
    return (int)ritz_mat_bits(at, 2, *swap);
}

bool ritz_mat_is_level5(const char *bytes, int64_t size)
{
    bool swap = false;

    return version_of(bytes, size, &swap) == LEVEL_5;
}

ritz_status ritz_mat_take(ritz_mat_reader *r, ritz_mat_element *out)
{
    int64_t left = r->end - r->at;
    int64_t where = r->at - r->begin;
    uint64_t first = 0;
    int64_t length = 0;

    RITZ_REFUSE_IF(left < 8, RITZ_ERR_FORMAT,
                   "byte %" PRId64 ": an element begins, but %" PRId64
                   " bytes are left",
                   where, left);
    first = ritz_mat_bits(r->at, 4, r->swap);
    if (first >> 16) { /* small */
        length = (int64_t)(first >> 16);
        RITZ_REFUSE_IF(length > 4, RITZ_ERR_FORMAT,
                       "byte %" PRId64 ": an element of %" PRId64
                       " bytes where 4 have room",
                       where, length);
        *out = (ritz_mat_element){(int)(first & 0xffff), r->at + 4, length};
        r->at += 8;
        return RITZ_OK;
    }
    length = (int64_t)ritz_mat_bits(r->at + 4, 4, r->swap);
    RITZ_REFUSE_IF(length > left - 8, RITZ_ERR_FORMAT,
                   "byte %" PRId64 ": an element of %" PRId64
                   " bytes begins, but %" PRId64 " are left",
                   where, length, left - 8);
    *out = (ritz_mat_element){(int)first, r->at + 8, length};
    r->at += 8 + length;
    if (first != RITZ_MAT_COMPRESSED)
        r->at += (8 - length % 8) % 8;
    if (r->at > r->end)
        r->at = r->end; /* the last one may come without its padding */
    return RITZ_OK;
}

/* Inflate until `room` bytes stand in out; the number that do. */
static int64_t inflate_into(z_stream *stream, unsigned char *out, int64_t room)
{
    stream->next_out = out;
    stream->avail_out = (uInt)room;
    (void)inflate(stream, Z_NO_FLUSH);
    return room - (int64_t)stream->avail_out;
}

/* All of it, the end of the stream and its checksum included. */
static ritz_status inflate_rest(z_stream *stream, unsigned char *out,
                                int64_t room)
{
    int64_t done_bytes = 0;
    int last = Z_OK;

    while (last == Z_OK && done_bytes < room) {
        int64_t piece = room - done_bytes;

        piece = piece < INT32_MAX ? piece : INT32_MAX;
        stream->next_out = out + done_bytes;
        stream->avail_out = (uInt)piece;
        last = inflate(stream, Z_NO_FLUSH);
        done_bytes += piece - (int64_t)stream->avail_out;
    }
    RITZ_REFUSE_IF(last != Z_STREAM_END || done_bytes + 1 != room,
                   RITZ_ERR_FORMAT, "compressed data are damaged");
    return RITZ_OK;
}

/* The element that a compressed one holds, whole, with its tag. */
static ritz_status expand(const ritz_mat_element *packed, bool swap,
                          int64_t *size, unsigned char **out)
{
    ritz_status status = RITZ_OK;
    z_stream stream = {0};
    unsigned char tag[8];
    unsigned char *bytes = NULL;
    bool begun = false;

    memcpy(&stream.next_in, &packed->at, sizeof packed->at); /* not const */
    stream.avail_in = (uInt)packed->bytes;
    begun = inflateInit(&stream) == Z_OK;
    RITZ_FAIL_IF(!begun, RITZ_ERR_MEMORY, "no memory to inflate");
    RITZ_FAIL_IF(inflate_into(&stream, tag, sizeof tag) != sizeof tag,
                 RITZ_ERR_FORMAT, "compressed data are damaged");
    *size = (int64_t)sizeof tag + (int64_t)ritz_mat_bits(tag + 4, 4, swap);
    RITZ_FAIL_IF(*size / MOST_RATIO > packed->bytes, RITZ_ERR_FORMAT,
                 "declares %" PRId64 " bytes, which %" PRId64
                 " cannot be inflated to",
                 *size, packed->bytes);
    RITZ_NEW(bytes, *size + 1); /* one more, to see that there is no more */
    memcpy(bytes, tag, sizeof tag);
    RITZ_TRY(inflate_rest(&stream, bytes + sizeof tag,
                          *size + 1 - (int64_t)sizeof tag));
    *out = bytes;
    bytes = NULL;
done:
    if (begun)
        inflateEnd(&stream);
    free(bytes);
    return status;
}

/* An array, or a compressed one; other elements are not known here. */
static ritz_status read_element(const ritz_mat_element *e, bool swap,
                                ritz_mat_list *list)
{
    ritz_status status = RITZ_OK;
    ritz_mat_reader inside = {e->at, e->at, e->at + e->bytes, swap};
    ritz_mat_element array = *e;
    unsigned char *bytes = NULL;
    int64_t size = 0;

    if (e->type == RITZ_MAT_COMPRESSED) {
        RITZ_TRY(expand(e, swap, &size, &bytes));
        inside = (ritz_mat_reader){bytes, bytes, bytes + size, swap};
        RITZ_TRY(ritz_mat_take(&inside, &array));
    }
    RITZ_FAIL_IF(array.type != RITZ_MAT_MATRIX, RITZ_ERR_FORMAT,
                 "an element of type %d where an array is due", array.type);
    inside =
        (ritz_mat_reader){array.at, array.at, array.at + array.bytes, swap};
    RITZ_TRY(ritz_mat_read_array(&inside, list));
done:
    free(bytes);
    return status;
}

ritz_status ritz_mat_read_level5(const char *bytes, int64_t size,
                                 ritz_mat_list *list)
{
    const unsigned char *begin = (const unsigned char *)bytes;
    ritz_mat_reader r = {begin, begin + HEAD, begin + size, false};
    char where[RITZ_NAME_SIZE];

    (void)version_of(bytes, size, &r.swap);
    while (r.at < r.end) {
        ritz_mat_element e = {0};

        snprintf(where, sizeof where, "byte %" PRId64, (int64_t)(r.at - begin));
        RITZ_CHECK(ritz_mat_take(&r, &e));
        RITZ_CHECK_IN(where, read_element(&e, r.swap, list));
    }
    return RITZ_OK;
}
