/*
 * A linear model in first-order form:
 *
 *     E x' = A x + B u,    y = C x + D u
 *
 * with A and E either small and dense or sparse. For second-order models x =
 * [u; u'].
 */
#ifndef RITZ_STATE_SPACE_H
#define RITZ_STATE_SPACE_H

#include <ritz/reduced.h>

#include <stdbool.h>
#include <stdint.h>

#pragma GCC visibility push(default)

/* Most dofs of a component that is converted to a dense first-order model; a
   dense state space has at most twice as many states. */
enum { RITZ_STATE_DOFS = 1500 };

/* An imported state space with more states than this is kept sparse if at most
   a tenth of the entries of A and E are not zero. */
enum { RITZ_SPARSE_STATES = 600 };

typedef struct ritz_state_space {
    ritz_dense A, B, C, D; /* D is always there */
    ritz_dense E;          /* invertible; {0}: the identity */
    ritz_sparse sA, sE; /* sparse model: used instead of A and E, which are then
                           {0}; sE {0}: the identity. sA {0}: the model is
                           dense */
    int64_t num_inputs, num_outputs;
    char (*input)[RITZ_NAME_SIZE];
    char (*output)[RITZ_NAME_SIZE];
    double *limit;        /* num_outputs, largest tolerated |y|; NaN: none */
    ritz_columns columns; /* what each state is */
    ritz_origin origin;
    char damping[RITZ_DAMPING_SIZE]; /* that is in A, without D; "" none */
    ritz_measures estimates;         /* by ritz-reduce: stability, a bound */
    ritz_measures errors;            /* by ritz-verify */
    char units[RITZ_NAME_SIZE];
} ritz_state_space;

/** Zero matrices (E the identity), with the names and limits of @p io. */
ritz_status ritz_state_space_new(int64_t states, const ritz_io *io,
                                 ritz_state_space *out);

/** A state space of sparse A and E, which are copied; E {0}: the identity. */
ritz_status ritz_state_space_of_sparse(const ritz_sparse *A,
                                       const ritz_sparse *E, const ritz_io *io,
                                       ritz_state_space *out);

/** Number of states. */
int64_t ritz_state_space_order(const ritz_state_space *model);

/** Whether A and E are sparse. */
bool ritz_state_space_is_sparse(const ritz_state_space *model);

/**
 * The model with dense A and E: @p model itself if it is dense, else a dense
 * copy written to @p made, which the caller frees.
 *
 * @return RITZ_ERR_ARGUMENT if the model is sparse and has more than 2
 *         RITZ_STATE_DOFS states
 */
ritz_status ritz_state_space_dense(const ritz_state_space *model,
                                   ritz_state_space *made,
                                   const ritz_state_space **out);

/**
 * Whether all parts fit each other, values are finite and E, if there is one,
 * is not singular.
 *
 * @return RITZ_ERR_FORMAT if they do not; the sentence names the part
 */
ritz_status ritz_state_space_check(const ritz_state_space *model);

/**
 * A component with its damping: that of its matrices and dampers, and
 * @p damping in addition, ratios by all its modes, a M + b K exactly.
 *
 * x = [u; u'] where M is definite. Where it is not, x = [q; q'] of the modes
 * that have mass, and the static response of massless dofs is in D.
 *
 * @return RITZ_ERR_ARGUMENT if there are more than RITZ_STATE_DOFS dofs, if
 *         there is structural damping, which is of harmonic motion alone, or if
 *         a massless dof is damped, or driven and observed by its velocity;
 *         RITZ_ERR_SINGULAR if K + M is singular
 * @cost   O(n^3), n dofs
 */
ritz_status ritz_state_space_of_component(const ritz_component *component,
                                          const ritz_damping *damping,
                                          ritz_state_space *out);

/**
 * A component in a basis of states: with E = [I 0; 0 M] of its first-order form
 *
 *     W'E T x' = W'A T x + W'B u
 *
 * solved for x'. Massless dofs respond as above. Columns of kind perturbed
 * respond statically and are eliminated, and a bound of the error is noted as
 * estimate "h-infinity-bound".
 *
 * With more than RITZ_STATE_DOFS dofs no dense matrix of the component is
 * formed. Damping ratios then need basis->among_hz, and dofs without mass must
 * have no input.
 *
 * @param[in] basis  of states, W {0}: T itself
 * @return RITZ_ERR_ARGUMENT if it is no such basis, or sizes disagree, or as
 *         above; RITZ_ERR_SINGULAR if W'E T is singular, or the columns that
 *         are to be eliminated have no static response
 */
ritz_status ritz_reduce_states(const ritz_component *component,
                               const ritz_damping *damping,
                               const ritz_basis *basis, ritz_state_space *out);

/**
 * A state space in a basis of its states: W'E T z' = W'A T z + W'B u, y = C T z
 * + D u, solved for z'; columns of kind perturbed, and the bound, as above.
 *
 * @return RITZ_ERR_ARGUMENT if it is no such basis, or sizes disagree;
 *         RITZ_ERR_SINGULAR as above
 */
ritz_status ritz_reduce_space(const ritz_state_space *full,
                              const ritz_basis *basis, ritz_state_space *out);

/**
 * A component in a basis of displacements u = T q with left vectors W of its
 * own, in companion form x = [q; q'], which is still of second order:
 *
 *     A = [0 I; -M_r^-1 K_r, -M_r^-1 D_r],   B = [0; M_r^-1 W'B],
 *     M_r = W'M T,   K_r = W'K T,   D_r = W'D T
 *
 * K_r and D_r need not be symmetric, which is why this is no ritz_reduced.
 * Rigid columns, which must be M-orthogonal to all others, have no part in K_r.
 *
 * @return RITZ_ERR_ARGUMENT if the basis is of states, or has no W, or as
 *         ritz_reduce_states; RITZ_ERR_SINGULAR if M_r is singular
 */
ritz_status ritz_reduce_companion(const ritz_component *component,
                                  const ritz_damping *damping,
                                  const ritz_basis *basis,
                                  ritz_state_space *out);

/**
 * A reduced component in first-order form, with its estimates and errors. Its
 * dampers count as far as they are installed.
 *
 * @return as ritz_state_space_of_component
 */
ritz_status ritz_states_of_reduced(const ritz_reduced *reduced,
                                   const ritz_damping *damping,
                                   ritz_state_space *out);

/**
 * Poles: eigenvalues of A, or of E^-1 A, by magnitude ascending; of a pair the
 * one above the axis first. To be freed.
 *
 * @return RITZ_ERR_CONVERGENCE, or as ritz_state_space_dense
 */
ritz_status ritz_state_space_poles(const ritz_state_space *model,
                                   int64_t *count, double _Complex **out);

void ritz_state_space_free(ritz_state_space *model);

#pragma GCC visibility pop

#endif
