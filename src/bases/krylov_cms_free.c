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
#include "bases/krylov_block.h"
#include "bases/loads.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum {
    OTHER_LOADS = RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS,
};

/*
 * Replace the Krylov columns of the seeds by the static responses X themselves.
 */
static ritz_status restore_attachment(const ritz_request *request,
                                      const ritz_krylov *S,
                                      const ritz_dense *F_a, const bool *taken,
                                      ritz_basis *basis)
{
    const ritz_dofs *a = &request->attached;
    RITZ_OWN(ritz_dense) X = {0};
    int64_t at = S->body->Phi.ncol;
    size_t size = (size_t)F_a->nrow * sizeof *F_a->val;

    RITZ_CHECK(ritz_dense_copy(F_a, &X));
    RITZ_CHECK(ritz_elastic_answer(S->body, &X));
    for (int64_t j = 0; j < a->count; j++) {
        if (!taken[j])
            continue;
        memcpy(ritz_dense_col(&basis->T, at), ritz_dense_col(&X, j), size);
        basis->columns.kind[at] = RITZ_COLUMN_ATTACHMENT;
        basis->columns.dof[at++] = a->at[j];
    }
    return RITZ_OK;
}

/* The attached dofs first; other loads are optional. */
static ritz_status collect_forces(const ritz_request *request, ritz_dense *F_a,
                                  ritz_dense *F)
{
    int others = request->choice.loads
                     ? request->choice.loads & ~RITZ_LOADS_ATTACHED
                     : OTHER_LOADS;
    int loads = RITZ_LOADS_ATTACHED | others;
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    RITZ_CHECK(ritz_loads_collect(request, loads, F, &dof));
    return ritz_dense_columns(F, 0, request->attached.count, F_a);
}

static ritz_status join_basis(const ritz_request *request, const ritz_krylov *S,
                              const ritz_dense *F_a, const bool *taken,
                              ritz_basis *out)
{
    RITZ_CHECK(ritz_krylov_join(S, out));
    RITZ_CHECK(restore_attachment(request, S, F_a, taken, out));
    if (S->seeds < F_a->ncol)
        ritz_krylov_say(out,
                        "%" PRId64 " attachment mode(s) left out, dependent or "
                        "nothing but rigid; ",
                        F_a->ncol - S->seeds);
    ritz_krylov_say_blocks(S, request->modes, out);
    return ritz_krylov_say_orthonormal(S, out);
}

static ritz_status make_krylov_free(const ritz_request *request,
                                    ritz_basis *out)
{
    const ritz_component *component = request->component;
    RITZ_OWN(ritz_dense) F_a = {0}, F = {0};
    RITZ_OWN_ARRAY bool *taken = NULL;
    RITZ_OWN(ritz_elastic) body = {0};
    RITZ_OWN(ritz_krylov) S = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(collect_forces(request, &F_a, &F));
    RITZ_CHECK_NEW(taken, F_a.ncol);
    RITZ_CHECK(ritz_elastic_new(&component->K, &component->M, &body));
    RITZ_CHECK(ritz_krylov_new(&body, request, &S));
    RITZ_CHECK(ritz_krylov_seed(&S, &F_a, taken));
    RITZ_CHECK(ritz_krylov_run(&S, &F, F_a.ncol));
    RITZ_CHECK(join_basis(request, &S, &F_a, taken, &basis));
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
