/*
 * In Schur form, stable poles first, the rest is taken off by a Sylvester
 * equation,
 *
 *     [I -G; 0 I] [S11 S12; 0 S22] [I R; 0 I] = [S11 0; 0 S22],
 *     S11 R - G S22 = -S12,   P11 R - G P22 = -P12    (G = R without E)
 *
 * so that X = Z_1, T = Z_1 R + Z_2, Y = Q_1 - Q_2 G', W = Q_2 P22^-T.
 *
 * Poles whose bound reaches the axis may yet be stable: those of a cascade of
 * equal stages are as defective as can be. With A X E' + E X A' = -I, A and E
 * remain stable under any change for which
 *
 *     2 |dA X E' + A X dE'| < 1
 */
#include "linear/split.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/frame.h"
#include "linear/general.h"
#include "linear/schur.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>

/* Whether no rounding of the matrices makes a pole unstable. All poles are left
   of the axis. */
static ritz_status prove_stable(const ritz_schur *schur, bool *proven)
{
    RITZ_OWN(ritz_dense) one = {0}, F = {0};
    double change = RITZ_POLE_BOUND_FACTOR * DBL_EPSILON * 2.0;

    RITZ_CHECK(ritz_dense_identity(schur->count, &one));
    RITZ_CHECK(ritz_general_hammarling(&schur->S, &schur->T, false, &one, &F));
    change *= ritz_general_size(&schur->S);
    change *= pow(ritz_general_size(&F), 2.0);
    if (schur->T.val)
        change *= 2.0 * ritz_general_size(&schur->T);
    *proven = change < 1.0;
    return RITZ_OK;
}

static ritz_status choose_stable(const ritz_schur *schur, bool *stable)
{
    bool all_left = true, doubt = false, proven = false;

    for (int64_t k = 0; k < schur->count; k++) {
        stable[k] = schur->re[k] < -RITZ_POLE_BOUND_FACTOR * schur->error[k];
        all_left = all_left && schur->re[k] < 0.0;
        doubt = doubt || !stable[k];
    }
    if (doubt && all_left)
        RITZ_CHECK(prove_stable(schur, &proven));
    for (int64_t k = 0; k < schur->count && proven; k++)
        stable[k] = true;
    return RITZ_OK;
}

/* R and G of m stable poles and the others. */
static ritz_status decouple_blocks(const ritz_schur *schur, int64_t m,
                                   ritz_dense *R, ritz_dense *G)
{
    int n = (int)schur->count;
    int a = n - (int)m;
    int info = 0;
    double scale = 1.0, unused = 0.0;
    const double *S = schur->S.val, *P = schur->T.val;
    int64_t at = m * n; /* of the blocks 12, and m further down 22 */

    RITZ_CHECK(ritz_dense_new(m, a, R));
    RITZ_CHECK(ritz_dense_new(m, a, G));
    for (int64_t j = 0; j < a; j++)
        for (int64_t i = 0; i < m; i++) {
            ritz_dense_col(R, j)[i] = -S[at + i + j * n];
            ritz_dense_col(G, j)[i] = P ? -P[at + i + j * n] : 0.0;
        }
    if (m == 0 || a == 0)
        return RITZ_OK;
    info = P ? LAPACKE_dtgsyl(LAPACK_COL_MAJOR, 'N', 0, (int)m, a, S, n,
                              S + at + m, n, R->val, (int)m, P, n, P + at + m,
                              n, G->val, (int)m, &scale, &unused)
             : LAPACKE_dtrsyl(LAPACK_COL_MAJOR, 'N', 'N', -1, (int)m, a, S, n,
                              S + at + m, n, R->val, (int)m, &scale);
    RITZ_REFUSE_IF(info != 0 || scale == 0.0, RITZ_ERR_CONVERGENCE,
                   "stable poles and others are too close to be separated");
    for (int64_t k = 0; k < m * a; k++) {
        R->val[k] /= scale;
        G->val[k] = P ? G->val[k] / scale : R->val[k];
    }
    return RITZ_OK;
}

/* X, T, Y, W in the coordinates of the form's own matrices. */
static ritz_status assemble_split(const ritz_schur *schur, int64_t m,
                                  ritz_split *out)
{
    int64_t n = schur->count, a = n - m;
    const ritz_dense *Z = schur->Z.val ? &schur->Z : &schur->Q;
    ritz_dense Z1 = ritz_dense_part(Z, 0, m);
    ritz_dense Q2 = ritz_dense_part(&schur->Q, m, a);
    RITZ_OWN(ritz_dense) R = {0}, G = {0}, Z1R = {0}, Q2G = {0};

    RITZ_CHECK(decouple_blocks(schur, m, &R, &G));
    RITZ_CHECK(ritz_dense_mul(&Z1, &R, &Z1R));
    RITZ_CHECK(ritz_dense_mul_nt(&Q2, &G, &Q2G));
    RITZ_CHECK(ritz_dense_columns(Z, 0, m, &out->X));
    RITZ_CHECK(ritz_dense_columns(&schur->Q, 0, m, &out->Y));
    RITZ_CHECK(ritz_dense_columns(Z, m, a, &out->T));
    RITZ_CHECK(ritz_dense_columns(&schur->Q, m, a, &out->W));
    ritz_dense_add(1.0, &Z1R, &out->T);
    ritz_dense_add(-1.0, &Q2G, &out->Y);
    if (schur->T.val && a > 0)
        cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasTrans,
                    CblasNonUnit, (int)n, (int)a, 1.0, schur->T.val + m * n + m,
                    (int)n, out->W.val, (int)n);
    return RITZ_OK;
}

ritz_status ritz_split_new(const ritz_dense *A, const ritz_dense *E,
                           ritz_split *out)
{
    RITZ_OWN(ritz_frame) f = {0};
    RITZ_OWN(ritz_schur) schur = {0};
    RITZ_OWN(ritz_split) split = {0};
    RITZ_OWN_ARRAY bool *stable = NULL;
    int64_t m = 0;

    RITZ_CHECK(ritz_frame_new(A, E, &f));
    RITZ_CHECK(ritz_schur_new(&f.A, &f.E, &schur));
    RITZ_CHECK_NEW(stable, A->nrow);
    RITZ_CHECK(choose_stable(&schur, stable));
    RITZ_CHECK(ritz_schur_order(&schur, stable, &m));
    RITZ_CHECK(ritz_dense_new(m, m, &split.S));
    ritz_dense_cut(&schur.S, 0, 0, &split.S);
    if (schur.T.val) {
        RITZ_CHECK(ritz_dense_new(m, m, &split.P));
        ritz_dense_cut(&schur.T, 0, 0, &split.P);
    }
    RITZ_CHECK(assemble_split(&schur, m, &split));
    ritz_frame_turn_back(&f, f.right, &split.X);
    ritz_frame_turn_back(&f, f.right, &split.T);
    ritz_frame_turn_back(&f, f.left, &split.Y);
    ritz_frame_turn_back(&f, f.left, &split.W);
    RITZ_MOVE(*out, split);
    return RITZ_OK;
}

void ritz_split_free(ritz_split *split)
{
    ritz_dense_free(&split->S);
    ritz_dense_free(&split->P);
    ritz_dense_free(&split->X);
    ritz_dense_free(&split->Y);
    ritz_dense_free(&split->T);
    ritz_dense_free(&split->W);
    *split = (ritz_split){0};
}
