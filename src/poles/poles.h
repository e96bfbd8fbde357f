/*
 * Some modes of a model with their participation in inputs and outputs, and the
 * response they make:
 *
 *     (Lambda - w^2 I + i w (d + D) + i K4) q = B u,
 *     y = (C + i w Cv - w^2 Ca) q
 */
#ifndef RITZ_POLES_POLES_H
#define RITZ_POLES_POLES_H

#include "base/complex.h"

#include <ritz/matrix.h>
#include <ritz/model.h>
#include <ritz/poles.h>
#include <ritz/response.h>

/* Components of up to this many dofs have all their modes computed if damping
   ratios act on them, by a dense eigenproblem of at most a minute. For larger
   ones Ritz vectors replace the modes that are not summed. */
enum { RITZ_RATIO_DOFS = 2000 };

/*
 * Response of the modes that were left out, damped by a M + b K: with K^+ the
 * inverse of K in the space of these modes, R_0 = K^+ B and R_j = K^+ M
 * R_(j-1),
 *
 *     X = sum_j mu^j R_j / (1 + i w b),    mu = (w^2 - i w a) / (1 + i w b)
 *
 * of which only the outputs are stored. A damping ratio gives mode k a rate d_k
 * in addition, which changes the mode's term 1 / z by
 *
 *     1 / (z + i w d) - 1 / z = -i w d / (z (z + i w d)),
 *     z = lambda (1 + i w b) + i w a - w^2
 *
 * This change is summed over all modes left out, or over the Ritz vectors of
 * ritz_ratio_space.
 */
typedef struct ritz_residual {
    int64_t count, num_outputs, num_inputs;
    int64_t num_damped; /* number of modes left out that have a rate, or of Ritz
                           vectors in their place */
    double *lambda, *rate;
    ritz_io modes;    /* inputs and outputs of these */
    double uncertain; /* error of the changes by ratios, relative to |H|; 0:
                         rounding */
    double a, b;
    bool known;      /* D acts on these modes by a and b alone, K4 not at all */
    double unit;     /* scale of mu: term j is stored times unit^j */
    double *part[3]; /* C, Cv and Ca: of each term j its C R_j, num_outputs
                            x num_inputs, as ritz_dense */
} ritz_residual;

typedef struct ritz_poles {
    int64_t count;
    int64_t num_rigid;
    int64_t massless;   /* coordinates behind the modes, without mass, K = I:
                           what D or K4 acts on of them; then coupled */
    double *lambda;     /* count, 0 where rigid  [rad^2/s^2]; 1 behind */
    double *rate;       /* count, 2 zeta w of given ratios and D's diagonal */
    bool coupled;       /* D or K4 couple modes: below are what to use */
    bool skew;          /* D is not symmetric */
    ritz_dense D;       /* count x count, with `rate` on its diagonal, or {0} */
    ritz_dense K4;      /* count x count, or {0} */
    ritz_dense L;       /* D - L L' is diagonal, L of few columns; {0}: there is
                           no such L, or K4 */
    ritz_io io;         /* for the modes */
    ritz_residual rest; /* response of motions without mass; {0}: none */
    double _Complex *q; /* count x num_inputs, to work in: one thread */
} ritz_poles;

/**
 * Modal coordinates at one frequency.
 *
 * @param[in]  transposed  of the transposed system
 * @param[in]  loads       count + massless rows
 * @param[out] q           as loads
 * @return RITZ_ERR_SINGULAR if that is on an undamped pole, or at 0 Hz where
 *         rigid modes are controllable and observable
 */
ritz_status ritz_poles_solve(const ritz_poles *poles, bool transposed,
                             const ritz_dense *loads, double hertz,
                             double _Complex *q);

/**
 * L of few columns for which D - L L' is rounding.
 *
 * @param[in]  D    m x m, symmetric
 * @param[out] out  m x p, p at most m / 3; {0}: there is no such L
 * @cost   O(m^2 p)
 */
ritz_status ritz_few_dampers(const ritz_dense *D, ritz_dense *out);

/**
 * ritz_poles_solve by L of the poles.
 *
 * @param[out] solved  false: the frequency is so near to that of a mode without
 *                     its dampers that too many digits would cancel
 * @cost   O(m p (p + inputs))
 */
ritz_status ritz_few_dampers_solve(const ritz_poles *poles,
                                   const ritz_dense *loads, double hertz,
                                   bool *solved, double _Complex *q);

/** The refusal of a frequency that is a pole, 0 Hz if @p rigid. */
ritz_status ritz_refuse_pole(bool rigid, double hertz);

/**
 * Whether mode k is controllable and observable: whether it adds to any
 * transfer function more than the rounding of all modes.
 */
bool ritz_poles_matter(const ritz_poles *poles, int64_t k);

/**
 * H += response of the modes and of motions without mass; num_outputs x
 * num_inputs, row by row.
 */
ritz_status ritz_poles_add(const ritz_poles *poles, double hertz,
                           double _Complex *H);

/**
 * The same at @p count frequencies, with the sum of each where ritz_poles_add
 * has one: H is num_outputs x num_inputs, row by row, of each frequency in turn.
 * Several threads may share the poles.
 */
ritz_status ritz_poles_add_all(const ritz_poles *poles, int64_t count,
                               const double *hertz, double _Complex *H);

/**
 * Roots of s^2 + rate s + lambda: a pair, the one above the axis first, or two
 * real ones without cancellation, the larger first.
 */
void ritz_poles_roots(double lambda, double rate, double _Complex s[static 2]);

/** Damping ratio of each mode, from its rate; 0 where rigid. */
ritz_status ritz_poles_ratios(const ritz_poles *poles, double **omega,
                              double **zeta);

void ritz_poles_free(ritz_poles *poles);

/**
 * Poles of all modes.
 *
 * @param[in] to_hz  highest frequency of interest; 0: not known
 * @return RITZ_ERR_ARGUMENT if an eigenvalue is negative beyond the rounding of
 *         the largest eigenvalue or of (2 pi to_hz)^2
 */
ritz_status ritz_poles_of_dense(const ritz_second_order *model,
                                const ritz_damping *damping, double to_hz,
                                ritz_poles *out);

/** ritz_poles_of_dense(), given the pairs of ritz_eigen_dense(K, M). */
ritz_status ritz_poles_of_modes(const ritz_second_order *model,
                                const ritz_damping *damping, double to_hz,
                                const ritz_pairs *pairs, ritz_poles *out);

/**
 * Poles of pairs that are known: all modes of finite frequency, `lambda` with
 * room for as many as there are coordinates.
 *
 * @param[in]     beside  whether motions without mass become coordinates even
 *                        where no damping acts on them
 * @param[in,out] pairs   gets their shapes behind those of its modes
 */
ritz_status ritz_poles_of_pairs(const ritz_second_order *model,
                                const ritz_damping *damping, bool beside,
                                ritz_pairs *pairs, ritz_poles *out);

/**
 * The magnitude that errors of each channel are relative to: the channel's
 * largest |H|, but at least a billionth of the geometric mean of the largest
 * |H| in its row and in its column. Smaller channels are rounding.
 *
 * @param[in]  peak   num_outputs x num_inputs, largest |H| of each channel
 * @param[out] scale  of the same size; may be @p peak
 */
void ritz_channel_scales(int64_t num_outputs, int64_t num_inputs,
                         const double *peak, double *scale);

/** Whether a grid is one. @return RITZ_ERR_ARGUMENT */
ritz_status ritz_grid_check(const ritz_grid *grid);

/** Response of zeros at the points of a grid, for these modes. */
ritz_status ritz_response_new(const ritz_grid *grid, const ritz_poles *poles,
                              ritz_response *out);

/**
 * Modes of a component up to a frequency, and what they make of its damping.
 *
 * @param[out] pairs  may be NULL: not wanted
 */
ritz_status ritz_poles_of_component(const ritz_component *component,
                                    const ritz_damping *damping,
                                    double up_to_hz, ritz_pairs *pairs,
                                    ritz_poles *out);

/**
 * Whether damping ratios act on all modes of a component, and not only on those
 * that are summed: it has at most RITZ_RATIO_DOFS dofs, or neither D nor K4.
 */
bool ritz_ratios_act_on_all(const ritz_component *component,
                            const ritz_damping *damping);

/**
 * The modes of a component above those that are known, M-orthogonal to the
 * latter. @cost O(n^3)
 *
 * @param[in]  pairs  the lowest modes, complete up to some frequency
 * @param[out] Phi, lambda  all other modes with mass, ascending
 */
ritz_status ritz_modes_above(const ritz_component *component,
                             const ritz_pairs *pairs, ritz_dense *Phi,
                             double **lambda);

/**
 * All modes of a component that have mass. Those up to @p up_to_hz have the
 * accuracy of ritz_eigen_sparse.
 */
ritz_status ritz_modes_of_whole(const ritz_component *component,
                                double up_to_hz, ritz_pairs *out);

/**
 * Response of the modes that are not in @p pairs, damped by @p damping, if it
 * is a M + b K, by D if it has this form, and by ratios if
 * ritz_ratios_act_on_all. Other damping of these modes is neglected: another D,
 * K4, ratios if they do not act on all modes, and an a so large that the series
 * does not converge.
 *
 * @param[in] damping  NULL: none in addition to D
 * @param[in] to_hz    frequency up to which the series is accurate to 1e-12
 * @param[in] out_hz   all modes up to this frequency are in @p pairs
 */
ritz_status ritz_residual_new(const ritz_component *component,
                              const ritz_damping *damping,
                              const ritz_pairs *pairs, double to_hz,
                              double out_hz, ritz_residual *out);

/**
 * Only the change by damping ratios of the response of the modes that are not
 * in @p pairs; empty unless ritz_ratios_act_on_all.
 */
ritz_status ritz_residual_of_ratios(const ritz_component *component,
                                    const ritz_damping *damping,
                                    const ritz_pairs *pairs, double out_hz,
                                    ritz_residual *out);

/**
 * As ritz_residual_of_ratios, for components so large that their modes cannot
 * all be computed: Ritz pairs take the place of modes, as many as are needed
 * for the response up to a third of @p out_hz. Sets `uncertain`.
 *
 * @param[in,out] r  its series is kept, if it has one
 * @cost a factorisation for each of up to 33 poles, n x 800 numbers at most
 */
ritz_status ritz_ratio_space(const ritz_component *component,
                             const ritz_damping *damping,
                             const ritz_pairs *pairs, double out_hz,
                             ritz_residual *r);

/** H += the changes by damping ratios alone. */
void ritz_residual_add_ratios(const ritz_residual *residual, double hertz,
                              double _Complex *H);

/** H += the response of the residual without these changes. */
void ritz_residual_add_series(const ritz_residual *residual, double hertz,
                              double _Complex *H);

/** H += the response of the residual. */
void ritz_residual_add(const ritz_residual *residual, double hertz,
                       double _Complex *H);

/** The same at @p count frequencies, as ritz_poles_add_all. */
ritz_status ritz_residual_add_all(const ritz_residual *residual, int64_t count,
                                  const double *hertz, double _Complex *H);

void ritz_residual_free(ritz_residual *residual);

/**
 * The part of a dense model's response that its modes do not have, the same at
 * all frequencies: with N of ritz_massless, C N N' B. No term where every
 * motion has mass; damping of such motions is left out.
 *
 * @param[in] pairs  of ritz_eigen_dense: all modes of finite frequency
 */
ritz_status ritz_static_rest(const ritz_second_order *model,
                             const ritz_pairs *pairs, ritz_residual *out);

/** ritz_static_gain(), given the pairs of ritz_eigen_dense(K, M). */
ritz_status ritz_static_gain_of_modes(const ritz_second_order *model,
                                      const ritz_pairs *pairs,
                                      int64_t num_rigid, ritz_dense *out);

/**
 * N, n x (n - m), the motions without mass, given the m finite pairs of the
 * model.
 *
 * @return RITZ_ERR_SINGULAR if K does not hold the motions without mass
 */
ritz_status ritz_massless(const ritz_second_order *model, const ritz_dense *Phi,
                          const double *lambda, ritz_dense *out);

/** B'AB whose entries are 0 where they are rounding, or up to @p floor. */
ritz_status ritz_project_above(const ritz_dense *A, const ritz_dense *B,
                               double floor, ritz_dense *out);

/**
 * The a and b for which |D - a M - b K| is least in the Frobenius norm.
 *
 * @param[in]  component  with D
 * @param[out] left       |D - a M - b K| / |D|
 */
ritz_status ritz_proportional(const ritz_component *component, double *a,
                              double *b, double *left);

/** D + a M + b K, of Rayleigh damping. */
ritz_status ritz_damping_matrix(const ritz_component *component,
                                const ritz_damping *damping, ritz_sparse *out);

/** Symbolic factor of c_0 K + c_1 M + c_2 D + i K4 for any c. */
ritz_status ritz_impedance_new(const ritz_component *component,
                               ritz_zldl **out);

/** @return RITZ_ERR_SINGULAR */
ritz_status ritz_impedance_factor(const ritz_component *component,
                                  const double _Complex c[static 3],
                                  ritz_zldl *Z);

/* Components of at most 300 dofs are taken whole, as dense: some seconds. */
enum { RITZ_WHOLE_DOFS = 300 };

/** All poles of a dense model; its io may be NULL. @cost O((2 n)^3) */
ritz_status ritz_spectrum_dense(const ritz_second_order *model,
                                const ritz_damping *damping,
                                ritz_spectrum *out);

/** Poles of a state space: all poles of a dense one, those that @p span asks
 * for of a sparse one. */
ritz_status ritz_spectrum_of_space(const ritz_state_space *model,
                                   const ritz_span *span, ritz_spectrum *out);

/** Poles of a component of more dofs than that, by a projection. */
ritz_status ritz_spectrum_large(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_span *span, ritz_spectrum *out);

/**
 * The space in which ritz_spectrum_large seeks poles, modes and static
 * responses to dampers, as a reduced model with dampers and T.
 */
ritz_status ritz_spectrum_space(const ritz_component *component,
                                const ritz_span *span, ritz_reduced *out);

/** K, M, D and K4 of a component as dense ones, and nothing else of it. */
ritz_status ritz_whole_new(const ritz_component *component, ritz_reduced *out);

/** Shape of pole j, n x 2: real and imaginary part. */
ritz_status ritz_spectrum_shape(const ritz_spectrum *spectrum, int64_t j,
                                ritz_dense *out);

/*
 * Damped eigenpairs of the full matrices, by inverse iteration for
 * Z(s) = s^2 M + s D + K + i K4:
 *
 *     u = Z(s)^-1 Z'(s) x,    s_new = s - (x^H x) / (x^H u),   x_new = u
 *
 * [Ruhe1973]
 */

/**
 * Iterate from an estimate of a damped eigenpair to a pair near it.
 *
 * @param[in]     Z  of ritz_impedance_new
 * @param[in,out] x  n x 2, real and imaginary part
 * @return RITZ_ERR_CONVERGENCE if s does not converge
 */
ritz_status ritz_refine(const ritz_component *component, ritz_zldl *Z,
                        ritz_dense *x, double _Complex *s);

/** The pole above the axis of size |s| and a ratio; NaN of ratios from 1 on. */
double _Complex ritz_pole_of(double size, double zeta);

typedef struct ritz_damped {
    double *zeta;          /* of each undamped mode: NaN where it does not
                              oscillate any more, 0 where rigid */
    double _Complex *s;    /* of each: NaN where rigid, or not oscillating */
    ritz_spectrum listing; /* all poles; {0} where D couples no modes */
} ritz_damped;

/**
 * The damped mode that each undamped one has become.
 *
 * @param[in] component  may be NULL; else modes in `band_hz` are made exact by
 *                       inverse iteration on its matrices
 * @param[in] pairs      of the component; NULL with it
 */
ritz_status ritz_damped_new(const ritz_poles *poles,
                            const ritz_component *component,
                            const ritz_pairs *pairs, const double band_hz[2],
                            ritz_damped *out);

/** The pole nearest to @p s, of those above the axis if @p above; or NaN. */
double _Complex ritz_nearest_pole(int64_t count, const double _Complex *pole,
                                  bool above, double _Complex s);

/** Oscillating pole nearest to @p s among those of a model; NaN if none. */
double _Complex ritz_damped_nearest(const ritz_damped *damped, int64_t count,
                                    double _Complex s);

void ritz_damped_free(ritz_damped *damped);

/*
 * The transfer function whose zeros are sought: some inputs and outputs of
 *
 *     x' = A x + B u,    y = C x + D u
 *
 * or, if `squared`, of x'' = A x + B u, whose eigenvalues and zeros are s^2.
 */
typedef struct ritz_channel {
    ritz_dense A, B, C, D;
    bool squared;       /* then A is diagonal */
    bool blocks;        /* A is [0 w; -l/w -d] of pairs of states k, k + n/2 */
    int64_t derivative; /* y is this time derivative of C x + D u: it adds as
                           many zeros at 0, less the poles there */
} ritz_channel;

ritz_status ritz_channel_dense(const ritz_second_order *model,
                               const ritz_damping *damping, int64_t output,
                               int64_t input, ritz_channel *out);
ritz_status ritz_channel_states(const ritz_state_space *model, int64_t output,
                                int64_t input, ritz_channel *out);

void ritz_channel_free(ritz_channel *channel);

/*
 * Norms of a model in Schur form, with A quasi-triangular, E triangular or {0},
 * and all poles known to be left of the axis. They equal those of
 * ritz_norm_infinity and ritz_norm_two, without another eigenproblem.
 */

/** @return RITZ_ERR_CONVERGENCE */
ritz_status ritz_norm_infinity_schur(const ritz_state_space *model,
                                     double tolerance, ritz_norm *out);

/**
 * @param[in]  last  number of states at the end that are decoupled from all
 *                   others
 * @param[out] part  the norm of the response of these states alone; may be NULL
 * @return RITZ_ERR_ARGUMENT if D is not 0
 */
ritz_status ritz_norm_two_schur(const ritz_state_space *model, int64_t last,
                                ritz_norm *out, ritz_norm *part);

/**
 * H-infinity norms of a sparse model and of its difference from a small one, by
 * interpolation of the sparse one. Each is a value that is reached; `engine`
 * says that it is a lower bound.
 *
 * @param[in]  small      in Schur form, all poles left of the axis
 * @param[out] decoupled  number of poles at 0 of @p model, which are left out
 * @cost  some 10 to 40 complex factors, and solves for all inputs and outputs
 */
ritz_status ritz_norm_infinity_sparse(const ritz_state_space *model,
                                      const ritz_state_space *small,
                                      double tolerance, int64_t *decoupled,
                                      ritz_norm *whole, ritz_norm *error);

#endif
