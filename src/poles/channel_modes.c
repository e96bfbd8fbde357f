/*
 * A channel of a second-order model, by its modes: with W = |Lambda|^1/2, or 1
 * where Lambda is 0,
 *
 *     x = [W p; p'],   x' = [ 0          W     ] x + [ 0      ] u
 *                           [ -Lambda/W  -Delta ]    [ Phi'B ]
 *
 * which holds slow poles apart from fast ones. Without damping
 * p'' = -Lambda p + Phi'B u stands for itself.
 */
#include "poles/channel_modes.h"

#include <math.h>
#include <stdlib.h>

static double weight(double lambda)
{
    return lambda != 0.0 ? sqrt(fabs(lambda)) : 1.0;
}

/* A = -Lambda, or blocks of two. */
static ritz_status fill_apart(int64_t m, const ritz_channel_row *rows,
                              bool squared, double feed, ritz_channel *out)
{
    int64_t n = squared ? m : 2 * m;

    out->squared = squared;
    out->blocks = !squared;
    RITZ_CHECK(ritz_dense_new(n, n, &out->A));
    RITZ_CHECK(ritz_dense_new(n, 1, &out->B));
    RITZ_CHECK(ritz_dense_new(1, n, &out->C));
    RITZ_CHECK(ritz_dense_new(1, 1, &out->D));
    out->D.val[0] = feed;
    for (int64_t k = 0; k < m; k++) {
        const ritz_channel_row *r = &rows[k];
        double w = weight(r->lambda);

        out->B.val[n - m + k] = 1.0;
        out->C.val[k] = squared ? r->c : r->c / w;
        if (squared) {
            ritz_dense_col(&out->A, k)[k] = -r->lambda;
            continue;
        }
        out->C.val[m + k] = r->cv;
        ritz_dense_col(&out->A, m + k)[k] = w;
        ritz_dense_col(&out->A, k)[m + k] = -r->lambda / w;
        ritz_dense_col(&out->A, m + k)[m + k] = -r->rate;
    }
    return RITZ_OK;
}

static ritz_status by_rows(int64_t count, const ritz_channel_row *rows,
                           double feed, ritz_channel *out)
{
    bool squared = true;

    for (int64_t k = 0; k < count; k++)
        squared = squared && rows[k].rate == 0.0 && rows[k].cv == 0.0;
    return fill_apart(count, rows, squared, feed, out);
}

/* All of it, in the same coordinates. */
static ritz_status by_states(const ritz_first_order *f, ritz_channel *out)
{
    int64_t m = f->count;

    RITZ_CHECK(ritz_dense_new(2 * m, 2 * m, &out->A));
    RITZ_CHECK(ritz_dense_new(2 * m, f->B.ncol, &out->B));
    RITZ_CHECK(ritz_dense_new(f->C.nrow, 2 * m, &out->C));
    RITZ_CHECK(ritz_dense_copy(&f->feed, &out->D));
    for (int64_t k = 0; k < m; k++) {
        double w = weight(f->lambda[k]);

        ritz_dense_col(&out->A, m + k)[k] = w;
        ritz_dense_col(&out->A, k)[m + k] = -f->lambda[k] / w;
        for (int64_t i = 0; i < m; i++)
            ritz_dense_col(&out->A, m + k)[m + i] =
                -ritz_dense_col(&f->Delta, k)[i];
        for (int64_t j = 0; j < f->B.ncol; j++)
            ritz_dense_col(&out->B, j)[m + k] = ritz_dense_col(&f->B, j)[k];
        for (int64_t i = 0; i < f->C.nrow; i++) {
            ritz_dense_col(&out->C, k)[i] = ritz_dense_col(&f->C, k)[i] / w;
            ritz_dense_col(&out->C, m + k)[i] = ritz_dense_col(&f->Cv, k)[i];
        }
    }
    return RITZ_OK;
}

/* The same without damping, of several outputs and inputs. */
static ritz_status by_squares(const ritz_first_order *f, ritz_channel *out)
{
    out->squared = true;
    RITZ_CHECK(ritz_dense_new(f->count, f->count, &out->A));
    for (int64_t k = 0; k < f->count; k++)
        ritz_dense_col(&out->A, k)[k] = -f->lambda[k];
    RITZ_CHECK(ritz_dense_copy(&f->B, &out->B));
    RITZ_CHECK(ritz_dense_copy(&f->C, &out->C));
    return ritz_dense_copy(&f->feed, &out->D);
}

ritz_status ritz_channel_of_modes(const ritz_first_order *modes,
                                  const ritz_dense *D, const ritz_io *io,
                                  bool single, ritz_channel *out)
{
    ritz_status status = RITZ_OK;
    ritz_channel_row *rows = NULL;
    ritz_first_order moved = {0};
    int64_t count = -1;

    if (single)
        RITZ_TRY(ritz_channel_rows(modes, D, io, &count, &rows));
    if (count >= 0) {
        RITZ_TRY(by_rows(count, rows, modes->feed.val[0], out));
        goto done;
    }
    RITZ_TRY(ritz_channel_moved(modes, D, io, &moved));
    if (ritz_dense_max(&moved.Delta) == 0.0 && ritz_dense_max(&moved.Cv) == 0.0)
        RITZ_TRY(by_squares(&moved, out));
    else
        RITZ_TRY(by_states(&moved, out));
done:
    free(rows);
    ritz_first_order_free(&moved);
    return status;
}
