/*
 * The sparse pencil A - s E of a linear system E x' = A x: products,
 * factorisations at points s, and the eigenvalues nearest to a point.
 */
#ifndef RITZ_LINEAR_PENCIL_H
#define RITZ_LINEAR_PENCIL_H

#include <ritz/matrix.h>

#include <stdbool.h>

typedef struct ritz_pencil {
    int64_t n;
    ritz_sparse A, E;   /* n x n; E is stored even if it is the identity */
    ritz_sparse At, Et; /* transposes; {0}: A and E are both symmetric */
    bool plain;         /* E is the identity */
    ritz_zldl *F;       /* factor of A - s E at the last point */
    double _Complex s;
    bool factored;
} ritz_pencil;

/**
 * The pencil of A and E, which are copied.
 *
 * @param[in] E  invertible; {0}: the identity
 */
ritz_status ritz_pencil_new(const ritz_sparse *A, const ritz_sparse *E,
                            ritz_pencil *out);

/** Whether A and E are symmetric. */
bool ritz_pencil_is_symmetric(const ritz_pencil *pencil);

/** A, or its transpose; E, or its transpose. */
const ritz_sparse *ritz_pencil_system(const ritz_pencil *pencil,
                                      bool transposed);
const ritz_sparse *ritz_pencil_descriptor(const ritz_pencil *pencil,
                                          bool transposed);

/** |y|'(|A| + w |E|)|x| for magnitudes @p x and @p y of n entries: eps times
 * this bounds the rounding of y'(A - w E) x. */
double ritz_pencil_magnitude(const ritz_pencil *pencil, double w,
                             const double *x, const double *y);

/**
 * Factor A - s E, unless it is factored at the same s already.
 *
 * @return RITZ_ERR_SINGULAR if s is an eigenvalue to working accuracy
 * @cost   one analysis of the pattern, and a complex factorisation for each s
 */
ritz_status ritz_pencil_factor(ritz_pencil *pencil, double _Complex s);

/** X := (A - s E)^-1 X with the last factor, or (A - s E)^-T X if @p
 * transposed; X is n x k. */
ritz_status ritz_pencil_solve(ritz_pencil *pencil, bool transposed, int64_t k,
                              double _Complex *X);

/** Y := A X with a sparse A and n x k matrices; X and Y must not overlap. */
void ritz_pencil_times(const ritz_sparse *A, int64_t k,
                       const double _Complex *X, double _Complex *Y);

/* Eigenvalues of a pencil near a point, nearest first. */
typedef struct ritz_pencil_pairs {
    int64_t count;
    double _Complex *s;
    double _Complex *x; /* n x count, of unit length */
    double *residual;   /* |A x - s E x| / | |A||x| + |s||E||x| | */
    char engine[RITZ_NAME_SIZE];
} ritz_pencil_pairs;

/**
 * The @p count eigenvalues nearest to @p shift, or all if there are fewer: by
 * LAPACK for small pencils, else by Arnoldi iterations on (A - shift E)^-1 E
 * (ARPACK). It is not proven that no nearer one is missing.
 *
 * @return RITZ_ERR_SINGULAR if the shift is an eigenvalue; RITZ_ERR_CONVERGENCE
 *         if the iterations do not converge
 */
ritz_status ritz_pencil_nearest(ritz_pencil *pencil, double _Complex shift,
                                int64_t count, ritz_pencil_pairs *out);

void ritz_pencil_pairs_free(ritz_pencil_pairs *pairs);
void ritz_pencil_free(ritz_pencil *pencil);

#endif
