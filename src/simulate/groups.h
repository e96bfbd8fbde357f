/* Which modes a damping matrix couples, directly or through others. */
#ifndef RITZ_SIMULATE_GROUPS_H
#define RITZ_SIMULATE_GROUPS_H

#include <ritz/dense.h>

typedef struct ritz_groups {
    int64_t count;
    int64_t *first;  /* count + 1 */
    int64_t *member; /* of group k: member[first[k]] ... */
} ritz_groups;

/** Entries below 64 eps of the largest couple nothing. */
ritz_status ritz_groups_new(const ritz_dense *D, ritz_groups *out);
void ritz_groups_free(ritz_groups *groups);

#endif
