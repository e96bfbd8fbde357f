/*
 * The transfer function whose zeros are sought: some inputs and outputs of
 *
 *     x' = A x + B u,    y = C x + D u
 *
 * or, if `squared`, of x'' = A x + B u, whose eigenvalues and zeros are s^2.
 */
#ifndef RITZ_POLES_CHANNEL_H
#define RITZ_POLES_CHANNEL_H

#include <ritz/model.h>
#include <ritz/poles.h>
#include <ritz/response.h>

#include <complex.h>

typedef struct ritz_channel {
    ritz_dense A, B, C, D;
    bool squared;       /* then A is diagonal */
    bool blocks;        /* A is [0 w; -l/w -d] of pairs of states k, k + n/2 */
    int64_t derivative; /* y is that derivative of what is above: so many zeros
                           at 0, but where poles are */
} ritz_channel;

ritz_status ritz_channel_dense(const ritz_second_order *model,
                               const ritz_damping *damping, int64_t output,
                               int64_t input, ritz_channel *out);
ritz_status ritz_channel_states(const ritz_state_space *model, int64_t output,
                                int64_t input, ritz_channel *out);

void ritz_channel_free(ritz_channel *channel);

#endif
