#define LANES 8
#include "linear/tiles_body.h"

TILES(8, 512)
