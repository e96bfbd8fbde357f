/* A matrix as a list of entries, real or complex, before it is compressed. */
#ifndef RITZ_FORMATS_MATRIX_H
#define RITZ_FORMATS_MATRIX_H

#include <ritz/import.h>

/* No place occurs twice. */
typedef struct ritz_triplets {
    int64_t count, room;
    int64_t *row, *col;
    double *re, *im;
} ritz_triplets;

/** Make sure of room for @p more entries. */
ritz_status ritz_triplets_reserve(ritz_triplets *list, int64_t more);

/** Append an entry that there is room for. */
static inline void ritz_triplets_put(ritz_triplets *list, int64_t row,
                                     int64_t col, double re, double im)
{
    list->row[list->count] = row;
    list->col[list->count] = col;
    list->re[list->count] = re;
    list->im[list->count++] = im;
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
                                   int64_t ncol, bool complex, ritz_matrix *m);

void ritz_triplets_free(ritz_triplets *list);

/** Append to a directory. */
ritz_status ritz_listing_add(ritz_listing *listing, const ritz_listed *item);

#endif
