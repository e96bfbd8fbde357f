/*
 * All modes of a dense second-order model, its damping, inputs and outputs, in
 * modal coordinates:
 *
 *     q'' + Delta q' + Lambda q = B u,    y = C q + Cv q' + feed u
 */
#ifndef RITZ_MODEL_MODAL_H
#define RITZ_MODEL_MODAL_H

#include <ritz/matrix.h>
#include <ritz/model.h>

/* K, M and D with dampers installed; D {0}: none. */
typedef struct ritz_structure {
    ritz_dense K, M, D;
} ritz_structure;

/** @return RITZ_ERR_ARGUMENT if it is too large or has structural damping */
ritz_status ritz_structure_of_component(const ritz_component *component,
                                        ritz_structure *out);
/** Structural damping is left out. */
ritz_status ritz_structure_of_reduced(const ritz_reduced *reduced,
                                      ritz_structure *out);
/** RITZ_ERR_ARGUMENT, and its sentence, if there is structural damping. */
ritz_status ritz_structure_refuse(bool structural);

/**
 * Sparse K and D with dampers installed and D := D + a M + b K; D {0}: none.
 *
 * @param[in] rayleigh  a and b; NULL or of kind NONE: no more damping
 */
ritz_status ritz_structure_sparse(const ritz_component *component,
                                  const ritz_damping *rayleigh, ritz_sparse *K,
                                  ritz_sparse *D);

void ritz_structure_free(ritz_structure *model);

typedef struct ritz_modal_model {
    int64_t num_dofs, count; /* n, m: modes that have mass, rigid ones first */
    int64_t num_rigid;
    ritz_dense Phi, MPhi; /* n x m */
    double *lambda;       /* m, 0 where rigid  [rad^2/s^2] */
    ritz_dense Delta;     /* m x m, all damping */
    ritz_dense B;         /* m x inputs */
    ritz_dense C, Cv;     /* outputs x m, accelerations written out */
    ritz_dense Ca;        /* outputs x m, before accelerations were expressed by
                             displacements and velocities */
    ritz_dense feed;      /* outputs x inputs */
} ritz_modal_model;

/**
 * With neither inputs nor outputs it is made for its poles alone, and what
 * damps massless dofs is left out.
 *
 * @return RITZ_ERR_ARGUMENT if a massless dof is damped, or driven and observed
 *         by its velocity or acceleration; RITZ_ERR_SINGULAR if K + M is
 */
ritz_status ritz_modal_model_new(const ritz_structure *model, const ritz_io *io,
                                 const ritz_damping *damping,
                                 ritz_modal_model *out);

/**
 * The last steps of that, with modes found otherwise, which may be some of all:
 * @p damping goes into Delta ({0}: no other), inputs and outputs are projected.
 * The response of massless dofs is left out.
 *
 * @param[in,out] modes  with Phi, lambda, Delta and counts
 */
ritz_status ritz_modal_model_drive(const ritz_io *io,
                                   const ritz_damping *damping,
                                   ritz_modal_model *modes);

/**
 * Modes that were found otherwise: Phi and lambda move over, 0 where rigid.
 *
 * @param[in] num_dofs  rows of Phi
 */
void ritz_modal_model_take(ritz_pairs *pairs, int64_t num_dofs,
                           ritz_modal_model *out);

void ritz_modal_model_free(ritz_modal_model *model);

/**
 * phi'D phi that stated damping means for a mode: 2 zeta w of ratios, which
 * rigid motion does not have, or a + b lambda of a M + b K, which it has.
 *
 * @param[in] damping   NULL: 0
 * @param[in] flexible  number among the flexible modes; negative: rigid
 */
double ritz_modal_rate(const ritz_damping *damping, int64_t flexible,
                       double lambda);

/**
 * D += what stated damping is as a matrix: a M + b K, or of ratios
 * M Phi diag(2 zeta w) Phi'M.
 *
 * @param[in,out] D  {0}: zeros, and stays {0} if there is no damping
 */
ritz_status ritz_modal_damping(const ritz_structure *model,
                               const ritz_damping *damping, ritz_dense *D);

/**
 * W'E T, W'A T, W'B and the outputs of T, of a component of any size whose M
 * is definite or neither drives nor is driven where it is not:
 *
 *     W'E T = W_q'T_q + W_v'M T_v,   W'A T = W_q'T_v - W_v'(K T_q + D T_v)
 *
 * @param[in,out] out  of as many states as T has columns; A and B are then
 *                     W'A T and W'B
 * @param[out]    E    W'E T
 * @return RITZ_ERR_ARGUMENT if damping needs modes that there are too many of
 */
ritz_status ritz_states_project(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_basis *basis, ritz_state_space *out,
                                ritz_dense *E);

/**
 * x := E^-1 x, E = W'E T, then columns as the basis names them: those of kind
 * perturbed are eliminated, and the bound that comes with Hankel values is
 * noted.
 *
 * @return RITZ_ERR_SINGULAR if E is, or what is to be eliminated has no static
 *         response
 */
ritz_status ritz_states_settle(const ritz_basis *basis, const ritz_dense *E,
                               ritz_state_space *model);

/** Number of rigid modes if Delta couples none of them with a flexible mode;
 * else 0. */
int64_t ritz_modal_decoupled(const ritz_modal_model *modes);

/** |lambda|^1/2, or 1 where lambda is 0: it makes states well scaled. */
double ritz_modal_scale(double lambda);

/* Which states stand for a modal model. */
typedef struct ritz_modal_layout {
    int64_t first;       /* the first mode that has a state q' */
    int64_t position;    /* the first mode that has a state q, not below */
    const double *scale; /* S, from mode `first` on; NULL: ritz_modal_scale */
} ritz_modal_layout;

/**
 * The model in states [S q; q'],
 *
 *     A = [0 S; -Lambda S^-1 -Delta],   B = [0; B],   C = [C S^-1 Cv]
 *
 * Scaled so, slow poles keep their digits where there are fast ones.
 *
 * @param[out] B,C  NULL: not wanted
 */
ritz_status ritz_modal_states(const ritz_modal_model *modes,
                              const ritz_modal_layout *layout, ritz_dense *A,
                              ritz_dense *B, ritz_dense *C);

#endif
