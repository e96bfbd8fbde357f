/* Residual modes: what the modes left out answer to forces. */
#ifndef RITZ_BASES_RESIDUAL_H
#define RITZ_BASES_RESIDUAL_H

#include <ritz/eigen.h>
#include <ritz/method.h>

/**
 * @param[in]  request  component and tolerance
 * @param[in]  modes    those that are kept, rigid ones first
 * @param[in]  F        n x p, loads; unit forces at the attached dofs, say
 * @param[out] Psi      n x p, M- and K-orthogonal to the kept modes
 * @param[out] keep     one for each column: false where it depends on others or
 *                      is nothing beside the kept modes
 * @return RITZ_ERR_CONVERGENCE, RITZ_ERR_SINGULAR
 * @cost   one factor, 3 to 10 solves a column
 */
ritz_status ritz_residual_modes(const ritz_request *request,
                                const ritz_pairs *modes, const ritz_dense *F,
                                ritz_dense *Psi, bool *keep);

#endif
