/*
 * Modes of the second system that stand for no mode that was kept. With modes
 * of unit mass and X_kj their products, mode j holds of the kept modes' space
 *
 *     s_j = sum over kept k of X_kj^2,    0 <= s_j <= 1
 *
 * which does not depend on the basis of a cluster. It stands for kept modes if
 * that is half or more; the sum over all j is at most their number. What is
 * left comes of the projection: bodies have more coordinates than the system
 * had modes [McDaniel2000, table 3.3]. Static corrections are among them.
 */
#include "base/alloc.h"
#include "compare/compare_parts.h"

#include <ritz/eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Share of mode j in the space of the kept modes. */
static double share(const ritz_configuration *first,
                    const ritz_compare_row *row, const double *x)
{
    double sum = 0.0;

    for (int64_t i = 0; i < row->num_kept; i++) {
        double one = x[first->num_rigid + row->kept[i]];

        sum += one * one;
    }
    return sum;
}

/* What a stray mode is, and which mode of the first system it is most like. */
static ritz_stray describe(const ritz_scene *scene,
                           const ritz_configuration *first, double lambda,
                           const double *x)
{
    ritz_stray stray = {.hertz = ritz_eigen_hertz(lambda), .like = -1};
    bool outside =
        stray.hertz < scene->band_hz[0] || stray.hertz > scene->band_hz[1];

    for (int64_t k = first->num_rigid; k < first->K.ncol; k++)
        if (x[k] * x[k] > stray.mac) {
            stray.mac = x[k] * x[k];
            stray.like = k - first->num_rigid;
        }
    stray.removed =
        scene->extraneous == RITZ_EXTRANEOUS_REMOVE ||
        (scene->extraneous == RITZ_EXTRANEOUS_OUT_OF_BAND && outside);
    return stray;
}

ritz_status ritz_compare_strays(const ritz_scene *scene,
                                const ritz_configuration *first,
                                const ritz_configuration *second,
                                const ritz_dense *X, ritz_compare_row *row)
{
    const double half = 0.5;

    RITZ_CHECK_NEW(row->stray, second->K.ncol);
    if (scene->select == RITZ_SELECT_KRYLOV)
        return RITZ_OK; /* no mode was kept, so none is beside them */
    for (int64_t j = second->num_rigid; j < second->K.ncol; j++) {
        const double *x = ritz_dense_col(X, j);

        if (share(first, row, x) >= half)
            continue;
        row->stray[row->num_strays] =
            describe(scene, first, second->lambda[j], x);
        row->stray[row->num_strays++].mode = j - second->num_rigid;
    }
    return RITZ_OK;
}

/* Columns `keep` of A. */
static ritz_status take_columns(int64_t count, const int64_t *keep,
                                ritz_dense *A)
{
    ritz_status status = RITZ_OK;
    ritz_dense less = {0};

    RITZ_TRY(ritz_dense_new(A->nrow, count, &less));
    for (int64_t j = 0; j < count && A->nrow > 0; j++)
        memcpy(ritz_dense_col(&less, j), ritz_dense_col(A, keep[j]),
               (size_t)A->nrow * sizeof *A->val);
    ritz_dense_free(A);
    *A = less;
    less = (ritz_dense){0};
done:
    ritz_dense_free(&less);
    return status;
}

/* Rows and columns `keep` of a square A, or rows alone. */
static ritz_status take_rows(int64_t count, const int64_t *keep, bool square,
                             ritz_dense *A)
{
    ritz_status status = RITZ_OK;
    ritz_dense less = {0};

    if (square)
        RITZ_TRY(take_columns(count, keep, A));
    RITZ_TRY(ritz_dense_rows(A, count, keep, &less));
    ritz_dense_free(A);
    *A = less;
    less = (ritz_dense){0};
done:
    ritz_dense_free(&less);
    return status;
}

/* The modes `keep` of a configuration, and no other. */
static ritz_status truncate(int64_t count, const int64_t *keep,
                            ritz_configuration *c)
{
    for (int64_t k = 0; k < c->num_blocks; k++)
        RITZ_CHECK(take_columns(count, keep, &c->P[k]));
    RITZ_CHECK(take_columns(count, keep, &c->io.C));
    RITZ_CHECK(take_columns(count, keep, &c->io.Cv));
    RITZ_CHECK(take_columns(count, keep, &c->io.Ca));
    if (c->momentum.val)
        RITZ_CHECK(take_columns(count, keep, &c->momentum));
    RITZ_CHECK(take_rows(count, keep, false, &c->io.B));
    RITZ_CHECK(take_rows(count, keep, true, &c->K));
    RITZ_CHECK(take_rows(count, keep, true, &c->M));
    if (c->D.val)
        RITZ_CHECK(take_rows(count, keep, true, &c->D));
    if (c->K4.val)
        RITZ_CHECK(take_rows(count, keep, true, &c->K4));
    if (c->dampers.B.val)
        RITZ_CHECK(take_rows(count, keep, false, &c->dampers.B));
    for (int64_t j = 0; j < count; j++) /* keep[j] >= j */
        c->lambda[j] = c->lambda[keep[j]];
    return RITZ_OK;
}

ritz_status ritz_compare_remove(const ritz_compare_row *row,
                                ritz_configuration *second)
{
    ritz_status status = RITZ_OK;
    int64_t *keep = NULL;
    int64_t count = 0;
    int64_t next = 0;

    RITZ_NEW(keep, second->K.ncol);
    for (int64_t j = 0; j < second->K.ncol; j++) {
        while (next < row->num_strays &&
               (row->stray[next].mode + second->num_rigid < j))
            next++;
        if (next < row->num_strays &&
            row->stray[next].mode + second->num_rigid == j &&
            row->stray[next].removed)
            continue;
        keep[count++] = j;
    }
    if (count < second->K.ncol)
        RITZ_TRY(truncate(count, keep, second));
done:
    free(keep);
    return status;
}
