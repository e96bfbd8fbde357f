/*
 * Decks: the input files of finite-element codes, as far as a component needs
 * them. Of elements only the grids that they join are kept, and the equations
 * of those that make dofs depend on others.
 */
#ifndef RITZ_DECK_H
#define RITZ_DECK_H

#include <ritz/component.h>
#include <ritz/elements.h>
#include <ritz/equations.h>

#pragma GCC visibility push(default)

/* Sets of dofs that a code keeps when it reduces matrices. */
enum { RITZ_SET_A, RITZ_SET_B, RITZ_SET_Q, RITZ_NUM_SETS };

typedef struct ritz_deck {
    const struct ritz_deck_format *format; /* that read it */
    ritz_grids grids; /* positions in the basic frame, displacement frames */
    int64_t num_points;
    int64_t *point; /* ids of scalar points, ascending */
    int64_t num_dofs;
    ritz_dof *dof; /* of all grids and points, in the order in which the code
                      numbers the rows of its matrices */
    int64_t num_fixed;
    ritz_dof *fixed; /* supports u = 0, each once, sorted */
    int64_t num_sets[RITZ_NUM_SETS];
    ritz_dof *set[RITZ_NUM_SETS]; /* sorted */
    int64_t num_constraints;
    char (*constraint)[RITZ_NAME_SIZE]; /* "RBE2 600": what makes dofs depend on
                                           others */
    ritz_equations equations;           /* what these state; `refused` says why
                                           it is not all of that */
    ritz_elements elements; /* for pictures; grids need not be there */
    int64_t num_strange;    /* elements whose grids are not understood */
    char *imposed; /* sentence about a support that moves its dof; NULL: none
                      does */
} ritz_deck;

typedef struct ritz_deck_format {
    const char *name;      /* "bulk" */
    const char *title;     /* "NASTRAN bulk data" */
    const char *reference; /* key in docs/references.bib */
    /** True if these bytes look like the format. @p size may be 0. */
    bool (*recognise)(const char *bytes, int64_t size);
    /**
     * Read the deck; a NUL follows its bytes. A constraint that is not
     * understood is no failure here, but in equations.refused: matrices may
     * have been made without its dofs.
     *
     * @param[in] path    for messages; NULL: they begin with the line
     * @param[in] folder  to which included files are relative
     * @param[out] out    empty; freed by the caller after a failure too
     * @return RITZ_ERR_FORMAT with file and line, and what is wrong there
     */
    ritz_status (*parse)(const char *path, const char *bytes, int64_t size,
                         const char *folder, ritz_deck *out);
} ritz_deck_format;

/** All formats of decks, ended by NULL; the first that recognises a file reads
 * it. */
extern const ritz_deck_format *const ritz_decks[];
extern const ritz_deck_format ritz_deck_nastran;

/** The format of these bytes; NULL if no format knows them. */
const ritz_deck_format *ritz_deck_recognise(const char *bytes, int64_t size);

/** Recognise and read; @return RITZ_ERR_FORMAT if no format knows it. */
ritz_status ritz_deck_read(const char *path, ritz_deck *out);

/** Recognise and read bytes, which a NUL follows. */
ritz_status ritz_deck_parse(const char *path, const char *bytes, int64_t size,
                            const char *folder, ritz_deck *out);

void ritz_deck_free(ritz_deck *deck);

#pragma GCC visibility pop

#endif
