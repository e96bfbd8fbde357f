/* Products with the matrices of a motion, and factors of their sums. */
#include "simulate/motion.h"

#include "base/alloc.h"

#include <cblas.h>
#include <complex.h>
#include <stdlib.h>

void ritz_motion_gemv(const ritz_dense *A, double alpha, const double *x,
                      double *y)
{
    if (A->val && A->nrow > 0 && A->ncol > 0)
        cblas_dgemv(CblasColMajor, CblasNoTrans, (int)A->nrow, (int)A->ncol,
                    alpha, A->val, (int)A->nrow, x, 1, 1.0, y, 1);
}

double ritz_motion_dot(int64_t n, const double *a, const double *b)
{
    double sum = 0.0;

    for (int64_t k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

void ritz_motion_add(const ritz_motion *motion, ritz_term term, double alpha,
                     const double *x, double *y)
{
    const ritz_dense *const dense[] = {&motion->K, &motion->M, &motion->D};
    const ritz_sparse *const all[] = {&motion->sK, &motion->sM, &motion->sD};
    const ritz_sparse *sparse = all[term];

    if (motion->form == RITZ_FORM_MODAL && term != RITZ_DAMPING) {
        for (int64_t k = 0; k < motion->n; k++)
            y[k] +=
                alpha * (term == RITZ_MASS ? 1.0 : motion->lambda[k]) * x[k];
        return;
    }
    if (motion->form != RITZ_FORM_SPARSE) {
        ritz_motion_gemv(dense[term], alpha, x, y);
        return;
    }
    for (int64_t j = 0; sparse->colptr && j < sparse->ncol; j++) {
        double xj = alpha * x[j];

        for (int64_t k = sparse->colptr[j];
             xj != 0.0 && k < sparse->colptr[j + 1]; k++)
            y[sparse->rowind[k]] += sparse->val[k] * xj;
    }
}

double ritz_motion_form(const ritz_dense *A, const double *x)
{
    double sum = 0.0;

    for (int64_t j = 0; j < A->ncol; j++) {
        const double *a = ritz_dense_col(A, j);
        const int below = (int)(A->nrow - j - 1);

        sum += x[j] * (a[j] * x[j] +
                       2.0 * cblas_ddot(below, a + j + 1, 1, x + j + 1, 1));
    }
    return sum;
}

static ritz_status factor_dense(const ritz_motion *motion, double m, double d,
                                double k, ritz_effective *F)
{
    RITZ_OWN(ritz_dense) sum = {0};

    RITZ_CHECK(ritz_dense_new(F->n, F->n, &sum));
    if (motion->D.val)
        ritz_dense_add(d, &motion->D, &sum);
    if (motion->form == RITZ_FORM_MODAL) {
        for (int64_t j = 0; j < F->n; j++)
            ritz_dense_col(&sum, j)[j] += m + k * motion->lambda[j];
    } else {
        ritz_dense_add(m, &motion->M, &sum);
        ritz_dense_add(k, &motion->K, &sum);
    }
    RITZ_CHECK_IN("a step", ritz_general_factor_new(&sum, &F->dense));
    return RITZ_OK;
}

/* The sum of the sparse matrices. */
static ritz_status combine_matrices(const ritz_motion *motion,
                                    const double c[3], bool fill,
                                    ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) sum = {0}, more = {0};

    RITZ_CHECK(ritz_sparse_add(c[0], &motion->sM, c[2], &motion->sK, &sum));
    if (motion->sD.colptr && c[1] != 0.0) {
        RITZ_CHECK(ritz_sparse_add(1.0, &sum, c[1], &motion->sD, &more));
        ritz_sparse_free(&sum);
        RITZ_MOVE(sum, more);
    }
    if (fill) {
        RITZ_CHECK(ritz_sparse_new(motion->n, motion->n, motion->n, &more));
        for (int64_t j = 0; j < motion->n; j++) {
            more.colptr[j + 1] = j + 1;
            more.rowind[j] = j;
            more.val[j] = motion->massless[j] ? 1.0 : 0.0;
        }
        RITZ_CHECK(ritz_sparse_add(1.0, &sum, 1.0, &more, out));
    } else {
        RITZ_MOVE(*out, sum);
    }
    return RITZ_OK;
}

/* CHOLMOD, MUMPS if K is indefinite, MUMPS's LU if D is not symmetric. */
static ritz_status factor_sparse(const ritz_motion *motion, const double c[3],
                                 bool fill, ritz_effective *F)
{
    const double _Complex one = 1.0;
    ritz_status status = RITZ_OK;
    bool skew = motion->sD.colptr && c[1] != 0.0 &&
                ritz_sparse_asymmetry(&motion->sD) > 0.0;
    const ritz_sparse *sum = &F->kept;

    RITZ_CHECK(combine_matrices(motion, c, fill, &F->kept));
    if (skew) {
        RITZ_CHECK_NEW(F->z, motion->n);
        RITZ_CHECK(ritz_zldl_new(1, &sum, &F->general));
        return ritz_zldl_factor(F->general, &one);
    }
    status = ritz_factor_spd(sum, &F->spd);
    if (status == RITZ_ERR_SINGULAR && !fill)
        status = ritz_ldl_new(sum, NULL, &F->ldl);
    return status;
}

ritz_status ritz_effective_new(const ritz_motion *motion, double m, double d,
                               double k, bool fill, ritz_effective *out)
{
    const double c[3] = {m, d, k};

    out->n = motion->n;
    if (motion->form == RITZ_FORM_SPARSE)
        return factor_sparse(motion, c, fill, out);
    return factor_dense(motion, m, d, k, out);
}

ritz_status ritz_effective_solve(ritz_effective *F, int64_t columns, double *x)
{
    ritz_dense X = {F->n, columns, x}; /* borrowed */

    if (F->n == 0 || columns == 0)
        return RITZ_OK;
    if (F->spd)
        return ritz_factor_solve(F->spd, &X);
    if (F->ldl)
        return ritz_ldl_solve(F->ldl, &X);
    if (!F->general) {
        ritz_general_factor_solve(&F->dense, false, &X);
        return RITZ_OK;
    }
    for (int64_t j = 0; j < columns; j++, x += F->n) { /* real right sides */
        for (int64_t k = 0; k < F->n; k++)
            F->z[k] = x[k];
        RITZ_CHECK(ritz_zldl_solve(F->general, false, 1, F->z));
        for (int64_t k = 0; k < F->n; k++)
            x[k] = creal(F->z[k]);
    }
    return RITZ_OK;
}

void ritz_effective_free(ritz_effective *F)
{
    ritz_general_factor_free(&F->dense);
    ritz_factor_free(&F->spd);
    ritz_ldl_free(&F->ldl);
    ritz_zldl_free(&F->general);
    ritz_sparse_free(&F->kept);
    free(F->z);
    *F = (ritz_effective){0};
}
