/* Shared by poles and scans of components. */
#ifndef RITZ_POLES_SPECTRUM_PARTS_H
#define RITZ_POLES_SPECTRUM_PARTS_H

#include <ritz/poles.h>

/* Components of so many dofs are taken whole, as dense: some seconds. */
enum { RITZ_WHOLE_DOFS = 300 };

/* All of a component as a dense model. */
typedef struct ritz_whole {
    ritz_dense K, M, D, K4;
    ritz_second_order model; /* of these; io NULL */
} ritz_whole;

/** All poles of a dense model; its io may be NULL. @cost O((2 n)^3) */
ritz_status ritz_spectrum_dense(const ritz_second_order *model,
                                const ritz_damping *damping,
                                ritz_spectrum *out);

/** Poles of a component of more dofs than that, by a projection. */
ritz_status ritz_spectrum_large(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_span *span, ritz_spectrum *out);

/** @param[out] out  must stay where it is: its model points into it */
ritz_status ritz_whole_new(const ritz_component *component, ritz_whole *out);
void ritz_whole_free(ritz_whole *whole);

#endif
