/*
 * The inside of a Level 5 array: flags, dimensions, name, and then by class
 *
 *     numbers  real part, imaginary part if flagged, by columns, in any type
 *     sparse   rows, starts of columns, real part, imaginary part
 *     struct   length of field names, field names, an array for each
 */
#include "formats/mat.h"

#include "base/alloc.h"
#include "base/array.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

typedef struct array {
    int class;
    bool complex;
    int num_dims;
    int64_t nrow, ncol;
    char name[JOINED];
} array;

/* An element of one type, of so many bytes; -1: any number. */
static ritz_status take(ritz_mat_reader *r, const char *what, int type,
                        int64_t bytes, ritz_mat_element *out)
{
    RITZ_CHECK(ritz_mat_take(r, out));
    RITZ_REFUSE_IF(out->type != type || (bytes >= 0 && out->bytes != bytes),
                   RITZ_ERR_FORMAT,
                   "%s are due, not %" PRId64 " bytes of type %d", what,
                   out->bytes, out->type);
    return RITZ_OK;
}

/* Values of any type. */
static ritz_status take_values(ritz_mat_reader *r, ritz_mat_values *out)
{
    ritz_mat_element e = {0};
    int64_t size = 0;

    RITZ_CHECK(ritz_mat_take(r, &e));
    size = ritz_mat_size(e.type);
    RITZ_REFUSE_IF(size == 0, RITZ_ERR_FORMAT,
                   "values of type %d, which is none of numbers", e.type);
    *out = (ritz_mat_values){e.at, e.bytes / size, e.type, r->swap};
    return RITZ_OK;
}

/* The name in the file, after what it is a part of. */
static ritz_status join(const char *outer, const char *name, int64_t length,
                        char out[JOINED])
{
    char own[RITZ_NAME_SIZE] = "";
    char clean[RITZ_NAME_SIZE] = "";

    snprintf(own, sizeof own, "%.*s", (int)(length < 99 ? length : 99), name);
    if (*own)
        RITZ_CHECK(ritz_name_copy(own, clean));
    snprintf(out, JOINED, "%s%s%s", outer, *outer && *clean ? "." : "", clean);
    return RITZ_OK;
}

static ritz_status read_head(ritz_mat_reader *r, const char *outer, array *out)
{
    ritz_mat_element e = {0};
    uint64_t flags = 0;

    RITZ_CHECK(take(r, "array flags", RITZ_MAT_UINT32, 8, &e));
    flags = ritz_mat_bits(e.at, 4, r->swap);
    out->class = (int)(flags & 0xff);
    out->complex = flags & FLAG_COMPLEX;
    out->nrow = out->ncol = 1;
    if (out->class != CLASS_OPAQUE) {
        RITZ_CHECK(take(r, "dimensions", RITZ_MAT_INT32, -1, &e));
        out->num_dims = (int)(e.bytes / 4);
        RITZ_REFUSE_IF(out->num_dims < 2, RITZ_ERR_FORMAT,
                       "an array of %d dimensions", out->num_dims);
        out->nrow = (int32_t)(uint32_t)ritz_mat_bits(e.at, 4, r->swap);
        out->ncol = (int32_t)(uint32_t)ritz_mat_bits(e.at + 4, 4, r->swap);
        RITZ_REFUSE_IF(out->nrow < 0 || out->ncol < 0, RITZ_ERR_FORMAT,
                       "an array of %" PRId64 " x %" PRId64, out->nrow,
                       out->ncol);
    }
    RITZ_CHECK(take(r, "a name's letters", RITZ_MAT_INT8, -1, &e));
    return join(outer, (const char *)e.at, e.bytes, out->name);
}

static ritz_status read_numbers(ritz_mat_reader *r, const array *a,
                                ritz_mat_list *list)
{
    ritz_mat_values part[2] = {0};

    for (int k = 0; k < (a->complex ? 2 : 1); k++) {
        RITZ_CHECK(take_values(r, &part[k]));
        RITZ_REFUSE_IF(
            part[k].count / a->ncol != a->nrow || part[k].count % a->ncol != 0,
            RITZ_ERR_FORMAT,
            "'%s' is %" PRId64 " x %" PRId64 " and has %" PRId64 " values",
            a->name, a->nrow, a->ncol, part[k].count);
    }
    return ritz_mat_add_full(list, a->name, a->nrow, a->ncol, &part[0],
                             &part[1]);
}

static ritz_status read_sparse(ritz_mat_reader *r, const array *a,
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
    return ritz_mat_add_sparse(list, a->name, &e);
}

/* An array that is to be read, and what it is a part of. */
typedef struct pending {
    ritz_mat_reader inside;
    int depth;
    char outer[RITZ_NAME_SIZE];
} pending;

/* Arrays that wait for their turn: those of a struct stand behind it. */
typedef struct queue {
    int64_t count, room;
    pending *item;
} queue;

static ritz_status take_field(ritz_mat_reader *r, const array *a,
                              const char *name, int64_t length, pending *out)
{
    ritz_mat_element field = {0};
    char whole[JOINED];

    RITZ_CHECK(ritz_mat_take(r, &field));
    RITZ_REFUSE_IF(field.type != RITZ_MAT_MATRIX, RITZ_ERR_FORMAT,
                   "'%s': a field of type %d where an array is due", a->name,
                   field.type);
    RITZ_CHECK(join(a->name, name, length, whole));
    snprintf(out->outer, sizeof out->outer, "%.*s", RITZ_NAME_SIZE - 1, whole);
    out->inside =
        (ritz_mat_reader){field.at, field.at, field.at + field.bytes, r->swap};
    return RITZ_OK;
}

static ritz_status read_struct(ritz_mat_reader *r, const array *a, int depth,
                               queue *fields)
{
    ritz_mat_element names = {0};
    ritz_mat_element size = {0};
    int64_t length = 0;

    RITZ_CHECK(take(r, "lengths of names", RITZ_MAT_INT32, 4, &size));
    length = (int32_t)(uint32_t)ritz_mat_bits(size.at, 4, r->swap);
    RITZ_CHECK(take(r, "names of fields", RITZ_MAT_INT8, -1, &names));
    RITZ_REFUSE_IF(length < 1 || names.bytes % length != 0, RITZ_ERR_FORMAT,
                   "'%s': %" PRId64 " bytes are no names of %" PRId64 " each",
                   a->name, names.bytes, length);
    for (int64_t k = 0; k < names.bytes / length; k++) {
        pending field = {.depth = depth + 1};

        RITZ_CHECK(take_field(r, a, (const char *)names.at + k * length, length,
                              &field));
        RITZ_CHECK_ROOM(fields->item, fields->count, fields->room);
        fields->item[fields->count++] = field;
    }
    return RITZ_OK;
}

/* Why an array is no matrix, or NULL. */
static const char *why_none(const array *a, int depth)
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

/* A matrix, what is none, or a struct, whose fields then wait. */
static ritz_status read_one(pending *p, ritz_mat_list *list, queue *fields)
{
    ritz_mat_reader *r = &p->inside;
    array a = {0};
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
        RITZ_CHECK(ritz_mat_add_other(list, a.name, why));
    else if (a.class == CLASS_STRUCT)
        RITZ_CHECK(read_struct(r, &a, p->depth, fields));
    else if (a.class == CLASS_SPARSE)
        RITZ_CHECK(read_sparse(r, &a, list));
    else
        RITZ_CHECK(read_numbers(r, &a, list));
    return RITZ_OK;
}

ritz_status ritz_mat_read_array(const ritz_mat_reader *reader,
                                ritz_mat_list *list)
{
    ritz_status status = RITZ_OK;
    queue waiting = {0};

    RITZ_ROOM(waiting.item, waiting.count, waiting.room);
    waiting.item[waiting.count++] = (pending){.inside = *reader};
    for (int64_t k = 0; k < waiting.count; k++) {
        pending turn = waiting.item[k];

        RITZ_TRY(read_one(&turn, list, &waiting));
    }
done:
    free(waiting.item);
    return status;
}
