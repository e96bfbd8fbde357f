/*
 * The motion of joined bodies with the terms of a stabilisation, to which any
 * ritz_integrator can be applied. With multipliers it is
 *
 *     c'' + damping c' + stiffness c = g
 *     p'' = (B u - D x' - K x)_p,
 *
 * so that the motion that satisfies the constraints does not change, and
 * without them
 *
 *     (1 + inertia) c'' + damping c' + stiffness c = (B u - D x' - K x)_c + g
 *     p'' = (B u - D x' - K x)_p.
 */
#include "simulate/constrained.h"

#include "base/alloc.h"

#include <math.h>

/* The rows of c become 0 if @p cleared, then A += add on their diagonal. */
static void hold_rows(const ritz_linked *j, bool cleared, double add,
                      ritz_dense *A)
{
    for (int64_t i = 0; i < j->rank; i++) {
        for (int64_t k = 0; cleared && k < A->ncol; k++)
            ritz_dense_col(A, k)[i] = 0.0;
        if (add != 0.0)
            ritz_dense_col(A, i)[i] += add;
    }
}

/* Inputs of the bodies, followed by g. */
static ritz_status fill_inputs(const ritz_linked *j, const ritz_stabiliser *s,
                               ritz_motion *m)
{
    const ritz_dense *B = &j->motion.B;
    const int64_t laws = s->law ? j->rank : 0;

    RITZ_CHECK(ritz_dense_new(j->motion.n, B->ncol + laws, &m->B));
    ritz_dense_put(B, 0, 0, &m->B);
    hold_rows(j, s->multipliers, 0.0, &m->B);
    for (int64_t k = 0; k < laws; k++)
        ritz_dense_col(&m->B, B->ncol + k)[k] = 1.0;
    RITZ_CHECK(ritz_dense_copy(&m->B, &m->push));
    for (int64_t k = 0; k < m->push.ncol; k++)
        for (int64_t i = 0; i < j->rank; i++)
            ritz_dense_col(&m->push, k)[i] /= 1.0 + s->inertia;
    return RITZ_OK;
}

ritz_status ritz_stabilised_motion(const ritz_linked *joined,
                                   const ritz_stabiliser *s, ritz_motion *out)
{
    RITZ_OWN(ritz_motion) m = {.form = RITZ_FORM_DENSE, .any_step = true};

    m.n = m.original = joined->motion.n;
    RITZ_CHECK(ritz_dense_copy(&joined->motion.K, &m.K));
    hold_rows(joined, s->multipliers, s->stiffness, &m.K);
    RITZ_CHECK(ritz_dense_copy(&joined->motion.D, &m.D));
    hold_rows(joined, s->multipliers, s->damping, &m.D);
    RITZ_CHECK(ritz_dense_identity(m.n, &m.M));
    hold_rows(joined, false, s->inertia, &m.M);
    RITZ_CHECK(fill_inputs(joined, s, &m));
    RITZ_CHECK(ritz_stabilised_highest(joined, s, &m.highest));
    RITZ_MOVE(*out, m);
    return RITZ_OK;
}

/* Largest eigenvalue of a symmetric matrix; 0 for an empty one. */
static ritz_status find_largest(const ritz_dense *A, double *out)
{
    RITZ_OWN_ARRAY double *lambda = NULL;

    RITZ_CHECK_NEW(lambda, A->nrow);
    RITZ_CHECK(ritz_general_symmetric_values(A, lambda));
    *out = A->nrow > 0 ? fmax(lambda[A->nrow - 1], 0.0) : 0.0;
    return RITZ_OK;
}

/*
 * With multipliers, the larger of the highest eigenvalue of K_pp, which is that
 * of the joined bodies, and the largest stiffness of c. Without them, the
 * highest eigenvalue of F K F, F = M^-1/2.
 */
ritz_status ritz_stabilised_highest(const ritz_linked *joined,
                                    const ritz_stabiliser *s, double *out)
{
    const double scale = s->multipliers ? 0.0 : 1.0 / sqrt(1.0 + s->inertia);
    RITZ_OWN(ritz_dense) A = {0};

    RITZ_CHECK(ritz_dense_copy(&joined->motion.K, &A));
    if (!s->multipliers)
        hold_rows(joined, false, s->stiffness, &A);
    for (int64_t i = 0; i < joined->rank; i++)
        for (int64_t k = 0; k < A.ncol; k++) {
            ritz_dense_col(&A, k)[i] *= scale;
            ritz_dense_col(&A, i)[k] *= scale;
        }
    RITZ_CHECK(find_largest(&A, out));
    if (s->multipliers && joined->rank > 0)
        *out = fmax(*out, s->stiffest);
    return RITZ_OK;
}
