/*
 * Gramians, Hankel singular values and balancing. With
 *
 *     A W_c E' + E W_c A' + B B' = 0,    A' W_o E + E' W_o A + C' C = 0,
 *
 * W_c = Z_c Z_c' and W_o = Z_o Z_o', the Hankel values are the singular values
 * of Z_o' E Z_c. Only the factors are ever formed. Outputs that have a limit
 * are divided by it, so that values of different quantities can be compared.
 *
 * Three engines give them:
 *
 *     dense     of first-order form, by SLICOT; any damping; O(n^3)
 *     modal     closed form in modal coordinates; modal damping; O(m^2)
 *     low-rank  ADI on sparse M, D, K; damping that lets Gramians decay
 *
 * [Moore1981], [Hammarling1982]
 */
#ifndef RITZ_GRAMIANS_H
#define RITZ_GRAMIANS_H

#include <ritz/choice.h>
#include <ritz/component.h>
#include <ritz/state_space.h>

#pragma GCC visibility push(default)

/*
 * Of n states: those of a state space, or x = [u; u'] of a component, for which
 * n is twice its dofs and E = [I 0; 0 M].
 */
typedef struct ritz_gramians {
    ritz_dense Zc;      /* n x k */
    ritz_dense EZc;     /* n x k; {0}: E is the identity */
    ritz_dense Zo;      /* n x l */
    ritz_dense T, W;    /* n x a, W'E T = I: what belongs to poles that are not
                        left of the axis (rigid modes: positions and then
                        velocities). It has no Gramian and stands apart */
    double residual[2]; /* of either equation, |R| / |B B'| and |R| / |C' C|,
                           where iterated; 0: exact to rounding */
    char engine[RITZ_NAME_SIZE];     /* "SLICOT SB03OD", "closed form", "ADI" */
    char damping[RITZ_DAMPING_SIZE]; /* of a component, that was used */
} ritz_gramians;

/*
 * The order of a truncation and its bound: with sigma_1 .. sigma_m and r kept,
 * the H-infinity norm of the error is at most 2 sum_{k > r} sigma_k, each value
 * that repeats counted once.
 */
typedef struct ritz_balanced {
    int64_t count;   /* m Hankel values, of which rounding leaves these */
    double *sigma;   /* m, descending */
    int64_t kept;    /* r */
    ritz_dense T, W; /* n x r, W'E T = I, of the kept ones, best first */
    double bound;    /* 2 sum of the rest; rank decisions are not in it */
} ritz_balanced;

/**
 * Dense, of a state space, E or not. Poles that are right of the axis, or left
 * of it by no more than eight times their rounding, stand apart; those of a
 * model of which rounding provably makes none unstable do not. E that is
 * symmetric and definite is reduced by its Cholesky factor (SLICOT SB03OD),
 * another one is kept (SG03BD).
 *
 * @return RITZ_ERR_ARGUMENT if it has no states, no inputs or no outputs, or a
 *         limit is not positive; RITZ_ERR_FORMAT as ritz_state_space_check;
 *         RITZ_ERR_CONVERGENCE if poles that must be told apart are too close
 * @cost   some 60 n^3, a third where A and E are symmetric, thrice with SG03BD
 * @see    [Hammarling1982], [Penzl1998]
 */
ritz_status ritz_gramians_of_space(const ritz_state_space *model,
                                   ritz_gramians *out);

/* What is asked of a component's Gramians. */
typedef struct ritz_gramians_request {
    const ritz_component *component; /* borrowed */
    ritz_damping damping;            /* beside its matrices and dampers */
    ritz_engine engine;
    double among_hz;   /* modal: all modes up to here; 0: all there are */
    double band_hz[2]; /* modal: over this band alone; 0, 0: all frequencies */
    double tolerance;  /* low-rank: of the residual; 0: 1e-10 */
} ritz_gramians_request;

/**
 * Of a component, by the engine that is asked for. `auto` is: modal where all
 * modes can be had and D couples none, dense up to RITZ_STATE_DOFS, otherwise
 * low-rank.
 *
 * @return RITZ_ERR_ARGUMENT if it has no inputs or no outputs, or the engine
 *         does not fit it; RITZ_ERR_CONVERGENCE if low rank is not low
 */
ritz_status ritz_gramians_of_component(const ritz_gramians_request *request,
                                       ritz_gramians *out);

/**
 * Hankel values, to be freed, descending: singular values of Z_o' E Z_c, small
 * ones as accurate as the factors are; 0 stands for what is below eps^2 of the
 * largest.
 *
 * @see [Drmac1998]
 */
ritz_status ritz_gramians_hankel(const ritz_gramians *gramians, int64_t *count,
                                 double **sigma);

/**
 * Balance by square roots: Z_o'E Z_c = U S V', T = Z_c V S^-1/2,
 * W = Z_o U S^-1/2, cut to @p order, or where values fall below @p tolerance of
 * the largest, whichever is less (order -1: all). Equal values (relative gap
 * below 1e-6) are kept or dropped whole: the cut moves down. Values below
 * max(k, l) eps of the largest, and those whose directions rounding has taken,
 * are never kept nor counted.
 *
 * [Moore1981], [Tombs1987]
 */
ritz_status ritz_gramians_balance(const ritz_gramians *gramians, int64_t order,
                                  double tolerance, ritz_balanced *out);

/**
 * 2 sum of sigma_k, k = kept.., each value that repeats (relative gap below
 * 1e-9: no error tells such from equal ones) counted once.
 */
double ritz_hankel_bound(int64_t count, const double *sigma, int64_t kept);

void ritz_gramians_free(ritz_gramians *gramians);
void ritz_balanced_free(ritz_balanced *balanced);

#pragma GCC visibility pop

#endif
