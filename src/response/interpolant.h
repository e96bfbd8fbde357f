/*
 * Rational interpolation with poles and zeros cancelled: through nodes s_m,
 *
 *     H(s) = Z(s)/D(s) sum_m H_m D(s_m)/Z(s_m)
 *                      prod_(l != m) (s - s_l)/(s_m - s_l)
 *     D(s) = prod (s - pole),    Z(s) = prod (s - zero) of the channel
 *
 * [KenneyStubberudLaub1992, (40)] in Lagrange's form: one polynomial through
 * the same values, but where Newton's coefficients of many cancelled poles are
 * differences of what is large, here every term is of the size of H.
 */
#ifndef RITZ_RESPONSE_INTERPOLANT_H
#define RITZ_RESPONSE_INTERPOLANT_H

#include <ritz/status.h>

#include <complex.h>
#include <stdint.h>

typedef struct ritz_interpolant {
    int64_t values; /* channels */
    double unit;    /* rad/s that count as one, against overflow */
    int64_t num_poles;
    double _Complex *pole; /* in units, as all that follow */
    int64_t *num_zeros;    /* of each channel */
    double _Complex **zero;
    int64_t count, room;
    double _Complex *node;
    double _Complex *weight; /* D(s_m) / prod (s_m - s_l) */
    double _Complex *H;      /* room x values */
} ritz_interpolant;

/** @param[in] pole  all, conjugates too  [rad/s] */
ritz_status ritz_interpolant_new(int64_t values, double unit, int64_t num_poles,
                                 const double _Complex *pole,
                                 ritz_interpolant *out);

/** Zeros of a channel, conjugates too; before there are nodes. */
ritz_status ritz_interpolant_cancel(ritz_interpolant *interpolant,
                                    int64_t channel, int64_t num_zeros,
                                    const double _Complex *zero);

/** One node more, on neither a pole nor a zero, nor at another node. */
ritz_status ritz_interpolant_add(ritz_interpolant *interpolant,
                                 double _Complex s, const double _Complex *H);

/** H at s; on an undamped pole not finite. @cost O(nodes + poles) a channel */
void ritz_interpolant_at(const ritz_interpolant *interpolant, double _Complex s,
                         double _Complex *H);

/** log |prod (s - s_m) / D(s)|: where it is largest a node helps most. */
double ritz_interpolant_need(const ritz_interpolant *interpolant,
                             double _Complex s);

void ritz_interpolant_free(ritz_interpolant *interpolant);

#endif
