/*
 * Normal modes and static Ritz vectors [ChuMilman1992]: the lowest modes, rigid
 * ones first, and for each load f what they lack of its static answer,
 *
 *     psi = K^-1 f - Phi Lambda^-1 Phi' f,
 *
 * for a free body that of the flexible part, under inertia relief. A damper
 * acts where the modes that were left out move too: without its vector, the
 * damping it gives is wrong even where frequencies are right.
 *
 * psi is M-orthogonal to Phi as equation (12) there demands, but keeps the
 * scale of a unit load.
 */
#include "bases/free_modes.h"
#include "bases/loads.h"

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    const int usual = RITZ_LOADS_INPUTS | RITZ_LOADS_DAMPERS;
    bool asked = request->choice.given & RITZ_USES_LOADS;
    int loads = asked ? request->choice.loads : usual;
    ritz_dense F = {0};
    int64_t *dof = NULL;

    if (asked && ritz_loads_count(request, loads) == 0)
        RITZ_CHECK(ritz_loads_collect(request, loads, &F, &dof)); /* says why */
    return ritz_free_basis(request, loads, RITZ_COLUMN_STATIC, out);
}

const ritz_method ritz_method_normal_modes = {
    .name = "normal-modes",
    .summary = "modes, and a static Ritz vector for each input and damper",
    .reference = "ChuMilman1992",
    .when = "one structure with its loads, dampers to be tuned",
    .cost = "a factor, two solves a mode, 3 to 10 a load",
    .holds = "kept modes, flexible static gain of its loads",
    .fails = "interfaces: what other bodies push on is not answered",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS,
    .make = make,
};
