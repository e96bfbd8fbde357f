/* Moments of transfer functions: reduced models are held to the full ones. */
#ifndef RITZ_TESTS_MOMENTS_H
#define RITZ_TESTS_MOMENTS_H

#include <ritz/component.h>

/* M x'' + D x' + K x = B u, y = C x; dense, D may be {0}. */
typedef struct moments_model {
    ritz_dense K, M, D;
    ritz_dense B; /* n x p */
    ritz_dense C; /* q x n */
} moments_model;

/** The component itself, with its D, B and C. */
moments_model moments_full(const ritz_component *component);

/** The same in the subspace of T. */
moments_model moments_reduced(const ritz_component *component,
                              const ritz_dense *T);

/**
 * C (A^-1 M)^j A^-1 B, A = K - sigma M, of the flexible modes: a sum over all
 * of them, C phi phi' B / (lambda - sigma)^(j + 1). q x p.
 */
ritz_dense moments_undamped(const moments_model *model, double sigma, int j);

/** Coefficient j of C (s^2 M + s D + K)^-1 B about s = 0; K is definite. */
ritz_dense moments_damped(const moments_model *model, int j);

/**
 * The moments 0 .. count - 1 of both agree, each within `bound` of the largest
 * entry of the full one. With sigma NaN they are those of the damped models.
 */
void moments_agree(const moments_model *full, const moments_model *reduced,
                   double sigma, int count, double bound);

/** Largest relative difference of moment j, as moments_agree measures it. */
double moments_differ(const moments_model *full, const moments_model *reduced,
                      double sigma, int j);

void moments_free(moments_model *model);

#endif
