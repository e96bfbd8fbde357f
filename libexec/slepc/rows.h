/*
 * The rows of a component that a rank holds: as many consecutive dofs as other
 * ranks, without those that are attached. A symmetric matrix is stored by
 * columns, so that the columns of these dofs are read from the file as rows.
 */
#ifndef RITZ_LIBEXEC_SLEPC_ROWS_H
#define RITZ_LIBEXEC_SLEPC_ROWS_H

#include <ritz/matrix.h>

#include <petscmat.h>

/* What all ranks know of the component. */
typedef struct rows_frame {
    const char *path;
    int64_t num_dofs;
    int64_t num_attached;
    const int64_t *sorted;   /* attached dofs, ascending */
    const int64_t *position; /* of each of them among the columns of K_ib */
} rows_frame;

/* Matrices of the interior: rows are distributed, in the order of dofs. */
typedef struct rows {
    Mat K, M;         /* K_ii, M_ii */
    Mat load;         /* -K_ib, dense; NULL: nothing is attached */
    int64_t interior; /* rows of all ranks */
    int64_t own;      /* rows of this rank */
} rows;

/**
 * Read them. Collective.
 *
 * @return RITZ_ERR_FORMAT as ritz_slab_read and ritz_slab_verify, or if a
 *         matrix is not symmetric; RITZ_ERR_ARGUMENT if it has too many entries
 *         for the ranks
 */
ritz_status rows_read(const rows_frame *frame, rows *out);

/** Fill a vector without structure, another for each column, the same however
 * many ranks there are. */
void rows_fill(Vec x, int64_t column);

void rows_free(rows *r);

#endif
