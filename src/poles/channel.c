/*
 * A channel of a second-order model. An output that is a derivative as a whole
 * is taken without it.
 */
#include "poles/channel.h"

#include "poles/channel_modes.h"

#include <string.h>

static ritz_status one_row(const ritz_dense *A, int64_t row, ritz_dense *out)
{
    ritz_dense_free(out);
    return ritz_dense_rows(A, 1, &row, out);
}

/* One channel as an io of its own, or all of it. */
static ritz_status cut(const ritz_io *io, int64_t output, int64_t input,
                       ritz_io *out)
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
        RITZ_CHECK(one_row(from[k], output, parts[k]));
    return RITZ_OK;
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
    RITZ_TRY(ritz_channel_of_modes(&modes, &structure.D, &io, single, &made));
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
