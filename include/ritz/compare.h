/*
 * COMPARE: component modes projection and assembly model reduction over all
 * configurations of an articulated system [LeeTsuha1992].
 */
#ifndef RITZ_COMPARE_H
#define RITZ_COMPARE_H

#include <ritz/ranking.h>
#include <ritz/synthesis.h>

/* What stage two did at one configuration. */
typedef struct ritz_compare_row {
    double *setting; /* one for each hinge */
    bool listed;     /* false: between listed angles, for checking only */
    int64_t num_rigid, num_flexible; /* of the stage-1 system */
    int64_t num_kept; /* flexible modes that matter: listed, they are kept;
                               between, they would have been */
    int64_t *kept;    /* num_kept indices into the flexible modes */
    int64_t order;    /* of the stage-2 system */
    double frequency_error; /* worst relative, of those modes */
    double allowed;         /* what rounding allows it, c eps lambda_max /
                               lambda_k with c = 20 e; NaN between */
    double rigid_error;     /* largest |omega| of a rigid mode of stage 2, Hz */
    double gain_error;      /* relative, of the flexible static gain */
    double response_error;  /* relative to the largest |H|, in the band */
    double mac;             /* smallest, of those modes */
} ritz_compare_row;

typedef struct ritz_comparison {
    ritz_stage second;                       /* bodies after stage two */
    ritz_system first_system, second_system; /* listed configurations */
    int64_t num_rows;
    ritz_compare_row *row; /* listed ones first, then those between */
    int64_t num_bodies;
    int64_t composite; /* vectors before dependent ones were removed */
    bool removed;      /* whether stage two removed anything at all */
    ritz_dense *V;     /* num_bodies, r_c x s_c */
} ritz_comparison;

/** Both stages. @cost an eigenproblem of the stage-1 order a configuration */
ritz_status ritz_compare(const ritz_stage *stage, ritz_comparison *out);

void ritz_comparison_free(ritz_comparison *comparison);

#endif
