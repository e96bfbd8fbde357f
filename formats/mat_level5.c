/*
 * MAT Level 5: a head of 128 bytes, and then data elements,
 *
 *     type (4 bytes), number of bytes (4 bytes), the bytes, padded to 8
 *
 * or, of up to 4 bytes, number and type in one word and the bytes behind. At
 * the top there are arrays, or arrays deflated.
 */
#include "base/alloc.h"
#include "formats/mat.h"

#include <zlib.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of Level 5 that are gone through element by element. */
typedef struct mat_reader {
    const unsigned char *begin, *at, *end;
    bool swap;
} mat_reader;

typedef struct mat_element {
    int type;
    const unsigned char *at;
    int64_t bytes;
} mat_element;

/* ---- elements of the file ----------------------------------------------- */

enum {
    HEAD = 128,
    VERSION = 124,
    LEVEL_5 = 0x0100,
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
    return (int)ritz_bytes_bits(at, 2, *swap);
}

bool ritz_mat_is_level5(const char *bytes, int64_t size)
{
    bool swap = false;

    return version_of(bytes, size, &swap) == LEVEL_5;
}

/* Take the next element. @return RITZ_ERR_FORMAT if it is not all there */
static ritz_status take_element(mat_reader *r, mat_element *out)
{
    int64_t left = r->end - r->at;
    int64_t where = r->at - r->begin;
    uint64_t first = 0;
    int64_t length = 0;

    RITZ_REFUSE_IF(left < 8, RITZ_ERR_FORMAT,
                   "byte %" PRId64 ": an element begins, but %" PRId64
                   " bytes are left",
                   where, left);
    first = ritz_bytes_bits(r->at, 4, r->swap);
    if (first >> 16) { /* small */
        length = (int64_t)(first >> 16);
        RITZ_REFUSE_IF(length > 4, RITZ_ERR_FORMAT,
                       "byte %" PRId64 ": an element of %" PRId64
                       " bytes where 4 have room",
                       where, length);
        *out = (mat_element){(int)(first & 0xffff), r->at + 4, length};
        r->at += 8;
        return RITZ_OK;
    }
    length = (int64_t)ritz_bytes_bits(r->at + 4, 4, r->swap);
    RITZ_REFUSE_IF(length > left - 8, RITZ_ERR_FORMAT,
                   "byte %" PRId64 ": an element of %" PRId64
                   " bytes begins, but %" PRId64 " are left",
                   where, length, left - 8);
    *out = (mat_element){(int)first, r->at + 8, length};
    r->at += 8 + length;
    if (first != RITZ_MAT_COMPRESSED)
        r->at += (8 - length % 8) % 8;
    if (r->at > r->end)
        r->at = r->end; /* the last one may come without its padding */
    return RITZ_OK;
}

/* ---- the inside of an array --------------------------------------------- */

/*
 * Flags, dimensions, name, and then by class
 *
 *     numbers  real part, imaginary part if flagged, by columns, in any type
 *     sparse   rows, starts of columns, real part, imaginary part
 *     struct   length of field names, field names, an array for each
 */

enum {
    CLASS_CELL = 1,
    CLASS_STRUCT,
    CLASS_OBJECT,
    CLASS_TEXT,
    CLASS_SPARSE,
    CLASS_DOUBLE,
    CLASS_SINGLE,
    CLASS_LAST_NUMBER = 15,
    CLASS_FUNCTION,
    CLASS_OPAQUE,
    FLAG_COMPLEX = 0x0800,
    JOINED = 2 * RITZ_NAME_SIZE, /* "sys.A" before it is cut */
};

typedef struct mat_array {
    int class;
    bool complex;
    int num_dims;
    int64_t nrow, ncol;
    char name[JOINED];
} mat_array;

/* An element of one type, of so many bytes; -1: any number. */
static ritz_status take_typed(mat_reader *r, const char *what, int type,
                              int64_t bytes, mat_element *out)
{
    RITZ_CHECK(take_element(r, out));
    RITZ_REFUSE_IF(out->type != type || (bytes >= 0 && out->bytes != bytes),
                   RITZ_ERR_FORMAT,
                   "%s are due, not %" PRId64 " bytes of type %d", what,
                   out->bytes, out->type);
    return RITZ_OK;
}

/* Values of any type. */
static ritz_status take_values(mat_reader *r, ritz_mat_values *out)
{
    mat_element e = {0};
    int64_t size = 0;

    RITZ_CHECK(take_element(r, &e));
    size = ritz_mat_size(e.type);
    RITZ_REFUSE_IF(size == 0, RITZ_ERR_FORMAT,
                   "values of type %d, which is none of numbers", e.type);
    *out = (ritz_mat_values){e.at, e.bytes / size, e.type, r->swap};
    return RITZ_OK;
}

/* The name in the file, after what it is a part of. */
static ritz_status join_names(const char *outer, const char *name,
                              int64_t length, char out[JOINED])
{
    char own[RITZ_NAME_SIZE] = "";
    char clean[RITZ_NAME_SIZE] = "";

    snprintf(own, sizeof own, "%.*s", (int)(length < 99 ? length : 99), name);
    if (*own && ritz_name_copy(own, clean) != RITZ_OK)
        return RITZ_ERR_FORMAT; /* it was said why */
    snprintf(out, JOINED, "%s%s%s", outer, *outer && *clean ? "." : "", clean);
    return RITZ_OK;
}

static ritz_status read_head(mat_reader *r, const char *outer, mat_array *out)
{
    mat_element e = {0};
    uint64_t flags = 0;

    RITZ_CHECK(take_typed(r, "array flags", RITZ_MAT_UINT32, 8, &e));
    flags = ritz_bytes_bits(e.at, 4, r->swap);
    out->class = (int)(flags & 0xff);
    out->complex = flags & FLAG_COMPLEX;
    out->nrow = out->ncol = 1;
    if (out->class != CLASS_OPAQUE) {
        RITZ_CHECK(take_typed(r, "dimensions", RITZ_MAT_INT32, -1, &e));
        out->num_dims = (int)(e.bytes / 4);
        RITZ_REFUSE_IF(out->num_dims < 2, RITZ_ERR_FORMAT,
                       "an array of %d dimensions", out->num_dims);
        out->nrow = (int32_t)(uint32_t)ritz_bytes_bits(e.at, 4, r->swap);
        out->ncol = (int32_t)(uint32_t)ritz_bytes_bits(e.at + 4, 4, r->swap);
        RITZ_REFUSE_IF(out->nrow < 0 || out->ncol < 0, RITZ_ERR_FORMAT,
                       "an array of %" PRId64 " x %" PRId64, out->nrow,
                       out->ncol);
    }
    RITZ_CHECK(take_typed(r, "a name's letters", RITZ_MAT_INT8, -1, &e));
    return join_names(outer, (const char *)e.at, e.bytes, out->name);
}

static ritz_status read_numbers(mat_reader *r, const mat_array *a,
                                ritz_mat_list *list)
{
    ritz_mat_entries e = {.nrow = a->nrow, .ncol = a->ncol};

    for (int k = 0; k < (a->complex ? 2 : 1); k++) {
        RITZ_CHECK(take_values(r, k ? &e.im : &e.re));
        e.count = k ? e.im.count : e.re.count;
        RITZ_REFUSE_IF(e.count / a->ncol != a->nrow || e.count % a->ncol != 0,
                       RITZ_ERR_FORMAT,
                       "'%s' is %" PRId64 " x %" PRId64 " and has %" PRId64
                       " values",
                       a->name, a->nrow, a->ncol, e.count);
    }
    return ritz_mat_add(list, a->name, &e);
}

static ritz_status read_sparse(mat_reader *r, const mat_array *a,
                               ritz_mat_list *list)
{
    ritz_mat_entries e = {.nrow = a->nrow, .ncol = a->ncol, .starts = true};
    double count = 0.0;

    RITZ_CHECK(take_values(r, &e.row));
    RITZ_CHECK(take_values(r, &e.col));
    RITZ_REFUSE_IF(e.col.count != a->ncol + 1, RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " columns and %" PRId64
                   " starts of columns",
                   a->name, a->ncol, e.col.count);
    count = ritz_mat_value(&e.col, a->ncol);
    RITZ_CHECK(take_values(r, &e.re));
    if (a->complex)
        RITZ_CHECK(take_values(r, &e.im));
    RITZ_REFUSE_IF(!(count >= 0.0 && count <= (double)e.row.count &&
                     count <= (double)e.re.count) ||
                       (a->complex && count > (double)e.im.count),
                   RITZ_ERR_FORMAT,
                   "'%s' declares %g entries, and has %" PRId64 " values",
                   a->name, count, e.re.count);
    e.count = (int64_t)count;
    return ritz_mat_add(list, a->name, &e);
}

/* An array that is to be read, and what it is a part of. */
typedef struct pending {
    mat_reader inside;
    int depth;
    char outer[RITZ_NAME_SIZE];
} pending;

/* Arrays that wait for their turn: those of a struct stand behind it. */
typedef struct queue {
    int64_t count, room;
    pending *item;
} queue;

static void queue_free(queue *waiting)
{
    free(waiting->item);
}

/* Queue the arrays of a struct under their joined names. */
static ritz_status read_struct(mat_reader *r, const mat_array *a, int depth,
                               queue *fields)
{
    mat_element names = {0};
    mat_element size = {0};
    int64_t length = 0;

    RITZ_CHECK(take_typed(r, "lengths of names", RITZ_MAT_INT32, 4, &size));
    length = (int32_t)(uint32_t)ritz_bytes_bits(size.at, 4, r->swap);
    RITZ_CHECK(take_typed(r, "names of fields", RITZ_MAT_INT8, -1, &names));
    RITZ_REFUSE_IF(length < 1 || names.bytes % length != 0, RITZ_ERR_FORMAT,
                   "'%s': %" PRId64 " bytes are no names of %" PRId64 " each",
                   a->name, names.bytes, length);
    for (int64_t k = 0; k < names.bytes / length; k++) {
        pending *field = NULL;
        mat_element e = {0};
        char whole[JOINED];

        RITZ_CHECK(take_element(r, &e));
        RITZ_REFUSE_IF(e.type != RITZ_MAT_MATRIX, RITZ_ERR_FORMAT,
                       "'%s': a field of type %d where an array is due",
                       a->name, e.type);
        RITZ_CHECK(join_names(a->name, (const char *)names.at + k * length,
                              length, whole));
        RITZ_CHECK_ROOM(fields->item, fields->count, fields->room);
        field = &fields->item[fields->count++];
        *field = (pending){.inside = {e.at, e.at, e.at + e.bytes, r->swap},
                           .depth = depth + 1};
        snprintf(field->outer, sizeof field->outer, "%.*s", RITZ_NAME_SIZE - 1,
                 whole);
    }
    return RITZ_OK;
}

/* Why an array is no matrix, or NULL. */
static const char *why_none(const mat_array *a, int depth)
{
    static const char *const classes[] = {
        [CLASS_CELL] = "a cell array", [CLASS_OBJECT] = "an object",
        [CLASS_TEXT] = "text",         [CLASS_FUNCTION] = "a function",
        [CLASS_OPAQUE] = "an object",
    };

    if (a->class < CLASS_CELL || a->class > CLASS_OPAQUE)
        return "of an unknown class";
    if (classes[a->class])
        return classes[a->class];
    if (a->num_dims > 2)
        return "an array of more than two dimensions";
    if (a->nrow == 0 || a->ncol == 0)
        return "empty";
    if (a->class == CLASS_STRUCT && (a->nrow != 1 || a->ncol != 1))
        return "an array of structs";
    if (a->class == CLASS_STRUCT && depth >= RITZ_MAT_DEPTH)
        return "a struct, too deep in others";
    return NULL;
}

/* Read a matrix, list another variable, or queue the fields of a struct. */
static ritz_status read_one(pending *p, ritz_mat_list *list, queue *fields)
{
    mat_reader *r = &p->inside;
    mat_array a = {0};
    const char *why = NULL;

    if (r->at == r->end) /* an empty field is nothing but its tag */
        return *p->outer ? ritz_mat_add_other(list, p->outer, "empty")
                         : RITZ_OK;
    RITZ_CHECK(read_head(r, p->outer, &a));
    if (!*a.name)
        return RITZ_OK; /* what MATLAB keeps for itself */
    a.name[RITZ_NAME_SIZE - 1] = '\0';
    why = why_none(&a, p->depth);
    if (why)
        return ritz_mat_add_other(list, a.name, why);
    if (a.class == CLASS_STRUCT)
        return read_struct(r, &a, p->depth, fields);
    return a.class == CLASS_SPARSE ? read_sparse(r, &a, list)
                                   : read_numbers(r, &a, list);
}

/* The inside of an array element, and of structs in it. */
static ritz_status read_array(const mat_reader *reader, ritz_mat_list *list)
{
    RITZ_OWN(queue) waiting = {0};

    RITZ_CHECK_ROOM(waiting.item, waiting.count, waiting.room);
    waiting.item[waiting.count++] = (pending){.inside = *reader};
    for (int64_t k = 0; k < waiting.count; k++) {
        pending turn = waiting.item[k];

        RITZ_CHECK(read_one(&turn, list, &waiting));
    }
    return RITZ_OK;
}

/* ---- arrays that are deflated ------------------------------------------- */

/* Inflate into `room` bytes; `got` counts those that this gave, up to the end
 * of the data or of the room. */
static ritz_status inflate_bytes(const mat_element *packed, int64_t room,
                                 unsigned char *out, int64_t *got)
{
    uLong size = (uLong)room;
    int end = uncompress(out, &size, packed->at, (uLong)packed->bytes);

    RITZ_REFUSE_IF(end == Z_MEM_ERROR, RITZ_ERR_MEMORY, "no memory to inflate");
    RITZ_REFUSE_IF(end != Z_OK && end != Z_BUF_ERROR, RITZ_ERR_FORMAT,
                   "compressed data are damaged");
    *got = (int64_t)size;
    return RITZ_OK;
}

/* The element that a compressed one holds, whole, with its tag. */
static ritz_status inflate_element(const mat_element *packed, bool swap,
                                   int64_t *size, unsigned char **out)
{
    unsigned char tag[8];
    RITZ_OWN_ARRAY unsigned char *bytes = NULL;
    int64_t got = 0;

    RITZ_CHECK(inflate_bytes(packed, sizeof tag, tag, &got));
    RITZ_REFUSE_IF(got < (int64_t)sizeof tag, RITZ_ERR_FORMAT,
                   "compressed data are damaged");
    *size = (int64_t)sizeof tag + (int64_t)ritz_bytes_bits(tag + 4, 4, swap);
    RITZ_REFUSE_IF(*size / RITZ_MAT_MOST_RATIO > packed->bytes, RITZ_ERR_FORMAT,
                   "declares %" PRId64 " bytes, which %" PRId64
                   " cannot be inflated to",
                   *size, packed->bytes);
    RITZ_CHECK_NEW(bytes,
                   *size + 1); /* one more, to see that there is no more */
    RITZ_CHECK(inflate_bytes(packed, *size + 1, bytes, &got));
    RITZ_REFUSE_IF(got != *size, RITZ_ERR_FORMAT,
                   "compressed data are damaged");
    RITZ_MOVE(*out, bytes);
    return RITZ_OK;
}

/* An array, or a compressed one; other elements are not known here. */
static ritz_status read_element(const mat_element *e, bool swap,
                                ritz_mat_list *list)
{
    mat_reader inside = {e->at, e->at, e->at + e->bytes, swap};
    mat_element array = *e;
    RITZ_OWN_ARRAY unsigned char *bytes = NULL;
    int64_t size = 0;

    if (e->type == RITZ_MAT_COMPRESSED) {
        RITZ_CHECK(inflate_element(e, swap, &size, &bytes));
        inside = (mat_reader){bytes, bytes, bytes + size, swap};
        RITZ_CHECK(take_element(&inside, &array));
    }
    RITZ_REFUSE_IF(array.type != RITZ_MAT_MATRIX, RITZ_ERR_FORMAT,
                   "an element of type %d where an array is due", array.type);
    inside = (mat_reader){array.at, array.at, array.at + array.bytes, swap};
    return read_array(&inside, list);
}

ritz_status ritz_mat_read_level5(const char *bytes, int64_t size,
                                 ritz_mat_list *list)
{
    const unsigned char *begin = (const unsigned char *)bytes;
    mat_reader r = {begin, begin + HEAD, begin + size, false};
    char where[RITZ_NAME_SIZE];

    (void)version_of(bytes, size, &r.swap);
    while (r.at < r.end) {
        mat_element e = {0};

        snprintf(where, sizeof where, "byte %" PRId64, (int64_t)(r.at - begin));
        RITZ_CHECK(take_element(&r, &e));
        RITZ_CHECK_IN(where, read_element(&e, r.swap, list));
    }
    return RITZ_OK;
}
