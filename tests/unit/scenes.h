/* Scenes that tests of synthesis share, with their bodies in memory. */
#ifndef RITZ_TESTS_SCENES_H
#define RITZ_TESTS_SCENES_H

#include <ritz/eigen.h>
#include <ritz/method.h>
#include <ritz/synthesis.h>

/**
 * The beam of [McDaniel2000] cut at node 2: components 'A' and 'B' joined by
 * the fixed joint 'middle' at their ports 'middle'.
 *
 * @param[in] clamped  whether node 4 is clamped as node 0 is
 */
ritz_status scene_of_two_beams(bool clamped, ritz_scene *out);

/**
 * Its bodies in a basis: @p modes of them, -1 where the method takes none.
 */
ritz_status stage_of_two_beams(const ritz_scene *scene,
                               const ritz_method *method, int64_t modes,
                               ritz_stage *out);

/** Give a component a port of all dofs of one grid. */
ritz_status add_port(ritz_component *component, const char *name, int64_t grid);

/** Reduce a component with all its ports attached: modes as in @p span. */
ritz_status reduce_to(const ritz_component *component,
                      const ritz_method *method, const ritz_span *span,
                      ritz_reduced *out);

/** The same with a number of modes. */
ritz_status reduce_with(const ritz_component *component,
                        const ritz_method *method, int64_t modes,
                        ritz_reduced *out);

#endif
