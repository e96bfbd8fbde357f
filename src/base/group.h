/* Limits of the process's control group. Private to the library and the
   tools. */
#ifndef RITZ_BASE_GROUP_H
#define RITZ_BASE_GROUP_H

#include <stdint.h>

/**
 * The least value that @p read finds in the files @p name of the process's
 * control group and of all groups above it.
 *
 * @param[in] read  the value of a file; INT64_MAX if it has none or cannot be
 *                  read
 * @return INT64_MAX if there is no limit
 */
int64_t ritz_group_least(const char *name, int64_t (*read)(const char *path));

#endif
