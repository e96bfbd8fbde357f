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
} ritz_triplets;

/** Make sure of room for @p more entries. */
ritz_status ritz_triplets_reserve(ritz_triplets *list, int64_t more);

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

/** Append to a directory. */
ritz_status ritz_listing_add(ritz_listing *listing, const ritz_listed *item);

#endif
