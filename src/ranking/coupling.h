/* How far modes are from being apart. */
#ifndef RITZ_RANKING_COUPLING_H
#define RITZ_RANKING_COUPLING_H

#include <ritz/ranking.h>

/**
 * The largest normalised off-diagonal |W_ab| / sqrt(W_aa W_bb) of both exact
 * Gramians, but within clusters, which are ranked whole.
 */
ritz_status ritz_ranking_coupling(const ritz_modal *modal,
                                  ritz_ranking *ranking);

#endif
