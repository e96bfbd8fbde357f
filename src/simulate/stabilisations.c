/* The table of stabilisations. A new one needs a descriptor in a file, and a
   row here. */
#include <ritz/constrained.h>

const ritz_stabilisation *const ritz_stabilisations[] = {
    &ritz_stabilisation_none,         &ritz_stabilisation_baumgarte,
    &ritz_stabilisation_sliding_mode, &ritz_stabilisation_penalty,
    &ritz_stabilisation_hybrid,       &ritz_stabilisation_projection,
    &ritz_stabilisation_index_2,      NULL,
};
