/* The coordinates of the bodies of a stage, one body after the other. */
#include "assembly/assembly.h"

#include "base/alloc.h"

#include <string.h>

ritz_status ritz_stage_blocks(const ritz_stage *stage, ritz_block **out)
{
    ritz_block *block = NULL;

    RITZ_CHECK_NEW(block, stage->count);
    for (int64_t k = 0; k < stage->count; k++) {
        const ritz_reduced *body = &stage->body[k];

        memcpy(block[k].name, stage->scene->component[k].name, RITZ_NAME_SIZE);
        block[k].first = stage->first[k];
        block[k].order = body->K.ncol;
        block[k].order_full = body->num_dofs;
    }
    *out = block;
    return RITZ_OK;
}

ritz_status ritz_stage_expansion(const ritz_stage *stage, const ritz_dense *V,
                                 ritz_dense *out)
{
    int64_t rows = 0, columns = 0;

    for (int64_t k = 0; k < stage->count; k++) {
        rows += V[k].nrow;
        columns += V[k].ncol;
    }
    RITZ_CHECK(ritz_dense_new(rows, columns, out));
    rows = columns = 0;
    for (int64_t k = 0; k < stage->count; k++) {
        ritz_dense_put(&V[k], rows, columns, out);
        rows += V[k].nrow;
        columns += V[k].ncol;
    }
    return RITZ_OK;
}
