/* SPDX-License-Identifier: 0BSD */
/*
 * A step h of an oscillator q'' + d q' + lambda q = f under a constant f. S is
 * the divided difference of exp(s h) over the roots s of s^2 + d s + lambda, P
 * its integral, rate its derivative, and hold = rate + d S. The differential
 * equation gives hold = 1 - lambda P.
 *
 * If h times the roots is small, a power series is summed. Otherwise complex
 * roots give sine and cosine. Real roots give formulas that divide by the root
 * of larger size alone, because the other may be 0, and that remain accurate if
 * both are equal.
 */
#include "propagate.h"

#include <math.h>

/* 1/22! is below the rounding of 1. */
enum { TERMS = 22 };

/* S = sum c_k h^(k+1)/(k+1)!, c_k = -d c_(k-1) - lambda c_(k-2), c_0 = 1 */
static fmu_oscillator sum_series(double lambda, double d, double h)
{
    fmu_oscillator o = {0};
    double before = 0.0;
    double c = 1.0; /* times h^k */
    double factorial = 1.0;

    for (int k = 0; k < TERMS; k++) {
        const double next = -d * h * c - lambda * h * h * before;

        o.rate += c / factorial;
        factorial *= k + 1;
        o.S += h * c / factorial;
        o.P += h * h * c / (factorial * (k + 2));
        before = c;
        c = next;
    }
    o.hold = 1.0 - lambda * o.P;
    return o;
}

static fmu_oscillator take_real_roots(double lambda, double d, double h)
{
    fmu_oscillator o = {0};
    const double root = sqrt(fmax(0.25 * d * d - lambda, 0.0));
    const double big = d >= 0.0 ? -0.5 * d - root : root - 0.5 * d;
    const double small = lambda / big;
    const double upper = fmax(big, small);
    const double first = small != 0.0 ? expm1(small * h) / small : h;

    o.S = exp(upper * h) *
          (root > 0.0 ? -expm1(-2.0 * root * h) / (2.0 * root) : h);
    o.rate = exp(big * h) + small * o.S;
    o.hold = exp(big * h) - big * o.S;
    o.P = (o.S - first) / big;
    return o;
}

static fmu_oscillator take_complex_roots(double lambda, double d, double h)
{
    fmu_oscillator o = {0};
    const double w = sqrt(lambda);
    const double decay = 0.5 * d;
    const double r = sqrt((w - decay) * (w + decay));
    const double fade = exp(-decay * h);

    o.S = fade * (r > 0.0 ? sin(r * h) / r : h);
    o.rate = fade * cos(r * h) - decay * o.S;
    o.hold = fade * cos(r * h) + decay * o.S;
    o.P = (1.0 - o.hold) / lambda;
    return o;
}

fmu_oscillator fmu_oscillator_over(double lambda, double d, double h)
{
    if (fabs(d) * h <= 1.0 && fabs(lambda) * h * h <= 1.0)
        return sum_series(lambda, d, h);
    if (lambda <= 0.25 * d * d)
        return take_real_roots(lambda, d, h);
    return take_complex_roots(lambda, d, h);
}
