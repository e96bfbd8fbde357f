/* Matrices of MAT files between their levels: private to the reader. */
#ifndef RITZ_FORMATS_MAT_H
#define RITZ_FORMATS_MAT_H

#include "formats/bytes.h"

#include <ritz/import.h>

/* Types of elements, by the numbers that Level 5 gives them. */
enum {
    RITZ_MAT_INT8 = 1,
    RITZ_MAT_UINT8,
    RITZ_MAT_INT16,
    RITZ_MAT_UINT16,
    RITZ_MAT_INT32,
    RITZ_MAT_UINT32,
    RITZ_MAT_SINGLE,
    RITZ_MAT_DOUBLE = 9,
    RITZ_MAT_INT64 = 12,
    RITZ_MAT_UINT64,
    RITZ_MAT_MATRIX, /* no number, nor is the next */
    RITZ_MAT_COMPRESSED,
};

enum {
    RITZ_MAT_DEPTH = 8,         /* how deep structs in structs are followed */
    RITZ_MAT_MOST_RATIO = 1032, /* that deflate can reach */
};

/* Values as the file holds them, `at` NULL: there are none. */
typedef struct ritz_mat_values {
    const unsigned char *at;
    int64_t count;
    int type;
    bool swap; /* of the other byte order */
} ritz_mat_values;

/* The entries of a matrix. Full, `col` without values: by columns. Sparse: rows
   from `base`; columns too, or ncol + 1 starts of theirs from 0. */
typedef struct ritz_mat_entries {
    int64_t nrow, ncol, count;
    ritz_mat_values row, col, re, im;
    int64_t base;
    bool starts;
} ritz_mat_entries;

/* A file that is gone through, to list what it holds or to read one of it. */
typedef struct ritz_mat_list {
    ritz_listing *listing; /* NULL: one matrix is read */
    int64_t wanted;        /* that one, counted from 0 */
    ritz_matrix matrix;    /* once it was met */
    int64_t count;         /* matrices met so far */
    int64_t bytes;         /* of the file, which bound what it can hold */
    const char *spelling;  /* "MAT level 5" */
} ritz_mat_list;

/** Bytes of a number; 0 if the type is that of none. */
int64_t ritz_mat_size(int type);
double ritz_mat_value(const ritz_mat_values *values, int64_t k);

/**
 * Check the memory for @p count values of a file of @p bytes.
 * @return RITZ_ERR_FORMAT if it is more than a GiB and more than deflate could
 *         have compressed into the file
 */
ritz_status ritz_mat_fits(int64_t bytes, const char *name, int64_t count);

/** Whether the next matrix is not asked for, so that its values need not be
 * read. */
bool ritz_mat_passes(const ritz_mat_list *list);

/** Add a variable that is not a matrix, and the reason. */
ritz_status ritz_mat_add_other(ritz_mat_list *list, const char *name,
                               const char *why);

/** Add a matrix. @return RITZ_ERR_FORMAT if the place of an entry is out of
 * range or given twice */
ritz_status ritz_mat_add(ritz_mat_list *list, const char *name,
                         const ritz_mat_entries *entries);

/* The levels in files of their own: whether bytes look like them, and all that
   they hold. */
bool ritz_mat_is_level5(const char *bytes, int64_t size);
bool ritz_mat_is_hdf5(const char *bytes, int64_t size);
ritz_status ritz_mat_admit_hdf5(const char *bytes, int64_t size);
ritz_status ritz_mat_read_level5(const char *bytes, int64_t size,
                                 ritz_mat_list *list);
ritz_status ritz_mat_read_hdf5(const char *bytes, int64_t size,
                               ritz_mat_list *list);

#endif
