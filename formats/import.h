/*
 * Parts of ritz_import: matrices that were asked for, names of their rows,
 * ports, inputs and outputs. Not for users.
 */
#ifndef RITZ_FORMATS_IMPORT_H
#define RITZ_FORMATS_IMPORT_H

#include <ritz/bulk.h>
#include <ritz/component.h>
#include <ritz/foreign.h>
#include <ritz/import.h>

/* A matrix that was asked for, and which one of the component it becomes. */
typedef struct ritz_part {
    const char *spec; /* "kgg.op4:KGG", for messages */
    ritz_matrix matrix;
    ritz_sparse *becomes;
    int64_t *place; /* row of the component-to-be of each of its rows */
} ritz_part;

typedef struct ritz_parts {
    int64_t count;
    ritz_part *part;
} ritz_parts;

/* What the rows of all matrices are, before empty ones are left out. */
typedef struct ritz_names {
    int64_t count;
    ritz_dof *dof;
    char map[RITZ_NAME_SIZE]; /* where they come from */
} ritz_names;

/* Rows by name: sorted, so that a name is found in O(log n). */
typedef struct ritz_place {
    ritz_dof dof;
    int64_t row;
} ritz_place;

typedef struct ritz_roster {
    int64_t count;
    ritz_place *place;
} ritz_roster;

/** Roster of @p count dofs; a repeated one is refused. */
ritz_status ritz_roster_new(int64_t count, const ritz_dof *dof,
                            ritz_roster *out);

/** Row of a dof, -1 if there is none. */
int64_t ritz_roster_row(const ritz_roster *roster, ritz_dof dof);

/** First place whose grid is not below @p grid; count if there is none. */
int64_t ritz_roster_from(const ritz_roster *roster, int64_t grid);

/** Record that a dof is not there, and what is near; the status to return. */
ritz_status ritz_roster_miss(const ritz_roster *roster, ritz_dof dof);
void ritz_roster_free(ritz_roster *roster);

/** Name the rows of all parts, and give each part its places. */
ritz_status ritz_names_find(const ritz_import_request *request,
                            const ritz_bulk *bulk, ritz_parts *parts,
                            ritz_names *out);

/** Names that a deck has for @p spec, n rows. @return RITZ_ERR_FORMAT */
ritz_status ritz_names_of_deck(const ritz_bulk *bulk, int64_t n,
                               const char *spec, ritz_names *out);

/** Names in a file of `GRID COMP` rows. */
ritz_status ritz_names_of_file(const char *path, ritz_names *out);
void ritz_names_free(ritz_names *names);

/** Put the parts into the component, rows empty in K and M left out. */
ritz_status ritz_parts_settle(ritz_parts *parts, const ritz_bulk *bulk,
                              const ritz_names *names,
                              ritz_component *component,
                              ritz_import_report *report);
void ritz_parts_free(ritz_parts *parts);

/** Ports as the request states them. */
ritz_status ritz_import_ports(const ritz_import_request *request,
                              const ritz_roster *roster,
                              ritz_component *component);

/** Inputs and outputs as the request states them. */
ritz_status ritz_import_io(const ritz_import_request *request,
                           const ritz_roster *roster,
                           ritz_component *component);

/**
 * Take "NAME=REST" apart.
 *
 * @param[out] rest  points behind the '='
 * @return RITZ_ERR_ARGUMENT with @p form, what it should look like
 */
ritz_status ritz_import_split(const char *text, const char *form,
                              char name[RITZ_NAME_SIZE], const char **rest);

#endif
