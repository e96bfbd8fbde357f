/* Damped poles: the s for which (s^2 M + s D + K + i K4) x = 0. */
#ifndef RITZ_POLES_H
#define RITZ_POLES_H

#include <ritz/matrix.h>
#include <ritz/model.h>
#include <ritz/response.h>

#pragma GCC visibility push(default)

/*
 * Of each pair of poles the one with Im s > 0, and every real one, by ascending
 * |s|. With K4, which says what loss a motion of positive frequency has, all
 * poles are of the first kind.
 */
typedef struct ritz_spectrum {
    int64_t count;
    double _Complex *s; /* count  [rad/s] */
    double *residual;   /* count, of the matrix whose eigenvalues they are */
    ritz_dense re, im;  /* n x count, shapes x */
    int64_t num_zero;   /* poles at 0, not listed: rigid motion nothing holds */
    char engine[RITZ_NAME_SIZE];
} ritz_spectrum;

/**
 * Poles of a model: all poles of a dense model (its io may be NULL) and of a
 * dense state space, which has neither shapes nor residuals; the lowest poles
 * of a component; the poles nearest to 0 of a sparse state space, without
 * shapes and without proof that none is missing.
 *
 * M may be singular: coordinates without mass respond statically, or with a
 * real pole where D acts on them. Damping ratios act on the undamped modes, in
 * addition to D. Dampers of a component count as far as they are installed.
 *
 * Small components are solved as dense models. Of large ones the poles are
 * sought in the space of twice as many undamped modes as are wanted and of the
 * static responses to forces along each damper's influence vector
 * [ChuMilman1992], then made exact on the full matrices by inverse iteration;
 * the residual says how exact. Damping ratios are then added to what matrices
 * give.
 *
 * @param[in] span  number of poles in addition to those at 0, or a limit of |s|
 *                  / (2 pi); read for components and sparse state spaces only
 * @return RITZ_ERR_SINGULAR if neither mass nor stiffness holds a motion;
 *         RITZ_ERR_ARGUMENT if K4, or a skew part of D, acts on coordinates
 *         without mass
 * @cost   O((2 n)^3) of a dense model
 */
ritz_status ritz_spectrum_of(ritz_model model, const ritz_span *span,
                             ritz_spectrum *out);

/**
 * The poles of a state space nearest to i 2 pi @p near_hz, on and above the
 * real axis, by Arnoldi iterations on sparse factors.
 *
 * @param[out] out  at most @p count, by ascending |s|, without shapes
 * @return RITZ_ERR_SINGULAR if a pole lies at that point
 */
ritz_status ritz_spectrum_near(const ritz_state_space *model, double near_hz,
                               int64_t count, ritz_spectrum *out);

/** Damping ratio -Re s / |s|: 1 of real poles that decay. */
double ritz_spectrum_ratio(double _Complex s);

/* One parameter of a scan: c or k of one or several dampers, which share the
   value, over a range. */
typedef struct ritz_scan_axis {
    int64_t count;
    const int64_t *damper; /* indices of the dampers that take the value */
    bool of_k;             /* the parameter is k; false: c */
    double from, to, step; /* from < to; c is not negative */
} ritz_scan_axis;

/* A scan over the grid of all combinations of the axes' values. */
typedef struct ritz_scan_request {
    int64_t count;
    const ritz_scan_axis *axis;
    int64_t mode; /* which oscillating pole at the first point; 0: the lowest */
} ritz_scan_request;

typedef struct ritz_scan {
    int64_t count, num_axes;
    int64_t *size;      /* num_axes, number of points along each */
    double *value;      /* num_axes x count; the last axis varies fastest */
    double _Complex *s; /* pole of the followed mode at each point */
    int64_t best;       /* the point where its damping ratio is largest */
} ritz_scan;

/**
 * Follow one mode while dampers change. The last two points of the mode are
 * extrapolated, and the pole nearest to the extrapolation is taken for the same
 * mode, because frequencies can cross: steps must be small relative to the
 * distance between poles. At the first point of a line, the extrapolation is
 * along the next slower axis.
 *
 * A large component is scanned in a space of some modes and static responses;
 * confirm what the scan finds by ritz_spectrum_of.
 *
 * @param[in] model  no state space; K and D as stored, including what they hold
 *                   of the model's dampers
 * @return RITZ_ERR_ARGUMENT if a range is empty, there is no such mode, or two
 *         axes scan the same parameter
 */
ritz_status ritz_scan_of(ritz_model model, const ritz_scan_request *request,
                         ritz_scan *out);

void ritz_spectrum_free(ritz_spectrum *spectrum);
void ritz_scan_free(ritz_scan *scan);

/*
 * Zeros: the complex frequencies s at which a model passes nothing on. With the
 * system pencil [Rosenbrock1970]
 *
 *     P(s) = [ s E - A   -B ]
 *            [   C        D ]
 *
 * they are where P loses rank, and the finite ones are found by a reduction of
 * orthogonal transformations [EmamiNaeiniVanDooren1982].
 */

/* For `output` and `input` together: all channels at once. */
enum { RITZ_ALL_CHANNELS = -1 };

/**
 * Finite zeros of a small model, rad/s, by magnitude ascending, of a pair the
 * one above the axis first.
 *
 * Of one channel they are transmission zeros: what poles cancel, as those of
 * modes that are not controllable or not observable, is not among them. Of all
 * channels at once they are invariant zeros, such modes among them, but for
 * free rigid motions that are not controllable or not observable.
 *
 * A zero that rounding of the model could move by its own magnitude cannot be
 * told from one at infinity, and is taken for that. Without damping, and with
 * outputs that are displacements and accelerations or velocities alone, zeros
 * are +- pairs exactly, and those on the axis lie on it exactly; collocated
 * ones are all there, between the poles.
 *
 * @param[in] output, input  indices from 0, or both RITZ_ALL_CHANNELS: as many
 *                           outputs as inputs
 * @param[out] out     count of them, to be freed
 * @return RITZ_ERR_ARGUMENT if there is no such channel, outputs are not as
 *         many as inputs, there is structural damping, massless dofs are
 *         damped or observed by velocities, or a component has too many dofs
 *         for dense matrices; RITZ_ERR_SINGULAR if nothing passes, or of all
 *         channels less than all, at any frequency
 * @cost   O(n^3), n coordinates
 */
ritz_status ritz_zeros_of(ritz_model model, int64_t output, int64_t input,
                          int64_t *count, double _Complex **out);

/* Norms of systems: how large the response of a model, or of the difference of
 * two, can be. */

typedef struct ritz_norm {
    double value;
    double hertz;    /* H-infinity: frequency of the peak; HUGE_VAL: beyond all
                        poles */
    double lower;    /* proven lower bound of the norm */
    double rounding; /* H-infinity: first-order bound of how much rounding, eps
                        |A|, may change the peak response; large next to a slow
                        pole */
    char engine[RITZ_NAME_SIZE];
} ritz_norm;

/**
 * H-infinity norm: the largest singular value of H(i w) over all w, to @p
 * tolerance relative.
 *
 * First values are met: at 0, far out, at every pole, and between them where
 * they are high; the largest is `lower`. Up to 600 states SLICOT AB13DD then
 * decides by eigenvalues of Hamiltonian matrices whether there is a larger one.
 * Of more states, whose Hamiltonians would cost 100 n^3 each, and where AB13DD
 * does not come to an end, `value` is `lower`, and `engine` says so: a peak
 * between poles that none of them shows can be missed.
 *
 * @return RITZ_ERR_ARGUMENT if a pole is not left of the axis, as
 *         ritz_gramians_of_space decides: it is infinite
 * @cost   O(n^3), some hundred times; beyond 600 states O(n^2) for each pole
 * @see    [Bruinsma1990]
 */
ritz_status ritz_norm_infinity(const ritz_state_space *model, double tolerance,
                               ritz_norm *out);

/**
 * H2 norm, sqrt(trace(C W_c C')), by the factor of W_c.
 *
 * @return RITZ_ERR_ARGUMENT if a pole is not left of the axis, or D is not 0:
 *         it is infinite
 * @cost   O(n^3)
 */
ritz_status ritz_norm_two(const ritz_state_space *model, ritz_norm *out);

/**
 * a - b as one state space, of the same inputs and outputs in the same order.
 *
 * @return RITZ_ERR_ARGUMENT if they differ by name or number
 */
ritz_status ritz_state_space_difference(const ritz_state_space *a,
                                        const ritz_state_space *b,
                                        ritz_state_space *out);

#pragma GCC visibility pop

#endif
