/*
 * An eigenvalue of a matrix that was rounded by eps |A| moves, to first order,
 * by at most eps |A| / s, s = |y'x| of its left and right eigenvectors of unit
 * length. LAPACK's dgeevx gives s and, after balancing, |A|.
 */
#include "linear/eigenvalues.h"

#include "base/alloc.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* Unsorted, as LAPACK leaves them; error still |A| / s. */
typedef struct value {
    double re, im, error;
} value;

static int by_magnitude(const void *left, const void *right)
{
    const value *a = left;
    const value *b = right;
    double x = hypot(a->re, a->im);
    double y = hypot(b->re, b->im);

    if (x != y)
        return (x > y) - (x < y);
    return (b->im > a->im) - (b->im < a->im);
}

static ritz_status check_matrix(const ritz_dense *A)
{
    RITZ_REFUSE_IF(A->nrow != A->ncol, RITZ_ERR_ARGUMENT,
                   "a matrix of %lld x %lld has no eigenvalues",
                   (long long)A->nrow, (long long)A->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        RITZ_REFUSE_IF(!isfinite(A->val[k]), RITZ_ERR_ARGUMENT,
                       "a matrix whose eigenvalues are wanted is not finite");
    return RITZ_OK;
}

static ritz_status find_eigenvalues(const ritz_dense *A, value *out)
{
    int n = (int)A->nrow;
    RITZ_OWN(ritz_dense) H = {0}, left = {0}, right = {0};
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL, *scale = NULL, *cosine = NULL;
    double norm = 0.0;
    lapack_int low = 0, high = 0;
    int info = 0;

    RITZ_CHECK(ritz_dense_copy(A, &H));
    RITZ_CHECK(ritz_dense_new(n, n, &left));
    RITZ_CHECK(ritz_dense_new(n, n, &right));
    RITZ_CHECK_NEW(re, n);
    RITZ_CHECK_NEW(im, n);
    RITZ_CHECK_NEW(scale, n);
    RITZ_CHECK_NEW(cosine, n);
    info = LAPACKE_dgeevx(LAPACK_COL_MAJOR, 'B', 'V', 'V', 'E', n, H.val, n, re,
                          im, left.val, n, right.val, n, &low, &high, scale,
                          &norm, cosine, NULL);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE, "poles were not found");
    for (int64_t k = 0; k < n; k++)
        out[k] = (value){re[k], im[k],
                         DBL_EPSILON * norm / fmax(cosine[k], DBL_EPSILON)};
    return RITZ_OK;
}

ritz_status ritz_eigenvalues_of(const ritz_dense *A, ritz_eigenvalues *out)
{
    RITZ_OWN(ritz_eigenvalues) eigenvalues = {.count = A->nrow};
    RITZ_OWN_ARRAY value *values = NULL;

    RITZ_CHECK(check_matrix(A));
    RITZ_CHECK_NEW(values, A->nrow);
    RITZ_CHECK_NEW(eigenvalues.re, A->nrow);
    RITZ_CHECK_NEW(eigenvalues.im, A->nrow);
    RITZ_CHECK_NEW(eigenvalues.error, A->nrow);
    if (A->nrow > 0)
        RITZ_CHECK(find_eigenvalues(A, values));
    qsort(values, (size_t)A->nrow, sizeof *values, by_magnitude);
    for (int64_t k = 0; k < A->nrow; k++) {
        eigenvalues.re[k] = values[k].re;
        eigenvalues.im[k] = values[k].im;
        eigenvalues.error[k] = values[k].error;
        eigenvalues.radius =
            fmax(eigenvalues.radius, hypot(values[k].re, values[k].im));
    }
    RITZ_MOVE(*out, eigenvalues);
    return RITZ_OK;
}

int64_t ritz_eigenvalues_worst(const ritz_eigenvalues *eigenvalues,
                               double times)
{
    int64_t worst = -1;
    int class_of_worst = 3;

    for (int64_t k = 0; k < eigenvalues->count; k++) {
        double error = times * eigenvalues->error[k];
        int class = eigenvalues->re[k] > error     ? 0
                    : eigenvalues->re[k] >= -error ? 1
                                                   : 2;

        if (class < class_of_worst ||
            (class == class_of_worst &&
             eigenvalues->re[k] > eigenvalues->re[worst])) {
            worst = k;
            class_of_worst = class;
        }
    }
    return worst;
}

void ritz_eigenvalues_free(ritz_eigenvalues *eigenvalues)
{
    RITZ_FREE(eigenvalues->re, eigenvalues->im, eigenvalues->error);
    *eigenvalues = (ritz_eigenvalues){0};
}
