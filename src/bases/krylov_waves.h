/* Krylov sequences of a damped structure about a frequency, with complex
   states. */
#ifndef RITZ_BASES_KRYLOV_WAVES_H
#define RITZ_BASES_KRYLOV_WAVES_H

#include "bases/krylov.h"

/*
 * An expansion point s_0 = i omega with the factor of Z_0 = K + i K4 + s_0 D +
 * s_0^2 M. At 0 Hz a free body has no Z_0^-1; there the elastic response is
 * expanded, and the factor is that of K + i K4 without the rows of a
 * determinate support.
 */
typedef struct ritz_wave_point {
    const ritz_elastic *body; /* borrowed */
    const ritz_sparse *K4;    /* borrowed; NULL: none */
    double omega;
    bool relieved;          /* 0 Hz and a free body */
    ritz_sparse at_rest[2]; /* if relieved: K and K4 without the supported
                               dofs */
    ritz_zldl *Z;
} ritz_wave_point;

/**
 * @param[in] D  NULL: none; borrowed until free, as the other matrices are
 * @return RITZ_ERR_SINGULAR if the point is a pole
 */
ritz_status ritz_wave_point_new(const ritz_elastic *body, const ritz_sparse *D,
                                const ritz_sparse *K4, double hertz,
                                ritz_wave_point *out);

/*
 * One sequence of states [d; v] about a point. A state is stored by the
 * coordinates of d and v in the rigid modes and V, real and imaginary parts
 * separately, and is followed by i times itself: real combinations of both are
 * complex multiples of the state.
 */
typedef struct ritz_waves {
    ritz_wave_point *point; /* borrowed */
    const ritz_sparse *D;   /* borrowed; D, or D' if `transposed`; NULL: none */
    bool transposed;        /* solves with Z_0', for outputs */
    int64_t room;           /* rows of each of Re d, Im d, Re v, Im v */
    ritz_orthonormal kept;
    int64_t first, count; /* the last block, as columns of `kept` */
    int64_t whole;        /* blocks that are completely contained in V */
    bool ended;           /* the last block gave no new state */
} ritz_waves;

/**
 * Begin with d = Z_0^-1 F and v = 0. If the elastic response is expanded, D
 * Phi_r and K4 Phi_r join the loads, since they couple rigid motion to the
 * rest.
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
