/* Dofs that constraints eliminated from the bodies of a full-order system. */
#include "assembly/held.h"

#include "base/alloc.h"

#include <stdlib.h>

/* diag(G_1, G_2, ...), and the names of its rows in the system. */
static ritz_status stack(const ritz_held *p, const int64_t *add,
                         ritz_recovery *out)
{
    ritz_status status = RITZ_OK;
    int64_t *row = NULL, *col = NULL;
    double *val = NULL;
    int64_t entries = 0, rows = 0, at = 0;

    for (int64_t k = 0; k < p->count; k++) {
        const ritz_recovery *r = &p->body[k].recovery;

        rows += r->count;
        entries += r->count > 0 ? r->G.colptr[r->G.ncol] : 0;
    }
    RITZ_NEW(row, entries);
    RITZ_NEW(col, entries);
    RITZ_NEW(val, entries);
    RITZ_NEW(out->dof, rows);
    for (int64_t k = 0; k < p->count; k++) {
        const ritz_recovery *r = &p->body[k].recovery;

        for (int64_t j = 0; r->count > 0 && j < r->G.ncol; j++)
            for (int64_t e = r->G.colptr[j]; e < r->G.colptr[j + 1]; e++) {
                row[at] = out->count + r->G.rowind[e];
                col[at] = p->first[k] + j;
                val[at++] = r->G.val[e];
            }
        for (int64_t i = 0; i < r->count; i++)
            out->dof[out->count++] =
                (ritz_dof){r->dof[i].grid + add[k], r->dof[i].component};
    }
    RITZ_TRY(ritz_sparse_from_triplets(rows, p->num_dofs, at, row, col, val,
                                       &out->G));
done:
    free(row);
    free(col);
    free(val);
    return status;
}

ritz_status ritz_held_recovery(const ritz_held *p, const int64_t *add,
                               const ritz_sparse *T, ritz_recovery *out)
{
    ritz_status status = RITZ_OK;
    ritz_recovery all = {0};
    ritz_sparse GT = {0};

    RITZ_TRY(stack(p, add, &all));
    if (all.count == 0)
        goto done;
    RITZ_TRY(ritz_sparse_product(&all.G, T, &GT));
    ritz_sparse_free(&all.G);
    all.G = GT;
    GT = (ritz_sparse){0};
    *out = all;
    all = (ritz_recovery){0};
done:
    ritz_recovery_free(&all);
    ritz_sparse_free(&GT);
    return status;
}
