/*
 * From matrices to a modal model: with K Phi = M Phi Lambda, Phi'M Phi = I,
 *
 *     q'' + Phi'D Phi q' + Lambda q = Phi'B u,    zeta_k = d_kk / (2 w_k)
 *
 * An acceleration output is q'' = b u - 2 zeta w q' - w^2 q:
 *
 *     C  := C  - Ca w^2,    Cv := Cv - Ca 2 zeta w
 *
 * and the feedthrough Ca b u is left out: it is the same whatever is kept.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>

static ritz_status check_limits(int64_t count, const double *limit,
                                const char (*output)[RITZ_NAME_SIZE])
{
    for (int64_t i = 0; i < count; i++)
        RITZ_REFUSE_IF(limit[i] <= 0.0, RITZ_ERR_ARGUMENT,
                       "output '%s' has the limit %g, which is not positive",
                       output[i], limit[i]);
    return RITZ_OK;
}

ritz_status ritz_ends_check(const char *what, int64_t inputs, int64_t outputs,
                            const double *limit,
                            const char (*output)[RITZ_NAME_SIZE])
{
    RITZ_REFUSE_IF(inputs == 0, RITZ_ERR_ARGUMENT,
                   "the %s has no inputs: nothing of it is controllable", what);
    RITZ_REFUSE_IF(outputs == 0, RITZ_ERR_ARGUMENT,
                   "the %s has no outputs: nothing of it is observable", what);
    return check_limits(outputs, limit, output);
}

ritz_status ritz_outputs_scaled(const ritz_dense *C, const double *limit,
                                ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(C->ncol, C->nrow, out));
    for (int64_t i = 0; i < C->nrow; i++)
        for (int64_t j = 0; j < C->ncol; j++)
            ritz_dense_col(out, i)[j] =
                ritz_dense_col(C, j)[i] / (isnan(limit[i]) ? 1.0 : limit[i]);
    return RITZ_OK;
}

/* One past the last mode at the frequency of mode `first`. */
static int64_t find_cluster_end(int64_t count, const double *omega,
                                int64_t first)
{
    int64_t last = first + 1;

    while (last < count &&
           omega[last] - omega[last - 1] <= RITZ_CLUSTER_GAP * omega[last])
        last++;
    return last;
}

int64_t ritz_modal_cluster(const ritz_modal *modal, int64_t first)
{
    return find_cluster_end(modal->count, modal->omega, first);
}

/* Columns first, first + 1, ... of A := those times V. */
static ritz_status turn_columns(ritz_dense *A, int64_t first,
                                const ritz_dense *V)
{
    RITZ_OWN(ritz_dense) turned = {0};
    ritz_dense part = {0};

    if (A->nrow == 0 || A->ncol == 0)
        return RITZ_OK;
    part = ritz_dense_part(A, first, V->nrow);
    RITZ_CHECK(ritz_dense_mul(&part, V, &turned));
    ritz_dense_put(&turned, 0, first, A);
    return RITZ_OK;
}

/* Rows first, first + 1, ... of A := V' times those. */
static ritz_status turn_rows(ritz_dense *A, int64_t first, const ritz_dense *V)
{
    RITZ_OWN(ritz_dense) part = {0}, turned = {0};

    RITZ_CHECK(ritz_dense_block(A, first, V->nrow, 0, A->ncol, &part));
    RITZ_CHECK(ritz_dense_mul_tn(V, &part, &turned));
    ritz_dense_put(&turned, first, 0, A);
    return RITZ_OK;
}

/* Eigenvectors V of a block of Delta; *needed: it is not diagonal yet. */
static ritz_status find_axes(const ritz_dense *Delta, int64_t first,
                             int64_t last, ritz_dense *V, bool *needed)
{
    int64_t n = last - first;
    RITZ_OWN_ARRAY double *d = NULL;

    RITZ_CHECK_NEW(d, n);
    RITZ_CHECK(ritz_dense_block(Delta, first, n, first, n, V));
    for (int64_t k = 0; k < n * n; k++)
        *needed = *needed || (k % (n + 1) != 0 && V->val[k] != 0.0);
    if (!*needed)
        return RITZ_OK;
    ritz_dense_symmetrise(V);
    RITZ_REFUSE_IF(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (int)n, V->val,
                                 (int)n, d) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "damping of a cluster of modes cannot be made diagonal");
    ritz_dense_orient(V);
    return RITZ_OK;
}

ritz_status ritz_modes_turn(ritz_modal_model *modes)
{
    ritz_dense *const columns[5] = {&modes->Phi, &modes->MPhi, &modes->C,
                                    &modes->Cv, &modes->Delta};
    RITZ_OWN_ARRAY double *omega = NULL;
    int64_t last = 0;

    RITZ_CHECK_NEW(omega, modes->count);
    for (int64_t k = modes->num_rigid; k < modes->count; k++)
        omega[k] = sqrt(modes->lambda[k]);
    for (int64_t k = modes->num_rigid; k < modes->count; k = last) {
        RITZ_OWN(ritz_dense) V = {0};
        bool needed = false;

        last = find_cluster_end(modes->count, omega, k);
        if (last > k + 1)
            RITZ_CHECK(find_axes(&modes->Delta, k, last, &V, &needed));
        if (!needed)
            continue;
        for (int i = 0; i < 5; i++)
            RITZ_CHECK(turn_columns(columns[i], k, &V));
        RITZ_CHECK(turn_rows(&modes->Delta, k, &V));
        RITZ_CHECK(turn_rows(&modes->B, k, &V));
    }
    return RITZ_OK;
}

/* Two modes that damping couples, one at least flexible. */
typedef struct coupling {
    int64_t mode[2];
    double ratio; /* of their own damping */
} coupling;

static bool find_coupling(const ritz_modal_model *modes, coupling *out)
{
    const ritz_dense *d = &modes->Delta;
    double largest = 0.0;

    for (int64_t k = 0; k < d->ncol; k++)
        largest = fmax(largest, fabs(ritz_dense_col(d, k)[k]));
    for (int64_t j = modes->num_rigid; j < d->ncol; j++)
        for (int64_t i = 0; i < j; i++) {
            double own = sqrt(fabs(ritz_dense_col(d, i)[i]) *
                              fabs(ritz_dense_col(d, j)[j]));
            double off = fmax(fabs(ritz_dense_col(d, j)[i]),
                              fabs(ritz_dense_col(d, i)[j]));
            double rounding = RITZ_NEGLIGIBLE * largest;

            if (off <= RITZ_DAMPING_COUPLES * own + rounding)
                continue;
            *out = (coupling){{i, j}, off / fmax(own, rounding)};
            return true;
        }
    return false;
}

bool ritz_modes_coupled(const ritz_modal_model *modes)
{
    return find_coupling(modes, &(coupling){0});
}

static ritz_status refuse_coupling(const ritz_modal_model *modes,
                                   const char *why)
{
    coupling found = {0};
    char own[RITZ_NAME_SIZE] = "which have none of their own";

    if (!find_coupling(modes, &found))
        return RITZ_OK;
    if (isfinite(found.ratio))
        snprintf(own, sizeof own, "%.1e of their own damping", found.ratio);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the damping matrix couples the modes at %.6g and %.6g "
                     "Hz (%s): %s",
                     ritz_eigen_hertz(modes->lambda[found.mode[0]]),
                     ritz_eigen_hertz(modes->lambda[found.mode[1]]), own, why);
}

/* A model of `count` modes, all zero. */
static ritz_status create_modal(int64_t count, int64_t inputs, int64_t outputs,
                                ritz_modal *out)
{
    RITZ_OWN(ritz_modal) modal = {.count = count};

    RITZ_CHECK_NEW(modal.omega, count);
    RITZ_CHECK_NEW(modal.zeta, count);
    RITZ_CHECK(ritz_dense_new(count, inputs, &modal.B));
    RITZ_CHECK(ritz_dense_new(outputs, count, &modal.C));
    RITZ_CHECK(ritz_dense_new(outputs, count, &modal.Cv));
    RITZ_MOVE(*out, modal);
    return RITZ_OK;
}

/* Inputs and outputs of mode k are those of mode `at`, over limits if any. */
static void put_mode(const ritz_dense *const from[static 3], int64_t at,
                     const double *limit, ritz_modal *modal, int64_t k)
{
    for (int64_t j = 0; j < modal->B.ncol; j++)
        ritz_dense_col(&modal->B, j)[k] = ritz_dense_col(from[0], j)[at];
    for (int64_t i = 0; i < modal->C.nrow; i++) {
        double by = limit && !isnan(limit[i]) ? limit[i] : 1.0;

        ritz_dense_col(&modal->C, k)[i] = ritz_dense_col(from[1], at)[i] / by;
        ritz_dense_col(&modal->Cv, k)[i] = ritz_dense_col(from[2], at)[i] / by;
    }
}

ritz_status ritz_modal_of_modes(const ritz_modal_model *modes,
                                const ritz_io *io, const char *why,
                                ritz_modal *out)
{
    const ritz_dense *const from[] = {&modes->B, &modes->C, &modes->Cv};
    RITZ_OWN(ritz_modal) modal = {0};
    int64_t r = modes->num_rigid;

    RITZ_CHECK(refuse_coupling(modes, why));
    RITZ_CHECK(check_limits(io->num_outputs, io->limit, io->output));
    RITZ_CHECK(
        create_modal(modes->count - r, modes->B.ncol, modes->C.nrow, &modal));
    for (int64_t k = 0; k < modal.count; k++) {
        modal.omega[k] = sqrt(modes->lambda[r + k]);
        modal.zeta[k] = ritz_dense_col(&modes->Delta, r + k)[r + k] /
                        (2.0 * modal.omega[k]);
        RITZ_REFUSE_IF(
            !(modal.zeta[k] > 0.0), RITZ_ERR_ARGUMENT,
            "the mode at %.6g Hz has %s damping: every flexible mode "
            "needs a positive ratio, from --damping or the scene",
            ritz_eigen_hertz(modes->lambda[r + k]),
            modal.zeta[k] < 0.0 ? "negative" : "no");
        put_mode(from, r + k, io->limit, &modal, k);
    }
    RITZ_MOVE(*out, modal);
    return RITZ_OK;
}

ritz_status ritz_modal_part(const ritz_modal *modal, int64_t first,
                            int64_t last, const bool *taken, ritz_modal *out)
{
    const ritz_dense *const from[] = {&modal->B, &modal->C, &modal->Cv};
    RITZ_OWN(ritz_modal) part = {0};
    int64_t count = 0;

    for (int64_t k = first; k < last; k++)
        count += !taken || taken[k];
    RITZ_CHECK(create_modal(count, modal->B.ncol, modal->C.nrow, &part));
    count = 0;
    for (int64_t k = first; k < last; k++) {
        if (taken && !taken[k])
            continue;
        part.omega[count] = modal->omega[k];
        part.zeta[count] = modal->zeta[k];
        put_mode(from, k, NULL, &part, count++);
    }
    RITZ_MOVE(*out, part);
    return RITZ_OK;
}

ritz_status ritz_modal_new(const ritz_dense *K, const ritz_dense *M,
                           const ritz_dense *D, const ritz_io *io,
                           const ritz_damping *damping, ritz_modal *out)
{
    const ritz_damping none = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_modal_model) modes = {0};

    RITZ_REFUSE_IF(io->B.nrow != K->nrow || io->C.ncol != K->nrow,
                   RITZ_ERR_ARGUMENT,
                   "inputs and outputs are those of another model");
    RITZ_REFUSE_IF(D && D->val && D->nrow != K->nrow, RITZ_ERR_ARGUMENT,
                   "the damping matrix is that of another model");
    RITZ_CHECK(ritz_eigen_dense(K, M, &pairs));
    ritz_modal_model_take(&pairs, K->nrow, &modes);
    if (D && D->val)
        RITZ_CHECK(ritz_dense_project(D, &modes.Phi, &modes.Delta));
    RITZ_CHECK(ritz_modal_model_drive(io, damping ? damping : &none, &modes));
    RITZ_CHECK(ritz_modes_turn(&modes));
    return ritz_modal_of_modes(&modes, io,
                               "a ranking needs damping mode by mode", out);
}

void ritz_modal_free(ritz_modal *modal)
{
    RITZ_FREE(modal->omega, modal->zeta);
    ritz_dense_free(&modal->B);
    ritz_dense_free(&modal->C);
    ritz_dense_free(&modal->Cv);
    *modal = (ritz_modal){0};
}

/*
 * Gramians of a band in closed form. With the full ones,
 *
 *     W_c(band) = S W_c + W_c S',    W_o(band) = S'W_o + W_o S,
 *     S = S(w2) - S(w1),    S(w) = i/2pi ln((A + i w)(A - i w)^-1)
 *
 * and of a mode, whose A is 2 x 2, S(w) = p I + g (A + d/2 I). Whether it is
 * under-, over- or critically damped: with h = w_k^2 + w^2,
 * beta^2 = w_k^2 - d^2/4 of either sign,
 *
 *     2 pi p = arg(w_k^2 - w^2 + i d w)
 *     2 pi g = (2 w / h) artanh(x) / x,    x = 2 w beta / h
 *
 * and the difference of two p is the angle between both arguments.
 *
 * Factors are from eigenvalues of Gramians scaled to a unit diagonal. What lies
 * within the rounding of S W + W S' is dropped; a negative one beyond it is an
 * error.
 *
 * [GawronskiJuang1990]
 */

/* S of a mode, in states (q, q'). */
typedef struct response {
    double s[2][2];
} response;

/* 2 pi g at w */
static double slope_at(double wk, double d, double w)
{
    double h = wk * wk + w * w;
    double square = (wk - d / 2.0) * (wk + d / 2.0);
    double beta = sqrt(fabs(square));
    double x = 2.0 * w * beta / h;

    if (isinf(w))
        return 0.0;
    if (!(x > 0.0))
        return 2.0 * w / h;
    if (square < 0.0)
        return atan(x) / beta;
    /* artanh(x) = log((h + 2 w beta) / (h - 2 w beta)) / 2, near resonance */
    return log1p(4.0 * w * beta / (d * d / 4.0 + (w - beta) * (w - beta))) /
           (2.0 * beta);
}

/* 2 pi (p(w2) - p(w1)) */
static double turned_angle(double wk, double d, const double w[static 2])
{
    double below = (wk - w[0]) * (wk + w[0]);
    double above = (wk - w[1]) * (wk + w[1]);

    if (isinf(w[1]))
        return atan2(d * w[0], -below);
    return atan2(d * (w[1] - w[0]) * (wk * wk + w[0] * w[1]),
                 above * below + d * d * w[0] * w[1]);
}

static response response_of(double wk, double zeta, const double w[static 2])
{
    double d = 2.0 * zeta * wk;
    double p = turned_angle(wk, d, w) / (2.0 * RITZ_PI);
    double g =
        (slope_at(wk, d, w[1]) - slope_at(wk, d, w[0])) / (2.0 * RITZ_PI);

    return (response){{{p + g * d / 2.0, g}, {-g * wk * wk, p - g * d / 2.0}}};
}

/* Row i of S W, or of S'W, at column j. */
static double applied_at(const response *S, bool transposed,
                         const ritz_dense *W, int64_t i, int64_t j)
{
    const double(*s)[2] = S[i / 2].s;
    const double *x = ritz_dense_col(W, j) + 2 * (i / 2);
    int a = (int)(i % 2);

    return transposed ? s[0][a] * x[0] + s[1][a] * x[1]
                      : s[a][0] * x[0] + s[a][1] * x[1];
}

/* S W + W S', exactly symmetric as W is. */
static ritz_status filter_gramian(const response *S, bool transposed,
                                  const ritz_dense *W, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(W->nrow, W->ncol, out));
    for (int64_t j = 0; j < W->ncol; j++)
        for (int64_t i = 0; i <= j; i++) {
            double x = applied_at(S, transposed, W, i, j) +
                       applied_at(S, transposed, W, j, i);

            ritz_dense_col(out, j)[i] = x;
            ritz_dense_col(out, i)[j] = x;
        }
    return RITZ_OK;
}

/* A band Gramian with the magnitudes that it is a sum of. */
typedef struct filtered {
    ritz_dense W, terms;
} filtered;

static void filtered_free(filtered *f)
{
    ritz_dense_free(&f->W);
    ritz_dense_free(&f->terms);
}

RITZ_PAIR_OF(filtered);

/* Both Gramians of a band. */
static ritz_status filter_gramians(const ritz_modal *modal,
                                   const double band_hz[static 2],
                                   filtered out[static 2])
{
    const double w[2] = {2.0 * RITZ_PI * band_hz[0],
                         2.0 * RITZ_PI * band_hz[1]};
    RITZ_OWN(ritz_dense_pair) W = {0};
    RITZ_OWN_ARRAY response *S = NULL, *size = NULL;

    RITZ_REFUSE_IF(!(band_hz[0] >= 0.0 && band_hz[1] > band_hz[0]) ||
                       isinf(band_hz[0]),
                   RITZ_ERR_ARGUMENT,
                   "a band is from 0 Hz or more to more, not from %g to %g",
                   band_hz[0], band_hz[1]);
    RITZ_CHECK(ritz_modal_gramians_whole(modal, &W[0], &W[1]));
    RITZ_CHECK_NEW(S, modal->count);
    RITZ_CHECK_NEW(size, modal->count);
    for (int64_t k = 0; k < modal->count; k++) {
        S[k] = response_of(modal->omega[k], modal->zeta[k], w);
        for (int i = 0; i < 4; i++)
            size[k].s[i / 2][i % 2] = fabs(S[k].s[i / 2][i % 2]);
    }
    for (int side = 0; side < 2; side++) {
        RITZ_OWN(ritz_dense) terms = {0};

        RITZ_CHECK(ritz_dense_abs(&W[side], &terms));
        RITZ_CHECK(filter_gramian(S, side == 1, &W[side], &out[side].W));
        RITZ_CHECK(filter_gramian(size, side == 1, &terms, &out[side].terms));
    }
    return RITZ_OK;
}

ritz_status ritz_modal_gramians(const ritz_modal *modal, const double *band_hz,
                                ritz_dense *Wc, ritz_dense *Wo)
{
    RITZ_OWN(filtered_pair) of = {0};

    if (!band_hz)
        return ritz_modal_gramians_whole(modal, Wc, Wo);
    RITZ_CHECK(filter_gramians(modal, band_hz, of));
    RITZ_MOVE(*Wc, of[0].W);
    RITZ_MOVE(*Wo, of[1].W);
    return RITZ_OK;
}

/* Roots of the diagonal, 0 where that is rounding. */
static ritz_status find_roots(const filtered *f, double *root)
{
    for (int64_t k = 0; k < f->W.nrow; k++) {
        double own = ritz_dense_col(&f->W, k)[k];
        double rounding = RITZ_BAND_ROUNDING * ritz_dense_col(&f->terms, k)[k];

        RITZ_REFUSE_IF(!(own >= -rounding), RITZ_ERR_CONVERGENCE,
                       "the Gramian of a band is negative beyond rounding");
        root[k] = own > rounding ? sqrt(own) : 0.0;
    }
    return RITZ_OK;
}

/* A(i,j) / (root_i root_j); returns its largest sum of a column. */
static double scale_matrix(ritz_dense *A, const double *root)
{
    double largest = 0.0;

    for (int64_t j = 0; j < A->ncol; j++) {
        double sum = 0.0;

        for (int64_t i = 0; i < A->nrow; i++) {
            double by = root[i] * root[j];
            double *x = ritz_dense_col(A, j) + i;

            *x = by > 0.0 ? *x / by : 0.0;
            sum += fabs(*x);
        }
        largest = fmax(largest, sum);
    }
    return largest;
}

/* root V s^1/2 of the eigenvalues s above what is rounding of others. */
static ritz_status put_factor(const ritz_dense *V, const double *s,
                              const double *root, ritz_dense *out)
{
    int64_t n = V->nrow;
    int64_t first = 0;
    double rounding = (double)n * DBL_EPSILON;

    if (n > 0)
        rounding = fmax(rounding, -s[0]);
    while (first < n && s[first] <= rounding)
        first++;
    RITZ_CHECK(ritz_dense_new(n, n - first, out));
    for (int64_t j = first; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(out, j - first)[i] =
                root[i] * ritz_dense_col(V, j)[i] * sqrt(s[j]);
    return RITZ_OK;
}

/* Overwrites both matrices. */
static ritz_status factor_filtered(filtered *f, ritz_dense *out)
{
    int n = (int)f->W.nrow;
    RITZ_OWN_ARRAY double *root = NULL, *s = NULL;
    double rounding = 0.0;

    RITZ_CHECK_NEW(root, n);
    RITZ_CHECK_NEW(s, n);
    RITZ_CHECK(find_roots(f, root));
    (void)scale_matrix(&f->W, root);
    rounding = RITZ_BAND_ROUNDING * scale_matrix(&f->terms, root);
    RITZ_REFUSE_IF(n > 0 && LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', n,
                                           f->W.val, n, s) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "eigenvalues of the Gramian of a band were not found");
    RITZ_REFUSE_IF(n > 0 && s[0] < -rounding, RITZ_ERR_CONVERGENCE,
                   "the Gramian of a band has an eigenvalue of %.1e of its "
                   "diagonal, beyond rounding (%.1e)",
                   s[0], rounding);
    return put_factor(&f->W, s, root, out);
}

ritz_status ritz_modal_factors(const ritz_modal *modal, const double *band_hz,
                               ritz_dense *Zc, ritz_dense *Zo)
{
    RITZ_OWN(filtered_pair) of = {0};
    RITZ_OWN(ritz_dense_pair) Z = {0};

    if (!band_hz)
        return ritz_modal_factors_whole(modal, Zc, Zo);
    RITZ_CHECK(filter_gramians(modal, band_hz, of));
    RITZ_CHECK(factor_filtered(&of[0], &Z[0]));
    RITZ_CHECK(factor_filtered(&of[1], &Z[1]));
    RITZ_MOVE(*Zc, Z[0]);
    RITZ_MOVE(*Zo, Z[1]);
    return RITZ_OK;
}

/*
 * Exact Hankel singular values of a modal model are those of Z_o'Z_c, of
 * factors in closed form. Modes that are not controllable or not observable get
 * zero and not a failure.
 *
 * [Moore1981], [McDaniel2000] eq. 3.2.19 to 3.2.21
 */
ritz_status ritz_modal_hankel(const ritz_modal *modal, const double *band_hz,
                              double *sigma)
{
    RITZ_OWN(ritz_dense) Zc = {0}, Zo = {0}, H = {0};

    RITZ_CHECK(ritz_modal_factors(modal, band_hz, &Zc, &Zo));
    for (int64_t k = 0; k < 2 * modal->count; k++)
        sigma[k] = 0.0;
    RITZ_CHECK(ritz_dense_mul_tn(&Zo, &Zc, &H));
    return ritz_context(ritz_general_singular(&H, sigma), "Hankel values");
}
