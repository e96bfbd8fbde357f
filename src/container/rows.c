/* The rows of all schemas, and those of one object, told to a listener. */
#include "container/schema.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void row_listener(const ritz_container_row *row, void *data);

enum { PATH_SIZE = 4 * RITZ_NAME_SIZE };

static const ritz_schema *const kinds[] = {
    &ritz_schema_component,  &ritz_schema_basis,
    &ritz_schema_reduced,    &ritz_schema_state_space,
    &ritz_schema_system,     &ritz_schema_response,
    &ritz_schema_simulation, &ritz_schema_rankings,
    &ritz_schema_recovered,  NULL,
};

static const ritz_schema *const shared[] = {
    &ritz_schema_grids,   &ritz_schema_elements, &ritz_schema_recovery,
    &ritz_schema_dampers, &ritz_schema_io,       &ritz_schema_columns,
    &ritz_schema_origin,  &ritz_schema_measures, NULL,
};

/* NULL: a part or a list has no type, and a row read by hand states its own. */
static const char *const types[BY_HAND + 1] = {
    [ATTRIBUTE_TEXT] = "text, attribute",
    [ATTRIBUTE_FLAG] = "i64, attribute",
    [ATTRIBUTE_WHOLE] = "i64, attribute",
    [ATTRIBUTE_REAL] = "f64, attribute",
    [SET_WHOLE] = "i64",
    [SET_REAL] = "f64",
    [SET_NAMES] = "text",
    [SET_WORDS] = "text",
    [SET_COLUMN_KINDS] = "text",
    [MATRIX_DENSE] = "f64",
    [MATRIX_SPARSE] = "sparse",
};

/* Whom rows are told to, and which kind they are of. */
typedef struct row_teller {
    const char *of;
    row_listener *say;
    void *data;
} row_teller;

/* "n, 3r", or the sizes that the object has. */
static void print_shape(const ritz_place *place, const ritz_member *row,
                        ritz_name out)
{
    int used = 0;

    out[0] = '\0';
    if (place->object && row->kind != BY_HAND) {
        ritz_h5_shape shape = ritz_schema_shape(place, row);

        for (int k = 0; k < shape.rank; k++)
            used += snprintf(out + used, sizeof(ritz_name) - (size_t)used,
                             "%s%" PRIuHSIZE, k > 0 ? ", " : "", shape.dims[k]);
        return;
    }
    for (const char *c = row->shape; c && *c && used < RITZ_NAME_SIZE - 3; c++)
        used += snprintf(out + used, 3, *c == ' ' ? ", " : "%c", *c);
}

/* Whether the presence of another member requires this one. */
static bool is_with_another(const ritz_member *row)
{
    return row->optional && *row->optional &&
           strcmp(row->optional, row->name) != 0;
}

/* A matrix that is an item of a list has no name but that of the item. */
static void tell_row(const ritz_place *place, const char *prefix,
                     const ritz_member *row, const row_teller *to)
{
    char path[PATH_SIZE];
    ritz_name shape;
    bool unnamed = row->schema && !*row->name;
    size_t length =
        (size_t)snprintf(path, sizeof path, "%s%s%s", prefix, row->name,
                         row->kind == PART && *row->name ? "/" : "");

    if (!*row->name && length > 0)
        path[length - 1] = '\0';
    print_shape(place, row, shape);
    to->say(
        &(ritz_container_row){
            .of = to->of,
            .name = unnamed ? row->schema->name : path,
            .type = row->type ? row->type : types[row->kind],
            .shape = shape,
            .about = row->about ? row->about : "",
            .range = row->range,
            .nan = row->values == VALUES_OR_NAN,
            .optional = (row->optional || row->has || row->some) && !row->must,
            .with = is_with_another(row) ? row->optional : NULL,
        },
        to->data);
}

static ritz_place enter_part(const ritz_place *place, const ritz_member *row)
{
    return place->object ? ritz_schema_part(place, row)
                         : (ritz_place){.schema = row->schema, .outer = place};
}

/* NOLINTBEGIN(misc-no-recursion): as deep as the tables are */
static void tell_members(const ritz_place *place, const char *prefix,
                         const row_teller *to);

/* Each item of a list, or one that stands for all. */
static void tell_items(const ritz_place *place, const char *prefix,
                       const ritz_member *row, const row_teller *to)
{
    ritz_place item = enter_part(place, row);
    ritz_name *name = NULL;
    char path[PATH_SIZE];
    int64_t count = 0;

    if (!place->object) {
        snprintf(path, sizeof path, "%s%s/<%s>/", prefix, row->name,
                 row->numbered ? "k" : "name");
        tell_members(&item, path, to);
        return;
    }
    if (ritz_schema_items(place, row, &count, &name) != RITZ_OK)
        return;
    memcpy(&item.object, item.object, sizeof item.object);
    for (item.index = 0; item.index < count; item.index++) {
        snprintf(path, sizeof path, "%s%s/%s/", prefix, row->name,
                 name[item.index]);
        if (row->alone && count == 1)
            snprintf(path, sizeof path, "%s", prefix);
        tell_members(&item, path, to);
        item.object = (const char *)item.object + row->size;
    }
    free(name);
}

static void tell_part(const ritz_place *place, const char *prefix,
                      const ritz_member *row, const row_teller *to)
{
    ritz_place part = enter_part(place, row);
    char path[PATH_SIZE];

    snprintf(path, sizeof path, "%s%s%s", prefix, row->name,
             *row->name ? "/" : "");
    tell_members(&part, path, to);
}

static void tell_members(const ritz_place *place, const char *prefix,
                         const row_teller *to)
{
    for (const ritz_member *row = place->schema->members; row->name; row++) {
        if (place->object && !ritz_schema_is_given(place, row))
            continue;
        if (row->kind == LIST)
            tell_items(place, prefix, row, to);
        else if (row->schema &&
                 (place->object ? row->kind == PART : !row->schema->shared))
            tell_part(place, prefix, row, to);
        else
            tell_row(place, prefix, row, to);
    }
}
/* NOLINTEND(misc-no-recursion) */

void ritz_container_rows(row_listener *say, void *data)
{
    for (const ritz_schema *const *s = shared; *s; s++)
        tell_members(&(ritz_place){.schema = *s}, (*s)->shared,
                     &(row_teller){(*s)->name, say, data});
    for (const ritz_schema *const *s = kinds; *s; s++)
        tell_members(&(ritz_place){.schema = *s}, "",
                     &(row_teller){(*s)->name, say, data});
}

void ritz_container_members(const char *kind, const void *object,
                            row_listener *say, void *data)
{
    for (const ritz_schema *const *s = kinds; *s; s++)
        if (strcmp((*s)->name, kind) == 0)
            tell_members(&(ritz_place){.schema = *s, .object = object}, "",
                         &(row_teller){kind, say, data});
}
