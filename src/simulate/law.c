/*
 * The law g(c, c') of a stabilisation, as an input that is linear over a step.
 * At the end of the step c and c' are c* + X g and c'* + V g, where c* and c'*
 * are those with g = 0 there. Hence g solves
 *
 *     R(g) = g - law(c* + X g, c'* + V g) = 0,
 *     J = I - diag(dlaw/dc) X - diag(dlaw/dc') V
 *
 * by Newton's method, whose steps are halved until |R| falls: a law that
 * saturates on both sides of a layer has corners.
 */
#include "simulate/constrained.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_ITERATIONS = 60, MOST_HALVINGS = 40 };

ritz_status ritz_law_step_new(int64_t rank, ritz_law_step *out)
{
    RITZ_OWN(ritz_law_step) l = {.rank = rank};

    RITZ_CHECK(ritz_dense_new(rank, rank, &l.X));
    RITZ_CHECK(ritz_dense_new(rank, rank, &l.V));
    RITZ_CHECK(ritz_dense_new(rank, rank, &l.J));
    RITZ_CHECK_NEW(l.c, rank);
    RITZ_CHECK_NEW(l.rate, rank);
    RITZ_CHECK_NEW(l.trial, rank);
    RITZ_CHECK_NEW(l.residual, rank);
    RITZ_CHECK_NEW(l.change, rank);
    RITZ_MOVE(*out, l);
    return RITZ_OK;
}

void ritz_law_step_free(ritz_law_step *l)
{
    ritz_dense_free(&l->X);
    ritz_dense_free(&l->V);
    ritz_dense_free(&l->J);
    RITZ_FREE(l->c, l->rate, l->trial, l->residual, l->change);
    *l = (ritz_law_step){0};
}

/* R(g) and, if wanted, J; returns |R|. @p size becomes the size of its terms,
   to which rounding of R is relative: |g| + |law| + |dlaw/dc c| + |dlaw/dc'
   c'|. */
static double find_residual(const ritz_stabiliser *s, ritz_law_step *l,
                            const double *g, bool wanted, double *size)
{
    double sum = 0.0;

    *size = 0.0;
    for (int64_t i = 0; i < l->rank; i++) {
        double c = l->c[i];
        double rate = l->rate[i];
        double out[3] = {0.0};

        for (int64_t j = 0; j < l->rank; j++) {
            c += ritz_dense_col(&l->X, j)[i] * g[j];
            rate += ritz_dense_col(&l->V, j)[i] * g[j];
        }
        s->law(s, c, rate, out);
        l->residual[i] = g[i] - out[0];
        sum += l->residual[i] * l->residual[i];
        *size +=
            fabs(g[i]) + fabs(out[0]) + fabs(out[1] * c) + fabs(out[2] * rate);
        for (int64_t j = 0; wanted && j < l->rank; j++)
            ritz_dense_col(&l->J, j)[i] = (i == j ? 1.0 : 0.0) -
                                          out[1] * ritz_dense_col(&l->X, j)[i] -
                                          out[2] * ritz_dense_col(&l->V, j)[i];
    }
    return sqrt(sum);
}

/* Halve the change until |R| falls. */
static bool search_line(const ritz_stabiliser *s, ritz_law_step *l,
                        double residual, double *g)
{
    double part = 1.0, size = 0.0;

    for (int k = 0; k < MOST_HALVINGS; k++) {
        for (int64_t i = 0; i < l->rank; i++)
            l->trial[i] = g[i] - part * l->change[i];
        if (find_residual(s, l, l->trial, false, &size) < residual) {
            for (int64_t i = 0; i < l->rank; i++)
                g[i] = l->trial[i];
            return true;
        }
        part *= 0.5;
    }
    return false;
}

ritz_status ritz_law_step_solve(const ritz_stabiliser *s, ritz_law_step *l,
                                double *g)
{
    ritz_dense change = {l->rank, 1, l->change}; /* borrowed */

    for (int k = 0; k < MOST_ITERATIONS; k++) {
        RITZ_OWN(ritz_general_factor) F = {0};
        double size = 0.0;
        const double residual = find_residual(s, l, g, true, &size);

        if (!(residual > RITZ_LAW_SOLVED * size))
            return RITZ_OK;
        RITZ_CHECK_IN("the law of constraints",
                      ritz_general_factor_new(&l->J, &F));
        for (int64_t i = 0; i < l->rank; i++)
            l->change[i] = l->residual[i];
        ritz_general_factor_solve(&F, false, &change);
        if (!search_line(s, l, residual, g))
            return residual <= RITZ_SAME * size
                       ? RITZ_OK
                       : ritz_fail(RITZ_ERR_CONVERGENCE,
                                   "the law of constraints has no solution at "
                                   "the end of a step: take smaller steps");
    }
    return ritz_fail(RITZ_ERR_CONVERGENCE,
                     "the law of constraints does not settle within a step: "
                     "take smaller steps");
}
