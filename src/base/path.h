/* Paths of files. */
#ifndef RITZ_BASE_PATH_H
#define RITZ_BASE_PATH_H

#include <ritz/base.h>

/** The folder of a path: "." if it names none. The caller frees @p out. */
ritz_status ritz_path_folder(const char *path, char **out);

#endif
