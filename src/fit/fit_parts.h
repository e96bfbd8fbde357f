/* What the files of this room share. */
#ifndef RITZ_FIT_FIT_PARTS_H
#define RITZ_FIT_FIT_PARTS_H

#include <ritz/estimate.h>
#include <ritz/fit.h>
#include <ritz/reference.h>
#include <ritz/synthesis.h>

/* The full system at one configuration. */
typedef struct ritz_fit_place {
    double *setting; /* of each sweep of the scene; NULL: of a component */
    char at[RITZ_NAME_SIZE];
    bool listed;         /* false: between, to confirm */
    ritz_component full; /* as it is compared, with its dampers */
    ritz_reference *reference;
    ritz_estimator *estimator; /* NULL: none */
    ritz_master *master;       /* of a scene: which dofs full's are */
} ritz_fit_place;

/* A body of a scene in one basis, kept as neighbours of a candidate use it. */
typedef struct ritz_fit_made {
    const ritz_method *method;
    int64_t body, modes;
    ritz_reduced reduced; /* without T, unless bounds need it */
    ritz_fit_watch spent;
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
    int64_t num_steps;  /* a ladder of its own */
    int64_t *step;      /* num_steps, whose next direction matters most */
    double rich_hz;     /* modes of the first stage, up to it */
    ritz_fit_watch spent;
} ritz_fit_second;

struct ritz_fitter {
    ritz_fit_request request;
    const ritz_component *component; /* of a component: borrowed */
    const ritz_scene *scene;         /* of a scene: borrowed */
    ritz_dofs attached;              /* of a component */
    int64_t num_places;
    ritz_fit_place *place; /* listed ones first */
    int64_t hardest;       /* listed place where errors were largest */
    bool rich;             /* a stage one is the reference */
    int64_t num_bodies;    /* flexible */
    int64_t *body;         /* num_bodies, component of the scene */
    ritz_component *model; /* num_bodies, of a scene */
    ritz_reduced *still;   /* of every component of the scene that stays as
                               it is; empty for flexible ones */
    int64_t num_first;     /* rungs of the ladder that all are tried on */
    int64_t num_steps;     /* rungs there are beyond the lowest */
    int64_t *step;         /* num_steps, which body has one mode more */
    double *step_hz;       /* num_steps, and that mode's frequency */
    double rich_hz;        /* modes of bodies in a rich reference, up to it */
    int64_t num_made;
    ritz_fit_made *made;
    ritz_fit_second second;
    int64_t largest; /* order to be tried */
};

/** Copy with K and D of its own, its dampers installed. */
ritz_status ritz_fit_install(const ritz_component *component,
                             ritz_component *out);
void ritz_fit_uninstall(ritz_component *copy);

/** Fill excess, binding and feasible from errors and limits. */
void ritz_fit_judge(const ritz_verify_request *limits,
                    ritz_fit_candidate *candidate);

/** Whether some measure has a limit at all, and what is limited exists. */
ritz_status ritz_fit_check(const ritz_verify_request *limits,
                           const ritz_component *full);

/** Where nothing moves rigidly, the flexible response is the response; whose
 * damping is asked for may not be missing. */
void ritz_fit_settle(const ritz_reference *reference,
                     ritz_verify_request *limits);

/** Order up to which candidates are tried, of @p n dofs with @p held attached. */
int64_t ritz_fit_largest(const ritz_fitter *fitter, int64_t held, int64_t n);

/** The reference of a place, whose full model is there. */
ritz_status ritz_fit_refer(const ritz_fit_request *request,
                           ritz_fit_place *place);

/** Load the bodies of a scene and make the ladder of those that are flexible. */
ritz_status ritz_fit_bodies(ritz_fitter *fitter);

/**
 * The ladder longer, to twice the modes of the body that ends it.
 *
 * @param[out] end  why it could not be; RITZ_FIT_END_NONE: it is longer
 */
ritz_status ritz_fit_extend(ritz_fitter *fitter, ritz_fit_end *end);

/** Modes of each body after @p rung steps of a method's ladder. */
void ritz_fit_rung(const ritz_fitter *fitter, const ritz_method *method,
                   int64_t rung, int64_t *modes);

/** Steps of that ladder, of a scene. */
int64_t ritz_fit_rungs(const ritz_fitter *fitter, const ritz_method *method);

/**
 * The scene's flexible bodies with modes far beyond the band, joined to those
 * that stay, which are lent: ritz_fit_rich_free takes them back.
 */
ritz_status ritz_fit_rich(ritz_fitter *fitter, double up_to_hz,
                          ritz_stage *out);

/** How far beyond the band, times it: 8, and up to 32 for fine tolerances. */
double ritz_fit_rich_to(const ritz_verify_request *limits);
void ritz_fit_rich_free(ritz_fitter *fitter, ritz_stage *stage);

/** Make COMPARE's bodies, once; if they are refused, each candidate says why. */
ritz_status ritz_fit_second_make(ritz_fitter *fitter);

/** The same of a first stage with modes up to that; what fails leaves those
 * that were made before. */
ritz_status ritz_fit_second_remake(ritz_fitter *fitter, double up_to_hz,
                                   bool *made);

/**
 * Make COMPARE's first stage richer until, with nothing removed, it leaves at
 * most a tenth of the tolerance, or does not get better.
 *
 * @param[out] end  what ended it; RITZ_FIT_END_NONE: it is rich enough
 */
ritz_status ritz_fit_enrich(ritz_fitter *fitter, ritz_fit_end *end);

/** Forget bodies that were made by a method. */
void ritz_fit_forget(ritz_fitter *fitter, const ritz_method *method);

/** Flexible body @p k with its rigid motions and so many directions. */
ritz_status ritz_fit_second_body(ritz_fitter *fitter, int64_t k, int64_t count,
                                 ritz_reduced *out);
void ritz_fit_second_free(int64_t num_bodies, ritz_fit_second *second);

/** Try a component's candidate, a scene's. */
ritz_status ritz_fit_try_component(ritz_fitter *fitter,
                                   ritz_fit_candidate *candidate);
ritz_status ritz_fit_try_scene(ritz_fitter *fitter,
                               ritz_fit_candidate *candidate);

/** Basis and reduction of the component, dampers bare. */
ritz_status ritz_fit_make(const ritz_fitter *fitter,
                          const ritz_fit_candidate *candidate,
                          ritz_basis *basis, ritz_reduced *reduced);

/** Record the sentence of a failure that is the candidate's own; pass on what
 * is not: memory. */
ritz_status ritz_fit_refuse(ritz_status status, ritz_fit_candidate *candidate);

/** A stop watch, and what it shows. */
ritz_fit_watch ritz_fit_start(void);
ritz_fit_watch ritz_fit_since(ritz_fit_watch start);

/** What a method heeds of what all are told; its damping is everybody's. */
ritz_choice ritz_fit_choose(const ritz_fitter *fitter,
                            const ritz_method *method);

/** Refuse what is unstable; measure what a feasible one costs. */
ritz_status ritz_fit_probe(const ritz_second_order *model,
                           const ritz_damping *damping,
                           ritz_fit_candidate *candidate);
ritz_status ritz_fit_price(const ritz_fitter *fitter,
                           const ritz_second_order *model,
                           ritz_fit_candidate *candidate);

/**
 * Measure and judge a stage of a scene: at every listed place, by bounds or on
 * the grid; what holds there where it is confirmed too. Bounds need every
 * body's T.
 */
ritz_status ritz_fit_measure_scene(ritz_fitter *fitter, const ritz_stage *stage,
                                   ritz_fit_candidate *candidate);

/** Bounds of a scene's candidate at every listed place, for its estimates. */
ritz_status ritz_fit_bound_scene(ritz_fitter *fitter, const ritz_stage *stage,
                                 ritz_fit_candidate *candidate);

/** The same of a candidate that was tried; of a component nothing is left to
 * do. */
ritz_status ritz_fit_bound(ritz_fitter *fitter, ritz_fit_candidate *candidate);

/** Bodies that stay as they are, lent to a stage, come home. */
void ritz_fit_take_back(ritz_fitter *fitter, ritz_reduced *body);

/** Flexible body @p k by a method and a number of modes. */
ritz_status ritz_fit_body(ritz_fitter *fitter, const ritz_method *method,
                          int64_t k, int64_t modes, ritz_reduced *out);

/** A component's columns in the order in which they matter. */
ritz_status ritz_fit_nest(const ritz_fitter *fitter, const ritz_reduced *whole,
                          ritz_reduced *out);

/**
 * The same of all flexible bodies of a scene together.
 *
 * @param[in]  whole  num_bodies, dampers bare
 * @param[in]  notes  whether prefixes are measured and noted too
 * @param[out] body   the scene's components, of which flexible ones are made
 */
ritz_status ritz_fit_nest_scene(ritz_fitter *fitter, const ritz_reduced *whole,
                                bool notes, ritz_reduced *body,
                                ritz_fit_path *path);

/** Flexible bodies of a scene's candidate, num_bodies, cut if it is. */
ritz_status ritz_fit_make_bodies(ritz_fitter *fitter,
                                 const ritz_fit_candidate *candidate,
                                 ritz_reduced *out);

/** Measure and judge a component's reduction, whose dampers are installed by
 * that: on the grid, and where it is confirmed. */
ritz_status ritz_fit_measure(ritz_fitter *fitter, ritz_reduced *reduced,
                             ritz_fit_candidate *candidate);

/**
 * The candidate without columns that its tolerance can do without; its order is
 * 0 if there are none.
 */
ritz_status ritz_fit_trim(ritz_fitter *fitter, const ritz_fit_candidate *from,
                          ritz_fit_candidate *out);
ritz_status ritz_fit_trim_scene(ritz_fitter *fitter,
                                const ritz_fit_candidate *from,
                                ritz_fit_candidate *out);

/** Whether a column must stay: without it a body could not move rigidly, or
 * would not have its interface. */
bool ritz_fit_stays(ritz_column_kind kind);

/** Whether candidate @p a is a better answer than @p b: smaller, or as small
 * and nearer. */
bool ritz_fit_is_better(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b);

/** Whether candidate @p a is nearer to the tolerance, as far as is known: it
 * misses fewer modes that may not be missing, or its other errors are less. */
bool ritz_fit_is_nearer(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b);

/** Modes that a candidate misses and may not. */
double ritz_fit_misses(const ritz_fit_candidate *candidate);

/** Of a method's candidates of no higher order the largest, the nearest of
 * those; -1: it has none. */
int64_t ritz_fit_largest_of(const ritz_fit *fit, int64_t method, int64_t order);

/**
 * Where what met the grid is confirmed: at random frequencies, and at the
 * model's own poles. Where each point takes a factor, poles that stand for the
 * full model's, around which the grid is fine already, are passed over.
 */
int ritz_fit_places(const ritz_reference *reference,
                    const ritz_measures *errors);

/* What bounds say of a candidate at a place. */
typedef enum ritz_fit_verdict {
    RITZ_FIT_OPEN, /* measure it */
    RITZ_FIT_HOLDS,
    RITZ_FIT_FAILS,
} ritz_fit_verdict;

/** Factors for bounds at a place, if they are wanted. */
ritz_status ritz_fit_estimator(const ritz_fitter *fitter,
                               const ritz_component *full,
                               ritz_fit_place *place);

/**
 * Bounds of a reduced model at a place that has an estimator, or what its error
 * is at least; none where nothing can be known.
 */
ritz_status ritz_fit_bound_at(const ritz_fit_place *place, const ritz_dense *T,
                              const ritz_reduced *reduced, bool least,
                              ritz_measures *out);

/**
 * Bound a candidate at a place, into its estimates; one that fails is screened.
 * A thorough search leaves everything open.
 *
 * @param[in] T  over the full model's dofs there, of the reduced model's columns
 */
ritz_status ritz_fit_foresee(const ritz_fitter *fitter,
                             const ritz_fit_place *place, const ritz_dense *T,
                             const ritz_reduced *reduced,
                             ritz_fit_candidate *candidate,
                             ritz_fit_verdict *verdict);

/** Take frequency-relative-least out of bounds that count missing modes, of
 * which it says nothing. */
void ritz_fit_forget_least(ritz_measures *found);

/** The worse of each measure, @p more's told with where it is, into @p worst. */
ritz_status ritz_fit_worst(const ritz_measures *more, const char *at,
                           ritz_measures *worst);

/** Candidates tried so far; try one, or find it among them. */
ritz_status ritz_fit_visit(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                           const int64_t *modes, int64_t *at);

/** Whether it was made, and not refused. */
bool ritz_fit_was_made(const ritz_fit_candidate *candidate);

/** One candidate more, moved into the list. */
ritz_status ritz_fit_append(ritz_fit *fit, ritz_fit_candidate *candidate);

/** The best and the nearest of a method, of all that were tried. */
void ritz_fit_conclude(ritz_fit *fit, int64_t method);

/** Search one method; @p on: beyond the end of the scene's first ladder, where
 * nothing was met. */
ritz_status ritz_fit_search(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                            bool on);

/** Take modes from bodies, and exchange them, while the tolerance holds. */
ritz_status ritz_fit_thin(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                          int64_t *best);

/** After `why`, where nothing was met: what ended the nearest method. */
void ritz_fit_explain_end(const ritz_fitter *fitter, ritz_fit *fit);

/** Why the chosen one, in words. */
ritz_status ritz_fit_explain(ritz_fitter *fitter, ritz_fit *fit);

#endif
