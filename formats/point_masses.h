/* Point masses that have the inertia invariants of a body. */
#ifndef RITZ_FORMATS_POINT_MASSES_H
#define RITZ_FORMATS_POINT_MASSES_H

#include "model/equations.h"

#include <ritz/model.h>

typedef struct ritz_point_masses {
    int64_t count;
    int64_t num_negative; /* of them with a negative mass, the last ones */
    double *mass;         /* count */
    ritz_dense field;     /* count x (3 + 3m): x, y, z; in column 3 + a m + j
                             the translation along axis a in mode j */
    double least; /* least eigenvalue of the products, over the largest */
} ritz_point_masses;

/**
 * Few points p whose sums over masses are the invariants of a body of m modes:
 * mass, static moment, inertia, and with positions x and modes psi
 *
 *     sum m psi_j,   sum m x psi_j',   sum m psi_j psi_k'
 *
 * There are 4 + 3m at most, two more if some must be negative.
 *
 * @param[in] M  m x m, whose diagonal is the size of each mode
 * @return RITZ_ERR_CONVERGENCE if LAPACK finds no eigenvalues
 * @cost   O(m^3), 27 m^2 doubles
 */
ritz_status ritz_point_masses_of(const ritz_inertia *inertia,
                                 const ritz_invariants *invariants,
                                 const ritz_dense *M, ritz_point_masses *out);
void ritz_point_masses_free(ritz_point_masses *points);

#endif
