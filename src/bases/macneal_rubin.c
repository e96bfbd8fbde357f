/*
 * MacNeal-Rubin reduction: free-interface modes and residual attachment modes.
 *
 * Keep the rigid modes Phi_r and the lowest flexible ones Phi_f of (K, M), and
 * add the static response of the modes that are left out to unit forces F at
 * the attached dofs [LeeTsuha1992, eq. 6]:
 *
 *     Psi = (P' S P - Phi_f Lambda_f^-1 Phi_f') F,    P = I - M Phi_r Phi_r'
 *
 * S is the pseudo-flexibility of any determinate support, of which Psi is
 * independent: free_modes.c finds it without one. Psi is M- and K-orthogonal to
 * the kept modes, so that T'KT and T'MT are block diagonal, and the flexible
 * static gain at the attached dofs is exact.
 * tests/unit/bases/test_macneal_rubin.c holds the code to the printed formula
 * with three supports.
 */
#include "bases/free_modes.h"

#include "bases/loads.h"

static ritz_status make_macneal_rubin(const ritz_request *request,
                                      ritz_basis *out)
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
    .make = make_macneal_rubin,
};

/*
 * MacNeal's reduction [MacNeal1971]: free-interface modes and residual
 * flexibility without mass. With T = [Phi, Psi] as above
 *
 *     K_r = diag(Lambda, F'Psi),   M_r = diag(I, 0)
 *
 * The residual columns are of kind massless, of which ritz_reduce leaves out
 * mass and damping.
 */

static ritz_status make_macneal(const ritz_request *request, ritz_basis *out)
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
    .make = make_macneal,
};

/*
 * Free-interface modes and inertia-relief attachment modes: the static response
 * to unit forces F at the attached dofs, in equilibrium with the inertia forces
 * of rigid motion,
 *
 *     X = P' S P F,    P = I - M Phi_r Phi_r'    [CraigChang1977]
 *
 * which is Psi as above plus the part of the kept flexible modes,
 *
 *     X = Psi + Phi_f Lambda_f^-1 Phi_f' F,
 *
 * so that both span the same. A column whose Psi is negligible is left out.
 */

/* Psi := X; columns of T are scaled like those that they replace. */
static ritz_status add_modes(ritz_free_set *set)
{
    const ritz_pairs *modes = &set->modes;
    RITZ_OWN(ritz_dense) q = {0}, part = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&modes->Phi, &set->F, &q));
    for (int64_t j = 0; j < q.ncol; j++)
        for (int64_t k = 0; k < q.nrow; k++)
            ritz_dense_col(&q, j)[k] *=
                k < modes->num_rigid ? 0.0 : 1.0 / modes->lambda[k];
    RITZ_CHECK(ritz_dense_mul(&modes->Phi, &q, &part));
    ritz_dense_add(1.0, &part, &set->Psi);
    return RITZ_OK;
}

static ritz_status make_inertia_relief(const ritz_request *request,
                                       ritz_basis *out)
{
    RITZ_OWN(ritz_free_set) set = {0};

    RITZ_CHECK(ritz_free_set_find(request, RITZ_LOADS_ATTACHED, &set));
    if (set.Psi.ncol > 0)
        RITZ_CHECK(add_modes(&set));
    return ritz_free_set_join(request, &set, RITZ_COLUMN_ATTACHMENT, out);
}

const ritz_method ritz_method_inertia_relief = {
    .name = "inertia-relief",
    .summary = "rigid, free-interface and inertia-relief attachment modes",
    .reference = "CraigChang1977",
    .when = "as macneal-rubin, columns as older papers have them",
    .cost = "as macneal-rubin",
    .holds = "spans what macneal-rubin spans",
    .fails = "columns that are nearly parallel once many modes are kept",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .make = make_inertia_relief,
};

/*
 * Dual Craig-Bampton [Rixen2004]: the columns of macneal-rubin, whose residual
 * coordinates represent interface forces. A single body is the same as by
 * macneal-rubin; assembly/dual.c joins such bodies by forces instead of by
 * displacements.
 */

static ritz_status make_dual(const ritz_request *request, ritz_basis *out)
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
    .only_named = RITZ_NAMED_FOR_COMPONENTS | RITZ_NAMED_FOR_SCENES,
    .make = make_dual,
};

/*
 * Normal modes and static Ritz vectors [ChuMilman1992]: the lowest modes, rigid
 * ones first, and for each load f the residual of its static response,
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

static ritz_status make_normal_modes(const ritz_request *request,
                                     ritz_basis *out)
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
    .fails = "interfaces: forces of other bodies have no static correction",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS,
    .make = make_normal_modes,
};
