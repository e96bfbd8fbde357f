#include "linear/resolvent.h"

#include "base/alloc.h"

#include <cblas.h>
#include <complex.h>
#include <lapacke.h>
#include <string.h>

/* A with complex entries, by column. */
static ritz_status widen_matrix(const ritz_dense *A, double _Complex **out)
{
    RITZ_CHECK_NEW(*out, A->nrow * A->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        (*out)[k] = A->val[k];
    return RITZ_OK;
}

/* B := Q^H B, C := C Z; T and X are there to work in. */
static void turn_loads(const double _Complex *Q, const double _Complex *Z,
                       ritz_resolvent *r)
{
    const double _Complex one = 1.0, zero = 0.0;
    int n = r->n, m = r->m, p = r->p;

    if (m > 0) {
        memcpy(r->X, r->B, (size_t)n * (size_t)m * sizeof *r->X);
        cblas_zgemm(CblasColMajor, CblasConjTrans, CblasNoTrans, n, m, n, &one,
                    Q, n, r->X, n, &zero, r->B, n);
    }
    for (int i = 0; i < p; i++) { /* a row at a time, as T holds one */
        cblas_zcopy(n, r->C + i, p, r->T, 1);
        cblas_zgemv(CblasColMajor, CblasTrans, n, n, &one, Z, n, r->T, 1, &zero,
                    r->C + i, p);
    }
}

static ritz_status triangularise_pencil(ritz_resolvent *r)
{
    int n = r->n;
    int64_t square = (int64_t)n * n;
    RITZ_OWN_ARRAY double _Complex *Q = NULL, *Z = NULL;
    RITZ_OWN_ARRAY double _Complex *alpha = NULL, *beta = NULL;
    lapack_int none = 0;
    int info = 0;

    RITZ_CHECK_NEW(Q, square);
    RITZ_CHECK_NEW(alpha, n);
    if (r->P) {
        RITZ_CHECK_NEW(Z, square);
        RITZ_CHECK_NEW(beta, n);
        info = LAPACKE_zgges(LAPACK_COL_MAJOR, 'V', 'V', 'N', NULL, n, r->S, n,
                             r->P, n, &none, alpha, beta, Q, n, Z, n);
    } else {
        info = LAPACKE_zgees(LAPACK_COL_MAJOR, 'V', 'N', NULL, n, r->S, n,
                             &none, alpha, Q, n);
    }
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE, "poles were not found");
    turn_loads(Q, r->P ? Z : Q, r);
    return RITZ_OK;
}

ritz_status ritz_resolvent_new(const ritz_dense *A, const ritz_dense *P,
                               const ritz_dense *B, const ritz_dense *C,
                               ritz_resolvent *out)
{
    RITZ_OWN(ritz_resolvent)
    r = {.n = (int)A->nrow, .m = (int)B->ncol, .p = (int)C->nrow};

    RITZ_CHECK(widen_matrix(A, &r.S));
    if (P->val)
        RITZ_CHECK(widen_matrix(P, &r.P));
    RITZ_CHECK(widen_matrix(B, &r.B));
    RITZ_CHECK(widen_matrix(C, &r.C));
    RITZ_CHECK_NEW(r.T, (int64_t)r.n * r.n);
    RITZ_CHECK_NEW(r.X, (int64_t)r.n * r.m);
    if (r.n > 0)
        RITZ_CHECK(triangularise_pencil(&r));
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

double _Complex ritz_resolvent_pole(const ritz_resolvent *resolvent, int64_t k)
{
    int64_t at = k + k * resolvent->n;

    return resolvent->P ? resolvent->S[at] / resolvent->P[at]
                        : resolvent->S[at];
}

/* T = z P - S, upper triangle; false if its diagonal is near 0. */
static bool shift_triangle(ritz_resolvent *r, double _Complex z, double near)
{
    double least = near * cabs(z);

    for (int64_t j = 0; j < r->n; j++) {
        for (int64_t i = 0; i <= j; i++) {
            int64_t at = i + j * r->n;
            double _Complex p = i == j ? 1.0 : 0.0;

            r->T[at] = z * (r->P ? r->P[at] : p) - r->S[at];
        }
        if (cabs(r->T[j + j * r->n]) <= least)
            return false;
    }
    return true;
}

bool ritz_resolvent_add(ritz_resolvent *resolvent, double _Complex z,
                        double near, double _Complex *H)
{
    const double _Complex one = 1.0;
    ritz_resolvent *r = resolvent;
    int n = r->n, m = r->m, p = r->p;

    if (n == 0 || m == 0 || p == 0)
        return true;
    if (!shift_triangle(r, z, near))
        return false;
    memcpy(r->X, r->B, (size_t)n * (size_t)m * sizeof *r->X);
    cblas_ztrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans,
                CblasNonUnit, n, m, &one, r->T, n, r->X, n);
    cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, p, m, n, &one, r->C,
                p, r->X, n, &one, H, p);
    return true;
}

void ritz_resolvent_free(ritz_resolvent *resolvent)
{
    RITZ_FREE(resolvent->S, resolvent->P, resolvent->B, resolvent->C,
              resolvent->T, resolvent->X);
    *resolvent = (ritz_resolvent){0};
}
