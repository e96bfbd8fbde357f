/* C (z P - A)^-1 B at many points z. */
#ifndef RITZ_LINEAR_RESOLVENT_H
#define RITZ_LINEAR_RESOLVENT_H

#include <ritz/matrix.h>

#include <stdbool.h>

/*
 * The transfer function of a linear system at many points,
 *
 *     C (z P - A)^-1 B
 *
 * A and P are transformed to complex upper triangular matrices once,
 *
 *     Q^H A Z = S,    Q^H P Z = P_z,    B := Q^H B,    C := C Z
 *
 * after which a point costs a triangular solve for each column of B.
 */
typedef struct ritz_resolvent {
    int n, m, p;            /* states, inputs, outputs */
    double _Complex *S, *P; /* n x n, upper triangles; P NULL: the identity */
    double _Complex *B, *C; /* n x m, p x n, transformed */
    double _Complex *T, *X; /* n x n, n x m: work space, for one thread at a
                               time */
    int *top;               /* for each column, the first row in which S or P is
                               not 0; for a diagonal entry only, its own row */
} ritz_resolvent;

/**
 * @param[in] P  {0}: the identity
 * @return RITZ_ERR_CONVERGENCE if the eigenvalues are not found
 * @cost   25 n^3 complex operations, 66 n^3 with P; n^2 if A is
 *         quasi-triangular and P triangular, as in a Schur form
 */
ritz_status ritz_resolvent_new(const ritz_dense *A, const ritz_dense *P,
                               const ritz_dense *B, const ritz_dense *C,
                               ritz_resolvent *out);

/** Eigenvalue k of A x = s P x. */
double _Complex ritz_resolvent_pole(const ritz_resolvent *resolvent, int64_t k);

/**
 * H += C (z P - A)^-1 B, p x m, column-major.
 *
 * @return false, without a change of H, if a pole is closer to z than @p near
 *         |z|
 * @cost   O(n^2 m)
 */
bool ritz_resolvent_add(ritz_resolvent *resolvent, double _Complex z,
                        double near, double _Complex *H);

/**
 * H += C (z P - A)^-1 B at @p count points, none of which is a pole; H holds p
 * x m values, column-major, for each point.
 *
 * @return RITZ_ERR_MEMORY
 * @cost   as ritz_resolvent_add at each point, but in matrix products
 */
ritz_status ritz_resolvent_many(const ritz_resolvent *resolvent, int64_t count,
                                const double _Complex *z, double _Complex *H);

/**
 * Frobenius norms of (z P - A)^-1 B and C (z P - A)^-1.
 *
 * @param[in] z  must not be a pole
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_resolvent_sides(ritz_resolvent *resolvent, double _Complex z,
                                 double *right, double *left);

void ritz_resolvent_free(ritz_resolvent *resolvent);

#endif
