/*
 * The space on which a component is projected, and the vectors that span its
 * residuals.
 *
 * V = [Phi X]: modes, and X with Phi'M X = 0, X'A X = I, A = K + tau M being
 * definite. With P = I - Phi Phi'M and Galerkin's V'r = 0 a residual has no
 * part along the modes,
 *
 *     r = P'(b - Z V q) = W y,
 *     W = P'[B, C', Cv', Ca', K X, M X, D V, D'V, K4 V],
 *
 * and its size |r|^2 = r^H A^-1 r = y^H G y costs nothing of length n once G =
 * W'S, S = A^-1 W is known; nor does a correction of the space, A^-1 r = S y.
 */
#ifndef RITZ_RESPONSE_KRYLOV_SPACE_H
#define RITZ_RESPONSE_KRYLOV_SPACE_H

#include "response/direct.h"

/* Kind of a column of W. */
typedef enum ritz_krylov_kind {
    RITZ_KRYLOV_B,
    RITZ_KRYLOV_C,
    RITZ_KRYLOV_CV,
    RITZ_KRYLOV_CA,
    RITZ_KRYLOV_K,
    RITZ_KRYLOV_M,
    RITZ_KRYLOV_D,
    RITZ_KRYLOV_DT, /* where D is not symmetric */
    RITZ_KRYLOV_K4,
} ritz_krylov_kind;

typedef struct ritz_krylov_column {
    ritz_krylov_kind kind;
    int64_t index; /* of the input or output, or of the column of V */
} ritz_krylov_column;

typedef struct ritz_krylov_space {
    const ritz_component *component; /* borrowed, as modes are */
    const ritz_dense *Phi, *MPhi;
    ritz_sparse A;
    ritz_factor *F; /* of A */
    ritz_sparse DT; /* D', {0} if D is symmetric */
    double tau;
    ritz_dense V;               /* n x r, with room for V_room */
    ritz_dense W, S;            /* n x w, with room for W_room */
    ritz_dense G;               /* w x w, W'S */
    ritz_krylov_column *column; /* w */
    int64_t V_room, W_room, S_room, column_room;
} ritz_krylov_space;

/**
 * The space of Phi alone, with the load vectors in W. @param[in] tau  above 0
 * [rad^2/s^2]
 */
ritz_status ritz_krylov_space_new(const ritz_direct *direct, double tau,
                                  ritz_krylov_space *out);

/**
 * Append the independent part of some vectors; *added counts its columns. G is
 * computed again.
 *
 * @param[in,out] X  n x k, destroyed
 */
ritz_status ritz_krylov_space_add(ritz_krylov_space *space, ritz_dense *X,
                                  int64_t *added);

void ritz_krylov_space_free(ritz_krylov_space *space);

/*
 * A component projected on a Krylov space, solved at one frequency at a time.
 */
typedef struct ritz_krylov_small {
    ritz_poles poles;      /* V'Z V q = V'B in modal coordinates */
    ritz_dense outputs_of; /* C', Cv', Ca': loads of its transpose */
    ritz_dense T;          /* r x r: from modal coordinates to V's */
    double _Complex *x;    /* q and p, r x inputs and r x outputs */
    double _Complex *z;    /* r x (inputs + 3 outputs), to work in */
} ritz_krylov_small;

/**
 * Project; given damping ratios act on the modes alone, a M + b K on all
 * coordinates.
 */
ritz_status ritz_krylov_small_new(const ritz_direct *direct,
                                  const ritz_krylov_space *space,
                                  ritz_krylov_small *out);

/**
 * Solve for q and p in coordinates of V at one frequency. @return
 * RITZ_ERR_SINGULAR at an undamped pole
 */
ritz_status ritz_krylov_small_solve(ritz_krylov_small *small, double hertz);

/**
 * y of residual @p index, of inputs and then of outputs, from the q and p of
 * the last solution.
 */
void ritz_krylov_residual(const ritz_direct *direct,
                          const ritz_krylov_space *space,
                          const ritz_krylov_small *small, double hertz,
                          int64_t index, double _Complex *y);

/** sqrt(y^H G y). */
double ritz_krylov_space_norm(const ritz_krylov_space *space,
                              const double _Complex *y);

void ritz_krylov_small_free(ritz_krylov_small *small);

#endif
