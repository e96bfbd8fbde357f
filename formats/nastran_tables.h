/* Tables that name the rows of NASTRAN's matrices of recovery. */
#ifndef RITZ_FORMATS_NASTRAN_TABLES_H
#define RITZ_FORMATS_NASTRAN_TABLES_H

#include <stdint.h>
#include <stdio.h>

/* A grid or element, and its rows. */
typedef struct ritz_nastran_entry {
    int64_t type; /* 1 of a grid, 2 of a scalar point; of an element its number,
                     34 of CBAR */
    int64_t id, first, count; /* the first row is 0 */
} ritz_nastran_entry;

/** The name of the table of a kind: "TUG1" of "displacement", "TES1" of
 * "stress", "TEF1" of "force"; NULL of others. */
const char *ritz_nastran_table_name(const char *kind);

/**
 * Put a table as DTI cards.
 *
 * @param[in] kind  one of these three
 * @param[in] rows, columns  of the matrix
 */
void ritz_nastran_table_put(FILE *file, const char *kind, int64_t rows,
                            int64_t columns, int64_t count,
                            const ritz_nastran_entry *entry);

#endif
