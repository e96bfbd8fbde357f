/*
 * Inertia terms that simulators need for a body that deforms in a moving frame.
 * They are made from the inertia invariants of its modes.
 *
 * A point of the body at x, from the origin of the frame, moves by u = sum_k
 * u_k q_k. Let v~ w = v x w, let j, k, l number the m modes and a, b the axes,
 * and let integrals be over the mass of the body:
 *
 *     S_k  = int u_k                h_k  = int x x u_k
 *     c_jk = int u_j x u_k          P_jk = int u_j u_k'
 *     N_k  = int x~ u_k~'    = int (x . u_k) I - u_k x'
 *     N_jk = int u_j~ u_k~'  = tr(P_jk) I - P_jk'
 *
 * Mass, inertia, S_k and h_k follow from all of M and are exact. c_jk, P_jk and
 * N_k are as exact as `position` and `product` of ritz_invariants, except that
 * the antisymmetric part of N_k is computed from h_k,
 *
 *     N_k - N_k' = -h_k~,
 *
 * because the equations of motion conserve momentum only if this holds.
 *
 * Matrices are column-major. In a column number such as 3 (j m + k) + b the
 * last index, b, runs fastest.
 */
#ifndef RITZ_MODEL_INERTIA_TERMS_H
#define RITZ_MODEL_INERTIA_TERMS_H

#include <ritz/model.h>

/*
 * MBDyn's invariants [MBDynTecman2023, Invariants]. MBDyn adds terms of the
 * nodes' inertia J_i and rotations V to them; here the integrals over mass that
 * moves by u + V x r already contain these terms, in I4, I6, I7 and I8.
 * Therefore I10 and I11, which consist of V and J_i alone, are zero.
 */
typedef struct ritz_mbdyn_terms {
    double I1;     /* mass */
    double I2[3];  /* int x, the mass times its centre */
    ritz_dense I3; /* 3 x m, column k: S_k */
    ritz_dense I4; /* 3 x m, column k: h_k */
    ritz_dense I5; /* 3 x m m, column j m + k: c_jk */
    ritz_dense I6; /* m x m, M_r */
    double I7[9];  /* int x~ x~', inertia about the origin, symmetric */
    ritz_dense I8; /* 3 x 3m, columns 3 k + b: N_k = int x~ u_k~' */
    ritz_dense I9; /* 3 x 3 m m, columns 3 (j m + k) + b: int u_j~ u_k~,
                      which is -N_jk */
} ritz_mbdyn_terms;

/**
 * @param[in] invariants  of the m modes, about the basic origin
 * @param[in] M           m x m, of the modes
 * @param[in] origin      of the frame, in the basic frame, whose axes it has
 * @return RITZ_ERR_ARGUMENT if there are no invariants, M has another size, or
 *         the body has no mass
 * @cost   O(m^2), as much memory as the invariants
 */
ritz_status ritz_mbdyn_terms_of(const ritz_invariants *invariants,
                                const ritz_dense *M,
                                const double origin[static 3],
                                ritz_mbdyn_terms *out);

void ritz_mbdyn_terms_free(ritz_mbdyn_terms *terms);

/*
 * A matrix that depends on the deformation: its value is m0 + sum_k q_k m1_k.
 * With c columns of m0, columns k c ... k c + c - 1 of m1 are m1_k: the term
 * that SID calls m1(i, k, j), from 1, is m1(i - 1, (k - 1) c + j - 1) here.
 */
typedef struct ritz_taylor {
    ritz_dense m0;
    ritz_dense m1; /* {0}: it does not depend on q */
} ritz_taylor;

/*
 * Terms of SID [Wallrapp1994] without geometric stiffening. With w the angular
 * velocity of the frame and a the acceleration of its origin, along its axes,
 *
 *     m a     + mdCM~' w' + Ct' q'' + ...                        = f
 *     mdCM~ a + J w'      + Cr' q'' + Gr(q') w + w~ J w          = t
 *     Ct a    + Cr w'     + Me q''  + Ge(q') w + Oe W + De q' + Ke q = f_q
 *
 * where Gr(q') = sum_k q'_k Gr_k, the same of Ge, and W = [w_1^2 w_2^2 w_3^2
 * w_1 w_2, w_2 w_3, w_1 w_3]'. With e_a a unit vector:
 *
 *     mdCM     int x               + sum_k q_k S_k
 *     J        int x~ x~'          + sum_k q_k (N_k + N_k')
 *     Ct(l,:)  S_l'
 *     Cr(l,:)  h_l'                + sum_k q_k c_kl'
 *     Gr_l     2 N_l               + sum_k q_k 2 N_kl
 *     Ge_k(l,:)  2 c_kl'
 *     Oe(l,:)  o(N_l)              + sum_k q_k o(N_kl)
 *
 * with o(N) = -[N_11 N_22 N_33, N_12 + N_21, N_23 + N_32, N_13 + N_31].
 */
typedef struct ritz_sid_terms {
    double mass;
    ritz_taylor mdCM; /* 3 x 1; m1 3 x m */
    ritz_taylor J;    /* 6 x 1, xx yy zz xy xz yz; m1 6 x m */
    ritz_taylor Ct;   /* m x 3; m1 {0}, which geometric stiffness fills */
    ritz_taylor Cr;   /* m x 3; m1 m x 3m */
    ritz_taylor Me;   /* m x m, M_r; m1 {0} */
    ritz_taylor Gr;   /* 3 x 3m, columns 3 l + b; m1 3 x 3m m */
    ritz_taylor Ge;   /* m x 3m, columns 3 k + a; m1 {0} */
    ritz_taylor Oe;   /* m x 6, as W; m1 m x 6m */
} ritz_sid_terms;

/** As ritz_mbdyn_terms_of. */
ritz_status ritz_sid_terms_of(const ritz_invariants *invariants,
                              const ritz_dense *M,
                              const double origin[static 3],
                              ritz_sid_terms *out);

void ritz_sid_terms_free(ritz_sid_terms *terms);

/*
 * The largest part of the kinetic energy of a mode that is missing in the
 * products of invariants. With P_aa the blocks (a m + j, a m + k) of
 * `product`, a = 1 to 3,
 *
 *     loss = max_phi |phi'(M - sum_a P_aa) phi| / phi'M phi
 *
 * over the modes phi of (K, M). It is rounding where the invariants are exact.
 */
typedef struct ritz_inertia_loss {
    double value; /* 0 if there is no mode */
    int64_t mode; /* number of that mode, from 0 in the order of eigenvalues */
} ritz_inertia_loss;

/**
 * @param[in] K, M  m x m, of the m columns that the invariants are of; a
 *                  direction without mass is no mode
 * @return RITZ_ERR_ARGUMENT if there are no invariants or sizes disagree, or as
 *         ritz_eigen_dense
 * @cost   O(m^3)
 */
ritz_status ritz_inertia_loss_of(const ritz_invariants *invariants,
                                 const ritz_dense *K, const ritz_dense *M,
                                 ritz_inertia_loss *out);

#endif
