/* Dense second-order models with variable dampers: their H2 norm and its
   derivatives. */
#ifndef RITZ_POLES_H2_H
#define RITZ_POLES_H2_H

#include "model/modal.h"

#include <ritz/tuning.h>

typedef struct ritz_plant {
    ritz_structure base;  /* dense K, M and D of n coordinates, with what they
                             hold of the dampers */
    ritz_io io;           /* in these coordinates */
    ritz_damping damping; /* in addition to D */
    ritz_dampers dampers; /* the model's response depends on their c and k */
    ritz_disturbance noise;
} ritz_plant;

typedef struct ritz_variance {
    bool finite;
    double square;    /* square of the norm; HUGE_VAL if it is infinite */
    double *by_c;     /* d square / dc for each damper; NULL: not wanted */
    double *by_k;     /* d square / dk for each damper; set if by_c is */
    int64_t unstable; /* number of poles that make the norm infinite */
    int64_t states;
} ritz_variance;

/** A plant of a dense model, or of a component with dense matrices; data are
 * copied. */
ritz_status ritz_plant_new(ritz_model model, const ritz_disturbance *noise,
                           ritz_plant *out);

/**
 * Sum of the variances of all outputs for the present c and k of the dampers,
 * and its derivatives.
 *
 * @param[in,out] out  by_c and by_k belong to the caller and have room for each
 *                     damper
 * @return RITZ_ERR_ARGUMENT as ritz_h2_of, or if derivatives are wanted and a
 *         damper acts on dofs without mass; an infinite norm is not refused
 */
ritz_status ritz_variance_of(const ritz_plant *plant, ritz_variance *out);

/** The norm for the present c and k; HUGE_VAL: infinite. */
ritz_status ritz_plant_norm(const ritz_plant *plant, double *out);

/** ritz_variance_of for a state space, without derivatives. */
ritz_status ritz_variance_of_states(const ritz_state_space *model,
                                    const ritz_disturbance *noise,
                                    ritz_variance *out);

/** Refuse an infinite norm: RITZ_ERR_ARGUMENT. */
ritz_status ritz_refuse_infinite(const ritz_variance *variance);

void ritz_plant_free(ritz_plant *plant);

/**
 * ritz_h2_of with other values of the dampers.
 *
 * @param[in] c,k  values for each damper; NULL: those that the matrices hold
 */
ritz_status ritz_h2_with(ritz_model model, const ritz_disturbance *noise,
                         const double *c, const double *k, ritz_h2 *out);

/* A search for the values of groups of dampers. */
typedef struct ritz_tuning_search {
    int64_t count;
    const ritz_tuned *tuned;
    const double *c, *k; /* for each group: an additional start; NULL: none */
    int64_t starts;      /* largest number of starts from the grid */
    int64_t most;        /* largest number of evaluations from each start */
} ritz_tuning_search;

/**
 * Tune a plant. Sets `c`, `k`, `norm`, `tuned`, `slope`, `evaluations`,
 * `starts` and `agreed` of the result. `norm` is HUGE_VAL if it was infinite at
 * all points.
 *
 * @param[in,out] plant  its dampers get the values that were found
 */
ritz_status ritz_tune_plant(ritz_plant *plant, const ritz_tuning_search *search,
                            ritz_tuning *out);

/** ritz_tuning_of with an additional start; NULL: none. */
ritz_status ritz_tune_from(const ritz_tuning_request *request, const double *c,
                           const double *k, ritz_tuning *out);

/** Check groups and ranges. @return RITZ_ERR_ARGUMENT if one is invalid */
ritz_status ritz_tuning_check(const ritz_tuning_request *request);

/** Whether the model is a component so large that it is tuned in a space of @p
 * modes modes and static responses. */
bool ritz_tuned_in_space(const ritz_tuning_request *request, int64_t modes);

/** Number of modes of the first space in which a component is tuned. */
int64_t ritz_tuning_modes(const ritz_tuning_request *request);

/** Mark the dampers that take part: those that are tuned, have c or k that is
 * not 0, or are contained in the matrices. */
void ritz_tuning_uses(const ritz_tuning_request *request, bool *used);

/*
 * A component projected on its lowest modes and its static responses to inputs
 * and dampers [ChuMilman1992, eq. 11-14]. A plant made of it uses the responses
 * of the dampers that take part only.
 */
typedef struct ritz_static_space {
    int64_t num_modes, num_inputs; /* columns are modes, responses to inputs,
                                      responses to dampers */
    double sigma;                  /* responses are those of K - sigma M */
    ritz_structure whole;          /* matrices in all columns */
    ritz_io io;
    ritz_dampers dampers;
    ritz_damping damping;
    ritz_disturbance noise;
} ritz_static_space;

/**
 * @param[in] model  a component
 * @param[in] modes  number of flexible modes, in addition to all rigid ones
 */
ritz_status ritz_static_space_new(ritz_model model, int64_t modes,
                                  const ritz_disturbance *noise,
                                  ritz_static_space *out);

/**
 * The component projected on the modes, the responses to inputs and the
 * responses to some dampers, in an orthonormal basis. The plant has all dampers
 * of the component.
 *
 * @param[in] used  for each damper whether its static response is included;
 *                  NULL: all are
 */
ritz_status ritz_static_space_plant(const ritz_static_space *space,
                                    const bool *used, ritz_plant *out);

void ritz_static_space_free(ritz_static_space *space);

#endif
