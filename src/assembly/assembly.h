/*
 * The steps of assembly: what a joint asks of two ports, where bodies are,
 * constraints and springs, and the assembly of bodies with force columns.
 */
#ifndef RITZ_ASSEMBLY_ASSEMBLY_H
#define RITZ_ASSEMBLY_ASSEMBLY_H

#include <ritz/assembly.h>
#include <ritz/scene.h>

/* The request for a basis of a body of a scene, with what it needs. */
typedef struct ritz_body_request {
    ritz_request asked;
    ritz_dofs attached;       /* asked.attached */
    ritz_neighbour neighbour; /* *asked.neighbour, if the method uses it */
} ritz_body_request;

/**
 * The request that ritz_stage_reduce makes for component @p k of a scene. It
 * must not be copied.
 *
 * @param[in] item, component  borrowed until free
 * @return RITZ_ERR_ARGUMENT if there is no such method or port
 */
ritz_status ritz_body_request_new(const ritz_scene *scene, int64_t k,
                                  const ritz_scene_component *item,
                                  const ritz_component *component,
                                  ritz_body_request *out);
void ritz_body_request_free(ritz_body_request *request);

/** Whether the same ports of components @p j and @p k of a scene are attached
 * where @p item of each names none. */
ritz_status ritz_stage_same_ports(const ritz_scene *scene, int64_t j, int64_t k,
                                  bool *same);

/* The relations of a joint between the motions of two ports. */

/* One end of a joint; the port's map is not used. */
typedef struct ritz_joint_end {
    const char *component; /* name, for messages */
    const ritz_port_map *port;
} ritz_joint_end;

/*
 * The position of the second body: a point x_B of it is at o_A + d + R (x_B -
 * o_B) in the basic axes of the first, o being the origins of the ports.
 */
typedef struct ritz_joint_pose {
    double R[9]; /* row by row */
    double d[3];
    double axis[2][3]; /* as those of the joint, to all digits */
} ritz_joint_pose;

/*
 * A relative motion, r = sum_k b[k] u_B[k] - sum_k a[k] u_A[k] over the port
 * rows: zero where locked, the elongation of a spring where caged.
 */
typedef struct ritz_relation {
    const ritz_joint *joint;
    const ritz_port_map *port[2];
    bool rotation;
    const ritz_freedom
        *freedom; /* of the joint; where the joint's type allows no motion, a
                     locked one */
    int64_t num_terms[2];
    int64_t row[2][6]; /* port rows of either end */
    double factor[2][6];
} ritz_relation;

/** Coefficient of the relation at one end for coordinate @p j of that body. */
static inline double ritz_relation_at(const ritz_relation *relation, int end,
                                      int64_t j)
{
    const double *map = ritz_dense_col(&relation->port[end]->map, j);
    double sum = 0.0;

    for (int64_t k = 0; k < relation->num_terms[end]; k++)
        sum += relation->factor[end][k] * map[relation->row[end][k]];
    return sum;
}

typedef struct ritz_relations {
    int64_t count, room;
    ritz_relation *item;
} ritz_relations;

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

/* Plane models. */

/** Whether a direction, 1-6, is a motion in the plane; without a plane every
 * direction is. */
bool ritz_plane_has(ritz_plane plane, int64_t component);

/**
 * Refuse a model, or a port with directions along basic axes, that does not lie
 * in the plane or can move out of it. Scalar points are accepted.
 *
 * @return RITZ_ERR_ARGUMENT naming the dof or the grids
 */
ritz_status ritz_plane_check_dofs(ritz_plane plane, int64_t count,
                                  const ritz_dof *dof, const ritz_grids *grids);
ritz_status ritz_plane_check_port(ritz_plane plane, const ritz_port_map *port);

/* Rotations and directions in space, 3 x 3 row by row. */

/** Rotation by @p degrees about a unit axis; quarter turns are exact. */
void ritz_turn_about(const double axis[static 3], double degrees,
                     double R[static 9]);

/** Two unit vectors normal to a unit axis and to each other. */
void ritz_joint_normals(const double axis[static 3], double e[static 2][3]);

/** C = A B. */
void ritz_turn_product(const double A[static 9], const double B[static 9],
                       double C[static 9]);

/** y = R x, and y = R'x. */
void ritz_turn_apply(const double R[static 9], const double x[static 3],
                     double y[static 3]);
void ritz_turn_back(const double R[static 9], const double x[static 3],
                    double y[static 3]);

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

/* Positions of bodies at a configuration. */

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

/** Places of all bodies where joints have such poses, a row of twelve numbers
 * each, as ritz_configuration.places. */
ritz_status ritz_place_posed(const ritz_stage *stage,
                             const ritz_joint_pose *pose, ritz_dense *out);

/** Whether joints of a scene, bushings among them, close a loop. */
ritz_status ritz_scene_loops(const ritz_scene *scene, bool *closed);

/* Closed loops of joints, without those that bushings close. */
typedef struct ritz_loops {
    int64_t count, num_joints;
    double *sign; /* count x num_joints: 1 where a loop goes from the first body
                     of a joint to the second, -1 back, 0 not through it */
} ritz_loops;

/** The loops of a stage that tie its bodies if these are rigid. */
ritz_status ritz_loops_of(const ritz_stage *stage, ritz_loops *out);
void ritz_loops_free(ritz_loops *loops);

/**
 * Turn axes of joints in closed loops, by no more than the digits that a scene
 * gives, to where the loops can move.
 *
 * @param[in,out] pose  as ritz_place_joints gives it; its axes
 * @param[out]    out   as ritz_stage_near_axes; NULL: not wanted
 */
ritz_status ritz_settle_axes(const ritz_stage *stage, ritz_joint_pose *pose,
                             ritz_near_axes *out);

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
 * Place all bodies of a configuration that already has its P, and find momentum
 * and mass of the system's rigid motion; these two stay empty if a body's own
 * are unknown.
 */
ritz_status ritz_place_configuration(const ritz_stage *stage,
                                     const double *setting,
                                     ritz_configuration *configuration);

/** Rotations and translations of all bodies, a row of twelve numbers each, as
 * ritz_configuration.places. */
ritz_status ritz_place_stage(const ritz_stage *stage, const double *setting,
                             ritz_dense *out);

/* A stage whose bodies turn at the constant rate of the scene: K, D and io are
   its own, all else is borrowed from the stage at rest. */
typedef struct ritz_spun {
    ritz_stage stage;
} ritz_spun;

/**
 * @return RITZ_ERR_ARGUMENT if a body has no invariants, a load is missing, a
 *         stiffening is of another origin, or bodies have force columns
 */
ritz_status ritz_stage_spun(const ritz_stage *stage, const double *setting,
                            ritz_spun *out);
void ritz_spun_free(ritz_spun *spun);

/** Refuse a scene that spins, for methods without spin. @return
 * RITZ_ERR_ARGUMENT if it spins */
ritz_status ritz_spin_refuse(const ritz_scene *scene);

/*
 * The springs and dampers of caged directions. Spring k is stretched by row k
 * of S q: it adds k_k s_k s_k' to K, and its damper c_k s_k s_k' to D.
 */
typedef struct ritz_springs {
    ritz_dense S; /* springs x Q */
    ritz_relations of;
} ritz_springs;

/**
 * The springs of all joints at some settings, in the coordinates of the stage.
 */
ritz_status ritz_stage_springs(const ritz_stage *stage, const double *setting,
                               ritz_springs *out);

/** Rows S q = 0 of all motions that joints lock, without scales. */
ritz_status ritz_stage_locks(const ritz_stage *stage, const double *setting,
                             ritz_springs *out);

/**
 * K += P'S' k S P, or with @p damping D += P'S' c S P. An empty matrix stays
 * {0} if there is nothing to add.
 */
ritz_status ritz_springs_add(const ritz_springs *springs, bool damping,
                             const ritz_dense *P, ritz_dense *A);

/**
 * The same without P, where the coordinates are some of the n of a full model.
 *
 * @param[in] at  Q, the index of each coordinate among the n
 */
ritz_status ritz_springs_add_sparse(const ritz_springs *springs, bool damping,
                                    int64_t n, const int64_t *at,
                                    ritz_sparse *A);

void ritz_springs_free(ritz_springs *springs);

/**
 * Orthonormal columns that span the null space of C, c x n.
 *
 * @param[out] rank  singular values above 1e-9 of the largest
 * @param[out] out   n x (n - rank)
 * @cost   O(n^2 c)
 */
ritz_status ritz_null_space(const ritz_dense *C, int64_t *rank,
                            ritz_dense *out);

/* Bodies with force columns, which are joined by interface forces. */

/** Whether a body of the stage has columns of kind force. */
bool ritz_dual_is_due(const ritz_stage *stage);

/**
 * RITZ_ERR_ARGUMENT naming the first body with force columns; for methods that
 * choose modes.
 */
ritz_status ritz_dual_refuse(const ritz_stage *stage);

/**
 * A system with force columns in its modal coordinates: rank, lambda,
 * num_rigid and, among the errors, the number of negative eigenvalues.
 *
 * @param[in]  C  constraints, columns of scaled coordinates
 * @param[out] P  Q x e, coordinates of the bodies by modes of the system
 * @return RITZ_ERR_SINGULAR if force columns have no stiffness
 */
ritz_status ritz_dual_assemble(const ritz_stage *stage,
                               const ritz_springs *springs, const ritz_dense *C,
                               ritz_dense *P, ritz_configuration *c);

/**
 * Name of a body's load in a system, "body:load": containers have it as the
 * name of a group, in which '/' would begin another one.
 *
 * @return RITZ_ERR_ARGUMENT if it is too long
 */
ritz_status ritz_body_load_name(const char *body, const char *load,
                                char out[RITZ_NAME_SIZE]);

/**
 * How many configurations of a stage to work on between two looks at whether to
 * stop: one, or of a small stage some for each thread.
 */
int64_t ritz_stage_round(const ritz_stage *stage);

/** Threads that work on @p count configurations of a stage, each on one at a
 * time: one, unless the stage is small. */
int ritz_stage_threads(const ritz_stage *stage, int64_t count);

/**
 * ritz_stage_assemble() at some settings. The threads of the team share small
 * systems out among them.
 *
 * @param[in]  setting  of each
 * @param[out] out      count; after a failure some are not empty
 * @return the failure of the first of them that fails
 */
ritz_status ritz_stage_assemble_some(const ritz_stage *stage, int64_t count,
                                     const double *const *setting,
                                     ritz_configuration *out);

/** All configurations of the scene, as ritz_assemble does, until @p stop ends
 * it; at least one. @param[in] stop  NULL: nothing ends it */
ritz_status ritz_assemble_until(const ritz_stage *stage, const ritz_stop *stop,
                                ritz_system *out);

/** Whether the work is to end now. @param[in] stop  NULL: never */
bool ritz_stop_asked(const ritz_stop *stop);

/** diag(V_1, V_2, ...), with a matrix for each body of the stage. */
ritz_status ritz_stage_expansion(const ritz_stage *stage, const ritz_dense *V,
                                 ritz_dense *out);

#endif
