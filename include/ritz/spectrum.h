/* Damped poles: the s for which (s^2 M + s D + K + i K4) x = 0. */
#ifndef RITZ_SPECTRUM_H
#define RITZ_SPECTRUM_H

#include <ritz/component.h>
#include <ritz/damping.h>
#include <ritz/eigen.h>
#include <ritz/response.h>

#include <complex.h>

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
 * All poles of a dense model; io may be NULL. M may be singular: coordinates
 * without mass answer at once, or with a real pole where D acts on them.
 *
 * Ratios of @p damping act on its undamped modes, beside D.
 *
 * @return RITZ_ERR_SINGULAR if neither mass nor stiffness holds a motion;
 *         RITZ_ERR_ARGUMENT if K4, or a skew part of D, acts on coordinates
 *         without mass
 * @cost   O((2 n)^3)
 */
ritz_status ritz_spectrum_dense(const ritz_second_order *model,
                                const ritz_damping *damping,
                                ritz_spectrum *out);

/**
 * The lowest poles of a component as K and D stand: dampers count as far as
 * they are installed.
 *
 * Small ones are solved as dense. Of large ones the poles are sought in the
 * space of twice as many undamped modes as are wanted and of the static answers
 * to forces along each damper's influence vector [ChuMilman1992], then made
 * exact on the full matrices by inverse iteration; the residual says how exact.
 * Ratios of @p damping are then added to what matrices give.
 *
 * @param[in] span  so many poles beside those at 0, or those up to |s| / (2 pi)
 */
ritz_status ritz_spectrum_component(const ritz_component *component,
                                    const ritz_damping *damping,
                                    const ritz_span *span, ritz_spectrum *out);

/**
 * That space as a model of its own, with its dampers projected: T is kept.
 *
 * @param[in] span  of undamped modes
 */
ritz_status ritz_spectrum_space(const ritz_component *component,
                                const ritz_span *span, ritz_reduced *out);

/** Damping ratio -Re s / |s|: 1 of real poles that decay. */
double ritz_spectrum_ratio(double _Complex s);

/* One value of c for some dampers at once, through a range. */
typedef struct ritz_scan_request {
    int64_t count;
    const int64_t *damper; /* indices of those that take the value */
    double from, to, step; /* 0 <= from < to */
    int64_t mode;          /* which oscillating pole at `from`, 0 the lowest */
} ritz_scan_request;

typedef struct ritz_scan {
    int64_t count;
    double *c;
    double _Complex *s; /* of the mode that is followed */
    int64_t best;       /* where its damping ratio is largest */
} ritz_scan;

/**
 * Follow one mode while dampers change. The pole nearest to where the last two
 * steps point is taken for the same mode, as frequencies swap places: the step
 * must be small against the way between poles.
 *
 * @param[in] model    K and D as they stand
 * @param[in] dampers  for its coordinates, with what K and D hold of them
 * @return RITZ_ERR_ARGUMENT if the range is none, or has no such mode
 */
ritz_status ritz_scan_dampers(const ritz_second_order *model,
                              const ritz_dampers *dampers,
                              const ritz_damping *damping,
                              const ritz_scan_request *request, ritz_scan *out);

/**
 * The same of a component. A large one is scanned in the space of some modes
 * and static answers: at what the scan finds, ask ritz_spectrum_component.
 */
ritz_status ritz_scan_component(const ritz_component *component,
                                const ritz_damping *damping,
                                const ritz_scan_request *request,
                                ritz_scan *out);

void ritz_spectrum_free(ritz_spectrum *spectrum);
void ritz_scan_free(ritz_scan *scan);

#pragma GCC visibility pop

#endif
