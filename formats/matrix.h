/* A matrix as a list of entries, real or complex, before it is compressed. */
#ifndef RITZ_FORMATS_MATRIX_H
#define RITZ_FORMATS_MATRIX_H

#include <ritz/import.h>

/* No place occurs twice. */
typedef struct ritz_triplets {
    int64_t count;
    int64_t *row, *col;
    double *re, *im;
} ritz_triplets;

/** Room for @p most entries. */
ritz_status ritz_triplets_new(int64_t most, ritz_triplets *out);

/** Append an entry that there is room for. */
static inline void ritz_triplets_put(ritz_triplets *list, int64_t row,
                                     int64_t col, double re, double im)
{
    list->row[list->count] = row;
    list->col[list->count] = col;
    list->re[list->count] = re;
    list->im[list->count++] = im;
}

/** Put the entries into @p m, in place of its own, as nrow x ncol. */
ritz_status ritz_triplets_compress(const ritz_triplets *list, int64_t nrow,
                                   int64_t ncol, bool complex, ritz_matrix *m);

void ritz_triplets_free(ritz_triplets *list);

/** Append to a directory. */
ritz_status ritz_listing_add(ritz_listing *listing, const ritz_listed *item);

#endif
