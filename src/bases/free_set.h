/* Free-interface modes and residual attachment modes, which are the static
   response of the modes that are left out. */
#ifndef RITZ_BASES_FREE_SET_H
#define RITZ_BASES_FREE_SET_H

#include "bases/columns.h"

/*
 * Modes, and residual modes for some loads. If the attached dofs are an
 * interface to other bodies, their residual modes come first, and residual
 * modes of all other loads are K-orthogonal to them: the interface then has the
 * same stiffness with and without the others.
 */
typedef struct ritz_free_set {
    ritz_pairs modes;  /* the modes that are kept, rigid ones first */
    int loads;         /* RITZ_LOADS_... that the columns below belong to */
    ritz_dense F, Psi; /* n x p, loads and their residual modes; {0}: no
                          loads */
    int64_t interface; /* number of leading columns that belong to the
                          interface */
    int64_t *dof;      /* p, row of the attached dof of a column; -1: other
                          load */
    bool *keep;        /* p, false: column is linearly dependent or
                          negligible */
    int64_t held;      /* number of interface columns that are kept */
    int64_t kept;      /* number of all columns of Psi that are kept */
} ritz_free_set;

/**
 * The lowest modes as the request says, and residual modes of the loads, M- and
 * K-orthogonal to them.
 *
 * @param[in] loads   sum of RITZ_LOADS_...; the component need not have any
 * @param[in] joined  whether the attached dofs, which are then among the loads,
 *                    are an interface
 */
ritz_status ritz_free_set_new(const ritz_request *request, int loads,
                              bool joined, ritz_free_set *out);

/**
 * T = [rigid, normal, Psi]; the Psi columns of the interface are of @p kind,
 * others are static, and the remark names the loads whose columns were left
 * out.
 */
ritz_status ritz_free_set_join(const ritz_request *request,
                               const ritz_free_set *set, ritz_column_kind kind,
                               ritz_basis *out);

/**
 * A basis of modes that were computed elsewhere, which are moved, and static
 * columns of residual modes for all loads.
 *
 * @param[in] request  its component is the one whose modes these are
 */
ritz_status ritz_free_set_beside(const ritz_request *request, int loads,
                                 ritz_pairs *modes, ritz_basis *out);

/**
 * Psi := Psi Psi_bb^-1 for residual modes of unit forces at the dofs b.
 *
 * @param[in] b  rows of Psi, as many as Psi has columns
 * @return RITZ_ERR_SINGULAR if Psi_bb is singular
 */
ritz_status ritz_residual_divide(const int64_t *b, ritz_dense *Psi);

/* As ritz_narrow, both from a basis of macneal-rubin without static columns. */
ritz_narrow ritz_macneal_rubin_narrow;
ritz_narrow ritz_rubin_narrow;

void ritz_free_set_free(ritz_free_set *set);

#endif
