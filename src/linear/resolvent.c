/*
 * The transfer function of a linear system at many points, from complex
 * triangular matrices that are computed once.
 */
#include "linear/resolvent.h"

#include "base/alloc.h"

#include <cblas.h>
#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Complex copy of a real matrix. */
static ritz_status widen_matrix(const ritz_dense *A, double _Complex **out)
{
    RITZ_CHECK_NEW(*out, A->nrow * A->ncol);
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        (*out)[k] = A->val[k];
    return RITZ_OK;
}

/* B := Q^H B, C := C Z; T and X are used as work space. */
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
    for (int i = 0; i < p; i++) { /* row by row, because T has room for one
                                     row */
        cblas_zcopy(n, r->C + i, p, r->T, 1);
        cblas_zgemv(CblasColMajor, CblasTrans, n, n, &one, Z, n, r->T, 1, &zero,
                    r->C + i, p);
    }
}

/* Whether A is in real Schur form and P is upper triangular. */
static bool is_schur(const ritz_dense *A, const ritz_dense *P)
{
    bool pair = false; /* the previous column has an entry below the diagonal */

    for (int64_t j = 0; j < A->ncol; j++) {
        const double *a = ritz_dense_col(A, j);
        bool below = j + 1 < A->nrow && a[j + 1] != 0.0;

        if (below && pair)
            return false;
        pair = below;
        for (int64_t i = j + 1; i < A->nrow; i++)
            if ((i > j + 1 && a[i] != 0.0) ||
                (P->val && ritz_dense_col(P, j)[i] != 0.0))
                return false;
    }
    return true;
}

/* Multiply rows k and k + 1 of A, in columns first .. last - 1, by Q^H from the
   left. */
static void turn_rows(const double _Complex Q[4], int64_t k, int64_t rows,
                      int64_t first, int64_t last, double _Complex *A)
{
    for (int64_t j = first; j < last; j++) {
        double _Complex *a = A + k + j * rows;
        double _Complex top = a[0];

        a[0] = conj(Q[0]) * top + conj(Q[1]) * a[1];
        a[1] = conj(Q[2]) * top + conj(Q[3]) * a[1];
    }
}

/* Multiply columns k and k + 1 of A, in rows 0 .. last - 1, by Z from the
   right. */
static void turn_columns(const double _Complex Z[4], int64_t k, int64_t rows,
                         int64_t last, double _Complex *A)
{
    for (int64_t i = 0; i < last; i++) {
        double _Complex *a = A + i + k * rows;
        double _Complex left = a[0];

        a[0] = left * Z[0] + a[rows] * Z[1];
        a[rows] = left * Z[2] + a[rows] * Z[3];
    }
}

/* Make the 2 x 2 diagonal block of a pair of complex poles, at row k, upper
   triangular. */
static ritz_status turn_block(int64_t k, ritz_resolvent *r)
{
    int64_t n = r->n;
    double _Complex S[4], P[4], Q[4], Z[4], alpha[2], beta[2];
    lapack_int none = 0;
    int info = 0;

    for (int64_t e = 0; e < 4; e++) {
        S[e] = r->S[k + e % 2 + (k + e / 2) * n];
        P[e] = r->P ? r->P[k + e % 2 + (k + e / 2) * n] : 0.0;
    }
    if (r->P)
        info = LAPACKE_zgges(LAPACK_COL_MAJOR, 'V', 'V', 'N', NULL, 2, S, 2, P,
                             2, &none, alpha, beta, Q, 2, Z, 2);
    else
        info = LAPACKE_zgees(LAPACK_COL_MAJOR, 'V', 'N', NULL, 2, S, 2, &none,
                             alpha, Q, 2);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE, "poles were not found");
    if (!r->P)
        memcpy(Z, Q, sizeof Z);
    turn_rows(Q, k, n, k, n, r->S);
    turn_columns(Z, k, n, k + 2, r->S);
    r->S[k + 1 + k * n] = 0.0;
    if (r->P) {
        turn_rows(Q, k, n, k, n, r->P);
        turn_columns(Z, k, n, k + 2, r->P);
        r->P[k + 1 + k * n] = 0.0;
    }
    turn_rows(Q, k, n, 0, r->m, r->B);
    turn_columns(Z, k, r->p, r->p, r->C);
    return RITZ_OK;
}

static ritz_status turn_blocks(ritz_resolvent *r)
{
    for (int64_t k = 0; k + 1 < r->n; k++)
        if (r->S[k + 1 + k * r->n] != 0.0)
            RITZ_CHECK(turn_block(k, r));
    return RITZ_OK;
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

/* Find the first row of each column of the triangles that is not zero. */
static ritz_status find_tops(ritz_resolvent *r)
{
    RITZ_CHECK_NEW(r->top, r->n);
    for (int j = 0; j < r->n; j++) {
        const double _Complex *S = r->S + (int64_t)j * r->n;
        const double _Complex *P = r->P ? r->P + (int64_t)j * r->n : S;
        int i = 0;

        while (i < j && S[i] == 0.0 && P[i] == 0.0)
            i++;
        r->top[j] = i;
    }
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
    if (is_schur(A, P))
        RITZ_CHECK(turn_blocks(&r));
    else
        RITZ_CHECK(triangularise_pencil(&r));
    RITZ_CHECK(find_tops(&r));
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}

double _Complex ritz_resolvent_pole(const ritz_resolvent *resolvent, int64_t k)
{
    int64_t at = k + k * resolvent->n;

    return resolvent->P ? resolvent->S[at] / resolvent->P[at]
                        : resolvent->S[at];
}

/* Diagonal entry j of z P - S. */
static double _Complex shifted_pivot(const ritz_resolvent *r, double _Complex z,
                                     int64_t j)
{
    int64_t at = j + j * r->n;

    return z * (r->P ? r->P[at] : 1.0) - r->S[at];
}

static bool is_near_pole(const ritz_resolvent *r, double _Complex z,
                         double near)
{
    double least = near * cabs(z);

    for (int64_t j = 0; j < r->n; j++)
        if (cabs(shifted_pivot(r, z, j)) <= least)
            return true;
    return false;
}

/*
 * X = (z P - S)^-1 B by back substitution, column by column. Each column of the
 * triangles is read once and none is copied, since memory traffic dominates the
 * cost.
 */
static void solve_shifted(ritz_resolvent *r, double _Complex z)
{
    int n = r->n, m = r->m;

    memcpy(r->X, r->B, (size_t)n * (size_t)m * sizeof *r->X);
    for (int j = n - 1; j >= 0; j--) {
        const int64_t at = r->top[j] + (int64_t)j * n;
        const int rows = j - r->top[j];
        double _Complex pivot = shifted_pivot(r, z, j);

        for (int k = 0; k < m; k++) {
            double _Complex *x = r->X + (int64_t)k * n;
            double _Complex shifted = 0.0;

            x[j] /= pivot;
            cblas_zaxpy(rows, &x[j], r->S + at, 1, x + r->top[j], 1);
            shifted = -z * x[j];
            if (r->P)
                cblas_zaxpy(rows, &shifted, r->P + at, 1, x + r->top[j], 1);
        }
    }
}

bool ritz_resolvent_add(ritz_resolvent *resolvent, double _Complex z,
                        double near, double _Complex *H)
{
    const double _Complex one = 1.0;
    ritz_resolvent *r = resolvent;
    int n = r->n, m = r->m, p = r->p;

    if (n == 0 || m == 0 || p == 0)
        return true;
    if (is_near_pole(r, z, near))
        return false;
    solve_shifted(r, z);
    cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, p, m, n, &one, r->C,
                p, r->X, n, &one, H, p);
    return true;
}

/*
 * Many points at once: X' holds (z P - S)^-1 B of all points, a row for each
 * point and input. The effect of a block of rows of X on the rows above,
 *
 *     X_above += S_above X_block - P_above (X_block z)
 *
 * is then a product of matrices that are the same for all points, except for
 * the factors z.
 */

/* Columns of X' in a block; rows of X', that is points times inputs, in a
   panel. */
enum { BLOCK = 48, PANEL = 240 };

typedef struct point_rows {
    const ritz_resolvent *r;
    const double _Complex *z; /* value at each point */
    int rows;                 /* points times inputs */
    double _Complex *X, *Z;   /* X', rows x n; Z = -z X', rows x BLOCK */
    double _Complex *H;       /* C X of each row, rows x p */
} point_rows;

static void point_rows_free(point_rows *s)
{
    RITZ_FREE(s->X, s->Z, s->H);
}

/* Column `at` of Z := -z times column j of X'. */
static void shift_column(const point_rows *s, int at, int j)
{
    for (int k = 0; k < s->rows; k++)
        s->Z[k + (int64_t)at * s->rows] =
            -s->z[k / s->r->m] * s->X[k + (int64_t)j * s->rows];
}

/* Back substitution within columns first .. last - 1 of X'; sets these columns
   of Z. */
static void solve_block(const point_rows *s, int first, int last)
{
    const ritz_resolvent *r = s->r;
    const int64_t rows = s->rows;

    for (int j = last - 1; j >= first; j--) {
        double _Complex *x = s->X + j * rows;

        for (int k = 0; k < s->rows; k++)
            x[k] /= shifted_pivot(r, s->z[k / r->m], j);
        if (r->P)
            shift_column(s, j - first, j);
        for (int i = first > r->top[j] ? first : r->top[j]; i < j; i++) {
            int64_t at = i + (int64_t)j * r->n;

            cblas_zaxpy(s->rows, &r->S[at], x, 1, s->X + i * rows, 1);
            if (r->P)
                cblas_zaxpy(s->rows, &r->P[at], s->Z + (j - first) * rows, 1,
                            s->X + i * rows, 1);
        }
    }
}

/* Add the contribution of a block to the columns of X' before it. */
static void take_block(const point_rows *s, int first, int last)
{
    const double _Complex one = 1.0;
    const ritz_resolvent *r = s->r;
    const int64_t rows = s->rows;
    int top = first;

    for (int j = first; j < last; j++)
        top = r->top[j] < top ? r->top[j] : top;
    if (top == first)
        return;
    cblas_zgemm(CblasColMajor, CblasNoTrans, CblasTrans, s->rows, first - top,
                last - first, &one, s->X + first * rows, s->rows,
                r->S + top + (int64_t)first * r->n, r->n, &one,
                s->X + top * rows, s->rows);
    if (r->P)
        cblas_zgemm(CblasColMajor, CblasNoTrans, CblasTrans, s->rows,
                    first - top, last - first, &one, s->Z, s->rows,
                    r->P + top + (int64_t)first * r->n, r->n, &one,
                    s->X + top * rows, s->rows);
}

/* Add C X of a panel's points to H. */
static void add_panel(const point_rows *s, double _Complex *H)
{
    const double _Complex one = 1.0, zero = 0.0;
    const ritz_resolvent *r = s->r;

    for (int j = 0; j < r->n; j++)
        for (int k = 0; k < s->rows; k++)
            s->X[k + (int64_t)j * s->rows] =
                r->B[j + (int64_t)(k % r->m) * r->n];
    for (int last = r->n; last > 0; last -= BLOCK) {
        int first = last > BLOCK ? last - BLOCK : 0;

        solve_block(s, first, last);
        take_block(s, first, last);
    }
    cblas_zgemm(CblasColMajor, CblasNoTrans, CblasTrans, s->rows, r->p, r->n,
                &one, s->X, s->rows, r->C, r->p, &zero, s->H, s->rows);
    for (int k = 0; k < s->rows; k++)
        for (int i = 0; i < r->p; i++)
            H[i + (int64_t)k * r->p] += s->H[k + (int64_t)i * s->rows];
}

ritz_status ritz_resolvent_many(const ritz_resolvent *resolvent, int64_t count,
                                const double _Complex *z, double _Complex *H)
{
    const ritz_resolvent *r = resolvent;
    const int64_t points = r->m > 0 && r->m < PANEL ? PANEL / r->m : 1;
    RITZ_OWN(point_rows) s = {.r = r};

    if (r->n == 0 || r->m == 0 || r->p == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(s.X, points * r->m * r->n);
    RITZ_CHECK_NEW(s.Z, points * r->m * BLOCK);
    RITZ_CHECK_NEW(s.H, points * r->m * r->p);
    for (int64_t k = 0; k < count; k += points) {
        int64_t some = count - k < points ? count - k : points;

        s.z = z + k;
        s.rows = (int)some * r->m;
        add_panel(&s, H + k * r->p * r->m);
    }
    return RITZ_OK;
}

/* T = upper triangle of z P - S. */
static void shift_triangle(ritz_resolvent *r, double _Complex z)
{
    for (int64_t j = 0; j < r->n; j++)
        for (int64_t i = 0; i <= j; i++) {
            int64_t at = i + j * r->n;
            double _Complex p = i == j ? 1.0 : 0.0;

            r->T[at] = z * (r->P ? r->P[at] : p) - r->S[at];
        }
}

/* Euclidean norm of a complex vector. */
static double complex_size(int64_t count, const double _Complex *x)
{
    double sum = 0.0;

    for (int64_t k = 0; k < count; k++)
        sum = hypot(sum, cabs(x[k]));
    return sum;
}

ritz_status ritz_resolvent_sides(ritz_resolvent *resolvent, double _Complex z,
                                 double *right, double *left)
{
    const double _Complex one = 1.0;
    ritz_resolvent *r = resolvent;
    int n = r->n, m = r->m, p = r->p;
    RITZ_OWN_ARRAY double _Complex *C = NULL;

    *right = *left = 0.0;
    if (n == 0 || m == 0 || p == 0)
        return RITZ_OK;
    RITZ_CHECK_COPY(C, r->C, (int64_t)p * n);
    shift_triangle(r, z);
    solve_shifted(r, z);
    cblas_ztrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans,
                CblasNonUnit, p, n, &one, r->T, n, C, p);
    *right = complex_size((int64_t)n * m, r->X);
    *left = complex_size((int64_t)p * n, C);
    return RITZ_OK;
}

void ritz_resolvent_free(ritz_resolvent *resolvent)
{
    RITZ_FREE(resolvent->S, resolvent->P, resolvent->B, resolvent->C,
              resolvent->T, resolvent->X, resolvent->top);
    *resolvent = (ritz_resolvent){0};
}
