/* Eigenvalues of a general real matrix, and how far rounding may move them. */
#ifndef RITZ_LINEAR_EIGENVALUES_H
#define RITZ_LINEAR_EIGENVALUES_H

#include <ritz/matrix.h>

typedef struct ritz_eigenvalues {
    int64_t count;
    double *re, *im;
    double *error; /* eps |A| / s, s the cosine between left and right
                      eigenvector: large where eigenvalues are defective */
    double radius; /* largest magnitude; 0 if there is none */
} ritz_eigenvalues;

/**
 * All eigenvalues, by magnitude ascending; of a pair the one with the positive
 * imaginary part first. A is balanced first (LAPACK dgeevx).
 *
 * @return RITZ_ERR_ARGUMENT if A is not square or not finite;
 *         RITZ_ERR_CONVERGENCE
 * @cost   about 25 n^3
 */
ritz_status ritz_eigenvalues_of(const ritz_dense *A, ritz_eigenvalues *out);

/**
 * Index of the eigenvalue that decides on stability: the rightmost of those
 * right of the imaginary axis by more than @p times their error; if there is
 * none, of those nearer to it; else of all. -1 if there are none.
 */
int64_t ritz_eigenvalues_worst(const ritz_eigenvalues *eigenvalues,
                               double times);

void ritz_eigenvalues_free(ritz_eigenvalues *eigenvalues);

#endif
