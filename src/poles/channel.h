/*
 * What zeros are sought of: some inputs and outputs of
 *
 *     x' = A x + B u,    y = C x + D u
 *
 * or, if `squared`, of x'' = A x + B u, whose eigenvalues and zeros are s^2.
 */
#ifndef RITZ_POLES_CHANNEL_H
#define RITZ_POLES_CHANNEL_H

#include <ritz/response.h>
#include <ritz/state_space.h>
#include <ritz/zeros.h>

#include <complex.h>

typedef struct ritz_channel {
    ritz_dense A, B, C, D;
    bool squared;       /* then A is diagonal */
    bool blocks;        /* A is [0 w; -l/w -d] of pairs of states k, k + n/2 */
    int64_t derivative; /* y is that derivative of what is above: so many zeros
                           at 0, but where poles are */
} ritz_channel;

/* Complex triangular form of one channel: poles are on the diagonal. */
typedef struct ritz_triangle {
    int64_t n, band; /* entries above the diagonal lie within `band` of it */
    double _Complex *T, *b, *c;
    double d;
    bool *cancelled;              /* n, poles that do not count */
    double _Complex *x, *w, *two; /* to work in */
} ritz_triangle;

/** Whether there is such a channel, or all at once can be asked for. */
ritz_status ritz_channel_check(int64_t outputs, int64_t inputs, int64_t output,
                               int64_t input);

ritz_status ritz_channel_dense(const ritz_second_order *model,
                               const ritz_damping *damping, int64_t output,
                               int64_t input, ritz_channel *out);
ritz_status ritz_channel_states(const ritz_state_space *model, int64_t output,
                                int64_t input, ritz_channel *out);

/**
 * Finite zeros as the pencil has them, which rounding of its largest entries
 * moves; conjugate pairs one after the other (SLICOT AB08ND).
 */
ritz_status ritz_channel_pencil(const ritz_channel *channel, int64_t *count,
                                double _Complex **out);

/** @return RITZ_ERR_CONVERGENCE */
ritz_status ritz_triangle_new(const ritz_channel *channel, ritz_triangle *out);

/* A value, its derivatives, and how far rounding may move the value. */
typedef struct ritz_sample {
    double _Complex f, first, second;
    double error;
} ritz_sample;

/** d + c (z I - T)^-1 b; z is no pole. @cost O(n band) */
void ritz_triangle_at(const ritz_triangle *triangle, double _Complex z,
                      ritz_sample *out);

/** Drop zeros on poles, make the others as good as the triangle is, and drop
 * those that cannot be told from infinity. */
ritz_status ritz_zeros_polish(ritz_triangle *triangle, int64_t *count,
                              double _Complex *zero);

void ritz_channel_free(ritz_channel *channel);
void ritz_triangle_free(ritz_triangle *triangle);

#endif
