/*
 * The part of the initial state that a basis does not span. Let x be a vector
 * in all modes at the start, with the mass matrix I and the stiffness Lambda.
 * The columns of S, the basis in these modes, are orthonormal, and
 *
 *     d = x - S S'x,   share of the mass norm  d'd / x'x,
 *     share of the strain energy  d'Lambda d / x'Lambda x
 *
 * are computed from d, so that a small share has digits. The static response to
 * an input b is Lambda^+ b.
 */
#include "simulate/swept.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "simulate/motion.h"

#include <math.h>
#include <string.h>

/* d of x. */
static void find_rest(const ritz_swept_model *m, const double *x, double *d)
{
    const int64_t e = m->start.nrow;

    memcpy(d, x, (size_t)e * sizeof *d);
    for (int64_t j = 0; j < m->start.ncol; j++) {
        const double *s = ritz_dense_col(&m->start, j);
        const double q = ritz_motion_dot(e, s, x);

        for (int64_t k = 0; k < e; k++)
            d[k] -= q * s[k];
    }
}

/* x'Lambda x */
static double strain(const ritz_swept_model *m, const double *x)
{
    double sum = 0.0;

    for (int64_t k = 0; k < m->start.nrow; k++)
        sum += m->start_lambda[k] * x[k] * x[k];
    return sum;
}

/* A ratio of squares; 0 if both are 0. */
static double share(double part, double all)
{
    return all > 0.0 ? fmin(part / all, 1.0) : 0.0;
}

/* The largest share of a displacement or a velocity that the basis spans. */
static double left_of(const double square[2], const ritz_swept_lost *lost)
{
    return fmax(square[0] > 0.0 ? 1.0 - lost->displacement : 0.0,
                square[1] > 0.0 ? 1.0 - lost->velocity : 0.0);
}

ritz_status ritz_swept_lost_state(const ritz_swept_model *m, const double *x0,
                                  const double *v0, ritz_swept_lost *out)
{
    const int64_t e = m->start.nrow, rigid = m->start_rigid;
    const double least = rigid < e ? m->start_lambda[rigid] : 0.0;
    const double square[2] = {x0 ? ritz_motion_dot(e, x0, x0) : 0.0,
                              v0 ? ritz_motion_dot(e, v0, v0) : 0.0};
    RITZ_OWN_ARRAY double *d = NULL;
    ritz_swept_lost lost = {0};

    RITZ_CHECK_NEW(d, e);
    if (square[0] > 0.0) {
        const double all = strain(m, x0);

        find_rest(m, x0, d);
        lost.displacement = share(ritz_motion_dot(e, d, d), square[0]);
        /* the strain of a rigid motion is rounding */
        if (all > RITZ_NEGLIGIBLE * least * square[0])
            lost.strain = share(strain(m, d), all);
    }
    if (square[1] > 0.0) {
        find_rest(m, v0, d);
        lost.velocity = share(ritz_motion_dot(e, d, d), square[1]);
    }
    lost.all =
        square[0] + square[1] > 0.0 && left_of(square, &lost) < RITZ_SWEPT_LEFT;
    *out = lost;
    return RITZ_OK;
}

ritz_status ritz_swept_lost_force(const ritz_swept_model *m, int64_t input,
                                  double *out)
{
    const int64_t e = m->start.nrow, rigid = m->start_rigid;
    const double *b = ritz_dense_col(&m->start_B, input);
    RITZ_OWN_ARRAY double *x = NULL, *d = NULL;

    *out = nan("");
    if (ritz_motion_dot(rigid, b, b) >
        RITZ_NEGLIGIBLE * ritz_motion_dot(e, b, b))
        return RITZ_OK;
    RITZ_CHECK_NEW(x, e);
    RITZ_CHECK_NEW(d, e);
    for (int64_t k = rigid; k < e; k++)
        x[k] = b[k] / m->start_lambda[k];
    find_rest(m, x, d);
    if (strain(m, x) > 0.0)
        *out = share(strain(m, d), strain(m, x));
    return RITZ_OK;
}
