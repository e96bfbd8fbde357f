/* Connected parts of the graph of a matrix, in the order of their smallest
   rows. */
#include "base/alloc.h"
#include "simulate/motion.h"

#include <math.h>

static bool couples(const ritz_dense *D, double floor, int64_t i, int64_t j)
{
    return i != j && (fabs(ritz_dense_col(D, j)[i]) > floor ||
                      fabs(ritz_dense_col(D, i)[j]) > floor);
}

void ritz_groups_free(ritz_groups *groups)
{
    RITZ_FREE(groups->first, groups->member);
    *groups = (ritz_groups){0};
}

ritz_status ritz_groups_new(const ritz_dense *D, double floor, ritz_groups *out)
{
    RITZ_OWN(ritz_groups) g = {0};
    RITZ_OWN_ARRAY bool *seen = NULL;
    int64_t n = D->nrow;
    int64_t end = 0; /* of members */

    RITZ_CHECK_NEW(g.first, n + 1);
    RITZ_CHECK_NEW(g.member, n);
    RITZ_CHECK_NEW(seen, n);
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
    RITZ_MOVE(*out, g);
    return RITZ_OK;
}
