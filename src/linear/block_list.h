/*
 * A list of blocks of eight vectors, as blocks.h has them, whose last ones are
 * in a file if memory does not hold all. Products read the blocks of the file
 * two at a time. Each sum has its terms in the same order wherever a block is,
 * so that results have the same bits.
 */
#ifndef RITZ_LINEAR_BLOCK_LIST_H
#define RITZ_LINEAR_BLOCK_LIST_H

#include "base/spill.h"
#include "linear/blocks.h"

enum { RITZ_BLOCK_WINDOW = 2 }; /* blocks of the file in memory at a time */

typedef struct ritz_block_list {
    int64_t n;     /* rows of a block */
    int64_t count; /* room for blocks */
    double **at;   /* each block in memory; NULL: it is empty, or in the file */
    int64_t held;  /* blocks from this one on are in the file */
    ritz_spill file; /* {0}: there is none, and held = count */
    double *window;  /* RITZ_BLOCK_WINDOW blocks, if there is a file */
} ritz_block_list;

/**
 * @param[in]  count  room for blocks; none is allocated before it is put
 * @param[out] out    freed by ritz_block_list_free()
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_block_list_new(int64_t n, int64_t count, ritz_block_list *out);

void ritz_block_list_free(ritz_block_list *V);

/**
 * From now on blocks from @p held on are put into a file. None has been put yet.
 *
 * @return RITZ_ERR_MEMORY, also if the file cannot be opened
 */
ritz_status ritz_block_list_limit(ritz_block_list *V, int64_t held);

/**
 * Block @p j becomes @p *W. A block in memory that is exchanged with W instead
 * of being copied leaves an array of the same size in *W.
 *
 * @param[in] exchange  whether *W is allocated alone, so that it may be
 * @return RITZ_ERR_MEMORY, also if the file fails
 */
ritz_status ritz_block_list_put(ritz_block_list *V, int64_t j, bool exchange,
                                double **W);

/** Block @p to becomes block @p from, which is void then.
 * @return RITZ_ERR_MEMORY, also if the file fails */
ritz_status ritz_block_list_move(ritz_block_list *V, int64_t from, int64_t to);

/** The address of block @p j, in memory until the next call that reads the
 * file. @return RITZ_ERR_MEMORY if the file fails */
ritz_status ritz_block_list_look(const ritz_block_list *V, int64_t j,
                                 const double **out);

/** Free the memory of the blocks from @p kept on. */
void ritz_block_list_shorten(ritz_block_list *V, int64_t kept);

/** ritz_blocks_project() for the blocks [first, first + count) of the list.
 * @return RITZ_ERR_MEMORY if the file fails */
ritz_status ritz_block_list_project(const ritz_block_list *V,
                                    const ritz_blocks *on, int64_t first,
                                    int64_t count, int64_t width,
                                    const double *X, double *C);

/** ritz_blocks_add() for the same blocks.
 * @return RITZ_ERR_MEMORY if the file fails */
ritz_status ritz_block_list_add(const ritz_block_list *V, const ritz_blocks *on,
                                int64_t first, int64_t count, int64_t width,
                                const double *C, double *X);

/** ritz_blocks_combine() of the list.
 * @return RITZ_ERR_MEMORY if the file fails */
ritz_status ritz_block_list_combine(const ritz_block_list *V,
                                    const ritz_blocks *on, int64_t count,
                                    int64_t kept, int64_t stride,
                                    const double *C, double *room);

#endif
