/* Gramians, Hankel values and factors of modal models: see ritz_modal. */
#ifndef RITZ_GRAMIANS_MODAL_H
#define RITZ_GRAMIANS_MODAL_H

#include <ritz/model.h>

/**
 * Modal model of symmetric dense matrices or of a configuration in modal form.
 *
 * @param[in] damping  ratio of each mode, added to what D says on the diagonal
 * @return RITZ_ERR_ARGUMENT if a flexible mode has no damping
 */
ritz_status ritz_modal_new(const ritz_dense *K, const ritz_dense *M,
                           const ritz_dense *D, const ritz_io *io,
                           const ritz_damping *damping, ritz_modal *out);

/**
 * Exact controllability and observability Gramians of the modal model in the
 * states (q_1, q_1', q_2, ...), 2m x 2m, closed form, O(m^2). Those of a band,
 *
 *     W_c = 1/pi Re int_{w1}^{w2} (i w - A)^-1 B B' (i w - A)^-* dw
 *
 * and W_o likewise, are semidefinite, rounding apart, and from 0 to infinity
 * those of all frequencies.
 *
 * @param[in] band_hz  from and to, HUGE_VAL is infinity; NULL: all frequencies
 * @return RITZ_ERR_ARGUMENT if it is no band, or a mode has no damping
 */
ritz_status ritz_modal_gramians(const ritz_modal *modal, const double *band_hz,
                                ritz_dense *Wc, ritz_dense *Wo);

/**
 * Factors of both, W_c = Z_c Z_c' and W_o = Z_o Z_o', in the same states and of
 * as many columns as there is rank.
 *
 * @return RITZ_ERR_CONVERGENCE if one is indefinite beyond rounding
 */
ritz_status ritz_modal_factors(const ritz_modal *modal, const double *band_hz,
                               ritz_dense *Zc, ritz_dense *Zo);

/** Exact Hankel singular values, 2m, descending. @cost O(m^3) */
ritz_status ritz_modal_hankel(const ritz_modal *modal, const double *band_hz,
                              double *sigma);

void ritz_modal_free(ritz_modal *modal);

#endif
