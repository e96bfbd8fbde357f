/*
 * The motion of joined bodies with the terms of a stabilisation, to which any
 * ritz_integrator can be applied. With P = I - W'W, it is with multipliers
 *
 *     z'' = P (B u - D z' - Lambda z) - W'(damping c' + stiffness c - g),
 *
 * and without them
 *
 *     (I + inertia W'W) z'' + (D + damping W'W) z'
 *         + (Lambda + stiffness W'W) z = B u + W'g.
 *
 * With multipliers c'' = - damping c' - stiffness c + g for any motion of the
 * bodies, and the motion that satisfies the constraints does not change.
 */
#include "simulate/constrained.h"

#include "base/alloc.h"

#include <math.h>

/* A -= W'(W A) if @p projected, then A += add W'W. */
static ritz_status fold(const ritz_linked *j, bool projected, double add,
                        ritz_dense *A)
{
    RITZ_OWN(ritz_dense) WA = {0}, part = {0};

    if (projected && j->rank > 0) {
        RITZ_CHECK(ritz_dense_mul(&j->W, A, &WA));
        RITZ_CHECK(ritz_dense_mul_tn(&j->W, &WA, &part));
        ritz_dense_add(-1.0, &part, A);
        ritz_dense_free(&part);
    }
    if (add != 0.0 && j->rank > 0) {
        RITZ_CHECK(ritz_dense_mul_tn(&j->W, &j->W, &part));
        ritz_dense_add(add, &part, A);
    }
    return RITZ_OK;
}

static ritz_status fill_stiffness(const ritz_linked *j, ritz_dense *K)
{
    RITZ_CHECK(ritz_dense_new(j->motion.n, j->motion.n, K));
    for (int64_t k = 0; k < j->motion.n; k++)
        ritz_dense_col(K, k)[k] = j->motion.lambda[k];
    return RITZ_OK;
}

/* Inputs of the bodies, followed by g. */
static ritz_status fill_inputs(const ritz_linked *j, const ritz_stabiliser *s,
                               ritz_motion *m)
{
    const ritz_dense *B = &j->motion.B;
    RITZ_OWN(ritz_dense) own = {0}, Wt = {0};

    RITZ_CHECK(ritz_dense_copy(B, &own));
    RITZ_CHECK(fold(j, s->multipliers, 0.0, &own));
    RITZ_CHECK(
        ritz_dense_new(j->motion.n, B->ncol + (s->law ? j->rank : 0), &m->B));
    ritz_dense_put(&own, 0, 0, &m->B);
    if (s->law) {
        RITZ_CHECK(ritz_general_transpose(&j->W, &Wt));
        ritz_dense_put(&Wt, 0, B->ncol, &m->B);
    }
    return RITZ_OK;
}

ritz_status ritz_stabilised_motion(const ritz_linked *joined,
                                   const ritz_stabiliser *s, ritz_motion *out)
{
    RITZ_OWN(ritz_motion) m = {.form = RITZ_FORM_DENSE, .any_step = true};

    m.n = m.original = joined->motion.n;
    RITZ_CHECK(fill_stiffness(joined, &m.K));
    RITZ_CHECK(fold(joined, s->multipliers, s->stiffness, &m.K));
    if (joined->motion.D.val)
        RITZ_CHECK(ritz_dense_copy(&joined->motion.D, &m.D));
    else
        RITZ_CHECK(ritz_dense_new(m.n, m.n, &m.D));
    RITZ_CHECK(fold(joined, s->multipliers, s->damping, &m.D));
    RITZ_CHECK(ritz_dense_identity(m.n, &m.M));
    RITZ_CHECK(fold(joined, false, s->inertia, &m.M));
    RITZ_CHECK(fill_inputs(joined, s, &m));
    RITZ_CHECK(ritz_dense_copy(&m.B, &m.push));
    if (s->inertia > 0.0)
        RITZ_CHECK(ritz_general_solve(&m.M, false, &m.push));
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
 * With multipliers, the larger of the highest eigenvalue of P Lambda P, which
 * is that of the joined bodies, and the largest stiffness of c. Without them,
 * the highest eigenvalue of F K F, F = (I + inertia W'W)^-1/2 = I + ((1 +
 * inertia)^-1/2 - 1) W'W.
 */
ritz_status ritz_stabilised_highest(const ritz_linked *joined,
                                    const ritz_stabiliser *s, double *out)
{
    const double root =
        s->multipliers ? -1.0 : 1.0 / sqrt(1.0 + s->inertia) - 1.0;
    RITZ_OWN(ritz_dense) K = {0}, F = {0}, A = {0};

    RITZ_CHECK(fill_stiffness(joined, &K));
    if (!s->multipliers)
        RITZ_CHECK(fold(joined, false, s->stiffness, &K));
    RITZ_CHECK(ritz_dense_identity(joined->motion.n, &F));
    RITZ_CHECK(fold(joined, false, root, &F));
    RITZ_CHECK(ritz_dense_congruence(&K, &F, &A));
    RITZ_CHECK(find_largest(&A, out));
    if (s->multipliers && joined->rank > 0)
        *out = fmax(*out, s->stiffest);
    return RITZ_OK;
}
