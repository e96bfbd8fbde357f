/*
 * The beam of [McDaniel2000] chapter 3 as a scene with ports at every node:
 * A holds nodes 1 and 2, B nodes 2, 3 and 4; nodes are called n1 ... n4, node
 * 2 of both is 'middle', where the fixed joint is. Bodies are of full order.
 */
#ifndef RITZ_TESTS_BEAMS_H
#define RITZ_TESTS_BEAMS_H

#include <ritz/synthesis.h>

/**
 * @param[in] clamped  whether node 4 is clamped as node 0 is
 * @param[in] tail     keys of the scene beside components and joints
 */
ritz_status beams_stage(bool clamped, const char *tail, ritz_scene *scene,
                        ritz_stage *stage);

/** Inputs (3.2.27) and outputs (3.2.28) of its EP&A example, as keys. */
extern const char beams_io[];

/** Input and output of its Krylov example: all dofs of node 2A, its y. */
extern const char beams_krylov_io[];

#endif
