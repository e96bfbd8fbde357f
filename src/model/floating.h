/*
 * A body in a floating frame: what simulators of flexible multibody systems
 * read. The frame carries rigid-body motion, modes the deformation from it,
 *
 *     u = R (motion of the frame) + Psi eta,    Psi = T V - R W
 *
 * with R unit rigid motions about the basic origin. W makes the reference
 * condition hold: Psi = 0 at the frame's node (tangent), R'M Psi = 0 (mean
 * axes, [Buckens1963]), or W = 0 (modes as the basis has them). K R = 0, so K
 * and D are those of V, whatever W is.
 *
 * Axes are the basic ones, at every node too.
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
    int64_t grid;     /* whose place the origin was set to; -1: none */
    ritz_frame_condition reference;
    ritz_dense V, W;      /* r x m, 6 x m */
    ritz_dense U;         /* r x m, Psi = T U */
    ritz_dense K, M, D;   /* m x m, M = Psi'M Psi; D {0}: no damping, that of
                           stated rules included */
    ritz_inertia inertia; /* its centre from the origin */
    ritz_invariants invariants; /* of Psi, about the origin, which is then
                                   {0, 0, 0} for ritz_sid_terms_of */
    int64_t num_rigid;          /* motions left to the frame */
    bool kept;                  /* columns of the basis as they are */
    bool structural; /* there is structural damping, which is nowhere here */
    double lowest_hz, highest_hz; /* of (K, M) */
    double approximate; /* kinetic energy of a mode of (K, M) that the products
                           of invariants do not hold, relative, at its worst */
    int64_t approximate_mode; /* which, from 0 in the order of eigenvalues */
} ritz_floating;

/**
 * The modes of a reduced component relative to a moving frame.
 *
 * The frame brings rigid-body motion; a mode that is rigid too would make the
 * mass matrix of the whole singular. Columns of kind rigid are left out if they
 * make up all of it, and the others stay as they are; of other bases, as of
 * Craig-Bampton, the eigenvectors of (K_r, M_r) without stiffness are left out.
 *
 * @return RITZ_ERR_ARGUMENT if it holds no basis, positions, mass or invariants,
 *         has scalar points, or is not a flexible body; if there is no such
 *         frame or reference; of a reference but none, if a rigid motion has
 *         stiffness; of tangent, if the frame is at no grid or its node does not
 *         say how it turns
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
