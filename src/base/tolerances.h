/*
 * Every tolerance of the library, with its reason. A number in a comparison
 * anywhere else is a mathematical constant of that method, with its source.
 *
 * eps is 2^-52, the distance from 1 to the next larger double.
 */
#ifndef RITZ_BASE_TOLERANCES_H
#define RITZ_BASE_TOLERANCES_H

#define RITZ_PI 3.14159265358979323846

#endif
