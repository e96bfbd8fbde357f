/*
 * Rational interpolation with poles and zeros cancelled: through nodes s_m,
 *
 *     H(s) = Z(s)/D(s) sum_m H_m D(s_m)/Z(s_m)
 *                      prod_(l != m) (s - s_l)/(s_m - s_l)
 *     D(s) = prod (s - pole),    Z(s) = prod (s - zero) of the channel
 *
 * [KenneyStubberudLaub1992, (40)] in Lagrange's form. It is the same polynomial
 * as Newton's, whose coefficients are differences of large numbers when many
 * poles are cancelled; here every term is of the size of H.
 */
#ifndef RITZ_RESPONSE_INTERPOLANT_H
#define RITZ_RESPONSE_INTERPOLANT_H

#include <ritz/base.h>

#include <complex.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct ritz_interpolant {
    int64_t values; /* channels */
    double unit;    /* of frequency, against overflow  [rad/s] */
    int64_t num_poles;
    double _Complex *pole; /* in units, like all that follow */
    int64_t *num_zeros;    /* of each channel */
    double _Complex **zero;
    int64_t count, room, weight_room, H_room;
    double _Complex *node;
    double _Complex *weight; /* D(s_m) / prod (s_m - s_l) */
    double _Complex *H;      /* count x values */
} ritz_interpolant;

/** Append a node @p s that is no pole, no zero and no other node. */
ritz_status ritz_interpolant_append(ritz_interpolant *f, double _Complex s,
                                    const double _Complex *H);

/**
 * H at @p s; not finite at an undamped pole. @cost O(nodes + poles) a channel
 *
 * @param[in]  with_zeros  zeros of the channels are cancelled too
 * @param[out] H           of each channel
 */
void ritz_interpolant_at(const ritz_interpolant *f, double _Complex s,
                         bool with_zeros, double _Complex *H);

/** log |prod (s - s_m) / D(s)|: a node helps most where this is largest. */
double ritz_interpolant_need(const ritz_interpolant *f, double _Complex s);

void ritz_interpolant_free(ritz_interpolant *f);

#endif
