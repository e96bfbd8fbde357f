/* Start of both Lanczos methods for states. */
#ifndef RITZ_BASES_LANCZOS_H
#define RITZ_BASES_LANCZOS_H

#include "gramians/modes.h"

#include <ritz/basis.h>

/** The shift of the states, 0 if none is chosen.
 * @return RITZ_ERR_ARGUMENT if several are chosen */
ritz_status ritz_lanczos_shift(const ritz_choice *choice, double *alpha);

/** The requested component in first-order form, with its states shifted. */
ritz_status ritz_lanczos_states(const ritz_request *request, ritz_states *out);

/**
 * G = A and b = B, or G = A^-1 and b = G B if @p inverse.
 *
 * @return RITZ_ERR_SINGULAR if A has no inverse
 */
ritz_status ritz_lanczos_operator(const ritz_dense *A, const ritz_dense *B,
                                  bool inverse, ritz_dense *G, ritz_dense *b);

#endif
