/*
 * The parts of ritz_import: requested matrices, names of their rows, ports,
 * inputs and outputs, quantities. Not for users.
 */
#ifndef RITZ_IMPORT_IMPORT_H
#define RITZ_IMPORT_IMPORT_H

#include "model/equations.h"

#include <ritz/import.h>
#include <ritz/model.h>

/* A requested matrix, and which matrix of the component it becomes. */
typedef struct ritz_part {
    const char *spec; /* "kgg.op4:KGG", for messages */
    char *owned;      /* the spec of a load, cut off its name; else NULL */
    const char *what; /* "stiffness" */
    ritz_matrix matrix;
    ritz_sparse *becomes;
    int64_t *place; /* of each of its rows: row of the component */
} ritz_part;

typedef struct ritz_parts {
    int64_t count;
    ritz_part *part;
} ritz_parts;

/* The dofs of all rows, before empty rows are left out. */
typedef struct ritz_row_names {
    int64_t count;
    ritz_dof *dof;
    char map[RITZ_NAME_SIZE]; /* where they come from */
    bool whole; /* all dofs of the deck, its dependent ones among them */
} ritz_row_names;

/** Refuse a dof that does not exist, and name the nearest one. */
ritz_status ritz_roster_miss(const ritz_roster *roster, ritz_dof dof);

/* The deck and the file of names of a request. They are read by another thread
 * while the matrices are read. */
typedef struct ritz_side_files ritz_side_files;

/** Start the thread that reads them. @param[out] out  freed by
   ritz_side_files_end() */
ritz_status ritz_side_files_begin(const ritz_import_request *request,
                                  ritz_side_files **out);

/** Wait until they are read, and take the deck, which is left empty without
 * one. @return what reading it returned, with its sentence */
ritz_status ritz_side_files_deck(ritz_side_files *side, ritz_deck *out);

/** Wait until they are read, and take the names; otherwise as
 * ritz_side_files_deck. */
ritz_status ritz_side_files_names(ritz_side_files *side, ritz_row_names *out);

/** Wait until they are read, and free what was not taken; *side may be NULL. */
void ritz_side_files_end(ritz_side_files **side);

/** Find the names of the rows of all parts, and set `place` of each part. */
ritz_status ritz_names_find(const ritz_import_request *request,
                            const ritz_deck *deck, ritz_side_files *side,
                            ritz_parts *parts, ritz_row_names *out);

/** Whether a text is a mapping file of ANSYS: behind a head of words a line
 * has two whole numbers and a label. */
bool ritz_mapping_recognise(const char *text);

/** The dof of one line of it, which must have this @p equation, from 1 on.
 * @param[out] out  grid 0 of a blank line and of the head */
ritz_status ritz_mapping_line(const char *path, int64_t number,
                              const char *line, int64_t equation,
                              ritz_dof *out);

/** Names in a file of `GRID COMP` rows, or in a mapping file of ANSYS. */
ritz_status ritz_names_of_file(const char *path, ritz_row_names *out);
void ritz_row_names_free(ritz_row_names *names);

/** Parse directions, digits 1 to 6, each once, or a single 0, into flags @p
 * want. */
ritz_status ritz_import_directions(const char *text, bool want[static 7]);

/** Threads that gain from a pass over the entries; at most
 * RITZ_TEAM_SHARES. */
int ritz_part_threads(const ritz_sparse *A);

/** Set @p bit of each row that has a non-zero entry. */
void ritz_part_mark(const ritz_part *part, unsigned char bit,
                    unsigned char *mark);

/** Whether a sorted list contains a dof. */
bool ritz_dof_among(ritz_dof dof, int64_t count, const ritz_dof *sorted);

enum {
    RITZ_TIED_FIXED = 1,   /* u = 0 */
    RITZ_TIED_ALIVE = 2,   /* the dof has stiffness or mass of its own */
    RITZ_TIED_OUTSIDE = 4, /* it is no row: the matrices lack dependent dofs */
};

/* Constraints between the rows, and what becomes of the dofs by them. */
typedef struct ritz_tying {
    const ritz_deck *deck;
    ritz_row_names names; /* all rows of the matrices and dofs of equations */
    unsigned char *mark;  /* of each: sum of RITZ_TIED_... */
    bool acts;            /* matrices have dependent dofs of the deck */
    ritz_elimination by;  /* the equations of the deck solved */
} ritz_tying;

/**
 * Find what constraints do to the rows.
 *
 * @param[in,out] deck   borrowed by @p out
 * @param[in,out] names  moved into @p out; those of parts are placed anew
 */
ritz_status ritz_tying_new(ritz_deck *deck, ritz_parts *parts,
                           ritz_row_names *names,
                           const ritz_component *component,
                           ritz_import_report *report, ritz_tying *out);

/** Solve the equations of the deck and of the ports so far. */
ritz_status ritz_tying_solve(ritz_tying *tying);

/** Add dofs to the names, without marks. */
ritz_status ritz_tying_append(int64_t count, const ritz_dof *dof,
                              ritz_tying *tying);

/** Add the grids, dofs and equations of rigid and averaged ports. */
ritz_status ritz_tying_ports(const ritz_import_request *request,
                             ritz_deck *deck, ritz_tying *tying,
                             ritz_import_report *report);

/** Mark the dofs that follow from some which the matrices do not have. */
void ritz_tying_unknown(const ritz_tying *tying, bool *unknown);

/**
 * Eliminate: A_nn = G'AG of every part.
 *
 * @param[out] kept  names of the rows that stay
 */
ritz_status ritz_tying_apply(const ritz_tying *tying, ritz_parts *parts,
                             ritz_row_names *kept, ritz_import_report *report);

/** Set the recovery: eliminated dofs as combinations of the rows. */
ritz_status ritz_tying_recover(const ritz_tying *tying,
                               ritz_component *component,
                               ritz_import_report *report);
void ritz_tying_free(ritz_tying *tying);

/*
 * A component whose recovered dofs are appended to its rows, so that ports,
 * inputs and outputs can name them. Column k of `from` expresses recovered dof
 * num_rows + k by the rows.
 */
typedef struct ritz_extended {
    ritz_component view; /* dof is owned, the rest borrowed */
    ritz_roster roster;
    int64_t num_rows;
    ritz_sparse from;
    const ritz_equations *equations; /* for messages; NULL: there are none */
} ritz_extended;

/** @param[in] component, equations  borrowed by @p out */
ritz_status ritz_extended_new(const ritz_component *component,
                              const ritz_equations *equations,
                              ritz_extended *out);

/**
 * Add @p value at @p row of the extended rows. A recovered dof, u = G u_n, adds
 * it through G'.
 *
 * @param[in,out] into  one number for each row of the component, @p stride
 *                      apart
 */
void ritz_extended_add(const ritz_extended *extended, int64_t row, double value,
                       int64_t stride, double *into);
void ritz_extended_free(ritz_extended *extended);

enum {
    RITZ_FILE_B,
    RITZ_FILE_C,
    RITZ_FILE_CV,
    RITZ_FILE_CA,
    RITZ_NUM_IO_FILES
};

/* "NAME=F[,KIND]", and the matrix that F is. */
typedef struct ritz_quantity_file {
    char name[RITZ_NAME_SIZE];
    char kind[RITZ_NAME_SIZE];
    char *spec;
    ritz_matrix matrix;
} ritz_quantity_file;

/* Matrices of inputs, outputs and quantities, as files contain them. */
typedef struct ritz_io_files {
    const char *spec[RITZ_NUM_IO_FILES]; /* NULL: not given */
    ritz_matrix matrix[RITZ_NUM_IO_FILES];
    int64_t num_quantities;
    ritz_quantity_file *quantity;
    int64_t num_dofs; /* rows of mass and stiffness as they are read */
    ritz_dof *dof;    /* name of each row */
    /* rows are in this order, whatever their names in files */
    bool in_order;
} ritz_io_files;

/** List the files that the request needs.
 * @param[in,out] count  number of those in @p wanted, which has room */
ritz_status ritz_io_files_want(const ritz_import_request *request,
                               ritz_io_files *files, ritz_wanted *wanted,
                               int64_t *count);

/** Remember the names of all rows, before some of them are eliminated. */
ritz_status ritz_io_files_name(const ritz_import_request *request,
                               const ritz_row_names *names,
                               ritz_io_files *files);

/** Find the numbers of inputs and outputs. @return RITZ_ERR_FORMAT */
ritz_status ritz_io_files_size(const ritz_io_files *files, int64_t *inputs,
                               int64_t *outputs);

/** Fill the last inputs and outputs of @p io, and set their names. */
ritz_status ritz_io_files_add(const ritz_import_request *request,
                              const ritz_deck *deck,
                              const ritz_import_report *report,
                              const ritz_extended *extended,
                              const ritz_io_files *files, ritz_io *io);
void ritz_io_files_free(ritz_io_files *files);

/* Which side of a matrix of inputs, outputs or quantities has the dofs. */
typedef struct ritz_layout {
    int64_t num_dofs;
    const ritz_dof *dof;
    bool across;   /* its columns are dofs; else its rows */
    int64_t count; /* of inputs, outputs or rows of a quantity, on the other */
} ritz_layout;

/** @param[in] input  whether dofs must be rows
 * @return RITZ_ERR_FORMAT if it is complex, or its size does not fit */
ritz_status ritz_layout_find(const ritz_io_files *files,
                             const ritz_matrix *matrix, const char *spec,
                             bool input, ritz_layout *out);

/* In place of a row: the deck fixes the dof, or the component lacks it. */
enum { RITZ_ROW_FIXED = -1, RITZ_ROW_NONE = -2 };

/** The row of each dof among extended rows, or RITZ_ROW_...; the caller frees
 * it. */
ritz_status ritz_layout_rows(const ritz_layout *layout, const ritz_deck *deck,
                             const ritz_extended *extended, int64_t **out);

/** Fail because a matrix has an entry for a dof that the component lacks. */
ritz_status ritz_layout_refuse(const char *spec,
                               const ritz_import_report *report,
                               const ritz_extended *extended, ritz_dof dof);

/** Parse the texts "NAME=F[,KIND]" of a request. @return RITZ_ERR_ARGUMENT */
ritz_status ritz_quantity_files_name(const ritz_import_request *request,
                                     ritz_io_files *files);

/** Make the quantities of the component from their files. */
ritz_status ritz_quantity_files_add(const ritz_import_request *request,
                                    const ritz_deck *deck,
                                    const ritz_import_report *report,
                                    const ritz_extended *extended,
                                    const ritz_io_files *files,
                                    ritz_component *component);
void ritz_quantity_file_free(ritz_quantity_file *file);

/**
 * Parse @p count names "a,b,c", each of which occurs once; without a list they
 * are "u1", "u2", ... for the prefix u.
 *
 * @param[in,out] limit  set by "NAME@LIMIT", otherwise unchanged; NULL: names
 *                       have no limits
 * @return RITZ_ERR_ARGUMENT
 */
ritz_status ritz_import_channels(const char *list, char prefix, int64_t count,
                                 char (*name)[RITZ_NAME_SIZE], double *limit);

/**
 * Add the files of a component in modal form to the parts.
 *
 * @return RITZ_ERR_ARGUMENT if the request also has matrices or names of rows
 */
ritz_status ritz_modal_want(const ritz_import_request *request,
                            ritz_component *component, ritz_parts *parts);

/** Make stiffness, damping and mass from the content of these files. */
ritz_status ritz_modal_make(const ritz_import_request *request,
                            ritz_component *component, ritz_parts *parts);

/**
 * Add the ports of the request, also those at grids made for ports, its inputs,
 * outputs and dampers.
 *
 * @param[in] deck  its supports; its equations, for messages about dofs that
 *                  depend on others
 */
ritz_status ritz_import_attach(const ritz_import_request *request,
                               const ritz_deck *deck,
                               const ritz_import_report *report,
                               const ritz_io_files *files,
                               ritz_component *component);

/**
 * One port; its dofs are rows of @p extended, and no recovered ones.
 *
 * @param[in] whole  a grid with axes of its own must bring all translations or
 *                   none, and the same of rotations
 */
ritz_status ritz_import_port(const char *text, bool whole,
                             const ritz_extended *extended, ritz_port *out);

/**
 * Add loads that act to the stiffness of a component whose matrices are settled.
 *
 * @return RITZ_ERR_ARGUMENT if there is no geometric stiffness of a load
 */
ritz_status ritz_import_preload(const ritz_import_request *request,
                                ritz_component *component);

/** A label, in which '/' divides: "N/mm". @return RITZ_ERR_ARGUMENT */
ritz_status ritz_import_units(const char *text, char out[RITZ_NAME_SIZE]);

#endif
