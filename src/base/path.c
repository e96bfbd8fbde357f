#include "base/path.h"

#include "base/alloc.h"

#include <string.h>

ritz_status ritz_path_folder(const char *path, char **out)
{
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) : 1;
    char *folder = NULL;

    if (slash == path)
        length = 1; /* the root */
    RITZ_CHECK_NEW(folder, (int64_t)length + 1);
    memcpy(folder, slash ? path : ".", length);
    *out = folder;
    return RITZ_OK;
}
