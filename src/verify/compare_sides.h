/* The two models that are compared, and the measures between them. */
#ifndef RITZ_VERIFY_COMPARE_SIDES_H
#define RITZ_VERIFY_COMPARE_SIDES_H

#include "verify/damped.h"
#include "verify/match.h"

#include <ritz/verify.h>

typedef struct ritz_sides {
    double band_hz[2];
    double modes_hz; /* the full model's modes are known up to here */
    ritz_damping damping;
    bool assumed;     /* nobody had said how it is damped */
    bool shapes;      /* MAC is of shapes */
    bool outputs;     /* MAC is of what inputs and outputs see */
    ritz_pairs pairs; /* of the full model, to three times the band */
    ritz_pairs small; /* of the reduced one, all */
    const ritz_component *component; /* the full model, borrowed */
    ritz_poles full, reduced;
    ritz_residual residual; /* of the full model */
    ritz_dense gain_reduced;
    ritz_damped damped_full, damped_reduced;
    ritz_match match;
} ritz_sides;

/** Frequency, MAC, damping, rigid, missing and extra modes. */
ritz_status ritz_sides_modes(const ritz_sides *sides,
                             const ritz_verify_request *request,
                             ritz_measures *out);

/** Response and static gain; none if there is no input or no output. */
ritz_status ritz_sides_responses(const ritz_sides *sides,
                                 const ritz_verify_request *request,
                                 ritz_measures *out);

void ritz_sides_free(ritz_sides *sides);

#endif
