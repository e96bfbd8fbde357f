/*
 * Distribution of a component's matrices: each rank holds the rows of an equal
 * number of consecutive dofs, without those of attached dofs. Files store
 * matrices by columns; as they are symmetric, columns are read and used as
 * rows.
 */
#ifndef RITZ_LIBEXEC_SLEPC_ROWS_H
#define RITZ_LIBEXEC_SLEPC_ROWS_H

#include "container/slab.h"

#include <ritz/matrix.h>

#include <petscmat.h>

/* What all ranks know of the component. */
typedef struct rows_frame {
    const char *path;
    int64_t num_dofs;
    int64_t num_attached;
    const int64_t *sorted;   /* attached dofs, ascending */
    const int64_t *position; /* column of K_ib of each dof of `sorted` */
    const ritz_dof
        *dof; /* of the component: consecutive dofs of a grid go to one
                            rank; NULL: they may be divided */
} rows_frame;

/* Matrices of the interior, i.e. of all dofs that are not attached, in the
   order of dofs. Rows are distributed. */
typedef struct rows {
    Mat K, M;         /* K_ii, M_ii */
    Mat load;         /* -K_ib, dense; NULL if no dof is attached */
    int64_t interior; /* rows of all ranks */
    int64_t own;      /* rows of this rank */
} rows;

/** The first dof of a rank; num_dofs for the rank after the last. */
int64_t rows_first_dof(const rows_frame *frame, int rank);

/**
 * Read the columns of this rank's dofs of a matrix, and compare its checksums.
 * Collective.
 *
 * @param[in] frame  path and num_dofs are used
 * @return as ritz_slab_read() and ritz_slab_verify()
 */
ritz_status rows_read_matrix(const rows_frame *frame, const char *name,
                             ritz_slab *out);

/**
 * Read K and M from the file. Collective.
 *
 * @return as ritz_slab_read() and ritz_slab_verify(); RITZ_ERR_FORMAT if a
 *         matrix is not symmetric; RITZ_ERR_ARGUMENT if a rank would hold more
 *         than 2^31 - 1 entries, or the interior has more rows; RITZ_ERR_MEMORY
 */
ritz_status rows_read(const rows_frame *frame, rows *out);

/** Fill x with random numbers between -1 and 1, which depend on the row and on
 * @p column alone, and not on the number of ranks. */
void rows_fill(Vec x, int64_t column);

void rows_free(rows *r);

#endif
