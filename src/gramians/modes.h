/* Gramians in modal coordinates, and the other engines of a component. */
#ifndef RITZ_GRAMIANS_MODES_H
#define RITZ_GRAMIANS_MODES_H

#include "model/modal.h"

#include <ritz/basis.h>

/**
 * RITZ_ERR_ARGUMENT if a limit of an output is not positive, or if @p what,
 * "component" say, has no inputs or no outputs.
 */
ritz_status ritz_ends_check(const char *what, int64_t inputs, int64_t outputs,
                            const double *limit,
                            const char (*output)[RITZ_NAME_SIZE]);

/** Divide the rows of C by the limits of the outputs that have one. */
void ritz_outputs_weigh(const double *limit, ritz_dense *C);

/** C', with the columns of outputs that have a limit divided by it. */
ritz_status ritz_outputs_scaled(const ritz_dense *C, const double *limit,
                                ritz_dense *out);

/**
 * Modal model of symmetric dense matrices or of a configuration in modal form.
 *
 * @param[in] D        may couple modes; modes may then lack damping of their
 *                     own
 * @param[in] damping  ratio of each mode, added to what D says on the diagonal
 * @return RITZ_ERR_ARGUMENT if a flexible mode has no damping
 */
ritz_status ritz_modal_new(const ritz_dense *K, const ritz_dense *M,
                           const ritz_dense *D, const ritz_io *io,
                           const ritz_damping *damping, ritz_modal *out);

/** Number of states: 2m, and one for the velocity of each rigid mode. */
int64_t ritz_modal_order(const ritz_modal *modal);

/**
 * Exact controllability and observability Gramians of the modal model in the
 * states (q_1, q_1', q_2, ...), 2m x 2m, closed form, O(m^2). Those of a band,
 *
 *     W_c = 1/pi Re int_{w1}^{w2} (i w - A)^-1 B B' (i w - A)^-* dw
 *
 * and W_o likewise, are semidefinite up to rounding; from 0 to infinity they
 * equal those over all frequencies. If damping couples modes, they come from
 * ritz_coupled_factors.
 *
 * @param[in] band_hz  ends of the band; HUGE_VAL is infinity; NULL: all
 *                     frequencies
 * @return RITZ_ERR_ARGUMENT if the band is invalid, a mode has no damping, or
 *         there is a band and damping couples modes
 */
ritz_status ritz_modal_gramians(const ritz_modal *modal, const double *band_hz,
                                ritz_dense *Wc, ritz_dense *Wo);

/**
 * Factors of both, W_c = Z_c Z_c' and W_o = Z_o Z_o', in the same states and of
 * as many columns as there is rank.
 *
 * @return RITZ_ERR_CONVERGENCE if one is indefinite beyond rounding
 */
ritz_status ritz_modal_factors(const ritz_modal *modal, const double *band_hz,
                               ritz_dense *Zc, ritz_dense *Zo);

/**
 * Exact Hankel singular values, descending: ritz_modal_order values, of which
 * the last are 0 if poles at 0 were removed. @cost O(m^3)
 */
ritz_status ritz_modal_hankel(const ritz_modal *modal, const double *band_hz,
                              double *sigma);

/**
 * Outputs as columns in the states of ritz_modal_gramians, without the outputs
 * of poles at 0, which grow with time.
 */
ritz_status ritz_modal_outputs(const ritz_modal *modal, ritz_dense *out);

void ritz_modal_free(ritz_modal *modal);

/** One past the last mode of the cluster that begins at mode @p first. */
int64_t ritz_modal_cluster(const ritz_modal *modal, int64_t first);

/**
 * Some modes of a model as a model of their own, with the damping between them.
 *
 * @param[in] taken  for each flexible mode of @p modal, whether it is taken
 * @param[in] rigid  for each rigid mode, whether it is taken; NULL: all are
 */
ritz_status ritz_modal_part(const ritz_modal *modal, const bool *taken,
                            const bool *rigid, ritz_modal *out);

/**
 * Damping between modes i and j relative to the root of the product of their
 * own; 0 where it is rounding of @p largest, the largest entry of Delta.
 */
double ritz_damping_between(const ritz_dense *Delta, double largest, int64_t i,
                            int64_t j);

/*
 * Modes that damping couples (coupled.c).
 */

/**
 * Clusters of modes to be ranked as one: flexible modes of one frequency, and
 * chains of flexible modes that damping couples by more than
 * RITZ_DAMPING_JOINS. A cluster that does not decay by itself is merged with
 * all modes that damping couples it to, rigid ones included.
 *
 * @param[out] cluster  m + r: the first mode of each mode's cluster; m for
 *                      rigid modes in no cluster
 * @return RITZ_ERR_ARGUMENT if a mode has no damping and no mode coupled to it
 *         damps it
 */
ritz_status ritz_coupled_clusters(const ritz_modal *modal, int64_t *cluster);

/**
 * Factors of both Gramians of the part that decays, in the states of
 * ritz_modal_gramians, with as many columns as that part has states.
 *
 * @return RITZ_ERR_ARGUMENT if a pole other than those at 0 is not left of the
 *         axis
 */
ritz_status ritz_coupled_factors(const ritz_modal *modal, ritz_dense *Zc,
                                 ritz_dense *Zo);

/** Hankel values of the part that decays, descending; @p sigma has room for
 * ritz_modal_order values. */
ritz_status ritz_coupled_hankel(const ritz_modal *modal, int64_t *count,
                                double *sigma);

/** ritz_modal_outputs of the part that decays. */
ritz_status ritz_coupled_outputs(const ritz_modal *modal, ritz_dense *out);

/** Refuse a mode without damping: RITZ_ERR_ARGUMENT. */
ritz_status ritz_refuse_undamped(double omega, double zeta);

/** Refuse damping that couples modes, naming the two modes that it couples
 * most: RITZ_ERR_ARGUMENT. */
ritz_status ritz_coupled_refuse(const ritz_modal *modal, const char *why);

/** ritz_modal_gramians and ritz_modal_factors over all frequencies. */
ritz_status ritz_modal_gramians_whole(const ritz_modal *modal, ritz_dense *Wc,
                                      ritz_dense *Wo);
ritz_status ritz_modal_factors_whole(const ritz_modal *modal, ritz_dense *Zc,
                                     ritz_dense *Zo);

/**
 * All modes of the component, or those up to the requested frequency, with all
 * damping; modes of one frequency are turned so that it couples none of them.
 *
 * @return RITZ_ERR_ARGUMENT if there are too many, or no flexible one
 */
ritz_status ritz_gramians_modes(const ritz_gramians_request *request,
                                ritz_modal_model *out);

/**
 * Modes of one frequency may be any basis of their space: turn them into one in
 * which damping is diagonal. MPhi may be {0}.
 */
ritz_status ritz_modes_turn(ritz_modal_model *modes);

/** Whether damping couples two modes, one of them at least flexible. */
bool ritz_modes_coupled(const ritz_modal_model *modes);

/**
 * The flexible modes, and rigid modes that damping couples to them.
 *
 * @param[in] io   for the limits of its outputs
 * @param[in] why  NULL: damping may couple modes; else it must not, and this
 *                 ends the sentence that refuses it
 * @return RITZ_ERR_ARGUMENT if damping couples modes and must not, a mode has
 *         no damping, or a limit is not positive
 */
ritz_status ritz_modal_of_modes(const ritz_modal_model *modes,
                                const ritz_io *io, const char *why,
                                ritz_modal *out);

/*
 * A component in well scaled states z = [S q; q'] of its modes, S = diag(w)
 * where w > 0: A is then nearly skew, and the size of a state is the root of
 * its energy. Rigid modes that no damping couples with others are decoupled:
 * they are no part of A, B and C.
 */
typedef struct ritz_states {
    ritz_modal_model modes;
    int64_t num_decoupled; /* rigid modes, the first ones */
    int64_t count;         /* of states in A */
    double *scale;         /* count / 2 */
    double alpha;          /* A is less alpha I  [rad/s] */
    ritz_dense A, B, C;
    char damping[RITZ_DAMPING_SIZE];
} ritz_states;

/**
 * @param[in] damping  in addition to the component's matrices and dampers
 * @param[in] alpha    A is less alpha I  [rad/s]
 * @return RITZ_ERR_ARGUMENT as ritz_state_space_of_component, or if there are
 *         only rigid modes
 */
ritz_status ritz_states_new(const ritz_component *component,
                            const ritz_damping *damping, double alpha,
                            ritz_states *out);

/**
 * A basis of x = [u; u']: the decoupled rigid modes, and then @p T and @p W of
 * z.
 *
 * @param[in] T,W  count x k, W'T = I
 */
ritz_status ritz_states_basis(const ritz_states *states, const ritz_dense *T,
                              const ritz_dense *W, ritz_basis *out);

void ritz_states_free(ritz_states *states);

/**
 * Factors of both Gramians of a large component by low-rank ADI from sparse M,
 * D, K; first-order matrices are never formed. Rigid modes are decoupled, dofs
 * without mass are condensed statically.
 *
 * @return RITZ_ERR_ARGUMENT if damping is no sparse matrix (ratios of modes,
 *         K4), there is none, it couples rigid motion to others or acts on
 *         dofs without mass; RITZ_ERR_CONVERGENCE if the Gramians have no low
 *         rank
 * @cost   a complex factor a shift, some 20 to 200 shifts; three factors of
 *         2 n x k numbers
 */
ritz_status ritz_gramians_low_rank(const ritz_gramians_request *request,
                                   ritz_gramians *out);

/**
 * Factors of both Gramians of a large component by projection on a Krylov space
 * of K^-1 M. The space grows until a bound of the error of every Hankel value
 * is below the tolerance times the largest value; the relative bound is `error`
 * of the result. Each Gramian alone is less accurate than the Hankel values.
 *
 * @return RITZ_ERR_ARGUMENT as ritz_gramians_low_rank(), or if D is not
 *         a M + b K apart from discrete dampers; RITZ_ERR_CONVERGENCE if the
 *         space would take more than RITZ_FACTOR_BYTES or exceed
 *         request->most vectors
 * @cost   a factor of K, its two lowest modes, and mostly 100 to 1000 vectors,
 *         each with a solve and an orthogonalisation
 */
ritz_status ritz_gramians_projection(const ritz_gramians_request *request,
                                     ritz_gramians *out);

/*
 * How 2m states are ordered and scaled that belong to m modes: all modes but
 * the first num_decoupled, which are rigid-body modes.
 */
typedef struct ritz_mode_states {
    const ritz_modal_model *modes;
    int64_t num_decoupled;
    int64_t step;        /* 1: all q before all q'; 2: each q before its q' */
    const double *scale; /* m, the states are S q and q', S = diag(scale);
                            NULL: S = I */
} ritz_mode_states;

/* By which matrix vectors of modal states are turned into vectors of
   x = [u; u'], with S = diag(scale) of ritz_mode_states. */
typedef enum ritz_lift_kind {
    RITZ_LIFT_RIGHT,   /* [Phi S^-1 0; 0 Phi], of Z_c and T */
    RITZ_LIFT_MOMENTA, /* [Phi S^-1 0; 0 M Phi], of E Z_c */
    RITZ_LIFT_LEFT,    /* [M Phi S 0; 0 Phi], of Z_o and W */
} ritz_lift_kind;

/**
 * Turn vectors Z of modal states into vectors of x = [u; u'].
 *
 * @param[in]  rigid  put the vectors of the decoupled rigid-body modes first,
 *                    those of positions and then those of velocities
 * @param[in]  Z      2m x k; without columns, any number of rows
 * @param[out] out    2n x k, or 2n x (2 num_decoupled + k) if @p rigid
 */
ritz_status ritz_states_lift(const ritz_mode_states *states,
                             ritz_lift_kind kind, bool rigid,
                             const ritz_dense *Z, ritz_dense *out);

/**
 * Turn factors of Gramians in modal states into those of x = [u; u'],
 *
 *     Z_c := [Phi S^-1 0; 0 Phi] Z_c,    Z_o := [M Phi S 0; 0 Phi] Z_o
 *
 * and T and W likewise, with those of the decoupled rigid-body modes first. The
 * factors in modal states are kept as gramians->core, from which Hankel values
 * are computed. If states->modes has no modes but the decoupled ones, Z_c and
 * Z_o get no columns.
 *
 * @param[in,out] gramians  Zc, Zo, T and W in modal states; EZc is set
 */
ritz_status ritz_gramians_lift(const ritz_mode_states *states,
                               ritz_gramians *gramians);

#endif
