/*
 * Full matrices of a component, factored at any frequency: the direct engine
 * samples them, krylov projects them and rational interpolates them.
 */
#ifndef RITZ_RESPONSE_DIRECT_H
#define RITZ_RESPONSE_DIRECT_H

#include "poles/poles.h"

#include <ritz/matrix.h>

typedef struct ritz_direct {
    const ritz_component *component; /* borrowed; or `damped` */
    ritz_component *damped; /* a copy that borrows all but D, which is own_D; or
                               NULL */
    ritz_sparse own_D;      /* D and the damping of all modes by ratios */
    ritz_damping damping;
    double a, b;     /* of Rayleigh damping; else 0 */
    double up_to_hz; /* frequency up to which modes are computed */
    ritz_zldl *Z;
    ritz_pairs pairs;
    ritz_poles poles; /* of the modes; their response is used if `apart` */
    ritz_dense MPhi;  /* n x m */
    int64_t n, m, inputs;
    ritz_residual rest; /* changes by ratios of the modes above, if `apart` */
    bool apart;         /* modes are decoupled: no D, no K4, no Rayleigh
                           damping */
    bool ratios;
    double _Complex *X; /* n x inputs, work space */
} ritz_direct;

/**
 * Damping ratios act on all modes if ritz_ratios_act_on_all; if there is D or
 * K4, they become part of D.
 *
 * @param[in] up_to_hz  of the modes that are computed; if ratios do not act on
 *                      all modes, they act on these
 */
ritz_status ritz_direct_new(const ritz_component *component,
                            const ritz_damping *damping, double up_to_hz,
                            ritz_direct *out);

/**
 * M Phi diag(2 zeta w) Phi'M of all modes. Modes up to @p up_to_hz have the
 * accuracy of ritz_eigen_sparse.
 */
ritz_status ritz_matrix_of_ratios(const ritz_component *component,
                                  const ritz_damping *damping, double up_to_hz,
                                  ritz_dense *out);

/**
 * Add H at one frequency to an array of zeros. @cost a complex factorization
 */
ritz_status ritz_direct_at(ritz_direct *direct, double hertz,
                           double _Complex *H);

/**
 * X := Z(i w)^-1 X, n x k, by one factorization; with Z' if @p transposed. If
 * the modes are decoupled, this is the response of the space M-orthogonal to
 * them, without damping by ratios.
 */
ritz_status ritz_direct_solve(ritz_direct *direct, double hertz,
                              bool transposed, int64_t k, double _Complex *X);

/**
 * Estimate of the rounding error of H, from the full responses X to all inputs
 * and Y of the transposed system to all outputs.
 *
 * @param[out] out  outputs x inputs, row by row, of H
 */
ritz_status ritz_direct_noise(const ritz_direct *direct, double hertz,
                              const double _Complex *X, int64_t outputs,
                              const double _Complex *Y, double *out);

void ritz_direct_free(ritz_direct *direct);

#endif
