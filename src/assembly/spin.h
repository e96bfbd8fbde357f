/* Bodies of a scene that spins, and what their joints hold. */
#ifndef RITZ_ASSEMBLY_SPIN_H
#define RITZ_ASSEMBLY_SPIN_H

#include "assembly/assembly.h"

/* A joint of a body that leads away from the first body. */
typedef struct ritz_spin_outlet {
    const ritz_port_map *port; /* of the body */
    double mass;               /* of all bodies that the joint holds */
    double pull[3];  /* sum of m_j d_j, d_j the vector from the axis to their
                        centres of mass, in the frame of the scene */
    int64_t unknown; /* one of them whose mass is not known; -1: none */
} ritz_spin_outlet;

/*
 * The joints of a body. The first body of the scene, or of a tree of joints
 * apart from it, has no inlet. A body that two joints hold is outboard of the
 * first of them alone.
 *
 * The body turns about the origin of the port that holds it: the offset or the
 * position of that joint is an arm of its own.
 */
typedef struct ritz_spin_joints {
    const ritz_port_map *inlet; /* port towards the first body, or NULL */
    double from[3]; /* origin of the port that holds it, in its own frame; or
                       its basic origin */
    int64_t count;
    ritz_spin_outlet *outlet;
} ritz_spin_joints;

ritz_status ritz_spin_joints_of(const ritz_stage *stage,
                                const ritz_dense *places, int64_t k,
                                ritz_spin_joints *out);
void ritz_spin_joints_free(ritz_spin_joints *joints);

/** Whether a component names any stiffening. If not, it has the stiffness of its
 * rotation as a whole about its inlet. */
bool ritz_spin_names_load(const ritz_scene_component *item);

/** Row k of placements: R row by row, and t. */
void ritz_spin_take_place(const ritz_dense *places, int64_t k,
                          double R[static 9], double t[static 3]);

/** Vector from the axis to a point of body k, in the frame of the scene. */
void ritz_spin_arm(const ritz_scene_spin *spin, const ritz_dense *places,
                   int64_t k, const double *point, double arm[static 3]);

/**
 * KG += the stiffness, about, that the pull of bodies outboard of body k would
 * give it at W = 1, if the scene names no load for it: see spin_pull.c.
 *
 * @param[in,out] KG  r x r; {0} is zero, and stays {0} if there is no such pull
 */
ritz_status ritz_spin_add_missing_pull(const ritz_stage *stage,
                                       const ritz_dense *places, int64_t k,
                                       ritz_dense *KG);

#endif
