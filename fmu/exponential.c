/* SPDX-License-Identifier: 0BSD */
/*
 * E = exp(A h) and G, the integral of exp(A s) B over the step, from one
 * exponential,
 *
 *     exp([A B/s; 0 0] h) = [E G/s; 0 I].
 *
 * Each input is divided by a scale s of its own, because an input of large unit
 * would increase the norm and thereby the number of doublings below.
 *
 * F = exp(X) - I is computed for X / 2^k, whose norm is at most 1/2, as a
 * Taylor polynomial of degree 16: the remainder is below 1e-17 of F. Powers are
 * grouped by four [PatersonStockmeyer1973]. Then F := 2 F + F^2 is applied k
 * times. Working with F instead of exp(X) keeps the digits of motions that
 * hardly change in a step. Rows and columns are first balanced by powers of two
 * [ParlettReinsch1969], because displacements and velocities have different
 * units.
 */
#include "propagate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GROUP = 4, DEGREE = 16, SWEEPS = 100, DOUBLINGS = 1100 };

/* Find powers of two by which row i and column i of A get nearly the same sum,
   for all i. */
static void balance(size_t k, const double *A, double *scale)
{
    bool again = true;

    for (size_t i = 0; i < k; i++)
        scale[i] = 1.0;
    for (int sweep = 0; again && sweep < SWEEPS; sweep++) {
        again = false;
        for (size_t i = 0; i < k; i++) {
            double row = 0.0;
            double col = 0.0;
            int power = 0;

            for (size_t j = 0; j < k; j++)
                if (j != i) {
                    row += fabs(A[j * k + i]) * scale[j] / scale[i];
                    col += fabs(A[i * k + j]) * scale[i] / scale[j];
                }
            if (row > 0.0 && col > 0.0 && isfinite(row) && isfinite(col))
                power = (int)lrint(0.5 * (log2(row) - log2(col)));
            if (power != 0) {
                scale[i] = ldexp(scale[i], power);
                again = true;
            }
        }
    }
}

/* Z = X Y, n x n */
static void multiply(size_t n, const double *X, const double *Y, double *Z)
{
    memset(Z, 0, n * n * sizeof *Z);
    for (size_t j = 0; j < n; j++)
        for (size_t l = 0; l < n; l++) {
            const double y = Y[j * n + l];

            for (size_t i = 0; y != 0.0 && i < n; i++)
                Z[j * n + i] += X[l * n + i] * y;
        }
}

/* Largest sum of a column. */
static double norm_of(size_t n, const double *X)
{
    double norm = 0.0;

    for (size_t j = 0; j < n; j++) {
        double sum = 0.0;

        for (size_t i = 0; i < n; i++)
            sum += fabs(X[j * n + i]);
        norm = fmax(norm, sum);
    }
    return norm;
}

/* F = X + X^2/2! + ... + X^16/16!; power[k] holds X^(k+1). */
static void sum_taylor(size_t n, double *const power[GROUP], double *work,
                       double *F)
{
    double c[DEGREE + 1] = {1.0};

    for (int k = 1; k <= DEGREE; k++)
        c[k] = c[k - 1] / k;
    for (int k = 1; k < GROUP; k++)
        multiply(n, power[0], power[k - 1], power[k]);
    memset(F, 0, n * n * sizeof *F);
    for (int first = DEGREE - GROUP; first >= 0; first -= GROUP) {
        if (first < DEGREE - GROUP) {
            multiply(n, power[GROUP - 1], F, work);
            memcpy(F, work, n * n * sizeof *F);
        }
        for (int k = 0; k < GROUP; k++)
            for (size_t i = 0; i < n * n; i++)
                F[i] += c[first + k + 1] * power[k][i];
    }
}

/* Fill X with the balanced A times h. @return its largest entry */
static double fill_states(size_t k, size_t n, const double *A,
                          const double *scale, double h, double *X)
{
    double largest = 0.0;

    memset(X, 0, n * n * sizeof *X);
    for (size_t j = 0; j < k; j++)
        for (size_t i = 0; i < k; i++) {
            X[j * n + i] = A[j * k + i] * scale[j] / scale[i] * h;
            largest = fmax(largest, fabs(X[j * n + i]));
        }
    return largest;
}

/* Fill a column of X with that of an input, divided by the scale s of the head.
   @return s */
static double scale_input(size_t k, const double *B, const double *scale,
                          double largest, double h, double *X)
{
    double unit = 0.0;

    for (size_t i = 0; i < k; i++) {
        X[i] = B[i] / scale[i] * h;
        unit = fmax(unit, fabs(X[i]));
    }
    unit = unit > 0.0 ? unit / fmax(largest, 1.0) : 1.0;
    for (size_t i = 0; i < k; i++)
        X[i] /= unit;
    return unit;
}

/* Compute F from X = power[0], which is overwritten. @return false if X is not
   finite, or too large */
static bool exponential_less_one(size_t n, double *const power[GROUP],
                                 double *work, double *F)
{
    double *X = power[0];
    const double norm = norm_of(n, X);
    int doublings = 0;

    if (!isfinite(norm))
        return false;
    if (norm > 0.5)
        doublings = (int)ceil(log2(2.0 * norm));
    if (doublings > DOUBLINGS)
        return false;
    for (size_t i = 0; i < n * n; i++)
        X[i] = ldexp(X[i], -doublings);
    sum_taylor(n, power, work, F);
    for (; doublings > 0; doublings--) {
        multiply(n, F, F, work);
        for (size_t i = 0; i < n * n; i++)
            F[i] = 2.0 * F[i] + work[i];
    }
    return true;
}

static void take_result(size_t k, size_t p, const double *F,
                        const double *scale, const double *unit, double *E)
{
    const size_t n = k + p;

    for (size_t j = 0; j < k; j++)
        for (size_t i = 0; i < k; i++)
            E[j * k + i] =
                (i == j ? 1.0 : 0.0) + F[j * n + i] * (scale[i] / scale[j]);
    for (size_t j = 0; j < p; j++)
        for (size_t i = 0; i < k; i++)
            E[(k + j) * k + i] = F[(k + j) * n + i] * unit[j] * scale[i];
}

bool fmu_exponential(size_t k, size_t p, const double *A, const double *B,
                     size_t stride, double h, double *E)
{
    const size_t n = k + p;
    double *room = calloc((GROUP + 2) * n * n + 2 * n + 1, sizeof *room);
    double *power[GROUP];
    double *F = NULL, *work = NULL, *scale = NULL, *unit = NULL;
    double largest = 0.0;

    if (!room)
        return false;
    for (size_t j = 0; j < GROUP; j++)
        power[j] = room + j * n * n;
    F = room + GROUP * n * n;
    work = F + n * n;
    scale = work + n * n;
    unit = scale + n;
    balance(k, A, scale);
    largest = fill_states(k, n, A, scale, h, power[0]);
    for (size_t j = 0; j < p; j++)
        unit[j] = scale_input(k, B + j * stride, scale, largest, h,
                              power[0] + (k + j) * n);
    if (exponential_less_one(n, power, work, F))
        take_result(k, p, F, scale, unit, E);
    else
        for (size_t i = 0; i < k * n; i++)
            E[i] = (double)NAN;
    free(room);
    return true;
}
