/*
 * NASTRAN bulk data: the geometry and the sets that a deck states, nothing of
 * its elements but which grids they join, and those that eliminate dofs.
 */
#ifndef RITZ_BULK_H
#define RITZ_BULK_H

#include <ritz/component.h>
#include <ritz/elements.h>
#include <ritz/equations.h>

typedef struct ritz_bulk {
    ritz_grids grids; /* positions in the basic frame, displacement frames */
    int64_t num_points;
    int64_t *point; /* SPOINT ids, ascending */
    int64_t num_fixed;
    ritz_dof *fixed; /* SPC1, SPC, and field 8 of GRID, each once, sorted; of
                        SPC sets those that the case control selects, all if
                        it selects none */
    int64_t num_sets[3];
    ritz_dof *set[3]; /* ASET1/ASET, BSET1/BSET, QSET1/QSET, sorted */
    int64_t num_constraints;
    char (*constraint)[RITZ_NAME_SIZE]; /* "RBE2 600": elements that eliminate
                                           dofs, and MPC sets that act: selected
                                           as SPC sets are */
    ritz_equations equations;           /* what these state; `refused` says why
                                           it is not all of that */
    ritz_elements elements; /* for pictures; grids need not be there */
    int64_t num_strange;    /* elements whose grids are not understood */
    char *imposed; /* of an SPC that acts and moves its dof; NULL: none does */
} ritz_bulk;

enum { RITZ_SET_A, RITZ_SET_B, RITZ_SET_Q };

/**
 * Read a deck or a bulk data file: small, large and free field, continuations,
 * INCLUDE (relative to the including file), comments. Executive and case
 * control are skipped. Cards that do not concern geometry are passed over. A
 * constraint element that is not understood is no failure here, but in
 * equations.refused: matrices may have been made without its dofs.
 *
 * @return RITZ_ERR_FORMAT with file and line, and what is wrong with the card
 */
ritz_status ritz_bulk_read(const char *path, ritz_bulk *out);

/** The same from text; INCLUDE is then relative to the folder @p folder. */
ritz_status ritz_bulk_parse(const char *path, const char *text,
                            const char *folder, ritz_bulk *out);

void ritz_bulk_free(ritz_bulk *bulk);

#endif
