/* No reduction: every dof a column. For small components and comparisons. */
#include "bases/columns.h"

#include <inttypes.h>
#include <stdio.h>

enum { MOST = 5000 }; /* 200 MB of identity, and dense matrices after it */

static ritz_status make_full(const ritz_request *request, ritz_basis *out)
{
    int64_t n = request->component->num_dofs;

    RITZ_REFUSE_IF(n > MOST, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " dofs are too many to keep all, %d is the most",
                   n, MOST);
    RITZ_CHECK(ritz_basis_new(n, n, out));
    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(&out->T, j)[j] = 1.0;
        ritz_columns_label_dofs(1, &j, j, &out->columns);
    }
    snprintf(out->origin.engine, sizeof out->origin.engine, "identity");
    return RITZ_OK;
}

const ritz_method ritz_method_full = {
    .name = "full",
    .summary = "every dof kept, for comparison (small components)",
    .reference = "CraigBampton1968",
    .when = "to compare with, up to some hundred dofs",
    .cost = "none; everything that follows is dense",
    .holds = "everything",
    .fails = "components that are not small",
    .make = make_full,
};
