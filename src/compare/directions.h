/* Independent directions in the mass inner product of a body. */
#ifndef RITZ_COMPARE_DIRECTIONS_H
#define RITZ_COMPARE_DIRECTIONS_H

#include <ritz/model.h>

#include <stdbool.h>

/**
 * A lambda of the body's own, the geometric mean of K_jj / M_jj: in K + lambda
 * M neither term is rounding relative to the other.
 */
double ritz_typical_lambda(const ritz_reduced *body);

/**
 * Lower Cholesky factor of the mass, in coordinates scaled to unit diagonal;
 * where mass is singular, of mass plus stiffness over a lambda of the body's.
 *
 * @param[out] mixed  whether stiffness was added
 * @return RITZ_ERR_SINGULAR if neither is definite
 */
ritz_status ritz_mass_factor(const ritz_reduced *body, const double *scale,
                             ritz_dense *L, bool *mixed);

/**
 * Lower Cholesky factor of mass plus stiffness over a given lambda, the norm of
 * an energy.
 */
ritz_status ritz_mixed_factor(const ritz_reduced *body, const double *scale,
                              double lambda, ritz_dense *L);

/**
 * Y = L' W with W in scaled coordinates: M-inner products become Euclidean
 * ones.
 */
ritz_status ritz_mass_transform(const ritz_dense *L, const double *scale,
                                const ritz_dense *W, ritz_dense *Y);

/**
 * Replace U by the W with Y = U.
 *
 * @param[in] limited  columns longer than one, before scaling, become unit ones
 */
void ritz_mass_return(const ritz_dense *L, const double *scale, bool limited,
                      ritz_dense *U);

/** W := [W, more]. */
ritz_status ritz_columns_append(const ritz_dense *more, ritz_dense *W);

/**
 * Orthonormal directions of Y (destroyed) whose singular values exceed
 * @p tolerance times *largest, which grows to the largest there is.
 *
 * @param[out] value  these values, descending; room for as many as @p Y has
 *                    rows; NULL: not wanted
 */
ritz_status ritz_span_of(ritz_dense *Y, double tolerance, double *largest,
                         double *value, ritz_dense *out);

#endif
