#include "base/alloc.h"

#include <ritz/model.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[] = {
    [RITZ_COLUMN_RIGID] = "rigid",
    [RITZ_COLUMN_CONSTRAINT] = "constraint",
    [RITZ_COLUMN_NORMAL] = "normal",
    [RITZ_COLUMN_RESIDUAL] = "residual",
    [RITZ_COLUMN_SYSTEM] = "system",
    [RITZ_COLUMN_KRYLOV] = "krylov",
    [RITZ_COLUMN_STATIC] = "static",
    [RITZ_COLUMN_ATTACHMENT] = "attachment",
    [RITZ_COLUMN_INTERFACE] = "interface",
    [RITZ_COLUMN_MASSLESS] = "massless",
    [RITZ_COLUMN_FORCE] = "force",
    [RITZ_COLUMN_STATE] = "state",
    [RITZ_COLUMN_PERTURBED] = "perturbed",
    [RITZ_COLUMN_BALANCED] = "balanced",
};

ritz_status ritz_columns_new(int64_t r, ritz_columns *out)
{
    RITZ_OWN(ritz_columns) columns = {.count = r};

    RITZ_CHECK_NEW(columns.kind, r);
    RITZ_CHECK_NEW(columns.dof, r);
    RITZ_CHECK_NEW(columns.hertz, r);
    RITZ_CHECK_NEW(columns.residual, r);
    RITZ_CHECK_NEW(columns.error, r);
    for (int64_t j = 0; j < r; j++) {
        columns.kind[j] = RITZ_COLUMN_NORMAL;
        columns.dof[j] = -1;
        columns.hertz[j] = columns.residual[j] = columns.error[j] = nan("");
    }
    RITZ_MOVE(*out, columns);
    return RITZ_OK;
}

ritz_status ritz_columns_pick(const ritz_columns *columns, int64_t count,
                              const int64_t *at, ritz_columns *out)
{
    RITZ_OWN(ritz_columns) picked = {0};

    RITZ_CHECK(ritz_columns_new(count, &picked));
    for (int64_t j = 0; j < count; j++) {
        int64_t k = at ? at[j] : j;

        picked.kind[j] = columns->kind[k];
        picked.dof[j] = columns->dof[k];
        picked.hertz[j] = columns->hertz[k];
        picked.residual[j] = columns->residual[k];
        if (columns->error)
            picked.error[j] = columns->error[k];
    }
    ritz_columns_free(out);
    RITZ_MOVE(*out, picked);
    return RITZ_OK;
}

ritz_status ritz_basis_new(int64_t n, int64_t r, ritz_basis *out)
{
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(ritz_dense_new(n, r, &basis.T));
    RITZ_CHECK(ritz_columns_new(r, &basis.columns));
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const char *ritz_column_name(ritz_column_kind kind)
{
    return names[kind];
}

bool ritz_column_find(const char *name, ritz_column_kind *out)
{
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp(names[k], name) == 0) {
            *out = (ritz_column_kind)k;
            return true;
        }
    return false;
}

void ritz_columns_free(ritz_columns *columns)
{
    RITZ_FREE(columns->kind, columns->dof, columns->hertz, columns->residual,
              columns->error);
    *columns = (ritz_columns){0};
}

void ritz_basis_free(ritz_basis *basis)
{
    ritz_dense_free(&basis->T);
    ritz_dense_free(&basis->W);
    ritz_columns_free(&basis->columns);
    free(basis->hankel);
    *basis = (ritz_basis){0};
}
