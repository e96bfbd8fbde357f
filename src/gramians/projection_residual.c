/*
 * Residuals of the Lyapunov equations of the large model, from the residuals of
 * its approximate modes Phi. P and Q are the Gramians of the projected model in
 * its states (y, y'), u = Phi y; E = [I 0; 0 M], A = [0 I; -K -D]. With
 *
 *     K Phi = M Phi Lambda - q L,    D Phi = M Phi Delta - q N,
 *     F = M Phi F_m + q g,           F_m = Phi'F,   g = -L Theta F_m,
 *     N = b L + L Theta P_m diag(c) P_m'   (P_m = Phi'P of the dampers)
 *
 * the Gramian X = W P W', W = diag(Phi, Phi), leaves
 *
 *     A X E' + E X A' + B B' = [0; q] S [Phi' 0; 0 Phi'M] + its transpose
 *                              + [0; q g] [0; q g]',
 *     S = [L N] P + g [0 B_m'],
 *
 * and Y = W Q W', W = diag(M Phi, Phi), leaves, Q_v being the rows of Q for y',
 *
 *     A'Y E + E'Y A + C'C = diag(q, q) S diag(M Phi, M Phi)' + its transpose
 *                           + diag(q, q) g g' diag(q, q)',
 *     S = [L; N] Q_v + g [C_m' Cv_m'],    g = -L Theta of C_m, of Cv_m
 *
 * A force f is measured by f'K_s^-1 f, twice the energy of its static response:
 * q is orthonormal, and M Phi = K_s Phi Theta + q L Theta, where K_s Phi
 * Theta^1/2 is orthonormal and orthogonal to q. A displacement u is measured by
 * u'M u, in which Phi is orthonormal. Velocities are multiplied by the lowest
 * frequency w_0 in the second equation. The norm is that of Frobenius.
 */
#include "gramians/projection.h"

#include <math.h>

enum { HALVES = 2 }; /* displacements and velocities */

/* One equation: its S = [S_uu S_uv; S_vu S_vv], its load and the factor of its
   Gramian. The rows S_uu and S_uv are zero for controllability. */
typedef struct lyapunov_rest {
    bool observable;
    ritz_dense Z[HALVES];         /* m x r, rows of its factor */
    const ritz_dense *F[HALVES];  /* m x loads; NULL: 0 */
    ritz_dense g[HALVES];         /* p x loads */
    ritz_dense S[HALVES][HALVES]; /* p x m */
} lyapunov_rest;

/* What both equations need, p x m. */
typedef struct mode_rest {
    ritz_dense LTheta;
    ritz_dense N[HALVES]; /* L and N */
} mode_rest;

static void lyapunov_rest_free(lyapunov_rest *e)
{
    for (int i = 0; i < HALVES; i++) {
        ritz_dense_free(&e->Z[i]);
        ritz_dense_free(&e->g[i]);
        for (int j = 0; j < HALVES; j++)
            ritz_dense_free(&e->S[i][j]);
    }
}

static void mode_rest_free(mode_rest *rest)
{
    ritz_dense_free(&rest->LTheta);
    ritz_dense_free(&rest->N[0]);
    ritz_dense_free(&rest->N[1]);
}

/* A := A diag(factor) */
static void scale_columns(const double *factor, ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] *= factor[j];
}

/* A += B C' */
static ritz_status add_product(const ritz_dense *B, const ritz_dense *C,
                               ritz_dense *A)
{
    RITZ_OWN(ritz_dense) product = {0};

    RITZ_CHECK(ritz_dense_mul_nt(B, C, &product));
    ritz_dense_add(1.0, &product, A);
    return RITZ_OK;
}

static ritz_status find_mode_rest(const ritz_projected *p, mode_rest *out)
{
    RITZ_OWN(ritz_dense) LP = {0};

    RITZ_CHECK(ritz_dense_copy(&p->L, &out->LTheta));
    scale_columns(p->theta, &out->LTheta);
    RITZ_CHECK(ritz_dense_copy(&p->L, &out->N[0]));
    RITZ_CHECK(ritz_dense_new(p->L.nrow, p->count, &out->N[1]));
    ritz_dense_add(p->b, &p->L, &out->N[1]);
    if (p->P.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul(&out->LTheta, &p->P, &LP));
    scale_columns(p->c, &LP);
    return add_product(&LP, &p->P, &out->N[1]);
}

/* Rows of one half of Z, whose states are (y_1, y_1', y_2, ...). */
static ritz_status pick_half(const ritz_dense *Z, int half, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(Z->nrow / 2, Z->ncol, out));
    for (int64_t j = 0; j < Z->ncol; j++)
        for (int64_t i = 0; i < out->nrow; i++)
            ritz_dense_col(out, j)[i] = ritz_dense_col(Z, j)[2 * i + half];
    return RITZ_OK;
}

/* Block row i of [L N] P or of [L; N] Q_v without the last factor Z' of
   P = Z Z' or Q = Z Z'. */
static ritz_status multiply_rest(const mode_rest *rest, const lyapunov_rest *e,
                                 int i, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) first = {0};

    if (e->observable)
        return ritz_dense_mul(&rest->N[i], &e->Z[1], out);
    RITZ_CHECK(ritz_dense_mul(&rest->N[0], &e->Z[0], &first));
    RITZ_CHECK(ritz_dense_mul(&rest->N[1], &e->Z[1], out));
    ritz_dense_add(1.0, &first, out);
    return RITZ_OK;
}

/* g and both blocks of S in block row i. */
static ritz_status find_row(const mode_rest *rest, int i, lyapunov_rest *e)
{
    RITZ_OWN(ritz_dense) NZ = {0}, LF = {0};

    RITZ_CHECK(ritz_dense_mul(&rest->LTheta, e->F[i], &LF));
    RITZ_CHECK(ritz_dense_new(LF.nrow, LF.ncol, &e->g[i]));
    ritz_dense_add(-1.0, &LF, &e->g[i]);
    RITZ_CHECK(multiply_rest(rest, e, i, &NZ));
    for (int j = 0; j < HALVES; j++) {
        RITZ_CHECK(ritz_dense_mul_nt(&NZ, &e->Z[j], &e->S[i][j]));
        if (e->F[j])
            RITZ_CHECK(add_product(&e->g[i], e->F[j], &e->S[i][j]));
    }
    return RITZ_OK;
}

/* |A diag(weight)^1/2|^2; NULL: all weights are 1. */
static double sum_squares(const ritz_dense *A, const double *weight)
{
    double sum = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        sum += ritz_dense_dot(A, j, A, j) * (weight ? weight[j] : 1.0);
    return sum;
}

/* *sum += |g_i g_j' + S_ij Theta L' + L Theta S_ji'|^2 weight, the part along q
   on both sides. */
static ritz_status add_core(const mode_rest *rest, const lyapunov_rest *e,
                            int i, int j, double weight, double *sum)
{
    RITZ_OWN(ritz_dense) H = {0};

    RITZ_CHECK(ritz_dense_mul_nt(&e->g[i], &e->g[j], &H));
    RITZ_CHECK(add_product(&e->S[i][j], &rest->LTheta, &H));
    RITZ_CHECK(add_product(&rest->LTheta, &e->S[j][i], &H));
    *sum += weight * sum_squares(&H, NULL);
    return RITZ_OK;
}

/* |F'K_s^-1 F| of the loads, as they lie in the span of K_s Phi. */
static ritz_status measure_loads(const ritz_projected *p,
                                 const lyapunov_rest *e, const double *square,
                                 double *out)
{
    RITZ_OWN(ritz_dense) sum = {0};

    RITZ_CHECK(ritz_dense_new(e->F[1]->ncol, e->F[1]->ncol, &sum));
    for (int i = 0; i < HALVES; i++) {
        RITZ_OWN(ritz_dense) scaled = {0}, part = {0};

        if (!e->F[i])
            continue;
        RITZ_CHECK(ritz_dense_copy(e->F[i], &scaled));
        ritz_dense_scale_rows(p->theta, &scaled);
        RITZ_CHECK(ritz_dense_mul_tn(&scaled, e->F[i], &part));
        ritz_dense_add(square[i], &part, &sum);
    }
    *out = sqrt(sum_squares(&sum, NULL));
    return RITZ_OK;
}

/* The residual of an equation, relative to its load. */
static ritz_status measure_equation(const ritz_projected *p,
                                    const mode_rest *rest, const ritz_dense *Z,
                                    lyapunov_rest *e, double *out)
{
    const double square[HALVES] = {1.0, e->observable ? p->lowest : 1.0};
    double sum = 0.0, load = 0.0;

    RITZ_CHECK(pick_half(Z, 0, &e->Z[0]));
    RITZ_CHECK(pick_half(Z, 1, &e->Z[1]));
    for (int i = e->observable ? 0 : 1; i < HALVES; i++)
        RITZ_CHECK(find_row(rest, i, e));
    for (int i = 0; i < HALVES; i++)
        for (int j = 0; j < HALVES; j++) {
            const double weight = square[i] * square[j];
            const bool force = e->observable || j == 1;

            sum += 2.0 * weight *
                   sum_squares(&e->S[i][j], force ? p->theta : NULL);
            if (force && (e->observable || i == 1))
                RITZ_CHECK(add_core(rest, e, i, j, weight, &sum));
        }
    RITZ_CHECK(measure_loads(p, e, square, &load));
    *out = load > 0.0 ? sqrt(sum) / load : 0.0;
    return RITZ_OK;
}

ritz_status ritz_projected_residuals(const ritz_projected *projected,
                                     const ritz_gramians *factors,
                                     double out[static RITZ_SIDES])
{
    const ritz_projected *p = projected;
    RITZ_OWN(mode_rest) rest = {0};
    RITZ_OWN(lyapunov_rest) first = {.F = {NULL, &p->B}};
    RITZ_OWN(lyapunov_rest) second = {.observable = true, .F = {&p->C, &p->Cv}};

    out[RITZ_CONTROLLABLE] = out[RITZ_OBSERVABLE] = 0.0;
    if (p->L.nrow == 0 || p->count == 0)
        return RITZ_OK;
    RITZ_CHECK(find_mode_rest(p, &rest));
    RITZ_CHECK(measure_equation(p, &rest, &factors->Zc, &first,
                                &out[RITZ_CONTROLLABLE]));
    return measure_equation(p, &rest, &factors->Zo, &second,
                            &out[RITZ_OBSERVABLE]);
}
