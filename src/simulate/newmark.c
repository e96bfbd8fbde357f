/*
 * One step solves for the acceleration a_1 at its end: with predictors
 * x* = x_0 + h v_0 + h^2 (1/2 - beta) a_0 and v* = v_0 + h (1 - gamma) a_0
 *
 *     [(1 - alpha_m) M + (1 - alpha_f) (gamma h D + beta h^2 K)] a_1 =
 *         B u_f - alpha_m M a_0 - D v_f* - K x_f*
 *
 * v_f* = (1 - alpha_f) v* + alpha_f v_0, and x_f*, u_f likewise
 * [Newmark1959, ChungHulbert1993]. With alpha_f = 0 the end of each step is in
 * equilibrium, dofs without mass too.
 *
 * Where an input has jumped since the end of the last step, a_0 is made to
 * follow: a_0 += M^-1 B (u_0 - u_last).
 *
 * Work of the inputs is u'B (x_1 - x_0), u = (u_0 + u_1) / 2, and damping takes
 * h v'D v with v = (x_1 - x_0) / h. Of the trapezoidal rule, alpha = 0,
 * beta = 1/4, gamma = 1/2, whose steps begin and end in equilibrium, energies
 * then balance exactly, as
 *
 *     (x_1 - x_0)'(M (v_1 - v_0) / h + D v + K (x_1 + x_0) / 2 - B u) = 0.
 */
#include "simulate/motion.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

typedef struct newmark {
    ritz_newmark w;
    ritz_effective F;
    double *a;    /* n, at the end of the last step */
    double *x0;   /* n */
    double *rhs;  /* n */
    double *work; /* n */
    double *last; /* inputs at the end of the last step */
} newmark;

static void release_newmark(void *own)
{
    newmark *s = own;

    ritz_effective_free(&s->F);
    RITZ_FREE(s->a, s->x0, s->rhs, s->work, s->last, s);
}

/* a from equilibrium; dofs without mass have none. */
static ritz_status settle_start(ritz_march *march, const double *u)
{
    const ritz_motion *m = march->motion;
    newmark *s = march->own;
    RITZ_OWN(ritz_effective) mass = {0};

    memset(s->a, 0, (size_t)m->n * sizeof *s->a);
    ritz_motion_gemv(&m->B, 1.0, u, s->a);
    ritz_motion_stiffness(m, -1.0, march->x, s->a);
    ritz_motion_damping(m, -1.0, march->v, s->a);
    for (int64_t k = 0; m->massless && k < m->n; k++)
        s->a[k] = m->massless[k] ? 0.0 : s->a[k];
    RITZ_CHECK_IN(
        "M", ritz_effective_new(m, 1.0, 0.0, 0.0, m->massless != NULL, &mass));
    RITZ_CHECK(ritz_effective_solve(&mass, 1, s->a));
    memcpy(s->last, u, (size_t)m->B.ncol * sizeof *u);
    return RITZ_OK;
}

static void follow_jumps(const ritz_motion *m, const double *u, newmark *s)
{
    for (int64_t j = 0; j < m->B.ncol; j++) {
        double jump = u[j] - s->last[j];
        const double *push = ritz_dense_col(&m->push, j);

        for (int64_t k = 0; jump != 0.0 && k < m->n; k++)
            s->a[k] += jump * push[k];
    }
}

/* The right side: loads and what the predictors leave of equilibrium. */
static void load_step(const ritz_march *march, const double *u0,
                      const double *u1, newmark *s)
{
    const ritz_motion *m = march->motion;
    const ritz_newmark *w = &s->w;
    double h = march->step;
    double f1 = 1.0 - w->alpha_f;

    memset(s->rhs, 0, (size_t)m->n * sizeof *s->rhs);
    ritz_motion_gemv(&m->B, f1, u1, s->rhs);
    if (w->alpha_f != 0.0)
        ritz_motion_gemv(&m->B, w->alpha_f, u0, s->rhs);
    if (w->alpha_m != 0.0)
        ritz_motion_mass(m, -w->alpha_m, s->a, s->rhs);
    for (int64_t k = 0; k < m->n; k++)
        s->work[k] = march->x[k] +
                     f1 * h * (march->v[k] + h * (0.5 - w->beta) * s->a[k]);
    ritz_motion_stiffness(m, -1.0, s->work, s->rhs);
    for (int64_t k = 0; k < m->n; k++)
        s->work[k] = march->v[k] + f1 * h * (1.0 - w->gamma) * s->a[k];
    ritz_motion_damping(m, -1.0, s->work, s->rhs);
}

/* x, v and a at the end; a_1 is in rhs. */
static void move_step(ritz_march *march, newmark *s)
{
    const ritz_newmark *w = &s->w;
    double h = march->step;

    for (int64_t k = 0; k < march->motion->n; k++) {
        double a0 = s->a[k];
        double a1 = s->rhs[k];

        march->x[k] +=
            h * march->v[k] + h * h * ((0.5 - w->beta) * a0 + w->beta * a1);
        march->v[k] += h * ((1.0 - w->gamma) * a0 + w->gamma * a1);
        s->a[k] = a1;
    }
}

static void account_energy(ritz_march *march, const double *u0,
                           const double *u1, newmark *s)
{
    const ritz_motion *m = march->motion;

    for (int64_t k = 0; k < m->n; k++)
        s->x0[k] = march->x[k] - s->x0[k];
    for (int64_t j = 0; j < m->B.ncol; j++)
        march->work += 0.5 * (u0[j] + u1[j]) *
                       ritz_motion_dot(m->n, ritz_dense_col(&m->B, j), s->x0);
    memset(s->work, 0, (size_t)m->n * sizeof *s->work);
    ritz_motion_damping(m, 1.0 / march->step, s->x0, s->work);
    march->dissipated += ritz_motion_dot(m->n, s->x0, s->work);
}

static ritz_status advance_newmark(ritz_march *march, const double *u0,
                                   const double *u1)
{
    const ritz_motion *m = march->motion;
    newmark *s = march->own;

    follow_jumps(m, u0, s);
    if (m->energies)
        memcpy(s->x0, march->x, (size_t)m->n * sizeof *s->x0);
    load_step(march, u0, u1, s);
    RITZ_CHECK(ritz_effective_solve(&s->F, 1, s->rhs));
    move_step(march, s);
    if (m->energies)
        account_energy(march, u0, u1, s);
    memcpy(s->last, u1, (size_t)m->B.ncol * sizeof *u1);
    return RITZ_OK;
}

ritz_status ritz_newmark_start(const ritz_motion *motion, double step,
                               const ritz_newmark *weights, ritz_march *out)
{
    const ritz_newmark *w = weights;
    double f1 = 1.0 - w->alpha_f;
    newmark *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->own = s;
    out->advance = advance_newmark;
    out->settle = settle_start;
    out->free = release_newmark;
    s->w = *w;
    RITZ_CHECK_NEW(s->a, motion->n);
    RITZ_CHECK_NEW(s->x0, motion->n);
    RITZ_CHECK_NEW(s->rhs, motion->n);
    RITZ_CHECK_NEW(s->work, motion->n);
    RITZ_CHECK_NEW(s->last, motion->B.ncol);
    return ritz_effective_new(motion, 1.0 - w->alpha_m, f1 * w->gamma * step,
                              f1 * w->beta * step * step, false, &s->F);
}
