/*
 * A body in a floating frame, as simulators of flexible multibody systems
 * describe it. The frame has the rigid-body motion, and modes describe the
 * deformation relative to the frame,
 *
 *     u = R (motion of the frame) + Psi eta,    Psi = T V - R W
 *
 * where R holds unit rigid motions about the basic origin. W is chosen to
 * satisfy a reference condition: Psi = 0 at the node of the frame (tangent),
 * R'M Psi = 0 (mean axes, [Buckens1963]), or W = 0, which leaves the modes as
 * they are in the basis. Because K R = 0, stiffness and damping do not depend
 * on W.
 *
 * All vectors are along the basic axes.
 */
#ifndef RITZ_MODEL_FLOATING_H
#define RITZ_MODEL_FLOATING_H

#include <ritz/model.h>

typedef enum ritz_frame_condition {
    RITZ_REFERENCE_NONE,      /* W = 0 */
    RITZ_REFERENCE_MEAN_AXIS, /* R'M Psi = 0 */
    RITZ_REFERENCE_TANGENT,   /* Psi = 0 at the frame's node */
} ritz_frame_condition;

typedef struct ritz_floating_request {
    const char *frame;     /* "basic", "centre" or a grid; NULL: "basic" */
    const char *reference; /* "none", "mean-axis", "tangent"; NULL: "none" */
} ritz_floating_request;

typedef struct ritz_floating {
    int64_t count;    /* nodes, by ascending grid id, recovered ones too */
    int64_t *id;      /* count */
    double *position; /* 3 count, from the origin */
    ritz_dense shape; /* 3 count x m, translations; absent ones are 0 */
    ritz_dense turn;  /* 3 count x m, rotations; {0}: no node has any */
    bool *rotates;    /* count: has rotations; others have 0 in `turn` */
    double origin[3]; /* of the frame, from the basic one */
    int64_t grid;     /* grid at which the frame is; -1: none */
    ritz_frame_condition reference;
    ritz_dense V, W;      /* r x m, 6 x m */
    ritz_dense U;         /* r x m, Psi = T U */
    ritz_dense K, M, D;   /* m x m, M = Psi'M Psi; D also has the damping of
                           stated rules; {0}: there is none */
    ritz_inertia inertia; /* its centre from the origin */
    ritz_invariants invariants; /* of Psi, about the origin of the frame: call
                                   ritz_sid_terms_of with origin {0, 0, 0} */
    int64_t num_rigid;          /* rigid motions that the frame takes over */
    bool kept;                  /* the modes are columns of the basis */
    bool structural; /* the component has structural damping, which is left
                        out */
    double lowest_hz, highest_hz; /* of (K, M) */
    double approximate;           /* ritz_inertia_loss.value and .mode */
    int64_t approximate_mode;
} ritz_floating;

/**
 * The modes of a reduced component relative to a moving frame.
 *
 * The frame already has the rigid-body motion. If a mode were rigid too, the
 * mass matrix of frame and modes would be singular. If the columns of kind
 * rigid span all rigid-body motion, they are left out and the other columns are
 * the modes. Otherwise, as for Craig-Bampton, the modes are the eigenvectors of
 * (K_r, M_r) that have stiffness.
 *
 * @return RITZ_ERR_ARGUMENT if the component has no basis, positions, mass or
 *         invariants, has scalar points, or has no flexible mode; if there is
 *         no such frame or reference; if the reference is tangent or mean-axis
 *         and a rigid motion has stiffness; if it is tangent and the frame is
 *         at no grid, or at a grid whose rotation is not known
 * @cost   O(n r m + r^3)
 */
ritz_status ritz_floating_of(const ritz_reduced *reduced,
                             const ritz_floating_request *request,
                             ritz_floating *out);

/** As ritz_floating_of(), with the reference that is usual for the frame:
 * tangent at a grid, mean axes elsewhere, none if no motion is rigid. */
ritz_status ritz_floating_usual(const ritz_reduced *reduced, const char *frame,
                                ritz_floating *out);

/** Name of a reference condition: "mean-axis". */
const char *ritz_frame_condition_name(ritz_frame_condition reference);

void ritz_floating_free(ritz_floating *floating);

#endif
