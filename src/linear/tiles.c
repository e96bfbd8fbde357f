#include "linear/tiles.h"

#include <ritz/base.h>

#include <stdlib.h>

const ritz_tiles *ritz_tiles_here(void)
{
    const char *text = getenv("RITZ_TILES");
    int64_t widest = 512;

    if (text && !ritz_text_whole(text, &widest))
        widest = 512;
#if defined __x86_64__
    if (widest >= 512 && __builtin_cpu_supports("avx512f"))
        return &ritz_tiles_8;
    if (widest >= 256 && __builtin_cpu_supports("avx2") &&
        __builtin_cpu_supports("fma"))
        return &ritz_tiles_4;
#endif
    return &ritz_tiles_2;
}
