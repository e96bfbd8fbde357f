/* How many blocks a search by block Lanczos has room for, and what memory it
 * needs; ritz_block_lanczos_needs() is here, too. */
#ifndef RITZ_LINEAR_LANCZOS_ROOM_H
#define RITZ_LINEAR_LANCZOS_ROOM_H

#include "linear/block_lanczos.h"

enum {
    RITZ_LANCZOS_SPARES = 8, /* converged pairs returned in addition to the k
                                requested */
};

/** Blocks of eight that each step adds. */
int64_t ritz_lanczos_width(const ritz_lanczos_plan *plan);

/** Blocks of V for n rows, a multiple of the width. */
int64_t ritz_lanczos_blocks(const ritz_lanczos_plan *plan, int64_t n);

/** Blocks of the vectors that are found, about. */
int64_t ritz_lanczos_found(int64_t k);

/** Bytes that the iteration needs for a while: LAPACK's workspace for T, the
 * coefficients of vectors and of products by each thread, and two blocks. */
int64_t ritz_lanczos_meanwhile(int64_t n, int64_t k, int64_t room);

#endif
