/*
 * Bases of the states of E x' = A x + B u, y = C x that span responses at points
 * of the complex plane.
 */
#ifndef RITZ_BASES_SPACE_H
#define RITZ_BASES_SPACE_H

#include "linear/orthonormal.h"
#include "model/space.h"

#include <ritz/basis.h>

/* Points and what is solved for there: block Krylov vectors of one side. */
typedef struct ritz_space_span {
    ritz_pencil *pencil; /* borrowed */
    bool left;           /* by transposed matrices */
    const ritz_dense *F; /* n x m, the right-hand sides; borrowed */
    int64_t most;        /* columns that are wanted */
    int64_t blocks;      /* of a point, at most; 0: as many as are of use */
    double tolerance;    /* below which a column is dependent */
} ritz_space_span;

/**
 * Real columns, orthonormal, that span
 *
 *     (A - s E)^-1 F,   (A - s E)^-1 E (A - s E)^-1 F,   ...
 *
 * of every point s, as many from each point. A complex point costs two columns
 * for one.
 *
 * @param[out] out    n x k, k <= most
 * @param[out] whole  whole blocks of each point; NULL: not wanted
 * @return RITZ_ERR_SINGULAR if a point is a pole
 * @cost   a complex factor a point, a solve a column
 */
ritz_status ritz_space_krylov(const ritz_space_span *span, int64_t count,
                              const double _Complex *point, ritz_dense *out,
                              int64_t *whole);

/**
 * Refuse of a request what no basis of a state space heeds: a frequency, no
 * vectors, or words that @p uses does not name.
 */
ritz_status ritz_space_request(const ritz_request *request, int uses);

/** Refuse a request that does not ask for states by their number. */
ritz_status ritz_states_asked(const ritz_request *request);

/** Basis of states from @p T and @p W, which are taken; W {0}: T itself. */
ritz_status ritz_space_basis(const ritz_state_space *model, ritz_dense *T,
                             ritz_dense *W, ritz_basis *out);

/** Both sides cut to as many columns as the narrower one has. */
void ritz_space_pair(ritz_dense *T, ritz_dense *W);

/** krylov of a state space. */
ritz_status ritz_krylov_of_space(const ritz_request *request, ritz_basis *out);

/** tangential of a state space: first-order IRKA. */
ritz_status ritz_tangential_of_space(const ritz_request *request,
                                     ritz_basis *out);

#endif
