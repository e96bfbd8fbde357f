/*
 * Design of passive dampers by the H2 norm: how large the response to noise is,
 * which rates and stiffnesses make it least, and in which places.
 *
 * In D += sum c_j b_j b_j' and K += sum k_j b_j b_j' the c_j and k_j of some
 * dampers vary [ChuMilman1992].
 */
#ifndef RITZ_TUNING_H
#define RITZ_TUNING_H

#include <ritz/model.h>

#include <stdbool.h>

#pragma GCC visibility push(default)

/* The most that a filter can be of. */
enum { RITZ_LOW_PASS_MOST = 20 };

/*
 * What drives each input: white noise of unit intensity, or that noise through
 * a Butterworth low-pass of gain 1 at 0 Hz.
 */
typedef struct ritz_disturbance {
    double low_pass_hz; /* where its gain is 1/sqrt(2); 0: white noise */
    int64_t order;      /* 1 .. RITZ_LOW_PASS_MOST; not read of white noise */
} ritz_disturbance;

typedef struct ritz_h2 {
    double value;
    double change; /* relative, when the modes it was found with were doubled;
                      0: all of the model was taken */
    char engine[RITZ_NAME_SIZE];
} ritz_h2;

/**
 * H2 norm of a model of any kind from that noise to its outputs, each over its
 * limit where it has one: the root of the sum of their variances,
 *
 *     sqrt(trace(C W_c C')),    A W_c + W_c A' + B B' = 0
 *
 * Dampers count as far as they are installed. Poles that are not left of the
 * imaginary axis are left out where no input drives, or no output observes
 * them.
 *
 * Components of more than 300 dofs are taken in the space of their lowest
 * modes and static responses to inputs and dampers, of which the modes are
 * doubled until the norm changes by less than 1e-6.
 *
 * @return RITZ_ERR_ARGUMENT if the norm is infinite, there are neither inputs
 *         nor outputs, there is structural damping, or the noise is none;
 *         RITZ_ERR_CONVERGENCE if the norm of a large component does not settle
 * @cost   some 40 s^3, s states: twice the coordinates, and the filters'
 * @see    [ChuMilman1992, eq. 8-10]
 */
ritz_status ritz_h2_of(ritz_model model, const ritz_disturbance *noise,
                       ritz_h2 *out);

/* Dampers that have one c and one k, each from [0] to [1]. */
typedef struct ritz_tuned {
    int64_t count;
    const int64_t *damper; /* indices, borrowed */
    double c[2], k[2];     /* where both ends are equal there is no choice */
} ritz_tuned;

typedef struct ritz_tuning_request {
    ritz_model model; /* no state space; its dampers installed or not */
    ritz_disturbance noise;
    int64_t count; /* of `tuned`, no damper in two */
    const ritz_tuned *tuned;
    int64_t modes; /* that a component is tuned with at first; 0: 20 */
    int64_t most;  /* evaluations of each search; 0: 300 */
    int64_t
        most_full; /* dofs up to which a component is tuned as it is; 0: 50 */
} ritz_tuning_request;

typedef struct ritz_tuning {
    int64_t count; /* of groups, as requested */
    double *c, *k; /* of each */
    double before; /* norm with what the model's dampers are; HUGE_VAL where it
                      is infinite */
    double norm;   /* with these c and k, of the full model */
    double change; /* as of ritz_h2, of the full model */
    double tuned;  /* norm on the model that was tuned */
    double slope;  /* largest d norm / d x, x from 0 to 1 over a range, over the
                      norm; what leads out of a range is not counted */
    int64_t modes; /* of the space that was tuned; 0: all of the model */
    int64_t evaluations;
    int64_t starts, agreed; /* searches, and how many ended at this norm */
} ritz_tuning;

/**
 * The c and k for which the H2 norm is least, by sequential quadratic
 * programming (NLopt's SLSQP) from several starts, with the gradient
 *
 *     d |G|^2 = 2 tr(W_o dA W_c) + 2 tr(dC W_c C')
 *
 * of both Gramians. Of each damper what the model has at present does not
 * matter, except to `before`. A large component is tuned in a space of modes
 * and static responses, then measured in full; where the two differ by more
 * than 1e-4 the modes are doubled and it is tuned again.
 *
 * It is a local minimum, the least that was found.
 *
 * @return as ritz_h2_of, and RITZ_ERR_ARGUMENT if a range is none, nothing
 *         varies, or a damper moves dofs without mass
 * @see    [Kraft1994], [ChuMilman1992, eq. 11-15]
 */
ritz_status ritz_tuning_of(const ritz_tuning_request *request,
                           ritz_tuning *out);

/* One choice of places and its norm. */
typedef struct ritz_placing_request {
    ritz_tuning_request tuning; /* a group is a candidate for a place */
    int64_t places;             /* how many groups are taken, 1 .. count */
    int64_t among;              /* of the best so many; 0: places + 5, or all */
} ritz_placing_request;

typedef struct ritz_placing {
    int64_t count;       /* candidates */
    double *alone;       /* norm of each by itself; HUGE_VAL: infinite */
    double *c, *k;       /* of each by itself */
    int64_t num_among;   /* candidates that were combined */
    int64_t num_choices; /* combinations that were tuned */
    double none;         /* norm without any of them; HUGE_VAL: infinite */
    int64_t places;
    int64_t *taken;     /* places, ascending */
    int64_t num_next;   /* the best that were not taken, 5 at most */
    int64_t *next;      /* places x num_next */
    double *next_norm;  /* num_next, on the model that was tuned */
    ritz_tuning tuning; /* of those that were taken */
} ritz_placing;

/**
 * In which places dampers do most: each candidate is tuned alone, without the
 * others; of the best all combinations are tuned, each from what its dampers
 * were alone and from what they are together [ChuMilman1992, section 4].
 *
 * A place that is not taken has c = 0 and k = 0.
 *
 * @return as ritz_tuning_of, and RITZ_ERR_ARGUMENT if there are fewer of them
 *         than places, or more than 100 000 combinations
 */
ritz_status ritz_placing_of(const ritz_placing_request *request,
                            ritz_placing *out);

void ritz_tuning_free(ritz_tuning *tuning);
void ritz_placing_free(ritz_placing *placing);

#pragma GCC visibility pop

#endif
