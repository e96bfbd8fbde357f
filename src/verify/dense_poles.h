/* Every mode of a dense model, as ritz_response_dense uses them. */
#ifndef RITZ_VERIFY_DENSE_POLES_H
#define RITZ_VERIFY_DENSE_POLES_H

#include "verify/poles.h"

/** @param[in] D  may be NULL or {0} */
ritz_status ritz_poles_of_dense(const ritz_dense *K, const ritz_dense *M,
                                const ritz_dense *D, const ritz_io *io,
                                const ritz_damping *damping, ritz_poles *out);

#endif
