/*
 * A flexible body in a moving frame, described by its eigenvectors with the
 * frame held, scaled to unit modal mass, instead of the columns of the basis.
 * Some simulators assume M = I, and others are faster with it.
 */
#ifndef RITZ_FORMATS_NORMAL_BODY_H
#define RITZ_FORMATS_NORMAL_BODY_H

#include "model/floating.h"

#include <ritz/export.h>

typedef struct ritz_normal_body {
    ritz_floating floating; /* as requested: nodes, frame, inertia */
    int64_t num_modes;      /* m, in ascending order of K */
    double *hertz;          /* m; negative where w^2 < 0 */
    double *K;              /* m, the diagonal w^2; M = I */
    ritz_dense D;           /* m x m; {0}: none */
    ritz_dense U; /* r x m, coordinates of the reduced component of each mode */
    ritz_dense shape, turn;     /* 3 nodes x m; turn {0}: no node rotates */
    ritz_invariants invariants; /* about the origin of the frame */
} ritz_normal_body;

/**
 * Describe a reduced component by its eigenvectors relative to a frame.
 *
 * @param[in] request  frame and reference. If it names no reference, modes are
 *                     tangent to a frame at a grid, and otherwise referred to
 *                     mean axes. If the body has no rigid motion, the reference
 *                     is "none"
 * @return as ritz_floating_of and ritz_eigen_dense
 */
ritz_status ritz_normal_body_of(const ritz_reduced *reduced,
                                const ritz_floating_request *request,
                                ritz_normal_body *out);

/** Report the frame, the modes and their scale, and damping. */
ritz_status ritz_normal_body_say(const ritz_reduced *reduced,
                                 const ritz_normal_body *body,
                                 ritz_export_report *report);

void ritz_normal_body_free(ritz_normal_body *body);

#endif
