/* The steps of COMPARE's second stage. */
#ifndef RITZ_COMPARE_COMPARE_H
#define RITZ_COMPARE_COMPARE_H

#include <ritz/assembly.h>
#include <ritz/response.h>

enum { RITZ_FORCE_SIZE = 2 * RITZ_NAME_SIZE + 32 };

/* A force whose static solutions may be added to the composite set. */
typedef struct ritz_unit_force {
    char name[RITZ_FORCE_SIZE]; /* "torque", "rotor/boom:3" */
    int sets;                   /* the sets that it belongs to,
                                   RITZ_ATTACHED_... */
    bool named;                 /* the scene attaches it by name */
    double *f; /* vector over the coordinates of all bodies of the stage; NULL:
                  a force along the damper of a joint, whose direction depends
                  on the configuration */
    int64_t spring; /* index of that damper among all joint springs that have a
                       damper */
} ritz_unit_force;

typedef struct ritz_unit_forces {
    int64_t count, room;
    ritz_unit_force *each;
} ritz_unit_forces;

/* What is decided before stage two is built. */
typedef struct ritz_plan {
    double tolerance;     /* of the composite set */
    ritz_augment augment; /* level of static corrections */
    int sets;             /* named sets, RITZ_ATTACHED_..., that `force` was
                             selected by */
    const ritz_unit_forces *forces; /* all forces of the scene; borrowed */
    int64_t count;
    const int64_t *force; /* count indices into `forces`, ascending; borrowed */
} ritz_plan;

/* Stage one at all rows: listed configurations, and those between them. */
typedef struct ritz_rows {
    const ritz_stage *stage;
    const ritz_system *listed;
    ritz_system between; /* its configurations alone */
    int64_t num_rows;
    ritz_compare_row *row;
    int64_t num_responses;
    ritz_response *response; /* at listed configurations; NULL until
                                ritz_rows_respond */
} ritz_rows;

/** The stage-1 configuration of row @p k, borrowed. */
const ritz_configuration *ritz_rows_first(const ritz_rows *rows, int64_t k);

/** Compute the responses of stage one at listed configurations, unless that is
 * done. */
ritz_status ritz_rows_respond(ritz_rows *rows);
void ritz_rows_free(ritz_rows *rows);

/**
 * The forces that a scene may attach: inputs, outputs, dampers, dofs that
 * joints hold, and what the scene names. If the scene says `attached: auto` and
 * nothing else, the dofs of all other ports are included, and all forces count
 * as named.
 *
 * @return RITZ_ERR_ARGUMENT if a place that the scene names does not exist
 */
ritz_status ritz_unit_forces_new(const ritz_stage *stage,
                                 ritz_unit_forces *out);

/** Only the inputs, the outputs, and the dampers of bodies and joints. */
ritz_status ritz_unit_forces_of_channels(const ritz_stage *stage,
                                         ritz_unit_forces *out);

/** Indices of the forces that belong to some sets and, if @p named, of those
 * that the scene names. */
ritz_status ritz_unit_forces_select(const ritz_unit_forces *forces, int sets,
                                    bool named, int64_t *count, int64_t **out);
void ritz_unit_forces_free(ritz_unit_forces *forces);

/** Whether bodies have dampers, or joints have springs with dampers. */
bool ritz_stage_is_damped(const ritz_stage *stage);

/** Forces along all dampers of bodies and joints, in the modal coordinates of a
 * configuration. */
ritz_status ritz_damper_forces(const ritz_stage *stage,
                               const ritz_configuration *configuration,
                               ritz_dense *out);

/** The planned forces on body @p k: a column each, r_c rows. */
ritz_status ritz_plan_body(const ritz_stage *stage, int64_t k,
                           const ritz_plan *plan, ritz_dense *out);

/** The planned forces in the modal coordinates of a configuration. */
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
ritz_status ritz_compare_threshold(const ritz_stage *stage,
                                   const ritz_system *system, double *least);

/**
 * Value of each flexible mode in the scene's ranking; 1 if modes are not
 * ranked.
 *
 * @param[out] joined  number of modes that are in a cluster only because
 *                     damping couples them to others; NULL: not wanted
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

/* The subspace V of each body that stage two projects it on. */
typedef struct ritz_subspaces {
    int64_t count;     /* of bodies */
    ritz_dense *V;     /* r_c x s_c, M-orthonormal if M is definite; the
                          identity if s_c would be r_c */
    int64_t *massless; /* for each body, number of leading columns without
                          mass */
    int64_t *firm;     /* for each body, number of leading columns without mass,
                          of rigid motion and of static solutions together */
    int64_t vectors;   /* number of vectors before dependent ones were
                          removed */
} ritz_subspaces;

/**
 * The composite set on each body: rigid modes, static corrections as planned,
 * kept modes or Krylov vectors of all configurations that count; dependent
 * columns removed by SVD in the M inner product.
 */
ritz_status ritz_compare_composite(const ritz_rows *rows, const ritz_plan *plan,
                                   ritz_subspaces *out);
void ritz_subspaces_free(ritz_subspaces *subspaces);

/** Stage two: the bodies projected on their subspaces; no configuration yet. */
ritz_status ritz_compare_project(const ritz_stage *stage,
                                 const ritz_subspaces *subspaces,
                                 ritz_comparison *out);

/** Order of each body of stage two, and the sum of all. */
ritz_status ritz_compare_orders(const ritz_comparison *trial, int64_t **order,
                                int64_t *total);

/**
 * Choose the forces with static corrections: build stage two with several sets
 * of forces, if the scene augments components or leaves the set open.
 *
 * @param[in,out] plan  the scene's plan; replaced by the chosen one
 * @param[out] out      candidates, and statistics of the search
 * @param[out] force    owns the forces of the chosen plan; not written if there
 *                      was no choice
 */
ritz_status ritz_attached_choose(ritz_rows *rows, ritz_plan *plan,
                                 ritz_comparison *out, int64_t **force);
void ritz_candidate_free(ritz_candidate *candidate);

/**
 * Remove vectors of bodies that make extraneous modes, as long as no error of a
 * kept mode or of a response increases by more than the scene's tolerance.
 *
 * @param[in,out] subspaces  of the bodies
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
 * Subtract from forces on body @p k the inertia of the rigid motion that they
 * cause, and scale the rows by the stage's scales; a force that only moves the
 * body rigidly becomes 0.
 */
ritz_status ritz_body_relieve(const ritz_stage *stage, int64_t k,
                              ritz_dense *F);

/**
 * Compare the second system with the first at one configuration: find stray
 * modes, remove them from @p second if the scene says so, and measure errors.
 *
 * @param[in]     V         of every body
 * @param[in]     response  of the first system; NULL: computed here
 * @param[in,out] row       kept modes; errors are filled in
 */
ritz_status ritz_compare_measure(const ritz_stage *stage, const ritz_dense *V,
                                 const ritz_configuration *first,
                                 const ritz_response *response,
                                 ritz_configuration *second,
                                 ritz_compare_row *row);

/**
 * As ritz_compare_measure, for a trial at listed configuration @p k.
 *
 * @param[out] row  copy of the row of @p rows with the errors of the trial.
 *                  Setting and kept modes are borrowed; the caller frees the
 *                  strays
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

/** Response at the frequencies of another response. */
ritz_status ritz_compare_follow(const ritz_scene *scene,
                                const ritz_configuration *configuration,
                                const ritz_response *points,
                                ritz_response *out);

/* Difference of two MIMO Bode plots: [0] by the largest singular value of H(i
   w), [1] by the smallest one that is not zero. */
typedef struct ritz_bode_gap {
    double deviation[2], hertz[2];
} ritz_bode_gap;

/**
 * Worst deviations of both singular values, relative to the value of the first
 * response at each point, or to 60 dB below the mean level of the plot where
 * the value is smaller. The smallest singular value is the last one that is not
 * zero at some point.
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
