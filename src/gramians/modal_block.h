/*
 * The equation that both Gramians of a modal model are made of, in states of
 * energy (w q, q'), positions of all modes before their velocities:
 *
 *     A_k = [0 w_k; -w_k -d_k],  d = 2 zeta w,    A X + X A' + F F' = 0
 *
 * Observability is the same equation, for J A J = A' with J = diag(1, -1):
 * its F is J C' and its X is J W_o J.
 */
#ifndef RITZ_GRAMIANS_MODAL_BLOCK_H
#define RITZ_GRAMIANS_MODAL_BLOCK_H

#include <ritz/modal.h>

typedef struct ritz_energy {
    int64_t count;   /* m */
    double *w, *d;   /* m */
    ritz_dense F[2]; /* 2m x inputs, 2m x outputs: B and J C' */
} ritz_energy;

/** @return RITZ_ERR_ARGUMENT if a mode has no damping or no stiffness */
ritz_status ritz_energy_new(const ritz_modal *modal, ritz_energy *out);

/**
 * Blocks X_ij of A_i X_ij + X_ij A_j' + G_ij = 0 for modes i = 0 .. upto - 1
 * and one mode j.
 *
 * @param[in]  G  columns of position j and of velocity j, 2m each
 * @param[out] X  the same columns of X
 * @cost   O(upto)
 */
void ritz_energy_blocks(const ritz_energy *model, int64_t j, int64_t upto,
                        const double *const G[static 2],
                        double *const X[static 2]);

/** Z of X = Z Z', 2m x rank (modal_factors.c). @cost O(m^2 inputs) */
ritz_status ritz_energy_factor(const ritz_energy *model, const ritz_dense *F,
                               ritz_dense *out);

void ritz_energy_free(ritz_energy *model);

#endif
