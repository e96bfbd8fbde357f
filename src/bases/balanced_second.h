/* Balancing that leaves a model of second order what it is. */
#ifndef RITZ_BASES_BALANCED_SECOND_H
#define RITZ_BASES_BALANCED_SECOND_H

#include <ritz/method.h>

/* Which half of the controllability Gramian of x = [u; u'] is balanced. */
typedef enum ritz_half {
    RITZ_HALF_POSITION,
    RITZ_HALF_VELOCITY,
} ritz_half;

/**
 * T = [Phi, T_b] and W = [Phi, W_b], Phi the rigid modes: see balanced_second.c.
 *
 * @return RITZ_ERR_ARGUMENT if a pole that is no rigid motion is not left of
 *         the axis, or as ritz_gramians_asked
 */
ritz_status ritz_balanced_second(const ritz_request *request, ritz_half half,
                                 ritz_basis *out);

#endif
