/* Components that do not fit into one process: all of a container but its
 * matrices, and some columns of a matrix. */
#ifndef RITZ_CONTAINER_SLAB_H
#define RITZ_CONTAINER_SLAB_H

#include <ritz/container.h>

#include <stdbool.h>

/** A component without K, M, D, K4 and KG, which stay empty. */
ritz_status ritz_slab_frame(const char *path, ritz_component *out);

/* Sets of a sparse matrix, in the order of the checksums below. */
enum { RITZ_SLAB_SETS = 3 };

/* Columns [from, from + A.ncol) of a sparse matrix in a file. */
typedef struct ritz_slab {
    ritz_sparse A; /* with all rows */
    int64_t from;
    int64_t before;  /* entries of the columns before */
    int64_t entries; /* of the whole matrix */
} ritz_slab;

/** Whether the container has a group of that name. */
ritz_status ritz_slab_has(const char *path, const char *name, bool *out);

/**
 * Read columns of a square matrix of @p n rows, without its checksums.
 *
 * @return RITZ_ERR_FORMAT if it is of another size, if its pointers descend, or
 *         rows of a column do not ascend, or a value is not finite
 */
ritz_status ritz_slab_read(const char *path, const char *name, int64_t n,
                           int64_t from, int64_t to, ritz_slab *out);

/** Checksums of `data`, `indices` and `indptr` before the first column. */
void ritz_slab_begin(uint64_t sum[RITZ_SLAB_SETS]);

/** Continue the checksums by those of a slab, after those of the columns
 * before. */
void ritz_slab_sum(const ritz_slab *slab, uint64_t sum[RITZ_SLAB_SETS]);

/** Compare the checksums of all columns with those of the file, as far as it
 * has them. @return RITZ_ERR_FORMAT if one does not fit */
ritz_status ritz_slab_verify(const char *path, const char *name,
                             const uint64_t sum[RITZ_SLAB_SETS]);

void ritz_slab_free(ritz_slab *slab);

#endif
