/*
 * What FORM says of an OUTPUT4 matrix: 3 with one row or column is a diagonal;
 * 6 symmetric, both triangles stored, a file with one only is completed; 8
 * without entries the identity.
 */
#include "formats/output4.h"
#include "formats/triplets.h"

#include <inttypes.h>

enum { DIAGONAL = 3, SYMMETRIC = 6, IDENTITY = 8 };

/* Whether entries lie beside the diagonal, and all on the same side of it. */
static bool is_triangle(const ritz_sparse *A)
{
    bool above = false;
    bool below = false;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            above = above || A->rowind[p] < j;
            below = below || A->rowind[p] > j;
        }
    return above != below;
}

/* Which matrix an entry of the file stands for. */
typedef enum shape { MIRRORED, ON_DIAGONAL, UNIT } shape;

/* The entries that the file's own stand for, as the n x n matrix has them. */
static ritz_status list_entries(const ritz_matrix *m, shape as, int64_t n,
                                ritz_triplets *out)
{
    const ritz_sparse *A = &m->A;

    RITZ_CHECK(ritz_triplets_new(as == UNIT ? n : 2 * A->colptr[A->ncol], out));
    for (int64_t k = 0; as == UNIT && k < n; k++)
        ritz_triplets_put(out, k, k, 1.0, 0.0);
    for (int64_t j = 0; as != UNIT && j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            double im = m->imaginary ? m->imaginary[p] : 0.0;
            int64_t i = A->rowind[p];
            int64_t at = A->ncol == 1 ? i : j;

            if (as == ON_DIAGONAL)
                ritz_triplets_put(out, at, at, A->val[p], im);
            else
                ritz_triplets_put(out, i, j, A->val[p], im);
            if (as == MIRRORED && i != j)
                ritz_triplets_put(out, j, i, A->val[p], im);
        }
    return RITZ_OK;
}

/* m := the n x n matrix that its entries are a shorthand of. */
static ritz_status expand(ritz_matrix *m, shape as, int64_t n)
{
    ritz_status status = RITZ_OK;
    ritz_triplets list = {0};

    RITZ_TRY(list_entries(m, as, n, &list));
    RITZ_TRY(ritz_triplets_compress(&list, n, n, m->imaginary != NULL, m));
done:
    ritz_triplets_free(&list);
    return status;
}

ritz_status ritz_output4_obey(ritz_output4_list *list,
                              ritz_output4_build *build)
{
    ritz_matrix *m = &build->matrix;
    int64_t nrow = m->A.nrow;
    int64_t ncol = m->A.ncol;
    int64_t n = nrow > ncol ? nrow : ncol;
    int64_t form = build->header.form;
    bool vector = form == DIAGONAL && (nrow == 1 || ncol == 1) && n > 1;
    bool unit = form == IDENTITY && nrow == ncol && build->nnz == 0;

    RITZ_REFUSE_IF((vector || unit) && n > list->columns, RITZ_ERR_FORMAT,
                   "'%s' is said to be a diagonal of %" PRId64
                   " rows, far more than its file can fill",
                   build->header.name, n);
    if (vector || unit) {
        list->columns -= n;
        RITZ_CHECK(expand(m, unit ? UNIT : ON_DIAGONAL, n));
    }
    if (form == SYMMETRIC && nrow == ncol && is_triangle(&m->A))
        RITZ_CHECK(expand(m, MIRRORED, n));
    m->symmetric = m->A.nrow == m->A.ncol &&
                   (form == SYMMETRIC || form == DIAGONAL || form == IDENTITY);
    return RITZ_OK;
}
