/* The exact step of one damped mode. */
#include "simulate/motion.h"

#include <math.h>

/*
 * All are divided differences of exp(s h) over the roots s_1, s_2 of
 * s^2 + d s + lambda and over 0: S of [s_1, s_2], P of [0, s_1, s_2] and R of
 * [0, 0, s_1, s_2]. So
 *
 * - while the roots are small, |s| h <= 1, by their power series: with h_k the
 *   complete symmetric polynomials, h_k = -d h_(k-1) - lambda h_(k-2),
 *
 *       S = sum h_k h^(k+1) / (k+1)!
 *
 *   and P, R one and two powers further; there is no root in it, and nothing
 *   divides;
 * - of real roots by the recursion that divides by the larger of them,
 *   P = (E - S) / -s_big, E = (exp(s_small h) - 1) / s_small, as the small one
 *   may vanish, and with expm1, as they may meet;
 * - of complex roots by sine and cosine, P and R from the equation itself,
 *   S' - 1 + d S + lambda P = 0 and S - h + d P + lambda R = 0, which loses
 *   nothing as lambda h^2 >= 1 there.
 */

/* 1/22! is below the rounding of 1. */
enum { TERMS = 22 };

static ritz_oscillator by_series(double lambda, double d, double h)
{
    ritz_oscillator o = {0};
    double before = 0.0; /* h_(k-1), each times h^k */
    double term = 1.0;
    double factorial = 1.0; /* k! */

    for (int k = 0; k < TERMS; k++) {
        double next = -d * h * term - lambda * h * h * before;

        o.rate += term / factorial;
        o.S += h * term / (factorial * (k + 1));
        o.P += h * h * term / (factorial * (k + 1) * (k + 2));
        o.R += h * h * h * term / (factorial * (k + 1) * (k + 2) * (k + 3));
        factorial *= k + 1;
        before = term;
        term = next;
    }
    o.hold = 1.0 - lambda * o.P;
    return o;
}

/* (exp(s h) - 1 - s h) / s^2 */
static double second_difference(double s, double h)
{
    double z = s * h;
    double sum = 0.0;

    if (fabs(z) > 1.0)
        return (expm1(z) - z) / (s * s);
    for (int k = TERMS; k >= 2; k--)
        sum = sum * z / (k + 1) + 1.0;
    return 0.5 * h * h * sum;
}

static ritz_oscillator by_real_roots(double lambda, double d, double h)
{
    ritz_oscillator o = {0};
    double half = 0.5 * d;
    double root = sqrt(fmax(half * half - lambda, 0.0));
    double big = half >= 0.0 ? -(half + root) : root - half;
    double small = lambda / big;
    double gap = 2.0 * root;
    double top = big > small ? big : small;
    double first = small != 0.0 ? expm1(small * h) / small : h;

    o.S = exp(top * h) * (gap * h > 0.0 ? -expm1(-gap * h) / gap : h);
    o.rate = exp(big * h) + small * o.S;
    o.hold = exp(big * h) - big * o.S;
    o.P = (o.S - first) / big;
    o.R = (o.P - second_difference(small, h)) / big;
    return o;
}

static ritz_oscillator by_complex_roots(double lambda, double d, double h)
{
    ritz_oscillator o = {0};
    double w = sqrt(lambda);
    double half = 0.5 * d;
    double r = sqrt((w - half) * (w + half));
    double fade = exp(-half * h);

    o.S = fade * (r > 0.0 ? sin(r * h) / r : h);
    o.rate = fade * cos(r * h) - half * o.S;
    o.hold = fade * cos(r * h) + half * o.S;
    o.P = (1.0 - o.hold) / lambda;
    o.R = (h - o.S - d * o.P) / lambda;
    return o;
}

ritz_oscillator ritz_oscillator_over(double lambda, double d, double h)
{
    if (fabs(d) * h <= 1.0 && fabs(lambda) * h * h <= 1.0)
        return by_series(lambda, d, h);
    if (lambda <= 0.25 * d * d)
        return by_real_roots(lambda, d, h);
    return by_complex_roots(lambda, d, h);
}
