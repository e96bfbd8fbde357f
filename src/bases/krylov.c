/*
 * Krylov reduction: rigid modes and block Krylov vectors of the undamped
 * structure, started by what it answers to its loads F,
 *
 *     span V = span of (A^-1 M)^j A^-1 F,  j = 0, 1, ...,   A = K - sigma M
 *
 * about every expansion point sigma [CraigSuKim1992, sec. 2; McDaniel2000,
 * sec. 3.2.3]. If the inputs B are among the loads, the moments
 * C (A^-1 M)^j A^-1 B of the first k blocks are kept, j < k; if the outputs are
 * too, those of j < 2 k. About 0 Hz a free body has moments of its elastic
 * part: krylov_block.c and elastic.c separate the rigid modes first.
 *
 * tests/unit/bases/test_krylov.c holds the code to the published example of
 * [McDaniel2000], to moments about 0 Hz and elsewhere, and to the block
 * tridiagonal V'MV that full reorthogonalisation must leave.
 */
#include "bases/krylov_block.h"
#include "bases/loads.h"

#include <stdlib.h>

static const int all_loads =
    RITZ_LOADS_ATTACHED | RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS;

static ritz_status make(const ritz_request *request, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    const ritz_component *component = request->component;
    int loads = request->choice.loads ? request->choice.loads : all_loads;
    ritz_dense F = {0};
    int64_t *dof = NULL;
    ritz_elastic body = {0};
    ritz_krylov S = {0};
    ritz_basis basis = {0};

    RITZ_TRY(ritz_loads_collect(request, loads, &F, &dof));
    RITZ_TRY(ritz_elastic_new(&component->K, &component->M, &body));
    RITZ_TRY(ritz_krylov_new(&body, request, &S));
    RITZ_TRY(ritz_krylov_run(&S, &F, 0));
    RITZ_TRY(ritz_krylov_join(&S, &basis));
    ritz_krylov_say_blocks(&S, request->modes, &basis);
    RITZ_TRY(ritz_krylov_say_orthonormal(&S, &basis));
    *out = basis;
    basis = (ritz_basis){0};
done:
    ritz_dense_free(&F);
    free(dof);
    ritz_elastic_free(&body);
    ritz_krylov_free(&S);
    ritz_basis_free(&basis);
    return status;
}

const ritz_method ritz_method_krylov = {
    .name = "krylov",
    .summary = "rigid modes and block Krylov vectors of the loads",
    .reference = "CraigSuKim1992",
    .when = "few inputs and outputs, a response over a band",
    .cost = "a factor a point, a solve a vector, no eigenvalues but rigid ones",
    .holds = "moments of the response at each point; static gain at 0 Hz",
    .fails = "interfaces with many dofs: a block is as wide as they are many",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_SHIFTS |
            RITZ_USES_LOADS | RITZ_USES_INNER,
    .make = make,
};
