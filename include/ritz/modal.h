/*
 * A modal model: each flexible mode by itself, with modal damping.
 *
 *     q_k'' + 2 zeta_k omega_k q_k' + omega_k^2 q_k = b_k u,
 *     y = sum_k c_k q_k + cv_k q_k' + ca_k q_k''
 */
#ifndef RITZ_MODAL_H
#define RITZ_MODAL_H

#include <ritz/damping.h>
#include <ritz/dense.h>
#include <ritz/io.h>

#pragma GCC visibility push(default)

/* Flexible modes of a model, with their own share of inputs and outputs. */
typedef struct ritz_modal {
    int64_t count;    /* m */
    double *omega;    /* m, ascending, positive  [rad/s] */
    double *zeta;     /* m, positive where a ranking needs damping */
    ritz_dense B;     /* m x inputs, inputs scaled by their weights */
    ritz_dense C, Cv; /* outputs x m, divided by limits; acceleration outputs
                          are folded into both, their feedthrough left out */
} ritz_modal;

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
 * states (q_1, q_1', q_2, ...), 2m x 2m, closed form, O(m^2).
 */
ritz_status ritz_modal_gramians(const ritz_modal *modal, ritz_dense *Wc,
                                ritz_dense *Wo);

/** Exact Hankel singular values, 2m, descending. @cost O(m^3) */
ritz_status ritz_modal_hankel(const ritz_modal *modal, double *sigma);

/**
 * Factors of both, W_c = Z_c Z_c' and W_o = Z_o Z_o', in the same states and of
 * as many columns as there is rank.
 */
ritz_status ritz_modal_factors(const ritz_modal *modal, ritz_dense *Zc,
                               ritz_dense *Zo);

/**
 * The same of a band alone, closed form:
 *
 *     W_c = 1/pi Re int_{w1}^{w2} (i w - A)^-1 B B' (i w - A)^-* dw
 *
 * and W_o likewise. From 0 to infinity they are those above. They are
 * semidefinite, rounding apart.
 *
 * @param[in] band_hz  from and to; HUGE_VAL is infinity
 * @return RITZ_ERR_ARGUMENT if it is no band, or a mode has no damping
 */
ritz_status ritz_modal_gramians_band(const ritz_modal *modal,
                                     const double band_hz[static 2],
                                     ritz_dense *Wc, ritz_dense *Wo);

/** @return RITZ_ERR_CONVERGENCE if one is indefinite beyond rounding */
ritz_status ritz_modal_factors_band(const ritz_modal *modal,
                                    const double band_hz[static 2],
                                    ritz_dense *Zc, ritz_dense *Zo);

/** Hankel values over a band, 2m, descending. @return as the factors */
ritz_status ritz_modal_hankel_band(const ritz_modal *modal,
                                   const double band_hz[static 2],
                                   double *sigma);

void ritz_modal_free(ritz_modal *modal);

#pragma GCC visibility pop

#endif
