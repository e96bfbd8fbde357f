#include "assembly/turns.h"

#include "base/tolerances.h"

#include <math.h>
#include <stdint.h>

void ritz_turn_about(const double axis[static 3], double degrees,
                     double R[static 9])
{
    /* quarter turns are exact, so that 90 degrees swaps axes and no more */
    double quarter = fmod(degrees, 90.0) == 0.0
                         ? fmod(fmod(degrees / 90.0, 4.0) + 4.0, 4.0)
                         : -1.0;
    static const double sines[] = {0.0, 1.0, 0.0, -1.0, 0.0};
    double s =
        quarter >= 0.0 ? sines[(int)quarter] : sin(degrees * RITZ_PI / 180.0);
    double c = quarter >= 0.0 ? sines[(int)quarter + 1]
                              : cos(degrees * RITZ_PI / 180.0);
    const double skew[9] = {0.0,      -axis[2], axis[1], axis[2], 0.0,
                            -axis[0], -axis[1], axis[0], 0.0};

    for (int64_t i = 0; i < 3; i++)
        for (int64_t j = 0; j < 3; j++)
            R[3 * i + j] = (i == j ? c : 0.0) + s * skew[3 * i + j] +
                           (1.0 - c) * axis[i] * axis[j];
}

void ritz_turn_product(const double A[static 9], const double B[static 9],
                       double C[static 9])
{
    for (int64_t i = 0; i < 3; i++)
        for (int64_t j = 0; j < 3; j++)
            C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] +
                           A[3 * i + 2] * B[6 + j];
}

void ritz_turn_between(const double A[static 9], const double B[static 9],
                       double C[static 9])
{
    for (int64_t i = 0; i < 3; i++)
        for (int64_t j = 0; j < 3; j++)
            C[3 * i + j] =
                A[i] * B[j] + A[3 + i] * B[3 + j] + A[6 + i] * B[6 + j];
}

void ritz_turn_apply(const double R[static 9], const double x[static 3],
                     double y[static 3])
{
    for (int64_t i = 0; i < 3; i++)
        y[i] = R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2];
}

void ritz_turn_back(const double R[static 9], const double x[static 3],
                    double y[static 3])
{
    for (int64_t i = 0; i < 3; i++)
        y[i] = R[i] * x[0] + R[3 + i] * x[1] + R[6 + i] * x[2];
}

void ritz_cross(const double a[static 3], const double b[static 3],
                double c[static 3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;

        c[i] = a[j] * b[k] - a[k] * b[j];
    }
}

double ritz_dot(const double a[static 3], const double b[static 3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void ritz_normalise(double x[static 3])
{
    double length = sqrt(ritz_dot(x, x));

    for (int i = 0; i < 3; i++)
        x[i] /= length;
}

void ritz_normals(const double axis[static 3], double e[static 2][3])
{
    double start[3] = {0.0, 0.0, 0.0};
    int least = 0;

    for (int i = 1; i < 3; i++)
        if (fabs(axis[i]) < fabs(axis[least]))
            least = i;
    start[least] = 1.0;
    ritz_cross(axis, start, e[0]);
    ritz_normalise(e[0]);
    ritz_cross(axis, e[0], e[1]);
}
