/*
 * Synthesis: components joined at a configuration, C(alpha) q = 0.
 *
 * At angle 0 the basic axes of both bodies of a joint are parallel and their
 * port origins coincide; a positive angle turns the second body right-handed
 * about the axis, given in the basic frame of the first.
 */
#ifndef RITZ_SYNTHESIS_H
#define RITZ_SYNTHESIS_H

#include <ritz/reduced.h>
#include <ritz/scene.h>
#include <ritz/system.h>

/* A scene with its models loaded and reduced: what stage one has made. */
typedef struct ritz_stage {
    const ritz_scene *scene; /* borrowed */
    int64_t count;
    ritz_reduced *body;      /* one for each component of the scene */
    int64_t num_coordinates; /* Q, of all bodies side by side */
    int64_t *first;          /* of each body's coordinates among them */
    ritz_io io;              /* the scene's inputs and outputs, for Q */
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
 * A stage of bodies that are there already, in the order of the scene.
 *
 * @param[in,out] body  scene->num_components, moved into the stage: on success
 *                      left empty, on failure untouched
 */
ritz_status ritz_stage_from(const ritz_scene *scene, ritz_reduced *body,
                            ritz_stage *out);

/** 1 / sqrt(M_jj) of each coordinate, or 1 / sqrt(K_jj) if it has no mass. */
void ritz_stage_scale(const ritz_stage *stage, double *scale);

/**
 * Constraint rows C q = 0 of all joints at some angles, c x Q.
 *
 * Columns are those of scaled coordinates, rows of one joint and kind
 * (translations, rotations) are divided by the largest norm among them, so that
 * singular values tell rank apart from rounding.
 *
 * @param[in] setting  one for each hinge of the scene
 * @param[in] scale      Q, as ritz_stage_scale gives it
 */
ritz_status ritz_stage_constraints(const ritz_stage *stage,
                                   const double *setting, const double *scale,
                                   ritz_dense *out);

/**
 * The system at some angles: null space P of the constraints, their rank by
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
 * The full-order system at some angles as one component: constraints
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

void ritz_stage_free(ritz_stage *stage);

#endif
