/* From the entries of a Matrix Market file to columns of both triangles. */
#include "formats/matrix_market.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

void ritz_market_mirror(const ritz_market *m, double *re, double *im)
{
    if (m->symmetry == RITZ_MARKET_SKEW) {
        *re = -*re;
        *im = -*im;
    } else if (m->symmetry == RITZ_MARKET_HERMITIAN) {
        *im = -*im;
    }
}

static bool is_sorted(const ritz_market *m)
{
    for (int64_t k = 1; k < m->count; k++) {
        const ritz_market_entry *a = &m->entry[k - 1];
        const ritz_market_entry *b = &m->entry[k];

        if (a->col > b->col || (a->col == b->col && a->row > b->row))
            return false;
    }
    return true;
}

/* Stable counting sort of the entries, by row or by column. */
static ritz_status sort_by(ritz_market *m, bool by_row)
{
    ritz_status status = RITZ_OK;
    int64_t n = by_row ? m->nrow : m->ncol;
    int64_t *start = NULL;
    ritz_market_entry *sorted = NULL;

    RITZ_NEW(start, n + 1);
    RITZ_NEW(sorted, m->count);
    for (int64_t k = 0; k < m->count; k++)
        start[(by_row ? m->entry[k].row : m->entry[k].col) + 1]++;
    for (int64_t j = 0; j < n; j++)
        start[j + 1] += start[j];
    for (int64_t k = 0; k < m->count; k++)
        sorted[start[by_row ? m->entry[k].row : m->entry[k].col]++] =
            m->entry[k];
    free(m->entry);
    m->entry = sorted;
    sorted = NULL;
done:
    free(start);
    free(sorted);
    return status;
}

ritz_status ritz_market_settle(ritz_market *m)
{
    int64_t kept = 0;
    int64_t run = 0; /* entries at one place */

    if (!is_sorted(m)) {
        RITZ_CHECK(sort_by(m, true));
        RITZ_CHECK(sort_by(m, false));
    }
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_market_entry *e = &m->entry[k];
        const ritz_market_entry *last = kept > 0 ? &m->entry[kept - 1] : NULL;

        if (!last || last->row != e->row || last->col != e->col) {
            m->entry[kept++] = *e;
            run = 1;
            continue;
        }
        run++;
        RITZ_REFUSE_IF(last->flipped == e->flipped || run > 2, RITZ_ERR_FORMAT,
                       "entry (%" PRId64 ", %" PRId64 ") is given twice",
                       e->row + 1, e->col + 1);
        RITZ_REFUSE_IF(last->re != e->re || last->im != e->im, RITZ_ERR_FORMAT,
                       "entries (%" PRId64 ", %" PRId64 ") and (%" PRId64
                       ", %" PRId64 ") of a %s matrix disagree",
                       e->row + 1, e->col + 1, e->col + 1, e->row + 1, m->kind);
    }
    m->count = kept;
    return RITZ_OK;
}

static bool is_zero(const ritz_market_entry *e)
{
    return e->re == 0.0 && e->im == 0.0;
}

/*
 * Columns from sorted entries. Mirrored ones come from columns further left, so
 * that they are in place, in order, when a column's own entries follow.
 */
ritz_status ritz_market_compress(const ritz_market *m, ritz_matrix *out)
{
    ritz_status status = RITZ_OK;
    ritz_sparse A = {0};
    int64_t *next = NULL;
    double *imaginary = NULL;

    RITZ_NEW(next, m->ncol + 1);
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_market_entry *e = &m->entry[k];

        if (is_zero(e))
            continue;
        next[e->col + 1]++;
        if (m->symmetry != RITZ_MARKET_GENERAL && e->row != e->col)
            next[e->row + 1]++;
    }
    for (int64_t j = 0; j < m->ncol; j++)
        next[j + 1] += next[j];
    RITZ_TRY(ritz_sparse_new(m->nrow, m->ncol, next[m->ncol], &A));
    memcpy(A.colptr, next, (size_t)(m->ncol + 1) * sizeof *next);
    if (m->field == RITZ_MARKET_COMPLEX)
        RITZ_NEW(imaginary, next[m->ncol]);
    for (int64_t k = 0; k < m->count; k++) {
        ritz_market_entry e = m->entry[k];
        bool twice = m->symmetry != RITZ_MARKET_GENERAL && e.row != e.col;

        for (int turn = 0; turn < (twice ? 2 : 1) && !is_zero(&e); turn++) {
            int64_t p = next[turn ? e.row : e.col]++;

            if (turn)
                ritz_market_mirror(m, &e.re, &e.im);
            A.rowind[p] = turn ? e.col : e.row;
            A.val[p] = e.re;
            if (imaginary)
                imaginary[p] = e.im;
        }
    }
    out->A = A;
    out->imaginary = imaginary;
    A = (ritz_sparse){0};
    imaginary = NULL;
done:
    free(next);
    free(imaginary);
    ritz_sparse_free(&A);
    return status;
}
