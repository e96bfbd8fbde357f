/* Poles of a state space about a range of frequencies. */
#ifndef RITZ_RESPONSE_STATE_POLES_H
#define RITZ_RESPONSE_STATE_POLES_H

#include "linear/pencil.h"
#include "poles/poles.h"

#include <ritz/response.h>

enum {
    RITZ_POLE_PLACES = 5, /* frequencies of the range near which are sought */
    RITZ_POLES_NEAR = 16, /* poles near each */
};

typedef struct ritz_near_poles {
    int64_t count;
    double _Complex *s; /* of a pair one or both */
    double _Complex *x; /* n x count: A x = s E x */
} ritz_near_poles;

/**
 * The poles nearest to some frequencies of a range, each once. Where they are
 * not found, or a frequency is that of a pole, there are fewer.
 *
 * @return RITZ_ERR_MEMORY
 * @cost   a complex factor, and some hundred solves, for each frequency
 */
ritz_status ritz_poles_near(ritz_pencil *pencil,
                            const ritz_response_request *request,
                            ritz_near_poles *out);

/** Those above the axis as modes, for a grid that is refined around them. */
ritz_status ritz_near_poles_list(const ritz_near_poles *near,
                                 const ritz_response_request *request,
                                 ritz_poles *out);

void ritz_near_poles_free(ritz_near_poles *near);

#endif
