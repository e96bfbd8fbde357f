/* Values: finite and symmetric. */
#include "check/audit_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Asymmetry that importing lets pass, contracts.md. */
static const double symmetric_within = 1e-6;

/* Entries that are not finite; their rows are flagged. */
static int64_t count_infinite(const ritz_sparse *A, bool *flag)
{
    int64_t count = 0;

    for (int64_t j = 0; A->colptr && j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (!isfinite(A->val[p])) {
                flag[A->rowind[p]] = true;
                count++;
            }
    return count;
}

static ritz_status check_finite(ritz_auditor *it, bool *usable)
{
    ritz_status status = RITZ_OK;
    const ritz_component *c = it->component;
    const ritz_sparse *const all[4] = {&c->K, &c->M, &c->D, &c->K4};
    bool *flag = NULL;
    char where[RITZ_WHERE_SIZE];
    int64_t count = 0;

    RITZ_NEW(flag, c->num_dofs);
    for (int k = 0; k < 4; k++)
        count += count_infinite(all[k], flag);
    ritz_auditor_where(it, flag, where);
    *usable = count == 0;
    ritz_auditor_say(it, "finite", (double)count, 0.0,
                     count == 0 ? RITZ_PASS : RITZ_FAIL, where,
                     count == 0 ? "all values are finite"
                                : "values that are not finite: no other check "
                                  "can be made");
done:
    free(flag);
    return status;
}

static void check_symmetry(ritz_auditor *it)
{
    const ritz_component *c = it->component;
    /* not D, whose gyroscopic part is not symmetric by right */
    const ritz_sparse *const all[3] = {&c->K, &c->M, &c->K4};
    double now = 0.0;
    double found = 0.0;

    for (int k = 0; k < 3; k++)
        if (all[k]->colptr)
            now = fmax(now, ritz_sparse_asymmetry(all[k]));
    found = fmax(now, c->asymmetry);
    if (now > symmetric_within)
        ritz_auditor_say(it, "symmetry", found, symmetric_within, RITZ_FAIL,
                         NULL, "the matrices are not symmetric");
    else if (found > symmetric_within)
        ritz_auditor_say(it, "symmetry", found, symmetric_within, RITZ_WARN,
                         NULL,
                         "the source was not symmetric, and was averaged");
    else
        ritz_auditor_say(
            it, "symmetry", found, symmetric_within, RITZ_PASS, NULL,
            found > 0.0 ? "rounding only, averaged away" : "exactly symmetric");
}

ritz_status ritz_audit_values(ritz_auditor *it, bool *usable)
{
    const ritz_component *c = it->component;

    it->rigid = !c->K.colptr || c->K.colptr[c->K.ncol] == 0;
    RITZ_CHECK(check_finite(it, usable));
    if (!*usable)
        return RITZ_OK;
    check_symmetry(it);
    if (it->rigid)
        it->digits = 17.0;
    else
        RITZ_CHECK(ritz_audit_digits(it));
    return RITZ_OK;
}
