/* From the terms of a DMIG matrix to the matrix, its rows and its columns. */
#include "formats/dmig_parts.h"
#include "formats/triplets.h"

#include "base/alloc.h"

#include <stdio.h>

/* The dofs that occur as rows, as columns or as either, ascending. */
static ritz_status collect(const ritz_dmig_term *terms, int64_t count,
                           bool rows, bool cols, int64_t *found, ritz_dof **out)
{
    ritz_dof *dof = NULL;
    int64_t n = 0;

    RITZ_CHECK_NEW(dof, 2 * count);
    for (int64_t k = 0; k < count; k++) {
        if (rows)
            dof[n++] = terms[k].row;
        if (cols)
            dof[n++] = terms[k].col;
    }
    *found = ritz_dof_distinct(n, dof);
    *out = dof;
    return RITZ_OK;
}

static int64_t position(ritz_dof wanted, int64_t count, const ritz_dof *dof)
{
    const ritz_dof *found =
        bsearch(&wanted, dof, (size_t)count, sizeof wanted, ritz_dof_compare);

    return found - dof;
}

/* Both triangles where one is given. */
static ritz_status list_terms(const ritz_dmig_header *owner,
                              const ritz_dmig_term *terms, int64_t nrow,
                              const ritz_dof *row, int64_t ncol,
                              const ritz_dof *col, ritz_triplets *out)
{
    RITZ_CHECK(ritz_triplets_new(2 * owner->count, out));
    for (int64_t k = 0; k < owner->count; k++) {
        const ritz_dmig_term *one = &terms[k];
        int64_t i = position(one->row, nrow, row);
        int64_t j = position(one->col, ncol, col);

        ritz_triplets_put(out, i, j, one->re, one->im);
        if (owner->form == RITZ_DMIG_SYMMETRIC && i != j)
            ritz_triplets_put(out, j, i, one->re, one->im);
    }
    return RITZ_OK;
}

ritz_status ritz_dmig_matrix(const ritz_dmig_header *owner,
                             const ritz_dmig_term *terms, ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    bool square =
        owner->form == RITZ_DMIG_SQUARE || owner->form == RITZ_DMIG_SYMMETRIC;
    ritz_matrix new = {.symmetric = owner->form == RITZ_DMIG_SYMMETRIC,
                       .digits = owner->digits};
    ritz_triplets list = {0};
    int64_t nrow = 0;
    int64_t ncol = 0;

    memcpy(new.name, owner->name, sizeof new.name);
    snprintf(new.spelling, sizeof new.spelling, "DMIG, form %d%s%s",
             (int)owner->form, owner->complex ? ", complex" : "",
             owner->polar ? ", polar" : "");
    RITZ_TRY(collect(terms, owner->count, true, square, &nrow, &new.row));
    ncol = nrow;
    if (!square)
        RITZ_TRY(collect(terms, owner->count, false, true, &ncol, &new.col));
    RITZ_TRY(list_terms(owner, terms, nrow, new.row, ncol,
                        square ? new.row : new.col, &list));
    RITZ_TRY(ritz_triplets_compress(&list, nrow, ncol, owner->complex, &new));
    *out = new;
    new = (ritz_matrix){0};
done:
    ritz_triplets_free(&list);
    ritz_matrix_free(&new);
    return status;
}
