/* Where bodies stand at a configuration. */
#ifndef RITZ_SYNTHESIS_PLACEMENT_H
#define RITZ_SYNTHESIS_PLACEMENT_H

#include <ritz/synthesis.h>

/**
 * Refuse joints that form a loop which does not close at these angles: bodies
 * that one way around puts elsewhere than the other.
 *
 * @return RITZ_ERR_ARGUMENT naming the joint that closes it, and how far from
 */
ritz_status ritz_place_check(const ritz_stage *stage, const double *setting);

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

#endif
