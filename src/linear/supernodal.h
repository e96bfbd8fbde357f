/*
 * Triangular solves with a supernodal Cholesky factor L L' for blocks of 8 or
 * 16 right-hand sides, by several threads, about as fast as memory can be read.
 *
 * The columns of L are packed as tiles.h describes. The elimination tree is cut
 * into its top, which contains the roots, and the subtrees below it. Subtrees
 * do not depend on each other: each thread solves with some of them. What they
 * subtract from rows of the top a thread collects in a copy of its own, and the
 * copies are added. All threads work on each block column of the top, each on
 * some of its panels.
 */
#ifndef RITZ_LINEAR_SUPERNODAL_H
#define RITZ_LINEAR_SUPERNODAL_H

#include <ritz/base.h>

#include <suitesparse/cholmod.h>

typedef struct ritz_supernodal ritz_supernodal;

/** The largest width of a block of right-hand sides. */
enum { RITZ_SOLVE_WIDTH = 16 };

/**
 * Pack a factor of CHOLMOD. Its values are lost: their pages are returned to
 * the system as they are read, so that memory holds the factor about once.
 *
 * @param[in,out] L    supernodal, L L'; only cholmod_l_free_factor() may follow
 * @param[in]     sign diagonal of S from ritz_signed_cholesky(), for a factor
 *                     L S L'; copied; NULL: S = I
 * @param[out]    out  freed by ritz_supernodal_free()
 * @return RITZ_ERR_MEMORY; RITZ_ERR_ARGUMENT if L has 2^31 - 1 rows or more
 * @cost   memory of about the size of L
 */
ritz_status ritz_supernodal_new(cholmod_factor *L, const double *sign,
                                ritz_supernodal **out);

/**
 * x := (L S L')^-1 x for a block of @p width right-hand sides. The result has
 * the same bits in every run with the same number of threads.
 *
 * @param[in]     width  8 or 16
 * @param[in,out] x      n x width, row by row, rows in the order of L
 * @cost   L is read twice
 */
void ritz_supernodal_solve(ritz_supernodal *S, int64_t width, double *x);

/**
 * Write the values of L to a file by ritz_spill_put(); read them back, which the
 * caller must do before the next solve. Nothing is done if they are there
 * already.
 *
 * @return RITZ_ERR_FILE; the values then stay where they were
 */
ritz_status ritz_supernodal_spill(ritz_supernodal *S);
ritz_status ritz_supernodal_fetch(ritz_supernodal *S);

/** How many threads each solve uses: more for a larger factor. */
int ritz_supernodal_threads(const ritz_supernodal *S);

void ritz_supernodal_free(ritz_supernodal **S);

#endif
