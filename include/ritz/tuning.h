/*
 * Design of passive dampers by the H2 norm: how large the response to random
 * disturbances is, which damping constants and stiffnesses minimise that
 * response, and at which places dampers work best.
 *
 * In D += sum c_j b_j b_j' and K += sum k_j b_j b_j' the constants c_j and k_j
 * of chosen dampers vary [ChuMilman1992].
 */
#ifndef RITZ_TUNING_H
#define RITZ_TUNING_H

#include <ritz/model.h>

#include <stdbool.h>

#pragma GCC visibility push(default)

/* Highest order of a disturbance's filter. */
enum { RITZ_LOW_PASS_MOST = 20 };

/*
 * The disturbance of each input: white noise of unit intensity, or such noise
 * through a Butterworth low-pass filter with gain 1 at 0 Hz.
 */
typedef struct ritz_disturbance {
    double low_pass_hz; /* frequency at which the gain is 1/sqrt(2); 0: white
                           noise */
    int64_t order;      /* of the filter, 1 .. RITZ_LOW_PASS_MOST; ignored for
                           white noise */
} ritz_disturbance;

typedef struct ritz_h2 {
    double value;
    double change; /* relative change of the norm when the number of modes was
                      last doubled; 0: the norm is that of the whole model */
    char engine[RITZ_NAME_SIZE];
} ritz_h2;

/**
 * H2 norm of a model of any kind from that disturbance to its outputs, each
 * divided by its limit if it has one: the square root of the sum of their
 * variances,
 *
 *     sqrt(trace(C W_c C')),    A W_c + W_c A' + B B' = 0
 *
 * Dampers count as far as they are installed. Poles that are not left of the
 * imaginary axis are left out if they are not controllable or not observable.
 *
 * Components of more than 300 dofs are projected on their lowest modes and the
 * static responses to inputs and dampers; the number of modes is doubled until
 * the norm changes by less than 1e-6.
 *
 * @return RITZ_ERR_ARGUMENT if the norm is infinite, there are no inputs or no
 *         outputs, there is structural damping, or the disturbance is invalid;
 *         RITZ_ERR_CONVERGENCE if the norm of a large component does not settle
 * @cost   some 40 s^3 with s states: twice the coordinates, and the filters'
 *         states
 * @see    [ChuMilman1992, eq. 8-10]
 */
ritz_status ritz_h2_of(ritz_model model, const ritz_disturbance *noise,
                       ritz_h2 *out);

/* Dampers with a common c and a common k, each within [0] .. [1]. */
typedef struct ritz_tuned {
    int64_t count;
    const int64_t *damper; /* indices, borrowed */
    double c[2], k[2];     /* ranges; equal ends fix the value; NaN: each damper
                              keeps its own */
} ritz_tuned;

typedef struct ritz_tuning_request {
    ritz_model model; /* no state space; its dampers may be installed or not */
    ritz_disturbance noise;
    int64_t count; /* of `tuned`; a damper may be in one of them only */
    const ritz_tuned *tuned;
    int64_t modes; /* modes of the first space in which a component is tuned; 0:
                      20 */
    int64_t most;  /* largest number of evaluations of each search; 0: 300 */
    int64_t most_full; /* a component of up to this many dofs is tuned without
                      projection; 0: 50 */
} ritz_tuning_request;

typedef struct ritz_tuning {
    int64_t count; /* number of groups, as requested */
    double *c, *k; /* values of each group; NaN: each damper has its own */
    double before; /* norm with the model's present dampers, of the model that
                      was tuned; HUGE_VAL: infinite */
    double norm;   /* norm of the full model with these c and k */
    double change; /* of the full model's norm, as in ritz_h2 */
    double tuned;  /* norm of the projected model that was tuned */
    double slope;  /* largest |d norm / dx| / norm, with x from 0 to 1 over a
                      range; slopes that lead out of a range do not count */
    int64_t modes; /* modes in the space of the tuned model; 0: it was the whole
                      model */
    int64_t evaluations;
    int64_t starts, agreed; /* searches, and how many of them ended at this
                               norm */
} ritz_tuning;

/**
 * The c and k that minimise the H2 norm, by sequential quadratic programming
 * (NLopt's SLSQP) from several starts, with the gradient
 *
 *     d |G|^2 = 2 tr(W_o dA W_c) + 2 tr(dC W_c C')
 *
 * from both Gramians. The dampers' present values affect only `before`. A large
 * component is tuned in a space of modes and static responses, and the norm of
 * the full model is then computed; if the two norms differ by more than 1e-4,
 * the number of modes is doubled and the component is tuned again.
 *
 * The result is the lowest of the local minima that were found.
 *
 * @return as ritz_h2_of, and RITZ_ERR_ARGUMENT if a range is invalid, nothing
 *         varies, or a damper acts on dofs without mass
 * @see    [Kraft1994], [ChuMilman1992, eq. 11-15]
 */
ritz_status ritz_tuning_of(const ritz_tuning_request *request,
                           ritz_tuning *out);

/* The search for the best places of a given number of dampers. */
typedef struct ritz_placing_request {
    ritz_tuning_request tuning; /* each group is a candidate for a place */
    int64_t places;             /* number of groups to choose, 1 .. count */
    int64_t among;              /* combinations are formed of this many
                                   candidates, the best by themselves; 0: places
                                   + 5, or all */
} ritz_placing_request;

typedef struct ritz_placing {
    int64_t count;       /* candidates */
    double *alone;       /* norm with each candidate by itself; HUGE_VAL:
                            infinite */
    double *c, *k;       /* tuned values of each candidate by itself */
    int64_t num_among;   /* candidates of which combinations were formed */
    int64_t num_choices; /* combinations that were tuned */
    double none;         /* norm without any candidate; HUGE_VAL: infinite */
    int64_t places;
    int64_t *taken;     /* places, the chosen candidates, ascending */
    int64_t num_next;   /* number of next best combinations, at most 5 */
    int64_t *next;      /* places x num_next, their candidates */
    double *next_norm;  /* num_next, their norms on the tuned model */
    ritz_tuning tuning; /* of the chosen combination */
} ritz_placing;

/**
 * Where dampers reduce the norm most. Each candidate is tuned by itself,
 * without the others. All combinations of the best candidates are then tuned,
 * starting both from their values alone and from the values that one search
 * finds for the dampers together [ChuMilman1992, section 4].
 *
 * A candidate that is not chosen has c = 0 and k = 0.
 *
 * @return as ritz_tuning_of, and RITZ_ERR_ARGUMENT if there are fewer
 *         candidates than places, or more than 100 000 combinations
 */
ritz_status ritz_placing_of(const ritz_placing_request *request,
                            ritz_placing *out);

void ritz_tuning_free(ritz_tuning *tuning);
void ritz_placing_free(ritz_placing *placing);

#pragma GCC visibility pop

#endif
