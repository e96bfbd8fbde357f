#include "spring_chain.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

double spring_chain_mass(int64_t i)
{
    return 1.0 + 0.1 * (double)(7 * i % 5);
}

double spring_chain_stiffness(int64_t i)
{
    return 1000.0 * (1.0 + 0.2 * (double)(3 * i % 4));
}

static ritz_status assemble(int64_t n, bool free_end, ritz_component *chain)
{
    ritz_status status = RITZ_OK;
    int64_t *row = NULL, *col = NULL;
    double *val = NULL;
    int64_t count = 0;

    RITZ_NEW(row, 4 * n);
    RITZ_NEW(col, 4 * n);
    RITZ_NEW(val, 4 * n);
    for (int64_t s = free_end ? 1 : 0; s < n; s++)
        for (int64_t i = s > 0 ? s - 1 : 0; i <= s; i++)
            for (int64_t j = s > 0 ? s - 1 : 0; j <= s; j++, count++) {
                row[count] = i;
                col[count] = j;
                val[count] = i == j ? spring_chain_stiffness(s)
                                    : -spring_chain_stiffness(s);
            }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, count, row, col, val, &chain->K));
    for (int64_t i = 0; i < n; i++) {
        row[i] = col[i] = i;
        val[i] = spring_chain_mass(i);
    }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, n, row, col, val, &chain->M));
done:
    free(row);
    free(col);
    free(val);
    return status;
}

ritz_status spring_chain(int64_t n, bool is_free, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component chain = {.units = "none", .num_dofs = n};

    RITZ_NEW(chain.dof, n);
    RITZ_NEW(chain.grids.id, n);
    RITZ_NEW(chain.grids.position, 3 * n);
    RITZ_NEW(chain.grids.frame, n);
    RITZ_NEW(chain.grids.axes, 9);
    chain.grids.count = n;
    chain.grids.num_frames = 1;
    for (int64_t k = 0; k < 3; k++)
        chain.grids.axes[4 * k] = 1.0;
    for (int64_t i = 0; i < n; i++) {
        chain.dof[i] = (ritz_dof){i + 1, 1};
        chain.grids.id[i] = i + 1;
        chain.grids.position[3 * i] = (double)(i + 1);
    }
    RITZ_TRY(assemble(n, is_free, &chain));
    RITZ_TRY(ritz_component_settle(&chain, false));
    *out = chain;
    chain = (ritz_component){0};
done:
    ritz_component_free(&chain);
    return status;
}

ritz_status spring_chain_damp(ritz_component *chain, int64_t count,
                              const int64_t *spring, double c, double k)
{
    ritz_status status = RITZ_OK;
    ritz_dampers dampers = {0};

    RITZ_TRY(ritz_dampers_new(chain->num_dofs, count, &dampers));
    for (int64_t j = 0; j < count; j++) {
        double *b = ritz_dense_col(&dampers.B, j);

        snprintf(dampers.name[j], RITZ_NAME_SIZE, "damper %" PRId64, spring[j]);
        dampers.c[j] = c;
        dampers.k[j] = k;
        b[spring[j]] = 1.0;
        if (spring[j] > 0)
            b[spring[j] - 1] = -1.0;
    }
    ritz_dampers_free(&chain->dampers);
    chain->dampers = dampers;
    dampers = (ritz_dampers){0};
done:
    ritz_dampers_free(&dampers);
    return status;
}
