/*
 * Finite zeros by the reduction of the system pencil to a regular one of the
 * same finite zeros (SLICOT AB08ND, [EmamiNaeiniVanDooren1982]). Time, inputs
 * and outputs are scaled first, so that its decisions on rank are no question
 * of units.
 */
#include "poles/channel.h"

#include "base/alloc.h"
#include "poles/poles.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* The Fortran name; character arguments bring their lengths at the end. */
void ab08nd_(/* NOLINT: its name */ const char *equil, const int *n,
             const int *m, const int *p, double *A, const int *lda, double *B,
             const int *ldb, double *C, const int *ldc, double *D,
             const int *ldd, int *nu, int *rank, int *dinfz, int *nkror,
             int *nkrol, int *infz, int *kronr, int *kronl, double *Af,
             const int *ldaf, double *Bf, const int *ldbf, const double *tol,
             int *iwork, double *work, const int *ldwork, int *info,
             size_t equil_length);

typedef struct pencil {
    int n, m, p, nu, rank;
    double speed; /* that time was divided by */
    ritz_dense A, B, C, D, Af, Bf;
    int *infz, *kronr, *kronl, *iwork;
    double *work, *re, *im, *beta;
} pencil;

static void discard(pencil *s)
{
    ritz_dense_free(&s->A);
    ritz_dense_free(&s->B);
    ritz_dense_free(&s->C);
    ritz_dense_free(&s->D);
    ritz_dense_free(&s->Af);
    ritz_dense_free(&s->Bf);
    free(s->infz);
    free(s->kronr);
    free(s->kronl);
    free(s->iwork);
    free(s->work);
    free(s->re);
    free(s->im);
    free(s->beta);
}

/* The same with largest entry 1, unless it is zero; what it was. */
static ritz_status scaled(const ritz_dense *A, double *size, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_copy(A, out));
    *size = ritz_dense_max(A);
    if (*size == 0.0)
        *size = 1.0;
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        out->val[k] /= *size;
    return RITZ_OK;
}

static ritz_status start(const ritz_channel *c, pencil *s)
{
    double b = 1.0, seen = 1.0;

    s->n = (int)c->A.nrow;
    s->m = (int)c->B.ncol;
    s->p = (int)c->C.nrow;
    RITZ_CHECK(scaled(&c->A, &s->speed, &s->A));
    RITZ_CHECK(scaled(&c->B, &b, &s->B));
    RITZ_CHECK(scaled(&c->C, &seen, &s->C));
    RITZ_CHECK(ritz_dense_copy(&c->D, &s->D));
    for (int64_t k = 0; k < s->D.nrow * s->D.ncol; k++)
        s->D.val[k] *= s->speed / (b * seen);
    RITZ_CHECK(ritz_dense_new(s->n + s->m, s->n + (s->m < s->p ? s->m : s->p),
                              &s->Af));
    RITZ_CHECK(ritz_dense_new(s->n + s->p, s->n + s->m, &s->Bf));
    RITZ_CHECK_NEW(s->infz, s->n);
    RITZ_CHECK_NEW(s->kronr, (int64_t)s->n + s->m + 1);
    RITZ_CHECK_NEW(s->kronl, (int64_t)s->n + s->p + 1);
    RITZ_CHECK_NEW(s->iwork, (int64_t)s->m + s->p);
    return RITZ_OK;
}

static ritz_status deflate(pencil *s)
{
    int room = 64 * (s->n + s->m + s->p + 1);
    int lda = s->n > 1 ? s->n : 1;
    int ldp = s->p > 1 ? s->p : 1;
    int ldaf = s->n + s->m, ldbf = s->n + s->p;
    int dinfz = 0, nkror = 0, nkrol = 0, info = 0;
    double tolerance = 0.0; /* its own: sqrt((n + p)(n + m)) eps */

    RITZ_CHECK_NEW(s->work, room);
    ab08nd_("N", &s->n, &s->m, &s->p, s->A.val, &lda, s->B.val, &lda, s->C.val,
            &ldp, s->D.val, &ldp, &s->nu, &s->rank, &dinfz, &nkror, &nkrol,
            s->infz, s->kronr, s->kronl, s->Af.val, &ldaf, s->Bf.val, &ldbf,
            &tolerance, s->iwork, s->work, &room, &info, 1);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "the zeros were not found, SLICOT says %d", info);
    RITZ_REFUSE_IF(s->rank < s->m || s->rank < s->p, RITZ_ERR_SINGULAR,
                   s->m == 1 && s->p == 1
                       ? "nothing passes from that input to that output"
                       : "what passes through all channels has not as many "
                         "dimensions as there are of them: zeros are "
                         "everywhere");
    return RITZ_OK;
}

ritz_status ritz_channel_pencil(const ritz_channel *channel, int64_t *count,
                                double _Complex **out)
{
    ritz_status status = RITZ_OK;
    pencil s = {0};
    double _Complex *zero = NULL;
    int64_t kept = 0;
    int info = 0;

    RITZ_TRY(start(channel, &s));
    RITZ_TRY(deflate(&s));
    RITZ_NEW(s.re, s.nu);
    RITZ_NEW(s.im, s.nu);
    RITZ_NEW(s.beta, s.nu);
    RITZ_NEW(zero, s.nu);
    if (s.nu > 0)
        info = LAPACKE_dggev(LAPACK_COL_MAJOR, 'N', 'N', s.nu, s.Af.val,
                             s.n + s.m, s.Bf.val, s.n + s.p, s.re, s.im, s.beta,
                             NULL, 1, NULL, 1);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_CONVERGENCE, "zeros were not found");
    for (int k = 0; k < s.nu; k++) {
        bool second = kept > 0 && s.im[k] < 0.0 && s.im[k - 1] > 0.0;

        if (s.beta[k] == 0.0)
            continue;
        zero[kept] = ritz_complex(s.re[k], s.im[k]) / s.beta[k] * s.speed;
        if (second) /* of a pair, exactly */
            zero[kept] = conj(zero[kept - 1]);
        kept++;
    }
    *count = kept;
    *out = zero;
    zero = NULL;
done:
    free(zero);
    discard(&s);
    return status;
}
