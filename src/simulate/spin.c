/*
 * A model in a frame whose rate W(t) changes: see ritz/spin.h. It is integrated
 * by the implicit midpoint rule. With <.> the mean over a step, and x and v the
 * means of their values at both ends,
 *
 *     M (v_1 - v_0) / h + (D + <W> G) v + (K + <W^2> H + <W'> G / 2) x
 *         = B u + <W^2> centrifugal + <W'> euler,    x_1 = x_0 + h v,
 *
 * where H = S + KG. <W'> is exact; <W> and <W^2> are found by Simpson's rule,
 * which is exact where W is linear. The rule is of second order, even if a step
 * contains a corner of a profile, because the impulse of Euler's force is
 * exact. At a constant rate it is the trapezoidal rule.
 *
 * The equations are those of the Lagrangian
 *
 *     L = v'M v / 2 + W (-euler'v + v'G x / 2)
 *         + W^2 (J + 2 centrifugal'x - x'H x) / 2 - x'K x / 2
 *
 * with the angular momentum p = dL/dW about the axis. A drive that imposes the
 * rate exerts the moment p'. The sum of the kinetic energy T = L + x'K x / 2,
 * the strain energy and the energy that D dissipates therefore changes by the
 * work of inputs and int W dp. Over a step, dissipation is h v'D v, the work of
 * inputs (x_1 - x_0)'B u and that of the drive <W> (p_1 - p_0): the error of
 * the balance is of the order of h^2.
 */
#include "simulate/motion.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <string.h>

/* All in the modes of the model at rest, in which M is the unit matrix and K is
   diagonal. A step then multiplies by H and G once, and solves once. */
typedef struct spun {
    ritz_spin_terms terms;
    const ritz_spin_rate *rate;
    ritz_dense H;          /* {0}: none */
    ritz_dense D;          /* its symmetric part, which dissipates; {0}: none */
    ritz_dense Ca;         /* outputs x n, of accelerations; {0}: none */
    ritz_general_factor F; /* of the matrix of a step with `mean` */
    double mean[3];        /* <W>, <W^2> and <W'> of that matrix */
    bool factored;
    ritz_dense f;    /* n x 1, right side and then <v> */
    double *Hx, *Gx; /* n, of the present x if `present` */
    bool present;
    double *memory; /* work of the drive */
} spun;

enum { RATE, ACCELERATION, ANGLE, SPIN_WORK, STIFFENING, NUM_DIAGNOSTICS };

static const char *const diagnostics[NUM_DIAGNOSTICS] = {
    [RATE] = "rate",
    [ACCELERATION] = "acceleration",
    [ANGLE] = "angle",
    [SPIN_WORK] = "spin work",
    [STIFFENING] = "stiffening",
};

static void release_spun(void *own)
{
    spun *s = own;

    ritz_spin_terms_free(&s->terms);
    ritz_dense_free(&s->H);
    ritz_dense_free(&s->D);
    ritz_dense_free(&s->Ca);
    ritz_general_factor_free(&s->F);
    ritz_dense_free(&s->f);
    RITZ_FREE(s->Hx, s->Gx, s->memory, s);
}

static double time_of(const ritz_march *march)
{
    return (double)march->steps * march->step;
}

/* H x and G x, which are 0 where H or G is {0}. */
static void multiply_present(const ritz_march *march)
{
    const size_t bytes = (size_t)march->motion->n * sizeof(double);
    spun *s = march->own;

    if (s->present)
        return;
    memset(s->Hx, 0, bytes);
    memset(s->Gx, 0, bytes);
    ritz_motion_gemv(&s->H, 1.0, march->x, s->Hx);
    ritz_motion_gemv(&s->terms.G, 1.0, march->x, s->Gx);
    s->present = true;
}

/* f += <W^2> (centrifugal - H x) + <W'> (euler - G x / 2) */
static void add_spin_forces(const ritz_march *march, const double mean[3])
{
    const spun *s = march->own;
    const double *c = ritz_dense_col(&s->terms.load, 0);
    const double *e = ritz_dense_col(&s->terms.load, 1);

    for (int64_t k = 0; k < march->motion->n; k++)
        s->f.val[k] +=
            mean[1] * (c[k] - s->Hx[k]) + mean[2] * (e[k] - 0.5 * s->Gx[k]);
}

static void add_scaled(double factor, const ritz_dense *A, ritz_dense *to)
{
    if (A->val && factor != 0.0)
        ritz_dense_add(factor, A, to);
}

/* M + h/2 (D + <W> G) + h^2/4 (K + <W^2> H + <W'> G / 2) */
static ritz_status factor_step(ritz_march *march, const double mean[3])
{
    const ritz_motion *m = march->motion;
    const double half = 0.5 * march->step;
    spun *s = march->own;
    RITZ_OWN(ritz_dense) A = {0};

    if (s->factored && mean[0] == s->mean[0] && mean[1] == s->mean[1] &&
        mean[2] == s->mean[2])
        return RITZ_OK;
    s->factored = false;
    ritz_general_factor_free(&s->F);
    RITZ_CHECK(ritz_dense_new(m->n, m->n, &A));
    for (int64_t k = 0; k < m->n; k++)
        ritz_dense_col(&A, k)[k] = 1.0 + half * half * m->lambda[k];
    add_scaled(half, &m->D, &A);
    add_scaled(half * (mean[0] + 0.5 * half * mean[2]), &s->terms.G, &A);
    add_scaled(half * half * mean[1], &s->H, &A);
    RITZ_CHECK_IN("the matrix of a step", ritz_general_factor_new(&A, &s->F));
    memcpy(s->mean, mean, sizeof s->mean);
    s->factored = true;
    return RITZ_OK;
}

/* J + 2 centrifugal'x - x'H x, the moment of inertia of the deformed bodies. */
static double moment_of_inertia(const ritz_march *march)
{
    const spun *s = march->own;
    const int64_t n = march->motion->n;
    const double *c = ritz_dense_col(&s->terms.load, 0);

    return s->terms.inertia + 2.0 * ritz_motion_dot(n, c, march->x) -
           ritz_motion_dot(n, s->Hx, march->x);
}

/* p at a rate W. */
static double angular_momentum(const ritz_march *march, double W)
{
    const spun *s = march->own;
    const int64_t n = march->motion->n;
    const double *e = ritz_dense_col(&s->terms.load, 1);

    multiply_present(march);
    return W * moment_of_inertia(march) - ritz_motion_dot(n, e, march->v) +
           0.5 * ritz_motion_dot(n, s->Gx, march->v);
}

/* Add the energy that D dissipates and the work of inputs; <v> is in f. */
static void account_step(ritz_march *march, const double *u0, const double *u1)
{
    const ritz_motion *m = march->motion;
    const spun *s = march->own;
    const double h = march->step;

    march->dissipated += h * ritz_motion_form(&s->D, s->f.val);
    for (int64_t j = 0; j < m->B.ncol; j++)
        march->work +=
            0.5 * h * (u0[j] + u1[j]) *
            ritz_motion_dot(m->n, ritz_dense_col(&m->B, j), s->f.val);
}

/* The right side of the equation for <v>. */
static void load_step(const ritz_march *march, const double mean[3],
                      const double *u0, const double *u1)
{
    const ritz_motion *m = march->motion;
    const double half = 0.5 * march->step;
    spun *s = march->own;

    memset(s->f.val, 0, (size_t)m->n * sizeof *s->f.val);
    ritz_motion_gemv(&m->B, 0.5, u0, s->f.val);
    ritz_motion_gemv(&m->B, 0.5, u1, s->f.val);
    add_spin_forces(march, mean);
    for (int64_t k = 0; k < m->n; k++)
        s->f.val[k] =
            march->v[k] + half * (s->f.val[k] - m->lambda[k] * march->x[k]);
}

static ritz_status advance_spun(ritz_march *march, const double *u0,
                                const double *u1)
{
    const double h = march->step, t = time_of(march), t1 = t + h;
    spun *s = march->own;
    const double W0 = ritz_spin_rate_at(s->rate, t);
    const double Wm = ritz_spin_rate_at(s->rate, t + 0.5 * h);
    const double W1 = ritz_spin_rate_at(s->rate, t1);
    const double mean[3] = {(W0 + 4.0 * Wm + W1) / 6.0,
                            (W0 * W0 + 4.0 * Wm * Wm + W1 * W1) / 6.0,
                            (W1 - W0) / h};
    double moment = -angular_momentum(march, W0);

    RITZ_CHECK(factor_step(march, mean));
    load_step(march, mean, u0, u1);
    ritz_general_factor_solve(&s->F, false, &s->f);
    for (int64_t k = 0; k < march->motion->n; k++) {
        march->x[k] += h * s->f.val[k];
        march->v[k] = 2.0 * s->f.val[k] - march->v[k];
    }
    s->present = false;
    account_step(march, u0, u1);
    moment += angular_momentum(march, W1);
    s->memory[0] += mean[0] * moment;
    march->work += mean[0] * moment;
    return RITZ_OK;
}

/* T of the Lagrangian, and the strain energy. */
static void find_energy(const ritz_march *march, double *kinetic,
                        double *potential)
{
    const spun *s = march->own;
    const double W = ritz_spin_rate_at(s->rate, time_of(march));
    const double p = angular_momentum(march, W);
    double strain = 0.0, speed = 0.0;

    for (int64_t k = 0; k < march->motion->n; k++) {
        strain += march->motion->lambda[k] * march->x[k] * march->x[k];
        speed += march->v[k] * march->v[k];
    }
    *potential = 0.5 * strain;
    *kinetic = 0.5 * speed + W * p - 0.5 * W * W * moment_of_inertia(march);
}

/* y = C x + Cv x' + Ca x'', x'' from equilibrium in the turning frame. */
static void find_outputs(const ritz_march *march, const double *u, double *y)
{
    const ritz_motion *m = march->motion;
    spun *s = march->own;
    const double t = time_of(march);
    const double W = ritz_spin_rate_at(s->rate, t);
    const double mean[3] = {W, W * W, ritz_spin_acceleration_at(s->rate, t)};

    memset(y, 0, (size_t)m->C.nrow * sizeof *y);
    ritz_motion_gemv(&m->C, 1.0, march->x, y);
    ritz_motion_gemv(&m->Cv, 1.0, march->v, y);
    ritz_motion_gemv(&m->feed, 1.0, u, y);
    if (!s->Ca.val)
        return;
    /* the motion gives x'' without spin: add what the spin changes */
    multiply_present(march);
    memset(s->f.val, 0, (size_t)m->n * sizeof *s->f.val);
    add_spin_forces(march, mean);
    ritz_motion_gemv(&s->terms.G, -W, march->v, s->f.val);
    ritz_motion_gemv(&s->Ca, 1.0, s->f.val, y);
}

static void diagnose(const ritz_march *march, double *out)
{
    const spun *s = march->own;
    const double t = time_of(march);

    out[RATE] = ritz_spin_rate_at(s->rate, t);
    out[ACCELERATION] = ritz_spin_acceleration_at(s->rate, t);
    out[ANGLE] = ritz_spin_angle_at(s->rate, t);
    out[SPIN_WORK] = s->memory[0];
    out[STIFFENING] =
        0.5 * out[RATE] * out[RATE] * ritz_motion_form(&s->terms.KG, march->x);
}

/* Terms and outputs in modes: q = Phi x, where motion->to is M Phi. */
static ritz_status take_modes(const ritz_spin_terms *terms, const ritz_io *io,
                              const ritz_motion *motion, spun *s)
{
    RITZ_OWN(ritz_dense) Phi = {0}; /* (M Phi)^-T */

    RITZ_CHECK(ritz_dense_identity(motion->n, &Phi));
    RITZ_CHECK(ritz_general_solve(&motion->to, true, &Phi));
    RITZ_CHECK(ritz_spin_terms_add(terms, &Phi, &s->terms));
    if (s->terms.S.val || s->terms.KG.val)
        RITZ_CHECK(ritz_dense_new(motion->n, motion->n, &s->H));
    add_scaled(1.0, &s->terms.S, &s->H);
    add_scaled(1.0, &s->terms.KG, &s->H);
    if (motion->D.val) {
        RITZ_CHECK(ritz_dense_copy(&motion->D, &s->D));
        ritz_dense_symmetrise(&s->D);
    }
    if (ritz_dense_max(&io->Ca) > 0.0)
        RITZ_CHECK(ritz_dense_mul(&io->Ca, &Phi, &s->Ca));
    return RITZ_OK;
}

static ritz_status start_spun(const ritz_spin_terms *terms,
                              const ritz_spin_rate *rate, const ritz_io *io,
                              const ritz_motion *motion, ritz_march *march)
{
    spun *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    march->own = s;
    march->free = release_spun;
    s->rate = rate;
    RITZ_CHECK_NEW(march->x, motion->n);
    RITZ_CHECK_NEW(march->v, motion->n);
    RITZ_CHECK_NEW(s->Hx, motion->n);
    RITZ_CHECK_NEW(s->Gx, motion->n);
    RITZ_CHECK_NEW(s->memory, 1);
    RITZ_CHECK(ritz_dense_new(motion->n, 1, &s->f));
    RITZ_CHECK(take_modes(terms, io, motion, s));
    march->motion = motion;
    march->memory = s->memory;
    march->num_memory = 1;
    march->advance = advance_spun;
    march->outputs = find_outputs;
    march->energy = find_energy;
    march->diagnose = diagnose;
    march->diagnostic = diagnostics;
    march->num_diagnostics = NUM_DIAGNOSTICS;
    return RITZ_OK;
}

static ritz_status check_request(ritz_model subject,
                                 const ritz_spin_terms *terms,
                                 const ritz_simulation_request *request)
{
    RITZ_REFUSE_IF(subject.kind != RITZ_MODEL_DENSE, RITZ_ERR_ARGUMENT,
                   "a spin needs a reduced component or a system");
    RITZ_REFUSE_IF(request->integrator != &ritz_integrator_trapezoidal,
                   RITZ_ERR_ARGUMENT,
                   "matrices of a rate that changes are integrated by "
                   "trapezoidal alone, not by %s",
                   request->integrator->name);
    RITZ_REFUSE_IF(terms->load.nrow != ritz_model_order(subject),
                   RITZ_ERR_ARGUMENT,
                   "the spin is of another model: its order is %ld, not %ld",
                   (long)terms->load.nrow, (long)ritz_model_order(subject));
    return RITZ_OK;
}

/* The spin of a run. */
typedef struct spin_course {
    const ritz_spin_terms *terms;
    const ritz_spin_rate *rate;
} spin_course;

static ritz_status run_spun(ritz_model subject,
                            const ritz_simulation_request *request,
                            const void *context, ritz_simulation *out)
{
    const spin_course *spin = context;
    RITZ_OWN(ritz_motion) motion = {0};
    RITZ_OWN(ritz_march) march = {.step = request->step};
    RITZ_OWN(ritz_simulation) s = {0};

    RITZ_CHECK(check_request(subject, spin->terms, request));
    RITZ_CHECK(ritz_motion_dense(subject, true, &motion));
    RITZ_REFUSE_IF(motion.n < motion.original, RITZ_ERR_ARGUMENT,
                   "a motion has no mass, as all need in a model that spins");
    motion.energies = true;
    RITZ_CHECK(
        start_spun(spin->terms, spin->rate, subject.dense.io, &motion, &march));
    RITZ_CHECK(ritz_march_run(&march, request, NULL, &s));
    RITZ_CHECK(ritz_simulation_label(subject, &s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

ritz_status ritz_simulate_spun(ritz_model subject, const ritz_spin_terms *terms,
                               const ritz_spin_rate *rate,
                               const ritz_simulation_request *request,
                               ritz_simulation *out)
{
    const spin_course spin = {terms, rate};

    return ritz_simulate_coordinates(subject, request, run_spun, &spin, out);
}
