/*
 * The engine behind the tables of containers: it walks the rows of a schema to
 * write an object, and to read and check one.
 *
 * Nothing is allocated before the file has been seen to hold as much: sizes are
 * taken from data sets whose shape is backed by stored bytes, and the shape of
 * each other member is compared with them first.
 */
#include "container/schema.h"

#include "base/alloc.h"
#include "base/text.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Letters and shapes. */

static const ritz_size *find_size(const ritz_schema *schema, char letter)
{
    for (const ritz_size *s = schema->sizes; s->letter; s++)
        if (s->letter == letter)
            return s;
    return NULL;
}

int64_t ritz_schema_size(const ritz_place *place, char letter)
{
    const ritz_size *s = NULL;
    int64_t value = 0;

    for (; place && !s; place = s ? place : place->outer)
        s = find_size(place->schema, letter);
    if (s && s->count)
        return s->count(place->object);
    if (s)
        memcpy(&value, (const char *)place->object + s->offset, sizeof value);
    return value;
}

/* "12", "n", "3r", "n+1" or "-1"; returns what follows. */
static const char *read_term(const ritz_place *place, const char *text,
                             int64_t *out)
{
    char *end = NULL;

    *out = 1;
    if (isdigit((unsigned char)*text) || *text == '-') {
        *out = strtol(text, &end, 10);
        text = end;
    }
    if (isalpha((unsigned char)*text))
        *out *= ritz_schema_size(place, *text++);
    if (*text == '+' || *text == '-') {
        *out += strtol(text, &end, 10);
        text = end;
    }
    return text;
}

ritz_h5_shape ritz_schema_shape(const ritz_place *place, const ritz_member *row)
{
    ritz_h5_shape shape = {0};

    for (const char *text = row->shape; text && *text; text += *text == ' ') {
        int64_t size = 0;

        text = read_term(place, text, &size);
        shape.dims[shape.rank++] = (hsize_t)size;
    }
    return shape;
}

/* "0..n-1"; without an end every number on that side. */
static void read_range(const ritz_place *place, const char *text,
                       int64_t *least, int64_t *most)
{
    *least = INT64_MIN;
    *most = INT64_MAX;
    if (!text)
        return;
    if (*text != '.')
        text = read_term(place, text, least);
    if (text[2])
        (void)read_term(place, text + 2, most);
}

static bool is_allowed(double x, ritz_member_values values)
{
    return isfinite(x) || values == VALUES_ANY ||
           (values == VALUES_OR_NAN && isnan(x));
}

/* Where members lie: in the file, and in memory. */

static bool is_attribute(const ritz_member *row)
{
    return row->kind <= ATTRIBUTE_REAL;
}

/* Whether the values are in the object itself, and not in an array. */
static bool is_inside(const ritz_member *row)
{
    return row->inside || is_attribute(row);
}

static const char *name_of(const ritz_member *row)
{
    const char *slash = strchr(row->name, '/');

    return slash ? slash + 1 : row->name;
}

/* The group of a row, "" if it is that of the place. */
static void copy_group(const char *path, ritz_name out)
{
    const char *slash = strchr(path, '/');

    snprintf(out, sizeof(ritz_name), "%.*s", slash ? (int)(slash - path) : 0,
             path);
}

/* Whether there is a link "name" or "group/name". */
static bool has_link(hid_t at, const char *path)
{
    ritz_name group = "";

    copy_group(path, group);
    return (!group[0] || ritz_h5_has(at, group)) && ritz_h5_has(at, path);
}

static const void *pointer_in(const void *field)
{
    const void *pointer = NULL;

    memcpy(&pointer, field, sizeof pointer);
    return pointer;
}

static const void *field_of(const ritz_place *place, const ritz_member *row)
{
    return (const char *)place->object + row->offset;
}

static void *target_of(const ritz_place *place, const ritz_member *row)
{
    return (char *)place->target + row->offset;
}

ritz_place ritz_schema_part(const ritz_place *place, const ritz_member *row)
{
    return (ritz_place){
        .at = place->at,
        .schema = row->schema,
        .object = field_of(place, row),
        .outer = place,
    };
}

static bool is_empty(const ritz_place *place, const ritz_member *row)
{
    const void *field = field_of(place, row);

    if (row->kind == ATTRIBUTE_TEXT)
        return !*(const char *)field;
    if (row->kind == ATTRIBUTE_FLAG)
        return !*(const bool *)field;
    if (row->kind == MATRIX_DENSE)
        return !((const ritz_dense *)field)->val;
    if (row->kind == MATRIX_SPARSE)
        return !((const ritz_sparse *)field)->colptr;
    return row->kind >= SET_WHOLE && !pointer_in(field);
}

/* Whether the object says that it has this member. */
bool ritz_schema_is_given(const ritz_place *place, const ritz_member *row)
{
    ritz_place part = ritz_schema_part(place, row);

    if (row->has)
        return row->has(place->object);
    if (row->some)
        return ritz_schema_size(row->kind == PART ? &part : place, row->some) >
               0;
    return !row->optional || !is_empty(place, row);
}

/* Whether the file has this member, or must have it. */
static bool is_due(const ritz_place *place, const ritz_member *row)
{
    const char *what = row->optional;

    if (!what)
        return ritz_schema_is_given(place, row);
    if (is_attribute(row) && !*what)
        return ritz_h5_has_attribute(place->at, row->name);
    return has_link(place->at, *what ? what : row->name);
}

/* Values: gathered from an object or its items, and scattered to them. */
static size_t width_in_file(const ritz_member *row)
{
    if (row->kind == ATTRIBUTE_TEXT)
        return row->size;
    return is_attribute(row) || row->kind == SET_WHOLE || row->kind == SET_REAL
               ? sizeof(int64_t)
               : RITZ_NAME_SIZE;
}

static size_t width_of_item(const ritz_member *row)
{
    size_t value = row->kind == SET_COLUMN_KINDS ? sizeof(ritz_column_kind)
                                                 : width_in_file(row);

    return row->size > 0 ? row->size : value;
}

static bool is_real(const ritz_member *row)
{
    return row->kind == ATTRIBUTE_REAL || row->kind == SET_REAL;
}

static bool is_whole(const ritz_member *row)
{
    return row->kind == ATTRIBUTE_FLAG || row->kind == ATTRIBUTE_WHOLE ||
           row->kind == SET_WHOLE;
}

static hid_t type_of(const ritz_member *row)
{
    if (is_whole(row))
        return H5Tcopy(H5T_STD_I64LE);
    if (is_real(row))
        return H5Tcopy(H5T_IEEE_F64LE);
    return ritz_h5_string(width_in_file(row));
}

/* Text is copied up to its NUL: bytes behind it would differ between runs. */
static void gather_values(const ritz_member *row, int64_t count,
                          const char *from, char *to)
{
    size_t width = width_in_file(row), step = width_of_item(row);
    const int64_t one = 1; /* of a flag */

    if (count > 0) /* without items the array may be NULL */
        from += row->item;
    for (int64_t k = 0; k < count; k++, from += step, to += width) {
        const ritz_column_kind *kind = (const void *)from;

        if (row->kind == SET_COLUMN_KINDS)
            snprintf(to, width, "%s", ritz_column_name(*kind));
        else if (row->kind == ATTRIBUTE_FLAG)
            memcpy(to, &one, width);
        else if (is_whole(row) || is_real(row))
            memcpy(to, from, width);
        else
            memcpy(to, from, strnlen(from, width - 1));
    }
}

static ritz_status scatter_values(const ritz_member *row, int64_t count,
                                  const char *from, char *to)
{
    size_t width = width_in_file(row), step = width_of_item(row);

    if (count > 0) /* without items the array may be NULL */
        to += row->item;
    for (int64_t k = 0; k < count; k++, from += width, to += step) {
        ritz_column_kind *kind = (void *)to;

        if (row->kind == SET_COLUMN_KINDS)
            RITZ_REFUSE_IF(!ritz_column_find(from, kind), RITZ_ERR_FORMAT,
                           "column %" PRId64 " is of unknown kind '%s'", k + 1,
                           from);
        else if (row->kind == ATTRIBUTE_FLAG)
            *(bool *)to = true;
        else
            memcpy(to, from, width);
    }
    return RITZ_OK;
}

/* Each can be the name of a link, and no two are the same. */
static ritz_status check_names(int64_t count, const ritz_name *names)
{
    ritz_name name;

    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(
            ritz_name_copy(names[k], name) != RITZ_OK, RITZ_ERR_FORMAT,
            "name %" PRId64 ", '%.40s', cannot be one", k + 1, names[k]);
    RITZ_CHECK(ritz_names_repeated(count, names, name));
    RITZ_REFUSE_IF(*name, RITZ_ERR_FORMAT, "'%s' is there twice", name);
    return RITZ_OK;
}

static ritz_status write_values(const ritz_place *place, hid_t at,
                                const ritz_member *row)
{
    ritz_h5_shape shape = ritz_schema_shape(place, row);
    int64_t count = (int64_t)ritz_h5_volume(&shape, INT64_MAX);
    const void *field = field_of(place, row);
    RITZ_OWN(hid_t) type = type_of(row);
    RITZ_OWN_ARRAY char *values = NULL;

    if (row->kind == ATTRIBUTE_TEXT) /* no longer than it is */
        return ritz_h5_set_text(at, row->name, field);
    RITZ_CHECK_NEW(values, count * (int64_t)width_in_file(row));
    gather_values(row, count, is_inside(row) ? field : pointer_in(field),
                  values);
    if (row->kind == SET_NAMES)
        RITZ_CHECK_IN(name_of(row), check_names(count, (void *)values));
    return is_attribute(row)
               ? ritz_h5_set(at, row->name, type, shape, values)
               : ritz_h5_write(at, name_of(row), type, shape, values);
}

/* "attribute 'bound'", "value 3 of 'hertz'" */
static const char *name_value(const ritz_member *row, int64_t k,
                              char out[2 * RITZ_NAME_SIZE])
{
    if (is_attribute(row))
        snprintf(out, 2 * (size_t)RITZ_NAME_SIZE, "attribute '%s'", row->name);
    else
        snprintf(out, 2 * (size_t)RITZ_NAME_SIZE, "value %" PRId64 " of '%s'",
                 k + 1, name_of(row));
    return out;
}

static ritz_status check_values(const ritz_place *place, const ritz_member *row,
                                int64_t count, const char *values)
{
    int64_t least = 1, most = 1, whole = 0; /* of a flag */
    char name[2 * RITZ_NAME_SIZE];
    double real = 0.0;

    if (row->kind == SET_NAMES)
        return ritz_context(check_names(count, (const void *)values),
                            name_of(row));
    if (row->kind != ATTRIBUTE_FLAG)
        read_range(place, row->range, &least, &most);
    for (int64_t k = 0; k < count && is_real(row); k++) {
        memcpy(&real, values + (size_t)k * sizeof real, sizeof real);
        RITZ_REFUSE_IF(!is_allowed(real, row->values), RITZ_ERR_FORMAT,
                       "%s is not finite", name_value(row, k, name));
    }
    for (int64_t k = 0; k < count && is_whole(row); k++) {
        memcpy(&whole, values + (size_t)k * sizeof whole, sizeof whole);
        RITZ_REFUSE_IF(whole < least || whole > most, RITZ_ERR_FORMAT,
                       "%s is %" PRId64 ", not in %" PRId64 "..%" PRId64,
                       name_value(row, k, name), whole, least, most);
    }
    return RITZ_OK;
}

/* Values in the object, or in an array that its first member allocates. */
static ritz_status find_room(const ritz_member *row, int64_t count, void *field,
                             char **out)
{
    char *array = field;

    if (!is_inside(row)) {
        memcpy(&array, field, sizeof array);
        if (!array)
            RITZ_CHECK_NEW(array, count * (int64_t)width_of_item(row));
        memcpy(field, &array, sizeof array);
    }
    *out = array;
    return RITZ_OK;
}

static ritz_status read_values(const ritz_place *place, hid_t at,
                               const ritz_member *row)
{
    ritz_h5_shape shape = ritz_schema_shape(place, row);
    int64_t count = (int64_t)ritz_h5_volume(&shape, INT64_MAX);
    RITZ_OWN(hid_t) type = type_of(row);
    RITZ_OWN_ARRAY char *values = NULL;
    char *to = NULL;

    if (!is_attribute(row))
        RITZ_CHECK(ritz_h5_expect(at, name_of(row), shape));
    RITZ_CHECK_NEW(values, count * (int64_t)width_in_file(row));
    RITZ_CHECK(find_room(row, count, target_of(place, row), &to));
    RITZ_CHECK(is_attribute(row)
                   ? ritz_h5_get(at, row->name, type, count, values)
                   : ritz_h5_read(at, name_of(row), type, shape, values));
    RITZ_CHECK(check_values(place, row, count, values));
    return scatter_values(row, count, values, to);
}

/*
 * Rows, parts and lists, in both directions. Schemas hold schemas, and these
 * functions call themselves as deep as the tables are: the measures of a
 * system's configuration are the third level.
 */
/* NOLINTBEGIN(misc-no-recursion) */

static ritz_status open_group(const ritz_place *place, const char *name,
                              hid_t *out)
{
    return place->target ? ritz_h5_enter(place->at, name, out)
                         : ritz_h5_group(place->at, name, out);
}

static ritz_status move_part(const ritz_place *place, const ritz_member *row)
{
    RITZ_OWN(hid_t) group = 0;
    ritz_place part = ritz_schema_part(place, row);

    if (place->target)
        part.target = target_of(place, row);
    if (!*row->name)
        return ritz_schema_move(&part);
    RITZ_CHECK_IN(row->name, open_group(place, row->name, &group));
    part.at = group;
    return ritz_context(ritz_schema_move(&part), row->name);
}

static ritz_status move_sparse(const ritz_place *place, hid_t at,
                               const char *name, const ritz_member *row)
{
    return place->target ? ritz_h5_read_sparse(at, name, target_of(place, row))
                         : ritz_h5_write_sparse(at, name, field_of(place, row));
}

/* An item whose one member has no name is a sparse matrix, itself a group. */
static ritz_status move_item(const ritz_place *item, const char *name)
{
    RITZ_OWN(hid_t) group = 0;
    ritz_place inner = *item;
    const ritz_member *row = item->schema->members;
    bool is_matrix = row->kind == MATRIX_SPARSE && !*row->name;

    if (is_matrix)
        RITZ_CHECK(move_sparse(item, item->at, name, row));
    RITZ_CHECK_IN(name, is_matrix ? ritz_h5_enter(item->at, name, &group)
                                  : open_group(item, name, &group));
    inner.at = group;
    if (!item->target)
        RITZ_CHECK_IN(name, ritz_h5_set(group, "index", H5T_STD_I64LE,
                                        ritz_h5_scalar(), &item->index));
    return is_matrix ? RITZ_OK : ritz_context(ritz_schema_move(&inner), name);
}

/* Names of the groups of a list: its items' own, or "0", "1", ... */
ritz_status ritz_schema_items(const ritz_place *place, const ritz_member *row,
                              int64_t *count, ritz_name **out)
{
    const char *item = pointer_in(field_of(place, row));
    RITZ_OWN_ARRAY ritz_name *name = NULL;

    *count = ritz_schema_size(place, *row->shape);
    RITZ_CHECK_NEW(name, *count);
    for (int64_t k = 0; k < *count; k++, item += row->size)
        if (row->numbered)
            snprintf(name[k], sizeof *name, "%" PRId64, k);
        else
            RITZ_CHECK(ritz_name_copy(item, name[k]));
    RITZ_MOVE(*out, name);
    return RITZ_OK;
}

/* The names that a group lists, and room for as many items. */
static ritz_status find_items(const ritz_place *place, const ritz_member *row,
                              hid_t group, int64_t *count, ritz_name **name)
{
    const ritz_size *size = find_size(place->schema, *row->shape);
    char *items = NULL;

    *count = 1;
    if (group != place->at)
        RITZ_CHECK(ritz_h5_list(group, count, name));
    RITZ_CHECK_NEW(items, *count * (int64_t)row->size);
    memcpy(target_of(place, row), &items, sizeof items);
    memcpy((char *)place->target + size->offset, count, sizeof *count);
    for (int64_t k = 0; k < *count && !row->numbered; k++)
        memcpy(items + (size_t)k * row->size, (*name)[k], sizeof **name);
    return RITZ_OK;
}

static ritz_status move_items(const ritz_place *place, const ritz_member *row,
                              hid_t group)
{
    ritz_place item = {.at = group, .schema = row->schema, .outer = place};
    RITZ_OWN_ARRAY ritz_name *name = NULL;
    int64_t count = 0;

    RITZ_CHECK(place->target ? find_items(place, row, group, &count, &name)
                             : ritz_schema_items(place, row, &count, &name));
    item.object = pointer_in(field_of(place, row));
    if (place->target)
        memcpy(&item.target, field_of(place, row), sizeof item.target);
    for (; item.index < count; item.index++) {
        RITZ_CHECK(group == place->at ? ritz_schema_move(&item)
                                      : move_item(&item, name[item.index]));
        item.object = (const char *)item.object + row->size;
        if (place->target)
            item.target = (char *)item.target + row->size;
    }
    return RITZ_OK;
}

static ritz_status move_list(const ritz_place *place, const ritz_member *row)
{
    RITZ_OWN(hid_t) group = 0;

    if (row->alone &&
        (place->target ? !has_link(place->at, row->name)
                       : ritz_schema_size(place, *row->shape) == 1))
        return move_items(place, row, place->at);
    RITZ_CHECK_IN(row->name, open_group(place, row->name, &group));
    return ritz_context(move_items(place, row, group), row->name);
}

static ritz_status move_dense(const ritz_place *place, hid_t at,
                              const ritz_member *row)
{
    ritz_h5_shape due = ritz_schema_shape(place, row);

    if (!place->target)
        return ritz_h5_write_dense(at, name_of(row), field_of(place, row));
    return ritz_h5_read_dense(at, name_of(row), (int64_t)due.dims[0],
                              (int64_t)due.dims[1], target_of(place, row));
}

static ritz_status move_row(const ritz_place *place, hid_t at,
                            const ritz_member *row)
{
    switch (row->kind) {
    case PART:
        return move_part(place, row);
    case LIST:
        return move_list(place, row);
    case BY_HAND:
        return row->move(place, at);
    case MATRIX_DENSE:
        return move_dense(place, at, row);
    case MATRIX_SPARSE:
        return move_sparse(place, at, name_of(row), row);
    default:
        break;
    }
    return place->target ? read_values(place, at, row)
                         : write_values(place, at, row);
}

/* The group of the rows at hand, open as long as they share it. */
typedef struct row_group {
    ritz_name name;
    hid_t id;
} row_group;

static void row_group_free(row_group *open)
{
    ritz_h5_close(open->id);
    *open = (row_group){0};
}

static ritz_status follow_group(const ritz_place *place, const ritz_member *row,
                                row_group *open)
{
    ritz_name name = "";

    copy_group(row->name, name);
    if (strcmp(name, open->name) == 0)
        return RITZ_OK;
    row_group_free(open);
    if (!name[0])
        return RITZ_OK;
    RITZ_CHECK(open_group(place, name, &open->id));
    memcpy(open->name, name, sizeof name);
    return RITZ_OK;
}

static ritz_status put_context(const row_group *open, ritz_status status)
{
    return open->name[0] ? ritz_context(status, open->name) : status;
}

/* Size of a letter, read from the data set of the row whose shape has it. */
static ritz_status measure_row(const ritz_place *place, char letter,
                               const ritz_member *row, int64_t *out)
{
    RITZ_OWN(row_group) open = {0};
    ritz_h5_shape found = {0};
    int rank = 1, which = 0;

    for (const char *c = row->shape; *c; c++) {
        which = *c == letter && which == 0 ? rank : which;
        rank += *c == ' ';
    }
    RITZ_CHECK(follow_group(place, row, &open));
    RITZ_CHECK(
        put_context(&open, ritz_h5_shape_of(open.id ? open.id : place->at,
                                            name_of(row), rank, &found)));
    RITZ_REFUSE_IF(found.dims[which - 1] > INT64_MAX / 4, RITZ_ERR_FORMAT,
                   "'%s' is too large", name_of(row));
    *out = (int64_t)found.dims[which - 1];
    return RITZ_OK;
}

static ritz_status read_sizes(const ritz_place *place)
{
    for (const ritz_size *s = place->schema->sizes; s->letter; s++) {
        const ritz_member *row = place->schema->members;
        int64_t size = 0;

        if (!s->from)
            continue;
        while (row->name && strcmp(row->name, s->from) != 0)
            row++;
        if (!row->name) /* "^" */
            size = ritz_schema_size(place->outer, s->letter);
        else if (is_due(place, row))
            RITZ_CHECK(measure_row(place, s->letter, row, &size));
        memcpy((char *)place->target + s->offset, &size, sizeof size);
    }
    return RITZ_OK;
}

ritz_status ritz_schema_move(const ritz_place *place)
{
    RITZ_OWN(row_group) open = {0};
    const double none = nan(""); /* for what earlier releases did not write */

    if (place->target)
        RITZ_CHECK(read_sizes(place));
    for (const ritz_member *row = place->schema->members; row->name; row++) {
        if (!(place->target ? is_due(place, row)
                            : ritz_schema_is_given(place, row))) {
            if (place->target && row->kind == ATTRIBUTE_REAL && row->optional &&
                row->values == VALUES_OR_NAN)
                memcpy(target_of(place, row), &none, sizeof none);
            continue;
        }
        RITZ_CHECK(follow_group(place, row, &open));
        RITZ_CHECK(put_context(
            &open, move_row(place, open.id ? open.id : place->at, row)));
    }
    if (place->target && place->schema->settle)
        RITZ_CHECK(place->schema->settle(place));
    return RITZ_OK;
}
/* NOLINTEND(misc-no-recursion) */
