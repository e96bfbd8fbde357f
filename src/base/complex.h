#ifndef RITZ_BASE_COMPLEX_H
#define RITZ_BASE_COMPLEX_H

#include <complex.h>

/* CMPLX is not to be had of every compiler, and I is a float. */
static inline double _Complex ritz_complex(double re, double im)
{
    return re + (double _Complex)_Complex_I * im;
}

#endif
