/* States [d; v] of a damped structure, by coordinates in Krylov vectors. */
#ifndef RITZ_BASES_KRYLOV_STATES_H
#define RITZ_BASES_KRYLOV_STATES_H

#include "bases/krylov_block.h"

/* One chain of states. */
typedef struct ritz_krylov_states {
    const ritz_sparse *D;  /* borrowed; NULL: undamped */
    int64_t room;          /* rows of d in a state, as many as V can have */
    ritz_orthonormal kept; /* rows of d, then as many of v */
    int64_t first, count;  /* the last block of states */
    int64_t whole;         /* blocks of which V missed nothing */
    bool ended;            /* nothing new came of the last block */
} ritz_krylov_states;

/**
 * Begin a chain with the answers to forces at rest: d = P' S P G, v = 0.
 *
 * @param[in]     D  borrowed until free, NULL where there is none
 * @param[in,out] S  whose V takes what is new in d
 */
ritz_status ritz_krylov_states_start(ritz_krylov *S, const ritz_sparse *D,
                                     const ritz_forces *forces,
                                     ritz_krylov_states *out);

/**
 * One block more: d <- -omega P' S P (D d + omega M v), v <- d.
 *
 * @param[in] omega  unit of velocities  [rad/s]
 */
ritz_status ritz_krylov_states_advance(ritz_krylov *S, double omega,
                                       ritz_krylov_states *chain);

void ritz_krylov_states_free(ritz_krylov_states *chain);

#endif
