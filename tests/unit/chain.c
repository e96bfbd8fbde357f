#include "chain.h"

#include "base/alloc.h"

#include <stdio.h>
#include <stdlib.h>

static double spring(int64_t i)
{
    return 1000.0 * (1.0 + 0.2 * (double)((3 * i) % 4));
}

/* K or M by its entries. */
static ritz_status matrices(int64_t n, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    int64_t *row = NULL, *col = NULL;
    double *val = NULL;
    int64_t count = 0;

    RITZ_NEW(row, 3 * n);
    RITZ_NEW(col, 3 * n);
    RITZ_NEW(val, 3 * n);
    for (int64_t i = 0; i < n; i++) {
        row[i] = col[i] = i;
        val[i] = 1.0 + 0.1 * (double)((7 * i) % 5);
    }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, n, row, col, val, &out->M));
    for (int64_t i = 0; i < n; i++) {
        row[count] = col[count] = i;
        val[count++] = spring(i) + (i + 1 < n ? spring(i + 1) : 0.0);
        if (i + 1 == n)
            break;
        row[count] = col[count + 1] = i;
        col[count] = row[count + 1] = i + 1;
        val[count] = val[count + 1] = -spring(i + 1);
        count += 2;
    }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, count, row, col, val, &out->K));
done:
    free(row);
    free(col);
    free(val);
    return status;
}

static ritz_status dampers(int64_t n, ritz_dampers *out)
{
    static const int64_t across[] = {2, 9, 17};
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_dampers_new(n, 3, out));
    for (int64_t j = 0; j < 3; j++) {
        snprintf(out->name[j], RITZ_NAME_SIZE, "%c", (char)('a' + j));
        out->c[j] = 150.0;
        out->k[j] = -200.0;
        ritz_dense_col(&out->B, j)[across[j]] = 1.0;
        ritz_dense_col(&out->B, j)[across[j] - 1] = -1.0;
    }
done:
    return status;
}

ritz_status chain_component(int64_t n, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component chain = {.num_dofs = n, .units = "kg m s"};

    RITZ_NEW(chain.dof, n);
    for (int64_t i = 0; i < n; i++)
        chain.dof[i] = (ritz_dof){i + 1, 0};
    RITZ_TRY(matrices(n, &chain));
    RITZ_TRY(dampers(n, &chain.dampers));
    RITZ_TRY(ritz_io_new(n, 1, 1, &chain.io));
    snprintf(chain.io.input[0], RITZ_NAME_SIZE, "f");
    snprintf(chain.io.output[0], RITZ_NAME_SIZE, "u");
    chain.io.B.val[n - 1] = 1.0;
    chain.io.C.val[n - 1] = 1.0;
    RITZ_TRY(ritz_component_settle(&chain, false));
    *out = chain;
    chain = (ritz_component){0};
done:
    ritz_component_free(&chain);
    return status;
}

void chain_free(ritz_component *chain)
{
    chain->K.val[0] -= spring(0);
}
