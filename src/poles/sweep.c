/*
 * Responses at many frequencies. The terms of ritz_poles_add and of
 * ritz_residual_add_ratios are those of modes k,
 *
 *     H_ij += g_k(w) b_kj (c_ik + i w cv_ik - w^2 ca_ik)
 *
 * and are summed for a block of frequencies at a time: loops over frequencies
 * have no branch, so that compilers use vector instructions. Where some g_k of
 * a block overflows, underflows or is that of a pole, ritz_poles_add and
 * ritz_residual_add_ratios take the block, one frequency after the other.
 */
#include "poles/poles.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    BLOCK = 64,        /* frequencies */
    PARTS = 2 * BLOCK, /* real and imaginary ones of a block */
};

typedef struct block {
    int64_t count;
    double w[BLOCK], w2[BLOCK];
    double re[BLOCK], im[BLOCK];      /* g of a mode */
    double least[BLOCK], most[BLOCK]; /* squares that were divided by */
    double *sum; /* num_outputs x num_inputs x PARTS, row by row */
} block;

static void block_free(block *b)
{
    free(b->sum);
}

static ritz_status block_new(const ritz_io *io, block *b)
{
    RITZ_CHECK_RAW(b->sum, PARTS * io->num_outputs * io->num_inputs);
    return RITZ_OK;
}

/* Whether every square was in the range in which its inverse has all digits. */
static bool is_sound(const block *b)
{
    bool sound = true;

    for (int64_t p = 0; p < b->count; p++)
        sound = sound && b->least[p] >= DBL_MIN && b->most[p] <= DBL_MAX;
    return sound;
}

/* The sums of output i and input j: real parts, and imaginary ones behind. */
static double *find_sums(const ritz_io *io, const block *b, int64_t i,
                         int64_t j)
{
    return b->sum + PARTS * (i * io->num_inputs + j);
}

static void begin_block(const ritz_io *io, block *b)
{
    memset(b->sum, 0,
           (size_t)(io->num_outputs * io->num_inputs * PARTS) * sizeof *b->sum);
    for (int64_t p = 0; p < b->count; p++) {
        b->least[p] = DBL_MAX;
        b->most[p] = 0.0;
    }
}

static void end_block(const ritz_io *io, const block *b, double _Complex *H)
{
    const int64_t values = io->num_outputs * io->num_inputs;

    for (int64_t e = 0; e < values; e++)
        for (int64_t p = 0; p < b->count; p++)
            H[p * values + e] += ritz_complex(b->sum[PARTS * e + p],
                                              b->sum[PARTS * e + BLOCK + p]);
}

/* Add g of mode k times its participations. */
static void add_mode(const ritz_io *io, int64_t k, block *b)
{
    for (int64_t i = 0; i < io->num_outputs; i++) {
        const double c = io->C.val[i + k * io->C.nrow];
        const double cv = io->Cv.val[i + k * io->Cv.nrow];
        const double ca = io->Ca.val[i + k * io->Ca.nrow];

        if (c == 0.0 && cv == 0.0 && ca == 0.0)
            continue;
        for (int64_t j = 0; j < io->num_inputs; j++) {
            const double in = io->B.val[k + j * io->B.nrow];
            double *sum_re = find_sums(io, b, i, j), *sum_im = sum_re + BLOCK;

            for (int64_t p = 0; p < b->count; p++) {
                const double re = b->re[p] * in, im = b->im[p] * in;
                const double out_re = c - b->w2[p] * ca, out_im = b->w[p] * cv;

                sum_re[p] += out_re * re - out_im * im;
                sum_im[p] += out_re * im + out_im * re;
            }
        }
    }
}

/* g = 1 / (lambda - w^2 + i w rate); `least` is below 0 on a pole. */
static void invert_mode(double lambda, double rate, block *b)
{
    for (int64_t p = 0; p < b->count; p++) {
        const double re = lambda - b->w2[p], im = b->w[p] * rate;
        const double square = re * re + im * im;
        const double hit = 2.0 * RITZ_POLE_HIT * (lambda + b->w2[p]);
        const double clear = square - hit * hit;

        b->least[p] = clear < b->least[p] ? clear : b->least[p];
        b->most[p] = square > b->most[p] ? square : b->most[p];
        b->re[p] = re / square;
        b->im[p] = -im / square;
    }
}

/* g = -i w d / (z (z + i w d)), z = lambda - w^2 + i w (a + b lambda). */
static void change_mode(const ritz_residual *r, int64_t k, block *b)
{
    const double lambda = r->lambda[k], rate = r->rate[k];
    const double own = r->a + r->b * lambda;

    for (int64_t p = 0; p < b->count; p++) {
        const double d = b->w[p] * rate;
        const double re = lambda - b->w2[p], im = b->w[p] * own;
        const double z_re = re * re - im * (im + d);
        const double z_im = re * (im + d) + im * re;
        const double square = z_re * z_re + z_im * z_im;
        const double scale = -d / square;

        b->least[p] = square < b->least[p] ? square : b->least[p];
        b->most[p] = square > b->most[p] ? square : b->most[p];
        b->re[p] = scale * z_im;
        b->im[p] = scale * z_re;
    }
}

static ritz_status add_poles(const ritz_poles *poles, const double *hertz,
                             block *b, double _Complex *H)
{
    const ritz_io *io = &poles->io;
    const int64_t values = io->num_outputs * io->num_inputs;

    for (int64_t p = 0; p < b->count; p++) {
        b->w[p] = 2.0 * RITZ_PI * hertz[p];
        b->w2[p] = b->w[p] * b->w[p];
    }
    begin_block(io, b);
    for (int64_t k = 0; k < poles->count; k++) {
        invert_mode(poles->lambda[k], poles->rate[k], b);
        add_mode(io, k, b);
    }
    if (!is_sound(b)) {
        for (int64_t p = 0; p < b->count; p++)
            RITZ_CHECK(ritz_poles_add(poles, hertz[p], H + p * values));
        return RITZ_OK;
    }
    end_block(io, b, H);
    for (int64_t p = 0; p < b->count && poles->rest.count > 0; p++)
        ritz_residual_add(&poles->rest, hertz[p], H + p * values);
    return RITZ_OK;
}

ritz_status ritz_poles_add_all(const ritz_poles *poles, int64_t count,
                               const double *hertz, double _Complex *H)
{
    const int64_t values = poles->io.num_outputs * poles->io.num_inputs;
    const int64_t rows = poles->count + poles->massless;
    RITZ_OWN(block) b = {0};
    RITZ_OWN_ARRAY double _Complex *q = NULL;
    ritz_poles own = *poles; /* borrowed, but for q: of this thread */

    RITZ_CHECK_RAW(q, rows * poles->io.num_inputs);
    own.q = q;
    if (poles->coupled) {
        for (int64_t k = 0; k < count; k++)
            RITZ_CHECK(ritz_poles_add(&own, hertz[k], H + k * values));
        return RITZ_OK;
    }
    RITZ_CHECK(block_new(&poles->io, &b));
    for (int64_t k = 0; k < count; k += BLOCK) {
        b.count = count - k < BLOCK ? count - k : BLOCK;
        RITZ_CHECK(add_poles(&own, hertz + k, &b, H + k * values));
    }
    return RITZ_OK;
}

static void add_ratios(const ritz_residual *r, const double *hertz, block *b,
                       double _Complex *H)
{
    const ritz_io *io = &r->modes;

    for (int64_t p = 0; p < b->count; p++) {
        b->w2[p] = ritz_eigen_lambda(hertz[p]);
        b->w[p] = sqrt(b->w2[p]);
    }
    begin_block(io, b);
    for (int64_t k = 0; k < r->num_damped; k++) {
        change_mode(r, k, b);
        add_mode(io, k, b);
    }
    if (is_sound(b)) {
        end_block(io, b, H);
        return;
    }
    for (int64_t p = 0; p < b->count; p++)
        ritz_residual_add_ratios(r, hertz[p],
                                 H + p * io->num_outputs * io->num_inputs);
}

ritz_status ritz_residual_add_all(const ritz_residual *r, int64_t count,
                                  const double *hertz, double _Complex *H)
{
    const int64_t values = r->num_outputs * r->num_inputs;
    RITZ_OWN(block) b = {0};

    for (int64_t k = 0; k < count; k++)
        ritz_residual_add_series(r, hertz[k], H + k * values);
    if (r->num_damped == 0)
        return RITZ_OK;
    RITZ_CHECK(block_new(&r->modes, &b));
    for (int64_t k = 0; k < count; k += BLOCK) {
        b.count = count - k < BLOCK ? count - k : BLOCK;
        add_ratios(r, hertz + k, &b, H + k * values);
    }
    return RITZ_OK;
}
