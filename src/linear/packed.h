/* A packed factor, between the file that packs it (packed.c) and the one that
   solves with it (supernodal.c). */
#ifndef RITZ_LINEAR_PACKED_H
#define RITZ_LINEAR_PACKED_H

#include "base/spill.h"
#include "linear/supernodal.h"
#include "linear/tiles.h"

/* The work and workspace of one thread. */
typedef struct ritz_solve_crew {
    int64_t num_blocks;
    int64_t *block; /* block columns of its subtrees, ascending */
    double *top;    /* rows of the top: forward, what its subtrees subtract from
                       them; backward, its copy of their solution */
    double *z, *rest; /* rows of one block column */
    double *sum[2];   /* the same; other threads read them, too */
} ritz_solve_crew;

struct ritz_supernodal {
    int64_t n;
    const ritz_tiles *tiles;
    int threads;
    int64_t num_blocks;
    ritz_block_column *block;
    int32_t *row;
    double *values; /* 64-byte aligned */
    size_t bytes;
    bool packed;      /* they are set, and their memory counts as in use */
    ritz_spill spill; /* the values; {0}: they are in memory */
    double *sign;     /* of each pivot, NULL: all positive */
    int64_t num_top;  /* number of rows of the top */
    int32_t *top_row; /* num_top rows of L, ascending */
    double *top;      /* their right-hand sides, then their solutions */
    int64_t num_shared;
    int64_t *shared; /* block columns of the top, ascending */
    ritz_solve_crew *crew;
};

/** Panels of eight rows that so many rows take. */
static inline int64_t ritz_panels_of(int64_t rows)
{
    return (rows + RITZ_TILE - 1) / RITZ_TILE;
}

/**
 * Pack L into *S, whose n, tiles, threads and sign are set.
 *
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_supernodal_pack(const cholmod_factor *L, ritz_supernodal *S);

#endif
