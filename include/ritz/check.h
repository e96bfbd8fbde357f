/*
 * Audit of a component before it is reduced, of a reduced component or of a
 * state space. Each check has a measured value, a limit, a verdict, and the
 * grids concerned. docs/check.md and docs/methods/stability.md list the checks,
 * what each measures and where its limit comes from; a check that does not
 * apply to a model is left out.
 */
#ifndef RITZ_CHECK_H
#define RITZ_CHECK_H

#include <ritz/model.h>

#pragma GCC visibility push(default)

typedef enum ritz_verdict {
    RITZ_PASS,
    RITZ_WARN,
    RITZ_FAIL,
} ritz_verdict;

enum { RITZ_WHERE_SIZE = 192 };

typedef struct ritz_check {
    char name[RITZ_NAME_SIZE]; /* "rigid-modes-geometry" */
    double value, limit;       /* NaN where there is none */
    ritz_verdict verdict;
    char where[RITZ_WHERE_SIZE]; /* "grid 101 T3, grid 205 R1"; "" nowhere */
    char says[RITZ_WHERE_SIZE];  /* a sentence in the user's terms */
} ritz_check;

typedef struct ritz_audit {
    int64_t count;
    ritz_check *check;
} ritz_audit;

/** All checks that apply to the component. @cost one factor and few modes */
ritz_status ritz_audit_component(const ritz_component *component,
                                 ritz_audit *out);

/* A load that acts, and its size in units of the load that its KG is for. */
typedef struct ritz_applied {
    char name[RITZ_NAME_SIZE];
    double amount;
} ritz_applied;

/**
 * As ritz_audit_component, with a check that the model is far enough from
 * buckling under the sum of these loads.
 *
 * @return RITZ_ERR_ARGUMENT if the model has no load of such a name
 */
ritz_status ritz_audit_component_under(const ritz_component *component,
                                       int64_t count,
                                       const ritz_applied *applied,
                                       ritz_audit *out);
ritz_status ritz_audit_reduced_under(const ritz_reduced *reduced, int64_t count,
                                     const ritz_applied *applied,
                                     ritz_audit *out);

/*
 * Factors by which a load must be multiplied for the model to buckle,
 *
 *     K phi = -mu KG phi,
 *
 * where KG of tension is positive: a load that compresses has a positive
 * factor, one that pulls a negative one, and many loads have both.
 */
typedef struct ritz_buckling {
    double factor;   /* lowest positive mu */
    double reversed; /* negative mu nearest to 0. Either one is NaN if there is
                        none up to 1000 times the other one */
} ritz_buckling;

/**
 * Buckling factors of each load of a model.
 *
 * @param[out] out  one for each load, to be freed; NULL if there is no load, or
 *                  if K leaves a motion free, for which there are no factors
 * @return RITZ_ERR_CONVERGENCE
 * @cost   for a component above 600 dofs one factor, and about twenty solves
 *         and counts of negative eigenvalues for each load; else O(n^3)
 */
ritz_status ritz_buckling_of_component(const ritz_component *component,
                                       ritz_buckling **out);
ritz_status ritz_buckling_of_reduced(const ritz_reduced *reduced,
                                     ritz_buckling **out);

/** "pass", "warn", "fail". */
const char *ritz_verdict_name(ritz_verdict verdict);

void ritz_audit_free(ritz_audit *audit);

/*
 * Whether a small model is stable, alone and in an assembly: the check that is
 * made before export.
 */

typedef enum ritz_stability {
    RITZ_STABLE,   /* every pole is left of the axis by more than rounding */
    RITZ_MARGINAL, /* some are on it: rigid-body motion, or no damping */
    RITZ_UNSTABLE, /* a pole is right of it, or M or K is not semidefinite */
} ritz_stability;

typedef struct ritz_probe {
    ritz_stability verdict;
    double pole[2];   /* that decided it, real and imaginary part [rad/s] */
    double radius;    /* largest |pole| [rad/s] */
    double tolerance; /* of `pole`, of rounding, relative to the radius */
    int64_t count;    /* of poles; 0: none was looked for */
    int64_t unseen;   /* poles of a sparse model that were not computed, where
                         no proof covers them */
    char why[RITZ_NAME_SIZE]; /* a defect of M or K; "" if poles decided */
} ritz_probe;

/**
 * Poles of A, or of E^-1 A. A pole s is on the axis if |Re s| is within
 * 8 eps |A| / cos, the first-order bound of its rounding error, where cos is
 * the cosine of the angle between its left and right eigenvectors.
 *
 * A sparse model is proven stable where E and -(A + A') are definite; otherwise
 * only the poles nearest to 0 are computed.
 */
ritz_status ritz_probe_states(const ritz_state_space *model, ritz_probe *out);

/**
 * M x'' + D x' + K x = 0: first M, which must have no negative eigenvalue, then
 * K, none of a motion that is not rigid, then the poles of the quadratic
 * pencil.
 *
 * @param[in] D        may be {0}; need not be symmetric
 * @param[in] damping  ratios in addition to D, by modes; NULL: none
 */
ritz_status ritz_probe_second_order(const ritz_dense *K, const ritz_dense *M,
                                    const ritz_dense *D,
                                    const ritz_damping *damping,
                                    ritz_probe *out);

/**
 * Whether any motion can grow, alone or in an assembly.
 *
 * Where M, K and D are semidefinite, nothing can grow with any passive system
 * attached: the checks that follow say so and compute nothing. The interface
 * are the ports or, without ports, the inputs.
 *
 * @cost  an eigenproblem of M, K and D each; of others some fifty of 2r states
 */
ritz_status ritz_audit_reduced(const ritz_reduced *reduced, ritz_audit *out);

/**
 * The same of states, from poles on. The interface are pairs of an input and an
 * output of one name, taken as a force and the motion of its point.
 */
ritz_status ritz_audit_states(const ritz_state_space *model, ritz_audit *out);

/** "stable", "marginal" or "unstable". */
const char *ritz_stability_name(ritz_stability verdict);

/** "pole +0.31 +- 12.4i rad/s (1.97 Hz)", or the defect of M or K. */
void ritz_probe_print(const ritz_probe *probe, char out[2 * RITZ_NAME_SIZE]);

/**
 * Remember it as estimate "growth-relative": Re s over the radius, with the
 * tolerance as its limit where it is unstable.
 */
ritz_status ritz_probe_record(const ritz_probe *probe,
                              ritz_measures *estimates);

#pragma GCC visibility pop

#endif
