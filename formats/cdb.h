/* The contents of a coded database of ANSYS as cdb.c reads them; cdb_deck.c
 * makes a deck of them. */
#ifndef RITZ_FORMATS_CDB_H
#define RITZ_FORMATS_CDB_H

#include "formats/cards.h"
#include "formats/deck_files.h"

#include <ritz/import.h>

enum { RITZ_CDB_MASS21 = 21 }; /* KEYOPT(3) chooses its directions */

/* Directions of a node: bit c is direction c. */
enum {
    RITZ_CDB_PLANE = 0x06,   /* UX UY */
    RITZ_CDB_FRAME = 0x46,   /* UX UY ROTZ */
    RITZ_CDB_SOLID = 0x0e,   /* UX UY UZ */
    RITZ_CDB_ALL_SIX = 0x7e, /* and ROTX ROTY ROTZ */
};

typedef struct ritz_cdb_node {
    int64_t id, line;
    double x[3];
    double angle[3]; /* THXY, THYZ, THZX, in degrees */
} ritz_cdb_node;

/* An element of the library of ANSYS. */
typedef struct ritz_cdb_kind {
    int64_t number; /* 185 of SOLID185 */
    int64_t size;   /* nodes that have dofs and make the cell; orientation nodes
                       may follow */
    ritz_cell cell; /* 0: it is not drawn */
    uint8_t mask;   /* directions of its nodes; 0: not known */
    bool ties;      /* it makes dofs depend on others */
} ritz_cdb_kind;

/* An element type of the file: the commands ET and KEYOPT. */
typedef struct ritz_cdb_type {
    int64_t number;            /* elements refer to the type by it */
    const ritz_cdb_kind *kind; /* NULL: not in the table of the library */
    int64_t option_3;          /* KEYOPT(3) */
} ritz_cdb_type;

typedef struct ritz_cdb_element {
    int64_t id;    /* 0: none */
    int64_t type;  /* number of its element type */
    int64_t first; /* its first node in `joined` */
    int64_t count; /* nodes, with those that are 0 */
    int64_t line;
} ritz_cdb_element;

/* A support: the command D. */
typedef struct ritz_cdb_support {
    int64_t node; /* 0: all */
    uint8_t mask; /* directions that it holds */
    bool imposed; /* the motion is not zero, or a table gives it */
    int64_t line;
} ritz_cdb_support;

/* A constraint: CE, CP, CERIG, RBE3, CEINTF or an element that ties nodes. */
typedef struct ritz_cdb_tie {
    char name[RITZ_NAME_SIZE];
    int64_t line;
} ritz_cdb_tie;

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
    int64_t open_type;   /* the command TYPE; for EBLOCK without SOLID */
    bool turned;         /* CSYS: coordinates of N are not global ones */
    bool chosen;         /* NSEL: only some nodes are selected */
    int64_t conditions;  /* nested *IF ... THEN around the line */
} ritz_cdb;

/** Find an element of the library by its name, "185" or "SOLID185".
 * @return NULL if it is not known */
const ritz_cdb_kind *ritz_cdb_find_kind(ritz_piece text);

/** Index of the element type with this number, or the index at which to insert
 * it. */
int64_t ritz_cdb_seek_type(const ritz_cdb *all, int64_t number);

/** The element type with this number; NULL if there is none. */
ritz_cdb_type *ritz_cdb_find_type(const ritz_cdb *all, int64_t number);

/** Fail with RITZ_ERR_FORMAT and a sentence that begins with file and line. */
[[gnu::format(printf, 3, 4)]] ritz_status
ritz_cdb_refuse(const ritz_cdb *all, int64_t line, const char *format, ...);

/** Make a deck of the contents of the file. */
ritz_status ritz_cdb_build(ritz_cdb *all, ritz_deck *out);

#endif
