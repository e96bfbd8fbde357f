/*
 * What containers hold, as rows. One table for each object says of each member
 * its name and form in the file, its shape, where it lies in memory and what it
 * means. Reading, writing and checking walk these rows; so do the list of
 * `ritz-info --members` and the tables of docs/container.md.
 *
 * A shape is up to three sizes, "n 3r" or "e+1": numbers, and letters that the
 * schema defines from fields of its object. Members of the same group have its
 * name before theirs, "inputs/B", and follow each other.
 *
 * Rows are written in their order, which is part of the format: the same object
 * gives the same bytes.
 */
#ifndef RITZ_CONTAINER_SCHEMA_H
#define RITZ_CONTAINER_SCHEMA_H

#include "container/h5.h"

#include <ritz/container.h>

#include <stddef.h>

typedef char ritz_name[RITZ_NAME_SIZE];

typedef enum ritz_member_kind {
    ATTRIBUTE_TEXT,  /* char[size] */
    ATTRIBUTE_FLAG,  /* bool, stored as 1, or absent */
    ATTRIBUTE_WHOLE, /* int64_t, or several in the object */
    ATTRIBUTE_REAL,  /* double, or several in the object */
    SET_WHOLE,       /* int64_t * */
    SET_REAL,        /* double * */
    SET_NAMES,       /* ritz_name *, distinct, each can be the name of a link */
    SET_WORDS,       /* ritz_name *, any */
    SET_COLUMN_KINDS, /* ritz_column_kind *, stored as words */
    MATRIX_DENSE,     /* ritz_dense */
    MATRIX_SPARSE,    /* ritz_sparse, whose size the object checks */
    PART,             /* a struct in the object, as a group of that name */
    LIST,             /* an array of structs, a group each in that group */
    BY_HAND,          /* a function of its own */
} ritz_member_kind;

/* Which numbers a member may hold; always finite otherwise. */
typedef enum ritz_member_values {
    VALUES_FINITE,
    VALUES_OR_NAN, /* NaN stands for none; an absent attribute becomes NaN */
    VALUES_ANY,    /* the object is checked afterwards */
} ritz_member_values;

typedef struct ritz_schema ritz_schema;

/* An object while it is read or written: its group, and what it is part of. */
typedef struct ritz_place {
    hid_t at;
    const ritz_schema *schema;
    const void *object;
    void *target;                   /* the object while it is read, else NULL */
    const struct ritz_place *outer; /* NULL for a file */
    int64_t index;                  /* of an item in its list */
} ritz_place;

typedef struct ritz_member {
    const char *name; /* "" of a PART: its members lie in the same group */
    ritz_member_kind kind;
    size_t offset; /* in the object: of the member, or of a pointer to it */
    size_t size;   /* of text, or of an item of the array; 0: of one value */
    size_t item;   /* offset of the value within such an item */
    const char *shape;
    const char *about; /* for docs/container.md */
    const char *range; /* of whole numbers, "0..n-1"; either end may lack */
    const char *type;  /* of a row by hand, for docs/container.md */
    ritz_member_values values;
    bool inside : 1;   /* the array is part of the object, as attributes are */
    bool numbered : 1; /* items of a list have the names "0", "1", ... */
    bool alone : 1; /* a list with one item is stored as the item's members */
    bool must : 1;  /* not written if it is empty, but required in a file that
                       is read */
    char some;      /* a letter: see below */
    /*
     * A member may be absent from a file if `optional` names what decides that,
     * "" the member itself. It is written if `has` says so, or if the size
     * `some` is not 0; without both, an optional member if it is not empty.
     * Where only `has` or `some` is given, it decides of reading too.
     */
    const char *optional;
    bool (*has)(const void *object);
    const ritz_schema *schema; /* of a part, or of the items of a list */
    /* Writes by hand, or reads where there is a target. */
    ritz_status (*move)(const ritz_place *place, hid_t group);
} ritz_member;

/* A letter of shapes, and the field of the object in which its value is. */
typedef struct ritz_size {
    char letter;
    size_t offset;                        /* of an int64_t */
    const char *from;                     /* row whose shape tells it when read,
                                           "^" the outer object's letter; NULL
                                           if it is read otherwise */
    int64_t (*count)(const void *object); /* instead of a field */
} ritz_size;

enum { RITZ_MOST_SIZES = 8 };

struct ritz_schema {
    const char *name;   /* `ritz_kind`, or of a part */
    const char *shared; /* of a part of several kinds: the group it lies in,
                           with a slash, or "" */
    ritz_size sizes[RITZ_MOST_SIZES]; /* ended by letter 0 */
    const ritz_member *members;       /* ended by name NULL */
    size_t
        units; /* of a kind: offset of char[RITZ_NAME_SIZE], 0: it has none */
    /** Checks an object before it is written; NULL: nothing is to check. */
    ritz_status (*check)(const void *object);
    /** Checks and completes what was read. */
    ritz_status (*settle)(const ritz_place *place);
};

/*
 * Where the value of a row is: a field; text; the first member of an array of
 * structs; the value of each item of such an array. Shape and meaning follow.
 */
#define RITZ_AT(type, field)                                                   \
    .offset = offsetof(type, field), .size = 0, .item = 0
#define RITZ_TEXT(type, field)                                                 \
    .offset = offsetof(type, field), .size = sizeof(((type *)0)->field),       \
    .item = 0
#define RITZ_LIST(type, field)                                                 \
    .offset = offsetof(type, field), .size = sizeof(*((type *)0)->field),      \
    .item = 0
#define RITZ_ITEM(type, field, item_type, value)                               \
    .offset = offsetof(type, field), .size = sizeof(item_type),                \
    .item = offsetof(item_type, value)

/** Write all members of an object at its place, or read them to its target. */
ritz_status ritz_schema_move(const ritz_place *place);

/** Open a container of any kind that this release reads. */
ritz_status ritz_schema_open(const char *path, char kind[RITZ_NAME_SIZE],
                             hid_t *out);

/** Read a container of one kind into @p object, which is empty before and may
 * be filled in part on failure. */
ritz_status ritz_schema_read(const char *path, const ritz_schema *schema,
                             void *object);

/* Where a walk over the rows of an object stands. */
bool ritz_schema_is_given(const ritz_place *place, const ritz_member *row);
ritz_h5_shape ritz_schema_shape(const ritz_place *place,
                                const ritz_member *row);
ritz_place ritz_schema_part(const ritz_place *place, const ritz_member *row);
ritz_status ritz_schema_items(const ritz_place *place, const ritz_member *row,
                              int64_t *count, ritz_name **out);

/** Value of a letter, of the object or of one that it is part of. */
int64_t ritz_schema_size(const ritz_place *place, char letter);

/* One of each kind of file, and parts that several kinds share. */
extern const ritz_schema ritz_schema_component, ritz_schema_basis,
    ritz_schema_reduced, ritz_schema_state_space, ritz_schema_system,
    ritz_schema_response, ritz_schema_simulation, ritz_schema_ranking,
    ritz_schema_rankings, ritz_schema_recovered, ritz_schema_grids,
    ritz_schema_elements, ritz_schema_recovery, ritz_schema_dampers,
    ritz_schema_io, ritz_schema_columns, ritz_schema_origin,
    ritz_schema_measures, ritz_schema_block;

#endif
