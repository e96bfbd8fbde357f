/* Effective masses, of which two rankings are made. */
#ifndef RITZ_RANKING_MASS_H
#define RITZ_RANKING_MASS_H

#include <ritz/ranking.h>

enum { RITZ_MASS_PARTS = 6 };

/** Effective masses in six directions as the parts of a ranking. */
ritz_status ritz_mass_parts(const ritz_rank_request *request,
                            ritz_ranking *ranking);

#endif
