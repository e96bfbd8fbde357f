/*
 * Synthesis: components joined at a configuration, C(alpha) q = 0.
 *
 * At settings 0 the basic axes of both bodies of a joint are parallel and their
 * port origins coincide; a positive angle turns the second body right-handed
 * about the axis, given in the basic frame of the first, and a positive
 * position moves it along the axis. A setting is degrees or a length.
 */
#ifndef RITZ_SYNTHESIS_H
#define RITZ_SYNTHESIS_H

#include <ritz/method.h>
#include <ritz/reduced.h>
#include <ritz/scene.h>
#include <ritz/system.h>

#pragma GCC visibility push(default)

/* A scene with its models loaded and reduced: what stage one has made. */
typedef struct ritz_stage {
    const ritz_scene *scene; /* borrowed */
    int64_t count;
    ritz_reduced *body;      /* one for each component of the scene */
    int64_t num_coordinates; /* Q, of all bodies side by side */
    int64_t *first;          /* of each body's coordinates among them */
    ritz_io io;              /* the scene's inputs and outputs, for Q */
    ritz_dampers
        dampers; /* "body/name", for Q; the bodies' D and K hold them */
} ritz_stage;

/**
 * Load the models of a scene and reduce each as it says. A model that is
 * reduced already is taken as it is, and then the scene names no basis.
 *
 * Attached are the ports that the scene names, or else those of every joint
 * and input.
 */
ritz_status ritz_stage_new(const ritz_scene *scene, ritz_stage *out);

/**
 * The model of component @p k of a scene, its ports checked: a full one, or one
 * that is reduced already; the other stays empty.
 */
ritz_status ritz_stage_load(const ritz_scene *scene, int64_t k,
                            ritz_component *full, ritz_reduced *reduced);

/**
 * Reduce that full model as @p item says, which may be the scene's own or
 * another: its basis, modes, up_to_hz, attach and choice are used.
 */
ritz_status ritz_stage_reduce(const ritz_scene *scene, int64_t k,
                              const ritz_scene_component *item,
                              const ritz_component *component,
                              ritz_reduced *out);

/**
 * A stage of bodies that are there already, in the order of the scene.
 *
 * @param[in,out] body  scene->num_components, moved into the stage: on success
 *                      left empty, on failure still the caller's; their
 *                      dampers are installed
 */
ritz_status ritz_stage_from(const ritz_scene *scene, ritz_reduced *body,
                            ritz_stage *out);

/** 1 / sqrt(M_jj) of each coordinate, or 1 / sqrt(K_jj) if it has no mass. */
void ritz_stage_scale(const ritz_stage *stage, double *scale);

/**
 * Constraint rows C q = 0 of all that joints lock at some settings, c x Q.
 *
 * Columns are those of scaled coordinates, rows of one joint and kind
 * (translations, rotations) are divided by the largest norm among them, so that
 * singular values tell rank apart from rounding.
 *
 * @param[in] setting  one for each sweep of the scene
 * @param[in] scale      Q, as ritz_stage_scale gives it
 */
ritz_status ritz_stage_constraints(const ritz_stage *stage,
                                   const double *setting, const double *scale,
                                   ritz_dense *out);

/**
 * The system at some settings: null space P of the constraints, their rank by
 * singular values above 1e-9 of the largest, then its modes as coordinates.
 *
 * @cost O(Q^2 c + e^3)
 */
ritz_status ritz_stage_assemble(const ritz_stage *stage, const double *setting,
                                ritz_configuration *out);

/** The system at every configuration of the scene, or at @p at alone. */
ritz_status ritz_assemble(const ritz_stage *stage, const char *at,
                          ritz_system *out);

/**
 * The full-order system at some settings as one component: constraints
 * eliminated sparsely, dofs of all bodies side by side, in the basic frame of
 * the first body. Grids are renumbered where two bodies use one number: those
 * of body k, from 0, by k times the next power of ten.
 *
 * Whatever basis the scene names, the full model is taken.
 *
 * @return RITZ_ERR_ARGUMENT if a model is reduced already
 */
ritz_status ritz_assemble_full(const ritz_scene *scene, const double *setting,
                               ritz_component *out);

/* Which dof of which body a dof of the full-order system is. */
typedef struct ritz_master {
    int64_t body, dof;
} ritz_master;

/**
 * The same, and where its dofs are; bodies ascend, and dofs of each.
 *
 * @param[out] where  out->num_dofs; the caller's to free
 */
ritz_status ritz_assemble_masters(const ritz_scene *scene,
                                  const double *setting, ritz_component *out,
                                  ritz_master **where);

/**
 * T of the system at a configuration, n x e, over the dofs of the full-order
 * system there: rows of T_c P_c of each body. With it the system's matrices are
 * those of the full one condensed, since ports move in both as T says.
 *
 * @return RITZ_ERR_ARGUMENT if a body has no T, or one of other dofs
 */
ritz_status ritz_stage_basis(const ritz_stage *stage,
                             const ritz_configuration *at, int64_t n,
                             const ritz_master *master, ritz_dense *out);

/* A component at one side of a joint, and what messages call it. */
typedef struct ritz_joined {
    const char *name;
    const ritz_component *component;
} ritz_joined;

/** Nothing hangs on @p attached dofs yet. */
ritz_status ritz_neighbour_new(int64_t attached, ritz_neighbour *out);

/**
 * Add what the body at the other side of a joint hangs on a component: its mass
 * and stiffness condensed to its port, as the joint lets the component feel
 * them. A motion that the joint frees is not loaded.
 *
 * @param[in]     setting   of all sweeps of the scene; NULL if it has none
 * @param[in]     near      which side is the component that is loaded
 * @param[in]     attached  its dofs, those of the joint's port among them
 * @param[in,out] sum       attached x attached
 * @return RITZ_ERR_ARGUMENT if ports do not fit or are not attached,
 *         RITZ_ERR_SINGULAR if the other body moves while its port is held
 */
ritz_status ritz_joint_neighbour(const ritz_joint *joint, const double *setting,
                                 const ritz_joined side[static 2], int near,
                                 const ritz_dofs *attached,
                                 ritz_neighbour *sum);

void ritz_neighbour_free(ritz_neighbour *neighbour);

void ritz_stage_free(ritz_stage *stage);

#pragma GCC visibility pop

#endif
