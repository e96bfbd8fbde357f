/* Products of vectors with three components. */
#ifndef RITZ_BASE_VECTOR_H
#define RITZ_BASE_VECTOR_H

/** a . b */
static inline double ritz_dot(const double a[static 3],
                              const double b[static 3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** out = a x b; @p out must not be @p a or @p b. */
static inline void ritz_cross(const double a[static 3],
                              const double b[static 3], double out[static 3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

#endif
