/* The neighbours of a component, condensed through joints to its ports. */
#ifndef RITZ_ASSEMBLY_NEIGHBOUR_H
#define RITZ_ASSEMBLY_NEIGHBOUR_H

#include <ritz/assembly.h>

/* Relations F q - G u of the far body's q and the near port's dofs u. */
typedef struct ritz_link {
    int64_t count;
    ritz_dense F, G; /* count x r, count x p */
    ritz_freedom *freedom;
} ritz_link;

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
