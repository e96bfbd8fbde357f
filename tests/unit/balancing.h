/* What tests of balanced bases share: a row of masses, and errors that count. */
#ifndef RITZ_TESTS_BALANCING_H
#define RITZ_TESTS_BALANCING_H

#include <ritz/method.h>
#include <ritz/state_space.h>

/**
 * The row of spring_chain.h with forces and displacements at some masses, and
 * damping ratios of @p damping, "modal 0.05".
 */
void balancing_chain(int64_t n, bool is_free, int64_t in, int64_t out,
                     const char *damping, ritz_component *chain);

/** What is asked: so many vectors of a component. */
ritz_request balancing_asking(const ritz_component *component, int64_t modes);

/** Its state space with its own damping. */
void balancing_full(const ritz_component *component, ritz_state_space *out);

/** H-infinity norm of a - b. */
double balancing_error(const ritz_state_space *a, const ritz_state_space *b);

/** Response at @p hertz, outputs x inputs by columns; to be freed. */
double _Complex *balancing_response(const ritz_state_space *model,
                                    double hertz);

/** D - C A^-1 B. */
ritz_dense balancing_static(const ritz_state_space *model);

#endif
