/* Damped eigenpairs (s^2 M + s D + K + i K4) x = 0. */
#ifndef RITZ_POLES_DAMPED_H
#define RITZ_POLES_DAMPED_H

#include "poles/poles.h"

#include <ritz/poles.h>

/* Components of so many dofs are taken whole, as dense: some seconds. */
enum { RITZ_WHOLE_DOFS = 300 };

/** The first m rows and columns of A; {0} of {0}. */
ritz_status ritz_leading(const ritz_dense *A, int64_t m, ritz_dense *out);

/** All poles of a dense model; its io may be NULL. @cost O((2 n)^3) */
ritz_status ritz_spectrum_dense(const ritz_second_order *model,
                                const ritz_damping *damping,
                                ritz_spectrum *out);

/** Poles of a component of more dofs than that, by a projection. */
ritz_status ritz_spectrum_large(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_span *span, ritz_spectrum *out);

/** K, M, D and K4 of a component as dense ones, and nothing else of it. */
ritz_status ritz_whole_new(const ritz_component *component, ritz_reduced *out);

/** Shape of pole j, n x 2: real and imaginary part. */
ritz_status ritz_spectrum_shape(const ritz_spectrum *spectrum, int64_t j,
                                ritz_dense *out);

/*
 * Damped eigenpairs of the full matrices, by inverse iteration for
 * Z(s) = s^2 M + s D + K + i K4:
 *
 *     u = Z(s)^-1 Z'(s) x,    s_new = s - (x^H x) / (x^H u),   x_new = u
 *
 * [Ruhe1973]
 */
typedef struct ritz_refiner {
    const ritz_component *component; /* borrowed */
    ritz_zldl *Z;
} ritz_refiner;

ritz_status ritz_refiner_new(const ritz_component *component,
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

/** The pole above the axis of size |s| and a ratio; NaN of ratios from 1 on. */
double _Complex ritz_pole_of(double size, double zeta);

typedef struct ritz_damped {
    double *zeta;          /* of each undamped mode: NaN where it does not
                              oscillate any more, 0 where rigid */
    double _Complex *s;    /* of each: NaN where rigid, or not oscillating */
    ritz_spectrum listing; /* all poles; {0} where D couples no modes */
} ritz_damped;

/**
 * The damped mode that each undamped one has become.
 *
 * @param[in] component  may be NULL; else modes in `band_hz` are made exact by
 *                       inverse iteration on its matrices
 * @param[in] pairs      of the component; NULL with it
 */
ritz_status ritz_damped_new(const ritz_poles *poles,
                            const ritz_component *component,
                            const ritz_pairs *pairs, const double band_hz[2],
                            ritz_damped *out);

/** Oscillating pole nearest to @p s among those of a model; NaN if none. */
double _Complex ritz_damped_nearest(const ritz_damped *damped, int64_t count,
                                    double _Complex s);

void ritz_damped_free(ritz_damped *damped);

#endif
