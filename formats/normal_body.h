/*
 * A flexible body in a moving frame, in its own modes: those of the body when
 * the frame is held, scaled to unit mass, whatever the columns of the basis
 * are. Some simulators take M = I for granted, and others are faster so.
 */
#ifndef RITZ_FORMATS_NORMAL_BODY_H
#define RITZ_FORMATS_NORMAL_BODY_H

#include "model/floating.h"

#include <ritz/export.h>

typedef struct ritz_normal_body {
    ritz_floating floating;     /* as requested: nodes, frame, inertia */
    int64_t num_modes;          /* m, in ascending order of K */
    double *hertz;              /* m; negative where K is indefinite */
    double *K;                  /* m, w^2; M = I */
    ritz_dense D;               /* m x m; {0}: none */
    ritz_dense shape, turn;     /* 3 nodes x m; turn {0}: no node rotates */
    ritz_invariants invariants; /* about the origin of the frame */
} ritz_normal_body;

/**
 * @param[in] request  frame and reference. Without a reference, it is the
 *                     tangent of a frame at a grid and mean axes otherwise; of
 *                     a body that cannot move as a rigid one it is none
 * @return as ritz_floating_of and ritz_eigen_dense
 */
ritz_status ritz_normal_body_of(const ritz_reduced *reduced,
                                const ritz_floating_request *request,
                                ritz_normal_body *out);

/** Frame, modes, their scale, and damping. */
ritz_status ritz_normal_body_say(const ritz_reduced *reduced,
                                 const ritz_normal_body *body,
                                 ritz_export_report *report);

void ritz_normal_body_free(ritz_normal_body *body);

#endif
