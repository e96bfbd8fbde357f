/* Dense matrices and their products. */
#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <cblas.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A matrix of zeros; or, for functions that write every entry, of memory that
   is not initialised. */
static ritz_status allocate_dense(int64_t nrow, int64_t ncol, bool zeroed,
                                  ritz_dense *out)
{
    RITZ_REFUSE_IF(nrow < 0 || ncol < 0 || nrow > INT_MAX || ncol > INT_MAX,
                   RITZ_ERR_ARGUMENT,
                   "a dense matrix cannot be %" PRId64 " x %" PRId64, nrow,
                   ncol);
    if (zeroed)
        RITZ_CHECK_NEW(out->val, nrow * ncol);
    else
        RITZ_CHECK_RAW(out->val, nrow * ncol);
    out->nrow = nrow;
    out->ncol = ncol;
    return RITZ_OK;
}

ritz_status ritz_dense_new(int64_t nrow, int64_t ncol, ritz_dense *out)
{
    return allocate_dense(nrow, ncol, true, out);
}

ritz_status ritz_dense_columns(const ritz_dense *A, int64_t first,
                               int64_t count, ritz_dense *out)
{
    RITZ_CHECK(allocate_dense(A->nrow, count, false, out));
    if (A->nrow * count > 0)
        memcpy(out->val, ritz_dense_col(A, first),
               (size_t)(A->nrow * count) * sizeof *out->val);
    return RITZ_OK;
}

ritz_dense ritz_dense_part(const ritz_dense *A, int64_t first, int64_t count)
{
    return (ritz_dense){A->nrow, count, A->val + first * A->nrow};
}

ritz_status ritz_dense_rows(const ritz_dense *A, int64_t count,
                            const int64_t *row, ritz_dense *out)
{
    RITZ_CHECK(allocate_dense(count, A->ncol, false, out));
    for (int64_t j = 0; j < A->ncol; j++) {
        const double *a = ritz_dense_col(A, j);
        double *to = ritz_dense_col(out, j);

        for (int64_t i = 0; i < count; i++)
            to[i] = a[row[i]];
    }
    return RITZ_OK;
}

ritz_status ritz_dense_pick(const ritz_dense *A, int64_t count,
                            const int64_t *col, ritz_dense *out)
{
    RITZ_CHECK(allocate_dense(A->nrow, count, false, out));
    for (int64_t j = 0; j < count && A->nrow > 0; j++)
        memcpy(ritz_dense_col(out, j), ritz_dense_col(A, col[j]),
               (size_t)A->nrow * sizeof *out->val);
    return RITZ_OK;
}

void ritz_dense_spread(const ritz_dense *B, const int64_t *row, ritz_dense *A)
{
    memset(A->val, 0, (size_t)(A->nrow * A->ncol) * sizeof *A->val);
    for (int64_t j = 0; j < A->ncol; j++) {
        const double *b = ritz_dense_col(B, j);
        double *a = ritz_dense_col(A, j);

        for (int64_t i = 0; i < B->nrow; i++)
            a[row[i]] = b[i];
    }
}

ritz_status ritz_dense_principal(const ritz_dense *A, int64_t count,
                                 const int64_t *at, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) rows = {0};

    RITZ_CHECK(ritz_dense_rows(A, count, at, &rows));
    return ritz_dense_pick(&rows, count, at, out);
}

void ritz_dense_cut(const ritz_dense *A, int64_t row, int64_t col,
                    ritz_dense *out)
{
    for (int64_t j = 0; j < out->ncol; j++)
        for (int64_t i = 0; i < out->nrow; i++)
            ritz_dense_col(out, j)[i] = ritz_dense_col(A, col + j)[row + i];
}

ritz_status ritz_dense_block(const ritz_dense *A, int64_t row, int64_t nrow,
                             int64_t col, int64_t ncol, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(nrow, ncol, out));
    ritz_dense_cut(A, row, col, out);
    return RITZ_OK;
}

void ritz_dense_put(const ritz_dense *A, int64_t row, int64_t col,
                    ritz_dense *out)
{
    for (int64_t j = 0; j < A->ncol && A->nrow > 0; j++)
        memcpy(ritz_dense_col(out, col + j) + row, ritz_dense_col(A, j),
               (size_t)A->nrow * sizeof *out->val);
}

ritz_status ritz_dense_beside(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *out)
{
    int64_t n = A->nrow > 0 ? A->nrow : B->nrow;

    RITZ_CHECK(allocate_dense(n, A->ncol + B->ncol, false, out));
    ritz_dense_put(A, 0, 0, out);
    ritz_dense_put(B, 0, A->ncol, out);
    return RITZ_OK;
}

ritz_status ritz_dense_copy(const ritz_dense *A, ritz_dense *out)
{
    return ritz_dense_columns(A, 0, A->ncol, out);
}

ritz_status ritz_dense_identity(int64_t n, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(n, n, out));
    for (int64_t j = 0; j < n; j++)
        ritz_dense_col(out, j)[j] = 1.0;
    return RITZ_OK;
}

void ritz_dense_add(double factor, const ritz_dense *B, ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        A->val[k] += factor * B->val[k];
}

void ritz_dense_scale_rows(const double *factor, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] *= factor[i];
}

void ritz_dense_replace(ritz_dense *A, ritz_dense *B)
{
    ritz_dense_free(A);
    RITZ_MOVE(*A, *B);
}

/* A := A A */
static ritz_status square_matrix(ritz_dense *A)
{
    RITZ_OWN(ritz_dense) AA = {0};

    RITZ_CHECK(ritz_dense_mul(A, A, &AA));
    ritz_dense_replace(A, &AA);
    return RITZ_OK;
}

ritz_status ritz_dense_times(const ritz_dense *B, ritz_dense *A)
{
    enum { ROWS = 1024 }; /* of A at a time, so that A is not held twice */
    RITZ_OWN_ARRAY double *rows = NULL;

    RITZ_REFUSE_IF(A->ncol != B->nrow || B->ncol > A->ncol, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " columns cannot be replaced by their products "
                   "with a matrix of %" PRId64 " x %" PRId64,
                   A->ncol, B->nrow, B->ncol);
    if (A->ncol > 0 && A->val == B->val) /* B may not change with A */
        return square_matrix(A);
    RITZ_CHECK_NEW(rows, ROWS * A->ncol);
    for (int64_t r = 0; r < A->nrow && B->ncol > 0; r += ROWS) {
        const int64_t count = A->nrow - r < ROWS ? A->nrow - r : ROWS;

        for (int64_t j = 0; j < A->ncol; j++)
            memcpy(rows + j * count, ritz_dense_col(A, j) + r,
                   (size_t)count * sizeof *rows);
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)count,
                    (int)B->ncol, (int)A->ncol, 1.0, rows, (int)count, B->val,
                    (int)B->nrow, 0.0, A->val + r, (int)A->nrow);
    }
    A->ncol = B->ncol;
    return RITZ_OK;
}

ritz_status ritz_dense_abs(const ritz_dense *A, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_copy(A, out));
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        out->val[k] = fabs(out->val[k]);
    return RITZ_OK;
}

/* Rows and columns of a tile: an entry and its mirror image are read together, and
   a tile's cache lines stay in the cache. */
enum { MIRROR_TILE = 16 };

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

void ritz_dense_symmetrise(ritz_dense *A)
{
    const int64_t n = A->ncol, m = A->nrow;

    for (int64_t first = 0; first < n; first += MIRROR_TILE)
        for (int64_t top = 0; top <= first; top += MIRROR_TILE)
            for (int64_t j = first; j < least(first + MIRROR_TILE, n); j++)
                for (int64_t i = top; i < least(top + MIRROR_TILE, j); i++) {
                    double *upper = &A->val[i + j * m];
                    double *lower = &A->val[j + i * m];

                    *upper = *lower = 0.5 * (*upper + *lower);
                }
}

double ritz_dense_asymmetry(const ritz_dense *A)
{
    const int64_t n = A->ncol, m = A->nrow;
    double gap = 0.0;

    for (int64_t first = 0; first < n; first += MIRROR_TILE)
        for (int64_t top = 0; top <= first; top += MIRROR_TILE)
            for (int64_t j = first; j < least(first + MIRROR_TILE, n); j++)
                for (int64_t i = top; i < least(top + MIRROR_TILE, j); i++) {
                    const double d =
                        fabs(A->val[i + j * m] - A->val[j + i * m]);

                    gap = d > gap ? d : gap;
                }
    return gap > 0.0 ? gap / ritz_dense_max(A) : 0.0;
}

double ritz_dense_skew(const ritz_dense *A)
{
    double all = 0.0, skew = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++) {
            double a = ritz_dense_col(A, j)[i];

            all = hypot(all, a);
            skew = hypot(skew, 0.5 * (a - ritz_dense_col(A, i)[j]));
        }
    return all > 0.0 ? skew / all : 0.0;
}

double ritz_dense_max(const ritz_dense *A)
{
    double largest = 0.0;

    for (int64_t k = 0; k < A->nrow * A->ncol; k++) { /* fmax() is slower */
        const double size = fabs(A->val[k]);

        largest = size > largest ? size : largest;
    }
    return largest;
}

double ritz_dense_col_max(const ritz_dense *A, int64_t j)
{
    return ritz_dense_max(&(ritz_dense){A->nrow, 1, ritz_dense_col(A, j)});
}

void ritz_dense_orient(ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++) {
        double *a = ritz_dense_col(A, j);
        double largest = ritz_dense_col_max(A, j);
        int64_t first = 0;

        while (first < A->nrow &&
               fabs(a[first]) < largest * (1 - RITZ_LIKE_LARGEST))
            first++;
        if (first < A->nrow && a[first] < 0.0)
            for (int64_t i = 0; i < A->nrow; i++)
                a[i] = -a[i];
    }
}

double *ritz_dense_col(const ritz_dense *A, int64_t j)
{
    return A->val + j * A->nrow;
}

void ritz_dense_free(ritz_dense *A)
{
    free(A->val);
    *A = (ritz_dense){0};
}

/* Products of dense matrices, and what is made of two of them. */

/* C = op(A) op(B), m x q with p summed over. */
static ritz_status multiply_dense(CBLAS_TRANSPOSE left, const ritz_dense *A,
                                  CBLAS_TRANSPOSE right, const ritz_dense *B,
                                  ritz_dense *C)
{
    int64_t m = left == CblasTrans ? A->ncol : A->nrow;
    int64_t p = left == CblasTrans ? A->nrow : A->ncol;
    int64_t rows = right == CblasTrans ? B->ncol : B->nrow;
    int64_t q = right == CblasTrans ? B->nrow : B->ncol;

    RITZ_REFUSE_IF(p != rows, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " columns meet %" PRId64 " rows", p, rows);
    RITZ_CHECK(allocate_dense(m, q, p == 0, C));
    if (m > 0 && p > 0 && q > 0)
        cblas_dgemm(CblasColMajor, left, right, (int)m, (int)q, (int)p, 1.0,
                    A->val, (int)A->nrow, B->val, (int)B->nrow, 0.0, C->val,
                    (int)m);
    return RITZ_OK;
}

ritz_status ritz_dense_mul(const ritz_dense *A, const ritz_dense *B,
                           ritz_dense *C)
{
    return multiply_dense(CblasNoTrans, A, CblasNoTrans, B, C);
}

ritz_status ritz_dense_mul_tn(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *C)
{
    return multiply_dense(CblasTrans, A, CblasNoTrans, B, C);
}

ritz_status ritz_dense_mul_nt(const ritz_dense *A, const ritz_dense *B,
                              ritz_dense *C)
{
    return multiply_dense(CblasNoTrans, A, CblasTrans, B, C);
}

double ritz_dense_dot(const ritz_dense *A, int64_t i, const ritz_dense *B,
                      int64_t j)
{
    return cblas_ddot((int)A->nrow, ritz_dense_col(A, i), 1,
                      ritz_dense_col(B, j), 1);
}

ritz_status ritz_dense_take_out(const ritz_dense *left, const ritz_dense *right,
                                ritz_dense *X)
{
    RITZ_OWN(ritz_dense) part = {0};

    RITZ_CHECK(ritz_dense_mul_tn(right, X, &part));
    RITZ_REFUSE_IF(left->nrow != X->nrow || left->ncol != part.nrow,
                   RITZ_ERR_ARGUMENT,
                   "a part along %" PRId64 " x %" PRId64
                   " cannot be taken out of %" PRId64 " x %" PRId64,
                   left->nrow, left->ncol, X->nrow, X->ncol);
    if (X->nrow > 0 && X->ncol > 0 && left->ncol > 0)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)X->nrow,
                    (int)X->ncol, (int)left->ncol, -1.0, left->val,
                    (int)X->nrow, part.val, (int)part.nrow, 1.0, X->val,
                    (int)X->nrow);
    return RITZ_OK;
}

ritz_status ritz_dense_project(const ritz_dense *A, const ritz_dense *B,
                               ritz_dense *out)
{
    RITZ_OWN(ritz_dense) AB = {0};

    RITZ_CHECK(ritz_dense_mul(A, B, &AB));
    RITZ_CHECK(ritz_dense_mul_tn(B, &AB, out));
    if (ritz_dense_asymmetry(A) == 0.0)
        ritz_dense_symmetrise(out);
    return RITZ_OK;
}

ritz_status ritz_dense_congruence(const ritz_dense *A, const ritz_dense *B,
                                  ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_project(A, B, out));
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

ritz_status ritz_dense_terms(const ritz_dense *A, const ritz_dense *B,
                             ritz_dense *out)
{
    RITZ_OWN(ritz_dense) size = {0}, columns = {0};

    RITZ_CHECK(ritz_dense_abs(A, &size));
    RITZ_CHECK(ritz_dense_abs(B, &columns));
    return ritz_dense_project(&size, &columns, out);
}
