/* Connected parts of the graph of D, in the order of their first modes. */
#include "simulate/groups.h"

#include "base/alloc.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static bool couples(const ritz_dense *D, double floor, int64_t i, int64_t j)
{
    return i != j && (fabs(ritz_dense_col(D, j)[i]) > floor ||
                      fabs(ritz_dense_col(D, i)[j]) > floor);
}

ritz_status ritz_groups_new(const ritz_dense *D, ritz_groups *out)
{
    ritz_status status = RITZ_OK;
    ritz_groups g = {0};
    bool *seen = NULL;
    int64_t n = D->nrow;
    int64_t end = 0; /* of members */
    double floor = 64.0 * DBL_EPSILON * ritz_dense_max(D);

    RITZ_NEW(g.first, n + 1);
    RITZ_NEW(g.member, n);
    RITZ_NEW(seen, n);
    for (int64_t j = 0; j < n; j++) {
        if (seen[j])
            continue;
        seen[j] = true;
        g.member[end] = j;
        for (int64_t next = end++; next < end; next++)
            for (int64_t i = j + 1; i < n; i++)
                if (!seen[i] && couples(D, floor, i, g.member[next])) {
                    seen[i] = true;
                    g.member[end++] = i;
                }
        g.first[++g.count] = end;
    }
    *out = g;
    g = (ritz_groups){0};
done:
    free(seen);
    ritz_groups_free(&g);
    return status;
}

void ritz_groups_free(ritz_groups *groups)
{
    free(groups->first);
    free(groups->member);
    *groups = (ritz_groups){0};
}
