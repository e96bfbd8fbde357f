/* The table of rankings: a new one is a file with a descriptor, and a row. */
#include <ritz/ranking.h>

const ritz_ranker *const ritz_rankers[] = {
    &ritz_ranker_gregory,
    &ritz_ranker_hankel,
    &ritz_ranker_hankel_band,
    &ritz_ranker_modal_cost,
    &ritz_ranker_h2,
    &ritz_ranker_effective_mass,
    &ritz_ranker_effective_interface_mass,
    &ritz_ranker_participation,
    NULL,
};
