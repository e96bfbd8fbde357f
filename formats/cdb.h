/* What the lines of a coded database of ANSYS say, before a deck is made of it:
 * private to the reader. */
#ifndef RITZ_FORMATS_CDB_H
#define RITZ_FORMATS_CDB_H

#include "formats/cards.h"
#include "formats/deck_files.h"

#include <ritz/import.h>

enum { RITZ_CDB_MASS21 = 21 }; /* whose directions KEYOPT(3) tells */

typedef struct ritz_cdb_node {
    int64_t id, line;
    double x[3];
    double angle[3]; /* THXY, THYZ, THZX, in degrees */
} ritz_cdb_node;

/* An element of the library, by its number. */
typedef struct ritz_cdb_kind {
    int64_t number; /* 185 of SOLID185 */
    int64_t size;   /* nodes with dofs, which draw it; others may follow */
    ritz_cell cell; /* 0: it is not drawn */
    uint8_t mask;   /* bit c: its nodes have direction c; 0: not known */
    bool ties;      /* it makes dofs depend on others */
} ritz_cdb_kind;

/* ET and KEYOPT of a number of element type. */
typedef struct ritz_cdb_type {
    int64_t number;            /* by which elements refer to it */
    const ritz_cdb_kind *kind; /* NULL: it is not known */
    int64_t option_3;          /* KEYOPT(3) */
} ritz_cdb_type;

typedef struct ritz_cdb_element {
    int64_t id;    /* 0: none */
    int64_t type;  /* the number of its element type */
    int64_t first; /* its first node in `joined` */
    int64_t count; /* nodes, with those that are 0 */
    int64_t line;
} ritz_cdb_element;

/* D: a support. */
typedef struct ritz_cdb_support {
    int64_t node; /* 0: all */
    uint8_t mask; /* bit c: direction c */
    bool imposed; /* the motion is not zero, or a table has it */
    int64_t line;
} ritz_cdb_support;

/* CE, CP and the like. */
typedef struct ritz_cdb_tie {
    char name[RITZ_NAME_SIZE];
    int64_t line;
} ritz_cdb_tie;

/* Everything that the lines say. */
typedef struct ritz_cdb {
    ritz_deck_files files;
    ritz_deck_reading reading;
    int64_t num_nodes, nodes_room;
    ritz_cdb_node *node;
    int64_t num_types, types_room;
    ritz_cdb_type *type; /* by number, ascending */
    int64_t num_elements, elements_room;
    ritz_cdb_element *element;
    int64_t num_joined, joined_room;
    int64_t *joined; /* nodes of all elements; 0: there is none */
    int64_t num_supports, supports_room;
    ritz_cdb_support *support;
    int64_t num_ties, ties_room;
    ritz_cdb_tie *tie;
    int64_t num_strange; /* elements that are not read */
    int64_t open_type;   /* set by TYPE, for EBLOCK without SOLID */
    bool turned;         /* CSYS: N is not along global axes */
    bool chosen;         /* NSEL: ALL is some of the nodes */
    int64_t conditions;  /* *IF ... THEN that are open */
} ritz_cdb;

/** The element of the library called @p text, "185" or "SOLID185"; NULL: it is
 * not known. */
const ritz_cdb_kind *ritz_cdb_find_kind(ritz_piece text);

/** The row of a number of element type, or the one where it belongs. */
int64_t ritz_cdb_seek_type(const ritz_cdb *all, int64_t number);

/** The row of that number of element type; NULL: there is none. */
ritz_cdb_type *ritz_cdb_find_type(const ritz_cdb *all, int64_t number);

/** Fail about a line. */
[[gnu::format(printf, 3, 4)]] ritz_status
ritz_cdb_refuse(const ritz_cdb *all, int64_t line, const char *format, ...);

/** Put together what the lines say. */
ritz_status ritz_cdb_build(ritz_cdb *all, ritz_deck *out);

#endif
