/* Rotations and directions in space, 3 x 3 row by row. */
#ifndef RITZ_ASSEMBLY_TURNS_H
#define RITZ_ASSEMBLY_TURNS_H

/** Rotation by @p degrees about a unit axis; quarter turns are exact. */
void ritz_turn_about(const double axis[static 3], double degrees,
                     double R[static 9]);

/** C = A B. */
void ritz_turn_product(const double A[static 9], const double B[static 9],
                       double C[static 9]);

/** C = A'B. */
void ritz_turn_between(const double A[static 9], const double B[static 9],
                       double C[static 9]);

/** y = R x, and y = R'x. */
void ritz_turn_apply(const double R[static 9], const double x[static 3],
                     double y[static 3]);
void ritz_turn_back(const double R[static 9], const double x[static 3],
                    double y[static 3]);

/** c = a x b. */
void ritz_cross(const double a[static 3], const double b[static 3],
                double c[static 3]);

double ritz_dot(const double a[static 3], const double b[static 3]);

#endif
