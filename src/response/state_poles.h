/* Poles of a state space near a range of frequencies. */
#ifndef RITZ_RESPONSE_STATE_POLES_H
#define RITZ_RESPONSE_STATE_POLES_H

#include "linear/pencil.h"
#include "poles/poles.h"

#include <ritz/response.h>

enum {
    RITZ_POLE_PLACES = 5, /* frequencies of the range near which poles are
                             sought */
    RITZ_POLES_NEAR = 16, /* poles sought near each of them */
};

typedef struct ritz_near_poles {
    int64_t count;
    double _Complex *s; /* one or both poles of a conjugate pair */
    double _Complex *x; /* n x count, eigenvectors: A x = s E x */
} ritz_near_poles;

/**
 * The poles nearest to some frequencies of a range, each once. A frequency at
 * which the iterations fail, or which is that of a pole, contributes none.
 *
 * @return RITZ_ERR_MEMORY
 * @cost   a complex factorisation and some hundred solves for each frequency
 */
ritz_status ritz_poles_near(ritz_pencil *pencil,
                            const ritz_response_request *request,
                            ritz_near_poles *out);

/** The poles above the real axis as modes, to refine a grid around them. */
ritz_status ritz_near_poles_list(const ritz_near_poles *near,
                                 const ritz_response_request *request,
                                 ritz_poles *out);

void ritz_near_poles_free(ritz_near_poles *near);

#endif
