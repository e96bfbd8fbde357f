/*
 * Dual Craig-Bampton [Rixen2004]: the columns of macneal_rubin.c, of which the
 * residual ones stand for forces at the interface. A body alone is the same as
 * by macneal-rubin; synthesis/dual.c joins such bodies by forces instead of by
 * displacements.
 */
#include "bases/free_modes.h"

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    return ritz_free_basis(request, RITZ_LOADS_ATTACHED, RITZ_COLUMN_FORCE,
                           out);
}

const ritz_method ritz_method_dual_craig_bampton = {
    .name = "dual-craig-bampton",
    .summary = "macneal-rubin joined by interface forces: can be unstable",
    .reference = "Rixen2004",
    .when = "to compare with; forces join bodies instead of motions",
    .cost = "as macneal-rubin",
    .holds = "nothing: interfaces are met weakly",
    .fails = "systems have a negative eigenvalue for each interface force",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = make,
};
