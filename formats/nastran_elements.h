/* Rows of recovery that have a place in NASTRAN's matrices. */
#ifndef RITZ_FORMATS_NASTRAN_ELEMENTS_H
#define RITZ_FORMATS_NASTRAN_ELEMENTS_H

#include "formats/nastran_rows.h"
#include "formats/nastran_tables.h"

typedef struct ritz_nastran_elements {
    int64_t count;
    ritz_nastran_entry *entry; /* each element of which all rows are there */
    int64_t num_rows;
    const double **row;               /* its first entry in ST, for each row */
    int64_t *stride;                  /* to the entry of the next coordinate */
    int64_t num_left;                 /* rows that are none of NASTRAN's */
    char (*left)[2 * RITZ_NAME_SIZE]; /* "'stress' element 12 sx" */
    bool corrected; /* there is mode acceleration, which is left out */
} ritz_nastran_elements;

/**
 * The rows of all quantities of a kind that name whole elements (or grids) of
 * NASTRAN. Elements of a type stand together with ascending numbers, types in
 * the order in which they occur.
 *
 * @param[in] reduced  borrowed by @p out
 */
ritz_status ritz_nastran_elements_new(const ritz_reduced *reduced,
                                      const char *kind,
                                      ritz_nastran_elements *out);

/** The matrix of these rows, with columns in the order of @p rows. */
ritz_status ritz_nastran_elements_matrix(const ritz_nastran_elements *elements,
                                         const ritz_nastran_rows *rows,
                                         ritz_dense *out);

/** Say what is written as @p matrix, and which rows are left out.
 * @param[in] matrix  "MES1" */
ritz_status ritz_nastran_elements_say(const ritz_nastran_elements *elements,
                                      const char *kind, const char *matrix,
                                      ritz_export_report *report);

void ritz_nastran_elements_free(ritz_nastran_elements *elements);

#endif
