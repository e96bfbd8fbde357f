/* Shared by all checks: saying what was found, and naming where. */
#include "check/check.h"

#include <math.h>
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

    if (it->audit.count >= it->room)
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

void ritz_checker_flagged(ritz_checker *it, const char *name, const bool *flag,
                          ritz_verdict verdict, const char *none,
                          const char *some)
{
    char where[RITZ_WHERE_SIZE];
    int64_t count = ritz_checker_dofs(it, flag, where);

    ritz_checker_say(it, name, (double)count, 0.0,
                     count == 0 ? RITZ_PASS : verdict, where, "%s",
                     count == 0 ? none : some);
}

bool ritz_checker_settled(ritz_checker *it, const char *name, const char *proof)
{
    bool none = it->space ? it->pairs.B.ncol == 0 : it->L.nrow == 0;

    if (none)
        ritz_checker_say(
            it, name, nan(""), nan(""), RITZ_PASS, "", "not applicable: no %s",
            it->space ? "input and output of one name" : "port and no input");
    else if (it->definite)
        ritz_checker_say(it, name, 0.0, 0.0, RITZ_PASS, "", "proven: %s",
                         proof);
    return none || it->definite;
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
