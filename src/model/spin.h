/* Spin terms of a body, from its inertia invariants: see ritz/spin.h. */
#ifndef RITZ_MODEL_SPIN_H
#define RITZ_MODEL_SPIN_H

#include <ritz/reduced.h>
#include <ritz/spin.h>

/**
 * Spin terms of the columns of a reduced component; KG stays {0}.
 *
 * @param[in] axis     n, unit, along basic axes
 * @param[in] through  a point of the axis, in the basic frame
 * @return RITZ_ERR_ARGUMENT if the component has no invariants
 * @cost   O(r^2)
 */
ritz_status ritz_spin_terms_of(const ritz_invariants *invariants,
                               const double axis[static 3],
                               const double through[static 3],
                               ritz_spin_terms *out);

/**
 * B += sum f a' over the mass of a body, f being the centrifugal force at W = 1
 * and a the position from a point: see spin_turn.c.
 *
 * @param[in] through  a point of the axis
 * @param[in] from     where a begins
 */
void ritz_spin_add_mass(const ritz_inertia *of, const double axis[static 3],
                        const double through[static 3],
                        const double from[static 3], double B[static 9]);

/**
 * KG += the stiffness of the rotation of a body on which forces act.
 *
 * @param[in]     B       sum f a', row by row
 * @param[in]     motion  6 x r, translation and rotation of the body
 * @param[in,out] KG      r x r; {0} is zero
 */
ritz_status ritz_spin_add_turn(const double B[static 9],
                               const ritz_dense *motion, ritz_dense *KG);

/**
 * The rigid motion nearest to that of a port, by least squares: translation of
 * the point @p from, and rotation. A rotation that the port's dofs do not
 * determine is 0.
 *
 * @param[out] out  6 x r
 */
ritz_status ritz_spin_port_motion(const ritz_reduced *body,
                                  const ritz_port_map *port,
                                  const double from[static 3], ritz_dense *out);

/**
 * The same of a rigid body, by all its ports and its momentum.
 *
 * @param[out] rigid  whether it is one: it has no other motion with mass
 */
ritz_status ritz_spin_rigid_motion(const ritz_reduced *body,
                                   const double from[static 3], bool *rigid,
                                   ritz_dense *out);

/** Whether a body has stiffness and is not rigid. */
ritz_status ritz_spin_is_flexible(const ritz_reduced *body, bool *out);

#endif
