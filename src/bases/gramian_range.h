/* The states that a Gramian reaches, in coordinates in which it is I. */
#ifndef RITZ_BASES_GRAMIAN_RANGE_H
#define RITZ_BASES_GRAMIAN_RANGE_H

#include <ritz/dense.h>

/*
 * With A W + W A' + B B' = 0, W = U U' and U = Z Sigma X', cut to r values:
 * Q = Z Sigma, V = Z Sigma^-1 and A~ = V'A Q, B~ = V'B, for which
 * A~ + A~' = -B~ B~'.
 */
typedef struct ritz_gramian_range {
    int64_t reached; /* values above the tolerance */
    ritz_dense Q, V; /* n x r, r <= reached: as rounding allows */
    ritz_dense A, B; /* r x r, r x inputs */
    double rounding; /* |A + A' + B B'| of Frobenius */
} ritz_gramian_range;

/**
 * @param[in] tolerance  relative, of singular values of U
 * @param[in] limit      of `rounding`: the range is cut until it is below
 * @return RITZ_ERR_ARGUMENT if the Gramian is zero, or a pole is not stable;
 *         RITZ_ERR_CONVERGENCE if nothing is left
 */
ritz_status ritz_gramian_range_new(const ritz_dense *A, const ritz_dense *B,
                                   double tolerance, double limit,
                                   ritz_gramian_range *out);

/** |A + A' + B B'|, Frobenius. */
double ritz_gramian_defect(const ritz_dense *A, const ritz_dense *B);

void ritz_gramian_range_free(ritz_gramian_range *range);

#endif
