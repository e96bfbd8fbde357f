/*
 * Gramians over a band in closed form, from W_c and W_o over all frequencies:
 *
 *     W_c(band) = S W_c + W_c S',    W_o(band) = S'W_o + W_o S,
 *     S = S(w2) - S(w1),    S(w) = i/2pi ln((A + i w)(A - i w)^-1)
 *
 * For one mode, A is 2 x 2 and S(w) = p I + g (A + d/2 I). For under-, over-
 * and critical damping alike, with h = w_k^2 + w^2 and beta^2 = w_k^2 - d^2/4
 * of either sign,
 *
 *     2 pi p = arg(w_k^2 - w^2 + i d w)
 *     2 pi g = (2 w / h) artanh(x) / x,    x = 2 w beta / h
 *
 * and 2 pi (p(w2) - p(w1)) is the angle between the two complex numbers.
 *
 * Factors come from the eigenvalues of Gramians scaled to a unit diagonal.
 * Eigenvalues within the rounding of S W + W S' are dropped; one that is more
 * negative is an error.
 *
 * [GawronskiJuang1990]
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"
#include "linear/general.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>

/* S(w2) - S(w1) of a mode, in states (q, q'). */
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

/* Entry (i, j) of S W, or of S'W. */
static double applied_at(const response *S, bool transposed,
                         const ritz_dense *W, int64_t i, int64_t j)
{
    const double(*s)[2] = S[i / 2].s;
    const double *x = ritz_dense_col(W, j) + 2 * (i / 2);
    int a = (int)(i % 2);

    return transposed ? s[0][a] * x[0] + s[1][a] * x[1]
                      : s[a][0] * x[0] + s[a][1] * x[1];
}

/* S W + W S', exactly symmetric. */
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

/* A band Gramian, and the sums of magnitudes that its rounding is relative
   to. */
typedef struct filtered {
    ritz_dense W, terms;
} filtered;

static void filtered_free(filtered *f)
{
    ritz_dense_free(&f->W);
    ritz_dense_free(&f->terms);
}

RITZ_PAIR_OF(filtered);

/* Both Gramians over a band. */
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

static const char band_alone[] = "over a band it must be mode by mode";

/* Gramians of modes that damping couples, by their factors. */
static ritz_status multiply_factors(const ritz_modal *modal, ritz_dense *Wc,
                                    ritz_dense *Wo)
{
    RITZ_OWN(ritz_dense) Zc = {0}, Zo = {0}, C = {0}, O = {0};

    RITZ_CHECK(ritz_coupled_factors(modal, &Zc, &Zo));
    RITZ_CHECK(ritz_dense_mul_nt(&Zc, &Zc, &C));
    RITZ_CHECK(ritz_dense_mul_nt(&Zo, &Zo, &O));
    RITZ_MOVE(*Wc, C);
    RITZ_MOVE(*Wo, O);
    return RITZ_OK;
}

ritz_status ritz_modal_gramians(const ritz_modal *modal, const double *band_hz,
                                ritz_dense *Wc, ritz_dense *Wo)
{
    RITZ_OWN(filtered_pair) of = {0};

    if (modal->Delta.val)
        return band_hz ? ritz_coupled_refuse(modal, band_alone)
                       : multiply_factors(modal, Wc, Wo);
    if (!band_hz)
        return ritz_modal_gramians_whole(modal, Wc, Wo);
    RITZ_CHECK(filter_gramians(modal, band_hz, of));
    RITZ_MOVE(*Wc, of[0].W);
    RITZ_MOVE(*Wo, of[1].W);
    return RITZ_OK;
}

/* Square roots of the diagonal; 0 where it is rounding. */
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

/* A(i,j) := A(i,j) / (root_i root_j); returns the largest sum of magnitudes in
   a column. */
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

/* root V s^1/2 with the eigenvalues s that are larger than rounding. */
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

/* Factor of a band Gramian; overwrites both matrices. */
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

    if (modal->Delta.val)
        return band_hz ? ritz_coupled_refuse(modal, band_alone)
                       : ritz_coupled_factors(modal, Zc, Zo);
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
 * Exact Hankel singular values of a modal model are the singular values of
 * Z_o'Z_c with factors in closed form. Modes that are not controllable or not
 * observable give zeros.
 *
 * [Moore1981], [McDaniel2000] eq. 3.2.19 to 3.2.21
 */
ritz_status ritz_modal_hankel(const ritz_modal *modal, const double *band_hz,
                              double *sigma)
{
    RITZ_OWN(ritz_dense) Zc = {0}, Zo = {0}, H = {0};
    int64_t count = 0;

    for (int64_t k = 0; k < ritz_modal_order(modal); k++)
        sigma[k] = 0.0;
    if (modal->Delta.val && !band_hz)
        return ritz_coupled_hankel(modal, &count, sigma);
    RITZ_CHECK(ritz_modal_factors(modal, band_hz, &Zc, &Zo));
    RITZ_CHECK(ritz_dense_mul_tn(&Zo, &Zc, &H));
    return ritz_context(ritz_general_singular(&H, sigma), "Hankel values");
}

ritz_status ritz_modal_outputs(const ritz_modal *modal, ritz_dense *out)
{
    if (modal->Delta.val)
        return ritz_coupled_outputs(modal, out);
    RITZ_CHECK(ritz_dense_new(2 * modal->count, modal->C.nrow, out));
    for (int64_t i = 0; i < out->ncol; i++)
        for (int64_t k = 0; k < modal->count; k++) {
            double *c = ritz_dense_col(out, i) + 2 * k;

            c[0] = ritz_dense_col(&modal->C, k)[i];
            c[1] = ritz_dense_col(&modal->Cv, k)[i];
        }
    return RITZ_OK;
}
