/*
 * Bases for the states of E x' = A x + B u, y = C x that span responses at
 * points of the complex plane.
 */
#ifndef RITZ_BASES_SPACE_H
#define RITZ_BASES_SPACE_H

#include "linear/orthonormal.h"
#include "model/space.h"

#include <ritz/basis.h>

/* What block Krylov vectors of one side are made from. */
typedef struct ritz_space_span {
    ritz_pencil *pencil; /* borrowed */
    bool left;           /* solves with the transposed matrices */
    const ritz_dense *F; /* n x m right-hand sides; borrowed */
    int64_t most;        /* largest number of columns */
    int64_t blocks;      /* largest number of blocks at a point; 0: no limit */
    double tolerance;    /* relative size below which a column is linearly
                            dependent */
} ritz_space_span;

/**
 * Orthonormal real columns that span
 *
 *     (A - s E)^-1 F,   (A - s E)^-1 E (A - s E)^-1 F,   ...
 *
 * at every point s, with an equal number from each point. A vector at a complex
 * point gives two columns.
 *
 * @param[out] out    n x k, k <= most
 * @param[out] whole  number of whole blocks at each point; NULL: not wanted
 * @return RITZ_ERR_SINGULAR if a point is a pole
 * @cost   a complex factorisation for each point, a solve for each column
 */
ritz_status ritz_space_krylov(const ritz_space_span *span, int64_t count,
                              const double _Complex *point, ritz_dense *out,
                              int64_t *whole);

/**
 * Refuse what no basis of a state space supports: a frequency limit, no
 * vectors, or words of the choice other than those that @p uses names.
 */
ritz_status ritz_space_request(const ritz_request *request, int uses);

/** Refuse a request that does not give a number of states. */
ritz_status ritz_states_asked(const ritz_request *request);

/** Basis of states from @p T and @p W, which are moved; W {0}: W = T. */
ritz_status ritz_space_basis(const ritz_state_space *model, ritz_dense *T,
                             ritz_dense *W, ritz_basis *out);

/** Cut both sides to the number of columns of the narrower one. */
void ritz_space_pair(ritz_dense *T, ritz_dense *W);

/** The method krylov for a state space. */
ritz_status ritz_krylov_of_space(const ritz_request *request, ritz_basis *out);

/** The method tangential for a state space: first-order IRKA. */
ritz_status ritz_tangential_of_space(const ritz_request *request,
                                     ritz_basis *out);

#endif
