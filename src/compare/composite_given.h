/* What all configurations of a stage give to its composite set, in groups. */
#ifndef RITZ_COMPARE_COMPOSITE_GIVEN_H
#define RITZ_COMPARE_COMPOSITE_GIVEN_H

#include "compare/compare_parts.h"

/* In order of right. */
enum {
    RITZ_GROUP_RIGID,
    RITZ_GROUP_BAND,
    RITZ_GROUP_STATIC,
    RITZ_GROUP_REST,
    RITZ_GROUPS
};

/* What one configuration gives, in its modal coordinates. */
typedef struct ritz_given {
    const ritz_configuration *at;
    double *value; /* of each flexible mode */
    ritz_dense X[RITZ_GROUPS];
} ritz_given;

typedef struct ritz_givens {
    const ritz_stage *stage; /* borrowed */
    double lambda;           /* of the end of the band */
    double *scale;           /* of all coordinates: ritz_stage_scale */
    ritz_system system;
    ritz_given *each; /* of each configuration */
} ritz_givens;

/** Assemble all configurations and choose what each gives. */
ritz_status ritz_givens_new(const ritz_stage *stage, ritz_givens *out);

/** P_c X of one body and group, all configurations side by side. */
ritz_status ritz_givens_gather(const ritz_givens *givens, int64_t body,
                               int group, ritz_dense *out);
void ritz_givens_free(ritz_givens *givens);

#endif
