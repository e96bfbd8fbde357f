/*
 * COMPARE: component modes projection and assembly model reduction over all
 * configurations of an articulated system [LeeTsuha1992], and its relatives:
 * P&A (no augmentation), EP&A and Krylov P&A [McDaniel2000, chapter 3].
 */
#ifndef RITZ_COMPARE_H
#define RITZ_COMPARE_H

#include <ritz/ranking.h>
#include <ritz/synthesis.h>

#pragma GCC visibility push(default)

/* A flexible mode of the second system that stands for no kept mode. */
typedef struct ritz_stray {
    int64_t mode; /* flexible mode of stage 2, as assembled */
    double hertz;
    int64_t like; /* flexible mode of stage 1 that it is most like; -1: none */
    double mac;   /* how like */
    bool removed; /* from the second system; the bodies still contain it */
} ritz_stray;

/* What stage two did at one configuration. */
typedef struct ritz_compare_row {
    double *setting; /* one for each sweep */
    bool listed;     /* false: between listed angles, for checking only */
    int64_t num_rigid, num_flexible; /* of the stage-1 system */
    int64_t num_kept; /* flexible modes that matter: listed, they are kept;
                               between, they would have been */
    int64_t *kept;    /* num_kept indices into the flexible modes, ascending */
    int64_t num_completed; /* of those, kept only as a cluster is never split */
    int64_t num_vectors;   /* Krylov vectors in their place */
    int64_t order;         /* of the stage-2 system, strays removed */
    double frequency_error; /* worst relative, of those modes; NaN: no mode */
    double allowed;         /* what rounding allows it, c eps lambda_max /
                               lambda_k with c = 20 e; NaN between */
    double rigid_error;     /* largest |omega| of a rigid mode of stage 2, Hz */
    double gain_error;      /* relative, of the flexible static gain */
    double response_error;  /* relative to the largest |H|, in the band */
    double mac;             /* smallest, of those modes; NaN: no mode */
    int64_t num_moments;    /* Krylov: the first of them are kept, */
    double moment_error;    /* and this is the worst, relative; NaN: none */
    int64_t num_strays;
    ritz_stray *stray;
} ritz_compare_row;

/* Static corrections for one set of forces, and what they are worth. */
typedef struct ritz_candidate {
    ritz_augment level;
    int attached;              /* sum of RITZ_ATTACHED_... */
    bool inputs_too;           /* and those that the scene names alone */
    char name[RITZ_NAME_SIZE]; /* "inputs, interface" */
    int64_t *order;            /* of each body */
    int64_t total;             /* of all bodies */
    int64_t largest;           /* order of a system, at any configuration */
    double gain_listed, gain_between; /* worst relative errors; NaN: none */
    double deviation; /* of the largest singular value of H(i w), relative, the
                         worst over the band at all listed configurations; NaN
                         where there is no response */
    double hertz;     /* where */
    char at[RITZ_NAME_SIZE]; /* and at which configuration */
    bool chosen;
} ritz_candidate;

/* What errors between listed angles there are, and whether one is to be added:
 * if it is above 1e-3 and ten times the worst of its kind at listed ones. */
typedef struct ritz_suggestion {
    int64_t row; /* between listed angles, with the worst error; -1: none */
    const char *measure;  /* "response", "frequency" or "gain" */
    double error, listed; /* there, and worst at listed configurations */
    bool worth;           /* add it */
} ritz_suggestion;

typedef struct ritz_comparison {
    ritz_stage second;                       /* bodies after stage two */
    ritz_system first_system, second_system; /* listed configurations */
    int64_t num_rows;
    ritz_compare_row *row; /* listed ones first, then those between */
    int64_t num_bodies;
    int64_t composite;      /* vectors before dependent ones were removed */
    bool removed;           /* whether stage two removed anything at all */
    ritz_dense *V;          /* num_bodies, r_c x s_c */
    int64_t num_candidates; /* where components are augmented, or by choice */
    ritz_candidate *candidate;
    ritz_suggestion suggestion;
} ritz_comparison;

/** Both stages. @cost an eigenproblem of the stage-1 order a configuration */
ritz_status ritz_compare(const ritz_stage *stage, ritz_comparison *out);

/* The second stage at one composite tolerance. */
typedef struct ritz_tolerance_row {
    double tolerance;
    int64_t *order;  /* of each body */
    int64_t total;   /* of all bodies */
    int64_t largest; /* order of a system, at any configuration */
    bool removed;    /* whether stage two removed anything */
    double frequency_error, gain_error, response_error; /* worst over all
                                                          listed; NaN: none */
} ritz_tolerance_row;

/**
 * What the composite tolerance trades: orders and worst errors at each of
 * @p count tolerances, everything else as the scene says.
 *
 * @param[out] out  count rows, to be freed by ritz_tolerances_free
 * @return RITZ_ERR_ARGUMENT if a tolerance is not between 0 and 1
 */
ritz_status ritz_compare_tolerances(const ritz_stage *stage,
                                    const ritz_comparison *comparison,
                                    int64_t count, const double *tolerance,
                                    ritz_tolerance_row **out);

/*
 * The composite set of each body with its directions in the order in which they
 * matter: any number of the first is a subspace for stage two.
 */
typedef struct ritz_composite {
    int64_t num_bodies;
    ritz_dense *V;     /* of each, r_c x s_c: rigid motions, then directions */
    int64_t *rigid;    /* of each, how many are rigid motions */
    int64_t num_steps; /* directions of all bodies */
    int64_t *step;     /* num_steps: the body whose next direction matters most
                          of those that are left */
} ritz_composite;

/**
 * Of the modes up to the end of the scene's band at all its configurations,
 * then of static answers to inputs and outputs, then of all that stage one has.
 *
 * Modes that are to be ranked (scene.select) weigh as much as their value in
 * the ranking, others all the same. Where the scene augments, static answers
 * come with the modes, not behind them. A body that does not move rigidly with
 * the system has its first direction before any other.
 *
 * What is cut keeps no mode exactly; it is for searches that measure each cut.
 *
 * @return RITZ_ERR_ARGUMENT if there is no band or no configuration, or as
 *         ritz_compare
 * @cost   an eigenproblem of the stage-1 order a configuration, and of each
 *         body a singular value decomposition, r_c rows and a column for each
 *         mode and configuration
 */
ritz_status ritz_composite_new(const ritz_stage *stage, ritz_composite *out);
void ritz_composite_free(ritz_composite *composite);

void ritz_tolerances_free(int64_t count, ritz_tolerance_row **rows);
void ritz_comparison_free(ritz_comparison *comparison);

#pragma GCC visibility pop

#endif
