/*
 * The static response of the modes that are left out to forces F. With the kept
 * modes Phi, Psi solves
 *
 *     K Psi = G,  G = F - M Phi Phi' F,    Phi' M Psi = 0
 *
 * and is found from one definite factor of A = K + s M, s > 0, by
 *
 *     Psi <- A^-1 (G + s M Psi),
 *
 * which contracts by s / (lambda + s) for every mode lambda that was left out.
 * F' Psi = Psi' K Psi is the residual flexibility: columns that are dependent
 * by it, or negligible relative to the flexibility of the kept modes, are
 * removed. With T = [Phi, Psi], T'KT and T'MT are block diagonal, and the
 * flexible static response to F at the loaded dofs is exact.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "linear/orthonormal.h"

#include <cblas.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_SWEEPS = 60,
    NAMED = 3, /* dofs in a remark */
};

/* Free-interface modes, and residual modes for some loads. */
typedef struct free_set {
    ritz_pairs modes;  /* that are kept, rigid ones first */
    int loads;         /* RITZ_LOADS_..., of the columns below */
    ritz_dense F, Psi; /* n x p, loads and residual modes; {0}: no load */
    int64_t *dof;      /* p, row of an attached dof, -1 of other loads */
    bool *keep;        /* p, false: dependent, or negligible (tolerance) */
    int64_t kept;      /* how many columns of Psi are */
} free_set;

static void free_set_free(free_set *set)
{
    ritz_pairs_free(&set->modes);
    ritz_dense_free(&set->F);
    ritz_dense_free(&set->Psi);
    RITZ_FREE(set->dof, set->keep);
}

/*
 * A shift below the first flexible mode contracts fast and makes A well
 * conditioned. If that mode is not kept, it is found for this; if there is
 * none, the shift is of the scale of the matrices.
 */
static ritz_status choose_shift(const ritz_component *component,
                                const ritz_pairs *modes, double *out)
{
    const ritz_span one = {.modes = 1};
    double K = ritz_sparse_max(&component->K);
    double M = ritz_sparse_max(&component->M);
    RITZ_OWN(ritz_pairs) first = {0};
    const ritz_pairs *known = modes;

    if (modes->Phi.ncol == modes->num_rigid) {
        RITZ_CHECK_IN(
            "first flexible mode",
            ritz_eigen_sparse(&component->K, &component->M, &one, &first));
        known = &first;
    }
    if (known->Phi.ncol > known->num_rigid)
        *out = RITZ_SHIFT_OF_FIRST * known->lambda[known->num_rigid];
    else
        *out = K > 0.0 && M > 0.0 ? RITZ_SHIFT_OF_SIZE * K / M : 1.0;
    return RITZ_OK;
}

/* An upper bound of the kept flexible modes' static response to load j. */
static double bound_response(const ritz_pairs *modes, const ritz_dense *F,
                             int64_t j)
{
    double most = 0.0;

    for (int64_t k = modes->num_rigid; k < modes->Phi.ncol; k++)
        most = fmax(most, ritz_dense_col_max(&modes->Phi, k) *
                              fabs(ritz_dense_dot(&modes->Phi, k, F, j)) /
                              modes->lambda[k]);
    return most;
}

/*
 * One step of the iteration; *change is the largest change of a column relative
 * to its size. A column smaller than least[j] is rounding, and its change is
 * relative to least[j].
 */
static ritz_status iterate_residual(ritz_factor *A, const ritz_sparse *M,
                                    double s, const ritz_dense *G,
                                    const double *least, ritz_dense *Psi,
                                    double *change)
{
    RITZ_OWN(ritz_dense) next = {0};

    RITZ_CHECK(ritz_sparse_mul(M, Psi, &next));
    for (int64_t k = 0; k < G->nrow * G->ncol; k++)
        next.val[k] = G->val[k] + s * next.val[k];
    RITZ_CHECK(ritz_factor_solve(A, &next));
    *change = 0.0;
    for (int64_t j = 0; j < G->ncol; j++) {
        const double *now = ritz_dense_col(&next, j);
        const double *before = ritz_dense_col(Psi, j);
        double moved = 0.0;
        double size = least[j];

        for (int64_t i = 0; i < G->nrow; i++) {
            moved = fmax(moved, fabs(now[i] - before[i]));
            size = fmax(size, fabs(now[i]));
        }
        if (size > 0.0)
            *change = fmax(*change, moved / size);
    }
    ritz_dense_replace(Psi, &next);
    return RITZ_OK;
}

/*
 * The response of A to each load at the load itself, and the size below which
 * its column is rounding.
 */
static ritz_status find_scales(const free_set *set, double tolerance,
                               ritz_factor *A, double *own, double *least)
{
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_dense_copy(&set->F, &X));
    RITZ_CHECK(ritz_factor_solve(A, &X));
    for (int64_t j = 0; j < X.ncol; j++) {
        own[j] = ritz_dense_dot(&set->F, j, &X, j);
        least[j] = fmax(tolerance * bound_response(&set->modes, &set->F, j),
                        RITZ_FORCE_RELIEVED * ritz_dense_col_max(&X, j));
    }
    return RITZ_OK;
}

/* Psi, and the response of A to each load at the load itself. */
static ritz_status find_residual(const ritz_request *request, free_set *set,
                                 double *response)
{
    const ritz_sparse *M = &request->component->M;
    const ritz_dense *Phi = &set->modes.Phi;
    const double settled = RITZ_SWEEPS_SETTLED * sqrt((double)M->nrow);
    double s = 0.0;
    double change = 1.0, best = HUGE_VAL;
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_dense) MPhi = {0}, G = {0};
    RITZ_OWN_ARRAY double *least = NULL;

    RITZ_CHECK_NEW(least, set->F.ncol);
    RITZ_CHECK(choose_shift(request->component, &set->modes, &s));
    RITZ_CHECK(ritz_sparse_add(1.0, &request->component->K, s, M, &A));
    RITZ_CHECK_IN("shifted stiffness", ritz_factor_spd(&A, &L));
    RITZ_CHECK(find_scales(set, request->tolerance, L, response, least));
    RITZ_CHECK(ritz_sparse_mul(M, Phi, &MPhi));
    RITZ_CHECK(ritz_dense_copy(&set->F, &G));
    RITZ_CHECK(ritz_dense_take_out(&MPhi, Phi, &G));
    RITZ_CHECK(ritz_dense_take_out(&MPhi, Phi, &G)); /* twice is enough */
    RITZ_CHECK(ritz_dense_new(G.nrow, G.ncol, &set->Psi));
    for (int k = 0; k < MOST_SWEEPS && change > settled; k++) {
        RITZ_CHECK(iterate_residual(L, M, s, &G, least, &set->Psi, &change));
        RITZ_CHECK(ritz_dense_take_out(Phi, &MPhi, &set->Psi));
        if (k > 8 && change > 0.5 * best)
            break; /* rounding, not contraction, is what is left */
        best = fmin(best, change);
    }
    RITZ_REFUSE_IF(change > RITZ_SWEEPS_UNSETTLED, RITZ_ERR_CONVERGENCE,
                   "residual attachment modes still change by %.1e", change);
    return RITZ_OK;
}

/* Flexibility F' Phi_f Lambda_f^-1 Phi_f' F of the kept modes for load j. */
static double kept_flexibility(const free_set *set, int64_t j)
{
    const ritz_pairs *modes = &set->modes;
    double sum = 0.0;

    for (int64_t k = modes->num_rigid; k < modes->Phi.ncol; k++) {
        double x = ritz_dense_dot(&modes->Phi, k, &set->F, j);

        sum += x * x / modes->lambda[k];
    }
    return sum;
}

/*
 * Mark the residual modes that are independent and more than rounding, by
 * pivots of R = F' Psi scaled to a unit diagonal: the square of what is new in
 * a column must exceed the tolerance. Of pivots that are equal to six digits
 * the first is taken, so that the choice does not depend on a processor's
 * rounding.
 */
static ritz_status choose_independent(const double *response, double tolerance,
                                      free_set *set)
{
    RITZ_OWN(ritz_dense) R = {0};
    RITZ_OWN_ARRAY double *scale = NULL;
    RITZ_OWN_ARRAY int64_t *order = NULL;

    RITZ_CHECK_NEW(scale, set->Psi.ncol);
    RITZ_CHECK_NEW(order, set->Psi.ncol);
    RITZ_CHECK(ritz_dense_mul_tn(&set->F, &set->Psi, &R));
    for (int64_t j = 0; j < R.ncol; j++) {
        double own = ritz_dense_col(&R, j)[j];
        double all = own + kept_flexibility(set, j);

        if (own > tolerance * all && own > RITZ_FORCE_RELIEVED * response[j])
            scale[j] = 1.0 / sqrt(own);
    }
    for (int64_t j = 0; j < R.ncol; j++)
        for (int64_t i = 0; i < R.ncol; i++)
            ritz_dense_col(&R, j)[i] *= scale[i] * scale[j];
    ritz_dense_symmetrise(&R);
    set->kept = ritz_pivots_find(&R, tolerance, RITZ_PIVOT_TIE, R.ncol, order);
    for (int64_t k = 0; k < set->kept; k++)
        set->keep[order[k]] = true;
    return RITZ_OK;
}

/*
 * The lowest modes as the request says, and residual modes of the loads, if
 * there are any, M- and K-orthogonal to the kept modes.
 */
static ritz_status find_free_set(const ritz_request *request, int loads,
                                 free_set *out)
{
    const ritz_component *component = request->component;
    const ritz_span span = {request->modes, request->up_to_hz};
    RITZ_OWN(free_set) set = {.loads = loads};
    RITZ_OWN(ritz_dofs) rest = {0};
    RITZ_OWN_ARRAY double *response = NULL;

    /* refuses attached dofs that are out of range or repeated */
    RITZ_CHECK(
        ritz_dofs_complement(&request->attached, component->num_dofs, &rest));
    RITZ_CHECK(ritz_lowest_modes("free-interface modes", "K", &component->K,
                                 &component->M, &span, &set.modes));
    if (ritz_loads_count(request, loads) > 0) {
        RITZ_CHECK(ritz_loads_collect(request, loads, &set.F, &set.dof));
        RITZ_CHECK_NEW(set.keep, set.F.ncol);
        RITZ_CHECK_NEW(response, set.F.ncol);
        RITZ_CHECK(find_residual(request, &set, response));
        RITZ_CHECK(choose_independent(response, request->tolerance, &set));
    }
    RITZ_MOVE(*out, set);
    return RITZ_OK;
}

/*
 * T = [rigid, normal, Psi]; the Psi columns have a kind, and the remark names
 * those left out.
 */
static ritz_status join_free_set(const ritz_request *request,
                                 const free_set *set, ritz_column_kind kind,
                                 ritz_basis *out)
{
    int64_t k = set->modes.Phi.ncol;
    char name[RITZ_LOADS_NAME_SIZE] = "";

    RITZ_CHECK(ritz_basis_of_modes(&set->modes, set->kept, out));
    for (int64_t j = 0; j < set->Psi.ncol; j++) {
        const ritz_dense column = ritz_dense_part(&set->Psi, j, 1);

        if (!set->keep[j] && !name[0])
            ritz_loads_name(request, set->loads, j, name);
        if (!set->keep[j])
            continue;
        out->columns.kind[k] = kind;
        out->columns.dof[k] = set->dof[j];
        ritz_dense_put(&column, 0, k++, &out->T);
    }
    if (set->kept < set->Psi.ncol)
        ritz_remark_add(out, "; ",
                        "%" PRId64 " %s mode(s) left out, the first of %s: "
                        "dependent, or negligible relative to the kept modes",
                        set->Psi.ncol - set->kept, ritz_column_name(kind),
                        name);
    return RITZ_OK;
}

static ritz_status make_free_basis(const ritz_request *request, int loads,
                                   ritz_column_kind kind, ritz_basis *out)
{
    RITZ_OWN(free_set) set = {0};

    RITZ_CHECK(find_free_set(request, loads, &set));
    return join_free_set(request, &set, kind, out);
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
    return make_free_basis(request, RITZ_LOADS_ATTACHED, RITZ_COLUMN_RESIDUAL,
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
    .keeps_interface = true,
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
    return make_free_basis(request, RITZ_LOADS_ATTACHED, RITZ_COLUMN_MASSLESS,
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
static ritz_status add_modes(free_set *set)
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
    RITZ_OWN(free_set) set = {0};

    RITZ_CHECK(find_free_set(request, RITZ_LOADS_ATTACHED, &set));
    if (set.Psi.ncol > 0)
        RITZ_CHECK(add_modes(&set));
    return join_free_set(request, &set, RITZ_COLUMN_ATTACHMENT, out);
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
    return make_free_basis(request, RITZ_LOADS_ATTACHED, RITZ_COLUMN_FORCE,
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
    ritz_dense F = {0};
    int64_t *dof = NULL;

    if (asked && ritz_loads_count(request, loads) == 0)
        RITZ_CHECK(ritz_loads_collect(request, loads, &F, &dof)); /* says why */
    return make_free_basis(request, loads, RITZ_COLUMN_STATIC, out);
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

/* G = Psi Psi_bb^-1, Psi_bb = S L L' S with a unit diagonal within. */
static ritz_status divide_residual(const int64_t *b, ritz_dense *Psi)
{
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY double *scale = NULL;
    int n = (int)Psi->nrow;
    int p = (int)Psi->ncol;

    RITZ_CHECK_NEW(scale, p);
    RITZ_CHECK(ritz_dense_rows(Psi, p, b, &F));
    ritz_dense_symmetrise(&F);
    for (int64_t j = 0; j < p; j++)
        scale[j] = 1.0 / sqrt(ritz_dense_col(&F, j)[j]);
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&F, j)[i] *= scale[i] * scale[j];
    RITZ_REFUSE_IF(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', p, F.val, p) != 0,
                   RITZ_ERR_SINGULAR,
                   "residual flexibility of the attached dofs is singular: "
                   "keep fewer modes, or a larger --tolerance");
    for (int64_t j = 0; j < p; j++)
        cblas_dscal(n, scale[j], ritz_dense_col(Psi, j), 1);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                n, p, 1.0, F.val, p, Psi->val, n);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans,
                CblasNonUnit, n, p, 1.0, F.val, p, Psi->val, n);
    for (int64_t j = 0; j < p; j++)
        cblas_dscal(n, scale[j], ritz_dense_col(Psi, j), 1);
    return RITZ_OK;
}

/*
 * T = [G, Phi - G Phi_b]. The rows of G are those of I, and those of
 * Phi - G Phi_b zero, where they are so exactly.
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
static void add_remark(const ritz_request *request, const free_set *set,
                       ritz_basis *basis)
{
    char text[NAMED * (RITZ_LOADS_NAME_SIZE + 2)] = "";
    char name[RITZ_LOADS_NAME_SIZE];
    size_t used = 0;
    int64_t count = 0;

    for (int64_t j = 0; j < set->Psi.ncol; j++)
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

static ritz_status make_rubin(const ritz_request *request, ritz_basis *out)
{
    RITZ_OWN(free_set) set = {0};
    RITZ_OWN(ritz_basis) joined = {0}, basis = {0};
    RITZ_OWN(ritz_dense) G = {0};
    const ritz_pairs *modes = &set.modes;
    const int64_t *b = NULL;

    RITZ_CHECK(find_free_set(request, RITZ_LOADS_ATTACHED, &set));
    RITZ_CHECK(join_free_set(request, &set, RITZ_COLUMN_RESIDUAL, &joined));
    if (set.kept == 0) { /* then the modes are all there is */
        add_remark(request, &set, &joined);
        RITZ_MOVE(*out, joined);
        return RITZ_OK;
    }
    b = joined.columns.dof + modes->Phi.ncol;
    RITZ_CHECK(ritz_dense_columns(&joined.T, modes->Phi.ncol, set.kept, &G));
    RITZ_CHECK(divide_residual(b, &G));
    RITZ_CHECK(ritz_basis_new(G.nrow, G.ncol + modes->Phi.ncol, &basis));
    RITZ_CHECK(fill_basis(&modes->Phi, b, &G, &basis.T));
    ritz_columns_label_dofs(G.ncol, b, 0, &basis.columns);
    ritz_columns_label(modes, RITZ_COLUMN_NORMAL, G.ncol, &basis.columns);
    for (int64_t j = G.ncol; j < G.ncol + modes->num_rigid; j++) {
        basis.columns.kind[j] = RITZ_COLUMN_NORMAL; /* and no longer rigid */
        basis.columns.hertz[j] = nan("");
    }
    memcpy(basis.origin.engine, modes->engine, sizeof basis.origin.engine);
    add_remark(request, &set, &basis);
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
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED,
    .keeps_interface = true,
    .make = make_rubin,
};
