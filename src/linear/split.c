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
#include "linear/general.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/*
 * E = L L' where it is definite, L^-1 A L^-T in the place of A, and the scaling
 * of LAPACK's balancing: powers of a base, rows and columns of equal size.
 */

/*
 * Coordinates in which a linear system E x' = A x is well scaled:
 * x = L^-T diag(right) z; left vectors are L^-T diag(left) times theirs.
 */
typedef struct scaled_pencil {
    ritz_dense A, E; /* in these coordinates; E {0}: the identity */
    ritz_dense L;    /* lower triangle; {0}: the identity */
    double *right, *left;
} scaled_pencil;

static void scaled_pencil_free(scaled_pencil *f)
{
    ritz_dense_free(&f->A);
    ritz_dense_free(&f->E);
    ritz_dense_free(&f->L);
    RITZ_FREE(f->right, f->left);
}

/* E = L L' in place, its lower triangle; false if it cannot be trusted. */
static ritz_status factor_cholesky(ritz_dense *E, bool *good)
{
    int n = (int)E->nrow;
    RITZ_OWN_ARRAY double *root = NULL;
    double rcond = 0.0;

    *good = false;
    RITZ_CHECK_NEW(root, n);
    for (int64_t i = 0; i < n; i++) {
        root[i] = sqrt(ritz_dense_col(E, i)[i]);
        if (!(root[i] > 0.0))
            return RITZ_OK;
    }
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(E, j)[i] /= root[i] * root[j];
    RITZ_CHECK(ritz_general_cholesky(E, &rcond));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = j; i < n; i++)
            ritz_dense_col(E, j)[i] *= root[i];
    *good = rcond > RITZ_WELL_CONDITIONED;
    return RITZ_OK;
}

/* A := L^-1 A L^-T, symmetric if A is, if E is symmetric and definite. */
static ritz_status reduce_pencil(const ritz_dense *A, const ritz_dense *E,
                                 scaled_pencil *f, bool *reduced)
{
    RITZ_OWN(ritz_dense) L = {0};
    int n = (int)E->nrow;

    *reduced = false;
    if (ritz_dense_asymmetry(E) > RITZ_SYMMETRIC_SUMS)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(E, &L));
    RITZ_CHECK(factor_cholesky(&L, reduced));
    if (!*reduced)
        return RITZ_OK;
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans,
                CblasNonUnit, n, n, 1.0, L.val, n, f->A.val, n);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                n, n, 1.0, L.val, n, f->A.val, n);
    if (ritz_dense_asymmetry(A) == 0.0)
        ritz_dense_symmetrise(&f->A);
    RITZ_MOVE(f->L, L);
    return RITZ_OK;
}

static double least_of(int64_t count, const double *value)
{
    double least = HUGE_VAL;

    for (int64_t i = 0; i < count; i++)
        least = fmin(least, value[i]);
    return least;
}

static ritz_status scale_frame(scaled_pencil *f)
{
    int n = (int)f->A.nrow;
    lapack_int low = 0, high = 0;
    int info = 0;

    if (f->E.val)
        info = LAPACKE_dggbal(LAPACK_COL_MAJOR, 'S', n, f->A.val, n, f->E.val,
                              n, &low, &high, f->left, f->right);
    else
        info = LAPACKE_dgebal(LAPACK_COL_MAJOR, 'S', n, f->A.val, n, &low,
                              &high, f->right);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_ARGUMENT,
                   "a matrix whose poles are wanted is not finite");
    for (int64_t i = 0; i < n && !f->E.val; i++)
        f->left[i] = 1.0 / f->right[i];
    return RITZ_OK;
}

/*
 * Rounding of the scaled matrix, eps |A|, is eps |A| / (left_i right_j) of the
 * given one. Where entries are themselves rounding, scaling magnifies them
 * without bound: then the matrices are left unscaled.
 */
static ritz_status balance_frame(scaled_pencil *f)
{
    int64_t n = f->A.nrow;
    RITZ_OWN(ritz_dense) A = {0}, E = {0};
    double most = 0.0;

    RITZ_CHECK_NEW(f->right, n);
    RITZ_CHECK_NEW(f->left, n);
    RITZ_CHECK(ritz_dense_copy(&f->A, &A));
    if (f->E.val)
        RITZ_CHECK(ritz_dense_copy(&f->E, &E));
    if (n > 0)
        RITZ_CHECK(scale_frame(f));
    most = RITZ_FRAME_GROWTH * least_of(n, f->left) * least_of(n, f->right);
    if (n > 0 &&
        (ritz_general_size(&f->A) > most * ritz_general_size(&A) ||
         (E.val && ritz_general_size(&f->E) > most * ritz_general_size(&E)))) {
        memcpy(f->A.val, A.val, (size_t)(n * n) * sizeof *A.val);
        if (E.val)
            memcpy(f->E.val, E.val, (size_t)(n * n) * sizeof *E.val);
        for (int64_t i = 0; i < n; i++)
            f->left[i] = f->right[i] = 1.0;
    }
    return RITZ_OK;
}

static ritz_status scale_pencil(const ritz_dense *A, const ritz_dense *E,
                                scaled_pencil *out)
{
    RITZ_OWN(scaled_pencil) f = {0};
    bool reduced = true;

    RITZ_CHECK(ritz_dense_copy(A, &f.A));
    if (E->val)
        RITZ_CHECK(reduce_pencil(A, E, &f, &reduced));
    if (!reduced)
        RITZ_CHECK(ritz_dense_copy(E, &f.E));
    RITZ_CHECK(balance_frame(&f));
    RITZ_MOVE(*out, f);
    return RITZ_OK;
}

/* V := L^-1 V, or L^-T V */
static void divide_factor(const scaled_pencil *f, CBLAS_TRANSPOSE trans,
                          ritz_dense *V)
{
    if (f->L.val && V->ncol > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, trans, CblasNonUnit,
                    (int)V->nrow, (int)V->ncol, 1.0, f->L.val, (int)V->nrow,
                    V->val, (int)V->nrow);
}

/* V := L^-T diag(scale) V, scale either of right and left. */
static void turn_back(const scaled_pencil *f, const double *scale,
                      ritz_dense *V)
{
    ritz_dense_scale_rows(scale, V);
    divide_factor(f, CblasTrans, V);
}

/* (L^-T diag(scale))' V: B by `left`, C' by `right`, in these coordinates. */
static ritz_status turn_forward(const scaled_pencil *f, const double *scale,
                                const ritz_dense *V, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_copy(V, out));
    divide_factor(f, CblasNoTrans, out);
    ritz_dense_scale_rows(scale, out);
    return RITZ_OK;
}

ritz_status ritz_split_scaled(const ritz_dense *A, const ritz_dense *E,
                              const ritz_dense *B, const ritz_dense *C,
                              ritz_dense *out_A, ritz_dense *out_B,
                              ritz_dense *out_C)
{
    RITZ_OWN(scaled_pencil) f = {0};
    RITZ_OWN(ritz_dense) one = {0}, back = {0};

    RITZ_CHECK(scale_pencil(A, E, &f));
    RITZ_CHECK(ritz_dense_copy(&f.A, out_A));
    RITZ_CHECK(turn_forward(&f, f.left, B, out_B));
    RITZ_CHECK(ritz_general_transpose(C, &one));
    RITZ_CHECK(turn_forward(&f, f.right, &one, &back));
    RITZ_CHECK(ritz_general_transpose(&back, out_C));
    if (f.E.val && A->nrow > 0) {
        RITZ_CHECK_IN("E", ritz_general_solve(&f.E, false, out_A));
        RITZ_CHECK_IN("E", ritz_general_solve(&f.E, false, out_B));
    }
    return RITZ_OK;
}

/*
 * With right and left eigenvectors x, y of a pair, A x = lambda E x, an
 * eigenvalue of matrices rounded by eps |A| and eps |E| moves to first order by
 *
 *     eps (|A| + |lambda| |E|) |x| |y| / |y'E x|
 *
 * and without E by eps |A| |x| |y| / |y'x|.
 */

/*
 * Schur form of a matrix, or of a pair, and how far rounding may move each
 * eigenvalue where it stands on the diagonal: Q'A Z = S quasi-triangular, Q'E Z
 * = T triangular. Without E: T is the identity and Z is Q, both {0}.
 */
typedef struct schur_form {
    int64_t count;
    ritz_dense S, T, Q, Z;
    double *re, *im; /* eigenvalues, as on the diagonal */
    double *error;   /* first-order bound, as of ritz_eigenvalues */
} schur_form;

static void schur_form_free(schur_form *schur)
{
    ritz_dense_free(&schur->S);
    ritz_dense_free(&schur->T);
    ritz_dense_free(&schur->Q);
    ritz_dense_free(&schur->Z);
    RITZ_FREE(schur->re, schur->im, schur->error);
}

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

static ritz_status find_vectors(schur_form *schur, vectors *out)
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

static ritz_status find_errors(schur_form *schur)
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
static ritz_status diagonalise_blocks(schur_form *schur)
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

static ritz_status factor_schur(schur_form *schur)
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
static ritz_status divide_eigenvalues(schur_form *schur, const double *beta)
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

static ritz_status factor_pair(const ritz_dense *E, schur_form *schur)
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

/* @return RITZ_ERR_SINGULAR if E is, to rounding; RITZ_ERR_CONVERGENCE */
static ritz_status factor_form(const ritz_dense *A, const ritz_dense *E,
                               schur_form *out)
{
    RITZ_OWN(schur_form) schur = {.count = A->nrow};

    RITZ_CHECK(ritz_dense_copy(A, &schur.S));
    RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &schur.Q));
    RITZ_CHECK_NEW(schur.re, A->nrow);
    RITZ_CHECK_NEW(schur.im, A->nrow);
    RITZ_CHECK_NEW(schur.error, A->nrow);
    if (A->nrow > 0 && E->val)
        RITZ_CHECK(factor_pair(E, &schur));
    else if (A->nrow > 0)
        RITZ_CHECK(factor_schur(&schur));
    RITZ_MOVE(*out, schur);
    return RITZ_OK;
}

/* Work space is ours: LAPACKE gives none where LAPACK reports its size. */
static int reorder_schur(schur_form *schur, const lapack_logical *select,
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

/*
 * Reorder so that the chosen eigenvalues, of either of a pair, come first;
 * pairs stay together.
 */
static ritz_status order_form(schur_form *schur, const bool *first,
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

/* Whether no rounding of the matrices makes a pole unstable. All poles are left
   of the axis. */
static ritz_status prove_stable(const schur_form *schur, bool *proven)
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

static ritz_status choose_stable(const schur_form *schur, bool *stable)
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
static ritz_status decouple_blocks(const schur_form *schur, int64_t m,
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
static ritz_status assemble_split(const schur_form *schur, int64_t m,
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
    RITZ_OWN(scaled_pencil) f = {0};
    RITZ_OWN(schur_form) schur = {0};
    RITZ_OWN(ritz_split) split = {0};
    RITZ_OWN_ARRAY bool *stable = NULL;
    int64_t m = 0;

    RITZ_CHECK(scale_pencil(A, E, &f));
    RITZ_CHECK(factor_form(&f.A, &f.E, &schur));
    RITZ_CHECK_NEW(stable, A->nrow);
    RITZ_CHECK(choose_stable(&schur, stable));
    RITZ_CHECK(order_form(&schur, stable, &m));
    RITZ_CHECK(ritz_dense_block(&schur.S, 0, m, 0, m, &split.S));
    if (schur.T.val)
        RITZ_CHECK(ritz_dense_block(&schur.T, 0, m, 0, m, &split.P));
    RITZ_CHECK(assemble_split(&schur, m, &split));
    turn_back(&f, f.right, &split.X);
    turn_back(&f, f.right, &split.T);
    turn_back(&f, f.left, &split.Y);
    turn_back(&f, f.left, &split.W);
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
