/*
 * The fitter: full models that candidates are compared with, the bodies of a
 * scene and their ladder of modes. A component is a scene of one body that is
 * joined to nothing; functions ask `scene` only where that matters.
 */
#ifndef RITZ_FIT_FITTER_H
#define RITZ_FIT_FITTER_H

#include <ritz/assembly.h>
#include <ritz/fit.h>
#include <ritz/verify.h>

/* The full model at one configuration. */
typedef struct ritz_fit_place {
    double *setting; /* of each sweep of the scene; NULL: of a component */
    char at[RITZ_NAME_SIZE];
    bool listed;         /* false: between listed ones, to confirm */
    ritz_component full; /* as it is compared, with its dampers */
    ritz_reference *reference;
    ritz_estimator *estimator; /* NULL: there are no bounds */
    ritz_master *master;       /* of a scene: which dofs full's are */
} ritz_fit_place;

/* A body in one basis, kept for the candidates that share it. */
typedef struct ritz_fit_made {
    const ritz_method *method;
    int64_t body, modes;
    ritz_reduced reduced; /* without T, unless bounds need it */
    ritz_fit_watch making;
    ritz_status status; /* of making it */
    char refusal[256];
} ritz_fit_made;

/* Bodies of COMPARE's second stage in all their directions. */
typedef struct ritz_fit_second {
    bool made;
    ritz_status status; /* of making it */
    char refusal[256];
    ritz_reduced *body; /* num_bodies, nested, dampers bare */
    int64_t *rigid;     /* num_bodies, columns that move rigidly */
    int64_t num_steps;  /* of a ladder of its own */
    int64_t *step;      /* num_steps, whose next direction matters most */
    double rich_hz;     /* the first stage has modes up to it */
    ritz_fit_watch making;
} ritz_fit_second;

struct ritz_fitter {
    ritz_fit_request request;
    const ritz_component *component; /* borrowed; NULL: of a scene */
    const ritz_scene *scene;         /* borrowed; NULL: of a component */
    ritz_dofs attached;              /* of a component */
    int64_t num_places;
    ritz_fit_place *place;  /* listed ones first */
    int64_t hardest;        /* listed place where errors were largest */
    bool rich;              /* a stage one is the reference */
    int64_t num_components; /* of the scene; 1 of a component */
    int64_t num_bodies;     /* flexible ones */
    int64_t *body;          /* num_bodies, component of the scene */
    ritz_component *model;  /* num_bodies, of a scene */
    ritz_reduced *still;    /* num_components, those that stay as they are;
                               flexible ones are empty */
    int64_t num_first;      /* rungs of the ladder that all are tried on */
    int64_t num_steps;      /* rungs there are beyond the lowest */
    int64_t *step;          /* num_steps, which body has one mode more */
    double *step_hz;        /* num_steps, and that mode's frequency */
    double rich_hz;         /* modes of bodies in a rich reference, up to it */
    int64_t num_made;
    ritz_fit_made *made;
    ritz_fit_second second;
    int64_t largest; /* order to be tried */
};

/* --- bodies.c ---------------------------------------------------------------- */

/** A stop watch, and what it shows. */
ritz_fit_watch ritz_fit_start(void);
ritz_fit_watch ritz_fit_since(ritz_fit_watch start);

/** Load the bodies of a scene and make the ladder of those that are flexible. */
ritz_status ritz_fit_bodies(ritz_fitter *fitter);

/**
 * Make the ladder longer, to twice the modes of the body that ends it.
 *
 * @param[out] end  why it could not be; RITZ_FIT_END_NONE: it is longer
 */
ritz_status ritz_fit_extend(ritz_fitter *fitter, ritz_fit_end *end);

/**
 * Join flexible bodies, dampers installed by that, to those that stay. Both are
 * lent until ritz_fit_part; on failure they are given back.
 *
 * @param[in,out] flexible  num_bodies, empty after
 */
ritz_status ritz_fit_join(ritz_fitter *fitter, ritz_reduced *flexible,
                          ritz_stage *out);

/** Take a stage apart; flexible bodies come back, or are freed if NULL. */
void ritz_fit_part(ritz_fitter *fitter, ritz_stage *stage,
                   ritz_reduced *flexible);

/** The scene with modes of flexible bodies far beyond the band. */
ritz_status ritz_fit_rich(ritz_fitter *fitter, double up_to_hz,
                          ritz_stage *out);

/* --- second.c ---------------------------------------------------------------- */

/** Modes of each body after @p rung steps of a method's ladder; its length. */
void ritz_fit_rung(const ritz_fitter *fitter, const ritz_method *method,
                   int64_t rung, int64_t *modes);
int64_t ritz_fit_rungs(const ritz_fitter *fitter, const ritz_method *method);

/** Make COMPARE's bodies, once; if they are refused, each candidate says why. */
ritz_status ritz_fit_second_make(ritz_fitter *fitter);

/** The same of a first stage with modes up to that; what fails leaves those
 * that were made before. */
ritz_status ritz_fit_second_remake(ritz_fitter *fitter, double up_to_hz,
                                   bool *made);

/** Flexible body @p k with its rigid motions and so many directions. */
ritz_status ritz_fit_second_body(ritz_fitter *fitter, int64_t k, int64_t count,
                                 ritz_reduced *out);
void ritz_fit_second_free(int64_t num_bodies, ritz_fit_second *second);

/* --- fitter.c ---------------------------------------------------------------- */

/** How far beyond the band, times it: 8, and up to 32 for fine tolerances. */
double ritz_fit_rich_to(const ritz_verify_request *limits);

/** Factors for bounds at a place, if they are wanted. */
ritz_status ritz_fit_estimator(const ritz_fitter *fitter,
                               const ritz_component *full,
                               ritz_fit_place *place);

/* --- candidate.c ------------------------------------------------------------- */

/** Record the sentence of a failure that is the candidate's own; pass on what
 * is not: memory. */
ritz_status ritz_fit_refuse(ritz_status status, ritz_fit_candidate *candidate);

/** Fill ratio, worst and feasible from errors and limits. */
void ritz_fit_judge(const ritz_verify_request *limits,
                    ritz_fit_candidate *candidate);

/** The worse of each measure, @p more's told with where it is, into @p worst. */
ritz_status ritz_fit_worst(const ritz_measures *more, const char *at,
                           ritz_measures *worst);

/**
 * Where what met the grid is confirmed: at random frequencies, and at the
 * model's own poles. Where each point takes a factor, poles that stand for the
 * full model's, around which the grid is fine already, are passed over.
 */
int ritz_fit_points(const ritz_reference *reference,
                    const ritz_measures *errors);

/** Flexible body @p k by a method and a number of modes; forget those made by
 * a method. */
ritz_status ritz_fit_body(ritz_fitter *fitter, const ritz_method *method,
                          int64_t k, int64_t modes, ritz_reduced *out);
void ritz_fit_forget(ritz_fitter *fitter, const ritz_method *method);

/** Errors of a stage at a place among the worst so far; refuse what is
 * unstable where it is confirmed (@p points is not 0). */
ritz_status ritz_fit_measure_at(ritz_fitter *fitter, const ritz_stage *stage,
                                const ritz_fit_place *place, int points,
                                ritz_fit_candidate *candidate);

/**
 * Measure and judge a stage: at every listed place, by bounds or on the grid;
 * what holds there at all places where it is confirmed too.
 */
ritz_status ritz_fit_measure(ritz_fitter *fitter, const ritz_stage *stage,
                             ritz_fit_candidate *candidate);

/** Bounds of a scene's stage at every place in place of its estimates. */
ritz_status ritz_fit_bound_stage(ritz_fitter *fitter, const ritz_stage *stage,
                                 ritz_fit_candidate *candidate);

/** Make, measure and judge a candidate; bound one of a scene that was tried. */
ritz_status ritz_fit_try(ritz_fitter *fitter, ritz_fit_candidate *candidate);
ritz_status ritz_fit_bound(ritz_fitter *fitter, ritz_fit_candidate *candidate);

/** Whether candidate @p a is nearer to the tolerance, as far as is known: it
 * misses fewer modes that may not be missing, or its other errors are less. */
bool ritz_fit_is_nearer(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b);

/** Modes that a candidate misses and may not. */
double ritz_fit_misses(const ritz_fit_candidate *candidate);

/* --- nest.c ------------------------------------------------------------------ */

/** Flexible bodies of a candidate, num_bodies, cut if it is. */
ritz_status ritz_fit_make_bodies(ritz_fitter *fitter,
                                 const ritz_fit_candidate *candidate,
                                 ritz_reduced *out);

/**
 * The candidate without columns that its tolerance can do without; its order is
 * 0 if there are none.
 */
ritz_status ritz_fit_trim(ritz_fitter *fitter, const ritz_fit_candidate *from,
                          ritz_fit_candidate *out);

/* --- explain.c --------------------------------------------------------------- */

/** Why the chosen one, in words; where nothing was met, what ended it. */
ritz_status ritz_fit_explain(const ritz_fitter *fitter, ritz_fit *fit);

#endif
