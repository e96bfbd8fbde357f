/* The elastic response of a body, free or held, to forces. */
#ifndef RITZ_BASES_ELASTIC_H
#define RITZ_BASES_ELASTIC_H

#include <ritz/matrix.h>
#include <ritz/model.h>

/*
 * The elastic static response to forces, by one factorization. Of a body that
 * is held there are K, M and L alone.
 */
typedef struct ritz_elastic {
    const ritz_sparse *K, *M; /* borrowed */
    ritz_dense Phi;           /* rigid modes, n x r, M-orthonormal */
    ritz_dense MPhi;          /* M Phi */
    double *residual;         /* r, of the rigid modes as ritz_pairs has it */
    ritz_dofs held, rest;     /* a determinate support, and all others */
    ritz_factor *L;           /* of K at `rest`; NULL where that is nothing */
} ritz_elastic;

/**
 * Find the rigid modes, choose a support and factor K at the other dofs.
 *
 * @return RITZ_ERR_SINGULAR if K has a negative eigenvalue, or K + M is
 *         singular; RITZ_ERR_CONVERGENCE
 * @cost   the rigid modes, which an inertia count proves, and a CHOLMOD factor
 */
ritz_status ritz_elastic_new(const ritz_sparse *K, const ritz_sparse *M,
                             ritz_elastic *out);

/**
 * F := P F, P = I - M Phi Phi': the forces less those that cause rigid motion.
 */
ritz_status ritz_elastic_forces(const ritz_elastic *E, ritz_dense *F);

/**
 * X := P' S P X, S the flexibility on any determinate support: the response
 * that is M-orthogonal to rigid motion. Without rigid modes it is K^-1 X.
 *
 * @param[in] A  factor of K - sigma M, for X := P' A^-1 P X; NULL: at 0 Hz
 */
ritz_status ritz_elastic_respond(const ritz_elastic *E, ritz_ldl *A,
                                 ritz_dense *X);

void ritz_elastic_free(ritz_elastic *E);

#endif
