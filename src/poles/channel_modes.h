/* A channel of a second-order model by its modes. */
#ifndef RITZ_POLES_CHANNEL_MODES_H
#define RITZ_POLES_CHANNEL_MODES_H

#include "model/first_order.h"
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
ritz_status ritz_channel_rows(const ritz_first_order *modes,
                              const ritz_dense *D, const ritz_io *io,
                              int64_t *count, ritz_channel_row **out);

/** a'phi_k of every mode, and what rounding may make of it; added to what is
 * there. */
void ritz_channel_see(const ritz_first_order *modes, const double *a,
                      double *value, double *doubt);

/** What rounding of K and M may bring of mode j into mode k. */
double ritz_channel_mixing(const ritz_first_order *modes, int64_t j, int64_t k);

/**
 * Without the free rigid motions that no input drives or no output sees.
 *
 * @param[in] D   that Delta was projected from; {0}: none
 * @param[in] io  any inputs and outputs
 */
ritz_status ritz_channel_moved(const ritz_first_order *modes,
                               const ritz_dense *D, const ritz_io *io,
                               ritz_first_order *out);

/** @param[in] single  whether @p io is of one input and one output */
ritz_status ritz_channel_of_modes(const ritz_first_order *modes,
                                  const ritz_dense *D, const ritz_io *io,
                                  bool single, ritz_channel *out);

#endif
