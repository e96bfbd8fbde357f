/* Positions of bodies at a configuration. */
#ifndef RITZ_ASSEMBLY_PLACEMENT_H
#define RITZ_ASSEMBLY_PLACEMENT_H

#include "assembly/joints.h"

#include <ritz/assembly.h>

/* x_system = R x + t. */
typedef struct ritz_placement {
    bool known;
    double R[9];
    double t[3];
} ritz_placement;

/**
 * The pose of each joint of the scene at some settings; that of a joint which
 * closes a loop follows from the other joints.
 *
 * A loop that does not close is refused: its two ways around place a body
 * differently.
 *
 * @param[out] pose  one for each joint
 * @return RITZ_ERR_ARGUMENT naming the joint that closes it, and the gap
 */
ritz_status ritz_place_joints(const ritz_stage *stage, const double *setting,
                              ritz_joint_pose *pose);

/**
 * Grids of all bodies in the basic frame of the first (of each tree of joints).
 *
 * @param[in]  stage  of the same bodies: its ports have the joints' origins
 * @param[out] add    count, what to add to the grid numbers of each body so
 *                    that no two are the same
 */
ritz_status ritz_place_grids(const ritz_stage *stage, const double *setting,
                             int64_t count, const ritz_component *body,
                             int64_t *add, ritz_grids *out);

/**
 * Momentum and mass of rigid motion of all bodies at their positions, for a
 * configuration that has its P; empty where a body's own are unknown.
 */
ritz_status ritz_place_mass(const ritz_stage *stage, const double *setting,
                            ritz_configuration *configuration);

#endif
