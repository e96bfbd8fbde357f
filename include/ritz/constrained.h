/*
 * Bodies whose joints are held during a simulation: the constraints C q = 0 are
 * enforced by forces or by projections, and not eliminated beforehand.
 *
 *     M q'' + D q' + K q = B u - C'lambda,    C q = 0
 *
 * A stabilisation is a method that enforces them. The system in which they are
 * eliminated (ritz_stage_assemble) is the reference for all methods: its motion
 * satisfies the constraints exactly.
 */
#ifndef RITZ_CONSTRAINED_H
#define RITZ_CONSTRAINED_H

#include <ritz/simulate.h>

#pragma GCC visibility push(default)

/* Bodies before they are joined, and the constraints that join them. */
typedef struct ritz_unjoined {
    int64_t n;          /* coordinates of all bodies */
    int64_t num_rows;   /* constraints, redundant ones too */
    ritz_dense K, M, D; /* n x n, of all bodies; D {0}: none */
    ritz_dense C;       /* num_rows x n, in lengths and radians */
    double *scale;      /* num_rows: each row is divided by its scale before
                              the rank is determined. NULL: all rows by the
                              length of the longest one */
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

/* Quantities from which a method chooses parameters that are not given. */
typedef struct ritz_gain_scales {
    double base;      /* rad/s: 1 / step, and less where that, added to the
                         highest frequency of the bodies, would make an
                         explicit integrator unstable; NaN where little is
                         left */
    double step;      /* s */
    double violation; /* |c| and |c'| at the start, where c = W q with */
    double rate;      /* W M^-1 W' = I                                 */
    double force;     /* largest |W M^-1 f| of the initial state and of the
                         amplitudes of the inputs */
} ritz_gain_scales;

struct ritz_stabiliser;

/* A way to hold constraints, as a table row. */
typedef struct ritz_stabilisation {
    const char *name;
    const char *summary;
    const char *accuracy; /* order in the step */
    const char *needs;
    const char *stability; /* for which steps */
    const char *frequency; /* effect on the highest one */
    const char *fails;
    const char *reference;             /* key in docs/references.bib */
    ritz_gain gain[RITZ_MOST_GAINS];   /* unused ones have no name */
    const ritz_integrator *integrator; /* used where `modal` is requested;
                                          NULL: the method is an integrator */
    /** Set the parameters that are NaN. Their defaults may depend on the given
     * ones. */
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

/* A method to enforce constraints, with its parameters. */
typedef struct ritz_constrained_request {
    const ritz_stabilisation *method;
    double gain[RITZ_MOST_GAINS]; /* NaN: the method chooses it */
    bool any_step; /* accept a step at which the run is unstable */
} ritz_constrained_request;

/**
 * "METHOD" or "METHOD:NAME=VALUE,...", as "baumgarte:alpha=20,beta=20".
 *
 * @return RITZ_ERR_ARGUMENT if a name is unknown or a value is not a number
 */
ritz_status ritz_constrained_parse(const char *text,
                                   ritz_constrained_request *out);

/* Properties of a run, in addition to its motion. */
typedef struct ritz_constrained_facts {
    int64_t num_rows, rank;
    int64_t num_redundant;
    int64_t *redundant; /* rows that depend on those before them */
    double gain[RITZ_MOST_GAINS];
    double joined_hz;      /* highest frequency of the joined bodies */
    double highest_hz;     /* the same with the terms of the method */
    double step_limit;     /* s, of central differences; HUGE_VAL: no limit */
    double step_cost;      /* processor time of a step, s, as measured */
    double force_rounding; /* eps (w h)^2 / 4 of penalty springs: relative
                              rounding error of the joint forces after a load
                              jumps; 0 without springs */
    double moved;      /* projection and index-2: relative change of the initial
                          displacements in the norm of M, which satisfies the
                          constraints */
    double moved_rate; /* the same of velocities */
    bool unresolved;   /* the frequency of penalty springs is above 2 / step, so
                          that with an implicit integrator forces oscillate from
                          step to step */
} ritz_constrained_facts;

void ritz_constrained_facts_free(ritz_constrained_facts *facts);

/**
 * Simulate bodies while a method enforces their constraints. Initial values are
 * used as they are given, whether or not they satisfy the constraints; only
 * projection and index-2 begin with the nearest values that do, in the norm of
 * M. Impulses act on the joined bodies. Diagnostics: "violation" and "violation-rate", the
 * largest |C q| and |C q'| of a row, and "multiplier", the largest |lambda| of
 * the solution with the least sum of squares.
 *
 * The rank of the constraints is determined once. It is the number of singular
 * values above 1e-9 of the largest, of the rows divided by their scales, with
 * columns scaled by M.
 *
 * @param[in] request  its integrator advances methods that add terms to the
 *                     equations of motion; if it is modal, the integrator of
 *                     the method does. x0 and v0 are in the coordinates of all
 *                     bodies, and so are coordinates that are stored
 * @param[out] facts   may be NULL
 * @return RITZ_ERR_ARGUMENT if the step is above the stability limit of the
 *         integrator, for the bodies and the terms of the method (the sentence
 *         has the limit), if the forces of penalty springs would be rounding,
 *         or if a motion of a body has no mass; RITZ_ERR_CONVERGENCE if the
 *         motion grows without bound
 * @cost   O(n^3) once; two products and a solve of order n for each step
 */
ritz_status ritz_simulate_constrained(const ritz_unjoined *bodies,
                                      const ritz_constrained_request *how,
                                      const ritz_simulation_request *request,
                                      ritz_constrained_facts *facts,
                                      ritz_simulation *out);

#pragma GCC visibility pop

#endif
