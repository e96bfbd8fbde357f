/* OUTPUT4 as it is put together, by the readers of text and of binary. */
#ifndef RITZ_FORMATS_OUTPUT4_H
#define RITZ_FORMATS_OUTPUT4_H

#include <ritz/import.h>

#include <math.h>

/*
 * Columns that a file may declare beyond one for each of its bytes. A matrix of
 * ten million columns, nearly all null, is legal and takes 150 bytes; a limit
 * keeps such bytes from asking for all memory there is.
 */
enum { RITZ_OUTPUT4_NULL_COLUMNS = 32000000 };

/* The header of a matrix. */
typedef struct ritz_output4_header {
    int64_t ncol, nrow;
    bool bigmat; /* its strings have two integers in front */
    int64_t form, type;
    char name[RITZ_NAME_SIZE];
} ritz_output4_header;

/* A matrix while its columns arrive. */
typedef struct ritz_output4_build {
    ritz_output4_header header;
    ritz_matrix matrix;
    int64_t numbers;  /* per value: 1 real, 2 complex */
    int64_t nnz;      /* entries so far */
    int64_t room;     /* and how many there is room for */
    int64_t columns;  /* that it may still declare, by the limit above */
    int64_t pointers; /* room in colptr */
    int64_t column;   /* the one being read, from 0; -1 before the first */
    int64_t below;    /* rows up to here are taken in this column */
    int64_t rule;     /* reading of strings that fitted last */
    int64_t wide;     /* and words of a real by it; 0: none yet */
    bool sparse;      /* a column came in strings */
} ritz_output4_build;

/* A string of a sparse column: consecutive rows. */
typedef struct ritz_output4_string {
    int64_t row;   /* first, from 0 */
    int64_t reals; /* numbers that follow */
    int64_t words; /* of the column's count that it uses, header included */
} ritz_output4_string;

/* Number of readings of a string's header, and how many integers it has. */
enum { RITZ_OUTPUT4_RULES = 3 };
int64_t ritz_output4_integers(int64_t rule);

/** The k-th reading to try, the one that the header declares first. */
int64_t ritz_output4_rule(const ritz_output4_build *build, int64_t k);

/**
 * What a string's header says by @p rule, words of a real @p wide.
 *
 * @return false if that is not possible within @p left words
 */
bool ritz_output4_decode(const ritz_output4_build *build, int64_t rule,
                         int64_t wide, const int64_t *integers, int64_t left,
                         ritz_output4_string *out);

/** Begin a matrix of a file of @p size bytes, with room for @p nnz entries. */
ritz_status ritz_output4_begin(const ritz_output4_header *header, int64_t size,
                               int64_t nnz, ritz_output4_build *out);

/** Begin column @p column, from 1; those between are null. */
ritz_status ritz_output4_column(ritz_output4_build *build, int64_t column);

/** Forget what this column got so far. */
void ritz_output4_rewind(ritz_output4_build *build);

/** Make room for @p count values from @p row, from 0. */
ritz_status ritz_output4_rows(ritz_output4_build *build, int64_t row,
                              int64_t count);

/** Append a value that there is room for; zeros of dense spellings would make
 * patterns differ between spellings, so none is kept. */
static inline void ritz_output4_put(ritz_output4_build *build, int64_t row,
                                    double re, double im)
{
    if (re == 0.0 && im == 0.0)
        return;
    build->matrix.A.rowind[build->nnz] = row;
    build->matrix.A.val[build->nnz] = re;
    if (build->matrix.imaginary)
        build->matrix.imaginary[build->nnz] = im;
    build->nnz++;
}

/** Refuse a value that is not finite. */
ritz_status ritz_output4_infinite(const ritz_output4_build *build, int64_t row);

/** After the last column: obey FORM and hand the matrix over. */
ritz_status ritz_output4_end(ritz_output4_build *build, ritz_matrix *out);

/** Append what a header says to a directory. */
ritz_status ritz_output4_list(ritz_listing *listing,
                              const ritz_output4_header *header, int64_t at,
                              int64_t line);

/** Copy a name without its padding. */
void ritz_output4_name(const char *bytes, int64_t size,
                       char out[RITZ_NAME_SIZE]);

/* Each spelling: recognition, directory (and a check of all values), one
 * matrix. */
bool ritz_output4_is_text(const char *bytes, int64_t size);
ritz_status ritz_output4_list_text(const ritz_foreign *file, bool check,
                                   ritz_listing *out);
ritz_status ritz_output4_read_text(const ritz_foreign *file,
                                   const ritz_listed *which, ritz_matrix *out);
bool ritz_output4_is_binary(const char *bytes, int64_t size);
ritz_status ritz_output4_list_binary(const ritz_foreign *file, bool check,
                                     ritz_listing *out);
ritz_status ritz_output4_read_binary(const ritz_foreign *file,
                                     const ritz_listed *which,
                                     ritz_matrix *out);

#endif
