/*
 * OUTPUT4 between its spellings, text and binary, and the matrix: private to
 * the reader.
 */
#ifndef RITZ_FORMATS_OUTPUT4_H
#define RITZ_FORMATS_OUTPUT4_H

#include "formats/decimal.h"
#include "formats/matrix.h"

#include <math.h>

enum { RITZ_OUTPUT4_SYMMETRIC = 6 }; /* FORM */

/* The header of a matrix. */
typedef struct ritz_output4_header {
    int64_t ncol, nrow;
    bool bigmat; /* its strings have two integers in front */
    int64_t form, type;
    int64_t numbers; /* per value: 1 real, 2 complex */
    bool symmetric;  /* by FORM */
    char name[RITZ_NAME_SIZE];
    int64_t at, line; /* where it begins, as in ritz_listed */
} ritz_output4_header;

/* ---- a matrix while its columns arrive ---------------------------------- */

typedef struct ritz_output4_build {
    ritz_output4_header header;
    ritz_triplets entries;
    int64_t columns; /* that it may still declare */
    int64_t column;  /* the one being read, from 0; -1 before the first */
    char where[RITZ_NAME_SIZE + 32]; /* "column 1 of 'KAA'" */
    int64_t first;                   /* entry of this column */
    int64_t below; /* first row that the next string may have, from 0 */
    int64_t rule;  /* how headers of strings are read, RITZ_OUTPUT4_* */
    int64_t wide;  /* words of a real, if headers are read so */
    bool sparse;   /* a column was stored as strings */
    bool ended;    /* the last column was read */
} ritz_output4_build;

void ritz_output4_build_free(ritz_output4_build *build);

/* A string of a sparse column: consecutive rows. */
typedef struct ritz_output4_string {
    int64_t row;   /* first, from 0 */
    int64_t reals; /* numbers that follow */
    int64_t words; /* of the column's count that it uses, header included */
} ritz_output4_string;

/* Readings of a string's header. */
enum {
    RITZ_OUTPUT4_WORDS,
    RITZ_OUTPUT4_VALUES,
    RITZ_OUTPUT4_BIGMAT,
    RITZ_OUTPUT4_RULES
};

/* ---- spellings ---------------------------------------------------------- */

/* A file that is gone through; a copy goes on from where it was made. */
typedef struct ritz_output4_reader ritz_output4_reader;
struct ritz_output4_reader {
    const struct ritz_output4_spelling *as;
    const char *begin;
    ritz_lines text; /* binary has no lines: only `at` and `end` are used */
    char format[32]; /* how the matrix is written, "1P,3E23.16" */
    int64_t digits;  /* of its values, as in ritz_matrix */
    int64_t wide;    /* words of a real, as the header has them */
    int64_t widths;  /* 2: they may as well be the other of 1 and 2 */
    /* text: nEw.d */
    int64_t per_line, width, decimals;
    /* binary */
    bool big_endian;
    int64_t mark;    /* bytes of a record's length */
    int64_t integer; /* bytes of an integer, the size of a word too */
    int64_t real;    /* bytes of a number in this matrix */
    const char *data, *data_end; /* of the column's record */
};

typedef struct ritz_output4_spelling {
    const char *name; /* "text" */
    /** True if the file is spelled so; sets what holds of all matrices. */
    bool (*recognise)(ritz_output4_reader *r);
    /** Take a header, and what it says of the spelling. @param[out] found
     * false at the end of the file */
    ritz_status (*take_header)(ritz_output4_reader *r, ritz_output4_header *out,
                               bool *found);
    /** Take ICOL, IROW and NW of the next column. */
    ritz_status (*take_column)(ritz_output4_reader *r,
                               const ritz_output4_build *build, int64_t n[3]);
    /** Read a dense column from those. */
    ritz_status (*read_dense)(ritz_output4_reader *r, ritz_output4_build *build,
                              const int64_t n[3]);
    /** Take the header of a string, of @p words of which @p left are to come,
     * and then its numbers. */
    ritz_status (*take_string)(ritz_output4_reader *r,
                               const ritz_output4_build *build, int64_t words,
                               int64_t left, ritz_output4_string *out);
    ritz_status (*read_numbers)(ritz_output4_reader *r,
                                ritz_output4_build *build, int64_t row,
                                int64_t reals);
    /** Move behind a column; false if its counts do not lead there. NULL: it
     * was taken whole. */
    bool (*skip_column)(ritz_output4_reader *r, const int64_t n[3]);
    /** Move behind a column like skip_column, and count its values; strings are
     * read by build->rule and build->wide. @return -1 if its counts do not lead
     * there; the reader is then anywhere */
    int64_t (*count_column)(ritz_output4_reader *r,
                            const ritz_output4_build *build,
                            const int64_t n[3]);
    /** Read the strings of a column whose form is the most frequent; false, and
     * nothing is read, if it is another one or anything is wrong. NULL: none
     * is that frequent. */
    bool (*read_usual)(ritz_output4_reader *r, ritz_output4_build *build,
                       int64_t words);
    /** Take what stands behind ICOL = NCOL + 1. NULL: it was taken whole. */
    ritz_status (*skip_last)(ritz_output4_reader *r,
                             const ritz_output4_build *build, int64_t words);
} ritz_output4_spelling;

/* ---- columns ------------------------------------------------------------ */

/**
 * Read all columns of a matrix whose header was taken: by several threads if
 * there are marks and ritz_set_threads() allows it. The entries are the same, in
 * the same order, as one thread reads.
 *
 * @param[in,out] r      moved behind the matrix if one thread reads, as it does
 *                       without marks; otherwise left where it is
 * @param[in]     marks  NULL if there are none
 * @param[out]    out    freed by ritz_output4_build_free()
 * @return RITZ_ERR_FORMAT, its sentence naming the column; RITZ_ERR_MEMORY
 */
ritz_status ritz_output4_read_columns(ritz_output4_reader *r,
                                      const ritz_output4_header *header,
                                      const ritz_marks *marks,
                                      ritz_output4_build *out);

/**
 * Move behind a matrix by the counts in the headers of its columns, without
 * reading numbers.
 *
 * @param[out]    size   bytes of the columns' records in a binary file, 0 in
 *                       text
 * @param[in,out] marks  set; left without marks if the values of a column cannot
 *                       be counted. NULL: not wanted
 * @return false if a count does not lead to another column
 */
bool ritz_output4_skip_columns(ritz_output4_reader *r,
                               const ritz_output4_header *header, int64_t *size,
                               ritz_marks *marks);

extern const ritz_output4_spelling ritz_output4_text;
extern const ritz_output4_spelling ritz_output4_binary;

#endif
