/* Point masses that have the inertia invariants of a body. */
#ifndef RITZ_FORMATS_POINT_MASSES_H
#define RITZ_FORMATS_POINT_MASSES_H

#include "model/equations.h"

#include <ritz/model.h>

typedef struct ritz_point_masses {
    int64_t count;
    int64_t num_negative; /* the last points, whose mass is negative */
    double *mass;         /* count */
    ritz_dense field;     /* count x (3 + 3m): x, y, z; in column 3 + a m + j
                             the translation along axis a in mode j */
    double least; /* smallest eigenvalue of the products over the largest */
} ritz_point_masses;

/**
 * Find point masses that have the invariants of a body with m modes: its mass,
 * static moment and inertia and, with positions x and modes psi, the sums over
 * points
 *
 *     sum m psi_j,   sum m x psi_j',   sum m psi_j psi_k'
 *
 * There are at most 4 + 3m points, two more if some masses are negative.
 *
 * @param[in] M  m x m, modal masses on its diagonal, by which modes are scaled
 * @return RITZ_ERR_CONVERGENCE if LAPACK finds no eigenvalues
 * @cost   O(m^3), 27 m^2 doubles
 */
ritz_status ritz_point_masses_of(const ritz_inertia *inertia,
                                 const ritz_invariants *invariants,
                                 const ritz_dense *M, ritz_point_masses *out);
void ritz_point_masses_free(ritz_point_masses *points);

#endif
