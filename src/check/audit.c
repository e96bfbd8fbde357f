/* All checks of a component, one after the other. */
#include "check/audit_parts.h"

#include "base/alloc.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void ritz_audit_add(ritz_audit *audit, int64_t most, const ritz_check *found,
                    const char *where, const char *says, va_list values)
{
    ritz_check *check = NULL;

    if (audit->count >= most)
        return;
    check = &audit->check[audit->count++];
    *check = *found;
    snprintf(check->where, sizeof check->where, "%s", where ? where : "");
    vsnprintf(check->says, sizeof check->says, says, values);
}

void ritz_auditor_say(ritz_auditor *it, const char *name, double value,
                      double limit, ritz_verdict verdict, const char *where,
                      const char *says, ...)
{
    ritz_check check = {.value = value, .limit = limit, .verdict = verdict};
    va_list values;

    snprintf(check.name, sizeof check.name, "%s", name);
    va_start(values, says);
    ritz_audit_add(&it->audit, RITZ_AUDIT_MOST, &check, where, says, values);
    va_end(values);
}

void ritz_auditor_list(char where[RITZ_WHERE_SIZE], const char *text)
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

int64_t ritz_auditor_where(const ritz_auditor *it, const bool *flag,
                           char where[RITZ_WHERE_SIZE])
{
    int64_t count = 0;
    char name[RITZ_DOF_NAME_SIZE];

    where[0] = '\0';
    for (int64_t k = 0; k < it->component->num_dofs; k++) {
        if (!flag[k])
            continue;
        count++;
        if (count <= RITZ_SHOWN)
            ritz_auditor_list(where,
                              ritz_dof_name(it->component->dof[k], name));
        else if (count == RITZ_SHOWN + 1)
            ritz_auditor_list(where, "...");
    }
    return count;
}

static void free_auditor(ritz_auditor *it)
{
    free(it->part);
    free(it->mu);
    ritz_dense_free(&it->R);
    ritz_dense_free(&it->Phi);
    ritz_audit_free(&it->audit);
}

ritz_status ritz_audit_component(const ritz_component *component,
                                 ritz_audit *out)
{
    ritz_status status = RITZ_OK;
    ritz_auditor it = {.component = component, .softest = nan("")};
    bool usable = false;
    ritz_status (*const checks[])(ritz_auditor *) = {
        ritz_audit_dofs,   ritz_audit_definite, ritz_audit_geometry,
        ritz_audit_forces, ritz_audit_rigid,    ritz_audit_grounding,
        ritz_audit_mass,   ritz_audit_damping,  ritz_audit_ports,
    };

    RITZ_FAIL_IF(component->num_dofs == 0, RITZ_ERR_ARGUMENT,
                 "the component has no dofs");
    RITZ_NEW(it.audit.check, RITZ_AUDIT_MOST);
    RITZ_TRY(ritz_audit_values(&it, &usable));
    for (size_t k = 0; usable && k < sizeof checks / sizeof *checks; k++)
        RITZ_TRY(checks[k](&it));
    *out = it.audit;
    it.audit = (ritz_audit){0};
done:
    free_auditor(&it);
    return status;
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
