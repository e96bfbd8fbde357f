/*
 * Audit of a component before it is reduced. Each check has a measured value,
 * a limit, a verdict, and the grids concerned.
 */
#ifndef RITZ_AUDIT_H
#define RITZ_AUDIT_H

#include <ritz/component.h>

typedef enum ritz_verdict {
    RITZ_PASS,
    RITZ_WARN,
    RITZ_FAIL,
} ritz_verdict;

enum { RITZ_WHERE_SIZE = 192 };

typedef struct ritz_check {
    char name[RITZ_NAME_SIZE]; /* "rigid-modes-geometry" */
    double value, limit;       /* NaN where there is none */
    ritz_verdict verdict;
    char where[RITZ_WHERE_SIZE]; /* "grid 101 T3, grid 205 R1"; "" nowhere */
    char says[RITZ_WHERE_SIZE];  /* a sentence in the user's terms */
} ritz_check;

typedef struct ritz_audit {
    int64_t count;
    ritz_check *check;
} ritz_audit;

/** All checks that apply to the component. @cost one factor and few modes */
ritz_status ritz_audit_component(const ritz_component *component,
                                 ritz_audit *out);

/** "pass", "warn", "fail". */
const char *ritz_verdict_name(ritz_verdict verdict);

void ritz_audit_free(ritz_audit *audit);

#endif
