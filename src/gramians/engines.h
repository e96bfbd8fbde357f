/* Engines for the Gramians of a component, and what they share. */
#ifndef RITZ_GRAMIANS_ENGINES_H
#define RITZ_GRAMIANS_ENGINES_H

#include "model/first_order.h"

#include <ritz/gramians.h>

#include <stdbool.h>

/** By SLICOT, in modal coordinates; what does not decay stands apart. */
ritz_status ritz_gramians_dense(const ritz_gramians_request *request,
                                ritz_gramians *out);

/** Closed form; @return RITZ_ERR_ARGUMENT also if damping couples modes */
ritz_status ritz_gramians_modal(const ritz_gramians_request *request,
                                ritz_gramians *out);

/** The same unless damping couples modes: then *fits is false, and no more. */
ritz_status ritz_gramians_modal_if(const ritz_gramians_request *request,
                                   bool *fits, ritz_gramians *out);

/**
 * All modes of the component, or those up to the frequency asked for, with all
 * damping; those of one frequency turned so that it couples none of them.
 *
 * @return RITZ_ERR_ARGUMENT if there are too many, or no flexible one
 */
ritz_status ritz_gramians_modes(const ritz_gramians_request *request,
                                ritz_first_order *out);

/* States of modes: q_k is row k * step, q_k' the next, or row m + k of 2m. */
typedef struct ritz_mode_states {
    const ritz_first_order *modes;
    int64_t apart; /* rigid modes, the first ones, that are none of them */
    int64_t step;  /* 1: all q before all q'; 2: each q before its q' */
    const double *scale; /* rows are scale q and q'; NULL: q */
} ritz_mode_states;

/**
 * Gramians of modes as those of x = [u; u'] of the component:
 *
 *     Z_c := [Phi 0; 0 Phi] Z_c,    Z_o := [M Phi 0; 0 Phi] Z_o
 *
 * and T and W likewise, behind the rigid modes that stand apart.
 *
 * @param[in,out] gramians  in states; without E
 */
ritz_status ritz_gramians_lift(const ritz_mode_states *states,
                               ritz_gramians *gramians);

#endif
