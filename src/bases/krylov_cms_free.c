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
#include "base/alloc.h"
#include "bases/columns.h"
#include "bases/krylov_block.h"
#include "bases/loads.h"

#include <inttypes.h>

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
    int loads =
        request->choice.loads ? request->choice.loads : RITZ_KRYLOV_LOADS;
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
