/*
 * One factor of K - sigma M, by MUMPS, which is made again for other shifts: the
 * pattern is analysed once, and the factor of one shift takes the place of that
 * of another. L D L' with pivots, as counts need it; Sylvester's law of inertia
 * gives the number of eigenvalues below sigma with each factor.
 */
#ifndef RITZ_LIBEXEC_SLEPC_PENCIL_H
#define RITZ_LIBEXEC_SLEPC_PENCIL_H

#include <ritz/matrix.h>

#include <petscmat.h>

typedef struct rank_pencil {
    Mat K, M; /* borrowed */
    Mat A;    /* K - sigma M, with the pattern of both */
    Mat F;    /* its factor */
    int room; /* percent that MUMPS allocates over what it foresees */
    double sigma;
    int64_t negative; /* eigenvalues below sigma, if the factor was made */
    double typical;   /* median of K_jj / M_jj, 1 if there is none */
    int64_t heavy;    /* columns of M that are not zero */
} rank_pencil;

/** Survey K and M. Collective. */
ritz_status rank_pencil_new(Mat K, Mat M, rank_pencil *out);

/**
 * Factor K - sigma M. Collective.
 *
 * @return RITZ_ERR_SINGULAR if a pivot is rounding; RITZ_ERR_MEMORY
 */
ritz_status rank_pencil_factor(rank_pencil *p, double sigma);

/** X := (K - sigma M)^-1 B, dense matrices with the rows of K; both may be the
 * same. Collective. */
void rank_pencil_solve(const rank_pencil *p, Mat B, Mat X);

/** x := (K - sigma M)^-1 b. Collective. */
void rank_pencil_solve_vector(const rank_pencil *p, Vec b, Vec x);

void rank_pencil_free(rank_pencil *p);

#endif
