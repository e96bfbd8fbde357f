/* Several models, as of the bodies of a scene: RITZ_OWN frees them all. */
#ifndef RITZ_MODEL_ARRAYS_H
#define RITZ_MODEL_ARRAYS_H

#include "base/alloc.h"

#include <ritz/model.h>

RITZ_ARRAY_OF(ritz_component);
RITZ_ARRAY_OF(ritz_reduced);

#endif
