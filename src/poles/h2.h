/* A small model whose dampers vary, its H2 norm and what it depends on. */
#ifndef RITZ_POLES_H2_H
#define RITZ_POLES_H2_H

#include "model/modal.h"

#include <ritz/tuning.h>

typedef struct ritz_plant {
    ritz_structure base;  /* dense K, M and D of n coordinates */
    ritz_io io;           /* for these */
    ritz_damping damping; /* in addition to D */
    ritz_dampers dampers; /* their c and k are read, and what `base` holds */
    ritz_disturbance noise;
} ritz_plant;

typedef struct ritz_variance {
    bool finite;
    double square;    /* of the norm; HUGE_VAL if it is not finite */
    double *by_c;     /* d square / d c of each damper; NULL: not wanted */
    double *by_k;     /* with by_c */
    int64_t unstable; /* poles that make it infinite */
    int64_t states;
} ritz_variance;

/** A dense model, or a component as dense matrices, copied. */
ritz_status ritz_plant_new(ritz_model model, const ritz_disturbance *noise,
                           ritz_plant *out);

/**
 * Sum of the variances of all outputs with the dampers as they are set, and its
 * derivatives.
 *
 * @param[in,out] out  by_c and by_k are the caller's, with room for each damper
 * @return RITZ_ERR_ARGUMENT if derivatives are wanted and a damper moves dofs
 *         without mass, or as ritz_h2_of; an infinite norm is not refused
 */
ritz_status ritz_variance_of(const ritz_plant *plant, ritz_variance *out);

/** The norm as the dampers are set; HUGE_VAL: infinite. */
ritz_status ritz_plant_norm(const ritz_plant *plant, double *out);

/** ritz_variance_of of a state space; no derivatives. */
ritz_status ritz_variance_of_states(const ritz_state_space *model,
                                    const ritz_disturbance *noise,
                                    ritz_variance *out);

/** The sentence of an infinite norm. */
ritz_status ritz_refuse_infinite(const ritz_variance *variance);

void ritz_plant_free(ritz_plant *plant);

/**
 * ritz_h2_of with other values of dampers.
 *
 * @param[in] c,k  of each damper of the model; NULL: what its matrices hold
 */
ritz_status ritz_h2_with(ritz_model model, const ritz_disturbance *noise,
                         const double *c, const double *k, ritz_h2 *out);

/* A search for the values of some dampers. */
typedef struct ritz_tuning_search {
    int64_t count;
    const ritz_tuned *tuned;
    const double *c, *k; /* of each group: one more start; NULL: none */
    int64_t starts;      /* of its own, at most */
    int64_t most;        /* evaluations from each start */
} ritz_tuning_search;

/**
 * Tune a plant: `c`, `k`, `norm`, `slope`, evaluations and starts of the result
 * are set. A norm that is infinite wherever it was tried is HUGE_VAL.
 *
 * @param[in,out] plant  its dampers have those values after it
 */
ritz_status ritz_tune_plant(ritz_plant *plant, const ritz_tuning_search *search,
                            ritz_tuning *out);

/** ritz_tuning_of with one more start; NULL: without. */
ritz_status ritz_tune_from(const ritz_tuning_request *request, const double *c,
                           const double *k, ritz_tuning *out);

/** Groups and ranges. @return RITZ_ERR_ARGUMENT */
ritz_status ritz_tuning_check(const ritz_tuning_request *request);

/** Whether such a component is tuned in a space of so many modes. */
bool ritz_tuned_in_space(const ritz_tuning_request *request, int64_t modes);

/** Modes that it is tuned with at first. */
int64_t ritz_tuning_modes(const ritz_tuning_request *request);

/** A damper takes part that is tuned, does something, or is held. */
void ritz_tuning_uses(const ritz_tuning_request *request, bool *used);

/*
 * A component in the space of its lowest modes and of static responses to
 * inputs and dampers [ChuMilman1992, eq. 11-14]. Of the dampers' responses a
 * model takes those of the dampers that it has.
 */
typedef struct ritz_static_space {
    int64_t num_modes, num_inputs; /* columns: modes, inputs, dampers */
    double sigma;         /* of K - sigma M, whose responses they are */
    ritz_structure whole; /* in all columns */
    ritz_io io;
    ritz_dampers dampers;
    ritz_damping damping;
    ritz_disturbance noise;
} ritz_static_space;

/**
 * @param[in] model  a component
 * @param[in] modes  how many flexible ones; rigid ones come first
 */
ritz_status ritz_static_space_new(ritz_model model, int64_t modes,
                                  const ritz_disturbance *noise,
                                  ritz_static_space *out);

/**
 * The model with the modes and inputs and with some of the dampers alone, in an
 * orthonormal basis; `dampers` of it are all of the component's.
 *
 * @param[in] used  for each damper whether its static response is taken; NULL:
 *                  all are
 */
ritz_status ritz_static_space_plant(const ritz_static_space *space,
                                    const bool *used, ritz_plant *out);

void ritz_static_space_free(ritz_static_space *space);

#endif
