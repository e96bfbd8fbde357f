/*
 * Ratios of modes; and a fit of a M + b K to ratios zeta_k at w_k: linear least
 * squares of
 *
 *     [1 / (2 w_k), w_k / 2] [a; b] = zeta_k
 *
 * As both columns and all zeta_k are positive, where one of a and b comes out
 * negative it is held to 0 and the other, fitted alone, is positive: the least
 * squares of a, b >= 0.
 */
#include "base/tolerances.h"

#include <ritz/damping.h>

#include <math.h>

/* Columns 1 / (2 w) and w / 2 of a point, and its ratio. */
static void equation(const double point[2], double row[3])
{
    double w = 2.0 * RITZ_PI * point[0];

    row[0] = 0.5 / w;
    row[1] = 0.5 * w;
    row[2] = point[1];
}

/* The column alone: its factor, and the sum of squares that it leaves. */
static double alone(const ritz_damping *damping, int column, double *left)
{
    double cc = 0.0, cz = 0.0;
    double row[3];

    for (int64_t k = 0; k < damping->count; k++) {
        equation(damping->point[k], row);
        cc += row[column] * row[column];
        cz += row[column] * row[2];
    }
    *left = 0.0;
    for (int64_t k = 0; k < damping->count; k++) {
        double r = 0.0;

        equation(damping->point[k], row);
        r = row[2] - cz / cc * row[column];
        *left += r * r;
    }
    return cz / cc;
}

/* Both columns: the second made orthogonal to the first. */
static void together(const ritz_damping *damping, double *a, double *b)
{
    double cc = 0.0, cd = 0.0, ee = 0.0, ez = 0.0, cz = 0.0;
    double row[3];

    for (int64_t k = 0; k < damping->count; k++) {
        equation(damping->point[k], row);
        cc += row[0] * row[0];
        cd += row[0] * row[1];
        cz += row[0] * row[2];
    }
    for (int64_t k = 0; k < damping->count; k++) {
        double e = 0.0;

        equation(damping->point[k], row);
        e = row[1] - cd / cc * row[0];
        ee += e * e;
        ez += e * row[2];
    }
    *b = ez / ee;
    *a = (cz - cd * *b) / cc;
}

void ritz_damping_fit(ritz_damping *damping)
{
    double left[2];
    double only_a = alone(damping, 0, &left[0]);
    double only_b = alone(damping, 1, &left[1]);

    together(damping, &damping->a, &damping->b);
    if (damping->a >= 0.0 && damping->b >= 0.0)
        return;
    damping->a = left[0] <= left[1] ? only_a : 0.0;
    damping->b = left[0] <= left[1] ? 0.0 : only_b;
}

double ritz_damping_misfit(const ritz_damping *damping, int64_t *at)
{
    double worst = 0.0;

    *at = 0;
    for (int64_t k = 0; damping->kind == RITZ_DAMPING_FIT && k < damping->count;
         k++) {
        double w = 2.0 * RITZ_PI * damping->point[k][0];
        double off =
            fabs(ritz_damping_ratio(damping, w) - damping->point[k][1]);

        if (off > worst) {
            worst = off;
            *at = k;
        }
    }
    return worst;
}

double ritz_damping_ratio(const ritz_damping *damping, double omega)
{
    double hertz = omega / (2.0 * RITZ_PI);

    switch (damping->kind) {
    case RITZ_DAMPING_NONE:
        break;
    case RITZ_DAMPING_MODAL:
        return damping->zeta;
    case RITZ_DAMPING_BANDS:
        /* an edge that two bands share is the upper one's */
        for (int64_t k = damping->count - 1; k >= 0; k--)
            if (hertz >= damping->band[k][0] && hertz <= damping->band[k][1])
                return damping->band[k][2];
        break;
    case RITZ_DAMPING_RAYLEIGH:
    case RITZ_DAMPING_FIT:
        /* phi'(a M + b K)phi = a + b omega^2 = 2 zeta omega */
        if (omega > 0.0)
            return 0.5 * (damping->a / omega + damping->b * omega);
        break;
    case RITZ_DAMPING_MODES:
        return damping->ratio[damping->count - 1];
    }
    return 0.0;
}

double ritz_damping_of_mode(const ritz_damping *damping, int64_t mode,
                            double omega)
{
    if (damping->kind == RITZ_DAMPING_MODES && mode >= 0 &&
        mode < damping->count)
        return damping->ratio[mode];
    return ritz_damping_ratio(damping, omega);
}
