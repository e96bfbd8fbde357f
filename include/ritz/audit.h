/*
 * Audit of a component before it is reduced. Each check has a measured value,
 * a limit, a verdict, and the grids concerned. docs/check.md says what each
 * measures and where its limit comes from. They are, in this order:
 *
 *     finite                    values are finite; if not, the only one
 *     symmetry                  what is, or was, averaged away
 *     massless-dofs             empty rows of M
 *     unconnected-dofs          empty rows of K            (if there is K)
 *     separate-bodies           connected parts of K + M
 *     mass-definite             negative eigenvalues of M
 *     stiffness-definite        the same of K              (if there is K)
 *     positions                 dofs of grids without one
 *     rigid-modes-geometry      free motions by positions  (if there is K)
 *     rigid-modes-null-space    by the inertia of K        (if there is K)
 *     rigid-modes-eigenvectors  by eigenvectors
 *     rigid-modes-agree         angle between the two      (if there is K)
 *     grounding-translation     forces K r                 (if there is K)
 *     grounding-rotation        the same       (if there is K, positions)
 *     source-digits             and what they do           (if there is K)
 *     mass-translations         the same along all axes
 *     mass-coupling             none about the mass centre (if there is mass)
 *     inertia-tensor            that of a body   (if positions, all motions)
 *     rayleigh                  D = a M + b K?             (if there is D)
 *     port-dofs                 six or more                (if ports)
 *     port-collinear            no rotation is left loose  (if ports)
 *     port-dependent            no dof in two ports        (if ports)
 *     port-positions            no two grids in one place  (if ports)
 *     port-disconnected         ports are part of the body (if ports)
 */
#ifndef RITZ_AUDIT_H
#define RITZ_AUDIT_H

#include <ritz/component.h>

#pragma GCC visibility push(default)

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

#pragma GCC visibility pop

#endif
