/* Constraint rows of joints: what two port grids have in common. */
#ifndef RITZ_SYNTHESIS_JOINTS_H
#define RITZ_SYNTHESIS_JOINTS_H

#include <ritz/scene.h>

/* One end of a joint: where its port's rows are, whatever they map from. */
typedef struct ritz_joint_end {
    const char *component; /* names, for messages */
    const char *port;
    const double *origin;   /* 3, of the port */
    int64_t count;          /* p rows of displacement along basic axes */
    const ritz_dof *dof;    /* p, what they are */
    const double *position; /* p x 3, of their grids */
} ritz_joint_end;

/* One constraint: sum_k a[k] u_A[k] = sum_k b[k] u_B[k] over the port rows. */
typedef struct ritz_constraint {
    bool rotation;
    int64_t num_terms[2];
    int64_t row[2][3]; /* port rows of either end */
    double factor[2][3];
} ritz_constraint;

typedef struct ritz_constraints {
    int64_t count;
    ritz_constraint *item;
} ritz_constraints;

/**
 * The constraints of a joint.
 *
 * @param[in] setting  of a hinge
 * @return RITZ_ERR_ARGUMENT if the ports do not fit: grids without a partner
 *         within the tolerance, a hinge on other than one six-dof grid
 */
ritz_status ritz_joint_constrain(const ritz_joint *joint,
                                 const ritz_joint_end end[static 2],
                                 double setting, ritz_constraints *out);

/** Rotation by @p setting about a unit axis, row by row. */
void ritz_joint_rotation(const double axis[static 3], double setting,
                         double R[static 9]);

void ritz_constraints_free(ritz_constraints *constraints);

#endif
