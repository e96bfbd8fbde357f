/*
 * A distributed pencil (K, M) and one factor K - sigma M = L D L' by MUMPS. The
 * pattern is analysed once; the factor of a new shift replaces the one before.
 * Pivoting allows any sigma, and by Sylvester's law of inertia D has as many
 * negative eigenvalues as the pencil has below sigma.
 */
#ifndef RITZ_LIBEXEC_SLEPC_PENCIL_H
#define RITZ_LIBEXEC_SLEPC_PENCIL_H

#include "factor.h"

#include <ritz/matrix.h>

#include <petscmat.h>

typedef struct rank_pencil {
    Mat K, M;       /* borrowed */
    rank_factor *F; /* of K - sigma M; NULL: none was made */
    double sigma;
    int64_t negative; /* eigenvalues below sigma, of the last factor made */
    double typical;   /* median of K_jj / M_jj, 1 if there is none */
    int64_t heavy;    /* columns of M that are not zero */
} rank_pencil;

/** Set `typical` and `heavy` from K and M; nothing is factored. Collective.
 * @return RITZ_ERR_SINGULAR if a diagonal entry of M is negative */
ritz_status rank_pencil_new(Mat K, Mat M, rank_pencil *out);

/** Factor K - sigma M. Collective.
 * @return as rank_factor_new() and rank_factor_make() */
ritz_status rank_pencil_factor(rank_pencil *p, double sigma);

/** The number of eigenvalues below sigma, by a factor that replaces the present
 * one. Collective.
 * @return as rank_pencil_factor() */
ritz_status rank_pencil_count(rank_pencil *p, double sigma, int64_t *out);

/** X := (K - sigma M)^-1 B for blocks with the rows of K; X is not B.
 * Collective.
 * @return as rank_factor_solve() */
ritz_status rank_pencil_solve(const rank_pencil *p, Mat B, Mat X);

/** x := (K - sigma M)^-1 b. Collective.
 * @return as rank_factor_solve() */
ritz_status rank_pencil_solve_vector(const rank_pencil *p, Vec b, Vec x);

void rank_pencil_free(rank_pencil *p);

#endif
