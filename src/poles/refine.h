/*
 * Damped eigenpairs of the full matrices, by inverse iteration for
 * Z(s) = s^2 M + s D + K (+ i K4):
 *
 *     u = Z(s)^-1 Z'(s) x,    s_new = s - (x^H x) / (x^H u),   x_new = u
 *
 * [Ruhe1973]
 */
#ifndef RITZ_POLES_REFINE_H
#define RITZ_POLES_REFINE_H

#include <ritz/matrix.h>
#include <ritz/model.h>

#include <complex.h>
#include <stdbool.h>

typedef struct ritz_refiner {
    const ritz_component *component; /* borrowed */
    const ritz_sparse *K4;           /* NULL: left out */
    ritz_zldl *Z;
} ritz_refiner;

/** @param[in] structural  take K4 into Z, if there is any */
ritz_status ritz_refiner_new(const ritz_component *component, bool structural,
                             ritz_refiner *out);

/**
 * From an estimate to the pair nearest to it.
 *
 * @param[in,out] x  n x 2, real and imaginary part
 * @return RITZ_ERR_CONVERGENCE if s does not settle
 */
ritz_status ritz_refine(ritz_refiner *refiner, ritz_dense *x,
                        double _Complex *s);

/** |Z(s) x| over the norm of what its terms add up to, taken as magnitudes. */
ritz_status ritz_refiner_residual(const ritz_refiner *refiner,
                                  const ritz_dense *x, double _Complex s,
                                  double *out);

void ritz_refiner_free(ritz_refiner *refiner);

#endif
