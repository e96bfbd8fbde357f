/* The neighbours of a component, condensed through joints to its ports. */
#ifndef RITZ_ASSEMBLY_NEIGHBOUR_H
#define RITZ_ASSEMBLY_NEIGHBOUR_H

#include <ritz/assembly.h>

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

#endif
