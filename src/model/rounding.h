/* Digits of a stiffness, and the forces that a rigid motion meets in it. */
#ifndef RITZ_MODEL_ROUNDING_H
#define RITZ_MODEL_ROUNDING_H

#include <ritz/model.h>

/* Rigid motions of one body. */
enum { RITZ_BODY_MOTIONS = 6 };

/* Forces K r of rigid motions, and what an error of size 1 leaves of them. */
typedef struct ritz_rigid_forces {
    double largest;
    int64_t row; /* where; -1: there is none */
    double bound;
    double fine; /* relative error that is no fault */
} ritz_rigid_forces;

/** Of all columns of R, @p out's `fine` being 0. */
ritz_status ritz_rigid_forces_of(const ritz_sparse *K, const ritz_dense *R,
                                 ritz_rigid_forces *out);

/**
 * Significant digits of K, which has entries, at most 17.
 *
 * @param[out] declared  they are what the source states, and K was rounded
 */
ritz_status ritz_source_digits(const ritz_component *component, double *digits,
                               bool *declared);

/** Half a unit of the last of some decimal digits, relative. */
double ritz_digits_rounding(double digits);

#endif
