/*
 * With S = d_i + d_j, Delta = w_i^2 - w_j^2, N = d_i w_j^2 + d_j w_i^2,
 * gamma = w_i g12 - w_j g21, den = Delta^2 + S N, the 2 x 2 block of
 *
 *     A_i' Y + Y A_j + g = 0
 *
 * is, in states (w q, q'),
 *
 *     y11 den = (d_i w_i^2 + d_j w_j^2 + S d_i d_j) g11 + S w_i w_j g22
 *               + w_j (Delta - S d_i) g12 - w_i (Delta + S d_j) g21
 *     y12 den = (d_i S - Delta) w_j g11 + S w_i gamma - Delta w_i g22
 *     y21 den = (d_j S + Delta) w_i g11 - S w_j gamma + Delta w_j g22
 *     y22 den = S w_i w_j g11 + Delta gamma + N g22
 *
 * Nothing is divided by S: light damping costs no digits. X = J Y J, g = J G J
 * turn it into the other equation. The tests hold both to it.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"

#include <cblas.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

typedef struct energy_model {
    int64_t count;   /* m */
    double *w, *d;   /* m */
    double *inverse; /* m, 1 / w */
    ritz_dense F[2]; /* 2m x inputs, 2m x outputs: B and J C' */
} energy_model;

static void energy_model_free(energy_model *model)
{
    RITZ_FREE(model->w, model->d, model->inverse);
    ritz_dense_free(&model->F[0]);
    ritz_dense_free(&model->F[1]);
    *model = (energy_model){0};
}

/* @return RITZ_ERR_ARGUMENT if a mode has no damping or no stiffness */
static ritz_status create_energy_model(const ritz_modal *modal,
                                       energy_model *out)
{
    int64_t m = modal->count;
    RITZ_OWN(energy_model) model = {.count = m};

    RITZ_CHECK_NEW(model.w, m);
    RITZ_CHECK_NEW(model.d, m);
    RITZ_CHECK_NEW(model.inverse, m);
    RITZ_CHECK(ritz_dense_new(2 * m, modal->B.ncol, &model.F[0]));
    RITZ_CHECK(ritz_dense_new(2 * m, modal->C.nrow, &model.F[1]));
    for (int64_t k = 0; k < m; k++) {
        double w = modal->omega[k];

        RITZ_REFUSE_IF(!(modal->zeta[k] > 0.0 && w > 0.0), RITZ_ERR_ARGUMENT,
                       "a mode without damping or stiffness has no Gramian");
        model.w[k] = w;
        model.inverse[k] = 1.0 / w;
        model.d[k] = 2.0 * modal->zeta[k] * w;
        for (int64_t j = 0; j < modal->B.ncol; j++)
            ritz_dense_col(&model.F[0], j)[m + k] =
                ritz_dense_col(&modal->B, j)[k];
        for (int64_t i = 0; i < modal->C.nrow; i++) {
            ritz_dense_col(&model.F[1], i)[k] =
                ritz_dense_col(&modal->C, k)[i] / w;
            ritz_dense_col(&model.F[1], i)[m + k] =
                -ritz_dense_col(&modal->Cv, k)[i];
        }
    }
    RITZ_MOVE(*out, model);
    return RITZ_OK;
}

/* * Blocks X_ij of A_i X_ij + X_ij A_j' + G_ij = 0 for modes i = 0 .. upto - 1
 * and one mode j.
 *
 * @param[in]  G  columns of position j and of velocity j, 2m each
 * @param[out] X  the same columns of X
 * @cost   O(upto) */
static void solve_blocks(const energy_model *model, int64_t j, int64_t upto,
                         const double *const G[static 2],
                         double *const X[static 2])
{
    int64_t m = model->count;
    double wj = model->w[j];
    double dj = model->d[j];
    const double *restrict w = model->w, *restrict d = model->d;
    const double *restrict g11 = G[0], *restrict g12 = G[1];
    const double *restrict g21 = G[0] + m, *restrict g22 = G[1] + m;
    double *restrict x11 = X[0], *restrict x12 = X[1];
    double *restrict x21 = X[0] + m, *restrict x22 = X[1] + m;

    for (int64_t i = 0; i < upto; i++) {
        double wi = w[i];
        double di = d[i];
        double S = di + dj;
        double Delta = (wi - wj) * (wi + wj);
        double N = di * wj * wj + dj * wi * wi;
        double by = 1.0 / (Delta * Delta + S * N);
        double gamma = wj * g21[i] - wi * g12[i];
        double ww = S * wi * wj;

        x11[i] = by * ((di * wi * wi + dj * wj * wj + S * di * dj) * g11[i] +
                       ww * g22[i] - wj * (Delta - S * di) * g12[i] +
                       wi * (Delta + S * dj) * g21[i]);
        x12[i] = by * ((Delta - di * S) * wj * g11[i] - S * wi * gamma +
                       Delta * wi * g22[i]);
        x21[i] = by * (-(dj * S + Delta) * wi * g11[i] + S * wj * gamma -
                       Delta * wj * g22[i]);
        x22[i] = by * (ww * g11[i] + Delta * gamma + N * g22[i]);
    }
}

/*
 * Exact Gramians of a modal model, block by block: B B' and C'C as products of
 * whole matrices, then a column of blocks at a time in states
 * of energy, put in place as (q_1, q_1', q_2, ...).
 */

enum { TILE = 32 };

/*
 * Blocks 0 .. j of columns 2j and 2j + 1 of W from two columns of X, as
 * W = t X t', t = diag(w, 1) or its inverse; with J, turned.
 */
static void put_blocks(const double *t, double sign, int64_t j, int64_t m,
                       double *const X[static 2], ritz_dense *W)
{
    double *position = ritz_dense_col(W, 2 * j);
    double *velocity = ritz_dense_col(W, 2 * j + 1);

    for (int64_t i = 0; i <= j; i++) {
        position[2 * i] = t[i] * t[j] * X[0][i];
        position[2 * i + 1] = sign * t[j] * X[0][m + i];
        velocity[2 * i] = sign * t[i] * X[1][i];
        velocity[2 * i + 1] = X[1][m + i];
    }
    /* exactly symmetric: the block of a mode with itself has x12 = x21 */
    position[2 * j + 1] = velocity[2 * j];
}

/* Below the diagonal what is above it, tile by tile. */
static void mirror_upper(ritz_dense *W)
{
    int64_t n = W->nrow;

    for (int64_t right = 0; right < n; right += TILE)
        for (int64_t top = 0; top <= right; top += TILE)
            for (int64_t j = right; j < n && j < right + TILE; j++)
                for (int64_t i = top; i < j && i < top + TILE; i++)
                    ritz_dense_col(W, i)[j] = ritz_dense_col(W, j)[i];
}

static ritz_status find_gramian(const energy_model *model, const ritz_dense *F,
                                const double *t, double sign, ritz_dense *out)
{
    int64_t m = model->count;
    RITZ_OWN(ritz_dense) G = {0}, X = {0}, W = {0};

    RITZ_CHECK(ritz_dense_mul_nt(F, F, &G));
    RITZ_CHECK(ritz_dense_new(2 * m, 2, &X));
    RITZ_CHECK(ritz_dense_new(2 * m, 2 * m, &W));
    for (int64_t j = 0; j < m; j++) {
        const double *const g[2] = {ritz_dense_col(&G, j),
                                    ritz_dense_col(&G, m + j)};
        double *const x[2] = {X.val, X.val + 2 * m};

        solve_blocks(model, j, j + 1, g, x);
        put_blocks(t, sign, j, m, x, &W);
    }
    mirror_upper(&W);
    RITZ_MOVE(*out, W);
    return RITZ_OK;
}

ritz_status ritz_modal_gramians_whole(const ritz_modal *modal, ritz_dense *Wc,
                                      ritz_dense *Wo)
{
    RITZ_OWN(energy_model) model = {0};
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};

    RITZ_CHECK(create_energy_model(modal, &model));
    RITZ_CHECK(find_gramian(&model, &model.F[0], model.inverse, 1.0, &X));
    RITZ_CHECK(find_gramian(&model, &model.F[1], modal->omega, -1.0, &Y));
    RITZ_MOVE(*Wc, X);
    RITZ_MOVE(*Wo, Y);
    return RITZ_OK;
}

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
 * a closed form, solve_blocks. Columns X_:k X_kk^-1/2 are the factor. It is
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

/* One mode, or one real pole of it: v' of its rows of B is what is left. */
typedef struct unit {
    int64_t mode;
    double pole;    /* 0: both of the mode */
    double v[2][2]; /* two vectors of both, one of a real pole */
    double first;   /* |v'B_k|^2 at the beginning; 0: done, or not reached */
    double left;
} unit;

typedef struct elimination {
    const energy_model *model;
    int64_t num_units;
    unit *units;
    ritz_dense B;    /* 2m x p, what is left */
    ritz_dense row;  /* 2 x p, v'B_k */
    ritz_dense G, X; /* 2m x 2 */
    ritz_dense Z;    /* 2m x 2m, of which rank columns are there */
    int64_t rank;
} elimination;

static void elimination_free(elimination *e)
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

    if (a <= RITZ_NEARLY_CRITICAL * w) {
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
static void measure_units(elimination *e)
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

static ritz_status start_elimination(const energy_model *model,
                                     const ritz_dense *F, elimination *e)
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
    measure_units(e);
    for (int64_t u = 0; u < e->num_units; u++)
        e->units[u].first = e->units[u].left;
    return RITZ_OK;
}

/* The unit of which most is left; NULL where that is rounding. */
static unit *choose_unit(elimination *e)
{
    double rounding = 2.0 * (double)e->model->count * DBL_EPSILON;
    double most = rounding * rounding;
    unit *best = NULL;

    measure_units(e);
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
static void read_unit(const unit *at, int columns, elimination *e)
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

    read_unit(at, 2, e);
    solve_blocks(e->model, k, m, G, X);
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

    read_unit(at, 1, e);
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

/* Z of X = Z Z', 2m x rank. @cost O(m^2 inputs) */
static ritz_status find_factor(const energy_model *model, const ritz_dense *F,
                               ritz_dense *out)
{
    RITZ_OWN(elimination) e = {0};
    RITZ_OWN_ARRAY double *row = NULL;
    unit *next = NULL;

    RITZ_CHECK_NEW(row, F->ncol);
    RITZ_CHECK(start_elimination(model, F, &e));
    for (next = choose_unit(&e); next; next = choose_unit(&e)) {
        if (next->pole < 0.0)
            eliminate_pole(next, &e, row);
        else
            eliminate_mode(next, &e, row);
    }
    *out = e.Z;
    out->ncol = e.rank;
    e.Z = (ritz_dense){0};
    return RITZ_OK;
}

/* Rows (q_1, q_1', ...) of t Z and of sign Z. */
static ritz_status spread_rows(const ritz_dense *Z, const double *t,
                               double sign, ritz_dense *out)
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

ritz_status ritz_modal_factors_whole(const ritz_modal *modal, ritz_dense *Zc,
                                     ritz_dense *Zo)
{
    RITZ_OWN(energy_model) model = {0};
    RITZ_OWN(ritz_dense) L = {0}, R = {0}, C = {0}, O = {0};

    RITZ_CHECK(create_energy_model(modal, &model));
    RITZ_CHECK(find_factor(&model, &model.F[0], &L));
    RITZ_CHECK(find_factor(&model, &model.F[1], &R));
    RITZ_CHECK(spread_rows(&L, model.inverse, 1.0, &C));
    RITZ_CHECK(spread_rows(&R, modal->omega, -1.0, &O));
    RITZ_MOVE(*Zc, C);
    RITZ_MOVE(*Zo, O);
    return RITZ_OK;
}
