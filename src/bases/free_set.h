/* Free-interface modes and the static response of what they leave out. */
#ifndef RITZ_BASES_FREE_SET_H
#define RITZ_BASES_FREE_SET_H

#include "bases/columns.h"

/*
 * Modes, and residual modes for some loads. Where other bodies act on the
 * attached dofs, these come first, and residual modes of all other loads are
 * K-orthogonal to theirs, so that the interface is what it would be without
 * them.
 */
typedef struct ritz_free_set {
    ritz_pairs modes;  /* that are kept, rigid ones first */
    int loads;         /* RITZ_LOADS_..., of the columns below */
    ritz_dense F, Psi; /* n x p, loads and residual modes; {0}: no load */
    int64_t interface; /* how many of the first are of the interface */
    int64_t *dof;      /* p, row of an attached dof, -1 of other loads */
    bool *keep;        /* p, false: dependent, or negligible (tolerance) */
    int64_t held;      /* how many columns of the interface are */
    int64_t kept;      /* how many of all columns of Psi are */
} ritz_free_set;

/**
 * The lowest modes as the request says, and residual modes of the loads, M- and
 * K-orthogonal to them.
 *
 * @param[in] loads   sum of RITZ_LOADS_...; none of them need be there
 * @param[in] joined  whether the attached dofs, which are then among the loads,
 *                    are an interface
 */
ritz_status ritz_free_set_new(const ritz_request *request, int loads,
                              bool joined, ritz_free_set *out);

/**
 * T = [rigid, normal, Psi]; the Psi columns of the interface are of @p kind,
 * others static, and the remark names those left out.
 */
ritz_status ritz_free_set_join(const ritz_request *request,
                               const ritz_free_set *set, ritz_column_kind kind,
                               ritz_basis *out);

/**
 * The same of modes that were found otherwise, and move over, all loads alike.
 *
 * @param[in] request  the component is that whose modes they are
 */
ritz_status ritz_free_set_beside(const ritz_request *request, int loads,
                                 ritz_pairs *modes, ritz_basis *out);

/**
 * Psi := Psi Psi_bb^-1, of residual modes of unit forces at the dofs b.
 *
 * @param[in] b  as many as Psi has columns
 * @return RITZ_ERR_SINGULAR
 */
ritz_status ritz_residual_divide(const int64_t *b, ritz_dense *Psi);

void ritz_free_set_free(ritz_free_set *set);

#endif
