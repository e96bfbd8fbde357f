/*
 * MacNeal-Rubin reduction: free-interface modes and residual attachment modes.
 *
 * Keep the rigid modes Phi_r and the lowest flexible ones Phi_f of (K, M), and
 * add what the modes that are left out answer to unit forces F at the attached
 * dofs [LeeTsuha1992, eq. 6]:
 *
 *     Psi = (P' S P - Phi_f Lambda_f^-1 Phi_f') F,    P = I - M Phi_r Phi_r'
 *
 * S is the pseudo-flexibility of any determinate support, of which Psi is
 * independent: residual.c finds it without one. Psi is M- and K-orthogonal to
 * the kept modes, so that T'KT and T'MT are block diagonal, and the flexible
 * static gain at the attached dofs is exact.
 * tests/unit/bases/test_macneal_rubin.c holds the code to the printed formula
 * with three supports.
 */
#include "bases/free_modes.h"

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    return ritz_free_basis(request, RITZ_LOADS_ATTACHED, RITZ_COLUMN_RESIDUAL,
                           out);
}

const ritz_method ritz_method_macneal_rubin = {
    .name = "macneal-rubin",
    .summary = "rigid, free-interface and residual attachment modes",
    .reference = "LeeTsuha1992",
    .when = "free components, few attached dofs, articulated systems",
    .cost = "a factor, two solves a mode, 3 to 10 an attached dof",
    .holds = "kept modes, flexible static gain, rigid motion; from above",
    .fails = "attached dofs that depend on each other: left out, and named",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = make,
};
