/* Weights applied. */
#ifndef RITZ_RANKING_WEIGHTS_H
#define RITZ_RANKING_WEIGHTS_H

#include <ritz/ranking.h>

/**
 * Scale inputs by the root of their weight, and put limits where output weights
 * replace them: Q = 1 / limit^2.
 *
 * @return RITZ_ERR_ARGUMENT if a weight names nothing
 */
ritz_status ritz_weights_apply(const ritz_weights *weights, ritz_io *io);

#endif
