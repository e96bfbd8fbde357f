#include "base/alloc.h"

#include <ritz/reduced.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_measures_add(ritz_measures *measures, const char *name,
                              double value, double limit, const char *where)
{
    ritz_status status = RITZ_OK;
    ritz_measure *more = NULL;
    ritz_measure *last = NULL;

    RITZ_NEW(more, measures->count + 1);
    if (measures->count > 0)
        memcpy(more, measures->item, (size_t)measures->count * sizeof *more);
    last = &more[measures->count];
    snprintf(last->name, sizeof last->name, "%s", name);
    snprintf(last->where, sizeof last->where, "%s", where ? where : "");
    last->value = value;
    last->limit = limit;
    free(measures->item);
    measures->item = more;
    measures->count++;
done:
    return status;
}

void ritz_measures_free(ritz_measures *measures)
{
    free(measures->item);
    *measures = (ritz_measures){0};
}
