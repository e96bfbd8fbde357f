/* Significant digits of a stiffness matrix, and forces that it exerts on rigid
   motions. */
#ifndef RITZ_MODEL_ROUNDING_H
#define RITZ_MODEL_ROUNDING_H

#include <ritz/model.h>

/* Rigid motions of one body. */
enum { RITZ_BODY_MOTIONS = 6 };

/* Forces K r of rigid motions, and the bound of those that rounding of K
   causes. */
typedef struct ritz_rigid_forces {
    double largest;
    int64_t row; /* its row; -1: all forces are 0 */
    double bound;
    double fine; /* relative error of K that is still accepted */
} ritz_rigid_forces;

/** The largest force over all columns r of R, and the bound; `fine` of the
 * result is 0. */
ritz_status ritz_rigid_forces_of(const ritz_sparse *K, const ritz_dense *R,
                                 ritz_rigid_forces *out);

/**
 * Number of significant digits of K, at most 17. K must have entries.
 *
 * @param[out] declared  the source states that number of digits, and K was
 *                       rounded to it
 */
ritz_status ritz_source_digits(const ritz_component *component, double *digits,
                               bool *declared);

/** Largest relative error of rounding to some decimal digits: half a unit of
 * the last digit. */
double ritz_digits_rounding(double digits);

#endif
