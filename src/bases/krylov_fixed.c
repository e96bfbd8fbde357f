/*
 * Fixed-interface Krylov component modes: constraint modes and block Krylov
 * vectors of the interior, started by the inertia forces of boundary motion
 * [CraigSuKim1992, sec. 4, eq. 24 and 25],
 *
 *     | u_b |   | I    0 | | u_b |   K_ii Psi = -K_ib
 *     | u_i | = | Psi  V | | q   |   span V = (A_ii^-1 M_ii)^j A_ii^-1 F_i
 *
 *     F_i = [M_ib + M_ii Psi, interior rows of other loads]
 *
 * with A = K - sigma M. Psi and V are K-orthogonal, so that T'KT is block
 * diagonal as it is with normal modes; forces on the boundary, and the other
 * loads, have their first moments kept, above all the static response.
 */
#include "base/alloc.h"
#include "bases/krylov.h"
#include "bases/partition.h"

#include <string.h>

/* M_ib + M_ii Psi. */
static ritz_status find_coupling(const ritz_partition *s, const ritz_dense *Psi,
                                 ritz_dense *out)
{
    const ritz_sparse *M_ib = &s->M_ib;

    RITZ_CHECK(ritz_sparse_mul(&s->M_ii, Psi, out));
    for (int64_t j = 0; j < M_ib->ncol; j++)
        for (int64_t p = M_ib->colptr[j]; p < M_ib->colptr[j + 1]; p++)
            ritz_dense_col(out, j)[M_ib->rowind[p]] += M_ib->val[p];
    return RITZ_OK;
}

/* F_i: the coupling columns first, if the attached dofs are among the loads. */
static ritz_status find_loads(const ritz_request *request,
                              const ritz_partition *s, ritz_dense *out)
{
    int loads = ritz_krylov_loads(request, true);
    int others = loads & ~RITZ_LOADS_ATTACHED;
    int64_t more = ritz_loads_count(request, others);
    bool attached = loads & RITZ_LOADS_ATTACHED && s->Psi.ncol > 0;
    RITZ_OWN(ritz_dense) coupling = {0}, F = {0}, F_i = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    if (more > 0 || !attached) { /* refuses none */
        RITZ_CHECK(
            ritz_loads_collect(request, more > 0 ? others : loads, &F, &dof));
        RITZ_CHECK(ritz_dense_rows(&F, s->i.count, s->i.at, &F_i));
    }
    F_i.ncol = more > 0 ? F_i.ncol : 0;
    if (attached)
        RITZ_CHECK(find_coupling(s, &s->Psi, more > 0 ? &coupling : out));
    if (more > 0 || !attached)
        return ritz_dense_beside(&coupling, &F_i, out);
    return RITZ_OK;
}

/* [I; Psi] and Krylov vectors, labelled and signed. What is not needed any more
   is freed before T is allocated. */
static ritz_status join_krylov(const ritz_request *request,
                               const ritz_partition *s, ritz_krylov *S,
                               ritz_basis *out)
{
    const ritz_dense V = ritz_dense_part(&S->set.V, 0, S->set.count);
    RITZ_OWN(ritz_basis) signature = {0};

    RITZ_CHECK(ritz_krylov_sign(S, request->modes, &signature));
    ritz_dense_free(&S->set.WV);
    RITZ_CHECK(ritz_partition_join(s, &V, out));
    for (int64_t j = s->b->count; j < out->T.ncol; j++)
        out->columns.kind[j] = RITZ_COLUMN_KRYLOV;
    memcpy(out->remark, signature.remark, sizeof out->remark);
    memcpy(out->origin.engine, signature.origin.engine,
           sizeof out->origin.engine);
    return RITZ_OK;
}

static ritz_status make_krylov_fixed(const ritz_request *request,
                                     ritz_basis *out)
{
    RITZ_OWN(ritz_partition) s = {0};
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN(ritz_elastic) interior = {0};
    RITZ_OWN(ritz_krylov) S = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(
        ritz_partition_hold(request, ritz_partition_may_take(request), &s));
    RITZ_CHECK(find_loads(request, &s, &F));
    interior = (ritz_elastic){.K = &s.K_ii, .M = &s.M_ii};
    RITZ_MOVE(interior.L, s.L);
    RITZ_CHECK(ritz_krylov_new(&interior, request, &S));
    RITZ_CHECK(ritz_krylov_run(&S, &F, 0));
    ritz_dense_free(&F);
    RITZ_REFUSE_IF(s.b->count + S.set.count == 0, RITZ_ERR_ARGUMENT,
                   "the basis would have no vectors");
    ritz_factor_free(&interior.L);
    RITZ_CHECK(join_krylov(request, &s, &S, &basis));
    ritz_remark_dampers(request, ritz_krylov_loads(request, true), &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const ritz_method ritz_method_krylov_cms_fixed = {
    .name = "krylov-cms-fixed",
    .summary = "constraint modes and fixed-interface block Krylov vectors",
    .reference = "CraigSuKim1992",
    .when = "as craig-bampton, without an eigenvalue problem",
    .cost = "a factor of the interior, one solve a vector",
    .holds = "statics and inertia of the interface; frequencies from above",
    .fails = "upper modes of the band: less exact than with normal modes",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_SHIFTS |
            RITZ_USES_LOADS | RITZ_USES_INNER,
    .keeps_interface = true,
    .nested = true,
    .make = make_krylov_fixed,
};
