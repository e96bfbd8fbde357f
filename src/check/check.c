/* Shared by all checks: saying what was found, and naming where. */
#include "check/check.h"

#include "base/alloc.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SHOWN = 4, /* dofs that a line names before it says "..." */
};

void ritz_checker_say(ritz_checker *it, const char *name, double value,
                      double limit, ritz_verdict verdict, const char *where,
                      const char *says, ...)
{
    ritz_check *check = NULL;
    va_list values;

    if (it->audit.count >= RITZ_MOST_CHECKS)
        return;
    check = &it->audit.check[it->audit.count++];
    *check = (ritz_check){.value = value, .limit = limit, .verdict = verdict};
    snprintf(check->name, sizeof check->name, "%s", name);
    snprintf(check->where, sizeof check->where, "%s", where ? where : "");
    va_start(values, says);
    vsnprintf(check->says, sizeof check->says, says, values);
    va_end(values);
}

void ritz_checker_list(char where[RITZ_WHERE_SIZE], const char *text)
{
    size_t used = strlen(where);
    size_t left = RITZ_WHERE_SIZE - used;
    const char *comma = used > 0 ? ", " : "";
    const char *const full = ", ...";

    if (used >= strlen(full) && strcmp(where + used - 3, "...") == 0)
        return;
    if (strlen(comma) + strlen(text) + strlen(full) < left)
        snprintf(where + used, left, "%s%s", comma, text);
    else if (strlen(full) < left)
        snprintf(where + used, left, "%s", full);
}

int64_t ritz_checker_dofs(const ritz_checker *it, const bool *flag,
                          char where[RITZ_WHERE_SIZE])
{
    int64_t count = 0;
    char name[RITZ_DOF_NAME_SIZE];

    where[0] = '\0';
    for (int64_t k = 0; k < it->component->num_dofs; k++) {
        if (!flag[k])
            continue;
        count++;
        if (count <= SHOWN)
            ritz_checker_list(where,
                              ritz_dof_name(it->component->dof[k], name));
        else if (count == SHOWN + 1)
            ritz_checker_list(where, "...");
    }
    return count;
}

ritz_status ritz_check_eigen(const ritz_dense *A, ritz_pairs *out)
{
    RITZ_OWN(ritz_dense) unit = {0};

    RITZ_CHECK(ritz_dense_new(A->nrow, A->nrow, &unit));
    for (int64_t k = 0; k < A->nrow; k++)
        ritz_dense_col(&unit, k)[k] = 1.0;
    return ritz_eigen_dense(A, &unit, out);
}

const char *ritz_verdict_name(ritz_verdict verdict)
{
    static const char *const names[] = {
        [RITZ_PASS] = "pass", [RITZ_WARN] = "warn", [RITZ_FAIL] = "fail"};

    return names[verdict];
}

void ritz_audit_free(ritz_audit *audit)
{
    free(audit->check);
    *audit = (ritz_audit){0};
}
