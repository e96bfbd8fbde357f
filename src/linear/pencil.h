/*
 * The sparse pencil A - s E of a linear system E x' = A x: products, factors at
 * points s, and the eigenvalues nearest to a point.
 */
#ifndef RITZ_LINEAR_PENCIL_H
#define RITZ_LINEAR_PENCIL_H

#include <ritz/matrix.h>

#include <stdbool.h>

typedef struct ritz_pencil {
    int64_t n;
    ritz_sparse A, E;   /* n x n; E is stored where it is the identity too */
    ritz_sparse At, Et; /* transposed; {0}: both are symmetric */
    bool plain;         /* E is the identity */
    ritz_zldl *F;       /* of A - s E */
    double _Complex s;
    bool factored;
} ritz_pencil;

/**
 * The pencil of some matrices, which are copied.
 *
 * @param[in] E  invertible; {0}: the identity
 */
ritz_status ritz_pencil_new(const ritz_sparse *A, const ritz_sparse *E,
                            ritz_pencil *out);

/** Whether A and E are symmetric. */
bool ritz_pencil_is_symmetric(const ritz_pencil *pencil);

/** A and E, or their transposes. */
const ritz_sparse *ritz_pencil_system(const ritz_pencil *pencil,
                                      bool transposed);
const ritz_sparse *ritz_pencil_descriptor(const ritz_pencil *pencil,
                                          bool transposed);

/**
 * Factor A - s E, unless that is what is factored.
 *
 * @return RITZ_ERR_SINGULAR if s is an eigenvalue to working accuracy
 * @cost   the pattern is analysed once, each s costs a complex factor
 */
ritz_status ritz_pencil_factor(ritz_pencil *pencil, double _Complex s);

/** X := (A - s E)^-1 X, or by the transposed matrix; n x k. */
ritz_status ritz_pencil_solve(ritz_pencil *pencil, bool transposed, int64_t k,
                              double _Complex *X);

/** Y := A X, n x k, of a sparse A; X and Y are not the same. */
void ritz_pencil_times(const ritz_sparse *A, int64_t k,
                       const double _Complex *X, double _Complex *Y);

/* Eigenvalues of a pencil near a point, that nearest first. */
typedef struct ritz_pencil_pairs {
    int64_t count;
    double _Complex *s;
    double _Complex *x; /* n x count, of length one */
    double *residual;   /* |A x - s E x| / | |A||x| + |s||E||x| | */
    char engine[RITZ_NAME_SIZE];
} ritz_pencil_pairs;

/**
 * The @p count eigenvalues nearest to @p shift, or all if there are fewer: by
 * LAPACK of small pencils, else by Arnoldi iterations on (A - shift E)^-1 E
 * (ARPACK). That none is missing between them is not proven.
 *
 * @return RITZ_ERR_SINGULAR if the shift is an eigenvalue;
 *         RITZ_ERR_CONVERGENCE if they are not found
 */
ritz_status ritz_pencil_nearest(ritz_pencil *pencil, double _Complex shift,
                                int64_t count, ritz_pencil_pairs *out);

void ritz_pencil_pairs_free(ritz_pencil_pairs *pairs);
void ritz_pencil_free(ritz_pencil *pencil);

#endif
