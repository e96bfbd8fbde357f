/* An input file of Abaqus or CalculiX between its lines and the deck: private
 * to the reader. */
#ifndef RITZ_FORMATS_INP_H
#define RITZ_FORMATS_INP_H

#include "formats/cards.h"
#include "formats/deck_files.h"

#include <ritz/import.h>

/* Where a line is, for sentences. */
typedef struct ritz_inp_place {
    int64_t file; /* of the deck's files */
    int64_t line;
} ritz_inp_place;

/* A line taken apart at its commas. */
typedef struct ritz_inp_fields {
    int64_t count, room;
    ritz_piece *field; /* without blanks around them */
    bool continues;    /* the line ends with a comma */
    ritz_inp_place place;
} ritz_inp_fields;

enum { RITZ_INP_PARAMETERS = 32 };

/* "*NODE, NSET=ALL" */
typedef struct ritz_inp_keyword {
    ritz_piece name; /* "NODE", as it is written */
    int64_t count;
    ritz_piece key[RITZ_INP_PARAMETERS];
    ritz_piece value[RITZ_INP_PARAMETERS]; /* without quotes; empty: none */
    ritz_piece odd; /* the first word in a continuation line that cannot be a
                       parameter; empty: there is none */
    ritz_inp_place place;
} ritz_inp_keyword;

typedef struct ritz_inp_node {
    int64_t id;
    int64_t order; /* in the deck, from 0 */
    ritz_inp_place place;
    double x[3];
} ritz_inp_node;

/* A type of element. */
typedef struct ritz_inp_type {
    const char *name;     /* "C3D8" */
    const char *variants; /* what may follow the name: "R I" */
    int64_t size;         /* nodes; a line of 3 is drawn as two lines */
    ritz_cell cell;       /* 0: it has one node, and is not drawn */
    uint8_t mask;         /* bit c: its nodes have direction c; 0: which
                             directions they have is not known */
    bool expanded;        /* CalculiX makes solids of it */
} ritz_inp_type;

typedef struct ritz_inp_element {
    const ritz_inp_type *type;
    int64_t id;
    int64_t first; /* of its nodes */
    ritz_inp_place place;
} ritz_inp_element;

/* A node or a set, as a data line names it. */
typedef struct ritz_inp_named {
    int64_t id;      /* 0: it is a set */
    ritz_piece name; /* of the set */
    bool inner;      /* the line is inside of a part or an instance */
    ritz_inp_place place;
} ritz_inp_named;

/* Members of a set: ids from, from + step, ... up to `to`, or another set. */
typedef struct ritz_inp_member {
    int64_t from, to, step;
    ritz_inp_named other; /* if step is 0 */
    int64_t next;         /* member of the same set; -1: it is the last */
} ritz_inp_member;

typedef struct ritz_inp_set {
    ritz_piece name;
    bool inner;          /* of a part or an instance */
    bool of_elements;    /* it also has the nodes of a set of elements */
    int64_t first, last; /* members; -1: there are none */
} ritz_inp_set;

/* BOUNDARY: u = 0 in these directions. */
typedef struct ritz_inp_support {
    ritz_inp_named nodes;
    uint8_t mask; /* bit c: direction c */
    bool imposed; /* the motion is not zero, or another source has it */
} ritz_inp_support;

/* A term of EQUATION. */
typedef struct ritz_inp_term {
    ritz_inp_named node;
    int64_t component;
    double factor;
} ritz_inp_term;

/* What makes dofs depend on others. */
typedef struct ritz_inp_constraint {
    const char *keyword; /* "EQUATION", "TIE" */
    int64_t first;       /* of its terms */
    int64_t count;       /* 0: it is not understood */
    ritz_inp_place place;
} ritz_inp_constraint;

/* The program that made the matrices, as far as the deck shows it. */
typedef enum ritz_inp_program {
    RITZ_INP_UNKNOWN,
    RITZ_INP_ABAQUS,
    RITZ_INP_CALCULIX
} ritz_inp_program;

/* A part or an instance. */
typedef struct ritz_inp_container {
    int64_t number; /* from 1; 0: none, -1: not known yet */
    bool is_part;
    ritz_piece name;
} ritz_inp_container;

typedef struct ritz_inp ritz_inp;

/* Everything that the lines say, before it is put together. */
struct ritz_inp {
    ritz_deck_files files;
    ritz_deck_reading reading;
    bool held;       /* the last line is to be read once more */
    bool unfollowed; /* the deck includes files that are not read */
    ritz_inp_fields fields;
    ritz_inp_keyword keyword; /* to which data lines belong */
    /* takes one of them; NULL: they are passed over */
    ritz_status (*take)(ritz_inp *all);

    int64_t num_nodes, nodes_room;
    ritz_inp_node *node; /* sorted by id, each once, once placed */
    int64_t num_elements, elements_room;
    ritz_inp_element *element;
    int64_t num_joined, joined_room;
    int64_t *joined;     /* ids of the nodes of all elements */
    int64_t num_strange; /* elements of types that are not known */
    int64_t num_sets, sets_room;
    ritz_inp_set *set;
    int64_t num_slots;
    int64_t *slot; /* hash table of the names of sets: k + 1 for set k, 0 for an
                      empty slot */
    int64_t num_members, members_room;
    ritz_inp_member *member;
    int64_t num_supports, supports_room;
    ritz_inp_support *support;
    int64_t num_terms, terms_room;
    ritz_inp_term *term;
    int64_t num_constraints, constraints_room;
    ritz_inp_constraint *constraint;

    /* of the keyword that is read */
    const ritz_inp_type *type; /* NULL: it is not known */
    int64_t into;              /* set that takes nodes; -1: none does */
    int64_t begun;             /* element whose nodes are read; 0: none */
    int64_t due;               /* terms of an equation that are to come */
    int64_t lines;             /* of data so far */
    bool imposed;              /* another source moves supports */

    /* of the deck so far */
    ritz_inp_program program;
    int64_t step;             /* number of steps */
    int64_t step_of_support;  /* step with supports; 0: none has them */
    int64_t step_of_matrices; /* first step that makes matrices; 0: none */
    int64_t supports_before;  /* of the step that is open */
    int64_t num_containers;
    ritz_inp_container open;  /* that is read */
    ritz_inp_container home;  /* that has the nodes */
    ritz_inp_place instance;  /* line 0: there is none */
    ritz_piece instance_name; /* and the part that it is of */
    ritz_piece instance_of;
    double shift[3]; /* of the instance */
    /* first lines that leave rows open; line 0: there is none */
    ritz_inp_place strange; /* a type whose rows are not known */
    ritz_piece strange_type;
    ritz_inp_place expanded; /* a type that CalculiX makes solids of */
    const ritz_inp_type *expanded_type;
    ritz_inp_place unordered; /* a node with a number below the one above it */
};

/* ---- lines (inp_lines.c) ------------------------------------------------- */

/** Take the next line that is neither blank nor a comment, without blanks
 * around it. @return false at the end of the deck */
bool ritz_inp_line(ritz_inp *all, ritz_piece *out);

/** Take a line apart: `fields`. A comma inside of quotes does not count. */
ritz_status ritz_inp_split(ritz_inp *all, ritz_piece line);

/** Read the keyword that begins with @p line, with the lines that continue it:
 * `keyword`. */
ritz_status ritz_inp_take_keyword(ritz_inp *all, ritz_piece line);

/** The value of a parameter, empty if it has none; NULL: it is not there. */
const ritz_piece *ritz_inp_parameter(const ritz_inp_keyword *keyword,
                                     const char *key);

/** Go on with the file that the parameter INPUT names, if there is one; where
 * included files are not followed it is passed over. */
ritz_status ritz_inp_follow(ritz_inp *all);

/** Whether a text is a word, whatever its case and blanks. */
bool ritz_inp_is(ritz_piece piece, const char *word);

/** A name without the quotes around it. */
ritz_piece ritz_inp_unquote(ritz_piece piece);

/** Whether two names are equal, whatever their case. */
bool ritz_inp_same(ritz_piece a, ritz_piece b);

/** Field @p k of the line; empty beyond its end. */
ritz_piece ritz_inp_field(const ritz_inp *all, int64_t k);

/** The field as an id, a number of a direction, a real number (0 if empty), and
 * a node or a set. */
ritz_status ritz_inp_id(const ritz_inp *all, int64_t k, int64_t *out);
ritz_status ritz_inp_direction(const ritz_inp *all, int64_t k, int64_t *out);
ritz_status ritz_inp_real(const ritz_inp *all, int64_t k, double *out);
ritz_status ritz_inp_name(const ritz_inp *all, int64_t k, ritz_inp_named *out);

/** Whether a text is a whole number, and its value. */
bool ritz_inp_whole(ritz_piece piece, int64_t *out);

/** Fail about a line. */
[[gnu::format(printf, 3, 4)]] ritz_status ritz_inp_refuse(const ritz_inp *all,
                                                          ritz_inp_place place,
                                                          const char *format,
                                                          ...);

/* Of a piece in sentences: its length, at most 40, and its text. */
#define RITZ_INP_QUOTED(piece)                                                 \
    (int)((piece).length < 40 ? (piece).length : 40), (piece).text

/* ---- elements, sets, and what they say together -------------------------- */

/** The type of that name; NULL: it is not known. */
const ritz_inp_type *ritz_inp_find_type(ritz_piece name);

/** Members of the keyword's set: ids or names; or ranges, with GENERATE. */
ritz_status ritz_inp_take_members(ritz_inp *all);
ritz_status ritz_inp_take_ranges(ritz_inp *all);

/** The set of that name, which is made if it is not there. */
ritz_status ritz_inp_open_set(ritz_inp *all, ritz_piece name, int64_t *out);

/** Append ids to a set. */
ritz_status ritz_inp_add_range(ritz_inp *all, int64_t set, int64_t from,
                               int64_t to, int64_t step);

/* State of ritz_inp_mark() that its calls share. Sets may contain sets, in
 * circles too, so each call visits a set once, and the number of nodes and sets
 * that all calls visit is limited. */
typedef struct ritz_inp_marks {
    int64_t work;     /* nodes and sets that were visited so far */
    int64_t turn;     /* number of the call, of those that name a set */
    int64_t *set;     /* sets to visit in this call; NULL before the first */
    int64_t *turn_of; /* for each set, the last call that visited it */
} ritz_inp_marks;

void ritz_inp_marks_free(ritz_inp_marks *marks);

/** Set the bits @p mask in into[k] for each node k that @p named names, itself
 * or by a set; k is the index among the sorted nodes. */
ritz_status ritz_inp_mark(const ritz_inp *all, const ritz_inp_named *named,
                          uint8_t mask, ritz_inp_marks *marks, uint8_t *into);

/** Index of a node among the sorted nodes; -1 if there is none of that id. */
int64_t ritz_inp_find(const ritz_inp *all, int64_t id);

/** The same of a node that a line names; it must be there, and be no set. */
ritz_status ritz_inp_locate(const ritz_inp *all, const ritz_inp_named *named,
                            int64_t *out);

/** Put together what the lines say. */
ritz_status ritz_inp_build(ritz_inp *all, ritz_deck *out);

#endif
