/* Which reduced modes can be which full ones: see estimate_partner.c. */
#ifndef RITZ_ESTIMATE_ESTIMATE_PARTNER_H
#define RITZ_ESTIMATE_ESTIMATE_PARTNER_H

#include "estimate/estimate_parts.h"

/* Full modes first .. last - 1, which are not known to be apart. */
typedef struct ritz_group {
    int64_t first, last;
    bool one;  /* but known to be one cluster */
    int which; /* 0: vectors of the trial are near them; 1: polished ones */
    int64_t from, to; /* vectors from .. to - 1, as many as modes or fewer */
    double sin2;      /* of the angle between these and it, at most */
} ritz_group;

typedef struct ritz_partners {
    int64_t count;
    ritz_group *group;
    ritz_dense Q[2]; /* reduced modes against the trial, the polished one */
} ritz_partners;

/* |c|^2 that a mode holds of a group. */
typedef struct ritz_share {
    double least, most;
} ritz_share;

/** Groups from full mode @p first on, of all up to @p last and beyond. */
ritz_status ritz_partners_new(const ritz_estimator *estimator,
                              const ritz_measuring *m, int64_t first,
                              int64_t last, ritz_partners *out);
void ritz_partners_free(ritz_partners *partners);

ritz_share ritz_partners_share(const ritz_partners *p, const ritz_group *g,
                               int64_t r);

/** Whether reduced mode @p r can hold half of the group; whether it does. */
bool ritz_partners_can(const ritz_measuring *m, const ritz_partners *p,
                       const ritz_group *g, int64_t r);
bool ritz_partners_must(const ritz_partners *p, const ritz_group *g, int64_t r);

#endif
