#include "print/describe.h"

#include <stdio.h>
#include <string.h>

static const char *kind_name(ritz_dof dof)
{
    return dof.component == 0 ? "point" : "grid";
}

/* "grid 7: 123456": directions of the grids, in the order they come in. */
static int64_t describe_grid(const ritz_recovery *r, int64_t k, size_t size,
                             char *text)
{
    ritz_dof first = r->dof[k];
    int used = snprintf(text, size, "%s %lld", kind_name(first),
                        (long long)first.grid);

    if (first.component > 0)
        used += snprintf(text + used, size - (size_t)used, " ");
    for (; k < r->count && r->dof[k].grid == first.grid; k++)
        if (r->dof[k].component > 0)
            used += snprintf(text + used, size - (size_t)used, "%lld",
                             (long long)r->dof[k].component);
    return k;
}

void describe_recovery(const cli_run *run, json_t *keys,
                       const ritz_recovery *recovery)
{
    enum { SHOWN = 5 };
    char text[SHOWN * 64] = "";
    size_t used = 0;
    int64_t grids = 0;
    json_t *list = json_array();

    for (int64_t k = 0; k < recovery->count; grids++) {
        char one[64];

        k = describe_grid(recovery, k, sizeof one, one);
        json_array_append_new(list, cli_string(one));
        if (grids < SHOWN)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s",
                                     grids > 0 ? ", " : "", one);
    }
    if (recovery->count > 0)
        cli_say(run, "  %-14s %lld dofs that follow from the others: %s%s",
                "recovered", (long long)recovery->count, text,
                grids > SHOWN ? ", ..." : "");
    json_object_set_new(keys, "recovered", json_integer(recovery->count));
    json_object_set_new(keys, "recovered_dofs", list);
}
