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
#include <ritz/response.h>

/*
 * Response of the modes that were left out, damped by a M + b K: with K^+ the
 * inverse of K where they live, R_0 = K^+ B and R_j = K^+ M R_(j-1),
 *
 *     X = sum_j mu^j R_j / (1 + i w b),    mu = (w^2 - i w a) / (1 + i w b)
 *
 * of which only the outputs are kept. Damping ratios do not act on it.
 */
typedef struct ritz_residual {
    int64_t count, num_outputs, num_inputs;
    double a, b;
    bool known;      /* a and b are all that D and K4 do to them */
    double unit;     /* of mu: term j is kept times its power j */
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
 * @param[in] to_hz  where responses end that are of interest; 0: not known
 * @return RITZ_ERR_ARGUMENT if an eigenvalue is negative beyond rounding, of
 *         the largest eigenvalue or of (2 pi to_hz)^2
 */
ritz_status ritz_poles_of_dense(const ritz_second_order *model,
                                const ritz_damping *damping, double to_hz,
                                ritz_poles *out);

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
 * Response of the modes that are not in @p pairs, damped by @p damping, if it
 * is a M + b K, and by D, if it is such a sum. Other damping of these modes is
 * neglected: by another D, by K4, and where a is so large that the series does
 * not converge.
 *
 * @param[in] damping  NULL: none beside D
 * @param[in] to_hz    where the series is to be good to 1e-12
 * @param[in] out_hz   all modes up to here are in @p pairs
 */
ritz_status ritz_residual_new(const ritz_component *component,
                              const ritz_damping *damping,
                              const ritz_pairs *pairs, double to_hz,
                              double out_hz, ritz_residual *out);

/** H += the response of the residual. */
void ritz_residual_add(const ritz_residual *residual, double hertz,
                       double _Complex *H);

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

/**
 * N, n x (n - m), the motions without mass, given the m finite pairs of the
 * model.
 *
 * @return RITZ_ERR_SINGULAR if K does not hold the motions without mass
 */
ritz_status ritz_massless(const ritz_second_order *model, const ritz_dense *Phi,
                          const double *lambda, ritz_dense *out);

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

#endif
