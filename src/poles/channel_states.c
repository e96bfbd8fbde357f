/* A channel of a first-order model. */
#include "poles/channel.h"

#include "linear/frame.h"
#include "linear/general.h"

ritz_status ritz_channel_check(int64_t outputs, int64_t inputs, int64_t output,
                               int64_t input)
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

/* In coordinates of the library's own scaling, E divided out. */
static ritz_status settle(const ritz_state_space *model, ritz_channel *out)
{
    ritz_status status = RITZ_OK;
    ritz_frame frame = {0};
    ritz_dense one = {0}, back = {0};

    RITZ_TRY(ritz_frame_new(&model->A, &model->E, &frame));
    RITZ_TRY(ritz_dense_copy(&frame.A, &out->A));
    RITZ_TRY(ritz_frame_forward(&frame, frame.left, &model->B, &out->B));
    RITZ_TRY(ritz_general_transpose(&model->C, &one));
    RITZ_TRY(ritz_frame_forward(&frame, frame.right, &one, &back));
    RITZ_TRY(ritz_general_transpose(&back, &out->C));
    RITZ_TRY(ritz_dense_copy(&model->D, &out->D));
    if (frame.E.val && model->A.nrow > 0) {
        RITZ_TRY_IN("E", ritz_general_solve(&frame.E, false, &out->A));
        RITZ_TRY_IN("E", ritz_general_solve(&frame.E, false, &out->B));
    }
done:
    ritz_frame_free(&frame);
    ritz_dense_free(&one);
    ritz_dense_free(&back);
    return status;
}

ritz_status ritz_channel_states(const ritz_state_space *model, int64_t output,
                                int64_t input, ritz_channel *out)
{
    ritz_status status = RITZ_OK;
    ritz_channel all = {0}, made = {0};

    RITZ_TRY(ritz_channel_check(model->num_outputs, model->num_inputs, output,
                                input));
    RITZ_TRY(settle(model, &all));
    if (output == RITZ_ALL_CHANNELS) {
        *out = all;
        all = (ritz_channel){0};
        goto done;
    }
    RITZ_TRY(ritz_dense_columns(&all.B, input, 1, &made.B));
    RITZ_TRY(ritz_dense_rows(&all.C, 1, &output, &made.C));
    RITZ_TRY(ritz_dense_new(1, 1, &made.D));
    made.D.val[0] = ritz_dense_col(&all.D, input)[output];
    made.A = all.A;
    all.A = (ritz_dense){0};
    *out = made;
    made = (ritz_channel){0};
done:
    ritz_channel_free(&all);
    ritz_channel_free(&made);
    return status;
}
