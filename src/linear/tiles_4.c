#define LANES 4
#include "linear/tiles_body.h"

TILES(4, 256)
