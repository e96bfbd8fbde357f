/*
 * A channel of a second-order model, by its modes: with W = |Lambda|^1/2, or 1
 * where Lambda is 0,
 *
 *     x = [W p; p'],   x' = [ 0          W     ] x + [ 0      ] u
 *                           [ -Lambda/W  -Delta ]    [ Phi'B ]
 *
 * which holds slow poles apart from fast ones. Without damping
 * p'' = -Lambda p + Phi'B u stands for itself. An output that is a derivative
 * as a whole is taken without it.
 */
#include "verify/channel.h"

#include "base/alloc.h"
#include "model/first_order.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of what a sum is made of: what the modes of a symmetric structure leave of a
   product that is zero; measured, 1e-13 of 200 modes. */
static const double unseen = 1e-11;
/* Off-diagonal damping that stands for none. */
static const double uncoupled_within = 1e-10;

static ritz_status one_row(const ritz_dense *A, int64_t row, ritz_dense *out)
{
    ritz_dense_free(out);
    return ritz_dense_rows(A, 1, &row, out);
}

/* One channel as an io of its own, or all of it. */
static ritz_status cut(const ritz_io *io, int64_t output, int64_t input,
                       ritz_io *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense *parts[] = {&out->C, &out->Cv, &out->Ca};
    const ritz_dense *from[] = {&io->C, &io->Cv, &io->Ca};

    if (output == RITZ_ALL_CHANNELS) {
        RITZ_TRY(ritz_io_new(io->B.nrow, io->num_inputs, io->num_outputs, out));
        memcpy(out->B.val, io->B.val,
               (size_t)(io->B.nrow * io->B.ncol) * sizeof *io->B.val);
        for (int k = 0; k < 3; k++)
            memcpy(parts[k]->val, from[k]->val,
                   (size_t)(from[k]->nrow * from[k]->ncol) *
                       sizeof *from[k]->val);
        goto done;
    }
    RITZ_TRY(ritz_io_new(io->B.nrow, 1, 1, out));
    ritz_dense_free(&out->B);
    RITZ_TRY(ritz_dense_columns(&io->B, input, 1, &out->B));
    for (int k = 0; k < 3; k++)
        RITZ_TRY(one_row(from[k], output, parts[k]));
done:
    return status;
}

/* Of a velocity alone, or an acceleration, the displacement; how many
   derivatives that was. */
static int64_t integrate(ritz_io *io)
{
    ritz_dense *kind[] = {&io->C, &io->Cv, &io->Ca};
    ritz_dense kept = {0};
    int64_t only = -1;
    int kinds = 0;

    for (int k = 0; k < 3; k++)
        if (ritz_dense_max(kind[k]) > 0.0) {
            only = k;
            kinds++;
        }
    if (kinds != 1 || only == 0)
        return 0;
    kept = *kind[only];
    *kind[only] = io->C;
    io->C = kept;
    return only;
}

static bool is_coupled(const ritz_dense *Delta)
{
    for (int64_t j = 0; j < Delta->ncol; j++)
        for (int64_t i = 0; i < Delta->nrow; i++)
            if (i != j &&
                fabs(ritz_dense_col(Delta, j)[i]) >
                    uncoupled_within * sqrt(fabs(ritz_dense_col(Delta, i)[i] *
                                                 ritz_dense_col(Delta, j)[j])))
                return true;
    return false;
}

/* Modes of one channel as they are summed. */
typedef struct row {
    double lambda, rate, b, c, cv;
} row;

/* Share of a mode in sum |A_i||Phi_i|, which is what its rounding is of. */
static double terms(const double *A, int64_t stride, const ritz_dense *Phi,
                    int64_t k)
{
    const double *phi = ritz_dense_col(Phi, k);
    double sum = 0.0;

    for (int64_t i = 0; i < Phi->nrow; i++)
        sum += fabs(A[i * stride] * phi[i]);
    return sum;
}

static double unless_rounding(double value, double size)
{
    return fabs(value) <= unseen * size ? 0.0 : value;
}

/* Modes that are driven and seen; of equal poles one, with the share of all. */
static int64_t collect(const ritz_first_order *m, const ritz_io *io, row *out)
{
    int64_t count = 0;
    double highest = m->count > 0 ? fabs(m->lambda[m->count - 1]) : 0.0;
    double same = (double)m->num_dofs * DBL_EPSILON * highest;

    for (int64_t k = 0; k < m->count; k++) {
        double l = m->lambda[k];
        double size = terms(io->C.val, 1, &m->Phi, k) +
                      fabs(l) * terms(io->Ca.val, 1, &m->Phi, k);
        double size_v =
            terms(io->Cv.val, 1, &m->Phi, k) +
            ritz_dense_col(&m->Delta, k)[k] * terms(io->Ca.val, 1, &m->Phi, k);
        row r = {
            .lambda = l,
            .rate = ritz_dense_col(&m->Delta, k)[k],
            .b = unless_rounding(m->B.val[k], terms(io->B.val, 1, &m->Phi, k)),
            .c = unless_rounding(m->C.val[k], size),
            .cv = unless_rounding(m->Cv.val[k], size_v)};
        row *last = count > 0 ? &out[count - 1] : NULL;

        if (r.b == 0.0 || (r.c == 0.0 && r.cv == 0.0))
            continue;
        r.c *= r.b;
        r.cv *= r.b;
        r.b = 1.0;
        if (last && r.lambda - last->lambda <= same &&
            fabs(r.rate - last->rate) <=
                uncoupled_within * (fabs(r.rate) + fabs(last->rate))) {
            last->c += r.c;
            last->cv += r.cv;
        } else {
            out[count++] = r;
        }
    }
    return count;
}

/* Parts of equal poles may have cancelled each other. */
static int64_t drop_silent(int64_t count, row *rows)
{
    int64_t kept = 0;
    double most = 0.0;

    for (int64_t k = 0; k < count; k++)
        most = fmax(most, fmax(fabs(rows[k].c), fabs(rows[k].cv)));
    for (int64_t k = 0; k < count; k++)
        if (fmax(fabs(rows[k].c), fabs(rows[k].cv)) > DBL_EPSILON * most)
            rows[kept++] = rows[k];
    return kept;
}

static double weight(double lambda)
{
    return lambda != 0.0 ? sqrt(fabs(lambda)) : 1.0;
}

/* A = -Lambda, or blocks of two. */
static ritz_status fill_apart(int64_t m, const row *rows, bool squared,
                              double feed, ritz_channel *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = squared ? m : 2 * m;

    out->squared = squared;
    out->blocks = !squared;
    RITZ_TRY(ritz_dense_new(n, n, &out->A));
    RITZ_TRY(ritz_dense_new(n, 1, &out->B));
    RITZ_TRY(ritz_dense_new(1, n, &out->C));
    RITZ_TRY(ritz_dense_new(1, 1, &out->D));
    out->D.val[0] = feed;
    for (int64_t k = 0; k < m; k++) {
        const row *r = &rows[k];
        double w = weight(r->lambda);

        out->B.val[n - m + k] = r->b;
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
done:
    return status;
}

static ritz_status by_rows(const ritz_first_order *modes, const ritz_io *io,
                           ritz_channel *out)
{
    ritz_status status = RITZ_OK;
    row *rows = NULL;
    int64_t count = 0;
    bool squared = true;

    RITZ_NEW(rows, modes->count);
    count = drop_silent(collect(modes, io, rows), rows);
    for (int64_t k = 0; k < count; k++)
        squared = squared && rows[k].rate == 0.0 && rows[k].cv == 0.0;
    RITZ_TRY(fill_apart(count, rows, squared, modes->feed.val[0], out));
done:
    free(rows);
    return status;
}

/* All of it, in the same coordinates. */
static ritz_status by_states(const ritz_first_order *f, ritz_channel *out)
{
    ritz_status status = RITZ_OK;
    int64_t m = f->count;

    RITZ_TRY(ritz_dense_new(2 * m, 2 * m, &out->A));
    RITZ_TRY(ritz_dense_new(2 * m, f->B.ncol, &out->B));
    RITZ_TRY(ritz_dense_new(f->C.nrow, 2 * m, &out->C));
    RITZ_TRY(ritz_dense_copy(&f->feed, &out->D));
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
done:
    return status;
}

/* The same without damping, of several outputs and inputs. */
static ritz_status by_squares(const ritz_first_order *f, ritz_channel *out)
{
    ritz_status status = RITZ_OK;

    out->squared = true;
    RITZ_TRY(ritz_dense_new(f->count, f->count, &out->A));
    for (int64_t k = 0; k < f->count; k++)
        ritz_dense_col(&out->A, k)[k] = -f->lambda[k];
    RITZ_TRY(ritz_dense_copy(&f->B, &out->B));
    RITZ_TRY(ritz_dense_copy(&f->C, &out->C));
    RITZ_TRY(ritz_dense_copy(&f->feed, &out->D));
done:
    return status;
}

ritz_status ritz_channel_dense(const ritz_second_order *model,
                               const ritz_damping *damping, int64_t output,
                               int64_t input, ritz_channel *out)
{
    static const ritz_damping none = {0};
    ritz_status status = RITZ_OK;
    ritz_structure structure = {*model->K, *model->M, {0}};
    ritz_first_order modes = {0};
    ritz_channel made = {0};
    ritz_io io = {0};
    bool single = output != RITZ_ALL_CHANNELS;

    RITZ_TRY(ritz_channel_check(model->io->num_outputs, model->io->num_inputs,
                                output, input));
    RITZ_FAIL_IF(model->K4 && model->K4->val, RITZ_ERR_ARGUMENT,
                 "structural damping is of harmonic motion and has no zeros, "
                 "give it as a modal ratio");
    if (model->D)
        structure.D = *model->D;
    RITZ_TRY(cut(model->io, output, input, &io));
    if (single)
        made.derivative = integrate(&io);
    RITZ_TRY(ritz_first_order_new(&structure, &io, damping ? damping : &none,
                                  &modes));
    if (single && !is_coupled(&modes.Delta))
        RITZ_TRY(by_rows(&modes, &io, &made));
    else if (ritz_dense_max(&modes.Delta) == 0.0 &&
             ritz_dense_max(&modes.Cv) == 0.0)
        RITZ_TRY(by_squares(&modes, &made));
    else
        RITZ_TRY(by_states(&modes, &made));
    *out = made;
    made = (ritz_channel){0};
done:
    ritz_first_order_free(&modes);
    ritz_channel_free(&made);
    ritz_io_free(&io);
    return status;
}

void ritz_channel_free(ritz_channel *channel)
{
    ritz_dense_free(&channel->A);
    ritz_dense_free(&channel->B);
    ritz_dense_free(&channel->C);
    ritz_dense_free(&channel->D);
    *channel = (ritz_channel){0};
}
