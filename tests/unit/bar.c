#include "bar.h"

#include "base/alloc.h"

#include <math.h>
#include <stdlib.h>

/* Assemble the 2 x 2 element matrix [a b; b a] along the bar. */
static ritz_status assemble(int64_t elements, double a, double b,
                            ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    int64_t *row = NULL;
    int64_t *col = NULL;
    double *val = NULL;
    int64_t k = 0;

    RITZ_NEW(row, 4 * elements);
    RITZ_NEW(col, 4 * elements);
    RITZ_NEW(val, 4 * elements);
    for (int64_t e = 0; e < elements; e++)
        for (int64_t i = 0; i < 2; i++)
            for (int64_t j = 0; j < 2; j++, k++) {
                row[k] = e + i;
                col[k] = e + j;
                val[k] = i == j ? a : b;
            }
    RITZ_TRY(ritz_sparse_from_triplets(elements + 1, elements + 1, k, row, col,
                                       val, out));
done:
    free(row);
    free(col);
    free(val);
    return status;
}

ritz_status bar_component(int64_t elements, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component bar = {.units = "none", .num_dofs = elements + 1};
    double h = 1.0 / (double)elements;

    RITZ_NEW(bar.dof, bar.num_dofs);
    RITZ_NEW(bar.grids.id, bar.num_dofs);
    RITZ_NEW(bar.grids.position, 3 * bar.num_dofs);
    RITZ_NEW(bar.grids.frame, bar.num_dofs);
    RITZ_NEW(bar.grids.axes, 9);
    bar.grids.count = bar.num_dofs;
    bar.grids.num_frames = 1;
    for (int64_t k = 0; k < 3; k++)
        bar.grids.axes[4 * k] = 1.0;
    for (int64_t k = 0; k < bar.num_dofs; k++) {
        bar.dof[k] = (ritz_dof){k + 1, 1};
        bar.grids.id[k] = k + 1;
        bar.grids.position[3 * k] = (double)k * h;
    }
    RITZ_TRY(assemble(elements, 1.0 / h, -1.0 / h, &bar.K));
    RITZ_TRY(assemble(elements, h / 3.0, h / 6.0, &bar.M));
    RITZ_TRY(ritz_component_settle(&bar, false));
    *out = bar;
    bar = (ritz_component){0};
done:
    ritz_component_free(&bar);
    return status;
}

double bar_eigenvalue(int64_t elements, int64_t k)
{
    const double pi = 3.14159265358979323846;
    double h = 1.0 / (double)elements;
    double c = cos((double)k * pi * h);

    return 6.0 / (h * h) * (1.0 - c) / (2.0 + c);
}
