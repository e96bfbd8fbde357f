/* Frequency responses H(i omega) from inputs to outputs. */
#ifndef RITZ_RESPONSE_H
#define RITZ_RESPONSE_H

#include <ritz/component.h>
#include <ritz/damping.h>
#include <ritz/reduced.h>

#include <stdbool.h>

#include <complex.h>

typedef struct ritz_response {
    int64_t count; /* of frequencies */
    double *hertz; /* ascending */
    int64_t num_inputs, num_outputs;
    char (*input)[RITZ_NAME_SIZE];
    char (*output)[RITZ_NAME_SIZE];
    double _Complex *H;          /* H[(k * num_outputs + i) * num_inputs + j] */
    char method[RITZ_NAME_SIZE]; /* "modal", "direct" */
    char damping[RITZ_DAMPING_SIZE];
} ritz_response;

/* Where a response is wanted. */
typedef struct ritz_grid {
    double from_hz, to_hz; /* 0 <= from < to */
    int64_t count;         /* evenly spaced in frequency, at least 2 */
    bool log;              /* evenly spaced in its logarithm; from > 0 */
    bool refine;           /* and at, and around, every resonance inside */
    const double *hertz;   /* count points instead of all that, ascending */
} ritz_grid;

/**
 * Frequencies of a grid; with `refine`, for each mode (omega, zeta) inside the
 * range also its peak and points from 0.25 to 8 half-power widths on both
 * sides, so that no peak falls between points.
 */
ritz_status ritz_grid_points(const ritz_grid *grid, int64_t num_modes,
                             const double *omega, const double *zeta,
                             int64_t *count, double **out);

/* A small dense model, borrowed; D, K4 NULL or {0}: there is none. */
typedef struct ritz_second_order {
    const ritz_dense *K, *M, *D, *K4;
    const ritz_io *io;
} ritz_second_order;

/** ritz_response_dense for a model that may have structural damping too. */
ritz_status ritz_response_second_order(const ritz_second_order *model,
                                       const ritz_damping *damping,
                                       const ritz_grid *grid,
                                       ritz_response *out);

/**
 * Modal: every mode of a small dense model, damping ratios from @p damping and
 * Phi'D Phi; where D couples modes, they are solved for together at each point.
 *
 * Rigid modes contribute 1/(-omega^2); a point at 0 Hz is refused if they
 * are driven and seen.
 *
 * @return RITZ_ERR_SINGULAR if a point lies on an undamped pole
 */
ritz_status ritz_response_dense(const ritz_dense *K, const ritz_dense *M,
                                const ritz_dense *D, const ritz_io *io,
                                const ritz_damping *damping,
                                const ritz_grid *grid, ritz_response *out);

/**
 * Modal, on the full matrices: modes up to @p up_to_hz (0: three times the
 * highest point), and what lies above answers without damping, as a series in
 * w^2 that begins with its residual flexibility.
 */
ritz_status ritz_response_modal(const ritz_component *component,
                                const ritz_damping *damping, double up_to_hz,
                                const ritz_grid *grid, ritz_response *out);

/**
 * Direct: one complex factor of K + i K4 + i w D - w^2 M at each
 * point. Ratios of @p damping act on the modes up to @p up_to_hz, which are
 * taken out of the load first; what lies above them is then undamped but for
 * D and K4. Rayleigh damping is exact. With D, K4 or Rayleigh damping a free
 * body is refused at 0 Hz.
 */
ritz_status ritz_response_direct(const ritz_component *component,
                                 const ritz_damping *damping, double up_to_hz,
                                 const ritz_grid *grid, ritz_response *out);

void ritz_response_free(ritz_response *response);

#endif
