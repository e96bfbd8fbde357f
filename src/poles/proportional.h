/* Whether D is a M + b K. */
#ifndef RITZ_POLES_PROPORTIONAL_H
#define RITZ_POLES_PROPORTIONAL_H

#include <ritz/model.h>

/**
 * The a and b for which |D - a M - b K| is least in the Frobenius norm.
 *
 * @param[in]  component  with D
 * @param[out] left       |D - a M - b K| / |D|
 */
ritz_status ritz_proportional(const ritz_component *component, double *a,
                              double *b, double *left);

#endif
