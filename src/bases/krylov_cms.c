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
#include "bases/columns.h"
#include "bases/krylov_block.h"
#include "bases/loads.h"
#include "bases/partition.h"

#include <inttypes.h>

/* M_ib + M_ii Psi. */
static ritz_status find_coupling(const ritz_partition *s, const ritz_dense *Psi,
                                 ritz_dense *out)
{
    const ritz_dofs *i = &s->i;
    const ritz_dofs *b = s->b;
    RITZ_OWN(ritz_sparse) M_ib = {0};

    RITZ_CHECK(ritz_sparse_extract(&s->component->M, i->count, i->at, b->count,
                                   b->at, &M_ib));
    RITZ_CHECK(ritz_sparse_mul(&s->M_ii, Psi, out));
    for (int64_t j = 0; j < M_ib.ncol; j++)
        for (int64_t p = M_ib.colptr[j]; p < M_ib.colptr[j + 1]; p++)
            ritz_dense_col(out, j)[M_ib.rowind[p]] += M_ib.val[p];
    return RITZ_OK;
}

/* F_i: the coupling columns first, if the attached dofs are among the loads. */
static ritz_status find_loads(const ritz_request *request,
                              const ritz_partition *s, const ritz_dense *Psi,
                              ritz_dense *out)
{
    int loads = ritz_krylov_loads(request);
    int others = loads & ~RITZ_LOADS_ATTACHED;
    int64_t more = ritz_loads_count(request, others);
    int64_t b = loads & RITZ_LOADS_ATTACHED ? Psi->ncol : 0;
    RITZ_OWN(ritz_dense) coupling = {0}, F = {0}, F_i = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    if (more > 0 || b == 0) /* refuses none */
        RITZ_CHECK(
            ritz_loads_collect(request, more > 0 ? others : loads, &F, &dof));
    RITZ_CHECK(ritz_dense_new(s->i.count, b + more, out));
    if (b > 0)
        RITZ_CHECK(find_coupling(s, Psi, &coupling));
    ritz_dense_put(&coupling, 0, 0, out);
    if (more > 0)
        RITZ_CHECK(ritz_dense_rows(&F, s->i.count, s->i.at, &F_i));
    ritz_dense_put(&F_i, 0, b, out);
    return RITZ_OK;
}

static ritz_status make_krylov_fixed(const ritz_request *request,
                                     ritz_basis *out)
{
    RITZ_OWN(ritz_partition) s = {0};
    RITZ_OWN(ritz_factor) *L = NULL;
    RITZ_OWN(ritz_dense) Psi = {0}, F = {0};
    RITZ_OWN(ritz_elastic) interior = {0};
    RITZ_OWN(ritz_krylov) S = {0};
    RITZ_OWN(ritz_basis) boundary = {0}, basis = {0};
    ritz_dense V = {0};

    RITZ_CHECK(ritz_partition_new(request, &s));
    RITZ_CHECK(ritz_partition_factor(&s, &L));
    RITZ_CHECK(ritz_partition_boundary(&s, L, &boundary));
    RITZ_CHECK(ritz_dense_rows(&boundary.T, s.i.count, s.i.at, &Psi));
    RITZ_CHECK(find_loads(request, &s, &Psi, &F));
    interior = (ritz_elastic){.K = &s.K_ii, .M = &s.M_ii};
    RITZ_MOVE(interior.L, L);
    RITZ_CHECK(ritz_krylov_new(&interior, request, &S));
    RITZ_CHECK(ritz_krylov_run(&S, &F, 0));
    V = ritz_dense_part(&S.set.V, 0, S.set.count);
    RITZ_REFUSE_IF(s.b->count + V.ncol == 0, RITZ_ERR_ARGUMENT,
                   "the basis would have no vectors");
    RITZ_CHECK(ritz_partition_join(&s, &boundary, &V, &basis));
    for (int64_t j = s.b->count; j < basis.T.ncol; j++)
        basis.columns.kind[j] = RITZ_COLUMN_KRYLOV;
    RITZ_CHECK(ritz_krylov_sign(&S, request->modes, &basis));
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
    .make = make_krylov_fixed,
};

/*
 * Free-interface Krylov component modes: rigid modes, the elastic static
 * response to unit forces F_a at the attached dofs, and the block Krylov
 * vectors that follow from them [CraigHale1988; CraigSuKim1992, sec. 4],
 *
 *     T = [Phi_r, X_a, V],   X_a = P' S P F_a,
 *     span [X_a, V] = span of (A^-1 M)^j A^-1 F,   F = [F_a, other loads]
 *
 * X_a are the inertia-relief attachment modes; V is K-orthogonal to them. The
 * method relates to residual flexibility with free modes [Rubin1975] as
 * fixed-interface Krylov vectors do to Craig and Bampton's. The elastic moments
 * about 0 Hz between attached dofs are kept, two for each whole block.
 */
/*
 * Replace the Krylov columns of the seeds by the static responses to F_a
 * themselves.
 */
static ritz_status restore_attachment(const ritz_request *request,
                                      const ritz_krylov *S,
                                      const ritz_dense *F_a, const bool *taken,
                                      ritz_basis *basis)
{
    RITZ_OWN(ritz_dense) X = {0};
    int64_t at = S->body->Phi.ncol;

    RITZ_CHECK(ritz_dense_copy(F_a, &X));
    RITZ_CHECK(ritz_elastic_respond(S->body, NULL, &X));
    for (int64_t j = 0; j < X.ncol; j++) {
        const ritz_dense x = ritz_dense_part(&X, j, 1);

        if (!taken[j])
            continue;
        basis->columns.kind[at] = RITZ_COLUMN_ATTACHMENT;
        basis->columns.dof[at] = request->attached.at[j];
        ritz_dense_put(&x, 0, at++, &basis->T);
    }
    if (S->seeds < F_a->ncol)
        ritz_remark_add(basis, "; ",
                        "%" PRId64 " attachment mode(s) left out, dependent or "
                        "nothing but rigid",
                        F_a->ncol - S->seeds);
    return RITZ_OK;
}

static ritz_status make_krylov_free(const ritz_request *request,
                                    ritz_basis *out)
{
    const ritz_component *component = request->component;
    int loads = ritz_krylov_loads(request);
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;
    RITZ_OWN_ARRAY bool *taken = NULL;
    RITZ_OWN(ritz_elastic) body = {0};
    RITZ_OWN(ritz_krylov) S = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_dense F_a = {0}; /* at the attached dofs, which come first */

    RITZ_CHECK(
        ritz_loads_collect(request, loads | RITZ_LOADS_ATTACHED, &F, &dof));
    F_a = ritz_dense_part(&F, 0, request->attached.count);
    RITZ_CHECK_NEW(taken, F_a.ncol);
    RITZ_CHECK(ritz_elastic_new(&component->K, &component->M, &body));
    RITZ_CHECK(ritz_krylov_new(&body, request, &S));
    RITZ_CHECK(ritz_krylov_seed(&S, &F_a, taken));
    RITZ_CHECK(ritz_krylov_run(&S, &F, F_a.ncol));
    RITZ_CHECK(ritz_krylov_join(&S, &basis));
    RITZ_CHECK(restore_attachment(request, &S, &F_a, taken, &basis));
    RITZ_CHECK(ritz_krylov_sign(&S, request->modes, &basis));
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const ritz_method ritz_method_krylov_cms_free = {
    .name = "krylov-cms-free",
    .summary = "rigid, attachment and free-interface block Krylov vectors",
    .reference = "CraigHale1988",
    .when = "as macneal-rubin, without flexible eigenvalues",
    .cost = "a factor, one solve a vector, two an attached dof",
    .holds = "flexible static gain and moments at the attached dofs",
    .fails = "upper modes of the band: less exact than with normal modes",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_SHIFTS |
            RITZ_USES_LOADS | RITZ_USES_INNER,
    .make = make_krylov_free,
};
