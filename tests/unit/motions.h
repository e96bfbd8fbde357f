/*
 * Three masses in a row, 1, 2 and 1.5, springs 100 (to ground), 50 and 80,
 * dashpots 0.5 (to ground), 0 and 3, which couple the modes: sparse and dense.
 * A force on the last is its input, the place of the first its output.
 */
#ifndef RITZ_TESTS_MOTIONS_H
#define RITZ_TESTS_MOTIONS_H

#include <ritz/simulate.h>

typedef struct motions {
    ritz_component component;
    ritz_dense K, M, D;
    ritz_second_order model; /* of the above */
    ritz_simulated dense;    /* the model, no damping beside D */
    ritz_simulated sparse;   /* the component, the same */
} motions;

/** @param[in] damped  with its dashpots */
ritz_status motions_new(bool damped, motions *out);

/** A row of @p n masses of any kind with the same input and output. */
ritz_status motions_row(int64_t n, const double *m, const double *k,
                        const double *c, motions *out);
void motions_free(motions *m);

/** A step on the one input; borrowed. */
extern const ritz_signal motions_step;

#endif
