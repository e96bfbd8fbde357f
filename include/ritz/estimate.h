/*
 * How wrong a reduced component can be, without one mode of the full one: the
 * full model is factored and its modes are counted, never computed.
 *
 *     mode-7, mode-8, ...         |f_r - f| / f of each reduced mode in the
 *                                 band, f that of the full mode of its number
 *                                 or of the one that the place names
 *     frequency-relative-bound    what ritz-verify's frequency-relative is at
 *                                 most: of full modes in the band and their
 *                                 partners, wherever these lie; none without
 *                                 such modes
 *     frequency-relative-least    what that is at least; none if it may be 0
 *     missing-modes-bound         what its missing-modes are at most: full modes
 *                                 in the band of which no reduced one is proven
 *                                 to hold half
 *     response-relative-bound     max |H - H_r| / max |H| in the band, between
 *                                 points too, for ratios common to all modes
 *                                 and for D = a M + b K
 *     response-relative-estimate  the same without proof, for other damping
 *
 * HUGE_VAL: nothing is known. Rounding is part of each bound.
 */
#ifndef RITZ_ESTIMATE_H
#define RITZ_ESTIMATE_H

#include <ritz/reduced.h>

#pragma GCC visibility push(default)

typedef struct ritz_estimate_request {
    double band_hz[2];    /* [0, 0]: up to half of what the basis knows of */
    ritz_damping damping; /* of responses; none: no response is bounded */
} ritz_estimate_request;

/* The factors of one full component, made once for many reductions of it. */
typedef struct ritz_estimator ritz_estimator;

/**
 * @param[in]  full     borrowed until free; its dampers count as far as K and D
 *                      hold them, and no response is bounded if D holds none
 * @param[in]  request  copied
 * @return RITZ_ERR_ARGUMENT if the band is none
 */
ritz_status ritz_estimator_new(const ritz_component *full,
                               const ritz_estimate_request *request,
                               ritz_estimator **out);

/**
 * Estimates of one reduction of that component. The factor is made for the
 * first one, by its band; counts stay, and serve the next.
 *
 * @param[in]  basis  by which it was reduced; its T is used, and its hertz
 * @param[out] out    empty on entry
 * @return RITZ_ERR_ARGUMENT if the basis is not that of the reduction;
 *         RITZ_ERR_SINGULAR if K - s M is definite for no s < 0
 * @cost   a factor once, an LDL' for each count, and a solve for each mode or,
 *         with responses, each vector; twice where that does not suffice
 * @see    [Lehmann1963], [BeattieGoerisch1995]
 */
ritz_status ritz_estimator_measure(ritz_estimator *estimator,
                                   const ritz_basis *basis,
                                   const ritz_reduced *reduced,
                                   ritz_measures *out);

/**
 * frequency-relative-least alone, as far as an inverse iteration of the reduced
 * modes shows it: no mode is counted, and so it is not known whether partners
 * are there. The worst error is so large at least, or some mode is missing.
 *
 * @cost a factor once, a solve for each mode up to some way beyond the band
 */
ritz_status ritz_estimator_least(ritz_estimator *estimator,
                                 const ritz_basis *basis,
                                 const ritz_reduced *reduced,
                                 ritz_measures *out);

void ritz_estimator_free(ritz_estimator **estimator);

/** The three above, into @p reduced's estimates. */
ritz_status ritz_estimate(const ritz_component *full, const ritz_basis *basis,
                          const ritz_estimate_request *request,
                          ritz_reduced *reduced);

#pragma GCC visibility pop

#endif
