/* A single eigenpair of a symmetric band matrix, in time proportional to its
 * order. */
#ifndef RITZ_LINEAR_BAND_H
#define RITZ_LINEAR_BAND_H

#include <ritz/base.h>

#include <stdbool.h>
#include <stdint.h>

/** Entry (j + i, j), 0 <= i <= width, is val[j (width + 1) + i]; entries beyond
 * the last row are not read. */
typedef struct ritz_band {
    int64_t n, width; /* entries below the diagonal in each column */
    double *val;
} ritz_band;

/**
 * The k-th largest eigenvalue of T, by bisection: within RITZ_KTH_WITHIN of it,
 * relative, and not above it but for rounding. Pivots are not exchanged, so that
 * a count near an eigenvalue of a leading block may be wrong: no more than a hint.
 *
 * @param[in,out] theta   a lower bound above 0; 0 if it was none
 * @param[out]    exists  whether k eigenvalues are above the lower bound
 * @return RITZ_ERR_MEMORY
 * @cost  some 30 n width^2 operations, or 10 if the bound is a close one
 */
ritz_status ritz_band_kth(const ritz_band *T, int64_t k, double *theta,
                          bool *exists);

/**
 * A vector of length one for an eigenvalue of T near @p theta, by two inverse
 * iterations.
 *
 * @param[out] z  n numbers, a mixture of eigenvectors where several have
 *                eigenvalues as near to theta
 * @return RITZ_ERR_MEMORY
 * @cost  6 n width^2 operations, and 4 n width numbers
 */
ritz_status ritz_band_vector(const ritz_band *T, double theta, double *z);

#endif
