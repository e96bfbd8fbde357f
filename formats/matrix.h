/* A matrix as a list of entries, real or complex, before it is compressed. */
#ifndef RITZ_FORMATS_MATRIX_H
#define RITZ_FORMATS_MATRIX_H

#include <ritz/import.h>

/* No place occurs twice. */
typedef struct ritz_triplets {
    int64_t count, room;
    int64_t *row, *col;
    int64_t *counts; /* column j has counts[j + 1] entries: set, zeroed, before
                        there is room where entries come by columns and rows;
                        `col` is then NULL */
    double *re, *im; /* no `im` of a real matrix */
    bool is_complex; /* set before there is room */
    bool borrowed;   /* arrays belong to another list, and do not grow */
} ritz_triplets;

/** Make sure of room for @p more entries. */
ritz_status ritz_triplets_reserve(ritz_triplets *list, int64_t more);

/** Give an empty list room for @p count entries, in arrays that are not cleared:
 * those of several megabytes would be cleared and then written. */
ritz_status ritz_triplets_room(ritz_triplets *list, int64_t count);

/** Append an entry that there is room for. */
static inline void ritz_triplets_put(ritz_triplets *list, int64_t row,
                                     int64_t col, double re, double im)
{
    list->row[list->count] = row;
    if (list->counts)
        list->counts[col + 1]++;
    else
        list->col[list->count] = col;
    list->re[list->count] = re;
    if (list->im)
        list->im[list->count] = im;
    list->count++;
}

/** The same unless it is zero: patterns would differ between the spellings of
 * a matrix, of which some write zeros and others do not. */
static inline void ritz_triplets_put_value(ritz_triplets *list, int64_t row,
                                           int64_t col, double re, double im)
{
    if (re != 0.0 || im != 0.0)
        ritz_triplets_put(list, row, col, re, im);
}

/**
 * The entries as nrow x ncol in @p m, which has no entries yet; the list is
 * left empty. Entries in the order of columns and rows are not copied.
 */
ritz_status ritz_triplets_compress(ritz_triplets *list, int64_t nrow,
                                   int64_t ncol, ritz_matrix *m);

/** Complete a matrix of one triangle: A(j,i) has the real part of A(i,j) times
 * @p re, and its imaginary part times @p im. */
ritz_status ritz_matrix_mirror(ritz_matrix *m, double re, double im);

void ritz_triplets_free(ritz_triplets *list);

/* A column of a large matrix in a file, from which a thread can read on. */
typedef struct ritz_mark {
    int64_t at, line; /* where it begins, as in ritz_listed */
    int64_t column;   /* number of the column before it, 0: none */
    int64_t values;   /* of all columns before it */
} ritz_mark;

/* Marks in about equal distances, from the first column on. */
typedef struct ritz_marks {
    int64_t count;
    int64_t apart;  /* bytes from one to the next, at least */
    int64_t values; /* of all columns */
    ritz_mark mark[64];
} ritz_marks;

/** Append a mark unless it is too near the last. Where there are too many,
 * every second one is removed. */
void ritz_marks_add(ritz_marks *marks, const ritz_mark *mark);

/** Append to a directory, which takes over item->marks if RITZ_OK is
 * returned. */
ritz_status ritz_listing_add(ritz_listing *listing, const ritz_listed *item);

/** Remove all that is listed. */
void ritz_listing_clear(ritz_listing *listing);

#endif
