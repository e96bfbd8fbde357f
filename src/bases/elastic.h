/* The deformation of a body under forces, without the rigid motion that they
   cause. */
#ifndef RITZ_BASES_ELASTIC_H
#define RITZ_BASES_ELASTIC_H

#include <ritz/matrix.h>
#include <ritz/parts.h>

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
 * @param[in] known  modes of K and M, all rigid ones among them; NULL: they are
 *                   computed
 * @return RITZ_ERR_SINGULAR if K has a negative eigenvalue, or K + M is
 *         singular; RITZ_ERR_CONVERGENCE
 * @cost   the rigid modes, which an inertia count proves, and a CHOLMOD factor
 */
ritz_status ritz_elastic_new(const ritz_sparse *K, const ritz_sparse *M,
                             const ritz_pairs *known, ritz_elastic *out);

void ritz_elastic_free(ritz_elastic *E);

/** F := P F: the forces less those that cause rigid motion. */
ritz_status ritz_elastic_relieve(const ritz_elastic *E, ritz_dense *F);

/**
 * X := P' S P X, without rigid modes K^-1 X; with a factor of A = K - sigma M
 * P' A^-1 P X.
 *
 * @param[in] A  NULL: no factor of K - sigma M
 */
ritz_status ritz_elastic_respond(const ritz_elastic *E, ritz_ldl *A,
                                 ritz_dense *X);

#endif
