/* Displacements that NASTRAN recovers of a superelement. */
#ifndef RITZ_FORMATS_NASTRAN_DISPLACEMENTS_H
#define RITZ_FORMATS_NASTRAN_DISPLACEMENTS_H

#include "formats/nastran_rows.h"

#include <stdio.h>

/* A grid or scalar point whose displacements are rows of MUG1. */
typedef struct ritz_nastran_point {
    int64_t id, first, count; /* its rows, the first from 0: six, or one */
} ritz_nastran_point;

typedef struct ritz_nastran_displacements {
    int64_t count;
    ritz_nastran_point *point; /* ascending */
    ritz_dense A; /* MUG1: u = A q, with q in the order of EXTRN and u along the
                     axes of each grid; 0 of a dof that the component does not
                     have */
} ritz_nastran_displacements;

/** Displacements of the grids and points of all ports, attached or not. */
ritz_status ritz_nastran_displacements_new(const ritz_reduced *reduced,
                                           const ritz_nastran_rows *rows,
                                           ritz_nastran_displacements *out);

/** Put the table DTI TUG1, which says whose displacements the rows are. */
void ritz_nastran_displacements_put(FILE *file,
                                    const ritz_nastran_displacements *all);

void ritz_nastran_displacements_free(ritz_nastran_displacements *all);

#endif
