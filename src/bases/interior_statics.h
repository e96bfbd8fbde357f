/*
 * Static vectors of other loads, mainly of dampers [ChuMilman1992]: the
 * response of the interior with a fixed boundary, without its part in the
 * modes,
 *
 *     X = K_ii^-1 F_i,   X := X - Phi Phi'M_ii X
 *
 * [0; X] is K-orthogonal to the constraint modes and the normal modes. Together
 * they contain the static response to F for any motion of the boundary.
 */
#ifndef RITZ_BASES_INTERIOR_STATICS_H
#define RITZ_BASES_INTERIOR_STATICS_H

#include "bases/partition.h"

typedef struct ritz_interior_statics {
    int loads;       /* sum of RITZ_LOADS_... */
    ritz_dense F, X; /* interior rows; {0}: no load */
    double *least;   /* F_j'X_j, the energy of response j, below which it is
                        rounding */
    bool *keep;
    int64_t kept;
} ritz_interior_statics;

void ritz_interior_statics_free(ritz_interior_statics *a);

/** Interior rows of the requested loads other than attached dofs. @param[in]
 * usual  kinds of loads, if none are requested */
ritz_status ritz_interior_statics_collect(const ritz_request *request,
                                          const ritz_partition *s, int usual,
                                          ritz_interior_statics *out);

/** X before its part in the modes is removed. @param[in] L  the factor of K_ii;
 * NULL: there is no interior */
ritz_status ritz_interior_statics_respond(const ritz_request *request,
                                          ritz_factor *L,
                                          ritz_interior_statics *a);

/** Basis of boundary columns, Phi and labelled static vectors. */
ritz_status ritz_interior_statics_join(const ritz_request *request,
                                       const ritz_partition *s,
                                       const ritz_dense *Phi,
                                       ritz_interior_statics *a,
                                       ritz_basis *out);

#endif
