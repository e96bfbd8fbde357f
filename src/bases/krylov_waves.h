/* Krylov sequences of a damped structure about a frequency: complex states. */
#ifndef RITZ_BASES_KRYLOV_WAVES_H
#define RITZ_BASES_KRYLOV_WAVES_H

#include "bases/krylov.h"

/*
 * A point s_0 = i omega and the factor of Z_0 = K + i K4 + s_0 D + s_0^2 M. At
 * rest, of a free body, that of K + i K4 at the dofs that do not support it:
 * then the elastic part is expanded.
 */
typedef struct ritz_wave_point {
    const ritz_elastic *body; /* borrowed */
    const ritz_sparse *K4;    /* borrowed; NULL: none */
    double omega;
    bool relieved;          /* at rest, of a free body */
    ritz_sparse at_rest[2]; /* K and K4 of the dofs that are not held, then */
    ritz_zldl *Z;
} ritz_wave_point;

/**
 * @param[in] D  NULL: none; borrowed until free, as all others
 * @return RITZ_ERR_SINGULAR if the point is a pole
 */
ritz_status ritz_wave_point_new(const ritz_elastic *body, const ritz_sparse *D,
                                const ritz_sparse *K4, double hertz,
                                ritz_wave_point *out);

/*
 * One sequence of states [d; v] about a point. A state is kept by the
 * coordinates of d and v in the rigid modes and V, real parts and imaginary
 * ones, and beside it i times the state: real combinations of both are the
 * complex multiples of one.
 */
typedef struct ritz_waves {
    ritz_wave_point *point; /* borrowed */
    const ritz_sparse *D;   /* borrowed; D, or D' if `transposed`; NULL: none */
    bool transposed;        /* of Z_0', for outputs */
    int64_t room;           /* rows of Re d in a state, and so on */
    ritz_orthonormal kept;
    int64_t first, count; /* the last block: columns of kept */
    int64_t whole;        /* blocks of which V missed nothing */
    bool ended;           /* nothing new came of the last block */
} ritz_waves;

/**
 * Begin with the response to the loads F, v = 0, and the coupling to rigid
 * motion where the elastic part is expanded.
 */
ritz_status ritz_waves_start(ritz_krylov *S, const ritz_dense *F,
                             ritz_waves *waves);

/**
 * Append a block: d <- -omega Z_0^-1 ((2 s_0 M + D) d + omega M v), v <- d.
 *
 * @param[in] unit  omega, the unit of s - s_0  [rad/s]
 */
ritz_status ritz_waves_advance(ritz_krylov *S, double unit, ritz_waves *waves);

void ritz_wave_point_free(ritz_wave_point *point);
void ritz_waves_free(ritz_waves *waves);

#endif
