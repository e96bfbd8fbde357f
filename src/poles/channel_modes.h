/* A channel of a second-order model by its modes. */
#ifndef RITZ_POLES_CHANNEL_MODES_H
#define RITZ_POLES_CHANNEL_MODES_H

#include "model/modal.h"
#include "poles/channel.h"

/* Modes of one channel as they are summed, c + s cv over s^2 + rate s + lambda;
   of equal poles one, with the share of all. What rounding may make of each
   stands beside it. */
typedef struct ritz_channel_row {
    double lambda, rate, c, cv;
    double doubt_rate, doubt_c, doubt_cv;
} ritz_channel_row;

/**
 * Modes that are driven and seen beyond rounding.
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
 * Without the free rigid motions that no input drives or no output sees.
 *
 * @param[in] D   that Delta was projected from; {0}: none
 * @param[in] io  any inputs and outputs
 */
ritz_status ritz_channel_moved(const ritz_modal_model *modes,
                               const ritz_dense *D, const ritz_io *io,
                               ritz_modal_model *out);

#endif
