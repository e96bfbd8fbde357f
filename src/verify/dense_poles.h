/* Every mode of a dense model, as ritz_response_dense uses them. */
#ifndef RITZ_VERIFY_DENSE_POLES_H
#define RITZ_VERIFY_DENSE_POLES_H

#include "verify/poles.h"

ritz_status ritz_poles_of_dense(const ritz_second_order *model,
                                const ritz_damping *damping, ritz_poles *out);

#endif
