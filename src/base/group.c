#include "base/group.h"

#include <stdio.h>
#include <string.h>

/*
 * /proc/self/cgroup has a line "0::/A/B" of the unified hierarchy, whose groups
 * /A/B and /A may have limits. A container sees its own group as the root.
 */
int64_t ritz_group_least(const char *name, int64_t (*read)(const char *path))
{
    enum { ROOM = 4096 };
    static const char root[] = "/sys/fs/cgroup";
    FILE *file = fopen("/proc/self/cgroup", "r");
    char line[ROOM], path[2 * ROOM];
    int64_t least = 0;

    snprintf(path, sizeof path, "%s/%s", root, name);
    least = read(path);
    while (file && fgets(line, sizeof line, file)) {
        if (strncmp(line, "0::/", 4) != 0)
            continue;
        line[strcspn(line, "\n")] = '\0';
        for (char *end = NULL; (end = strrchr(line + 3, '/')); *end = '\0') {
            int64_t found = 0;

            snprintf(path, sizeof path, "%s%s/%s", root, line + 3, name);
            found = read(path);
            least = found < least ? found : least;
        }
    }
    if (file)
        fclose(file);
    return least;
}
