/*
 * Singular values of a response of several inputs and outputs: the largest is
 * the most that any unit input, in whatever direction and phase, can do.
 */
#ifndef RITZ_SINGULAR_H
#define RITZ_SINGULAR_H

#include <ritz/response.h>

#pragma GCC visibility push(default)

/*
 * What signals are measured by: outputs are divided by theirs, as by the limit
 * of each; inputs are multiplied by theirs, as by the size each may have. NULL,
 * or NaN in place of a number: 1.
 */
typedef struct ritz_scales {
    const double *output, *input;
} ritz_scales;

/** Of one H, row by row: min(outputs, inputs) of them, descending.
 * @return RITZ_ERR_CONVERGENCE */
ritz_status ritz_singular_values(int64_t num_outputs, int64_t num_inputs,
                                 const double _Complex *H,
                                 const ritz_scales *scales, double *sigma);

/**
 * At every point of a response; kept in it, in place of others.
 *
 * @param[in] scales  NULL: none
 */
ritz_status ritz_singular_of(const ritz_scales *scales,
                             ritz_response *response);

/**
 * The largest of them and where, between the points too: around those that
 * stand out from their neighbours it is looked for until nothing is gained.
 * Responses that have points at every resonance, as refined ones have, leave
 * no peak between two that are lower.
 *
 * @param[in] responder  of the same model; NULL: points alone
 * @param[out] value     HUGE_VAL at a pole that nothing damps
 */
ritz_status ritz_singular_peak(const ritz_response *response,
                               const ritz_scales *scales,
                               ritz_responder *responder, double *hertz,
                               double *value);

#pragma GCC visibility pop

#endif
