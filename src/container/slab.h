/*
 * Reading a component whose matrices do not fit into one process: all of its
 * container but the matrices, and a slab, which is a range of columns of one.
 */
#ifndef RITZ_CONTAINER_SLAB_H
#define RITZ_CONTAINER_SLAB_H

#include <ritz/container.h>

#include <stdbool.h>

/** Read a component without K, M, D, K4 and KG, which stay empty. */
ritz_status ritz_slab_frame(const char *path, ritz_component *out);

/* Data sets of a sparse matrix: `data`, `indices` and `indptr`. Arrays of their
 * checksums are in this order. */
enum { RITZ_SLAB_SETS = 3 };

/* Columns [from, from + A.ncol) of a sparse matrix in a file. */
typedef struct ritz_slab {
    ritz_sparse A; /* with all rows */
    int64_t from;
    int64_t before;  /* entries of the columns before `from` */
    int64_t entries; /* of the whole matrix */
} ritz_slab;

/** Whether the container has a group of that name. */
ritz_status ritz_slab_has(const char *path, const char *name, bool *out);

/** Names of the loads whose geometric stiffness "KG/<name>" is stored, in their
 * order. @param[out] name  to be freed; NULL if there is none */
ritz_status ritz_slab_loads(const char *path, int64_t *count,
                            char (**name)[RITZ_NAME_SIZE]);

/**
 * Read columns [from, to) of a square matrix of @p n rows. Its checksums, which
 * are those of all columns, are not compared: see ritz_slab_verify.
 *
 * @return RITZ_ERR_FORMAT if it has another size, column pointers descend, the
 *         rows of a column do not ascend, or a value is not finite
 */
ritz_status ritz_slab_read(const char *path, const char *name, int64_t n,
                           int64_t from, int64_t to, ritz_slab *out);

/** Begin the checksums of a matrix. */
void ritz_slab_begin(uint64_t sum[RITZ_SLAB_SETS]);

/** Continue the checksums by a slab. Slabs must come in the order of their
 * columns. */
void ritz_slab_sum(const ritz_slab *slab, uint64_t sum[RITZ_SLAB_SETS]);

/** Compare the checksums of all columns with those that the file has.
 * @return RITZ_ERR_FORMAT if one differs */
ritz_status ritz_slab_verify(const char *path, const char *name,
                             const uint64_t sum[RITZ_SLAB_SETS]);

void ritz_slab_free(ritz_slab *slab);

#endif
