#include "linear/general.h"

#include "base/alloc.h"

#include <cblas.h>
#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Replace LU by its factors L and U; *rcond is the reciprocal condition number,
   0 if the matrix is singular. */
static ritz_status factor_in_place(ritz_dense *LU, int *pivot, double *rcond)
{
    int n = (int)LU->nrow, info = 0;
    double norm = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', n, n, LU->val, n);

    *rcond = 0.0;
    if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, n, n, LU->val, n, pivot) == 0)
        info =
            LAPACKE_dgecon(LAPACK_COL_MAJOR, '1', n, LU->val, n, norm, rcond);
    RITZ_REFUSE_IF(info == LAPACK_WORK_MEMORY_ERROR, RITZ_ERR_MEMORY,
                   "no memory for the condition of a matrix");
    return RITZ_OK;
}

ritz_status ritz_general_solve(const ritz_dense *A, bool transposed,
                               ritz_dense *X)
{
    int n = (int)A->nrow;
    RITZ_OWN(ritz_dense) LU = {0};
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    double rcond = 0.0;

    RITZ_REFUSE_IF(A->nrow != A->ncol || X->nrow != A->nrow, RITZ_ERR_ARGUMENT,
                   "a system of equations is not square");
    if (n == 0 || X->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(A, &LU));
    RITZ_CHECK_NEW(pivot, n);
    RITZ_CHECK(factor_in_place(&LU, pivot, &rcond));
    RITZ_REFUSE_IF(!(rcond > DBL_EPSILON), RITZ_ERR_SINGULAR,
                   "a matrix is singular to working accuracy");
    (void)LAPACKE_dgetrs(LAPACK_COL_MAJOR, transposed ? 'T' : 'N', n,
                         (int)X->ncol, LU.val, n, pivot, X->val, n);
    return RITZ_OK;
}

void ritz_general_factor_free(ritz_general_factor *F)
{
    ritz_dense_free(&F->LU);
    RITZ_FREE(F->pivot, F->row, F->col);
    *F = (ritz_general_factor){0};
}

/* Scale rows and columns to similar size, by powers of two; false if a row or a
   column is zero. */
static bool equilibrate(ritz_dense *A, double *row, double *col)
{
    int n = (int)A->nrow;
    double row_spread = 0.0, col_spread = 0.0, largest = 0.0;

    if (LAPACKE_dgeequb(LAPACK_COL_MAJOR, n, n, A->val, n, row, col,
                        &row_spread, &col_spread, &largest) != 0)
        return false;
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(A, j)[i] *= row[i] * col[j];
    return true;
}

ritz_status ritz_general_factor_new(const ritz_dense *A,
                                    ritz_general_factor *out)
{
    RITZ_OWN(ritz_general_factor) F = {0};
    double rcond = 0.0;

    RITZ_REFUSE_IF(A->nrow != A->ncol, RITZ_ERR_ARGUMENT,
                   "a system of equations is not square");
    RITZ_CHECK(ritz_dense_copy(A, &F.LU));
    RITZ_CHECK_NEW(F.pivot, A->nrow);
    if (A->nrow > 0)
        RITZ_CHECK(factor_in_place(&F.LU, F.pivot, &rcond));
    if (A->nrow > 0 && !(rcond > DBL_EPSILON)) {
        ritz_dense_free(&F.LU);
        RITZ_CHECK(ritz_dense_copy(A, &F.LU));
        RITZ_CHECK_NEW(F.row, A->nrow);
        RITZ_CHECK_NEW(F.col, A->nrow);
        if (equilibrate(&F.LU, F.row, F.col))
            RITZ_CHECK(factor_in_place(&F.LU, F.pivot, &rcond));
    }
    RITZ_REFUSE_IF(A->nrow > 0 && !(rcond > DBL_EPSILON), RITZ_ERR_SINGULAR,
                   "a matrix is singular to working accuracy");
    RITZ_MOVE(*out, F);
    return RITZ_OK;
}

static void scale_rows(const double *by, ritz_dense *X)
{
    for (int64_t j = 0; by && j < X->ncol; j++)
        for (int64_t i = 0; i < X->nrow; i++)
            ritz_dense_col(X, j)[i] *= by[i];
}

void ritz_general_factor_solve(const ritz_general_factor *F, bool transposed,
                               ritz_dense *X)
{
    int n = (int)X->nrow;

    if (n == 0 || X->ncol == 0)
        return;
    scale_rows(transposed ? F->col : F->row, X);
    (void)LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, transposed ? 'T' : 'N', n,
                              (int)X->ncol, F->LU.val, n, F->pivot, X->val, n);
    scale_rows(transposed ? F->row : F->col, X);
}

ritz_status ritz_general_solve_scaled(const ritz_dense *A, bool transposed,
                                      ritz_dense *X)
{
    RITZ_OWN(ritz_general_factor) F = {0};

    if (A->nrow == 0 || X->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_general_factor_new(A, &F));
    ritz_general_factor_solve(&F, transposed, X);
    return RITZ_OK;
}

/*
 * A lower bound of the reciprocal condition of A = L L', for 2 n^2 operations.
 * Entries of L^-1 are at most those of C^-1, where C has |l_jj| and -|l_ij|:
 *
 *     |A^-1| <= |L^-T| |L^-1| <= max z max y,   C y = C'z = (1 ... 1)'
 *
 * in the norm of sums of columns [Higham2002].
 */
static ritz_status bound_condition(const ritz_dense *L, double norm,
                                   double *out)
{
    const int64_t n = L->nrow;
    RITZ_OWN_ARRAY double *y = NULL;
    RITZ_OWN_ARRAY double *z = NULL;
    double forward = 0.0, back = 0.0;

    RITZ_CHECK_NEW(y, n);
    RITZ_CHECK_NEW(z, n);
    for (int64_t j = 0; j < n; j++) {
        const double *l = ritz_dense_col(L, j);

        y[j] = (1.0 + y[j]) / l[j];
        forward = fmax(forward, y[j]);
        for (int64_t i = j + 1; i < n; i++)
            y[i] += fabs(l[i]) * y[j];
    }
    for (int64_t j = n - 1; j >= 0; j--) {
        const double *l = ritz_dense_col(L, j);

        for (int64_t i = j + 1; i < n; i++)
            z[j] += fabs(l[i]) * z[i];
        z[j] = (1.0 + z[j]) / l[j];
        back = fmax(back, z[j]);
    }
    *out = n > 0 ? 1.0 / (norm * forward * back) : 0.0;
    return RITZ_OK;
}

ritz_status ritz_general_cholesky_above(ritz_dense *A, double enough,
                                        double *rcond)
{
    int n = (int)A->nrow;
    double norm = LAPACKE_dlansy(LAPACK_COL_MAJOR, '1', 'L', n, A->val, n);
    int info = 0;

    *rcond = 0.0;
    if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, A->val, n) != 0)
        return RITZ_OK;
    if (isfinite(enough))
        RITZ_CHECK(bound_condition(A, norm, rcond));
    if (!(*rcond > enough))
        info = LAPACKE_dpocon(LAPACK_COL_MAJOR, 'L', n, A->val, n, norm, rcond);
    RITZ_REFUSE_IF(info == LAPACK_WORK_MEMORY_ERROR, RITZ_ERR_MEMORY,
                   "no memory for the condition of a matrix");
    return RITZ_OK;
}

ritz_status ritz_general_cholesky(ritz_dense *A, double *rcond)
{
    return ritz_general_cholesky_above(A, HUGE_VAL, rcond);
}

double ritz_general_noise(uint64_t *state)
{
    *state = *state * 6364136223846793005U + 1442695040888963407U;
    return (double)(int64_t)*state / (double)INT64_MAX;
}

bool ritz_general_unit(int64_t n, double *x)
{
    double length = 0.0;

    for (int64_t i = 0; i < n; i++)
        length = hypot(length, x[i]);
    for (int64_t i = 0; i < n && length > 0.0; i++)
        x[i] /= length;
    return length > 0.0;
}

double ritz_general_size(const ritz_dense *A)
{
    return LAPACKE_dlange(LAPACK_COL_MAJOR, 'F', (int)A->nrow, (int)A->ncol,
                          A->val, (int)A->nrow);
}

void ritz_general_place(double sign, const ritz_dense *A, bool transposed,
                        int64_t row, int64_t col, ritz_dense *to)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            *(transposed ? &ritz_dense_col(to, col + i)[row + j]
                         : &ritz_dense_col(to, col + j)[row + i]) =
                sign * ritz_dense_col(A, j)[i];
}

ritz_status ritz_general_transpose(const ritz_dense *A, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(A->ncol, A->nrow, out));
    ritz_general_place(1.0, A, true, 0, 0, out);
    return RITZ_OK;
}

ritz_status ritz_general_svd(const ritz_dense *A, ritz_dense *U, double **s,
                             ritz_dense *V)
{
    int m = (int)A->nrow;
    int n = (int)A->ncol;
    int p = m < n ? m : n;
    RITZ_OWN(ritz_dense) copy = {0}, left = {0}, right = {0};
    RITZ_OWN_ARRAY double *values = NULL;

    RITZ_CHECK_NEW(values, p);
    RITZ_CHECK(ritz_dense_copy(A, &copy));
    RITZ_CHECK(ritz_dense_new(m, V ? m : p, &left));
    RITZ_CHECK(ritz_dense_new(V ? n : p, n, &right));
    RITZ_REFUSE_IF(p > 0 && LAPACKE_dgesdd(LAPACK_COL_MAJOR, V ? 'A' : 'S', m,
                                           n, copy.val, m, values, left.val, m,
                                           right.val, (int)right.nrow) != 0,
                   RITZ_ERR_CONVERGENCE, "singular values did not converge");
    if (V)
        RITZ_CHECK(ritz_general_transpose(&right, V));
    RITZ_MOVE(*U, left);
    RITZ_MOVE(*s, values);
    return RITZ_OK;
}

ritz_status ritz_general_singular(ritz_dense *A, double *sigma)
{

    RITZ_REFUSE_IF(A->nrow > 0 && A->ncol > 0 &&
                       LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'N', (int)A->nrow,
                                      (int)A->ncol, A->val, (int)A->nrow, sigma,
                                      NULL, 1, NULL, 1) != 0,
                   RITZ_ERR_CONVERGENCE, "singular values did not converge");
    return RITZ_OK;
}

ritz_status ritz_general_norm(ritz_dense *A, double *out)
{
    int64_t k = A->nrow < A->ncol ? A->nrow : A->ncol;
    RITZ_OWN_ARRAY double *sigma = NULL;

    RITZ_CHECK_NEW(sigma, k);
    RITZ_CHECK(ritz_general_singular(A, sigma));
    *out = k > 0 ? sigma[0] : 0.0;
    return RITZ_OK;
}

/*
 * Factors of Gramians. SLICOT leaves a triangle: U, W = U U', or of the
 * transposed equation U'U, for which the right hand side goes in as B'. Of a
 * pair in Schur form it takes the Schur vectors, here the identity.
 */

/* Fortran names; character arguments bring their lengths at the end. */
void sb03od_(/* NOLINT: its name */ const char *dico, const char *fact,
             const char *trans, const int *n, const int *m, double *A,
             const int *lda, double *Q, const int *ldq, double *B,
             const int *ldb, double *scale, double *wr, double *wi,
             double *work, const int *ldwork, int *info, size_t dico_length,
             size_t fact_length, size_t trans_length);
void sg03bd_(/* NOLINT: its name */ const char *dico, const char *fact,
             const char *trans, const int *n, const int *m, double *A,
             const int *lda, double *E, const int *lde, double *Q,
             const int *ldq, double *Z, const int *ldz, double *B,
             const int *ldb, double *scale, double *alphar, double *alphai,
             double *beta, double *work, const int *ldwork, int *info,
             size_t dico_length, size_t fact_length, size_t trans_length);

/* Arguments of SLICOT, which it may overwrite. */
typedef struct equation {
    int n, m, ldb, room;
    bool schur, transposed;
    ritz_dense S, P, Q, Z, B;
    double *re, *im, *beta, *work;
    double scale;
} equation;

static void equation_free(equation *e)
{
    ritz_dense_free(&e->S);
    ritz_dense_free(&e->P);
    ritz_dense_free(&e->Q);
    ritz_dense_free(&e->Z);
    ritz_dense_free(&e->B);
    RITZ_FREE(e->re, e->im, e->beta, e->work);
}

static ritz_status copy_right_side(const ritz_dense *B, equation *e)
{
    int64_t wide = e->m > e->n ? e->m : e->n;

    e->ldb = e->transposed ? (int)wide : e->n;
    RITZ_CHECK(ritz_dense_new(e->ldb, wide, &e->B));
    ritz_general_place(1.0, B, e->transposed, 0, 0, &e->B);
    return RITZ_OK;
}

static ritz_status prepare_equation(const ritz_dense *S, const ritz_dense *P,
                                    const ritz_dense *B, equation *e)
{
    e->n = (int)S->nrow;
    e->m = (int)B->ncol;
    e->room = e->schur ? 64 * (e->n + e->m) + 64 : 128 * e->n + e->m;
    RITZ_CHECK(ritz_dense_copy(S, &e->S));
    RITZ_CHECK(ritz_dense_identity(e->n, &e->Q));
    if (P->val) {
        RITZ_CHECK(ritz_dense_copy(P, &e->P));
        RITZ_CHECK(ritz_dense_identity(e->n, &e->Z));
    }
    RITZ_CHECK(copy_right_side(B, e));
    RITZ_CHECK_NEW(e->re, e->n);
    RITZ_CHECK_NEW(e->im, e->n);
    RITZ_CHECK_NEW(e->beta, e->n);
    RITZ_CHECK_NEW(e->work, e->room);
    return RITZ_OK;
}

static ritz_status solve_equation(equation *e)
{
    const char *trans = e->transposed ? "N" : "T";
    const char *fact = e->schur ? "F" : "N";
    int n = e->n;
    int unstable = e->P.val ? 5 : 3;
    int info = 0;

    if (e->P.val)
        sg03bd_("C", fact, trans, &n, &e->m, e->S.val, &n, e->P.val, &n,
                e->Q.val, &n, e->Z.val, &n, e->B.val, &e->ldb, &e->scale, e->re,
                e->im, e->beta, e->work, &e->room, &info, 1, 1, 1);
    else
        sb03od_("C", fact, trans, &n, &e->m, e->S.val, &n, e->Q.val, &n,
                e->B.val, &e->ldb, &e->scale, e->re, e->im, e->work, &e->room,
                &info, 1, 1, 1);
    RITZ_REFUSE_IF(info == unstable || (!e->P.val && info == 2),
                   RITZ_ERR_ARGUMENT,
                   "a Gramian is infinite: a pole is not stable");
    RITZ_REFUSE_IF(
        info < 0 || info > 1 || e->scale == 0.0, RITZ_ERR_CONVERGENCE,
        "the Lyapunov equation was not solved, SLICOT says %d", info);
    return RITZ_OK;
}

static ritz_status take_triangle(const equation *e, ritz_dense *F)
{
    RITZ_CHECK(ritz_dense_new(e->n, e->n, F));
    for (int64_t j = 0; j < e->n; j++)
        for (int64_t i = 0; i <= j; i++) {
            double u = ritz_dense_col(&e->B, j)[i] / e->scale;

            if (e->transposed)
                ritz_dense_col(F, i)[j] = u;
            else
                ritz_dense_col(F, j)[i] = u;
        }
    return RITZ_OK;
}

static ritz_status find_factor(const ritz_dense *S, const ritz_dense *P,
                               const ritz_dense *B, equation *e, ritz_dense *F)
{
    if (S->nrow == 0 || B->ncol == 0)
        return ritz_dense_new(S->nrow, S->nrow, F);
    RITZ_CHECK(prepare_equation(S, P, B, e));
    RITZ_CHECK(solve_equation(e));
    return take_triangle(e, F);
}

ritz_status ritz_general_hammarling(const ritz_dense *S, const ritz_dense *P,
                                    bool transposed, const ritz_dense *B,
                                    ritz_dense *F)
{
    RITZ_OWN(equation)
    e = {.schur = true, .transposed = transposed, .scale = 1.0};

    return find_factor(S, P, B, &e, F);
}

ritz_status ritz_general_gramian(const ritz_dense *A, const ritz_dense *B,
                                 ritz_dense *U)
{
    RITZ_OWN(equation) e = {.scale = 1.0};

    return find_factor(A, &(ritz_dense){0}, B, &e, U);
}

/*
 * An eigenvalue of a matrix that was rounded by eps |A| moves, to first order,
 * by at most eps |A| / s, s = |y'x| of its left and right eigenvectors of unit
 * length. LAPACK's dgeevx gives s and, after balancing, |A|.
 */

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

    RITZ_CHECK(ritz_dense_copy(A, &H));
    RITZ_CHECK(ritz_dense_new(n, n, &left));
    RITZ_CHECK(ritz_dense_new(n, n, &right));
    RITZ_CHECK_NEW(re, n);
    RITZ_CHECK_NEW(im, n);
    RITZ_CHECK_NEW(scale, n);
    RITZ_CHECK_NEW(cosine, n);
    RITZ_REFUSE_IF(LAPACKE_dgeevx(LAPACK_COL_MAJOR, 'B', 'V', 'V', 'E', n,
                                  H.val, n, re, im, left.val, n, right.val, n,
                                  &low, &high, scale, &norm, cosine, NULL) != 0,
                   RITZ_ERR_CONVERGENCE, "poles were not found");
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

/*
 * exp(A h) = exp(A t)^(2^j), t = h / 2^j with |A t| <= 1/2 in the 1-norm, where
 * 16 terms of its series are enough [MolerVanLoan1978]. The integral follows
 * along,
 *
 *     W(2 t) = W(t) + E(t)'W(t) E(t),
 *
 * and starts as a series too, as d/dt E'QE = E'L(Q)E, L(X) = A'X + X A:
 *
 *     W(t) = sum t^(k+1) / (k+1)! L^k(Q)
 *
 * Nothing in it grows if A is stable, unlike in exponentials of [-A' Q; 0 A].
 */
/* (1/2)^17 / 17! and 1 / 19! are below the rounding of 1. */
enum { TERMS = 17, INTEGRAL_TERMS = 20, MOST_DOUBLINGS = 60 };

static void scale_matrix(double factor, ritz_dense *A)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        A->val[k] *= factor;
}

/* A := D^-1 A D with D = diag(d) of powers of two. */
static ritz_status balance_matrix(ritz_dense *A, double *d)
{
    lapack_int low = 0, high = 0;
    int n = (int)A->nrow;

    RITZ_REFUSE_IF(LAPACKE_dgebal(LAPACK_COL_MAJOR, 'S', n, A->val, n, &low,
                                  &high, d) != 0,
                   RITZ_ERR_ARGUMENT, "a matrix of states is not finite");
    return RITZ_OK;
}

ritz_status ritz_general_balance(const ritz_dense *A, double *d, double *norm)
{
    int n = (int)A->nrow;
    RITZ_OWN(ritz_dense) balanced = {0};

    *norm = 0.0;
    if (n == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(A, &balanced));
    RITZ_CHECK(balance_matrix(&balanced, d));
    *norm = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', n, n, balanced.val, n);
    return RITZ_OK;
}

/* A(i,j) *= d(i)^row d(j)^col, powers being 1 or -1. */
static void turn_matrix(const double *d, int row, int col, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] *=
                (row > 0 ? d[i] : 1.0 / d[i]) * (col > 0 ? d[j] : 1.0 / d[j]);
}

/* E = I + A (I + A / 2 (I + A / 3 (...))) */
static ritz_status sum_series(const ritz_dense *A, ritz_dense *E)
{
    RITZ_OWN(ritz_dense) AE = {0};

    RITZ_CHECK(ritz_dense_identity(A->nrow, E));
    for (int k = TERMS; k > 0; k--) {
        RITZ_CHECK(ritz_dense_mul(A, E, &AE));
        scale_matrix(1.0 / k, &AE);
        for (int64_t j = 0; j < A->nrow; j++)
            ritz_dense_col(&AE, j)[j] += 1.0;
        ritz_dense_replace(E, &AE);
    }
    return RITZ_OK;
}

/* The integral over t of A t = `A`. */
static ritz_status sum_integral(const ritz_dense *A, double t,
                                const ritz_dense *Q, ritz_dense *W)
{
    RITZ_OWN(ritz_dense) X = {0}, XA = {0};

    RITZ_CHECK(ritz_dense_copy(Q, &X));
    scale_matrix(t, &X);
    RITZ_CHECK(ritz_dense_copy(&X, W));
    for (int k = 2; k <= INTEGRAL_TERMS; k++) {
        RITZ_CHECK(ritz_dense_mul(&X, A, &XA));
        ritz_dense_symmetrise(&XA); /* half of X A + A'X */
        scale_matrix(2.0 / k, &XA);
        ritz_dense_replace(&X, &XA);
        ritz_dense_add(1.0, &X, W);
    }
    return RITZ_OK;
}

/* W += E'W E */
static ritz_status double_integral(const ritz_dense *E, ritz_dense *W)
{
    RITZ_OWN(ritz_dense) more = {0};

    RITZ_CHECK(ritz_dense_congruence(W, E, &more));
    ritz_dense_add(1.0, &more, W);
    return RITZ_OK;
}

/* Over t first, then doubled; A is scaled to A t. */
static ritz_status propagate_doubling(ritz_dense *A, double h, int count,
                                      ritz_dense *Q, ritz_dense *E,
                                      ritz_dense *W)
{
    int n = (int)A->nrow;
    double size =
        n > 0 ? h * LAPACKE_dlange(LAPACK_COL_MAJOR, '1', n, n, A->val, n)
              : 0.0;
    int doublings = 0;

    (void)frexp(2.0 * size, &doublings);
    doublings = size > 0.5 ? doublings : 0;
    RITZ_REFUSE_IF(
        !isfinite(size) || doublings > MOST_DOUBLINGS, RITZ_ERR_ARGUMENT,
        "a step of %g s is too long for the fastest of its states", h);
    h = ldexp(h, -doublings);
    scale_matrix(h, A);
    RITZ_CHECK(sum_series(A, E));
    for (int k = 0; k < count; k++)
        RITZ_CHECK(sum_integral(A, h, &Q[k], &W[k]));
    for (int j = 0; j < doublings; j++) {
        for (int k = 0; k < count; k++)
            RITZ_CHECK(double_integral(E, &W[k]));
        RITZ_CHECK(ritz_dense_times(E, E));
    }
    return RITZ_OK;
}

RITZ_ARRAY_OF(ritz_dense);

ritz_status ritz_exponential(const ritz_dense *A, double h, int count,
                             const ritz_dense *Q, ritz_dense *E, ritz_dense *W)
{
    RITZ_OWN(ritz_dense_array) form = {.count = count};
    RITZ_OWN(ritz_dense_array) whole = {.count = count};
    RITZ_OWN(ritz_dense) scaled = {0};
    RITZ_OWN(ritz_dense) made = {0};
    RITZ_OWN_ARRAY double *d = NULL;

    RITZ_CHECK_NEW(form.at, count);
    RITZ_CHECK_NEW(whole.at, count);
    RITZ_CHECK_NEW(d, A->nrow);
    RITZ_CHECK(ritz_dense_copy(A, &scaled));
    if (A->nrow > 0)
        RITZ_CHECK(balance_matrix(&scaled, d));
    for (int k = 0; k < count; k++) {
        RITZ_CHECK(ritz_dense_copy(&Q[k], &form.at[k]));
        turn_matrix(d, 1, 1, &form.at[k]);
    }
    RITZ_CHECK(propagate_doubling(&scaled, h, count, form.at, &made, whole.at));
    turn_matrix(d, 1, -1, &made);
    for (int k = 0; k < count; k++) {
        turn_matrix(d, -1, -1, &whole.at[k]);
        RITZ_MOVE(W[k], whole.at[k]);
    }
    RITZ_MOVE(*E, made);
    return RITZ_OK;
}

ritz_status ritz_eigen_refuse(int64_t rows_K, int64_t cols_K, int64_t rows_M,
                              int64_t cols_M)
{
    RITZ_REFUSE_IF(rows_K != cols_K || rows_M != rows_K || cols_M != rows_K,
                   RITZ_ERR_ARGUMENT,
                   "stiffness is %" PRId64 " x %" PRId64 " but mass %" PRId64
                   " x %" PRId64,
                   rows_K, cols_K, rows_M, cols_M);
    return RITZ_OK;
}

ritz_status ritz_eigen_quotients(const ritz_dense *A, const ritz_dense *Q,
                                 double *theta)
{
    RITZ_OWN(ritz_dense) AQ = {0};

    RITZ_CHECK(ritz_dense_mul(A, Q, &AQ));
    for (int64_t j = 0; j < Q->ncol; j++)
        theta[j] = ritz_dense_dot(Q, j, &AQ, j);
    return RITZ_OK;
}
