#include "assembly/springs.h"

#include "base/alloc.h"

#include <stdlib.h>

bool ritz_springs_damp(const ritz_springs *springs)
{
    for (int64_t k = 0; k < springs->S.nrow; k++)
        if (springs->hold[k].damping > 0.0)
            return true;
    return false;
}

/* A += sum_k s[k] R(k,:)' R(k,:), s the stiffnesses or the dampings. */
static void add_rows(const ritz_dense *R, const ritz_freedom *hold,
                     bool damping, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++) {
            double sum = 0.0;

            for (int64_t k = 0; k < R->nrow; k++)
                sum += (damping ? hold[k].damping : hold[k].stiffness) *
                       (ritz_dense_col(R, i)[k] * ritz_dense_col(R, j)[k]);
            ritz_dense_col(A, j)[i] += sum;
        }
}

ritz_status ritz_springs_add(const ritz_springs *springs, const ritz_dense *P,
                             ritz_dense *K, ritz_dense *D)
{
    ritz_status status = RITZ_OK;
    ritz_dense R = {0};

    if (springs->S.nrow == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_dense_mul(&springs->S, P, &R));
    add_rows(&R, springs->hold, false, K);
    if (D->val)
        add_rows(&R, springs->hold, true, D);
done:
    ritz_dense_free(&R);
    return status;
}

/* The coordinates that a row has. */
static int64_t list_entries(const ritz_dense *S, int64_t row, int64_t *column)
{
    int64_t count = 0;

    for (int64_t j = 0; j < S->ncol; j++)
        if (ritz_dense_col(S, j)[row] != 0.0)
            column[count++] = j;
    return count;
}

/* sum_k s[k] S(k,:)' S(k,:) over n. */
static ritz_status make_matrix(const ritz_springs *springs, bool damping,
                               int64_t n, const int64_t *at, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *S = &springs->S;
    int64_t *column = NULL, *row = NULL, *col = NULL;
    double *val = NULL;
    int64_t count = 0, most = 0;

    RITZ_NEW(column, S->ncol);
    for (int64_t k = 0; k < S->nrow; k++) {
        int64_t entries = list_entries(S, k, column);

        most += entries * entries;
    }
    RITZ_NEW(row, most);
    RITZ_NEW(col, most);
    RITZ_NEW(val, most);
    for (int64_t k = 0; k < S->nrow; k++) {
        const ritz_freedom *hold = &springs->hold[k];
        int64_t entries = list_entries(S, k, column);

        for (int64_t e = 0; e < entries * entries; e++) {
            int64_t i = column[e % entries];
            int64_t j = column[e / entries];

            row[count] = at[i];
            col[count] = at[j];
            val[count++] = (damping ? hold->damping : hold->stiffness) *
                           (ritz_dense_col(S, i)[k] * ritz_dense_col(S, j)[k]);
        }
    }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, count, row, col, val, out));
done:
    free(column);
    free(row);
    free(col);
    free(val);
    return status;
}

ritz_status ritz_springs_add_sparse(const ritz_springs *springs, bool damping,
                                    int64_t n, const int64_t *at,
                                    ritz_sparse *A)
{
    ritz_status status = RITZ_OK;
    ritz_sparse own = {0}, sum = {0};

    if (springs->S.nrow == 0 || (damping && !ritz_springs_damp(springs)))
        return RITZ_OK;
    RITZ_TRY(make_matrix(springs, damping, n, at, &own));
    if (A->colptr)
        RITZ_TRY(ritz_sparse_add(1.0, A, 1.0, &own, &sum));
    else
        RITZ_TRY(ritz_sparse_copy(&own, &sum));
    ritz_sparse_free(A);
    *A = sum;
done:
    ritz_sparse_free(&own);
    return status;
}

void ritz_springs_free(ritz_springs *springs)
{
    ritz_dense_free(&springs->S);
    free(springs->hold);
    *springs = (ritz_springs){0};
}
