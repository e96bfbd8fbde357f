/* A channel of a second-order model by its modes. */
#ifndef RITZ_POLES_CHANNEL_MODES_H
#define RITZ_POLES_CHANNEL_MODES_H

#include "model/modal.h"
#include "poles/channel.h"

/* Modes of one channel as they are summed, c + s cv over s^2 + rate s +
   lambda; modes with equal poles are one row, their participation summed.
   The rounding error of each number is in `doubt_`. */
typedef struct ritz_channel_row {
    double lambda, rate, c, cv;
    double doubt_rate, doubt_c, doubt_cv;
} ritz_channel_row;

/**
 * Modes that are controllable and observable beyond rounding.
 *
 * @param[in]  D     that Delta was projected from; {0}: none
 * @param[in]  io    of one input and one output
 * @param[out] out   as many as there are modes, to be freed by the caller
 * @param[out] count of them that count; -1: damping couples modes
 */
ritz_status ritz_channel_rows(const ritz_modal_model *modes,
                              const ritz_dense *D, const ritz_io *io,
                              int64_t *count, ritz_channel_row **out);

/**
 * The model without the free rigid motions that are not controllable or not
 * observable.
 *
 * @param[in] D   that Delta was projected from; {0}: none
 * @param[in] io  any inputs and outputs
 */
ritz_status ritz_channel_moved(const ritz_modal_model *modes,
                               const ritz_dense *D, const ritz_io *io,
                               ritz_modal_model *out);

#endif
