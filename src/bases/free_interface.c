/* Methods that use free-interface modes and residual attachment modes, which
   are the static response of the modes that are left out. */
#include "bases/free_set.h"

#include "base/alloc.h"

#include <cblas.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAMED = 3 }; /* dofs in a remark */

/* Modes and residual modes of a body whose attached dofs are an interface. */
static ritz_status find_joined_set(const ritz_request *request,
                                   ritz_free_set *out)
{
    int beside = 0;

    RITZ_CHECK(ritz_loads_beside(request, RITZ_LOADS_DAMPERS, &beside));
    return ritz_free_set_new(request, RITZ_LOADS_ATTACHED | beside, true, out);
}

static ritz_status make_joined_basis(const ritz_request *request,
                                     ritz_column_kind kind, ritz_basis *out)
{
    RITZ_OWN(ritz_free_set) set = {0};

    RITZ_CHECK(find_joined_set(request, &set));
    return ritz_free_set_join(request, &set, kind, out);
}

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
 * independent: it is found without one. Psi is M- and K-orthogonal to
 * the kept modes, so that T'KT and T'MT are block diagonal, and the flexible
 * static gain at the attached dofs is exact.
 * tests/unit/bases/test_macneal_rubin.c holds the code to the printed formula
 * with three supports.
 */
static ritz_status make_macneal_rubin(const ritz_request *request,
                                      ritz_basis *out)
{
    return make_joined_basis(request, RITZ_COLUMN_RESIDUAL, out);
}

const ritz_method ritz_method_macneal_rubin = {
    .name = "macneal-rubin",
    .summary = "rigid, free-interface and residual attachment modes",
    .reference = "LeeTsuha1992",
    .when = "free components, few attached dofs, articulated systems",
    .cost = "a factor, two solves a mode, 3 to 10 an attached dof",
    .holds = "kept modes, flexible static gain, rigid motion; from above",
    .fails = "attached dofs that depend on each other: left out, and named",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS |
            RITZ_USES_EIGEN,
    .keeps_interface = true,
    .wide = &ritz_method_macneal_rubin,
    .narrow = ritz_macneal_rubin_narrow,
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
    return make_joined_basis(request, RITZ_COLUMN_MASSLESS, out);
}

const ritz_method ritz_method_macneal = {
    .name = "macneal",
    .summary = "free-interface modes, residual flexibility without mass",
    .reference = "MacNeal1971",
    .when = "free-interface results of codes that leave this mass out",
    .cost = "as macneal-rubin",
    .holds = "flexible static gain; kept modes",
    .fails = "frequencies need not come from above; M is singular",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS |
            RITZ_USES_EIGEN,
    .keeps_interface = true,
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
    const ritz_dense F = ritz_dense_part(&set->F, 0, set->interface);
    ritz_dense X = ritz_dense_part(&set->Psi, 0, set->interface);
    RITZ_OWN(ritz_dense) q = {0}, part = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&modes->Phi, &F, &q));
    for (int64_t j = 0; j < q.ncol; j++)
        for (int64_t k = 0; k < q.nrow; k++)
            ritz_dense_col(&q, j)[k] *=
                k < modes->num_rigid ? 0.0 : 1.0 / modes->lambda[k];
    RITZ_CHECK(ritz_dense_mul(&modes->Phi, &q, &part));
    ritz_dense_add(1.0, &part, &X);
    return RITZ_OK;
}

static ritz_status make_inertia_relief(const ritz_request *request,
                                       ritz_basis *out)
{
    RITZ_OWN(ritz_free_set) set = {0};

    RITZ_CHECK(find_joined_set(request, &set));
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
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS |
            RITZ_USES_EIGEN,
    .keeps_interface = true,
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
    return make_joined_basis(request, RITZ_COLUMN_FORCE, out);
}

const ritz_method ritz_method_dual_craig_bampton = {
    .name = "dual-craig-bampton",
    .summary = "macneal-rubin joined by interface forces: can be unstable",
    .reference = "Rixen2004",
    .when = "to compare with; forces join bodies instead of motions",
    .cost = "as macneal-rubin",
    .holds = "nothing: interfaces are met weakly",
    .fails = "systems have a negative eigenvalue for each interface force",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS |
            RITZ_USES_EIGEN,
    .only_named = RITZ_NAMED_FOR_COMPONENTS | RITZ_NAMED_FOR_SCENES,
    .keeps_interface = true,
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
    RITZ_OWN(ritz_free_set) set = {0};
    ritz_dense F = {0};
    int64_t *dof = NULL;

    if (asked && ritz_loads_count(request, loads) == 0)
        RITZ_CHECK(ritz_loads_collect(request, loads, &F, &dof)); /* says why */
    RITZ_CHECK(ritz_free_set_new(request, loads, false, &set));
    return ritz_free_set_join(request, &set, RITZ_COLUMN_STATIC, out);
}

const ritz_method ritz_method_normal_modes = {
    .name = "normal-modes",
    .summary = "modes, and a static Ritz vector for each input and damper",
    .reference = "ChuMilman1992",
    .when = "one structure with its loads, dampers to be tuned",
    .cost = "a factor, two solves a mode, 3 to 10 a load",
    .holds = "kept modes, flexible static gain of its loads",
    .fails = "interfaces: forces of other bodies have no static correction",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS |
            RITZ_USES_EIGEN,
    .make = make_normal_modes,
};

/*
 * Rubin's reduction [Rubin1975]: free-interface modes and residual flexibility
 * with its inertia, in coordinates that include the attached displacements u_b.
 * With Psi and Phi of macneal-rubin and Psi_bb = F'Psi
 *
 *     u = Phi q + Psi p,   u_b = Phi_b q + Psi_bb p
 *     T = [G, Phi - G Phi_b],   G = Psi Psi_bb^-1,   u = T [u_b; q]
 *
 * It spans the same space as macneal-rubin. The columns of q vanish at b, so
 * that those of rigid modes store energy: they are of kind normal like the
 * others.
 *
 * Psi_bb has an inverse on independent columns only; the dofs of columns that
 * are removed are no coordinates, and the remark names them.
 */

/*
 * T = [G, Phi - G Phi_b, ..]. At the attached dofs b, the rows of G are those
 * of I, and those of all other columns are zero; both are set exactly.
 */
static ritz_status fill_basis(const ritz_dense *Phi, const int64_t *b,
                              ritz_dense *G, ritz_dense *T)
{
    RITZ_OWN(ritz_dense) Phi_b = {0};
    int64_t n = G->nrow;
    int64_t p = G->ncol;

    RITZ_CHECK(ritz_dense_rows(Phi, p, b, &Phi_b));
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(G, j)[b[i]] = i == j ? 1.0 : 0.0;
    ritz_dense_put(G, 0, 0, T);
    ritz_dense_put(Phi, 0, p, T);
    if (Phi->ncol > 0)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, (int)n,
                    (int)Phi->ncol, (int)p, -1.0, G->val, (int)n, Phi_b.val,
                    (int)p, 1.0, ritz_dense_col(T, p), (int)n);
    for (int64_t j = p; j < T->ncol; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(T, j)[b[i]] = 0.0;
    return RITZ_OK;
}

/* Name the dofs that are no coordinates: "grid 3 T1, grid 7 T1". */
static void add_remark(const ritz_request *request, const ritz_free_set *set,
                       ritz_basis *basis)
{
    char text[NAMED * (RITZ_LOADS_NAME_SIZE + 2)] = "";
    char name[RITZ_LOADS_NAME_SIZE];
    size_t used = 0;
    int64_t count = 0;

    for (int64_t j = 0; j < set->interface; j++)
        if (!set->keep[j] && count++ < NAMED)
            used += (size_t)snprintf(
                text + used, sizeof text - used, "%s%s", used > 0 ? ", " : "",
                ritz_loads_name(request, set->loads, j, name));
    if (count > 0)
        snprintf(basis->remark, sizeof basis->remark,
                 "%" PRId64
                 " attached dof(s) are no coordinates, %.80s%s: their "
                 "residual flexibility depends on others, or is negligible "
                 "relative to the kept modes",
                 count, text, count > NAMED ? ", ..." : "");
}

/* Copy the static columns of the set to the end of T. */
static void put_statics(const ritz_basis *joined, const ritz_free_set *set,
                        ritz_basis *basis)
{
    const int64_t count = set->kept - set->held;
    const int64_t at = basis->T.ncol - count;
    const ritz_dense statics =
        ritz_dense_part(&joined->T, joined->T.ncol - count, count);

    ritz_dense_put(&statics, 0, at, &basis->T);
    for (int64_t j = at; j < basis->T.ncol; j++)
        basis->columns.kind[j] = RITZ_COLUMN_STATIC;
}

/* [G, Phi - G Phi_b, statics] from [Phi, Psi, statics]. */
static ritz_status turn_columns(const ritz_free_set *set,
                                const ritz_basis *joined, ritz_basis *out)
{
    const ritz_pairs *modes = &set->modes;
    const int64_t *b = joined->columns.dof + modes->Phi.ncol;
    RITZ_OWN(ritz_dense) G = {0};

    RITZ_CHECK(ritz_dense_columns(&joined->T, modes->Phi.ncol, set->held, &G));
    RITZ_CHECK(ritz_residual_divide(b, &G));
    RITZ_CHECK(ritz_basis_new(G.nrow, joined->T.ncol, out));
    put_statics(joined, set, out);
    RITZ_CHECK(fill_basis(&modes->Phi, b, &G, &out->T));
    ritz_columns_label_dofs(G.ncol, b, 0, &out->columns);
    ritz_columns_label(modes, RITZ_COLUMN_NORMAL, G.ncol, &out->columns);
    for (int64_t j = G.ncol; j < G.ncol + modes->num_rigid; j++) {
        out->columns.kind[j] = RITZ_COLUMN_NORMAL; /* no longer a rigid
                                                      motion */
        out->columns.hertz[j] = out->columns.error[j] = nan("");
    }
    ritz_origin_name_engine(modes, &out->origin);
    return RITZ_OK;
}

static ritz_status make_rubin(const ritz_request *request, ritz_basis *out)
{
    RITZ_OWN(ritz_free_set) set = {0};
    RITZ_OWN(ritz_basis) joined = {0}, basis = {0};

    RITZ_CHECK(find_joined_set(request, &set));
    RITZ_CHECK(
        ritz_free_set_join(request, &set, RITZ_COLUMN_RESIDUAL, &joined));
    if (set.held > 0)
        RITZ_CHECK(turn_columns(&set, &joined, &basis));
    else /* no attached dof becomes a coordinate */
        RITZ_MOVE(basis, joined);
    basis.remark[0] = '\0';
    add_remark(request, &set, &basis);
    if (set.Psi.ncol > 0)
        ritz_remark_left_out(
            request, set.loads, set.interface, set.Psi.ncol - set.interface,
            set.keep + set.interface, RITZ_COLUMN_STATIC, &basis);
    ritz_remark_dampers(request, set.loads, &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const ritz_method ritz_method_rubin = {
    .name = "rubin",
    .summary = "attached dofs themselves, free-interface modes within",
    .reference = "Rubin1975",
    .when = "as macneal-rubin, for codes that want attached dofs as "
            "coordinates",
    .cost = "as macneal-rubin",
    .holds = "spans what macneal-rubin spans",
    .fails = "nearly all modes kept: what is left at the interface is rounding",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_LOADS |
            RITZ_USES_EIGEN,
    .keeps_interface = true,
    .wide = &ritz_method_macneal_rubin,
    .narrow = ritz_rubin_narrow,
    .make = make_rubin,
};
