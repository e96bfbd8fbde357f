/* Gramians of large sparse components by low-rank ADI. */
#ifndef RITZ_GRAMIANS_LOW_RANK_H
#define RITZ_GRAMIANS_LOW_RANK_H

#include <ritz/basis.h>

/**
 * Factors of both Gramians from sparse M, D, K; first-order matrices are never
 * formed. Rigid modes are split off, dofs without mass are condensed
 * statically.
 *
 * @return RITZ_ERR_ARGUMENT if damping is no sparse matrix (ratios of modes,
 *         K4), there is none, it couples rigid motion to others or acts on
 *         dofs without mass; RITZ_ERR_CONVERGENCE if the Gramians have no low
 *         rank
 * @cost   a complex factor a shift, some 20 to 200 shifts; three factors of
 *         2 n x k numbers
 */
ritz_status ritz_gramians_low_rank(const ritz_gramians_request *request,
                                   ritz_gramians *out);

#endif
