/*
 * Projection of a component on a basis by all ranks: rank 0 calls
 * projection_make() and gets the reduced component, the others are in
 * projection_help() meanwhile.
 */
#ifndef RITZ_LIBEXEC_SLEPC_PROJECTION_H
#define RITZ_LIBEXEC_SLEPC_PROJECTION_H

#include <ritz/model.h>

#include <stdbool.h>

/**
 * To be called in rank 0: as ritz_reduce(), for a component whose matrices are
 * in its file only.
 *
 * @param[in] path       of the component's file, readable by all ranks
 * @param[in] component  all but its matrices
 * @return as ritz_reduce(), ritz_slab_read() or ritz_slab_verify();
 *         RITZ_ERR_FORMAT if K, M or K4 is not symmetric to the last bit
 */
ritz_status projection_make(const char *path, const ritz_component *component,
                            const ritz_basis *basis, ritz_reduced *out);

/** To be called in all other ranks: take part in each projection_make() of rank
 * 0, until it calls projection_dismiss(). */
void projection_help(void);

/** To be called in rank 0: let projection_help() return in the other ranks. */
void projection_dismiss(void);

/** In rank 0: whether no projection_make() is under way, so that the other
 * ranks wait for a task. */
bool projection_is_idle(void);

#endif
