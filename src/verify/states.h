/* Two state spaces that are compared, and the measures between them. */
#ifndef RITZ_VERIFY_STATES_H
#define RITZ_VERIFY_STATES_H

#include <ritz/poles.h>
#include <ritz/verify.h>

/* Outputs are divided by their limits; 0 is the full model, 1 the reduced. */
typedef struct ritz_state_pair {
    const ritz_verify_request *request;
    const ritz_state_space *given[2]; /* as they came; borrowed */
    ritz_state_space model[2];        /* with their outputs divided */
    ritz_state_space stable[2];  /* what belongs to poles left of the axis */
    int64_t num_unstable[2];     /* poles that are not left of the axis */
    bool has_norms;              /* both have as many of those */
    ritz_state_space difference; /* of the stable ones, if has_norms */
    bool has_gain;               /* neither has a pole at 0 */
    ritz_dense gain[2];          /* static */
    ritz_norm full,
        error; /* H-infinity, of the full model and the difference */
} ritz_state_pair;

/**
 * @param[in] full,reduced,request  borrowed until free
 * @return RITZ_ERR_ARGUMENT if inputs or outputs differ, or if there are no norms
 *         and one has a limit
 */
ritz_status ritz_state_pair_new(const ritz_state_space *full,
                                const ritz_state_space *reduced,
                                const ritz_verify_request *request,
                                ritz_state_pair *out);
void ritz_state_pair_free(ritz_state_pair *p);

/* Functions of the table of measures: see ritz_measure_kind.of_states. */
ritz_status ritz_states_infinity(const ritz_state_pair *p, ritz_measure *out);
ritz_status ritz_states_infinity_relative(const ritz_state_pair *p,
                                          ritz_measure *out);
ritz_status ritz_states_infinity_bound(const ritz_state_pair *p,
                                       ritz_measure *out);
ritz_status ritz_states_h2(const ritz_state_pair *p, ritz_measure *out);
ritz_status ritz_states_response(const ritz_state_pair *p, ritz_measure *out);
ritz_status ritz_states_gain(const ritz_state_pair *p, ritz_measure *out);
ritz_status ritz_states_growth(const ritz_state_pair *p, ritz_measure *out);

#endif
