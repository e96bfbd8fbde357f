/*
 * Constraints of bodies whose residual columns answer interface forces
 * [Rixen2004]. With multipliers lambda the forces of the joints are -C' lambda,
 * to which the columns p, of which K_pp is the flexibility F'Psi, answer
 *
 *     p = -K_pp^-1 C_p' lambda.
 *
 * Put into q'Kq/2 + p'K_pp p/2 + lambda'(C_q q + C_p p) this gives, with
 * H = C_p K_pp^-1,
 *
 *     K = [ Lambda   C_q'    ]    M = [ I   0         ]
 *         [ C_q     -H C_p'  ],       [ 0   H M_pp H' ]
 *
 * Here K_pp = L L' and C_p L'^-1 = U S V'. Of the rows of U'C those with a
 * singular value are taken as forces mu, lambda = U_1 S_1^-1 mu, so that their
 * block of K is -I; the others do not see p and hold q as joints hold any
 * coordinates, q = N y:
 *
 *     p = -L'^-1 V_1 mu,   X = [N, 0; 0, -L'^-1 V_1]
 *
 * X'KX has +I for mu; the constraints add -2I and C_1q N, C_1 = S_1^-1 U_1'C.
 */
#include "assembly/dual_forces.h"

#include "assembly/null_space.h"
#include "base/alloc.h"

#include <cblas.h>
#include <lapacke.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Relative, below which a constraint does not see p; and of C, is rounding. */
static const double unseen = 1e-9;

/* Columns of A whose flag is as wanted. */
static ritz_status pick(const ritz_dense *A, const bool *flag, bool wanted,
                        ritz_dense *out)
{
    int64_t count = 0;

    for (int64_t j = 0; j < A->ncol; j++)
        count += flag[j] == wanted;
    RITZ_CHECK(ritz_dense_new(A->nrow, count, out));
    count = 0;
    for (int64_t j = 0; j < A->ncol; j++)
        if (flag[j] == wanted && A->nrow > 0)
            memcpy(ritz_dense_col(out, count++), ritz_dense_col(A, j),
                   (size_t)A->nrow * sizeof *A->val);
    return RITZ_OK;
}

/* L of K_pp. */
static ritz_status factor(const ritz_dense *K, const bool *is_force,
                          ritz_dense *L)
{
    ritz_status status = RITZ_OK;
    ritz_dense columns = {0};
    int64_t p = 0;

    RITZ_TRY(pick(K, is_force, true, &columns));
    RITZ_TRY(ritz_dense_new(columns.ncol, columns.ncol, L));
    for (int64_t j = 0; j < L->ncol; j++) {
        p = 0;
        for (int64_t i = 0; i < K->nrow; i++)
            if (is_force[i])
                ritz_dense_col(L, j)[p++] = ritz_dense_col(&columns, j)[i];
    }
    p = L->ncol;
    RITZ_FAIL_IF(
        LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (int)p, L->val, (int)p) != 0,
        RITZ_ERR_SINGULAR,
        "the residual flexibility of force columns is not positive "
        "definite");
done:
    ritz_dense_free(&columns);
    return status;
}

/* What the constraints make of p: W = C_p L'^-1 = U S V'. */
typedef struct split {
    int64_t rank;     /* singular values that count */
    ritz_dense L;     /* p x p, lower */
    ritz_dense U, Vt; /* c x c, p x p */
    double *sigma;    /* the lesser of c and p */
} split;

static ritz_status decompose(const ritz_dense *C, const bool *is_force,
                             split *s)
{
    ritz_status status = RITZ_OK;
    ritz_dense W = {0};
    int c = (int)C->nrow;
    int p = (int)s->L.ncol;
    int least = c < p ? c : p;

    RITZ_TRY(pick(C, is_force, true, &W));
    RITZ_TRY(ritz_dense_new(c, c, &s->U));
    RITZ_TRY(ritz_dense_new(p, p, &s->Vt));
    RITZ_NEW(s->sigma, least);
    if (least == 0)
        goto done;
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                c, p, 1.0, s->L.val, p, W.val, c);
    RITZ_FAIL_IF(LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'A', c, p, W.val, c, s->sigma,
                                s->U.val, c, s->Vt.val, p) != 0,
                 RITZ_ERR_CONVERGENCE,
                 "singular values of the interface do not converge");
    while (s->rank < least && s->sigma[s->rank] > unseen * s->sigma[0])
        s->rank++;
done:
    ritz_dense_free(&W);
    return status;
}

/* N: what the constraints that do not see p leave to q. */
static ritz_status hold(const split *s, const ritz_dense *C_q, int64_t *rank,
                        ritz_dense *N)
{
    ritz_status status = RITZ_OK;
    double most = ritz_dense_max(C_q);
    ritz_dense U_0 = {0}, C_0 = {0};

    if (s->sigma && s->L.ncol > 0)
        RITZ_TRY(ritz_dense_columns(&s->U, s->rank, s->U.ncol - s->rank, &U_0));
    if (s->L.ncol > 0)
        RITZ_TRY(ritz_dense_mul_tn(&U_0, C_q, &C_0));
    else
        RITZ_TRY(ritz_dense_copy(C_q, &C_0));
    for (int64_t k = 0; k < C_0.nrow * C_0.ncol; k++)
        if (fabs(C_0.val[k]) <= unseen * most)
            C_0.val[k] = 0.0;
    RITZ_TRY(ritz_null_space(&C_0, rank, N));
done:
    ritz_dense_free(&U_0);
    ritz_dense_free(&C_0);
    return status;
}

/* X = [N, 0; 0, -L'^-1 V_1], its rows where they belong. */
static ritz_status build(split *s, const bool *is_force, const ritz_dense *N,
                         ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    int p = (int)s->L.ncol;
    int64_t rows[2] = {0, 0};
    ritz_dense Y = {0};

    RITZ_TRY(ritz_dense_new(p, s->rank, &Y));
    for (int64_t j = 0; j < s->rank; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&Y, j)[i] = -ritz_dense_col(&s->Vt, i)[j];
    if (s->rank > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, p, (int)s->rank, 1.0, s->L.val, p, Y.val, p);
    RITZ_TRY(ritz_dense_new(N->nrow + p, N->ncol + s->rank, X));
    for (int64_t i = 0; i < X->nrow; i++) {
        const ritz_dense *from = is_force[i] ? &Y : N;
        int64_t first = is_force[i] ? N->ncol : 0;
        int64_t row = rows[is_force[i]]++;

        for (int64_t j = 0; j < from->ncol; j++)
            ritz_dense_col(X, first + j)[i] = ritz_dense_col(from, j)[row];
    }
done:
    ritz_dense_free(&Y);
    return status;
}

/* joint = [0, (C_1q N)'; C_1q N, -2 I]. */
static ritz_status add_joint(const split *s, const ritz_dense *C_q,
                             const ritz_dense *N, ritz_dense *joint)
{
    ritz_status status = RITZ_OK;
    int64_t y = N->ncol;
    ritz_dense U_1 = {0}, C_1 = {0}, G = {0};

    RITZ_TRY(ritz_dense_new(y + s->rank, y + s->rank, joint));
    RITZ_TRY(ritz_dense_columns(&s->U, 0, s->rank, &U_1));
    RITZ_TRY(ritz_dense_mul_tn(&U_1, C_q, &C_1));
    RITZ_TRY(ritz_dense_mul(&C_1, N, &G));
    for (int64_t i = 0; i < s->rank; i++) {
        ritz_dense_col(joint, y + i)[y + i] = -2.0;
        for (int64_t j = 0; j < y; j++)
            ritz_dense_col(joint, y + i)[j] = ritz_dense_col(joint, j)[y + i] =
                ritz_dense_col(&G, j)[i] / s->sigma[i];
    }
done:
    ritz_dense_free(&U_1);
    ritz_dense_free(&C_1);
    ritz_dense_free(&G);
    return status;
}

static void split_free(split *s)
{
    ritz_dense_free(&s->L);
    ritz_dense_free(&s->U);
    ritz_dense_free(&s->Vt);
    free(s->sigma);
}

ritz_status ritz_dual_new(const ritz_dense *K, const ritz_dense *C,
                          const bool *is_force, ritz_dual *out)
{
    ritz_status status = RITZ_OK;
    ritz_dual dual = {0};
    split s = {0};
    ritz_dense C_q = {0}, N = {0};

    RITZ_TRY(factor(K, is_force, &s.L));
    RITZ_TRY(decompose(C, is_force, &s));
    RITZ_TRY(pick(C, is_force, false, &C_q));
    RITZ_TRY(hold(&s, &C_q, &dual.rank, &N));
    RITZ_TRY(build(&s, is_force, &N, &dual.X));
    RITZ_TRY(add_joint(&s, &C_q, &N, &dual.joint));
    dual.rank += s.rank;
    dual.num_forces = s.rank;
    *out = dual;
    dual = (ritz_dual){0};
done:
    split_free(&s);
    ritz_dual_free(&dual);
    ritz_dense_free(&C_q);
    ritz_dense_free(&N);
    return status;
}

void ritz_dual_free(ritz_dual *dual)
{
    ritz_dense_free(&dual->X);
    ritz_dense_free(&dual->joint);
    *dual = (ritz_dual){0};
}
