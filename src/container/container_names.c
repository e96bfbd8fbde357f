/* Names of inputs and outputs where no matrix goes with them. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <stdlib.h>

ritz_status ritz_part_write_group_names(hid_t at, const char *name,
                                        int64_t count, const ritz_name *names)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_group(at, name, &group));
    RITZ_TRY_IN(name, ritz_part_write_names(group, "names", count, names));
done:
    ritz_h5_close(group);
    return status;
}

ritz_status ritz_part_read_group_names(hid_t at, const char *name,
                                       int64_t *count, ritz_name **out)
{
    ritz_status status = RITZ_OK;
    ritz_name *names = NULL;
    int64_t found = 0;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(at, name, &group));
    RITZ_TRY_IN(name, ritz_h5_count(group, "names", &found));
    RITZ_NEW(names, found);
    RITZ_TRY_IN(name, ritz_part_read_names(group, "names", found, names));
    *count = found;
    *out = names;
    names = NULL;
done:
    free(names);
    ritz_h5_close(group);
    return status;
}
