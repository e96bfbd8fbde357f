/*
 * Factors of both Gramians of a modal model, and neither is formed. Eliminating
 * mode k from
 *
 *     A X + X A' + B B' = 0,    X := X - X_:k X_kk^-1 X_k:
 *
 * leaves the solution of the same equation with
 *
 *     B := B - X_:k X_kk^-1 B_k
 *
 * so a few columns B are all there is to update, and a column of blocks X_:k is
 * a closed form (modal_block.c). Columns X_:k X_kk^-1/2 are the factor. It is
 * ADI with the poles themselves for shifts, which ends exactly; what rounding
 * does to B it does to the factor, not to its square, so Hankel values are good
 * to rounding of the largest, as with [Hammarling1982].
 *
 * A mode that is overdamped is eliminated one real pole at a time, by left
 * eigenvectors v of A_k: (A + lambda) x + B B_k'v = 0, v'X_kk v =
 * |B_k'v|^2 / (2 |lambda|). Next is the one of which most is left, relative to
 * what there was; the rest is dropped when it is rounding.
 *
 * [LiWhite2002], [Moore1981]
 */
#include "base/alloc.h"
#include "gramians/modal_block.h"

#include <cblas.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Ratios up to here: eigenvectors of a mode are no better than its block. */
static const double nearly_critical = 1.001;

/* One mode, or one real pole of it: v' of its rows of B is what is left. */
typedef struct unit {
    int64_t mode;
    double pole;    /* 0: both of the mode */
    double v[2][2]; /* two vectors of both, one of a real pole */
    double first;   /* |v'B_k|^2 at the beginning; 0: done, or not reached */
    double left;
} unit;

typedef struct elimination {
    const ritz_energy *model;
    int64_t num_units;
    unit *units;
    ritz_dense B;    /* 2m x p, what is left */
    ritz_dense row;  /* 2 x p, v'B_k */
    ritz_dense G, X; /* 2m x 2 */
    ritz_dense Z;    /* 2m x 2m, of which rank columns are there */
    int64_t rank;
} elimination;

static void release(elimination *e)
{
    free(e->units);
    ritz_dense_free(&e->B);
    ritz_dense_free(&e->row);
    ritz_dense_free(&e->G);
    ritz_dense_free(&e->X);
    ritz_dense_free(&e->Z);
}

/* lambda = -a - c and -w^2 / (a + c), a = d / 2, c^2 = a^2 - w^2 */
static void add_units(elimination *e, int64_t k)
{
    double w = e->model->w[k];
    double a = e->model->d[k] / 2.0;
    double pole[2];

    if (a <= nearly_critical * w) {
        e->units[e->num_units++] =
            (unit){.mode = k, .v = {{1.0, 0.0}, {0.0, 1.0}}};
        return;
    }
    pole[0] = -a - sqrt((a - w) * (a + w));
    pole[1] = w * (w / pole[0]);
    for (int p = 0; p < 2; p++) {
        double length = hypot(w, pole[p]);

        e->units[e->num_units++] =
            (unit){.mode = k,
                   .pole = pole[p],
                   .v = {{w / length, -pole[p] / length}, {0.0, 0.0}}};
    }
}

/* |v'B_k|^2 of each unit. */
static void measure(elimination *e)
{
    int64_t m = e->model->count;

    for (int64_t u = 0; u < e->num_units; u++)
        e->units[u].left = 0.0;
    for (int64_t j = 0; j < e->B.ncol; j++) {
        const double *b = ritz_dense_col(&e->B, j);

        for (int64_t u = 0; u < e->num_units; u++) {
            unit *at = &e->units[u];
            double q = b[at->mode];
            double v = b[m + at->mode];
            double x = at->v[0][0] * q + at->v[0][1] * v;
            double y = at->v[1][0] * q + at->v[1][1] * v;

            at->left += x * x + y * y;
        }
    }
}

static ritz_status start(const ritz_energy *model, const ritz_dense *F,
                         elimination *e)
{
    int64_t m = model->count;

    e->model = model;
    RITZ_CHECK_NEW(e->units, 2 * m);
    for (int64_t k = 0; k < m; k++)
        add_units(e, k);
    RITZ_CHECK(ritz_dense_copy(F, &e->B));
    RITZ_CHECK(ritz_dense_new(2, F->ncol, &e->row));
    RITZ_CHECK(ritz_dense_new(2 * m, 2, &e->G));
    RITZ_CHECK(ritz_dense_new(2 * m, 2, &e->X));
    RITZ_CHECK(ritz_dense_new(2 * m, 2 * m, &e->Z));
    measure(e);
    for (int64_t u = 0; u < e->num_units; u++)
        e->units[u].first = e->units[u].left;
    return RITZ_OK;
}

/* The unit of which most is left; NULL where that is rounding. */
static unit *choose(elimination *e)
{
    double rounding = 2.0 * (double)e->model->count * DBL_EPSILON;
    double most = rounding * rounding;
    unit *best = NULL;

    measure(e);
    for (int64_t u = 0; u < e->num_units; u++) {
        unit *at = &e->units[u];

        if (at->first > 0.0 && at->left > most * at->first) {
            most = at->left / at->first;
            best = at;
        }
    }
    return best;
}

/* row = v'B_k, G = B row' */
static void read(const unit *at, int columns, elimination *e)
{
    int n = (int)e->B.nrow;
    int p = (int)e->B.ncol;
    int64_t m = e->model->count;

    for (int64_t j = 0; j < p; j++) {
        const double *b = ritz_dense_col(&e->B, j);

        for (int i = 0; i < 2; i++)
            ritz_dense_col(&e->row, j)[i] =
                at->v[i][0] * b[at->mode] + at->v[i][1] * b[m + at->mode];
    }
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, n, columns, p, 1.0,
                e->B.val, n, e->row.val, 2, 0.0, e->G.val, n);
}

/*
 * Columns t'[x y], scaled to be of the factor: x'X_kk x = size. The same of
 * the row, for B := B - Z row.
 */
static void add_column(elimination *e, const double t[2], double size,
                       double *row)
{
    double scale = 1.0 / sqrt(size);
    const double *x = e->X.val;
    const double *y = e->X.val + e->X.nrow;
    double *z = ritz_dense_col(&e->Z, e->rank++);

    for (int64_t i = 0; i < e->Z.nrow; i++)
        z[i] = scale * (t[0] * x[i] + t[1] * y[i]);
    for (int64_t j = 0; j < e->B.ncol; j++)
        row[j] = scale * (t[0] * ritz_dense_col(&e->row, j)[0] +
                          t[1] * ritz_dense_col(&e->row, j)[1]);
    for (int64_t j = 0; j < e->B.ncol; j++)
        cblas_daxpy((int)e->B.nrow, -row[j], z, 1, ritz_dense_col(&e->B, j), 1);
}

/* Both poles: principal axes of X_kk, so that one of them may be empty. */
static void eliminate_mode(unit *at, elimination *e, double *row)
{
    int64_t m = e->model->count;
    int64_t k = at->mode;
    const double *const G[2] = {e->G.val, e->G.val + 2 * m};
    double *const X[2] = {e->X.val, e->X.val + 2 * m};
    double a, b, c, size, less, angle;

    read(at, 2, e);
    ritz_energy_blocks(e->model, k, m, G, X);
    a = X[0][k];
    b = (X[0][m + k] + X[1][k]) / 2.0;
    c = X[1][m + k];
    angle = 0.5 * atan2(2.0 * b, a - c);
    size = (a + c) / 2.0 + hypot((a - c) / 2.0, b);
    less = (a * c - b * b) / size;
    add_column(e, (double[]){cos(angle), sin(angle)}, size, row);
    if (less > 4.0 * DBL_EPSILON * size)
        add_column(e, (double[]){-sin(angle), cos(angle)}, less, row);
    for (int64_t j = 0; j < e->B.ncol; j++)
        ritz_dense_col(&e->B, j)[k] = ritz_dense_col(&e->B, j)[m + k] = 0.0;
    at->first = 0.0;
}

/* x = -(A + lambda)^-1 G */
static void eliminate_pole(unit *at, elimination *e, double *row)
{
    int64_t m = e->model->count;
    double pole = at->pole;
    const double *g = e->G.val;
    double *x = e->X.val;
    double size = at->left / (-2.0 * pole);

    read(at, 1, e);
    for (int64_t i = 0; i < m; i++) {
        double w = e->model->w[i];
        double d = e->model->d[i];
        double by = 1.0 / (pole * (pole - d) + w * w);

        x[i] = by * ((d - pole) * g[i] + w * g[m + i]);
        x[m + i] = -by * (w * g[i] + pole * g[m + i]);
    }
    add_column(e, (double[]){1.0, 0.0}, size, row);
    at->first = 0.0;
}

ritz_status ritz_energy_factor(const ritz_energy *model, const ritz_dense *F,
                               ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    elimination e = {0};
    double *row = NULL;
    unit *next = NULL;

    RITZ_NEW(row, F->ncol);
    RITZ_TRY(start(model, F, &e));
    for (next = choose(&e); next; next = choose(&e)) {
        if (next->pole < 0.0)
            eliminate_pole(next, &e, row);
        else
            eliminate_mode(next, &e, row);
    }
    *out = e.Z;
    out->ncol = e.rank;
    e.Z = (ritz_dense){0};
done:
    free(row);
    release(&e);
    return status;
}

/* Rows (q_1, q_1', ...) of t Z and of sign Z. */
static ritz_status spread(const ritz_dense *Z, const double *t, double sign,
                          ritz_dense *out)
{
    int64_t m = Z->nrow / 2;

    RITZ_CHECK(ritz_dense_new(2 * m, Z->ncol, out));
    for (int64_t j = 0; j < Z->ncol; j++) {
        const double *from = ritz_dense_col(Z, j);
        double *to = ritz_dense_col(out, j);

        for (int64_t k = 0; k < m; k++) {
            to[2 * k] = t[k] * from[k];
            to[2 * k + 1] = sign * from[m + k];
        }
    }
    return RITZ_OK;
}

ritz_status ritz_modal_factors(const ritz_modal *modal, ritz_dense *Zc,
                               ritz_dense *Zo)
{
    ritz_status status = RITZ_OK;
    ritz_energy model = {0};
    ritz_dense L = {0}, R = {0}, C = {0}, O = {0};
    double *inverse = NULL;

    RITZ_TRY(ritz_energy_new(modal, &model));
    RITZ_NEW(inverse, modal->count);
    for (int64_t k = 0; k < modal->count; k++)
        inverse[k] = 1.0 / modal->omega[k];
    RITZ_TRY(ritz_energy_factor(&model, &model.F[0], &L));
    RITZ_TRY(ritz_energy_factor(&model, &model.F[1], &R));
    RITZ_TRY(spread(&L, inverse, 1.0, &C));
    RITZ_TRY(spread(&R, modal->omega, -1.0, &O));
    *Zc = C;
    *Zo = O;
    C = O = (ritz_dense){0};
done:
    free(inverse);
    ritz_energy_free(&model);
    ritz_dense_free(&L);
    ritz_dense_free(&R);
    ritz_dense_free(&C);
    ritz_dense_free(&O);
    return status;
}
