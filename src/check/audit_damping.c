/*
 * Whether D is proportional, a M + b K. One that is not is no fault: it couples
 * modes.
 */
#include "check/audit_parts.h"
#include "poles/proportional.h"

#include <math.h>
#include <stdio.h>

ritz_status ritz_audit_damping(ritz_auditor *it)
{
    const ritz_component *c = it->component;
    double a = 0.0, b = 0.0, left = 0.0;
    double skew = 0.0;
    char where[RITZ_WHERE_SIZE];

    if (!c->D.colptr)
        return RITZ_OK;
    RITZ_CHECK(ritz_proportional(c, &a, &b, &left));
    skew = ritz_sparse_skew(&c->D);
    snprintf(where, sizeof where, "a = %.6g, b = %.6g", a, b);
    if (skew > 0.0)
        ritz_auditor_say(it, "rayleigh", left, nan(""), RITZ_PASS, where,
                         "D is unsymmetric: %.3g %% of it is gyroscopic",
                         100.0 * skew);
    else
        ritz_auditor_say(it, "rayleigh", left, nan(""), RITZ_PASS, where,
                         left <= RITZ_PROPORTIONAL_WITHIN
                             ? "damping is proportional: D = a M + b K"
                             : "damping is not proportional, it couples modes");
    return RITZ_OK;
}
