/* The steps of COMPARE's second stage. */
#ifndef RITZ_COMPARE_COMPARE_H
#define RITZ_COMPARE_COMPARE_H

#include <ritz/assembly.h>
#include <ritz/response.h>

enum { RITZ_FORCE_SIZE = 2 * RITZ_NAME_SIZE + 32 };

/* A force whose static solutions may be added to the composite set. */
typedef struct ritz_unit_force {
    char name[RITZ_FORCE_SIZE]; /* "torque", "rotor/boom:3" */
    int sets;                   /* of RITZ_ATTACHED_..., to which it belongs */
    bool named;                 /* the scene attaches it by its name */
    double *f; /* over the coordinates of all bodies of the stage; NULL: along
                  the damper of a joint, which turns with it */
    int64_t spring; /* that one, among the springs of joints with dampers */
} ritz_unit_force;

typedef struct ritz_unit_forces {
    int64_t count, room;
    ritz_unit_force *each;
} ritz_unit_forces;

/* What is decided before stage two is built. */
typedef struct ritz_plan {
    double tolerance;     /* of the composite set */
    ritz_augment augment; /* level of static corrections, */
    int sets;             /* for these sets and what is named, which are */
    const ritz_unit_forces *forces; /* for these of all forces; borrowed */
    int64_t count;
    const int64_t *force; /* count, ascending; borrowed */
} ritz_plan;

/* Stage one at all rows: listed configurations, and those between them. */
typedef struct ritz_rows {
    const ritz_stage *stage;
    const ritz_system *listed;
    ritz_system between; /* its configurations alone */
    int64_t num_rows;
    ritz_compare_row *row;
    int64_t num_responses;
    ritz_response *response; /* of the listed ones; NULL until it is wanted */
} ritz_rows;

/** The stage-1 configuration of row @p k, borrowed. */
const ritz_configuration *ritz_rows_first(const ritz_rows *rows, int64_t k);

/** Make the responses of stage one at listed configurations, once. */
ritz_status ritz_rows_respond(ritz_rows *rows);
void ritz_rows_free(ritz_rows *rows);

/**
 * Inputs, outputs, the dofs that joints hold, and what the scene attaches by
 * name; of `attached: auto` alone the dofs of all other ports too, and every
 * force is named.
 *
 * @return RITZ_ERR_ARGUMENT if a place of the scene is not there
 */
ritz_status ritz_unit_forces_new(const ritz_stage *stage,
                                 ritz_unit_forces *out);

/** Inputs, outputs and the dampers of bodies and joints alone. */
ritz_status ritz_unit_forces_of_channels(const ritz_stage *stage,
                                         ritz_unit_forces *out);

/** Indices of those of some sets, and, if wanted, of those that are named. */
ritz_status ritz_unit_forces_select(const ritz_unit_forces *forces, int sets,
                                    bool named, int64_t *count, int64_t **out);
void ritz_unit_forces_free(ritz_unit_forces *forces);

/** Whether bodies have dampers, or joints hold motions on them. */
bool ritz_stage_is_damped(const ritz_stage *stage);

/** Forces of all dampers, of bodies and joints, on a configuration's modes. */
ritz_status ritz_damper_forces(const ritz_stage *stage,
                               const ritz_configuration *configuration,
                               ritz_dense *out);

/** The planned forces as columns: of one body, r_c rows. */
ritz_status ritz_plan_body(const ritz_stage *stage, int64_t k,
                           const ritz_plan *plan, ritz_dense *out);

/** The same in the modal coordinates of a configuration. */
ritz_status ritz_plan_system(const ritz_stage *stage,
                             const ritz_configuration *at,
                             const ritz_plan *plan, ritz_dense *out);

/**
 * The least value of a mode that matters: the scene's tolerance times the
 * largest over all listed configurations. Where modes are not ranked this is
 * not used.
 *
 * @param[in] system  stage one, at all listed configurations
 */
ritz_status ritz_compare_threshold(const ritz_scene *scene,
                                   const ritz_system *system, double *least);

/**
 * Value of each flexible mode in the scene's ranking; 1 where modes are not
 * ranked.
 *
 * @param[out] joined  modes that damping joins to others; NULL: not wanted
 */
ritz_status ritz_compare_values(const ritz_scene *scene,
                                const ritz_configuration *configuration,
                                double *value, int64_t *joined);

/**
 * Choose the modes of one configuration that matter, or count the Krylov
 * vectors that replace them.
 */
ritz_status ritz_compare_select(const ritz_scene *scene,
                                const ritz_configuration *configuration,
                                double least, ritz_compare_row *row);

/**
 * Krylov vectors of a configuration in its modal coordinates, flexible part:
 * span of Lambda^-1 R, Lambda^-2 R, ... with R = B, or [B, C'] for @p both;
 * K-orthonormal, dependent ones deflated.
 *
 * @param[in]  vectors  largest number; fewer if the sequence ends
 * @param[out] out      e x k, rows of rigid modes zero
 * @param[out] moments  number of moments C Lambda^-i-1 B that the span keeps
 */
ritz_status ritz_system_krylov(const ritz_configuration *configuration,
                               int64_t vectors, bool both, ritz_dense *out,
                               int64_t *moments);

/*
 * The groups of vectors that all configurations contribute to one body, r_c
 * rows, in the order in which they are made orthogonal: see composite.c.
 */
enum {
    RITZ_GIVEN_MASSLESS,
    RITZ_GIVEN_RIGID,
    RITZ_GIVEN_STATIC,
    RITZ_GIVEN_KEPT, /* modes or Krylov vectors */
    RITZ_GROUPS
};

/* What a configuration contributes, in its modal coordinates, by groups. */
typedef struct ritz_given {
    const ritz_configuration *at;
    double *value; /* of each flexible mode; NULL where it is not wanted */
    ritz_dense X[RITZ_GROUPS];
} ritz_given;

typedef struct ritz_givens {
    int64_t count;
    ritz_given *each;
} ritz_givens;

/** P_c X of one body and group, all configurations side by side. */
ritz_status ritz_givens_gather(const ritz_givens *givens,
                               const ritz_stage *stage, int64_t body, int group,
                               ritz_dense *out);
void ritz_givens_free(ritz_givens *givens);

/**
 * Modal coordinates of the vectors that a configuration contributes to a group.
 */
ritz_status ritz_composite_choose(const ritz_stage *stage,
                                  const ritz_configuration *configuration,
                                  const ritz_compare_row *row, int group,
                                  const ritz_plan *plan, ritz_dense *out);

/* The subspace of each body in which stage two reduces it. */
typedef struct ritz_subspaces {
    int64_t count;     /* of bodies */
    ritz_dense *V;     /* r_c x s_c, M-orthonormal where M is definite; the
                          identity where s_c would be r_c */
    int64_t *massless; /* of each, how many first columns have no mass, */
    int64_t *firm;     /* and how many hold these, rigid motion and statics */
    int64_t vectors;   /* before dependent ones were removed */
} ritz_subspaces;

/**
 * The composite set on each body: rigid modes, static corrections as planned,
 * kept modes or Krylov vectors of all configurations that count; dependent
 * columns removed by SVD in the M inner product.
 */
ritz_status ritz_compare_composite(const ritz_rows *rows, const ritz_plan *plan,
                                   ritz_subspaces *out);
void ritz_subspaces_free(ritz_subspaces *subspaces);

/** Stage two: the bodies in those subspaces; no configuration yet. */
ritz_status ritz_compare_project(const ritz_stage *stage,
                                 const ritz_subspaces *subspaces,
                                 ritz_comparison *out);

/** Orders of the bodies of stage two, and their sum. */
ritz_status ritz_compare_orders(const ritz_comparison *trial, int64_t **order,
                                int64_t *total);

/**
 * Stage two with the static corrections of each of some sets of forces, where
 * the scene augments components or leaves the set open.
 *
 * @param[in,out] plan  as the scene says; becomes the one that is chosen
 * @param[out] out      its candidates, and how they were sought
 * @param[out] force    what its forces are borrowed from; unless it is chosen
 *                      otherwise untouched
 */
ritz_status ritz_attached_choose(ritz_rows *rows, ritz_plan *plan,
                                 ritz_comparison *out, int64_t **force);
void ritz_candidate_free(ritz_candidate *candidate);

/**
 * Drop vectors of bodies that make extraneous modes, as long as no error of a
 * kept mode or of a response grows by more than the scene's tolerance.
 *
 * @param[in,out] subspaces  before and after
 */
ritz_status ritz_compact(ritz_rows *rows, ritz_subspaces *subspaces,
                         ritz_comparison *out);

/* The body's own contributions, r rows each. */
typedef struct ritz_statics {
    ritz_dense rigid;    /* its rigid modes, M-orthonormal */
    ritz_dense massless; /* null space of M */
    ritz_dense answers; /* static solutions for unit forces, inertia relieved */
} ritz_statics;

/**
 * Static corrections of body @p k: its rigid modes and its static solutions for
 * unit forces of the planned sets; solutions that are rounding are left out.
 *
 * @return RITZ_ERR_SINGULAR if its stiffness is not definite but for its rigid
 *         modes
 */
ritz_status ritz_body_statics(const ritz_stage *stage, int64_t k,
                              const ritz_plan *plan, ritz_statics *out);

void ritz_statics_free(ritz_statics *statics);

/**
 * Relieve forces on body @p k of the inertia of its rigid motion, and scale
 * their rows as the stage does; a force that does not deform it becomes 0.
 */
ritz_status ritz_body_relieve(const ritz_stage *stage, int64_t k,
                              ritz_dense *F);

/**
 * Compare the second system with the first at one configuration: stray modes
 * are found and, if the scene says so, removed from @p second; then errors are
 * measured.
 *
 * @param[in]     V         of every body
 * @param[in]     response  of the first, NULL: made here
 * @param[in,out] row       kept modes; errors are filled in
 */
ritz_status ritz_compare_measure(const ritz_stage *stage, const ritz_dense *V,
                                 const ritz_configuration *first,
                                 const ritz_response *response,
                                 ritz_configuration *second,
                                 ritz_compare_row *row);

/**
 * The same of a trial at listed configuration @p k.
 *
 * @param[out] row  that of @p rows with the errors of the trial: its setting
 *                  and kept modes are borrowed, its strays the caller's
 */
ritz_status ritz_rows_measure(const ritz_rows *rows, int64_t k,
                              const ritz_dense *V, ritz_configuration *second,
                              ritz_compare_row *row);

/**
 * X = sum_c P_c' M_c V_c P2_c: M-products of the modes of two systems of unit
 * mass, whose squares are their MAC.
 *
 * @param[in] V         of every body; NULL: the second is of the same bodies
 * @param[in] flexible  of flexible modes only
 */
ritz_status ritz_modes_correlate(const ritz_stage *stage, const ritz_dense *V,
                                 bool flexible, const ritz_configuration *first,
                                 const ritz_configuration *second,
                                 ritz_dense *X);

/** Error of the flexible static gain: see ritz_gain_error. */
ritz_status ritz_compare_gain(const ritz_configuration *first,
                              const ritz_configuration *second, double *out);

/** Whether a scene has a response: inputs, outputs, a band and damping. */
bool ritz_compare_responds(const ritz_scene *scene);

/** Response at the points of another. */
ritz_status ritz_compare_follow(const ritz_scene *scene,
                                const ritz_configuration *configuration,
                                const ritz_response *points,
                                ritz_response *out);

/* How far two MIMO Bode plots are apart: the largest singular value of H(i w)
   and the smallest that is not zero. */
typedef struct ritz_bode_gap {
    double deviation[2], hertz[2];
} ritz_bode_gap;

/**
 * Worst deviations of both, relative to the value of the first at each point;
 * at points more than 60 dB below the mean level of the plot they are relative
 * to that level. The smallest is the last that is not zero at some point.
 *
 * @param[in] scales  of inputs and outputs, NULL: none
 */
ritz_status ritz_compare_bode(const ritz_scales *scales,
                              const ritz_response *first,
                              const ritz_response *second, ritz_bode_gap *out);

/**
 * The angle where errors between listed angles are largest, and the measure.
 */
void ritz_compare_suggest(const ritz_comparison *comparison,
                          ritz_suggestion *out);

/* Independent directions in the mass inner product of a body. */

/**
 * Lower Cholesky factor of the mass, in coordinates scaled to unit diagonal;
 * where mass is singular, of mass plus stiffness over a lambda of the body's.
 *
 * @param[out] mixed  whether stiffness was added
 * @return RITZ_ERR_SINGULAR if neither is definite
 */
ritz_status ritz_mass_factor(const ritz_reduced *body, const double *scale,
                             ritz_dense *L, bool *mixed);

/**
 * Lower Cholesky factor of mass plus stiffness over a given lambda, the norm of
 * an energy.
 */
ritz_status ritz_mixed_factor(const ritz_reduced *body, const double *scale,
                              double lambda, ritz_dense *L);

/**
 * Y = L' W with W in scaled coordinates: M-inner products become Euclidean
 * ones.
 */
ritz_status ritz_mass_transform(const ritz_dense *L, const double *scale,
                                const ritz_dense *W, ritz_dense *Y);

/**
 * Replace U by the W with Y = U.
 *
 * @param[in] limited  columns are at most one long before they are scaled: with
 *                     unit M-norm a motion of little mass is long, and its
 *                     rounding would act as mass that it does not have
 */
void ritz_mass_return(const ritz_dense *L, const double *scale, bool limited,
                      ritz_dense *U);

/**
 * Orthonormal directions of Y (destroyed) whose singular values exceed
 * @p tolerance times *largest, which grows to the largest there is.
 *
 * @param[out] value  these values, descending; room for as many as @p Y has
 *                    rows; NULL: not wanted
 */
ritz_status ritz_span_of(ritz_dense *Y, double tolerance, double *largest,
                         double *value, ritz_dense *out);

/** Append those directions of Y, orthogonal to U, to U. */
ritz_status ritz_span_append(ritz_dense *Y, double tolerance, double *largest,
                             double *value, ritz_dense *U);

#endif
