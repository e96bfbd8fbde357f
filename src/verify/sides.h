/* The two models that are compared, and the measures between them. */
#ifndef RITZ_VERIFY_SIDES_H
#define RITZ_VERIFY_SIDES_H

#include "poles/poles.h"

#include <ritz/poles.h>
#include <ritz/verify.h>

/** @return RITZ_ERR_ARGUMENT unless inputs and outputs have the same names */
ritz_status ritz_verify_signals(ritz_model full, ritz_model reduced);

/** @return RITZ_ERR_ARGUMENT unless 0 <= low < high, or high is 0 if it may */
ritz_status ritz_verify_band(const double band_hz[2], bool may_be_zero);

/** Whether a mode is in a band, whose ends belong to it but for rounding. */
bool ritz_in_band(const double band_hz[2], double lambda);

/*
 * Two models without common coordinates are compared by how much each mode
 * takes part in their inputs and outputs, instead of by mode shapes. Mode k has
 * the participations scale[c] phi'b_c, of outputs scale[c] c_c phi; c counts
 * inputs, then rows of C, of Cv and of Ca.
 */
typedef struct ritz_participation {
    double *scale;    /* one over the largest of the flexible modes in the band,
                         0 where that is rounding */
    bool *observable; /* of each mode, in any transfer function */
} ritz_participation;

typedef struct ritz_match {
    /* of each mode of the full model */
    int64_t *partner; /* mode of the reduced one; -1: it has none */
    double *mac;      /* of the cluster it is in; NaN: not known */
    bool *taken;      /* of each mode of the reduced one: it is paired */
} ritz_match;

/* The full model's responses at some frequencies. */
typedef struct ritz_reference_sweep {
    int64_t count, values; /* points; responses at each */
    double *hertz;
    double _Complex *full, *reduced; /* reduced: NULL unless it is compared */
    double flexible;                 /* largest |H| without rigid motion */
    bool significant;                /* any |H| is more than rounding */
} ritz_reference_sweep;

/* What of the full model serves every comparison. */
struct ritz_reference {
    const ritz_component *component; /* borrowed */
    double band_hz[2];
    double modes_hz; /* its modes are known up to here */
    ritz_damping damping;
    bool assumed;         /* the damping was assumed, because neither model
                             states any */
    ritz_rounded rounded; /* effect of rounding of K on its responses */
    double rules_hz;      /* frequency up to which that rounding dominates; 0:
                             none  [Hz] */
    ritz_pairs pairs;     /* modes up to three times the band */
    ritz_poles poles;
    ritz_residual residual;
    ritz_damped damped;
    ritz_participation part;
    ritz_dense gain;
    ritz_responder *responder; /* of the component, where modes and the static
                                  response of the rest do not give responses;
                                  NULL: they do, or there are none */
    ritz_reference_sweep own, random;
};

/* The largest of some values, and where it was found. */
typedef struct ritz_extreme {
    double value, hertz;
} ritz_extreme;

/* How much the responses of two models differ, over all points. */
typedef struct ritz_gap {
    bool significant;   /* any |H| of the full model is more than rounding */
    double largest;     /* |H| of the full model */
    double flexible;    /* the same without rigid motion */
    ritz_extreme error; /* |H - H_r| */
    ritz_extreme db;    /* of levels, where |H| is not negligible */
    double singular;    /* largest of the smallest non-zero singular value */
    ritz_extreme singular_error;
} ritz_gap;

typedef struct ritz_sides {
    const ritz_reference *full;
    const double *limit;     /* RITZ_MEASURES of them, by ritz_measure_id */
    ritz_second_order model; /* the reduced one */
    const ritz_reduced *component; /* it too; NULL: a system */
    ritz_gap gap;
    int where;               /* sum of RITZ_AT_... and RITZ_ONLY_LIMITED */
    const ritz_dense *parts; /* borrowed, Phi'M T; NULL: compute it from T */
    bool shapes;             /* MAC compares shapes; otherwise, of a system,
                                participations of observable modes */
    ritz_pairs small;        /* of the reduced model, all */
    ritz_poles reduced;
    ritz_dense gain_reduced;
    ritz_damped damped_reduced;
    ritz_match match;
} ritz_sides;

/**
 * Fill `part`: scales that make units of inputs and outputs irrelevant, and
 * which modes are observable. Mode k is not observable from input j to output i
 * if the product p of its participations in both is rounding, or if for some
 * mode m of the band
 *
 *     p_k max(1, (w_m / w_k)^2) max(1, zeta_m / zeta_k) <= 1e-6 p_m,
 *
 * so that its parts in the static response, in accelerations and at resonance
 * are at most a millionth of those of the other mode. Without inputs, or
 * without outputs, the participations in the others decide alone.
 */
ritz_status ritz_reference_observe(ritz_reference *reference);

/**
 * Fill `match`: which mode of the full model is which of the reduced one. By
 * shapes it is the one that holds half of it at least; without them, by
 * frequency and participations, what the alignment of the two ascending lists
 * that costs least says, and then exchanges of modes whose order differs
 * between them.
 */
ritz_status ritz_sides_match(ritz_sides *sides);

/** Make `responder` if it is needed: one for all sweeps of the band. */
ritz_status ritz_reference_prepare(ritz_reference *reference);

/** The full model at the points of a sweep, which has its hertz. */
ritz_status ritz_reference_respond(const ritz_reference *reference,
                                   ritz_reference_sweep *sweep);

/**
 * The points of the band refined at some poles, @p even evenly spaced among
 * them.
 */
ritz_status ritz_sweep_points(const ritz_reference *reference,
                              const ritz_poles *poles,
                              const ritz_damped *damped, int64_t even,
                              ritz_reference_sweep *out);

/** Number of rigid motions of the full model, with hidden ones. */
int64_t ritz_reference_rigid(const ritz_reference *reference);

/**
 * Frequency at which responses over the band start. If the band starts at 0, it
 * is above 0 if there is rigid motion, and above the frequency up to which
 * rounding of the stiffness dominates, unless the band ends below that.
 */
double ritz_reference_start(const ritz_reference *reference);

/**
 * The highest frequency of the modes that a basis was made with, or else of its
 * own modes. @param[in] columns  may be NULL
 */
double ritz_highest_hertz(const ritz_columns *columns, int64_t count,
                          const double *lambda);

/**
 * Take one response of both models into a gap.
 *
 * @return RITZ_ERR_CONVERGENCE unless it is finite
 */
ritz_status ritz_gap_add(double _Complex H, double _Complex H_r, double hertz,
                         ritz_gap *gap);

/** Fill `gap`: responses of both models, at all points that were asked for. */
ritz_status ritz_sides_respond(ritz_sides *sides);

/* Functions of the table of measures. */
ritz_measure_modes ritz_modes_frequency, ritz_modes_mac, ritz_modes_damping,
    ritz_modes_rigid_hertz, ritz_modes_missing_rigid, ritz_modes_missing,
    ritz_modes_extra, ritz_modes_h2, ritz_responses_error,
    ritz_responses_flexible, ritz_responses_level, ritz_responses_gain,
    ritz_responses_singular, ritz_responses_rounding;

void ritz_sweep_free(ritz_reference_sweep *sweep);

/* Two state spaces that are compared. */

/* Outputs are divided by their limits; 0 is the full model, 1 the reduced. */
typedef struct ritz_state_pair {
    const ritz_verify_request *request;
    const ritz_state_space *given[2]; /* the models as given, borrowed; or
                                         `dense` */
    ritz_state_space dense[2];        /* dense copies of sparse models */
    ritz_state_space model[2];        /* models with outputs divided by limits;
                                         own only C and D */
    ritz_state_space stable[2]; /* the parts whose poles are left of the axis */
    int64_t num_unstable[2];    /* number of poles that are not left of the
                                   axis */
    bool large;     /* a model is sparse with too many states for dense
                       matrices */
    bool has_norms; /* num_unstable of both are equal, and one at most is
                       large */
    ritz_state_space difference; /* of the stable parts, the full model's states
                                    last; if has_norms */
    bool has_gain;               /* neither has a pole at 0 */
    ritz_dense gain[2];          /* static */
    ritz_norm full,
        error; /* H-infinity, of the full model and the difference */
} ritz_state_pair;

/**
 * @param[in] full,reduced,request  borrowed until free
 * @return RITZ_ERR_ARGUMENT if inputs or outputs differ, or if norms that have
 *         a limit do not exist
 */
ritz_status ritz_state_pair_new(const ritz_state_space *full,
                                const ritz_state_space *reduced,
                                const ritz_verify_request *request,
                                ritz_state_pair *out);
void ritz_state_pair_free(ritz_state_pair *p);

ritz_measure_states ritz_states_infinity, ritz_states_infinity_relative,
    ritz_states_infinity_bound, ritz_states_h2, ritz_states_response,
    ritz_states_gain, ritz_states_growth;

#endif
