/*
 * Matrices in foreign files: NASTRAN OUTPUT4, DMIG and punch, Matrix Market,
 * MAT.
 * A format is recognised by content, never by name.
 */
#ifndef RITZ_FOREIGN_H
#define RITZ_FOREIGN_H

#include <ritz/dofs.h>
#include <ritz/sparse.h>
#include <ritz/text.h>

#pragma GCC visibility push(default)

/* One matrix as its file states it; both triangles once read. */
typedef struct ritz_matrix {
    char name[RITZ_NAME_SIZE]; /* "KGG"; "" where the format has none */
    ritz_sparse A;
    double *imaginary; /* beside A.val; NULL if real */
    bool symmetric;    /* the file says so */
    int64_t digits;    /* significant decimal digits of its values: 17 binary
                          double, 7 binary single, else as written */
    char spelling[RITZ_NAME_SIZE]; /* "OUTPUT4 text, bigmat, 1P,3E23.16" */
    ritz_dof *row; /* dof of each row where the file says; else NULL */
    ritz_dof *col; /* of each column, of rectangular ones; NULL: as rows */
    char other[RITZ_NAME_SIZE]; /* why it is no matrix that can be used, "a cell
                                   array"; A is then 0 x 0. "": it is one */
} ritz_matrix;

typedef struct ritz_matrices {
    int64_t count;
    ritz_matrix *matrix;
    char format[RITZ_NAME_SIZE]; /* of the descriptor that read them */
} ritz_matrices;

/* An entry of the directory: a matrix whose values were not read. */
typedef struct ritz_listed {
    char name[RITZ_NAME_SIZE];
    int64_t nrow, ncol; /* as its header has them; -1: only reading tells */
    bool symmetric, is_complex;
    int64_t at;   /* where it begins: byte of the file, or place among others */
    int64_t line; /* of that byte, where the format is text */
    char other[RITZ_NAME_SIZE]; /* as in ritz_matrix */
} ritz_listed;

typedef struct ritz_listing {
    int64_t count, room;
    ritz_listed *item;
} ritz_listing;

/* A file of matrices that was read, and the directory of what it holds. */
typedef struct ritz_foreign {
    char *path;        /* NULL: bytes without a file */
    const char *bytes; /* a NUL follows those of a file */
    int64_t size;
    char *folder; /* where files that it includes lie; NULL: none is followed */
    char digest[RITZ_DIGEST_SIZE];    /* SHA-256 of a file */
    const struct ritz_format *format; /* NULL: none knows it */
    ritz_listing listing;
    char *owned; /* the bytes of a file */
} ritz_foreign;

typedef struct ritz_format {
    const char *name;      /* "output4" */
    const char *summary;   /* one line */
    const char *reference; /* key in docs/references.bib */
    /** True if these bytes look like the format. @p size may be 0. */
    bool (*recognise)(const char *bytes, int64_t size);
    /**
     * Append what the file holds, without its values where the format allows
     * that. @return RITZ_ERR_FORMAT naming line or byte
     */
    ritz_status (*list)(const ritz_foreign *file, ritz_listing *out);
    /** Read one matrix of the list. @return as list */
    ritz_status (*read)(const ritz_foreign *file, const ritz_listed *which,
                        ritz_matrix *out);
} ritz_format;

/** All formats of matrices, ended by NULL. */
extern const ritz_format *const ritz_formats[];
extern const ritz_format ritz_format_dmig;
extern const ritz_format ritz_format_mat;
extern const ritz_format ritz_format_matrix_market;
extern const ritz_format ritz_format_output4;

/** Read the bytes of a file once, sum them up and recognise their format. */
ritz_status ritz_foreign_open(const char *path, ritz_foreign *out);

/** Fill the directory; @return RITZ_ERR_FORMAT if no format knows the file. */
ritz_status ritz_foreign_list(ritz_foreign *file);

/** Read matrix @p k of the directory. */
ritz_status ritz_foreign_take(const ritz_foreign *file, int64_t k,
                              ritz_matrix *out);

/** Put the path of a file before what is wrong with it. */
ritz_status ritz_foreign_context(const ritz_foreign *file, ritz_status status);
void ritz_foreign_close(ritz_foreign *file);

/** All matrices of a file, or of bytes, at once. */
ritz_status ritz_foreign_read(const char *path, ritz_matrices *out);
ritz_status ritz_foreign_parse(const char *bytes, int64_t size,
                               ritz_matrices *out);

/**
 * The matrix that "FILE[:NAME[#K]]" names: without a name the only one; the
 * K-th of that name, from 1. Without K there must be one only.
 *
 * A file whose whole name holds a colon is tried first.
 *
 * @return RITZ_ERR_ARGUMENT listing what the file holds
 */
ritz_status ritz_foreign_select(const char *spec, ritz_matrix *out);

/* Files that were read, and their SHA-256. */
typedef struct ritz_file_sum {
    char *path;
    char digest[RITZ_DIGEST_SIZE];
} ritz_file_sum;

typedef struct ritz_file_sums {
    int64_t count, room;
    ritz_file_sum *sum;
} ritz_file_sums;

/** Append a file. */
ritz_status ritz_file_sums_add(ritz_file_sums *sums, const ritz_foreign *file);
void ritz_file_sums_free(ritz_file_sums *sums);

/* A matrix that is wanted. */
typedef struct ritz_wanted {
    const char *spec; /* as of ritz_foreign_select */
    const char *what; /* "stiffness", before messages; NULL: nothing is */
    ritz_matrix *into;
} ritz_wanted;

/**
 * Select several matrices. Each file is read once, one file at a time, and of
 * its matrices only those that are wanted.
 *
 * @param[in,out] sums  gets the files; NULL: not asked
 */
ritz_status ritz_foreign_collect(int64_t count, const ritz_wanted *wanted,
                                 ritz_file_sums *sums);

/** The part of a spec that names the file; the caller frees @p out. */
ritz_status ritz_foreign_path(const char *spec, char **out);

/* How OUTPUT4 is written. */
typedef struct ritz_output4_style {
    bool text;      /* else binary, native byte order, 32-bit integers */
    bool sparse;    /* else dense */
    int64_t digits; /* text: significant digits, 1 to 17; 17 by default */
} ritz_output4_style;

/** Write matrices as one OUTPUT4 file (draft, then rename). Names are cut to 8
 * letters and capitals. */
ritz_status ritz_output4_write(const char *path, int64_t count,
                               const ritz_matrix *matrix,
                               const ritz_output4_style *style);

/** Write one matrix, 17 digits; symmetric ones as lower triangle; dense ones
 * (all entries stored) as array. Comment lines may be NULL. */
ritz_status ritz_matrix_market_write(const char *path,
                                     const ritz_matrix *matrix,
                                     const char *comment);

void ritz_matrix_free(ritz_matrix *matrix);
void ritz_matrices_free(ritz_matrices *matrices);

#pragma GCC visibility pop

#endif
