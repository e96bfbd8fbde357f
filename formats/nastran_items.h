/* What the rows of grids and elements are in NASTRAN's matrices of recovery. */
#ifndef RITZ_FORMATS_NASTRAN_ITEMS_H
#define RITZ_FORMATS_NASTRAN_ITEMS_H

#include <ritz/base.h>

#include <stdbool.h>
#include <stdint.h>

/* Types of a table of displacements. */
enum { RITZ_NASTRAN_GRID = 1, RITZ_NASTRAN_SCALAR = 2, RITZ_NASTRAN_DOFS = 6 };

/* A row of a grid or element. */
typedef struct ritz_nastran_item {
    int64_t type;  /* 34 of CBAR; RITZ_NASTRAN_GRID, RITZ_NASTRAN_SCALAR */
    int64_t index; /* of the row among those of the element, from 0 */
    int64_t rows;  /* how many these are; 0: the name does not tell */
} ritz_nastran_item;

/**
 * Name a row: "T1" to "R3" of a grid, "cbar.m1a" of an element whose rows are
 * known, "cquad4.3" or "type95.3" where they are not.
 *
 * @param[in] kind  "displacement", "stress" or "force"
 */
void ritz_nastran_item_name(const char *kind, const ritz_nastran_item *item,
                            char out[RITZ_NAME_SIZE]);

/** The row that has this name; @return false if NASTRAN has no such row. */
bool ritz_nastran_item_find(const char *kind, const char *name,
                            ritz_nastran_item *out);

#endif
