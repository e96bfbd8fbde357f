/* Modal models of modes that are known. */
#ifndef RITZ_GRAMIANS_MODAL_MODES_H
#define RITZ_GRAMIANS_MODAL_MODES_H

#include "model/modal.h"

#include <ritz/model.h>

#include <stdbool.h>

/**
 * Modes of one frequency may be any basis of their space: turn them into one in
 * which damping is diagonal. MPhi may be {0}.
 */
ritz_status ritz_modes_turn(ritz_modal_model *modes);

/* Two modes that damping couples, one at least flexible. */
typedef struct ritz_coupling {
    double hertz[2];
    double ratio; /* of their own damping */
} ritz_coupling;

/** Whether there are such. */
bool ritz_modes_coupled(const ritz_modal_model *modes, ritz_coupling *out);

/** RITZ_ERR_ARGUMENT, with a sentence that ends in @p why. */
ritz_status ritz_coupling_refuse(const ritz_coupling *coupling,
                                 const char *why);

/**
 * Their flexible ones, of which damping couples none.
 *
 * @param[in] io  for the limits of its outputs
 * @return RITZ_ERR_ARGUMENT if one has no damping, or a limit is not positive
 */
ritz_status ritz_modal_of_modes(const ritz_modal_model *modes,
                                const ritz_io *io, ritz_modal *out);

#endif
