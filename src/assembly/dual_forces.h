/* Steps of a dual assembly: coordinates in which constraints are forces. */
#ifndef RITZ_ASSEMBLY_DUAL_FORCES_H
#define RITZ_ASSEMBLY_DUAL_FORCES_H

#include <ritz/synthesis.h>

/*
 * With the constraints C_q q + C_p p = 0 of modal coordinates q and force
 * coordinates p, x = [q; p] = X [y; mu], and what the constraints add to
 * X'KX: see dual_forces.c.
 */
typedef struct ritz_dual {
    int64_t rank;       /* of the constraints */
    ritz_dense X;       /* Q x (y + mu), scaled coordinates */
    ritz_dense joint;   /* (y + mu) square, symmetric */
    int64_t num_forces; /* mu, the last of the columns */
} ritz_dual;

/**
 * @param[in] K        Q x Q, of all bodies, scaled coordinates
 * @param[in] C        c x Q, the same
 * @param[in] is_force Q, which coordinates are p
 */
ritz_status ritz_dual_new(const ritz_dense *K, const ritz_dense *C,
                          const bool *is_force, ritz_dual *out);

void ritz_dual_free(ritz_dual *dual);

#endif
