/*
 * The family of Newmark and generalised-alpha integrators: with z_b =
 * (1 - b) z_1 + b z_0,
 *
 *     M a_(alpha_m) + D v_(alpha_f) + K x_(alpha_f) = B u_(alpha_f)
 *     x_1 = x_0 + h v_0 + h^2 ((1/2 - beta) a_0 + beta a_1)
 *     v_1 = v_0 + h ((1 - gamma) a_0 + gamma a_1)
 *
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
 * In modes K and M are diagonal. If D is too, so is the matrix of a step, S. If
 * D couples modes, S = A + c D with A diagonal and c = (1 - alpha_f) gamma h, so
 * that D v_f* = (S - A) v_f* / c needs no product:
 *
 *     S y = A v_f* + c (B u_f - alpha_m M a_0 - K x_f*),   a_1 = (y - v_f*) / c
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
#include "base/tolerances.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct newmark {
    ritz_newmark_weights w;
    ritz_effective F;
    double *memory; /* a, then last */
    double *a;      /* n, at the end of the last step */
    double *x0;     /* n */
    double *rhs;    /* n */
    double *work;   /* n */
    double *last;   /* inputs at the end of the last step */
    double c;
    double *A;       /* n; NULL: full or sparse matrices */
    bool uncoupled;  /* D is diagonal, and S too: A + c D */
    ritz_dense half; /* symmetric part of D, if modes are coupled by it and
                        energies requested; {0} */
} newmark;

static void release_newmark(void *own)
{
    newmark *s = own;

    ritz_effective_free(&s->F);
    ritz_dense_free(&s->half);
    RITZ_FREE(s->memory, s->x0, s->rhs, s->work, s->A, s);
}

/* a from equilibrium; dofs without mass have none. */
static ritz_status settle_start(ritz_march *march, const double *u)
{
    const ritz_motion *m = march->motion;
    newmark *s = march->own;
    RITZ_OWN(ritz_effective) mass = {0};

    memset(s->a, 0, (size_t)m->n * sizeof *s->a);
    ritz_motion_gemv(&m->B, 1.0, u, s->a);
    ritz_motion_add(m, RITZ_STIFFNESS, -1.0, march->x, s->a);
    ritz_motion_add(m, RITZ_DAMPING, -1.0, march->v, s->a);
    for (int64_t k = 0; m->massless && k < m->n; k++)
        s->a[k] = m->massless[k] ? 0.0 : s->a[k];
    if (m->form != RITZ_FORM_MODAL) {
        RITZ_CHECK_IN("M", ritz_effective_new(m, 1.0, 0.0, 0.0,
                                              m->massless != NULL, &mass));
        RITZ_CHECK(ritz_effective_solve(&mass, 1, s->a));
    }
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

/* The right side, without damping forces; v_f* in `work`. */
static void load_step(const ritz_march *march, const double *u0,
                      const double *u1, newmark *s)
{
    const ritz_motion *m = march->motion;
    const ritz_newmark_weights *w = &s->w;
    double h = march->step;
    double f1 = 1.0 - w->alpha_f;

    memset(s->rhs, 0, (size_t)m->n * sizeof *s->rhs);
    ritz_motion_gemv(&m->B, f1, u1, s->rhs);
    if (w->alpha_f != 0.0)
        ritz_motion_gemv(&m->B, w->alpha_f, u0, s->rhs);
    if (w->alpha_m != 0.0)
        ritz_motion_add(m, RITZ_MASS, -w->alpha_m, s->a, s->rhs);
    for (int64_t k = 0; k < m->n; k++)
        s->work[k] = march->x[k] +
                     f1 * h * (march->v[k] + h * (0.5 - w->beta) * s->a[k]);
    ritz_motion_add(m, RITZ_STIFFNESS, -1.0, s->work, s->rhs);
    for (int64_t k = 0; k < m->n; k++)
        s->work[k] = march->v[k] + f1 * h * (1.0 - w->gamma) * s->a[k];
}

/* a_1 in rhs. */
static ritz_status solve_step(const ritz_motion *m, newmark *s)
{
    if (!s->A) {
        ritz_motion_add(m, RITZ_DAMPING, -1.0, s->work, s->rhs);
        return ritz_effective_solve(&s->F, 1, s->rhs);
    }
    if (s->uncoupled) {
        for (int64_t k = 0; k < m->n; k++) {
            const double d = ritz_dense_col(&m->D, k)[k];

            s->rhs[k] = (s->rhs[k] - d * s->work[k]) / (s->A[k] + s->c * d);
        }
        return RITZ_OK;
    }
    for (int64_t k = 0; k < m->n; k++)
        s->rhs[k] = s->A[k] * s->work[k] + s->c * s->rhs[k];
    RITZ_CHECK(ritz_effective_solve(&s->F, 1, s->rhs));
    for (int64_t k = 0; k < m->n; k++)
        s->rhs[k] = (s->rhs[k] - s->work[k]) / s->c;
    return RITZ_OK;
}

/* x'D x */
static double damping_form(const ritz_motion *m, newmark *s, const double *x)
{
    double sum = 0.0;

    if (s->uncoupled) {
        for (int64_t k = 0; k < m->n; k++)
            sum += ritz_dense_col(&m->D, k)[k] * x[k] * x[k];
        return sum;
    }
    if (s->half.val)
        return ritz_motion_form(&s->half, x);
    memset(s->work, 0, (size_t)m->n * sizeof *s->work);
    ritz_motion_add(m, RITZ_DAMPING, 1.0, x, s->work);
    return ritz_motion_dot(m->n, x, s->work);
}

/* x, v and a at the end; a_1 is in rhs. */
static void move_step(ritz_march *march, newmark *s)
{
    const ritz_newmark_weights *w = &s->w;
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
    march->dissipated += damping_form(m, s, s->x0) / march->step;
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
    RITZ_CHECK(solve_step(m, s));
    move_step(march, s);
    if (m->energies)
        account_energy(march, u0, u1, s);
    memcpy(s->last, u1, (size_t)m->B.ncol * sizeof *u1);
    return RITZ_OK;
}

/* Whether D is diagonal but for rounding, as `modal` decides it. */
static ritz_status is_uncoupled(const ritz_motion *motion, bool *out)
{
    RITZ_OWN(ritz_groups) parts = {0};

    RITZ_CHECK(ritz_groups_new(
        &motion->D, RITZ_SUM_ROUNDING * ritz_dense_max(&motion->D), &parts));
    *out = parts.count == motion->n;
    return RITZ_OK;
}

static ritz_status factor_step(const ritz_motion *motion, double step,
                               newmark *s)
{
    const double f1 = 1.0 - s->w.alpha_f, m = 1.0 - s->w.alpha_m;
    const double k = f1 * s->w.beta * step * step;

    s->c = f1 * s->w.gamma * step;
    if (motion->form == RITZ_FORM_MODAL) {
        RITZ_CHECK_NEW(s->A, motion->n);
        for (int64_t j = 0; j < motion->n; j++)
            s->A[j] = m + k * motion->lambda[j];
        RITZ_CHECK(is_uncoupled(motion, &s->uncoupled));
        if (motion->energies && !s->uncoupled) {
            RITZ_CHECK(ritz_dense_copy(&motion->D, &s->half));
            ritz_dense_symmetrise(&s->half);
        }
    }
    return s->uncoupled ? RITZ_OK
                        : ritz_effective_new(motion, m, s->c, k, false, &s->F);
}

static ritz_status start_newmark(const ritz_motion *motion, double step,
                                 const ritz_newmark_weights *w, ritz_march *out)
{
    newmark *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->own = s;
    out->advance = advance_newmark;
    out->settle = settle_start;
    out->free = release_newmark;
    s->w = *w;
    out->num_memory = motion->n + motion->B.ncol;
    RITZ_CHECK_NEW(s->memory, out->num_memory);
    out->memory = s->memory;
    s->a = s->memory;
    s->last = s->memory + motion->n;
    RITZ_CHECK_NEW(s->x0, motion->n);
    RITZ_CHECK_NEW(s->rhs, motion->n);
    RITZ_CHECK_NEW(s->work, motion->n);
    return factor_step(motion, step, s);
}

/*
 * The trapezoidal rule, which in second order is Newmark's with gamma = 1/2,
 * beta = 1/4, the average acceleration: unconditionally stable, and what it
 * takes from energy is what D takes. Periods come out longer by (w h)^2 / 12.
 */
static ritz_status start_trapezoidal(const ritz_motion *motion, double step,
                                     double rho, ritz_march *out)
{
    const ritz_newmark_weights weights = {0.0, 0.0, 0.25, 0.5};

    (void)rho;
    if (motion->form == RITZ_FORM_STATES)
        return ritz_states_start(motion, step, false, out);
    return start_newmark(motion, step, &weights, out);
}

const ritz_integrator ritz_integrator_trapezoidal = {
    .name = "trapezoidal",
    .summary = "average acceleration, implicit: one factor, a solve a step",
    .accuracy = "second order: periods longer by (w h)^2 / 12",
    .stability = "any step",
    .dissipation = "none: the energy of an undamped model stays",
    .fails = "modes above 1/h are kept alive as ringing",
    .reference = "Newmark1959",
    .takes_sparse = true,
    .takes_states = true,
    .start = start_trapezoidal,
};

/*
 * Generalised-alpha: with rho the spectral radius at infinite frequency
 *
 *     alpha_m = (2 rho - 1) / (rho + 1),   alpha_f = rho / (rho + 1)
 *     gamma = 1/2 - alpha_m + alpha_f
 *     beta  = (1 - alpha_m + alpha_f)^2 / 4
 *
 * which is of second order, stable at any step, and of all such weights takes
 * least from low frequencies [ChungHulbert1993]. rho = 1 takes nothing, rho = 0
 * ends what it cannot resolve in one step.
 */
ritz_status ritz_generalised_alpha(double rho, ritz_newmark_weights *w)
{
    RITZ_REFUSE_IF(!(rho >= 0.0 && rho <= 1.0), RITZ_ERR_ARGUMENT,
                   "the spectral radius at infinite frequency is between 0 and "
                   "1, not %g",
                   rho);
    w->alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
    w->alpha_f = rho / (rho + 1.0);
    w->gamma = 0.5 - w->alpha_m + w->alpha_f;
    w->beta = 0.25 * (1.0 - w->alpha_m + w->alpha_f) *
              (1.0 - w->alpha_m + w->alpha_f);
    return RITZ_OK;
}

static ritz_status start_generalised_alpha(const ritz_motion *motion,
                                           double step, double rho,
                                           ritz_march *out)
{
    ritz_newmark_weights w = {0};

    RITZ_CHECK(ritz_generalised_alpha(rho, &w));
    return start_newmark(motion, step, &w, out);
}

const ritz_integrator ritz_integrator_generalised_alpha = {
    .name = "generalised-alpha",
    .summary = "implicit, damps what the step does not resolve (--rho)",
    .accuracy = "second order",
    .stability = "any step",
    .dissipation = "by design: rho a step at high frequency, little below 1/h",
    .fails = "takes energy from modes that matter if steps are coarse",
    .reference = "ChungHulbert1993",
    .takes_sparse = true,
    .start = start_generalised_alpha,
};

/*
 * Central differences, Newmark's with gamma = 1/2, beta = 0:
 *
 *     M (x_+ - 2 x + x_-) / h^2 + D (x_+ - x_-) / (2 h) + K x = B u
 *
 * Damping forces are solved for, with M + h/2 D, so that the scheme is of
 * second order, stands gyroscopic terms, and its limit stays 2 / omega_max:
 * the energy v'M v / 2 + x'K x_+ / 2, v = (x_+ - x) / h, which is positive for
 * h omega_max < 2, changes by -h v_c'D v_c alone, v_c = (x_+ - x_-) / (2 h)
 * [Belytschko2014]. See simulate.h for that of damping forces half a step old.
 */
static ritz_status start_central_difference(const ritz_motion *motion,
                                            double step, double rho,
                                            ritz_march *out)
{
    const ritz_newmark_weights weights = {0.0, 0.0, 0.0, 0.5};
    double omega = sqrt(motion->highest);

    (void)rho;
    RITZ_REFUSE_IF(!motion->any_step && step * omega >= 2.0, RITZ_ERR_ARGUMENT,
                   "a step of %g s is not stable: the highest frequency, %.6g "
                   "Hz, limits it to %.6g s",
                   step, 0.5 * omega / RITZ_PI, 2.0 / omega);
    return start_newmark(motion, step, &weights, out);
}

const ritz_integrator ritz_integrator_central_difference = {
    .name = "central-difference",
    .summary = "explicit: one factor of M + h/2 D, no stiffness in it",
    .accuracy = "second order: periods shorter by (w h)^2 / 24",
    .stability = "steps below 2 / omega_max, refused above",
    .dissipation = "none",
    .fails = "one stiff mode makes every step short",
    .reference = "Belytschko2014",
    .is_explicit = true,
    .start = start_central_difference,
};
