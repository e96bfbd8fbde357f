/* Damped eigenpairs (s^2 M + s D + K + i K4) x = 0 of models in verification. */
#ifndef RITZ_POLES_DAMPED_H
#define RITZ_POLES_DAMPED_H

#include "poles/poles.h"

#include <ritz/poles.h>

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
