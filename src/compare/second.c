/* Stage two: the bodies of stage one projected on smaller subspaces. */
#include "compare/compare.h"

#include "base/alloc.h"

#include <ritz/base.h>

#include <stdio.h>

/* Set mass and damping of motions without mass, which are rounding, to zero. */
static void zero_entries(int64_t massless, ritz_dense *A)
{
    for (int64_t j = 0; j < massless && A->val; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(A, j)[i] = ritz_dense_col(A, i)[j] = 0.0;
}

ritz_status ritz_compare_project(const ritz_stage *stage,
                                 const ritz_subspaces *subspaces,
                                 ritz_comparison *out)
{
    RITZ_OWN(ritz_stage) made = {0};

    RITZ_CHECK_NEW(made.body, stage->count);
    made.count = stage->count;
    out->composite = subspaces->vectors;
    out->num_bodies = stage->count;
    RITZ_CHECK_NEW(out->V, stage->count);
    for (int64_t c = 0; c < stage->count; c++) {
        const ritz_dense *V = &subspaces->V[c];
        ritz_origin *origin = &made.body[c].origin;

        RITZ_CHECK(ritz_dense_copy(V, &out->V[c]));
        RITZ_CHECK(ritz_reduced_project(&stage->body[c], V, &made.body[c]));
        zero_entries(subspaces->massless[c], &made.body[c].M);
        zero_entries(subspaces->massless[c], &made.body[c].D);
        for (int64_t j = 0; j < subspaces->massless[c]; j++)
            made.body[c].columns.kind[j] = RITZ_COLUMN_MASSLESS;
        snprintf(origin->method, sizeof origin->method, "compare");
        snprintf(origin->reference, sizeof origin->reference, "LeeTsuha1992");
        out->removed = out->removed || V->ncol < V->nrow;
    }
    return ritz_stage_from(stage->scene, made.body, &out->second);
}

ritz_status ritz_compare_orders(const ritz_comparison *trial, int64_t **order,
                                int64_t *total)
{
    RITZ_CHECK_NEW(*order, trial->num_bodies);
    for (int64_t c = 0; c < trial->num_bodies; c++)
        *total += (*order)[c] = trial->V[c].ncol;
    return RITZ_OK;
}
