/* Rows of a component, and behind them the dofs that follow from these. */
#include "import/import.h"

#include "base/alloc.h"

#include <stdlib.h>

ritz_status ritz_extended_new(const ritz_component *component,
                              const ritz_equations *equations,
                              ritz_extended *out)
{
    ritz_status status = RITZ_OK;
    ritz_extended new = {.view = *component,
                         .num_rows = component->num_dofs,
                         .equations = equations};
    const ritz_recovery *recovery = &component->recovery;
    ritz_dof *all = NULL;

    RITZ_TRY(ritz_recovery_extend(recovery, component->num_dofs, component->dof,
                                  NULL, &all, NULL));
    new.view.dof = all;
    new.view.num_dofs += recovery->count;
    RITZ_TRY(ritz_roster_new(new.view.num_dofs, all, &new.roster));
    if (recovery->count > 0)
        RITZ_TRY(ritz_sparse_transpose(&recovery->G, &new.from));
    *out = new;
    new = (ritz_extended){0};
    all = NULL;
done:
    ritz_roster_free(&new.roster);
    ritz_sparse_free(&new.from);
    free(all);
    return status;
}

void ritz_extended_free(ritz_extended *extended)
{
    free(extended->view.dof);
    ritz_roster_free(&extended->roster);
    ritz_sparse_free(&extended->from);
    *extended = (ritz_extended){0};
}
