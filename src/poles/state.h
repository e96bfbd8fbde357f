/*
 * First-order form of a dense model whose damped poles are wanted.
 *
 * With K Phi = M Phi Lambda, Phi'M Phi = I and, where M is singular, N spanning
 * its null space with N'KN = I and Phi'KN = 0, the model in u = Phi p + N a is
 *
 *     p'' + D_pp p' + D_pa a' + L p = 0,    D_ap p' + D_aa a' + a = 0
 *
 * with L = Lambda + i K4_pp. Of N only what D acts on is kept, as the rest of a
 * is 0. In
 *
 *     y = [W p; p'; a],    W = |Lambda|^1/2, or 1 where Lambda is 0,
 *
 *     y' = [  0         W                         0            ] y
 *          [ -L W^-1   -(D_pp - D_pa F)   D_pa D_aa^-1         ]
 *          [  0        -F                 -D_aa^-1             ]
 *
 * F = D_aa^-1 D_ap. Scaled by W, slow poles are not lost beside fast ones.
 * Rigid motions that nothing damps are left out: a double pole at 0 is
 * defective, and rounding would scatter it [TisseurMeerbergen2001].
 */
#ifndef RITZ_POLES_STATE_H
#define RITZ_POLES_STATE_H

#include <ritz/response.h>

#include <stdbool.h>

typedef struct ritz_state {
    int64_t m, k;     /* modes p; massless coordinates a */
    int64_t num_free; /* rigid motions left out */
    double *lambda;   /* m, 0 where rigid */
    ritz_dense X;     /* n x (m + k), columns of Phi and N */
    ritz_dense D;     /* (m + k) x (m + k) */
    ritz_dense K4;    /* m x m, or {0} */
    bool diagonal;    /* D couples nothing, and there is neither a nor K4 */
} ritz_state;

ritz_status ritz_state_new(const ritz_second_order *model,
                           const ritz_damping *damping, ritz_state *out);

/** The matrix of y', 2m + k square, without what K4 does. */
ritz_status ritz_state_matrix(const ritz_state *state, ritz_dense *out);

/** W of mode j. */
double ritz_state_weight(const ritz_state *state, int64_t j);

void ritz_state_free(ritz_state *state);

#endif
