/* Rows of matrices for NASTRAN, shared by its exporters. */
#ifndef RITZ_FORMATS_NASTRAN_ROWS_H
#define RITZ_FORMATS_NASTRAN_ROWS_H

#include <ritz/export.h>

enum { RITZ_NASTRAN_MOST_ID = 99999999 }; /* of grids, points and others */

/* The dof of each coordinate of a reduced component. */
typedef struct ritz_nastran_rows {
    int64_t order; /* r */
    ritz_dof *dof; /* r */
    int64_t *at;   /* r, coordinates with their dofs ascending: those of grids,
                      then scalar points */
    int64_t num_interface; /* dofs of grids */
    int64_t first_point;   /* number of the first scalar point; the others
                              follow in the order of columns */
} ritz_nastran_rows;

/**
 * A coordinate belongs to a grid if its column is that of a constraint, whose
 * row of T is a unit vector: then q_j is that displacement itself, along the
 * grid's own axes. All others become scalar points, with numbers behind the
 * next power of ten above all grids or, if there is no room, behind the last
 * grid.
 *
 * @param[in] format  for messages: "DMIG"
 * @return RITZ_ERR_ARGUMENT if an attached dof has no such coordinate, none has
 *         one, there is no basis, or numbers do not suffice
 */
ritz_status ritz_nastran_rows_new(const ritz_reduced *reduced,
                                  const char *format, ritz_nastran_rows *out);

/** Say which coordinates are dofs of grids and which are points. */
ritz_status ritz_nastran_rows_say(const ritz_nastran_rows *rows,
                                  ritz_export_report *report);

/** Say which ports have a grid without such a coordinate. @param[in] words
 * what becomes of such a port */
ritz_status ritz_nastran_rows_say_ports(const ritz_nastran_rows *rows,
                                        const ritz_reduced *reduced,
                                        const char *words,
                                        ritz_export_report *report);

void ritz_nastran_rows_free(ritz_nastran_rows *rows);

#endif
