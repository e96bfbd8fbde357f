/*
 * System equivalent reduction expansion process: the lowest modes Phi of the
 * component, observed at its attached (measured) dofs [OCallahan1989b],
 *
 *     T = Phi Phi_a^+,    u = T u_a
 *
 * With as many modes m as attached dofs a, T has a column for each of them.
 * With fewer, T u_a has rank m only, and matrices of order a would be singular:
 * m dofs s that distinguish the modes best, by a QR factor of Phi_a' with
 * pivots, are coordinates then, and the others follow from them:
 *
 *     T = Phi Phi_s^-1,   span T = span Phi Phi_a^+ = span Phi
 *
 * so that every kept frequency and shape is exact:
 * tests/unit/bases/test_serep.c.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "bases/columns.h"

#include <lapacke.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The dofs that are chosen, and how well they distinguish the modes. */
typedef struct selection {
    const ritz_request *request;
    const ritz_pairs *modes;
    double size[3]; /* of all modes at points, translations, rotations */
    int64_t *at;    /* m, attached dofs that are coordinates, in their order */
    double condition;
    int64_t worst; /* least observable mode */
} selection;

static void selection_free(selection *c)
{
    free(c->at);
}

static int64_t dof_kind(const ritz_component *component, int64_t row)
{
    int64_t direction = component->dof[row].component;

    return direction == 0 ? 0 : direction <= 3 ? 1 : 2;
}

/*
 * Metres and radians are not comparable: each kind is relative to its own size.
 */
static void find_sizes(selection *c)
{
    const ritz_component *component = c->request->component;

    for (int64_t j = 0; j < c->modes->Phi.ncol; j++)
        for (int64_t i = 0; i < component->num_dofs; i++) {
            double *size = &c->size[dof_kind(component, i)];

            *size = fmax(*size, fabs(ritz_dense_col(&c->modes->Phi, j)[i]));
        }
}

/* 1 / size, of an attached dof. */
static double dof_weight(const selection *c, int64_t k)
{
    const ritz_request *request = c->request;
    int64_t row = request->attached.at[k];
    double size = c->size[dof_kind(request->component, row)];

    return size > 0.0 ? 1.0 / size : 1.0;
}

/* Mode j at attached dof k, relative to the size of its kind. */
static double weighted_entry(const selection *c, int64_t k, int64_t j)
{
    return dof_weight(c, k) *
           ritz_dense_col(&c->modes->Phi, j)[c->request->attached.at[k]];
}

/* The first m pivots of the weighted Phi_a', in the order of attachment. */
static ritz_status choose_dofs(selection *c)
{
    const ritz_dofs *a = &c->request->attached;
    int64_t m = c->modes->Phi.ncol;
    RITZ_OWN(ritz_dense) R = {0};
    RITZ_OWN_ARRAY double *tau = NULL;
    RITZ_OWN_ARRAY int *pivot = NULL;

    RITZ_CHECK_NEW(tau, m);
    RITZ_CHECK_NEW(pivot, a->count);
    RITZ_CHECK_NEW(c->at, m);
    RITZ_CHECK(ritz_dense_new(m, a->count, &R));
    for (int64_t k = 0; k < a->count; k++)
        for (int64_t j = 0; j < m; j++)
            ritz_dense_col(&R, k)[j] = weighted_entry(c, k, j);
    RITZ_REFUSE_IF(LAPACKE_dgeqp3(LAPACK_COL_MAJOR, (int)m, (int)a->count,
                                  R.val, (int)m, pivot, tau) != 0,
                   RITZ_ERR_MEMORY, "no memory to choose among attached dofs");
    for (int64_t k = 0; k < m; k++)
        c->at[k] = pivot[k] - 1;
    qsort(c->at, (size_t)m, sizeof *c->at, ritz_ascending_index);
    return RITZ_OK;
}

/* U, sigma, V' of the weighted Phi_s, m x m. */
static ritz_status decompose_modes(const selection *c, ritz_dense *U,
                                   double *sigma, ritz_dense *Vt)
{
    int m = (int)c->modes->Phi.ncol;
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN_ARRAY double *work = NULL;

    RITZ_CHECK_NEW(work, m);
    RITZ_CHECK(ritz_dense_new(m, m, &A));
    RITZ_CHECK(ritz_dense_new(m, m, U));
    RITZ_CHECK(ritz_dense_new(m, m, Vt));
    for (int64_t j = 0; j < m; j++)
        for (int64_t k = 0; k < m; k++)
            ritz_dense_col(&A, j)[k] = weighted_entry(c, c->at[k], j);
    RITZ_REFUSE_IF(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'A', 'A', m, m, A.val, m,
                                  sigma, U->val, m, Vt->val, m, work) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "singular values of the measured shapes do not converge");
    return RITZ_OK;
}

/*
 * Observability is relative to size 1, the largest of a mode at any dof: a mode
 * that is rounding at all attached dofs is unobservable, even if these dofs
 * distinguish it from others. The worst mode has the largest entry in the last
 * row of V'.
 */
static void find_worst(selection *c, const double *sigma, const ritz_dense *Vt)
{
    int64_t last = Vt->nrow - 1;

    c->condition =
        sigma[last] > 0.0 ? fmax(sigma[0], 1.0) / sigma[last] : HUGE_VAL;
    for (int64_t j = 0; j < Vt->ncol; j++)
        if (fabs(ritz_dense_col(Vt, j)[last]) >
            RITZ_TIE * fabs(ritz_dense_col(Vt, c->worst)[last]))
            c->worst = j;
}

/* "mode 7, 3.41 Hz", rigid ones counted. */
static void name_worst(const selection *c, char text[static RITZ_NAME_SIZE])
{
    const ritz_pairs *modes = c->modes;

    if (c->worst < modes->num_rigid)
        snprintf(text, RITZ_NAME_SIZE, "a rigid-body motion");
    else
        snprintf(text, RITZ_NAME_SIZE, "mode %" PRId64 ", %.6g Hz",
                 c->worst + 1, ritz_eigen_hertz(modes->lambda[c->worst]));
}

/* T = Phi V Sigma^-1 U' W, with rows of I at the coordinates themselves. */
static ritz_status expand_basis(const selection *c, const ritz_dense *U,
                                const double *sigma, const ritz_dense *Vt,
                                ritz_dense *T)
{
    int64_t m = U->ncol;
    RITZ_OWN(ritz_dense) scaled = {0}, inverse = {0};

    RITZ_CHECK(ritz_dense_new(m, m, &scaled)); /* Sigma^-1 U' W */
    for (int64_t j = 0; j < m; j++)
        for (int64_t k = 0; k < m; k++)
            ritz_dense_col(&scaled, k)[j] =
                ritz_dense_col(U, j)[k] * dof_weight(c, c->at[k]) / sigma[j];
    RITZ_CHECK(ritz_dense_mul_tn(Vt, &scaled, &inverse));
    RITZ_CHECK(ritz_dense_mul(&c->modes->Phi, &inverse, T));
    for (int64_t j = 0; j < m; j++)
        for (int64_t k = 0; k < m; k++)
            ritz_dense_col(T, j)[c->request->attached.at[c->at[k]]] =
                j == k ? 1.0 : 0.0;
    return RITZ_OK;
}

static ritz_status find_serep(selection *c, ritz_dense *T)
{
    RITZ_OWN(ritz_dense) U = {0}, Vt = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    char text[RITZ_NAME_SIZE];

    find_sizes(c);
    RITZ_CHECK(choose_dofs(c));
    RITZ_CHECK_NEW(sigma, c->modes->Phi.ncol);
    RITZ_CHECK(decompose_modes(c, &U, sigma, &Vt));
    find_worst(c, sigma, &Vt);
    name_worst(c, text);
    RITZ_REFUSE_IF(
        !(c->condition * c->request->tolerance < 1.0), RITZ_ERR_SINGULAR,
        "the attached dofs cannot distinguish the kept modes (condition "
        "%.1e), %s is least observable: attach dofs where it moves, or "
        "keep fewer modes",
        c->condition, text);
    return expand_basis(c, &U, sigma, &Vt, T);
}

/*
 * Name the dofs that are no coordinates, as far as there is room, and the mode
 * that is least observable.
 */
static void add_remark(const selection *c, ritz_basis *basis)
{
    const ritz_dofs *a = &c->request->attached;
    int64_t m = basis->T.ncol;
    const size_t size = sizeof basis->remark;
    char name[RITZ_NAME_SIZE];

    if (c->condition > RITZ_SEREP_CONDITION) {
        name_worst(c, name);
        ritz_remark_add(basis, "; ",
                        "%s is hardly observable at the attached dofs: "
                        "condition %.1e",
                        name, c->condition);
    }
    if (m == a->count)
        return;
    ritz_remark_add(basis, "; ",
                    "%" PRId64 " of %" PRId64 " attached dofs are "
                    "coordinates, which are enough:",
                    m, a->count);
    for (int64_t k = 0; k < m; k++)
        ritz_remark_add(
            basis, k > 0 ? ", " : " ", "%s",
            ritz_dof_name(c->request->component->dof[a->at[c->at[k]]], name));
    if (strlen(basis->remark) + 1 == size)
        memcpy(basis->remark + size - 4, "...", 4);
}

static ritz_status make_serep(const ritz_request *request, ritz_basis *out)
{
    const ritz_component *component = request->component;
    const ritz_dofs *a = &request->attached;
    const ritz_span span = ritz_request_span(request);
    RITZ_OWN(ritz_pairs) modes = {0};
    RITZ_OWN(selection) c = {.request = request, .modes = &modes};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dofs) rest = {0};
    int64_t m = 0;

    RITZ_CHECK(ritz_refuse_unattached(request, "nothing is measured"));
    /* refuses attached dofs that are out of range or repeated */
    RITZ_CHECK(ritz_dofs_complement(a, component->num_dofs, &rest));
    RITZ_CHECK_IN(
        "free-interface modes",
        ritz_eigen_sparse(&component->K, &component->M, &span, &modes));
    m = modes.Phi.ncol;
    RITZ_REFUSE_IF(m == 0, RITZ_ERR_ARGUMENT,
                   "no mode is kept: there is no rigid one, ask for flexible "
                   "ones");
    RITZ_REFUSE_IF(m > a->count, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " attached dof(s) cannot show %" PRId64
                   " modes, %" PRId64 " rigid ones among them: attach more or "
                   "keep fewer",
                   a->count, m, modes.num_rigid);
    RITZ_CHECK(ritz_columns_new(m, &basis.columns));
    RITZ_CHECK(find_serep(&c, &basis.T));
    for (int64_t k = 0; k < m; k++)
        ritz_columns_label_dofs(1, &a->at[c.at[k]], k, &basis.columns);
    add_remark(&c, &basis);
    ritz_origin_name_engine(&modes, &basis.origin);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const ritz_method ritz_method_serep = {
    .name = "serep",
    .summary = "modes observed at attached dofs (test-analysis models)",
    .reference = "OCallahan1989b",
    .when = "test-analysis models: exact modes on measured dofs",
    .cost = "a factor, two solves a mode",
    .holds = "kept frequencies and shapes",
    .fails = "statics; modes that the measured dofs do not distinguish",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_EIGEN,
    .only_named = RITZ_NAMED_FOR_SCENES,
    .make = make_serep,
};
