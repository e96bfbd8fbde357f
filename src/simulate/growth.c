/*
 * Growth of free motion, in modes: states start with q = +-1/w, v = +-1 (rigid
 * ones with v alone), signs from a seeded generator, so that each has the same
 * energy and no way of growing is missed for long. The march itself is that of
 * full matrices; modes only read the energy: q = Phi'M x.
 */
#include "base/tolerances.h"
#include "simulate/motion.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* SplitMix64 [Steele2014]: between -1 and 1, away from 0. */
static double next_noise(uint64_t *seed)
{
    uint64_t z = (*seed += UINT64_C(0x9e3779b97f4a7c15));
    double value = 0.0;

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    value = 0.5 + 0.5 * (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
    return z & 1 ? value : -value;
}

/* E of modal coordinates. */
static double energy_of(const ritz_motion *modes, const double *q,
                        const double *v)
{
    double sum = 0.0;

    for (int64_t k = 0; k < modes->n; k++)
        sum += 0.5 * (v[k] * v[k] + fabs(modes->lambda[k]) * q[k] * q[k]);
    return sum;
}

/* q = Phi'M x of what is marched; the same if that is modal itself. */
static void to_modes(const ritz_motion *modes, const ritz_motion *motion,
                     const double *x, double *q)
{
    for (int64_t k = 0; k < modes->n; k++)
        q[k] = motion->to.val
                   ? x[k]
                   : ritz_motion_dot(modes->original,
                                     ritz_dense_col(&modes->to, k), x);
}

/* x = Phi q from M x = (M Phi) q. */
static ritz_status from_modes(const ritz_motion *modes,
                              const ritz_motion *motion, ritz_effective *mass,
                              const double *q, double *x)
{
    for (int64_t k = 0; k < motion->n; k++)
        x[k] = motion->to.val ? q[k] : 0.0;
    if (motion->to.val)
        return RITZ_OK;
    ritz_motion_gemv(&modes->to, 1.0, q, x);
    return ritz_effective_solve(mass, 1, x);
}

typedef struct growth_trial {
    const ritz_motion *modes, *motion;
    ritz_effective mass;
    double *q, *v, *u;
} growth_trial;

static void growth_trial_free(growth_trial *t)
{
    ritz_effective_free(&t->mass);
    free(t->q);
    free(t->v);
    free(t->u);
}

static ritz_status free_motion(growth_trial *t, ritz_march *march,
                               int64_t steps, uint64_t *seed, double *worst)
{
    double start = 0.0;

    for (int64_t k = 0; k < t->modes->n; k++) {
        double w = sqrt(fabs(t->modes->lambda[k]));

        t->q[k] = w > 0.0 ? next_noise(seed) / w : 0.0;
        t->v[k] = next_noise(seed);
    }
    start = energy_of(t->modes, t->q, t->v);
    RITZ_CHECK(from_modes(t->modes, t->motion, &t->mass, t->q, march->x));
    RITZ_CHECK(from_modes(t->modes, t->motion, &t->mass, t->v, march->v));
    if (march->settle)
        RITZ_CHECK(march->settle(march, t->u));
    for (int64_t k = 0; k < steps && *worst < RITZ_GROWN_ENOUGH; k++) {
        double now = 0.0;

        RITZ_CHECK(march->advance(march, t->u, t->u));
        to_modes(t->modes, t->motion, march->x, t->q);
        to_modes(t->modes, t->motion, march->v, t->v);
        now = energy_of(t->modes, t->q, t->v) / start;
        *worst = isfinite(now) ? fmax(*worst, now) : HUGE_VAL;
    }
    return RITZ_OK;
}

static ritz_status run_all(growth_trial *t, const ritz_integrator *integrator,
                           double step, const int64_t count[2], double *out)
{
    RITZ_OWN(ritz_march) march = {0};
    uint64_t seed = 1993;
    double worst = 0.0;

    RITZ_CHECK_NEW(t->q, t->modes->n);
    RITZ_CHECK_NEW(t->v, t->modes->n);
    RITZ_CHECK_NEW(t->u, t->motion->B.ncol);
    if (t->motion->form == RITZ_FORM_DENSE)
        RITZ_CHECK_IN(
            "M", ritz_effective_new(t->motion, 1.0, 0.0, 0.0, false, &t->mass));
    RITZ_CHECK(ritz_march_new(t->motion, integrator, step, 0.8, &march));
    for (int64_t k = 0;
         t->modes->n > 0 && k < count[1] && worst < RITZ_GROWN_ENOUGH; k++)
        RITZ_CHECK(free_motion(t, &march, count[0], &seed, &worst));
    *out = worst;
    return RITZ_OK;
}

ritz_status ritz_simulate_growth(ritz_model model,
                                 const ritz_integrator *integrator, double step,
                                 int64_t steps, int64_t starts, double *out)
{
    const int64_t count[2] = {steps, starts};
    RITZ_OWN(ritz_motion) modes = {0}, motion = {0};
    RITZ_OWN(growth_trial)
    t = {.modes = &modes, .motion = &motion};

    RITZ_REFUSE_IF(!(step > 0.0) || !isfinite(step) || steps < 1 || starts < 1,
                   RITZ_ERR_ARGUMENT,
                   "growth is of one step and one start at least");
    RITZ_CHECK(ritz_motion_dense(model, true, &modes));
    RITZ_CHECK(ritz_motion_dense(model, integrator == &ritz_integrator_modal,
                                 &motion));
    motion.any_step = true;
    return run_all(&t, integrator, step, count, out);
}
