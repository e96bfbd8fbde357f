/*
 * With right and left eigenvectors x, y of a pair, A x = lambda E x, an
 * eigenvalue of matrices rounded by eps |A| and eps |E| moves to first order by
 *
 *     eps (|A| + |lambda| |E|) |x| |y| / |y'E x|
 *
 * and without E by eps |A| |x| |y| / |y'x|.
 */
#include "linear/schur.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>

/* Eigenvectors of the Schur form itself: Q and Z leave their lengths as they
   are. */
typedef struct vectors {
    ritz_dense left, right, Eright;
} vectors;

static void vectors_free(vectors *v)
{
    ritz_dense_free(&v->left);
    ritz_dense_free(&v->right);
    ritz_dense_free(&v->Eright);
}

static ritz_status find_vectors(ritz_schur *schur, vectors *out)
{
    int n = (int)schur->count;
    lapack_int found = 0;
    int info = 0;

    RITZ_CHECK(ritz_dense_new(n, n, &out->left));
    RITZ_CHECK(ritz_dense_new(n, n, &out->right));
    if (schur->T.val)
        info = LAPACKE_dtgevc(LAPACK_COL_MAJOR, 'B', 'A', NULL, n, schur->S.val,
                              n, schur->T.val, n, out->left.val, n,
                              out->right.val, n, n, &found);
    else
        info =
            LAPACKE_dtrevc(LAPACK_COL_MAJOR, 'B', 'A', NULL, n, schur->S.val, n,
                           out->left.val, n, out->right.val, n, n, &found);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "eigenvectors of a Schur form were not found");
    if (schur->T.val)
        RITZ_CHECK(ritz_dense_mul(&schur->T, &out->right, &out->Eright));
    return RITZ_OK;
}

/* |y'E x| / |x| |y| of column k, or of the pair that begins there. */
static double cosine_of(const vectors *v, int64_t k, bool pair)
{
    const ritz_dense *Ex = v->Eright.val ? &v->Eright : &v->right;
    double x = ritz_dense_dot(&v->right, k, &v->right, k);
    double y = ritz_dense_dot(&v->left, k, &v->left, k);
    double re = ritz_dense_dot(&v->left, k, Ex, k);
    double im = 0.0;

    if (pair) {
        x += ritz_dense_dot(&v->right, k + 1, &v->right, k + 1);
        y += ritz_dense_dot(&v->left, k + 1, &v->left, k + 1);
        re += ritz_dense_dot(&v->left, k + 1, Ex, k + 1);
        im = ritz_dense_dot(&v->left, k, Ex, k + 1) -
             ritz_dense_dot(&v->left, k + 1, Ex, k);
    }
    return x > 0.0 && y > 0.0 ? hypot(re, im) / sqrt(x) / sqrt(y) : 0.0;
}

static ritz_status find_errors(ritz_schur *schur)
{
    RITZ_OWN(vectors) v = {0};
    double size = ritz_general_size(&schur->S);
    double size_of_E = schur->T.val ? ritz_general_size(&schur->T) : 0.0;
    int64_t step = 1;

    RITZ_CHECK(find_vectors(schur, &v));
    for (int64_t k = 0; k < schur->count; k += step) {
        bool pair = k + 1 < schur->count && schur->im[k] != 0.0;
        double lambda = hypot(schur->re[k], schur->im[k]);
        double moves = size + lambda * size_of_E;
        double s = cosine_of(&v, k, pair);
        /* no vector of unit length is better known than to eps */
        double least = DBL_EPSILON * (schur->T.val ? size_of_E : 1.0);

        step = pair ? 2 : 1;
        for (int64_t i = k; i < k + step; i++)
            schur->error[i] = DBL_EPSILON * moves / fmax(s, least);
    }
    return RITZ_OK;
}

/* A symmetric matrix has its eigenvectors for Schur vectors. */
static ritz_status diagonalise_blocks(ritz_schur *schur)
{
    int n = (int)schur->count;
    double size = ritz_general_size(&schur->S);

    for (int64_t k = 0; k < schur->count * schur->count; k++) {
        schur->Q.val[k] = schur->S.val[k];
        schur->S.val[k] = 0.0;
    }
    RITZ_REFUSE_IF(LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', n, schur->Q.val,
                                  n, schur->re) != 0,
                   RITZ_ERR_CONVERGENCE, "poles were not found");
    for (int64_t k = 0; k < schur->count; k++) {
        ritz_dense_col(&schur->S, k)[k] = schur->re[k];
        schur->error[k] = DBL_EPSILON * size;
    }
    return RITZ_OK;
}

static ritz_status factor_schur(ritz_schur *schur)
{
    int n = (int)schur->count;
    lapack_int none = 0;

    if (ritz_dense_asymmetry(&schur->S) == 0.0)
        return diagonalise_blocks(schur);
    RITZ_REFUSE_IF(LAPACKE_dgees(LAPACK_COL_MAJOR, 'V', 'N', NULL, n,
                                 schur->S.val, n, &none, schur->re, schur->im,
                                 schur->Q.val, n) != 0,
                   RITZ_ERR_CONVERGENCE, "poles were not found");
    return find_errors(schur);
}

/* lambda = alpha / beta, beta the diagonal of T. */
static ritz_status divide_eigenvalues(ritz_schur *schur, const double *beta)
{
    double least = DBL_EPSILON * ritz_general_size(&schur->T);

    for (int64_t k = 0; k < schur->count; k++) {
        RITZ_REFUSE_IF(!(fabs(beta[k]) > least), RITZ_ERR_SINGULAR,
                       "E is singular to working accuracy");
        schur->re[k] /= beta[k];
        schur->im[k] /= beta[k];
    }
    return RITZ_OK;
}

static ritz_status factor_pair(const ritz_dense *E, ritz_schur *schur)
{
    int n = (int)schur->count;
    lapack_int none = 0;
    RITZ_OWN_ARRAY double *beta = NULL;

    RITZ_CHECK_NEW(beta, n);
    RITZ_CHECK(ritz_dense_copy(E, &schur->T));
    RITZ_CHECK(ritz_dense_new(n, n, &schur->Z));
    RITZ_REFUSE_IF(LAPACKE_dgges(LAPACK_COL_MAJOR, 'V', 'V', 'N', NULL, n,
                                 schur->S.val, n, schur->T.val, n, &none,
                                 schur->re, schur->im, beta, schur->Q.val, n,
                                 schur->Z.val, n) != 0,
                   RITZ_ERR_CONVERGENCE, "poles were not found");
    RITZ_CHECK(divide_eigenvalues(schur, beta));
    return find_errors(schur);
}

ritz_status ritz_schur_new(const ritz_dense *A, const ritz_dense *E,
                           ritz_schur *out)
{
    RITZ_OWN(ritz_schur) schur = {.count = A->nrow};

    RITZ_CHECK(ritz_dense_copy(A, &schur.S));
    RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &schur.Q));
    RITZ_CHECK_NEW(schur.re, A->nrow);
    RITZ_CHECK_NEW(schur.im, A->nrow);
    RITZ_CHECK_NEW(schur.error, A->nrow);
    if (A->nrow > 0 && E && E->val)
        RITZ_CHECK(factor_pair(E, &schur));
    else if (A->nrow > 0)
        RITZ_CHECK(factor_schur(&schur));
    RITZ_MOVE(*out, schur);
    return RITZ_OK;
}

/* Work space is ours: LAPACKE gives none where LAPACK reports its size. */
static int reorder_schur(ritz_schur *schur, const lapack_logical *select,
                         double *work, lapack_int *moved)
{
    int n = (int)schur->count;
    int room = 4 * n + 16;
    lapack_int integer = 0;
    double unused[2] = {0};

    if (schur->T.val)
        return LAPACKE_dtgsen_work(
            LAPACK_COL_MAJOR, 0, 1, 1, select, n, schur->S.val, n, schur->T.val,
            n, schur->re, schur->im, work, schur->Q.val, n, schur->Z.val, n,
            moved, &unused[0], &unused[1], NULL, work + n, room, &integer, 1);
    return LAPACKE_dtrsen_work(LAPACK_COL_MAJOR, 'N', 'V', select, n,
                               schur->S.val, n, schur->Q.val, n, schur->re,
                               schur->im, moved, &unused[0], &unused[1], work,
                               room, &integer, 1);
}

ritz_status ritz_schur_order(ritz_schur *schur, const bool *first,
                             int64_t *moved)
{
    RITZ_OWN_ARRAY lapack_logical *select = NULL;
    /* of a pair it begins with the diagonal of T */
    RITZ_OWN_ARRAY double *work = NULL;
    lapack_int count = 0;

    RITZ_CHECK_NEW(select, schur->count);
    RITZ_CHECK_NEW(work, 5 * schur->count + 16);
    for (int64_t k = 0; k < schur->count; k++)
        select[k] = first[k];
    if (schur->count > 0)
        RITZ_REFUSE_IF(
            reorder_schur(schur, select, work, &count) != 0,
            RITZ_ERR_CONVERGENCE,
            "poles that must be separated are too close to each other");
    if (schur->T.val)
        RITZ_CHECK(divide_eigenvalues(schur, work));
    *moved = count;
    return RITZ_OK;
}

void ritz_schur_free(ritz_schur *schur)
{
    ritz_dense_free(&schur->S);
    ritz_dense_free(&schur->T);
    ritz_dense_free(&schur->Q);
    ritz_dense_free(&schur->Z);
    RITZ_FREE(schur->re, schur->im, schur->error);
    *schur = (ritz_schur){0};
}
