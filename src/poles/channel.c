/* A channel of a first-order model. */
#include "poles/channel.h"

#include "base/alloc.h"
#include "linear/frame.h"
#include "poles/channel_modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Whether there is such a channel, or all at once can be asked for. */
static ritz_status channel_check(int64_t outputs, int64_t inputs,
                                 int64_t output, int64_t input)
{
    if (output == RITZ_ALL_CHANNELS && input == RITZ_ALL_CHANNELS) {
        RITZ_REFUSE_IF(
            outputs != inputs || outputs == 0, RITZ_ERR_ARGUMENT,
            "zeros of all channels at once are of as many outputs as "
            "inputs, not of %lld and %lld",
            (long long)outputs, (long long)inputs);
        return RITZ_OK;
    }
    RITZ_REFUSE_IF(output < 0 || output >= outputs, RITZ_ERR_ARGUMENT,
                   "there is no output %lld, there are %lld",
                   (long long)output + 1, (long long)outputs);
    RITZ_REFUSE_IF(input < 0 || input >= inputs, RITZ_ERR_ARGUMENT,
                   "there is no input %lld, there are %lld",
                   (long long)input + 1, (long long)inputs);
    return RITZ_OK;
}

ritz_status ritz_channel_states(const ritz_state_space *model, int64_t output,
                                int64_t input, ritz_channel *out)
{
    RITZ_OWN(ritz_channel) all = {0}, made = {0};

    RITZ_CHECK(
        channel_check(model->num_outputs, model->num_inputs, output, input));
    RITZ_CHECK(ritz_frame_system(&model->A, &model->E, &model->B, &model->C,
                                 &all.A, &all.B, &all.C));
    RITZ_CHECK(ritz_dense_copy(&model->D, &all.D));
    if (output == RITZ_ALL_CHANNELS) {
        RITZ_MOVE(*out, all);
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_dense_columns(&all.B, input, 1, &made.B));
    RITZ_CHECK(ritz_dense_rows(&all.C, 1, &output, &made.C));
    RITZ_CHECK(ritz_dense_new(1, 1, &made.D));
    made.D.val[0] = ritz_dense_col(&all.D, input)[output];
    made.A = all.A;
    all.A = (ritz_dense){0};
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* A = -Lambda, or blocks of two. */
static ritz_status fill_decoupled(int64_t m, const ritz_channel_row *rows,
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
        double w = ritz_modal_scale(r->lambda);

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

static ritz_status channel_of_rows(int64_t count, const ritz_channel_row *rows,
                                   double feed, ritz_channel *out)
{
    bool squared = true;

    for (int64_t k = 0; k < count; k++)
        squared = squared && rows[k].rate == 0.0 && rows[k].cv == 0.0;
    return fill_decoupled(count, rows, squared, feed, out);
}

/* A model whose damping couples modes, or of several inputs and outputs. */
static ritz_status channel_of_coupled(const ritz_modal_model *f,
                                      ritz_channel *out)
{
    RITZ_CHECK(ritz_modal_states(f, &(ritz_modal_layout){0}, &out->A, &out->B,
                                 &out->C));
    return ritz_dense_copy(&f->feed, &out->D);
}

/* x'' = A x + B u of an undamped model, several outputs and inputs. */
static ritz_status channel_of_undamped(const ritz_modal_model *f,
                                       ritz_channel *out)
{
    out->squared = true;
    RITZ_CHECK(ritz_dense_new(f->count, f->count, &out->A));
    for (int64_t k = 0; k < f->count; k++)
        ritz_dense_col(&out->A, k)[k] = -f->lambda[k];
    RITZ_CHECK(ritz_dense_copy(&f->B, &out->B));
    RITZ_CHECK(ritz_dense_copy(&f->C, &out->C));
    return ritz_dense_copy(&f->feed, &out->D);
}

/* @param[in] single  whether @p io is of one input and one output */
static ritz_status channel_of_modes(const ritz_modal_model *modes,
                                    const ritz_dense *D, const ritz_io *io,
                                    bool single, ritz_channel *out)
{
    RITZ_OWN_ARRAY ritz_channel_row *rows = NULL;
    RITZ_OWN(ritz_modal_model) moved = {0};
    int64_t count = -1;

    if (single)
        RITZ_CHECK(ritz_channel_rows(modes, D, io, &count, &rows));
    if (count >= 0) {
        RITZ_CHECK(channel_of_rows(count, rows, modes->feed.val[0], out));
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_channel_moved(modes, D, io, &moved));
    if (ritz_dense_max(&moved.Delta) == 0.0 && ritz_dense_max(&moved.Cv) == 0.0)
        RITZ_CHECK(channel_of_undamped(&moved, out));
    else
        RITZ_CHECK(channel_of_coupled(&moved, out));
    return RITZ_OK;
}

/*
 * A channel of a second-order model. An output that is a derivative as a whole
 * is taken without it.
 */

static ritz_status take_row(const ritz_dense *A, int64_t row, ritz_dense *out)
{
    ritz_dense_free(out);
    return ritz_dense_rows(A, 1, &row, out);
}

/* One channel as an io of its own, or all of it. */
static ritz_status take_channel(const ritz_io *io, int64_t output,
                                int64_t input, ritz_io *out)
{
    ritz_dense *parts[] = {&out->C, &out->Cv, &out->Ca};
    const ritz_dense *from[] = {&io->C, &io->Cv, &io->Ca};

    if (output == RITZ_ALL_CHANNELS) {
        RITZ_CHECK(
            ritz_io_new(io->B.nrow, io->num_inputs, io->num_outputs, out));
        memcpy(out->B.val, io->B.val,
               (size_t)(io->B.nrow * io->B.ncol) * sizeof *io->B.val);
        for (int k = 0; k < 3; k++)
            memcpy(parts[k]->val, from[k]->val,
                   (size_t)(from[k]->nrow * from[k]->ncol) *
                       sizeof *from[k]->val);
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_io_new(io->B.nrow, 1, 1, out));
    ritz_dense_free(&out->B);
    RITZ_CHECK(ritz_dense_columns(&io->B, input, 1, &out->B));
    for (int k = 0; k < 3; k++)
        RITZ_CHECK(take_row(from[k], output, parts[k]));
    return RITZ_OK;
}

/* An output that is a velocity alone, or an acceleration alone, is replaced
   by the displacement; the number of derivatives taken away. */
static int64_t integrate_outputs(ritz_io *io)
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

ritz_status ritz_channel_dense(const ritz_second_order *model,
                               const ritz_damping *damping, int64_t output,
                               int64_t input, ritz_channel *out)
{
    static const ritz_damping none = {0};
    ritz_structure structure = {*model->K, *model->M, {0}};
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_channel) made = {0};
    RITZ_OWN(ritz_io) io = {0};
    bool single = output != RITZ_ALL_CHANNELS;

    RITZ_CHECK(channel_check(model->io->num_outputs, model->io->num_inputs,
                             output, input));
    RITZ_REFUSE_IF(model->K4 && model->K4->val, RITZ_ERR_ARGUMENT,
                   "structural damping is of harmonic motion and has no zeros, "
                   "give it as a modal ratio");
    if (model->D)
        structure.D = *model->D;
    RITZ_CHECK(take_channel(model->io, output, input, &io));
    if (single)
        made.derivative = integrate_outputs(&io);
    RITZ_CHECK(ritz_modal_model_new(&structure, &io, damping ? damping : &none,
                                    &modes));
    RITZ_CHECK(channel_of_modes(&modes, &structure.D, &io, single, &made));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

void ritz_channel_free(ritz_channel *channel)
{
    ritz_dense_free(&channel->A);
    ritz_dense_free(&channel->B);
    ritz_dense_free(&channel->C);
    ritz_dense_free(&channel->D);
    *channel = (ritz_channel){0};
}
