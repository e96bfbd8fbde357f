/*
 * MacNeal's reduction [MacNeal1971]: free-interface modes beside residual
 * flexibility without mass. With T = [Phi, Psi] of macneal_rubin.c
 *
 *     K_r = diag(Lambda, F'Psi),   M_r = diag(I, 0)
 *
 * The residual columns are of kind massless, of which ritz_reduce leaves out
 * mass and damping.
 */
#include "bases/free_modes.h"

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    return ritz_free_basis(request, RITZ_LOADS_ATTACHED, RITZ_COLUMN_MASSLESS,
                           out);
}

const ritz_method ritz_method_macneal = {
    .name = "macneal",
    .summary = "free-interface modes, residual flexibility without mass",
    .reference = "MacNeal1971",
    .when = "free-interface results of codes that leave this mass out",
    .cost = "as macneal-rubin",
    .holds = "flexible static gain; kept modes",
    .fails = "frequencies need not come from above; M is singular",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = make,
};
