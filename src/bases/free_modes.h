/* Free-interface modes, and residual modes for some loads. */
#ifndef RITZ_BASES_FREE_MODES_H
#define RITZ_BASES_FREE_MODES_H

#include <ritz/basis.h>

typedef struct ritz_free_set {
    ritz_pairs modes;  /* that are kept, rigid ones first */
    int loads;         /* RITZ_LOADS_..., of the columns below */
    ritz_dense F, Psi; /* n x p, loads and residual modes; {0}: no load */
    int64_t *dof;      /* p, row of an attached dof, -1 of other loads */
    bool *keep;        /* p, false: dependent, or negligible (tolerance) */
    int64_t kept;      /* how many columns of Psi are */
} ritz_free_set;

/**
 * The lowest modes as the request says, and residual modes of the loads, M- and
 * K-orthogonal to the kept modes.
 *
 * @param[in] loads  RITZ_LOADS_...; that there is none of them is no failure
 * @return RITZ_ERR_ARGUMENT, RITZ_ERR_SINGULAR, RITZ_ERR_CONVERGENCE
 * @cost   of residual modes one factor, 3 to 10 solves a column
 */
ritz_status ritz_free_set_find(const ritz_request *request, int loads,
                               ritz_free_set *out);

/**
 * T = [rigid, normal, Psi]; the Psi columns have a kind, and the remark names
 * those left out.
 */
ritz_status ritz_free_set_join(const ritz_request *request,
                               const ritz_free_set *set, ritz_column_kind kind,
                               ritz_basis *out);

/** Both steps: the basis of modes and of residual columns of a kind. */
ritz_status ritz_free_basis(const ritz_request *request, int loads,
                            ritz_column_kind kind, ritz_basis *out);

void ritz_free_set_free(ritz_free_set *set);

#endif
