/* The relations of a joint between the motions of two port grids, and rotations
   in space. */
#ifndef RITZ_ASSEMBLY_JOINTS_H
#define RITZ_ASSEMBLY_JOINTS_H

#include <ritz/assembly.h>
#include <ritz/scene.h>

/*
 * One end of a joint: the rows of its port, whatever coordinates they map from.
 */
typedef struct ritz_joint_end {
    const char *component; /* names, for messages */
    const char *port;
    const double *origin;   /* 3, of the port */
    int64_t count;          /* p rows of displacement along basic axes */
    const ritz_dof *dof;    /* p, grid and direction of each */
    const double *position; /* p x 3, of their grids */
} ritz_joint_end;

/*
 * The position of the second body: a point x_B of it is at o_A + d + R (x_B -
 * o_B) in the basic axes of the first, o being the origins of the ports.
 */
typedef struct ritz_joint_pose {
    double R[9]; /* row by row */
    double d[3];
} ritz_joint_pose;

/*
 * A relative motion, r = sum_k b[k] u_B[k] - sum_k a[k] u_A[k] over the port
 * rows: zero where locked, the elongation of a spring where caged.
 */
typedef struct ritz_relation {
    int64_t joint; /* of the scene, where there are several */
    bool rotation;
    ritz_freedom freedom;
    int64_t num_terms[2];
    int64_t row[2][6]; /* port rows of either end */
    double factor[2][6];
} ritz_relation;

typedef struct ritz_relations {
    int64_t count, room;
    ritz_relation *item;
} ritz_relations;

/** The end of a joint at a port. */
ritz_joint_end ritz_joint_end_at(const char *component,
                                 const ritz_port_map *port);

/**
 * Name, origin, dofs and positions of a port, and how its dofs turn into the
 * motions along basic axes.
 *
 * @param[out] turn  p x p
 * @param[out] out   without its map
 */
ritz_status ritz_port_describe(const ritz_component *component,
                               const ritz_port *port, ritz_dense *turn,
                               ritz_port_map *out);

/** The pose that a joint's settings give, @p setting being all of the scene. */
void ritz_joint_pose_at(const ritz_joint *joint, const double *setting,
                        ritz_joint_pose *out);

/**
 * Append the relative motions that a joint locks or holds on springs.
 *
 * @return RITZ_ERR_ARGUMENT if the ports do not fit: a grid has no counterpart
 *         within the tolerance, or a port is not the one six-dof grid that the
 *         joint needs
 */
ritz_status ritz_joint_relate(const ritz_joint *joint,
                              const ritz_joint_end end[static 2],
                              const ritz_joint_pose *pose,
                              ritz_relations *list);

void ritz_relations_free(ritz_relations *relations);

/**
 * The neighbours of component @p k of a scene at its first configuration, by
 * all its joints; the other components are read for it.
 *
 * @param[out] out  zero matrices if no joint holds the component
 * @return RITZ_ERR_ARGUMENT if a neighbour is reduced already
 */
ritz_status ritz_scene_neighbour(const ritz_scene *scene, int64_t k,
                                 const ritz_component *component,
                                 const ritz_dofs *attached,
                                 ritz_neighbour *out);

/* Rotations and directions in space, 3 x 3 row by row. */

/** Rotation by @p degrees about a unit axis; quarter turns are exact. */
void ritz_turn_about(const double axis[static 3], double degrees,
                     double R[static 9]);

/** C = A B. */
void ritz_turn_product(const double A[static 9], const double B[static 9],
                       double C[static 9]);

/** C = A'B. */
void ritz_turn_between(const double A[static 9], const double B[static 9],
                       double C[static 9]);

/** y = R x, and y = R'x. */
void ritz_turn_apply(const double R[static 9], const double x[static 3],
                     double y[static 3]);
void ritz_turn_back(const double R[static 9], const double x[static 3],
                    double y[static 3]);

/** c = a x b. */
void ritz_cross(const double a[static 3], const double b[static 3],
                double c[static 3]);

double ritz_dot(const double a[static 3], const double b[static 3]);

#endif
