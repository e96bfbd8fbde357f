/*
 * A response at many points: with A = U S U^*, S an upper triangle,
 *
 *     G(i w) = diag((i w)^power) (C U (i w I - S)^-1 U^* B + D)
 *
 * costs a triangular solve.
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "poles/poles.h"
#include "poles/widen.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct ritz_sampler {
    int n, p;
    double _Complex *S, *B, *C; /* n x n, n x p, p x n */
    double _Complex *T, *X, *H; /* to work in */
    const double *D;            /* p x p, borrowed */
    const int *power;
};

/* On a pole there is no answer. */
static const double on_pole = 1e-13;

ritz_status ritz_sampler_new(const ritz_collocated *model, ritz_sampler **out)
{
    ritz_status status = RITZ_OK;
    ritz_sampler *s = NULL;
    double _Complex *U = NULL, *lambda = NULL;
    lapack_int none = 0;
    int info = 0;

    RITZ_NEW(s, 1);
    s->n = (int)model->A.nrow;
    s->p = (int)model->B.ncol;
    s->D = model->D.val;
    s->power = model->power;
    RITZ_TRY(ritz_widen(&model->A, &s->S));
    RITZ_TRY(ritz_widen(&model->B, &s->B));
    RITZ_TRY(ritz_widen(&model->C, &s->C));
    RITZ_NEW(s->T, (int64_t)s->n * s->n);
    RITZ_NEW(s->X, (int64_t)s->n * s->p);
    RITZ_NEW(s->H, (int64_t)s->p * s->p);
    RITZ_NEW(U, (int64_t)s->n * s->n);
    RITZ_NEW(lambda, s->n);
    if (s->n > 0)
        info = LAPACKE_zgees(LAPACK_COL_MAJOR, 'V', 'N', NULL, s->n, s->S, s->n,
                             &none, lambda, U, s->n);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE, "poles were not found");
    if (s->n > 0)
        RITZ_TRY(ritz_turn(s->n, s->p, s->p, U, U, &s->B, &s->C));
    *out = s;
    s = NULL;
done:
    free(U);
    free(lambda);
    ritz_sampler_free(&s);
    return status;
}

/* T = i w - S, false where that is singular. */
static bool shift(ritz_sampler *s, double w)
{
    int64_t n = s->n;

    for (int64_t k = 0; k < n * n; k++)
        s->T[k] = -s->S[k];
    for (int64_t k = 0; k < n; k++) {
        s->T[k + k * n] += ritz_complex(0.0, w);
        if (cabs(s->T[k + k * n]) <= on_pole * w)
            return false;
    }
    return true;
}

const double _Complex *ritz_sampler_at(ritz_sampler *s, double w)
{
    const double _Complex one = 1.0;
    int n = s->n, p = s->p;

    if (!shift(s, w))
        return NULL;
    for (int64_t k = 0; k < (int64_t)p * p; k++)
        s->H[k] = s->D[k];
    if (n > 0) {
        memcpy(s->X, s->B, (size_t)n * (size_t)p * sizeof *s->X);
        cblas_ztrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans,
                    CblasNonUnit, n, p, &one, s->T, n, s->X, n);
        cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, p, p, n, &one,
                    s->C, p, s->X, n, &one, s->H, p);
    }
    for (int64_t i = 0; i < p; i++)
        for (int64_t j = 0; j < p; j++) {
            double _Complex *h = &s->H[i + j * p];

            if (s->power[i] > 0)
                *h *= ritz_complex(0.0, w);
            else if (s->power[i] < 0)
                *h *= ritz_complex(0.0, -1.0 / w);
        }
    return s->H;
}

void ritz_sampler_free(ritz_sampler **sampler)
{
    ritz_sampler *s = *sampler;

    if (!s)
        return;
    free(s->S);
    free(s->B);
    free(s->C);
    free(s->T);
    free(s->X);
    free(s->H);
    free(s);
    *sampler = NULL;
}
