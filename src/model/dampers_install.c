/* D += sum (c - held_c) b b', K += sum (k - held_k) b b', dense and sparse. */
#include <ritz/dampers.h>

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>

/* Entries that b b' of one damper may have in a sparse matrix. */
static const int64_t most_entries = 1000000;

/* What installing damper j is to add to D, and to K. */
static double more_c(const ritz_dampers *dampers, int64_t j)
{
    return dampers->c[j] - dampers->held_c[j];
}

static double more_k(const ritz_dampers *dampers, int64_t j)
{
    return dampers->k[j] - dampers->held_k[j];
}

static bool any(const ritz_dampers *dampers,
                double (*more)(const ritz_dampers *, int64_t))
{
    for (int64_t j = 0; j < dampers->count; j++)
        if (more(dampers, j) != 0.0)
            return true;
    return false;
}

static void settle(ritz_dampers *dampers)
{
    for (int64_t j = 0; j < dampers->count; j++) {
        dampers->held_c[j] = dampers->c[j];
        dampers->held_k[j] = dampers->k[j];
    }
}

/* A += sum more_j b_j b_j', whose two triangles are the same to the bit. */
static void add(const ritz_dampers *dampers,
                double (*more)(const ritz_dampers *, int64_t), ritz_dense *A)
{
    for (int64_t j = 0; j < dampers->count; j++) {
        const double *b = ritz_dense_col(&dampers->B, j);
        double value = more(dampers, j);

        for (int64_t c = 0; value != 0.0 && c < A->ncol; c++)
            for (int64_t r = 0; r < A->nrow; r++)
                ritz_dense_col(A, c)[r] += value * (b[r] * b[c]);
    }
}

ritz_status ritz_dampers_install(ritz_dampers *dampers, ritz_dense *K,
                                 ritz_dense *D)
{
    int64_t n = K->nrow;

    RITZ_REFUSE_IF(dampers->count > 0 && dampers->B.nrow != n,
                   RITZ_ERR_ARGUMENT,
                   "dampers of %" PRId64 " coordinates in a model of %" PRId64,
                   dampers->B.nrow, n);
    if (any(dampers, more_c) && !D->val)
        RITZ_CHECK(ritz_dense_new(n, n, D));
    add(dampers, more_c, D);
    add(dampers, more_k, K);
    settle(dampers);
    return RITZ_OK;
}

static int64_t count_entries(const ritz_dense *B, int64_t j)
{
    int64_t count = 0;

    for (int64_t i = 0; i < B->nrow; i++)
        count += ritz_dense_col(B, j)[i] != 0.0;
    return count;
}

/* sum more_j b_j b_j' of few entries each. */
static ritz_status outer(const ritz_dampers *dampers,
                         double (*more)(const ritz_dampers *, int64_t),
                         ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = dampers->B.nrow;
    int64_t room = 0;
    int64_t count = 0;
    int64_t *row = NULL;
    int64_t *col = NULL;
    double *val = NULL;

    for (int64_t j = 0; j < dampers->count; j++) {
        int64_t m = count_entries(&dampers->B, j);

        RITZ_FAIL_IF(m * m > most_entries, RITZ_ERR_ARGUMENT,
                     "damper '%s' moves with %" PRId64
                     " dofs: as a sparse matrix that is too many",
                     dampers->name[j], m);
        room += m * m;
    }
    RITZ_NEW(row, room);
    RITZ_NEW(col, room);
    RITZ_NEW(val, room);
    for (int64_t j = 0; j < dampers->count; j++) {
        const double *b = ritz_dense_col(&dampers->B, j);

        for (int64_t c = 0; c < n; c++)
            for (int64_t r = 0; b[c] != 0.0 && r < n; r++)
                if (b[r] != 0.0) {
                    row[count] = r;
                    col[count] = c;
                    val[count++] = more(dampers, j) * (b[r] * b[c]);
                }
    }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, count, row, col, val, out));
done:
    free(row);
    free(col);
    free(val);
    return status;
}

/* A := A + sum more_j b_j b_j'. */
static ritz_status add_sparse(const ritz_dampers *dampers,
                              double (*more)(const ritz_dampers *, int64_t),
                              ritz_sparse *A)
{
    ritz_status status = RITZ_OK;
    ritz_sparse part = {0};
    ritz_sparse sum = {0};

    if (!any(dampers, more))
        return RITZ_OK;
    RITZ_TRY(outer(dampers, more, &part));
    if (A->colptr) {
        RITZ_TRY(ritz_sparse_add(1.0, A, 1.0, &part, &sum));
        ritz_sparse_free(A);
        *A = sum;
        sum = (ritz_sparse){0};
    } else {
        *A = part;
        part = (ritz_sparse){0};
    }
done:
    ritz_sparse_free(&part);
    ritz_sparse_free(&sum);
    return status;
}

ritz_status ritz_dampers_install_sparse(ritz_dampers *dampers, ritz_sparse *K,
                                        ritz_sparse *D)
{
    RITZ_REFUSE_IF(dampers->count > 0 && dampers->B.nrow != K->nrow,
                   RITZ_ERR_ARGUMENT,
                   "dampers of %" PRId64 " coordinates in a model of %" PRId64,
                   dampers->B.nrow, K->nrow);
    RITZ_CHECK(add_sparse(dampers, more_c, D));
    RITZ_CHECK(add_sparse(dampers, more_k, K));
    settle(dampers);
    return RITZ_OK;
}
