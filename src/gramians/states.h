/* A component in states that are well scaled. */
#ifndef RITZ_GRAMIANS_STATES_H
#define RITZ_GRAMIANS_STATES_H

#include "model/modal.h"

#include <ritz/model.h>

/*
 * z = [S q; q'] of the modes, S = diag(w) where w > 0: A is then near skew, and
 * a state's size is the root of its energy. Rigid modes that no damping couples
 * with others are split off: they are no part of A, B and C.
 */
typedef struct ritz_states {
    ritz_modal_model modes;
    int64_t num_apart; /* rigid modes that are split off, the first ones */
    int64_t count;     /* of states in A */
    double *scale;     /* count / 2 */
    double alpha;      /* A is less alpha I [rad/s] */
    ritz_dense A, B, C;
    char damping[RITZ_DAMPING_SIZE];
} ritz_states;

/**
 * @param[in] damping  beside the component's matrices and dampers
 * @param[in] alpha    shift of A [rad/s]
 * @return RITZ_ERR_ARGUMENT as ritz_state_space_of_component, or if there are
 *         rigid modes alone
 */
ritz_status ritz_states_new(const ritz_component *component,
                            const ritz_damping *damping, double alpha,
                            ritz_states *out);

/**
 * A, or A^-1 if @p inverse.
 *
 * @return RITZ_ERR_SINGULAR if there is no A^-1
 */
ritz_status ritz_states_operator(const ritz_dense *A, bool inverse,
                                 ritz_dense *out);

/**
 * Vectors for x = [u; u']: positions and then velocities of the rigid modes
 * that are split off, before those that @p T and @p W have in z.
 *
 * @param[in] T,W  count x k, W'T = I
 */
ritz_status ritz_states_basis(const ritz_states *states, const ritz_dense *T,
                              const ritz_dense *W, ritz_basis *out);

void ritz_states_free(ritz_states *states);

#endif
