/* Displacements that NASTRAN recovers from the solution of a superelement. */
#ifndef RITZ_FORMATS_NASTRAN_DISPLACEMENTS_H
#define RITZ_FORMATS_NASTRAN_DISPLACEMENTS_H

#include "formats/nastran_elements.h"

typedef struct ritz_nastran_displacements {
    int64_t count;
    ritz_nastran_entry *entry; /* grids and scalar points, ascending */
    ritz_dense A; /* MUG1: u = A q, with q in the order of EXTRN and u along the
                     axes of each grid; 0 of a dof that the component does not
                     have */
    ritz_nastran_elements recovered; /* grids of quantities, and what is left
                                        out of these */
} ritz_nastran_displacements;

/** Displacements of the grids and points of all ports, attached or not, and of
 * those that rows of recovery name. */
ritz_status ritz_nastran_displacements_new(const ritz_reduced *reduced,
                                           const ritz_nastran_rows *rows,
                                           ritz_nastran_displacements *out);

void ritz_nastran_displacements_free(ritz_nastran_displacements *all);

#endif
