/*
 * Shifts from the space that the iteration spans itself: M, K and D projected
 * on the latest displacements keep their signs, so that every projected pole
 * is stable. In modes of that small model, states (w q, q'), it is
 *
 *     A = [0 w; -w -Delta],   A x_i = lambda_i x_i,   y_i'A = lambda_i y_i'
 *
 * and in what is left of W a pole participates by |y_i'w| / |y_i'x_i| and
 * |w'x_i|, |x_i| being one. Poles of the largest participation are the next
 * shifts: each removes its own.
 *
 * Projection on the latest block is [BennerKuerschnerSaak2014]; second order,
 * more blocks and the choice by participation are our own.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/low_rank_parts.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/*
 * The latest displacements X that the iteration found, a ring of columns, and
 * M, K and D between them: a small model of second order, for shifts.
 */

/* Twice the columns of a step at least, or this many. */
enum { COLUMNS = 96 };

ritz_status ritz_low_rank_window_new(const ritz_low_rank_model *model,
                                     ritz_low_rank_window *out)
{
    RITZ_OWN(ritz_low_rank_window) window = {0};
    int64_t step = 2 * (model->W[RITZ_CONTROLLABLE][RITZ_BELOW].ncol +
                        model->W[RITZ_OBSERVABLE][RITZ_BELOW].ncol);

    window.room = 2 * step > COLUMNS ? 2 * step : COLUMNS;
    RITZ_CHECK(ritz_dense_new(model->n, window.room, &window.X));
    for (int k = 0; k < 3; k++)
        RITZ_CHECK(ritz_dense_new(window.room, window.room, &window.G[k]));
    RITZ_MOVE(*out, window);
    return RITZ_OK;
}

/* M X, K X and D X of new columns. */
typedef ritz_dense products[3];

static void products_free(products *AX)
{
    for (int k = 0; k < 3; k++)
        ritz_dense_free(&(*AX)[k]);
}

/* g := X'y, count entries. */
static void project_window(const ritz_low_rank_window *window, const double *y,
                           double *g)
{
    int n = (int)window->X.nrow;

    if (n > 0 && window->count > 0)
        cblas_dgemv(CblasColMajor, CblasTrans, n, (int)window->count, 1.0,
                    window->X.val, n, y, 1, 0.0, g, 1);
}

/* Column @p at of G = X'AX, and its row by A'; both are A x for symmetric A. */
static void put_products(int64_t at, const double *Ax, const double *Atx,
                         ritz_low_rank_window *window, ritz_dense *G)
{
    double *column = ritz_dense_col(G, at);

    project_window(window, Atx, column);
    for (int64_t j = 0; j < window->count; j++)
        ritz_dense_col(G, j)[at] = column[j];
    project_window(window, Ax, column);
}

ritz_status ritz_low_rank_window_add(const ritz_low_rank_model *model,
                                     const ritz_dense *X,
                                     ritz_low_rank_window *window)
{
    bool turned = model->Dt.colptr;
    const ritz_sparse *const A[] = {&model->M, &model->K, &model->D};
    RITZ_OWN(ritz_dense) DtX = {0};
    RITZ_OWN(products) AX = {0};

    for (int k = 0; k < 3; k++)
        RITZ_CHECK(ritz_sparse_mul(A[k], X, &AX[k]));
    if (turned)
        RITZ_CHECK(ritz_sparse_mul(&model->Dt, X, &DtX));
    for (int64_t j = 0; j < X->ncol; j++) {
        int64_t at = window->next;
        const ritz_dense x = ritz_dense_part(X, j, 1);

        ritz_dense_put(&x, 0, at, &window->X);
        window->next = (at + 1) % window->room;
        if (window->count < window->room)
            window->count++;
        for (int k = 0; k < 3; k++)
            put_products(at, ritz_dense_col(&AX[k], j),
                         ritz_dense_col(turned && k == 2 ? &DtX : &AX[k], j),
                         window, &window->G[k]);
    }
    return RITZ_OK;
}

/* A = V diag(e) V', V over A. */
static ritz_status diagonalise_symmetric(ritz_dense *A, double *e)
{
    int n = (int)A->nrow;

    RITZ_REFUSE_IF(n > 0 && LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', n, A->val,
                                          n, e) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "the latest displacements have no modes");
    return RITZ_OK;
}

/* F with F'GF = I, G = X'MX, of what is independent in X. */
static ritz_status orthonormalise_window(const ritz_low_rank_window *window,
                                         ritz_dense *out)
{
    int64_t c = window->count;
    int64_t first = 0;
    RITZ_OWN(ritz_dense) G = {0};
    RITZ_OWN_ARRAY double *size = NULL, *e = NULL;

    RITZ_CHECK_NEW(size, c);
    RITZ_CHECK_NEW(e, c);
    RITZ_CHECK(ritz_dense_block(&window->G[0], 0, c, 0, c, &G));
    for (int64_t j = 0; j < c; j++) {
        double g = ritz_dense_col(&G, j)[j];

        size[j] = g > 0.0 ? 1.0 / sqrt(g) : 0.0;
    }
    for (int64_t k = 0; k < c * c; k++)
        G.val[k] = size[k % c] * G.val[k] * size[k / c];
    RITZ_CHECK(diagonalise_symmetric(&G, e));
    while (first < c && !(e[first] > RITZ_SQUARED_DEPENDENT * e[c - 1]))
        first++;
    RITZ_CHECK(ritz_dense_columns(&G, first, c - first, out));
    for (int64_t j = 0; j < out->ncol; j++)
        for (int64_t i = 0; i < c; i++)
            ritz_dense_col(out, j)[i] *= size[i] / sqrt(e[first + j]);
    return RITZ_OK;
}

/* F'GF of the columns that are there. */
static ritz_status project_products(const ritz_low_rank_window *window,
                                    int which, const ritz_dense *F,
                                    ritz_dense *out)
{
    int64_t c = window->count;
    RITZ_OWN(ritz_dense) G = {0};

    RITZ_CHECK(ritz_dense_block(&window->G[which], 0, c, 0, c, &G));
    return ritz_dense_project(&G, F, out);
}

/*
 * Modes X F of the small model, M-orthonormal: F, frequencies and F'X'DX F.
 *
 * @param[out] F      count x r
 * @param[out] omega  r, positive, to be freed
 */
static ritz_status find_window_modes(const ritz_low_rank_window *window,
                                     ritz_dense *F, double **omega,
                                     ritz_dense *Delta)
{
    RITZ_OWN(ritz_dense) V = {0}, K = {0}, modes = {0};
    RITZ_OWN_ARRAY double *w = NULL;

    RITZ_CHECK(orthonormalise_window(window, &V));
    RITZ_CHECK(project_products(window, 1, &V, &K));
    RITZ_CHECK_NEW(w, K.nrow);
    ritz_dense_symmetrise(&K);
    RITZ_CHECK(diagonalise_symmetric(&K, w));
    RITZ_CHECK(ritz_dense_mul(&V, &K, &modes));
    RITZ_CHECK(project_products(window, 2, &modes, Delta));
    for (int64_t k = 0; k < K.nrow; k++) /* the last one is exact enough */
        w[k] = sqrt(fmax(w[k], DBL_EPSILON * w[K.nrow - 1]));
    RITZ_MOVE(*F, modes);
    RITZ_MOVE(*omega, w);
    return RITZ_OK;
}

void ritz_low_rank_window_free(ritz_low_rank_window *window)
{
    ritz_dense_free(&window->X);
    for (int k = 0; k < 3; k++)
        ritz_dense_free(&window->G[k]);
    *window = (ritz_low_rank_window){0};
}

/* Modes of the window and poles of its states. */
typedef struct small {
    ritz_dense F;             /* window x r: modes are X F */
    ritz_dense A;             /* 2r x 2r */
    double *omega;            /* r */
    double *re, *im;          /* 2r */
    ritz_dense left, right;   /* 2r x 2r, as LAPACK packs pairs */
    ritz_dense w[RITZ_SIDES]; /* 2r x inputs, outputs */
    double *part;             /* 2r, participation */
} small;

static void small_free(small *s)
{
    ritz_dense_free(&s->F);
    ritz_dense_free(&s->A);
    RITZ_FREE(s->omega, s->re, s->im);
    ritz_dense_free(&s->left);
    ritz_dense_free(&s->right);
    ritz_dense_free(&s->w[RITZ_CONTROLLABLE]);
    ritz_dense_free(&s->w[RITZ_OBSERVABLE]);
    free(s->part);
}

/* A, its poles and both kinds of vectors. */
static ritz_status find_poles(const ritz_low_rank_window *window, small *s)
{
    RITZ_OWN(ritz_dense) Delta = {0};
    int64_t r = 0;
    int n = 0;

    RITZ_CHECK(find_window_modes(window, &s->F, &s->omega, &Delta));
    r = s->F.ncol;
    n = (int)(2 * r);
    RITZ_CHECK(ritz_dense_new(n, n, &s->A));
    RITZ_CHECK(ritz_dense_new(n, n, &s->left));
    RITZ_CHECK(ritz_dense_new(n, n, &s->right));
    RITZ_CHECK_NEW(s->re, n);
    RITZ_CHECK_NEW(s->im, n);
    for (int64_t j = 0; j < r; j++) {
        ritz_dense_col(&s->A, r + j)[j] = s->omega[j];
        ritz_dense_col(&s->A, j)[r + j] = -s->omega[j];
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&s->A, r + j)[r + i] = -ritz_dense_col(&Delta, j)[i];
    }
    RITZ_REFUSE_IF(n > 0 && LAPACKE_dgeev(LAPACK_COL_MAJOR, 'V', 'V', n,
                                          s->A.val, n, s->re, s->im,
                                          s->left.val, n, s->right.val, n) != 0,
                   RITZ_ERR_CONVERGENCE, "no poles were found for shifts");
    return RITZ_OK;
}

/* rows first.. of w := diag(omega^power) F'X'A */
static ritz_status put_half(const ritz_low_rank_window *window,
                            const ritz_dense *A, double power, int64_t first,
                            small *s, ritz_dense *w)
{
    ritz_dense X = ritz_dense_part(&window->X, 0, window->count);
    RITZ_OWN(ritz_dense) XA = {0}, q = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&X, A, &XA));
    RITZ_CHECK(ritz_dense_mul_tn(&s->F, &XA, &q));
    for (int64_t j = 0; j < q.ncol; j++)
        for (int64_t i = 0; i < q.nrow; i++)
            ritz_dense_col(w, j)[first + i] =
                pow(s->omega[i], power) * ritz_dense_col(&q, j)[i];
    return RITZ_OK;
}

/* What is left of W: velocities w Phi'M W_1 and forces; outputs w^-1, 1. */
static ritz_status project_loads(const ritz_low_rank_model *model,
                                 const ritz_low_rank_window *window, small *s)
{
    int64_t r = s->F.ncol;
    const ritz_dense *U = model->W[RITZ_CONTROLLABLE];
    const ritz_dense *Y = model->W[RITZ_OBSERVABLE];
    RITZ_OWN(ritz_dense) MU = {0};

    RITZ_CHECK(ritz_sparse_mul(&model->M, &U[RITZ_ABOVE], &MU));
    RITZ_CHECK(ritz_dense_new(2 * r, MU.ncol, &s->w[RITZ_CONTROLLABLE]));
    RITZ_CHECK(ritz_dense_new(2 * r, Y[0].ncol, &s->w[RITZ_OBSERVABLE]));
    RITZ_CHECK(put_half(window, &MU, 1.0, 0, s, &s->w[RITZ_CONTROLLABLE]));
    RITZ_CHECK(
        put_half(window, &U[RITZ_BELOW], 0.0, r, s, &s->w[RITZ_CONTROLLABLE]));
    RITZ_CHECK(
        put_half(window, &Y[RITZ_ABOVE], -1.0, 0, s, &s->w[RITZ_OBSERVABLE]));
    return put_half(window, &Y[RITZ_BELOW], 0.0, r, s, &s->w[RITZ_OBSERVABLE]);
}

/* |x'w|^2 of a vector whose imaginary part is y, NULL if real. */
static double sum_squares(int64_t n, const double *x, const double *y,
                          const ritz_dense *w)
{
    double sum = 0.0;

    for (int64_t j = 0; j < w->ncol; j++) {
        const double *column = ritz_dense_col(w, j);
        double re = 0.0;
        double im = 0.0;

        for (int64_t i = 0; i < n; i++) {
            re += x[i] * column[i];
            im += y ? y[i] * column[i] : 0.0;
        }
        sum += re * re + im * im;
    }
    return sum;
}

/* |y'x|^2 of a left and a right vector. */
static double square_product(int64_t n, const double *y, const double *y_im,
                             const double *x, const double *x_im)
{
    double re = 0.0;
    double im = 0.0;

    for (int64_t i = 0; i < n; i++) {
        re += y[i] * x[i] + (x_im ? y_im[i] * x_im[i] : 0.0);
        im += x_im ? y[i] * x_im[i] - y_im[i] * x[i] : 0.0;
    }
    return re * re + im * im;
}

/* Squares of both participations, each over the largest, added. */
static ritz_status weigh_poles(const bool open[static RITZ_SIDES], small *s)
{
    int64_t n = s->A.nrow;
    double most[RITZ_SIDES] = {0.0, 0.0};
    RITZ_OWN(ritz_dense) part = {0};

    RITZ_CHECK_NEW(s->part, n);
    RITZ_CHECK(ritz_dense_new(n, RITZ_SIDES, &part));
    for (int64_t k = 0; k < n; k += s->im[k] != 0.0 ? 2 : 1) {
        bool pair = s->im[k] != 0.0;
        const double *x = ritz_dense_col(&s->right, k);
        const double *y = ritz_dense_col(&s->left, k);
        const double angle =
            square_product(n, y, pair ? y + n : NULL, x, pair ? x + n : NULL);
        double *in = ritz_dense_col(&part, RITZ_CONTROLLABLE) + k;
        double *seen = ritz_dense_col(&part, RITZ_OBSERVABLE) + k;

        *in = sum_squares(n, y, pair ? y + n : NULL, &s->w[RITZ_CONTROLLABLE]);
        *in /= fmax(angle, DBL_EPSILON);
        *seen = sum_squares(n, x, pair ? x + n : NULL, &s->w[RITZ_OBSERVABLE]);
        most[RITZ_CONTROLLABLE] = fmax(most[RITZ_CONTROLLABLE], *in);
        most[RITZ_OBSERVABLE] = fmax(most[RITZ_OBSERVABLE], *seen);
    }
    for (int side = 0; side < RITZ_SIDES; side++)
        for (int64_t k = 0; k < n && open[side] && most[side] > 0.0; k++)
            s->part[k] += ritz_dense_col(&part, side)[k] / most[side];
    return RITZ_OK;
}

/* The poles of largest participation, of a pair the first. */
static ritz_status choose_shifts(small *s, int64_t most, int64_t *count,
                                 double _Complex *out)
{
    for (*count = 0; *count < most; (*count)++) {
        int64_t best = -1;
        double size = 0.0;

        for (int64_t k = 0; k < s->A.nrow; k++)
            if (s->part[k] > 0.0 && (best < 0 || s->part[k] > s->part[best]))
                best = k;
        if (best < 0)
            break;
        size = hypot(s->re[best], s->im[best]);
        RITZ_REFUSE_IF(
            !(s->re[best] < -RITZ_SHIFT_DAMPED * size), RITZ_ERR_ARGUMENT,
            "a motion near %.4g Hz is not damped, or even fed, by D: "
            "it has no Gramian",
            size / (2.0 * acos(-1.0)));
        out[*count] = s->re[best];
        if (fabs(s->im[best]) > RITZ_SHIFT_REAL * fabs(s->re[best]))
            out[*count] += fabs(s->im[best]) * (double _Complex)_Complex_I;
        s->part[best] = 0.0;
    }
    RITZ_REFUSE_IF(*count == 0, RITZ_ERR_CONVERGENCE,
                   "there is no shift for what the Gramians still miss");
    return RITZ_OK;
}

ritz_status ritz_low_rank_shifts(const ritz_low_rank_model *model,
                                 const ritz_low_rank_window *window,
                                 const bool open[static RITZ_SIDES],
                                 int64_t most, int64_t *count,
                                 double _Complex *out)
{
    RITZ_OWN(small) s = {0};

    RITZ_CHECK(find_poles(window, &s));
    RITZ_CHECK(project_loads(model, window, &s));
    RITZ_CHECK(weigh_poles(open, &s));
    return choose_shifts(&s, most, count, out);
}
