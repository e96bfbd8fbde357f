/* The rows of matrices for NASTRAN; for its exporters. */
#ifndef RITZ_FORMATS_NASTRAN_ROWS_H
#define RITZ_FORMATS_NASTRAN_ROWS_H

#include <ritz/export.h>

enum { RITZ_NASTRAN_MOST_ID = 99999999 }; /* largest number of a card */

/* The grid and direction, or scalar point, of each reduced coordinate. */
typedef struct ritz_nastran_rows {
    int64_t order; /* r */
    ritz_dof *dof; /* r */
    int64_t *at;   /* r, the coordinates in ascending order of their dofs:
                      those of grids, then scalar points */
    int64_t num_interface; /* coordinates that are dofs of grids */
    int64_t first_point;   /* number of the scalar point of the first other
                              coordinate; the next have the next numbers */
} ritz_nastran_rows;

/**
 * Find the dof of each coordinate. If column j of the basis is a constraint
 * mode and the row of its dof in T is the unit vector e_j, then q_j is the
 * displacement of that dof, along the axes of its grid. All other coordinates
 * become scalar points, with numbers after the next power of ten above all
 * grids or, if there is no room, after the last grid.
 *
 * @param[in] format  for messages: "DMIG"
 * @return RITZ_ERR_ARGUMENT if no coordinate is the displacement of an attached
 *         dof, no dof is attached, there is no basis, or there are not enough
 *         numbers for scalar points
 */
ritz_status ritz_nastran_rows_new(const ritz_reduced *reduced,
                                  const char *format, ritz_nastran_rows *out);

/** Report how many coordinates are dofs of grids, and which are points. */
ritz_status ritz_nastran_rows_say(const ritz_nastran_rows *rows,
                                  ritz_export_report *report);

/** Report ports with grids whose displacements are not coordinates.
 * @param[in] words  what the format does with such a port, for the sentence */
ritz_status ritz_nastran_rows_say_ports(const ritz_nastran_rows *rows,
                                        const ritz_reduced *reduced,
                                        const char *words,
                                        ritz_export_report *report);

void ritz_nastran_rows_free(ritz_nastran_rows *rows);

#endif
