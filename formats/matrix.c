/* Matrices of foreign files, put together from their entries. */
#include "formats/matrix.h"

#include "base/alloc.h"

#include <stdlib.h>

ritz_status ritz_triplets_new(int64_t most, ritz_triplets *out)
{
    RITZ_OWN(ritz_triplets) list = {0};

    RITZ_CHECK_NEW(list.row, most);
    RITZ_CHECK_NEW(list.col, most);
    RITZ_CHECK_NEW(list.re, most);
    RITZ_CHECK_NEW(list.im, most);
    RITZ_MOVE(*out, list);
    return RITZ_OK;
}

ritz_status ritz_triplets_compress(const ritz_triplets *list, int64_t nrow,
                                   int64_t ncol, bool complex, ritz_matrix *m)
{
    RITZ_OWN(ritz_sparse) real = {0};
    RITZ_OWN(ritz_sparse) imaginary = {0};

    RITZ_CHECK(ritz_sparse_from_triplets(nrow, ncol, list->count, list->row,
                                         list->col, list->re, &real));
    if (complex) {
        RITZ_CHECK(ritz_sparse_from_triplets(nrow, ncol, list->count, list->row,
                                             list->col, list->im, &imaginary));
        free(m->imaginary);
        m->imaginary = imaginary.val; /* the pattern is the same */
        imaginary.val = NULL;
    }
    ritz_sparse_free(&m->A);
    RITZ_MOVE(m->A, real);
    return RITZ_OK;
}

void ritz_triplets_free(ritz_triplets *list)
{
    free(list->row);
    free(list->col);
    free(list->re);
    free(list->im);
    *list = (ritz_triplets){0};
}

void ritz_matrix_free(ritz_matrix *matrix)
{
    ritz_sparse_free(&matrix->A);
    free(matrix->imaginary);
    free(matrix->row);
    free(matrix->col);
    *matrix = (ritz_matrix){0};
}

void ritz_matrices_free(ritz_matrices *matrices)
{
    RITZ_FREE_EACH(ritz_matrix, matrices->count, matrices->matrix);
    *matrices = (ritz_matrices){0};
}

ritz_status ritz_listing_add(ritz_listing *listing, const ritz_listed *item)
{
    RITZ_CHECK_ROOM(listing->item, listing->count, listing->room);
    listing->item[listing->count++] = *item;
    return RITZ_OK;
}
