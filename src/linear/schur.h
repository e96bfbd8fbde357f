/*
 * Schur form of a matrix, or of a pair, and how far rounding may move each
 * eigenvalue where it stands on the diagonal.
 */
#ifndef RITZ_LINEAR_SCHUR_H
#define RITZ_LINEAR_SCHUR_H

#include <ritz/matrix.h>

#include <stdbool.h>

/*
 * Q'A Z = S quasi-triangular, Q'E Z = T triangular. Without E: T is the
 * identity and Z is Q, both {0}.
 */
typedef struct ritz_schur {
    int64_t count;
    ritz_dense S, T, Q, Z;
    double *re, *im; /* eigenvalues, as on the diagonal */
    double *error;   /* first-order bound, as in eigenvalues.h */
} ritz_schur;

/**
 * @param[in] E  invertible; NULL or {0}: the identity
 * @return RITZ_ERR_SINGULAR if E is, to rounding; RITZ_ERR_CONVERGENCE
 * @cost   some 25 n^3, of a pair 60 n^3
 */
ritz_status ritz_schur_new(const ritz_dense *A, const ritz_dense *E,
                           ritz_schur *out);

/**
 * Reorder so that the chosen eigenvalues come first; pairs stay together.
 *
 * @param[in] first  count, of either of a pair
 * @param[out] moved how many they are
 * @return RITZ_ERR_CONVERGENCE if two are too close to change places
 */
ritz_status ritz_schur_order(ritz_schur *schur, const bool *first,
                             int64_t *moved);

void ritz_schur_free(ritz_schur *schur);

#endif
