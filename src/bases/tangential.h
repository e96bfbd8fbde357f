/* Tangential interpolation, with the points at which it interpolates. */
#ifndef RITZ_BASES_TANGENTIAL_H
#define RITZ_BASES_TANGENTIAL_H

#include "bases/rational.h"

/**
 * The basis of the method `tangential`.
 *
 * @param[out] probes  the responses in its span: at each point s, in direction
 *                     b of a group of loads; may be NULL
 */
ritz_status ritz_tangential_find(const ritz_request *request, ritz_basis *out,
                                 ritz_probes *probes);

#endif
