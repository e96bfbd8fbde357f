/* Matrices of MAT files between their levels: private to the reader. */
#ifndef RITZ_FORMATS_MAT_H
#define RITZ_FORMATS_MAT_H

#include <ritz/import.h>

/* Numbers of the format for types of values. */
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
    RITZ_MAT_MATRIX,
    RITZ_MAT_COMPRESSED,
};

/* How deep structs in structs are followed. */
enum { RITZ_MAT_DEPTH = 8 };

/* Values as the file holds them, `at` NULL: there are none. */
typedef struct ritz_mat_values {
    const unsigned char *at;
    int64_t count;
    int type;
    bool swap; /* of the other byte order */
} ritz_mat_values;

/* A file that is gone through, to list what it holds or to read one of it. */
typedef struct ritz_mat_list {
    ritz_listing *listing; /* NULL: one matrix is read */
    int64_t wanted;        /* that one, counted from 0 */
    ritz_matrix matrix;    /* once it was met */
    int64_t count;         /* matrices met so far */
    int64_t bytes;         /* of the file, which bound what it can hold */
    const char *spelling;  /* "MAT level 5" */
} ritz_mat_list;

/** Bytes of a value; 0 if the type is not a number. */
int64_t ritz_mat_size(int type);

double ritz_mat_value(const ritz_mat_values *values, int64_t k);

/** An unsigned number of 1 to 8 bytes. */
uint64_t ritz_mat_bits(const unsigned char *at, int64_t size, bool swap);

/** Count a matrix that is not wanted; false: it is to be added. */
bool ritz_mat_pass(ritz_mat_list *list);

/** Add a variable that is not a matrix, and the reason. */
ritz_status ritz_mat_add_other(ritz_mat_list *list, const char *name,
                               const char *why);

/** A full matrix by columns; there are nrow * ncol values. */
ritz_status ritz_mat_add_full(ritz_mat_list *list, const char *name,
                              int64_t nrow, int64_t ncol,
                              const ritz_mat_values *re,
                              const ritz_mat_values *im);

/* Entries of a sparse matrix: rows from `base`; columns too, or ncol + 1
   starts of theirs from 0. */
typedef struct ritz_mat_entries {
    int64_t nrow, ncol, count;
    ritz_mat_values row, col, re, im;
    int64_t base;
    bool starts;
} ritz_mat_entries;

/** @return RITZ_ERR_FORMAT if a place is out of range or given twice */
ritz_status ritz_mat_add_sparse(ritz_mat_list *list, const char *name,
                                const ritz_mat_entries *entries);

/* Each level: whether bytes look like it, and all that they hold. */
bool ritz_mat_is_level4(const char *bytes, int64_t size);
bool ritz_mat_is_level5(const char *bytes, int64_t size);
bool ritz_mat_is_hdf5(const char *bytes, int64_t size);
ritz_status ritz_mat_read_level4(const char *bytes, int64_t size,
                                 ritz_mat_list *list);
ritz_status ritz_mat_read_level5(const char *bytes, int64_t size,
                                 ritz_mat_list *list);
ritz_status ritz_mat_read_hdf5(const char *bytes, int64_t size,
                               ritz_mat_list *list);

#endif
