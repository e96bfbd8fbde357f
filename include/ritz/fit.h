/*
 * The smallest model that meets a tolerance: over methods and orders, every
 * candidate measured against one full model that was prepared once.
 *
 * A component is measured as it stands, with its own inputs and outputs; how it
 * behaves between others a scene tells, which is measured as a system at every
 * listed configuration and, to confirm, at random ones between them.
 */
#ifndef RITZ_FIT_H
#define RITZ_FIT_H

#include <ritz/assembly.h>
#include <ritz/basis.h>
#include <ritz/model.h>
#include <ritz/scene.h>
#include <ritz/simulate.h>
#include <ritz/verify.h>

#pragma GCC visibility push(default)

/* Seconds: on the wall, and of the processor. */
typedef struct ritz_fit_watch {
    double wall, cpu;
} ritz_fit_watch;

/* One model that was tried: a method, and a number of modes for each body. */
typedef struct ritz_fit_candidate {
    const ritz_method *method;
    int64_t num_bodies; /* flexible components; 1 of a component */
    int64_t *modes;     /* num_bodies, modes asked for; -1: the method takes no
                             number of modes */
    int64_t order;      /* columns; of a scene: of the largest system */
    int64_t left_out;   /* columns of its bases that are left out because the
                             tolerance holds without them: not in `order` and
                             `columns` */
    int64_t columns;    /* of all flexible bodies together */
    ritz_measures errors;    /* worst of all configurations; {0} if refused */
    ritz_measures estimates; /* bounds, of the result and the runner-up of a
                                search: worst of all configurations. Of other
                                candidates of a scene the lower bound of the
                                frequency error, at one configuration */
    double ratio;     /* largest error over its tolerance; 1 or less: met */
    int64_t worst;    /* the measure of that ratio in `errors`; -1: none */
    bool feasible;    /* it meets the tolerance everywhere, and is stable */
    bool unconfirmed; /* it met the tolerance on the grid, and not at the random
                         frequencies and configurations */
    bool ruled_out;   /* of a scene: a lower bound of its error is above the
                         tolerance, so it was not measured */
    ritz_fit_watch making; /* to make basis and reduction */
    ritz_cost cost;        /* if it is feasible; order 0: not measured */
    char refusal[256];     /* why it could not be made, or is unstable; "" */
} ritz_fit_candidate;

/* Called with each candidate as it is done. */
typedef void ritz_fit_observer(const ritz_fit_candidate *candidate,
                               void *context);

typedef struct ritz_fit_request {
    ritz_verify_request tolerance; /* band, damping, limits */
    int64_t num_methods; /* 0: every method that makes reduced components and
                            takes a number of modes; for a component with ports
                            only those that keep its interface; for a scene
                            `compare` as well */
    const ritz_method *const *methods; /* borrowed */
    ritz_choice choice;                /* options of methods that have them */
    const char *attach;                /* ports of a component; NULL: all */
    int64_t largest;       /* order to be tried; 0: four times what the band
                               holds, and 40; of a scene as far as errors fall,
                               with a thousand modes or so at most */
    int64_t num_random;    /* frequencies that confirm; configurations are
                               `num_between` */
    int64_t num_between;   /* random configurations that confirm */
    uint64_t seed;         /* of both */
    bool estimates;        /* find bounds of the result and the runner-up, and
                              do not measure candidates of a scene that a lower
                              bound rules out */
    bool costs;            /* of every method's best or, with an observer or
                              `thorough`, of all that are feasible; measured,
                              some 2 ms each */
    bool thorough;         /* every method to its end, not only as far as twice
                            the best of others */
    int64_t most_full;     /* dofs up to which a scene's full system is the
                               reference; above it a rich stage one is */
    int64_t most_measured; /* systems at a place, to put a scene's columns in
                              order and for what cuts come to: beyond it some
                              places and some cuts speak for all; 0: no end */
    ritz_fit_observer *observe;  /* may be NULL */
    bool (*stop)(void *context); /* asked often during a search: true ends it
                                    with the best so far; NULL: never */
    void *context;               /* of both */
} ritz_fit_request;

#define RITZ_FIT_NONE                                                          \
    {                                                                          \
        .tolerance = RITZ_VERIFY_NONE, .num_random = 1000, .num_between = 4,   \
        .seed = 1, .estimates = true, .costs = true, .most_full = 20000,       \
        .most_measured = 1000                                                  \
    }

/* What ended the search of a method that met nothing. */
typedef enum ritz_fit_end {
    RITZ_FIT_END_NONE,      /* it met the tolerance, or others do with less */
    RITZ_FIT_END_LARGEST,   /* the next is larger than `largest` */
    RITZ_FIT_END_WHOLE,     /* there are no more modes */
    RITZ_FIT_END_SAME,      /* more modes gave no more columns */
    RITZ_FIT_END_FLAT,      /* more modes gave no smaller error */
    RITZ_FIT_END_FAR,       /* as many modes as are tried unless `largest` says
                              more */
    RITZ_FIT_END_REFERENCE, /* a rich first stage is compared with, and has no
                              more */
    RITZ_FIT_END_REFUSED,   /* the next cannot be made */
} ritz_fit_end;

/* The full model, ready; and what of candidates can be kept. */
typedef struct ritz_fitter ritz_fitter;

/* What came of a search. */
typedef struct ritz_fit {
    int64_t count, room;
    ritz_fit_candidate *candidate; /* all that were tried, in their order */
    int64_t chosen, runner_up;     /* -1: none; the runner-up is the best of
                                      another method */
    bool interrupted;              /* request.stop ended the search: candidates
                                      that were not tried may be smaller */
    int64_t num_methods;
    int64_t *best;     /* num_methods, of each the smallest that is feasible;
                          -1: none is */
    int64_t *reached;  /* num_methods, of each the one that misses the fewest
                         modes, with the least ratio; -1: all were refused */
    ritz_fit_end *end; /* num_methods, of each that met nothing what ended it */
    const ritz_method **method; /* num_methods */
    char why[1024];
} ritz_fit;

/*
 * From the whole answer down to the fewest columns that its bodies can have,
 * each row one column less than the one before; where they are many, some. In a
 * row each flexible body is cut to its first columns; `modes` is their number,
 * in a scene the `order` of its file. Errors are the worst of all listed and
 * random configurations.
 */
typedef struct ritz_fit_path {
    int64_t num_bodies, count;
    ritz_fit_candidate *row;
} ritz_fit_path;

/* Composite modes of a scene's configurations on each body, the second stage of
   COMPARE: a method among those of a scene, and refused of a component. Its
   "modes" are the number of directions of a body. */
extern const ritz_method ritz_fit_compare;

/** A method of a search by its name: one of ritz_methods, or that. */
const ritz_method *ritz_fit_method_find(const char *name);

/**
 * Prepare a component: its modes to three times the band, responses at all
 * points where candidates are compared.
 *
 * @param[in] component  borrowed until free; dampers not installed
 * @return RITZ_ERR_ARGUMENT if there is no band, no tolerance, or one for what
 *         the component does not have
 */
ritz_status ritz_fitter_new(const ritz_component *component,
                            const ritz_fit_request *request, ritz_fitter **out);

/**
 * Prepare a scene: the system at each listed configuration, and at random ones
 * between them. Bodies that the scene has as rigid, or that are reduced
 * already, stay as they are.
 *
 * @param[in] scene  borrowed until free; its band and damping where the request
 *                   has none
 */
ritz_status ritz_fitter_scene(const ritz_scene *scene,
                              const ritz_fit_request *request,
                              ritz_fitter **out);

/** "the full system of 1200 dofs at 6 configurations, 4 more at random". */
void ritz_fitter_describe(const ritz_fitter *fitter, int64_t size, char *out);

/** Band and damping as they were settled. */
const ritz_verify_request *ritz_fitter_tolerance(const ritz_fitter *fitter);

/** Number of flexible bodies, of which a candidate has a number of modes. */
int64_t ritz_fitter_bodies(const ritz_fitter *fitter);
const char *ritz_fitter_body(const ritz_fitter *fitter, int64_t k);

/**
 * Try one candidate. What cannot be made is no failure: its refusal says why.
 *
 * @param[in] modes  one for each flexible body
 * @return RITZ_ERR_MEMORY, or RITZ_ERR_... of the full model
 */
ritz_status ritz_fitter_try(ritz_fitter *fitter, const ritz_method *method,
                            const int64_t *modes, ritz_fit_candidate *out);

/**
 * Search methods and orders.
 *
 * Of each method the order is doubled until the tolerance holds, bisected, and
 * then orders below are tried one by one, since errors do not always fall with
 * the order; of a scene modes are then taken from one body after the other, and
 * exchanged between them.
 *
 * A search that request.stop ends has the best of the candidates that were
 * tried, without bounds. The reduced components or the system that this fitter
 * makes afterwards are not nested, and have no path.
 *
 * @return as ritz_fitter_try; that no method meets the tolerance is no failure
 *         but has no `chosen`
 */
ritz_status ritz_fitter_search(ritz_fitter *fitter, ritz_fit *out);

/**
 * Of each method of a search one candidate of an order, or the nearest below:
 * appended to the search's candidates.
 *
 * @param[out] at  num_methods, which candidate; -1: all were refused
 */
ritz_status ritz_fitter_equal(ritz_fitter *fitter, int64_t order, ritz_fit *fit,
                              int64_t *at);

/**
 * The reduced component of a candidate, nested: columns that must stay first,
 * then the others as they matter, with the errors of every prefix.
 *
 * @return as ritz_fitter_try, or RITZ_ERR_CONVERGENCE if request.stop ends it
 */
ritz_status ritz_fitter_reduced(ritz_fitter *fitter,
                                const ritz_fit_candidate *candidate,
                                ritz_reduced *out);

/**
 * The reduced system of a candidate at all configurations of the scene, and how
 * it can be cut.
 *
 * Columns of all flexible bodies are put in one order: from the whole system
 * one at a time is left out, that without which it is nearest to its tolerance
 * on the grid of the listed configurations, of six that matter least alone.
 * Those that must stay (ritz_fitter_reduced) stay, of a body without any that
 * which matters most alone. Each body is nested in its own part of that order.
 *
 * What a body's file notes of a prefix, and of the whole body as its errors, is
 * no error of the body but one of the system, and its name begins with
 * "system-": the worst at all listed and random configurations if this body
 * alone is cut to that prefix while all others are whole. What several cuts
 * come to together, the path tells.
 *
 * @param[out] body  one for each component of the scene, nested where flexible
 * @param[out] path  from the whole system down, measured where candidates are
 *                   confirmed; ritz_fit_path_free
 * @return as ritz_fitter_reduced
 * @cost  of c columns that may go at p listed and q random configurations:
 *        c (2 p + 5) systems measured on the grid, or some more, and at most
 *        2 c (p + q) where candidates are confirmed; where c p or the latter is
 *        above request.most_measured, at every s-th place and for every s-th
 *        cut alone
 */
ritz_status ritz_fitter_system(ritz_fitter *fitter,
                               const ritz_fit_candidate *candidate,
                               ritz_bodies *body, ritz_fit_path *path,
                               ritz_system *out);

void ritz_fitter_free(ritz_fitter **fitter);
void ritz_fit_candidate_free(ritz_fit_candidate *candidate);
void ritz_fit_free(ritz_fit *fit);
void ritz_fit_path_free(ritz_fit_path *path);

#pragma GCC visibility pop

#endif
