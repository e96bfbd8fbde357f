/*
 * The fitter: full models that candidates are compared with, the bodies of a
 * scene and their ladder of modes. A component is a scene of one body that is
 * joined to nothing; functions ask `scene` only where that matters.
 */
#ifndef RITZ_FIT_FITTER_H
#define RITZ_FIT_FITTER_H

#include "base/aside.h"
#include "linear/ordering.h"
#include "linear/spectra.h"

#include <ritz/assembly.h>
#include <ritz/fit.h>
#include <ritz/verify.h>

/* The full model at one configuration. */
typedef struct ritz_fit_place {
    double *setting; /* of each sweep of the scene; NULL: of a component */
    char at[RITZ_NAME_SIZE];
    ritz_component full; /* as it is compared, with its dampers */
    ritz_reference *reference;
    ritz_estimator *estimator; /* NULL: there are no bounds */
    ritz_master *master;       /* of a scene: which dofs full's are */
} ritz_fit_place;

/* A body in one basis, kept for the candidates that share it. */
typedef struct ritz_fit_made {
    const ritz_method *method;
    int64_t body, modes;
    ritz_reduced reduced; /* dampers installed; without T, unless bounds need
                             it */
    ritz_dense parts; /* of a component: Phi'M T, see ritz_reference_parts */
    ritz_fit_watch making;
    ritz_status status; /* of making it */
    char refusal[256];
} ritz_fit_made;

/* The basis of a body that a method made last. If the method is nested
   (family.c), candidates with fewer modes take their columns from it. */
typedef struct ritz_fit_family {
    const ritz_method *method;
    int64_t body;       /* flexible body, the first of those that are equal */
    bool exact;         /* it serves candidates with `modes` modes only */
    int64_t modes;      /* that it was made with; -1: none was made */
    ritz_reduced whole; /* {0}: dropped for lack of room; without T if a scene
                           has no bounds, which alone need it */
    ritz_dense parts;   /* of a component: Phi'M T of all its columns */
    int64_t used;       /* value of num_uses at its last use */
} ritz_fit_family;

/* The columns of a candidate's bodies, those whose loss raises its errors most
   first. Method and modes say which candidate, before columns are left out. */
typedef struct ritz_fit_ordered {
    const ritz_method *method;
    int64_t *modes;  /* num_bodies */
    int64_t count;   /* columns of all bodies */
    int64_t fixed;   /* the first of them, which must stay */
    int64_t step;    /* columns between two cuts that are measured */
    int64_t *column; /* count */
} ritz_fit_ordered;

/* A rung of a ladder: the body that gets one mode more. */
typedef struct ritz_fit_step {
    double hertz; /* of that mode; 0 where it is a direction of COMPARE */
    int64_t body;
} ritz_fit_step;

/* Bodies of COMPARE's second stage in all their directions. */
typedef struct ritz_fit_second {
    bool made;
    ritz_status status; /* of making it */
    char refusal[256];
    ritz_bodies body;    /* num_bodies, nested, dampers not installed */
    int64_t *rigid;      /* num_bodies, columns that move rigidly */
    int64_t num_steps;   /* of a ladder of its own */
    ritz_fit_step *step; /* num_steps, whose next direction matters most */
    double rich_hz;      /* the first stage has modes up to it */
    ritz_fit_watch making;
} ritz_fit_second;

/* Bodies joined: the stage borrows all of them. */
typedef struct ritz_fit_joined {
    ritz_stage stage;
    ritz_bodies own;   /* flexible ones that were made for this stage alone */
    ritz_dense parts;  /* of a component: Phi'M T, by which shapes are compared;
                         {0}: by T */
    ritz_pairs *modes; /* of a component: gets its modes when it is measured;
                          NULL: not wanted */
} ritz_fit_joined;

struct ritz_fitter {
    ritz_fit_request request;
    ritz_orders *orders;   /* fill-reducing orders, lent to all factors during
                            each call of a function of ritz/fit.h */
    ritz_spectra *spectra; /* all modes of small matrices, lent likewise */
    const ritz_component *component; /* borrowed; NULL: of a scene */
    const ritz_scene *scene;         /* borrowed; NULL: of a component */
    ritz_dofs attached;              /* of a component */
    int64_t num_places, num_listed;
    ritz_fit_place *place; /* listed ones first; those between them confirm */
    int64_t hardest;       /* listed place where errors were largest */
    bool rich;             /* a stage one is the reference */
    ritz_bodies still;     /* of each component of the scene that stays as it
                              is, dampers installed; flexible ones are empty */
    int64_t num_bodies;    /* flexible ones; 1 of a component */
    int64_t *body;         /* num_bodies, component of the scene */
    ritz_component *model; /* num_bodies, of a scene */
    int64_t *equal;        /* num_bodies: the first flexible body with the same
                              model, ports and options of its basis */
    ritz_pairs *known;     /* num_bodies, of a scene: free modes of each body,
                              as many as the ladder has; Phi is {0} for lack of
                              room, and of bodies that equal another */
    int64_t num_first;     /* rungs of the ladder that all are tried on */
    int64_t num_steps;     /* rungs there are beyond the lowest */
    ritz_fit_step *step;   /* num_steps, ascending frequencies */
    double rich_hz;        /* modes of bodies in a rich reference, up to it */
    int64_t num_made, room_made;
    ritz_fit_made *made;
    int64_t num_families, room_families;
    ritz_fit_family *family;
    int64_t num_uses;     /* of all families */
    int64_t most_entries; /* of T of all kept bases together, of T of all bodies
                             that were made, and of `known` */
    int64_t num_ordered, room_ordered;
    ritz_fit_ordered *ordered;
    ritz_fit_second second;
    int64_t largest; /* order to be tried */
    bool stopped;    /* request.stop said that the search shall end */
};

/* --- ahead.c -------------------------------------------------------------- */

/* Fixed-interface modes that another thread computes. */
typedef struct ritz_fit_ahead {
    ritz_sparse K_ii, M_ii;
    ritz_pairs modes; /* all of them, if `found` */
    bool found;
    ritz_aside aside;
} ritz_fit_ahead;

/**
 * Begin to compute the modes of a component with its attached dofs fixed, if it
 * is small and craig-bampton is among the methods.
 *
 * @param[in,out] out  empty; not moved before ritz_fit_ahead_free()
 */
ritz_status ritz_fit_ahead_begin(const ritz_fitter *fitter,
                                 ritz_fit_ahead *out);

/** Wait for the modes and put them into the store of this thread. */
ritz_status ritz_fit_ahead_store(ritz_fit_ahead *ahead);

void ritz_fit_ahead_free(ritz_fit_ahead *ahead);

/* --- bodies.c ------------------------------------------------------------- */

/** A stop watch, and what it shows. */
ritz_fit_watch ritz_fit_start(void);
ritz_fit_watch ritz_fit_since(ritz_fit_watch start);

/** Load the bodies of a scene; make the ladder of those that are flexible. */
ritz_status ritz_fit_bodies(ritz_fitter *fitter);

/**
 * Make the ladder longer, to twice the modes of the body that ends it.
 *
 * @param[out] end  why it could not be; RITZ_FIT_END_NONE: it is longer
 */
ritz_status ritz_fit_extend(ritz_fitter *fitter, ritz_fit_end *end);

/** Modes of flexible body @p k up to a frequency, as far as the ladder has
 * them. */
int64_t ritz_fit_modes_to(const ritz_fitter *fitter, int64_t k, double hertz);

/**
 * Join flexible bodies to those that stay. All are borrowed until
 * ritz_fit_joined_free.
 *
 * @param[in] flexible  num_bodies, dampers installed
 */
ritz_status ritz_fit_join(const ritz_fitter *fitter,
                          const ritz_reduced *flexible, ritz_fit_joined *out);

/* --- family.c ------------------------------------------------------------- */

/** Whether a column of this kind may never be left out: without it a body could
 * not move rigidly, or would lose a part of its interface. */
bool ritz_fit_stays(ritz_column_kind kind);

/**
 * The kind of each column of a body. A column that takes part in rigid motion
 * of the body is RITZ_COLUMN_RIGID, also if its method calls it a mode.
 *
 * @param[out] kind  one for each column
 */
ritz_status ritz_fit_kinds(const ritz_reduced *whole, ritz_column_kind *kind);

/** Reduce flexible body @p k by a method with a number of modes; dampers not
 * installed. @return as ritz_basis_make */
ritz_status ritz_fit_body(ritz_fitter *fitter, const ritz_method *method,
                          int64_t k, int64_t modes, ritz_reduced *out);

/** Whether flexible bodies @p j and @p k have the same reduced models by a
 * method: they are equal, and their neighbours do not matter to it. */
bool ritz_fit_are_equal(const ritz_fitter *fitter, const ritz_method *method,
                        int64_t j, int64_t k);

/**
 * Reduce flexible body @p k by a method with a number of modes, for a candidate.
 * If the method is nested, columns are taken from a basis with more modes, which
 * is made once for all bodies that are equal, and again with twice as many modes
 * when more are asked for. Of any other method the last basis of a component is
 * kept, in case it is asked for again; that of a scene's body is not.
 *
 * @param[in]  with_T  whether @p out gets T (n x r) and invariants; of a scene
 *                     without bounds T is not kept
 * @param[out] out     dampers not installed
 * @param[out] parts   of a component: Phi'M T, modes of the reference x r; {0}:
 *                     of a scene
 * @return as ritz_basis_make
 * @cost   a basis if no kept one serves; otherwise O(N^2 r) for the N columns
 *         of the kept one, and O(n r) with T
 */
ritz_status ritz_fit_take(ritz_fitter *fitter, const ritz_method *method,
                          int64_t k, int64_t modes, bool with_T,
                          ritz_reduced *out, ritz_dense *parts);

void ritz_fit_family_free(ritz_fit_family *family);

/* --- bodies.c: joined bodies ---------------------------------------------- */

/** Join the flexible bodies that @p joined owns, and install their dampers. */
ritz_status ritz_fit_join_own(const ritz_fitter *fitter,
                              ritz_fit_joined *joined);
void ritz_fit_joined_free(ritz_fit_joined *joined);

/** The scene with modes of flexible bodies far beyond the band. */
ritz_status ritz_fit_rich(const ritz_fitter *fitter, double up_to_hz,
                          ritz_fit_joined *out);

/* --- second.c ------------------------------------------------------------- */

/** Modes of each body after @p rung steps of a method's ladder; its length. */
void ritz_fit_rung(const ritz_fitter *fitter, const ritz_method *method,
                   int64_t rung, int64_t *modes);
int64_t ritz_fit_rungs(const ritz_fitter *fitter, const ritz_method *method);

/**
 * Make COMPARE's bodies of a first stage with modes up to a frequency, unless
 * they are made of as rich a one. If the first time is refused, each candidate
 * says why; later a refusal leaves those that were made before.
 *
 * @param[out] made  whether they are now of so rich a stage; NULL: not wanted
 */
ritz_status ritz_fit_second_make(ritz_fitter *fitter, double up_to_hz,
                                 bool *made);

/** Flexible body @p k with its rigid motions and @p count directions. */
ritz_status ritz_fit_second_body(ritz_fitter *fitter, int64_t k, int64_t count,
                                 ritz_reduced *out);
void ritz_fit_second_free(ritz_fit_second *second);

/* --- fitter.c ------------------------------------------------------------- */

/** How far beyond the band, times it: 8, and up to 32 for fine tolerances. */
double ritz_fit_rich_to(const ritz_verify_request *limits);

/** The estimator of a place, if bounds were requested. The place must have its
 * reference, whose modes the estimator borrows. */
ritz_status ritz_fit_estimator(const ritz_fitter *fitter,
                               const ritz_component *full,
                               ritz_fit_place *place);

/** Ask request.stop, before a model is measured, whether the search shall end.
 * @return RITZ_ERR_CONVERGENCE if so, now or before; `stopped` is then set */
ritz_status ritz_fit_go_on(ritz_fitter *fitter);

/* --- candidate.c ---------------------------------------------------------- */

/** Record the sentence of a failure that is the candidate's own; pass on what
 * is not: memory. */
ritz_status ritz_fit_refuse(ritz_status status, ritz_fit_candidate *candidate);

/** Fill ratio, worst and feasible from errors and limits. */
void ritz_fit_judge(const ritz_verify_request *limits,
                    ritz_fit_candidate *candidate);

/** The worse of each measure into @p worst; that of @p more with its place. */
ritz_status ritz_fit_worst(const ritz_measures *more, const char *at,
                           ritz_measures *worst);

/**
 * Where what met the grid is confirmed: at random frequencies, and at the
 * model's own poles. Where each point takes a factor, poles that stand for the
 * full model's, around which the grid is fine already, are passed over.
 */
int ritz_fit_points(const ritz_reference *reference,
                    const ritz_measures *errors);

/** Forget the bodies that were made by a method. */
void ritz_fit_forget(ritz_fitter *fitter, const ritz_method *method);

/**
 * Add the errors of joined bodies at a place to the worst so far; refuse what
 * is unstable where it is confirmed (@p points is not 0).
 *
 * @param[in] bounds  find a lower bound first, and do not measure what it rules
 *                    out
 */
ritz_status ritz_fit_measure_at(ritz_fitter *fitter,
                                const ritz_fit_joined *joined,
                                const ritz_fit_place *place, int points,
                                bool bounds, ritz_fit_candidate *candidate);

/**
 * Measure and judge joined bodies: at every listed place on the grid, unless a
 * bound rules them out. If they meet the tolerance there, confirm them at all
 * places, at random frequencies too.
 */
ritz_status ritz_fit_measure(ritz_fitter *fitter, const ritz_fit_joined *joined,
                             ritz_fit_candidate *candidate);

/** The cost of simulating joined bodies at the first place; there may be none.
 */
ritz_status ritz_fit_take_cost(const ritz_fitter *fitter,
                               const ritz_stage *stage,
                               ritz_fit_candidate *candidate);

/** Replace a candidate's estimates by bounds of its joined bodies, the worst of
 * all places. */
ritz_status ritz_fit_bound_stage(ritz_fitter *fitter, const ritz_stage *stage,
                                 ritz_fit_candidate *candidate);

/** Find the bounds of a scene's candidate without columns left out; its bodies
 * are joined for that. */
ritz_status ritz_fit_bound_joined(ritz_fitter *fitter,
                                  ritz_fit_candidate *candidate);

/** Whether candidate @p a is nearer to the tolerance, as far as is known: it
 * misses fewer modes that may not be missing, or its other errors are less. */
bool ritz_fit_is_nearer(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b);

/** Modes that a candidate misses and may not. */
double ritz_fit_misses(const ritz_fit_candidate *candidate);

/* --- ordered.c ------------------------------------------------------------ */

/** The order that was kept for the @p count columns of a candidate's bodies,
 * valid until another is kept; NULL: there is none. */
const ritz_fit_ordered *ritz_fit_ordered_find(const ritz_fitter *fitter,
                                              const ritz_fit_candidate *of,
                                              int64_t count);

/** Keep a copy of an order, for the method and modes of candidate @p of; those
 * of @p found are not used. */
ritz_status ritz_fit_ordered_keep(ritz_fitter *fitter,
                                  const ritz_fit_candidate *of,
                                  const ritz_fit_ordered *found);
void ritz_fit_ordered_free(ritz_fit_ordered *ordered);

/* --- nest.c --------------------------------------------------------------- */

/**
 * Make the flexible bodies of a candidate without the columns that it leaves
 * out; dampers not installed.
 *
 * @param[in] proven  make each basis anew with the modes of the candidate, and
 *                    prove by a count that none is missing; otherwise take the
 *                    bases that the search keeps, which is cheaper
 */
ritz_status ritz_fit_make_bodies(ritz_fitter *fitter,
                                 const ritz_fit_candidate *candidate,
                                 bool proven, ritz_bodies *out);

/** Measure the cost of a feasible candidate, unless it was measured. */
ritz_status ritz_fit_cost(ritz_fitter *fitter, ritz_fit_candidate *candidate);

/** Find the bounds of a candidate that was tried, the worst of all places. */
ritz_status ritz_fit_bound(ritz_fitter *fitter, ritz_fit_candidate *candidate);

/**
 * The candidate without columns that its tolerance can do without; its order is
 * 0 if there are none.
 */
ritz_status ritz_fit_trim(ritz_fitter *fitter, const ritz_fit_candidate *from,
                          ritz_fit_candidate *out);

/* --- search.c ------------------------------------------------------------- */

/* A candidate up to this factor larger than the smallest may still win once
   columns are left out. */
#define RITZ_FIT_REACH 1.5

/** Try a candidate, or find it among those that were tried. */
ritz_status ritz_fit_visit(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                           const int64_t *modes, int64_t *at);

/** One candidate more, moved into the list. */
ritz_status ritz_fit_append(ritz_fit *fit, ritz_fit_candidate *candidate);

/** Whether candidate @p a is a better answer than @p b: smaller, or as small
 * and nearer. */
bool ritz_fit_is_better(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b);

/** Largest candidate of a method with at most @p order columns, the nearest of
 * those; -1: it has none that was made. */
int64_t ritz_fit_largest_of(const ritz_fit *fit, const ritz_method *method,
                            int64_t order);

/** The best and the nearest of a method, of all that were tried. */
void ritz_fit_conclude(ritz_fit *fit, int64_t method);

/** Make COMPARE's first stage rich enough; @p end: what ended that, or none. */
ritz_status ritz_fit_enrich(ritz_fitter *fitter, ritz_fit_end *end);

/** Search one method; @p on: beyond the end of the scene's first ladder, where
 * nothing was met. */
ritz_status ritz_fit_search(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                            bool on);

#endif
