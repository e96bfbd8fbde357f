/* Engines for the Gramians of a component, and what they share. */
#ifndef RITZ_GRAMIANS_ENGINES_H
#define RITZ_GRAMIANS_ENGINES_H

#include "model/modal.h"

#include <ritz/basis.h>

#include <stdbool.h>

/**
 * All modes of the component, or those up to the frequency asked for, with all
 * damping; those of one frequency turned so that it couples none of them.
 *
 * @return RITZ_ERR_ARGUMENT if there are too many, or no flexible one
 */
ritz_status ritz_gramians_modes(const ritz_gramians_request *request,
                                ritz_modal_model *out);

/* States of modes: q_k is row k * step, q_k' the next, or row m + k of 2m. */
typedef struct ritz_mode_states {
    const ritz_modal_model *modes;
    int64_t apart; /* rigid modes, the first ones, that are none of them */
    int64_t step;  /* 1: all q before all q'; 2: each q before its q' */
    const double *scale; /* rows are scale q and q'; NULL: q */
} ritz_mode_states;

#endif
