#define LANES 2
#include "linear/tiles_body.h"

TILES(2, 128)
