/*
 * Bodies that are joined over time: constraints C q = 0 hold by forces or by
 * projections, not by elimination.
 *
 *     M q'' + D q' + K q = B u - C'lambda,    C q = 0
 *
 * A stabilisation says how. The eliminated system (ritz_stage_assemble) is the
 * reference for all of them: its motion has no violation.
 */
#ifndef RITZ_CONSTRAINED_H
#define RITZ_CONSTRAINED_H

#include <ritz/simulate.h>

#pragma GCC visibility push(default)

/* Bodies, and what joins them. */
typedef struct ritz_unjoined {
    int64_t n;          /* coordinates of all bodies */
    int64_t num_rows;   /* constraints, redundant ones too */
    ritz_dense K, M, D; /* n x n, of all bodies; D {0}: none */
    ritz_dense C;       /* num_rows x n, in lengths and radians */
    double *scale;      /* num_rows: where the rank is decided, a row is
                              divided by it. NULL: by the longest row */
    char (*row)[RITZ_NAME_SIZE]; /* names; NULL: rows have none */
    ritz_io io;                  /* n */
    ritz_dense P; /* n x e: q = P y, y the joined coordinates; {0}: unknown */
} ritz_unjoined;

void ritz_unjoined_free(ritz_unjoined *bodies);

enum { RITZ_MOST_GAINS = 3 };

/* A parameter of a stabilisation. */
typedef struct ritz_gain {
    const char *name, *unit;
    const char *summary;
} ritz_gain;

/* What the parameters of a stabilisation are chosen from. */
typedef struct ritz_gain_scales {
    double base;      /* rad/s: 1 / step, and less where an explicit integrator
                         has no room for it beside the highest frequency */
    double step;      /* s */
    double violation; /* |c| and |c'| at the start, c = W q normalised: */
    double rate;      /* W M^-1 W' = I                                  */
    double force;     /* |W M^-1 f| that the start and the inputs may ask for */
} ritz_gain_scales;

struct ritz_stabiliser;

/* A way to hold constraints, as a table row. */
typedef struct ritz_stabilisation {
    const char *name;
    const char *summary;
    const char *accuracy; /* order in the step */
    const char *needs;
    const char *stability; /* for which steps */
    const char *frequency; /* what it does to the highest one */
    const char *fails;
    const char *reference;             /* key in docs/references.bib */
    ritz_gain gain[RITZ_MOST_GAINS];   /* those behind have no name */
    const ritz_integrator *integrator; /* where `modal` is asked for; NULL: it
                                          has an integrator of its own */
    void (*choose)(const ritz_gain_scales *scales, double *gain);
    ritz_status (*terms)(const double *gain, struct ritz_stabiliser *out);
} ritz_stabilisation;

/** All of them, ended by NULL. */
extern const ritz_stabilisation *const ritz_stabilisations[];

extern const ritz_stabilisation ritz_stabilisation_none;
extern const ritz_stabilisation ritz_stabilisation_baumgarte;
extern const ritz_stabilisation ritz_stabilisation_sliding_mode;
extern const ritz_stabilisation ritz_stabilisation_penalty;
extern const ritz_stabilisation ritz_stabilisation_hybrid;
extern const ritz_stabilisation ritz_stabilisation_projection;
extern const ritz_stabilisation ritz_stabilisation_index_2;

/* How constraints are to hold. */
typedef struct ritz_constrained_request {
    const ritz_stabilisation *method;
    double gain[RITZ_MOST_GAINS]; /* NaN: by the method's rule */
    bool any_step; /* also one with which the run is unstable, to see it fail */
} ritz_constrained_request;

/**
 * "METHOD" or "METHOD:NAME=VALUE,...", as "baumgarte:alpha=20,beta=20".
 *
 * @return RITZ_ERR_ARGUMENT naming what is unknown or no number
 */
ritz_status ritz_constrained_parse(const char *text,
                                   ritz_constrained_request *out);

/* What is known of a run beside its motion. */
typedef struct ritz_constrained_facts {
    int64_t num_rows, rank;
    int64_t num_redundant;
    int64_t *redundant; /* rows that follow from those before them */
    double gain[RITZ_MOST_GAINS];
    double joined_hz;  /* highest frequency of the joined bodies */
    double highest_hz; /* the same with what the method adds */
    double step_limit; /* s, of central differences; HUGE_VAL: none */
    double step_cost;  /* s of processor time, measured */
    bool unresolved;   /* springs of a penalty are beyond 2 / step, so that an
                          implicit integrator lets forces ring */
} ritz_constrained_facts;

void ritz_constrained_facts_free(ritz_constrained_facts *facts);

/**
 * Simulate. The start is taken as it is given, whether or not constraints hold
 * there; impulses act on the joined bodies. Diagnostics: "violation" and
 * "violation-rate", the largest |C q| and |C q'| of a row, and "multiplier",
 * the largest |lambda| of those with the least sum of squares.
 *
 * The rank is decided once, by singular values above 1e-9 of the largest of the
 * rows divided by their scales, columns scaled by M.
 *
 * @param[in] request  its integrator advances the methods that are differential
 *                     equations, in place of modal the method's own; x0, v0 are
 *                     of the unjoined coordinates
 * @param[out] facts   may be NULL
 * @return RITZ_ERR_ARGUMENT if the step is beyond the limit of the integrator
 *         with what the method adds (it is named), if a motion of a body has no
 *         mass, or coordinates are wanted; RITZ_ERR_CONVERGENCE if the motion
 *         leaves all bounds
 * @cost   O(n^3) once; a step two products and a solve of order n
 */
ritz_status ritz_simulate_constrained(const ritz_unjoined *bodies,
                                      const ritz_constrained_request *how,
                                      const ritz_simulation_request *request,
                                      ritz_constrained_facts *facts,
                                      ritz_simulation *out);

#pragma GCC visibility pop

#endif
