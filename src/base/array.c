#include "base/array.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

void *ritz_array_grown(void *array, int64_t count, int64_t *room, size_t size)
{
    char *more = NULL;

    if (count < *room)
        return array;
    more = ritz_zalloc(2 * *room + 16, size);
    if (!more)
        return NULL;
    if (count > 0)
        memcpy(more, array, (size_t)count * size);
    free(array);
    *room = 2 * *room + 16;
    return more;
}
