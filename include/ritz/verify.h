/*
 * Every error measure between a full and a reduced model, one row each.
 * Options, help, verification, fit, records and charts read this table; a new
 * measure is one name in RITZ_EACH_MEASURE, one row of src/verify/measures.c,
 * its function there, and one line in docs/methods/verify.md.
 */
#ifndef RITZ_VERIFY_H
#define RITZ_VERIFY_H

#include <ritz/model.h>
#include <ritz/response.h>

#include <math.h>

#pragma GCC visibility push(default)

/* In the order in which a verified file lists them. */
#define RITZ_EACH_MEASURE(X)                                                   \
    X(FREQUENCY)                                                               \
    X(MAC)                                                                     \
    X(DAMPING)                                                                 \
    X(RIGID_HERTZ)                                                             \
    X(MISSING_RIGID)                                                           \
    X(MISSING)                                                                 \
    X(EXTRA)                                                                   \
    X(INFINITY)                                                                \
    X(INFINITY_RELATIVE)                                                       \
    X(INFINITY_BOUND)                                                          \
    X(H2)                                                                      \
    X(RESPONSE)                                                                \
    X(FLEXIBLE)                                                                \
    X(LEVEL)                                                                   \
    X(GAIN)                                                                    \
    X(SINGULAR)                                                                \
    X(ROUNDING)                                                                \
    X(GROWTH)

typedef enum ritz_measure_id {
#define RITZ_MEASURE_ID(name) RITZ_MEASURE_##name,
    RITZ_EACH_MEASURE(RITZ_MEASURE_ID)
#undef RITZ_MEASURE_ID
        RITZ_MEASURES
} ritz_measure_id;

/* What must be there before a measure can be held to a limit. */
enum {
    RITZ_NEEDS_CHANNELS = 1, /* inputs and outputs */
    RITZ_NEEDS_DAMPING = 2,  /* damping that somebody has stated */
    RITZ_NEEDS_BAND = 4,     /* a band, of state spaces too */
    RITZ_NEEDS_LIMIT = 8,    /* costly for second-order models: measured only
                                where a limit is given */
};

struct ritz_sides;      /* two second-order models that are compared */
struct ritz_state_pair; /* two state spaces that are compared */

/* Set the value of a measure, its place and, where it is not the one of the
   request, the limit; the value stays NaN where there is nothing to compare. */
typedef ritz_status ritz_measure_modes(const struct ritz_sides *sides,
                                       ritz_measure *out);
typedef ritz_status ritz_measure_states(const struct ritz_state_pair *pair,
                                        ritz_measure *out);

typedef struct ritz_measure_kind {
    const char *name;  /* in files, records and JSON */
    const char *word;  /* of --tolerance and --limit-; NULL: takes no limit */
    const char *help;  /* of --limit-; NULL if there is no word */
    const char *label; /* on charts; NULL: not drawn unless asked for */
    int importance;    /* charts draw 1 first; 0 if there is no label */
    const char *unit;  /* "": relative, "modes", "Hz" or "dB" */
    bool large_is_good;
    int needs;         /* sum of RITZ_NEEDS_... */
    const char *bound; /* estimate of ritz-reduce that bounds it; NULL */
    const char *other; /* measure that is held to this limit where this one
                              does not exist; NULL: none */
    ritz_measure_modes *of_modes; /* NULL: does not exist for such models */
    ritz_measure_states *of_states;
} ritz_measure_kind;

/** By ritz_measure_id. */
extern const ritz_measure_kind ritz_measure_table[RITZ_MEASURES];

/** The row called @p name; NULL if there is none. */
const ritz_measure_kind *ritz_measure_kind_find(const char *name);

/** The limit of the measure called @p name; NaN if it has none. */
double ritz_measure_limit(const double limit[RITZ_MEASURES], const char *name);

/** How wrong a value is, 0 being best: 1 - MAC, all others as they are. */
double ritz_measure_error(const char *name, double value);

/**
 * Error over tolerance, 1 or less where the limit is met. Of a limit that
 * allows nothing: 0 where there is no error, else 1 + error. Infinite if @p
 * value is not a number.
 */
double ritz_measure_ratio(const char *name, double value, double limit);

/** Whether a value meets a limit. */
bool ritz_measure_meets(const char *name, double value, double limit);

/** Whether a measure meets its limit; a NaN limit is always met. */
bool ritz_measure_holds(const ritz_measure *measure);

/**
 * Whether a measure without a tolerance must be reported in addition to the
 * worst measure that has one: both are relative errors, and the measure without
 * a tolerance is more than ten times as large.
 */
bool ritz_measure_is_beside(const char *name, double value,
                            const ritz_measure *worst);

/* Full against reduced: every error measure, never one alone. */

/* What is compared, and what it is held to. */
typedef struct ritz_verify_request {
    double band_hz[2];           /* [0, 0]: up to half the highest frequency of
                                    the basis, or of the reduced model */
    ritz_damping damping;        /* of the responses */
    double limit[RITZ_MEASURES]; /* by ritz_measure_id; NaN: only measured.
                                    Missing modes are held to 0 where frequency
                                    or damping has a limit */
} ritz_verify_request;

#define RITZ_NO_LIMIT(name) (double)NAN,
#define RITZ_VERIFY_NONE                                                       \
    {                                                                          \
        .limit = { RITZ_EACH_MEASURE(RITZ_NO_LIMIT) }                          \
    }

/**
 * A full component and its reduction; a full-order assembled system and one
 * reduced configuration; or two state spaces. Dampers count as far as K and D
 * hold them: install them first.
 *
 * MAC of systems, for which there are no shapes, is of the participations of
 * observable modes in inputs and outputs: see docs/methods/verify.md. Outputs
 * of state spaces that have a limit in @p full are divided by it; poles that
 * are not left of the axis are left out of norms if both models have as many.
 *
 * @return RITZ_ERR_ARGUMENT if the reduction is of another model, names differ,
 *         or a measure has a limit that does not exist for these models
 * @cost   of state spaces O(n^3), some fifty times
 */
ritz_status ritz_verify(ritz_model full, ritz_model reduced,
                        const ritz_verify_request *request, ritz_measures *out);

/**
 * Take "frequency=1e-3,mac=0.99,gain=1e-6": names of measures with their
 * tolerances. A number without a name is the tolerance of the flexible response
 * and of frequencies, unless they are named. Tolerances of other measures do
 * not change.
 *
 * @return RITZ_ERR_ARGUMENT for a word that names no measure of second-order
 *         models (the sentence names the nearest), a word that is given twice,
 *         a number without a name where both are named, or an invalid tolerance
 */
ritz_status ritz_tolerance_take(const char *text, ritz_verify_request *limits);

/** Its text form: "response=0.01". Cut to fit. */
void ritz_tolerance_print(const ritz_verify_request *limits, int64_t size,
                          char *out);

/** Word of a measure: "response" of "response-relative"; its own name if it has
 * none. */
const char *ritz_tolerance_word(const char *measure);

/**
 * Flexible static gain C Phi_f Lambda_f^-1 Phi_f' B of a dense model.
 *
 * @param[in] num_rigid  rigid modes of the full model, 0: not known. As many at
 *                       least of the lowest modes are left out: a reduction
 *                       that represents a rigid motion badly has it at some
 *                       frequency, which is no compliance
 */
ritz_status ritz_static_gain(const ritz_dense *K, const ritz_dense *M,
                             const ritz_io *io, int64_t num_rigid,
                             ritz_dense *out);

/**
 * |G - G_r| / |G| of two static gains of one size, largest singular values; NaN
 * where G is rounding compared with the difference.
 */
ritz_status ritz_gain_error(const ritz_dense *full, const ritz_dense *reduced,
                            double *out);

/*
 * A full model prepared once for comparison with many reductions of it: its
 * modes to three times the band, the static response of the modes above, and
 * its responses at every frequency of comparison.
 */

typedef struct ritz_reference ritz_reference;

typedef struct ritz_reference_request {
    double band_hz[2];    /* not [0, 0]. If the band starts at 0, responses
                             start at the frequency above which rounding of a
                             free body's stiffness is negligible */
    ritz_damping damping; /* none: as the model says, or else modal 0.01 */
    double tolerance;     /* largest relative effect of that rounding on
                             flexible responses; 0, or above 1e-3: 1e-3 */
    int64_t num_random;   /* further frequencies, anywhere in the band */
    uint64_t seed;        /* of those; one seed always gives the same */
} ritz_reference_request;

/* Where responses are compared in addition to an even grid and the poles of the
   full model, and what is measured. */
enum {
    RITZ_AT_OTHER_POLES = 1, /* those of the reduced model */
    RITZ_AT_RANDOM = 2,      /* the random frequencies */
    RITZ_ONLY_LIMITED = 4,   /* leave out responses and static gain if no
                                measure that has a limit needs them */
};

/**
 * @param[in] full     borrowed until free; dampers count as far as K and D hold
 *                     them
 * @param[in] request  copied
 * @return RITZ_ERR_ARGUMENT if the band is invalid
 * @cost   the modes up to three times the band; with damping ratios all modes
 *         of up to 2000 dofs, and some factorisations of larger models; where
 *         dampers couple modes of a model that is not small, a projection of
 *         its responses or, where rounding of K dominates them at the start of
 *         the band, a factorisation for each frequency
 */
ritz_status ritz_reference_new(const ritz_component *full,
                               const ritz_reference_request *request,
                               ritz_reference **out);

/**
 * What ritz_verify measures.
 *
 * @param[in] reduced  a reduced component or a configuration
 * @param[in] limits   its limits alone are used
 * @param[in] where    sum of RITZ_AT_... and RITZ_ONLY_LIMITED
 */
ritz_status ritz_reference_measure(const ritz_reference *reference,
                                   ritz_model reduced,
                                   const ritz_verify_request *limits, int where,
                                   ritz_measures *out);

/** The modes of the full model that it holds; borrowed. */
const ritz_pairs *ritz_reference_pairs(const ritz_reference *reference);

/**
 * Phi'M T with the modes Phi of the full model: how much of each mode the
 * columns of T contain. A reduction by T S has Phi'M T S, so that its shapes
 * can be compared without T.
 *
 * @param[in]  T    n x r
 * @param[out] out  modes x r
 * @cost   O(n modes r)
 */
ritz_status ritz_reference_parts(const ritz_reference *reference,
                                 const ritz_dense *T, ritz_dense *out);

/* What is known of a reduced model besides its matrices, and what a comparison
   finds of it on the way. */
typedef struct ritz_compared {
    const ritz_dense *parts; /* borrowed, by ritz_reference_parts, with as many
                                columns as T; NULL: shapes are compared by T */
    bool keeps_modes;        /* `modes` are wanted */
    ritz_pairs modes;        /* out: all modes, without residuals */
    bool passive; /* out: M, K and the damping are such that nothing can grow;
                     false: not known, because the model has a matrix D */
} ritz_compared;

/**
 * As ritz_reference_measure, for a reduced component whose T may be missing.
 *
 * @param[in,out] compared  NULL: as ritz_reference_measure
 * @cost   does not grow with the size of the full model, unless each of its
 *         responses takes a factor: see ritz_reference_new
 */
ritz_status ritz_reference_measure_parts(const ritz_reference *reference,
                                         ritz_model reduced,
                                         ritz_compared *compared,
                                         const ritz_verify_request *limits,
                                         int where, ritz_measures *out);

/**
 * Number of flexible modes of the full model in the band, and of rigid ones.
 */
int64_t ritz_reference_modes(const ritz_reference *reference, int64_t *rigid);

/**
 * Whether responses of the full model need more than its modes: dampers couple
 * modes, and not all of them are known.
 */
bool ritz_reference_factors(const ritz_reference *reference);

void ritz_reference_free(ritz_reference **reference);

/** The next number of a sequence, in [0, 1) [Steele2014]. */
double ritz_random_next(uint64_t *state);

/*
 * Bounds of the errors of a reduced component for which no mode of the full one
 * is computed: the full model is factored and its modes are counted.
 *
 *     mode-7, mode-8, ...         |f_r - f| / f of each reduced mode in the
 *                                 band; f is the frequency of the full mode
 *                                 with the same number, or with the number that
 *                                 the place states
 *     frequency-relative-bound    upper bound of ritz-verify's measure
 *                                 frequency-relative; none without modes
 *     frequency-relative-least    lower bound of it; none if it may be 0
 *     missing-modes-bound         upper bound of its missing-modes: full modes
 *                                 in the band without a reduced mode that is
 *                                 proven to contain half of them
 *     response-relative-bound     max |H - H_r| / max |H| in the band, between
 *                                 points too, for ratios common to all modes
 *                                 and for D = a M + b K; the worst channel,
 *                                 each relative to its own max |H|
 *     response-relative-estimate  the same without proof, for other damping
 *
 * HUGE_VAL: nothing is known. Rounding is part of each bound.
 */

typedef struct ritz_estimate_request {
    double band_hz[2];    /* [0, 0]: up to half the highest frequency of the
                             basis */
    ritz_damping damping; /* of responses; none: no response is bounded */
    bool frequencies;     /* estimate frequencies only, no response */
    /* modes of the full model, none of which is missing below `proven_to`:
       where they show how many modes lie below a value, none are counted by a
       factor; borrowed, NULL: not known */
    const ritz_pairs *modes;
} ritz_estimate_request;

/* The factors of one full component, made once for many reductions of it. */
typedef struct ritz_estimator ritz_estimator;

/**
 * @param[in]  full     borrowed until free; its dampers count as far as K and D
 *                      hold them, and no response is bounded if D holds none
 * @param[in]  request  copied
 * @return RITZ_ERR_ARGUMENT if the band is none
 */
ritz_status ritz_estimator_new(const ritz_component *full,
                               const ritz_estimate_request *request,
                               ritz_estimator **out);

/**
 * Estimates of one reduction of that component. The factor is made for the
 * first one, by its band; counts stay, and serve the next.
 *
 * @param[in]  basis  by which it was reduced; its T is used, and its hertz
 * @param[in]  least  frequency-relative-least alone, as far as an inverse
 *                    iteration of the reduced modes shows it: no mode is
 *                    counted, so it is not known whether partners are there.
 *                    The worst error is so large at least, or some mode is
 *                    missing
 * @param[out] out    empty on entry
 * @return RITZ_ERR_ARGUMENT if the basis is not that of the reduction;
 *         RITZ_ERR_SINGULAR if K - s M is definite for no s < 0
 * @cost   a factor once, an LDL' for each count, and a solve for each mode or,
 *         with responses, each vector; twice where that does not suffice
 * @see    [Lehmann1963], [BeattieGoerisch1995]
 */
ritz_status ritz_estimator_measure(ritz_estimator *estimator,
                                   const ritz_basis *basis,
                                   const ritz_reduced *reduced, bool least,
                                   ritz_measures *out);

void ritz_estimator_free(ritz_estimator **estimator);

/** The three above, into @p reduced's estimates. */
ritz_status ritz_estimate(const ritz_component *full, const ritz_basis *basis,
                          const ritz_estimate_request *request,
                          ritz_reduced *reduced);

#pragma GCC visibility pop

#endif
