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
#ifndef RITZ_ZEROS_H
#define RITZ_ZEROS_H

#include <ritz/component.h>
#include <ritz/damping.h>
#include <ritz/response.h>
#include <ritz/state_space.h>

#include <complex.h>

#pragma GCC visibility push(default)

/* For `output` and `input` together: all channels at once. */
enum { RITZ_ALL_CHANNELS = -1 };

/**
 * Finite zeros of a small dense model, rad/s, by magnitude ascending, of a pair
 * the one above the axis first.
 *
 * Of one channel they are transmission zeros: what poles cancel, as those of
 * modes that are not driven or not seen, is not among them. Of all channels at
 * once they are invariant zeros, such modes among them, but for free rigid
 * motions that no input drives or no output sees.
 *
 * A zero that rounding of the model could move by its own magnitude cannot be
 * told from one at infinity, and is taken for that. Without damping, and with
 * outputs that are displacements and accelerations or velocities alone, zeros
 * are +- pairs exactly, and those on the axis lie on it exactly; collocated
 * ones are all there, between the poles.
 *
 * @param[in] damping  as of responses; NULL: that of the matrices alone
 * @param[in] output, input  indices from 0, or both RITZ_ALL_CHANNELS: as many
 *                           outputs as inputs
 * @param[out] out     count of them, to be freed
 * @return RITZ_ERR_ARGUMENT if there is no such channel, outputs are not as
 *         many as inputs, there is structural damping, or massless dofs are
 *         damped or seen by velocities; RITZ_ERR_SINGULAR if nothing passes,
 *         or of all channels less than all, at any frequency
 * @cost   O(n^3), n coordinates
 */
ritz_status ritz_zeros_dense(const ritz_second_order *model,
                             const ritz_damping *damping, int64_t output,
                             int64_t input, int64_t *count,
                             double _Complex **out);

/**
 * The same of a component, its dampers at work.
 *
 * @return RITZ_ERR_ARGUMENT also if it has too many dofs for dense matrices
 */
ritz_status ritz_zeros_component(const ritz_component *component,
                                 const ritz_damping *damping, int64_t output,
                                 int64_t input, int64_t *count,
                                 double _Complex **out);

/** The same of a model in first-order form. */
ritz_status ritz_zeros_states(const ritz_state_space *model, int64_t output,
                              int64_t input, int64_t *count,
                              double _Complex **out);

#pragma GCC visibility pop

#endif
