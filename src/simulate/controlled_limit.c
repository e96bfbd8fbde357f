/*
 * Stability of a closed loop, and of its propagation in time: the poles of the
 * continuous loop, and the spectral radius of the linear map from one step, or
 * one sample, to the next. The matrix of a small map is found column by column;
 * a large map is applied to a vector, from whose growth the radius is
 * estimated.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "simulate/controlled.h"

#include <complex.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest order of a map whose eigenvalues are computed. */
enum { MOST_MAPPED = 160 };

/* How a loop is propagated, for any step. */
typedef struct scheme {
    const ritz_simulation_request *request;
    ritz_motion motion; /* borrowed; without energies, at any step */
    const ritz_controlled *controlled;
} scheme;

static ritz_status map_matrix(ritz_march *march, ritz_dense *out)
{
    const int64_t n = ritz_split_order(march);

    RITZ_CHECK(ritz_dense_new(n, n, out));
    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(out, j)[j] = 1.0;
        RITZ_CHECK(ritz_split_map(march, ritz_dense_col(out, j)));
    }
    return RITZ_OK;
}

static ritz_status radius_of_matrix(ritz_march *march, ritz_loop_stability *out)
{
    RITZ_OWN(ritz_dense) A = {0};
    RITZ_OWN(ritz_eigenvalues) values = {0};

    RITZ_CHECK(map_matrix(march, &A));
    RITZ_CHECK(ritz_eigenvalues_of(&A, &values));
    out->radius = values.radius;
    out->grows = out->neutral = false;
    for (int64_t k = 0; k < values.count; k++) {
        const double error = RITZ_POLE_BOUND_FACTOR * values.error[k];
        const double beyond = hypot(values.re[k], values.im[k]) - 1.0;

        out->grows |= beyond > error;
        out->neutral |= fabs(beyond) <= error;
    }
    out->neutral &= !out->grows;
    return RITZ_OK;
}

/* ln(|map^count z| / |z|); z has length one before and after. */
static ritz_status grow_vector(ritz_march *march, int64_t n, int count,
                               double *z, double *out)
{
    double sum = 0.0;

    for (int k = 0; k < count; k++) {
        RITZ_CHECK(ritz_split_map(march, z));
        sum += 0.5 * log(ritz_motion_dot(n, z, z));
        if (!isfinite(sum) || !ritz_general_unit(n, z))
            break;
    }
    *out = sum;
    return RITZ_OK;
}

static ritz_status radius_of_growth(ritz_march *march, ritz_loop_stability *out)
{
    const int64_t n = ritz_split_order(march);
    uint64_t seed = 1992;
    double ignored = 0.0, first = 0.0, second = 0.0;
    RITZ_OWN_ARRAY double *z = NULL;

    RITZ_CHECK_NEW(z, n);
    for (int64_t k = 0; k < n; k++)
        z[k] = ritz_general_noise(&seed);
    (void)ritz_general_unit(n, z);
    RITZ_CHECK(grow_vector(march, n, RITZ_GROWTH_MAPS, z, &ignored));
    RITZ_CHECK(grow_vector(march, n, RITZ_GROWTH_MAPS, z, &first));
    RITZ_CHECK(grow_vector(march, n, 2 * RITZ_GROWTH_MAPS, z, &second));
    first /= RITZ_GROWTH_MAPS;
    second /= 2.0 * RITZ_GROWTH_MAPS;
    out->estimated = true;
    out->radius = exp(second);
    out->grows = !isfinite(second) || (second > RITZ_GROWTH_LEAST &&
                                       second > RITZ_GROWTH_KEPT * first);
    out->neutral = !out->grows && second >= -RITZ_GROWTH_LEAST;
    return RITZ_OK;
}

static ritz_status find_radius(const scheme *by, double step,
                               ritz_loop_stability *out)
{
    RITZ_OWN(ritz_march) march = {0};

    RITZ_CHECK(ritz_split_start(&by->motion, by->controlled,
                                by->request->integrator, step, by->request->rho,
                                &march));
    return ritz_split_order(&march) <= MOST_MAPPED
               ? radius_of_matrix(&march, out)
               : radius_of_growth(&march, out);
}

/* Largest |pole| of a plant, or of a controller; 0 if it has none. */
static ritz_status fastest_pole(const ritz_state_space *of, double *out)
{
    RITZ_OWN_ARRAY double _Complex *pole = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_state_space_poles(of, &count, &pole));
    for (int64_t k = 0; k < count; k++)
        *out = fmax(*out, hypot(creal(pole[k]), cimag(pole[k])));
    return RITZ_OK;
}

/* The step from which steps are tried: a part of the shortest time constant, of
   the closed loop where its poles are known, else of the controller, and no
   longer than the step of the run; without poles a part of that step. */
static ritz_status first_step(const scheme *by, double fastest, double *out)
{
    const double least = by->request->step * RITZ_STEP_LEAST;

    if (!(fastest > 0.0) && by->controlled->controller->A.nrow > 0)
        RITZ_CHECK(fastest_pole(by->controlled->controller, &fastest));
    *out = fastest > 0.0
               ? fmax(fmin(by->request->step, RITZ_STEP_OF_CONSTANT / fastest),
                      least)
               : by->request->step / RITZ_STEP_FINER;
    return RITZ_OK;
}

/* The first unstable one of ascending steps, and the stable one before it, 0 if
   there is none; `high` is infinite if all up to the whole run are stable. */
static ritz_status bracket_limit(const scheme *by, double from, double *low,
                                 double *high)
{
    const double own = by->request->step;
    double step = from;

    *low = 0.0;
    *high = HUGE_VAL;
    for (;;) {
        ritz_loop_stability now = {0};

        RITZ_CHECK(find_radius(by, step, &now));
        if (now.grows) {
            *high = step;
            return RITZ_OK;
        }
        *low = step;
        if (step > by->request->seconds)
            return RITZ_OK;
        step *= RITZ_STEP_RATIO;
        if (*low < own && own < step)
            step = own;
    }
}

static ritz_status find_limit(const scheme *by, double fastest,
                              ritz_loop_stability *out)
{
    double low = 0.0, high = 0.0;

    RITZ_CHECK(first_step(by, fastest, &out->from));
    RITZ_CHECK(bracket_limit(by, out->from, &low, &high));
    while (low > 0.0 && isfinite(high) && high - low > RITZ_STEP_FOUND * high) {
        const double middle = 0.5 * (low + high);
        ritz_loop_stability now = {0};

        RITZ_CHECK(find_radius(by, middle, &now));
        if (now.grows)
            high = middle;
        else
            low = middle;
    }
    out->limit = low > 0.0 ? high : 0.0;
    return RITZ_OK;
}

/* A delay that makes the loop grow does so at a finer step too. */
static ritz_status blame_delay(const scheme *by, ritz_loop_stability *out)
{
    ritz_loop_stability finer = {0};

    if (!out->grows)
        return RITZ_OK;
    RITZ_CHECK(find_radius(by, by->request->step / RITZ_STEP_FINER, &finer));
    out->unstable_by_delay = finer.grows;
    return RITZ_OK;
}

/* The plant in first-order form: that of its motion, or of the component itself
   if it is integrated unreduced. */
static ritz_status find_plant(ritz_model subject, const ritz_motion *motion,
                              ritz_state_space *out)
{
    const ritz_io io = ritz_model_io(subject);
    const ritz_state_space *same =
        NULL; /* out: a component is no state space */

    return motion->form == RITZ_FORM_SPARSE
               ? ritz_model_states(subject, out, &same)
               : ritz_motion_states(motion, &io, out);
}

/* Poles of a continuous loop that is not too large. */
static ritz_status probe_loop(ritz_model subject, const ritz_motion *motion,
                              const ritz_controlled *controlled,
                              double *fastest, ritz_loop_stability *out)
{
    const int64_t order = 2 * motion->n + controlled->controller->A.nrow;
    const bool few = motion->form == RITZ_FORM_SPARSE
                         ? motion->n <= RITZ_LOOP_DOFS
                         : order <= RITZ_LOOP_POLES;
    RITZ_OWN(ritz_state_space) plant = {0}, closed = {0};

    if (controlled->sample > 0.0 || controlled->delay > 0.0 || !few)
        return RITZ_OK;
    RITZ_CHECK(find_plant(subject, motion, &plant));
    RITZ_CHECK(ritz_closed_loop(&plant, controlled->controller,
                                controlled->loop, &closed));
    RITZ_CHECK(ritz_probe_states(&closed, &out->loop));
    out->known = true;
    return fastest_pole(&closed, fastest);
}

/* How the split does at the step of the run and at others. */
static ritz_status examine_split(const scheme *by, double fastest,
                                 ritz_loop_stability *out)
{
    const ritz_controlled *controlled = by->controlled;

    RITZ_CHECK(find_radius(by, by->request->step, out));
    if (controlled->sample > 0.0)
        return RITZ_OK;
    if (controlled->delay > 0.0)
        return blame_delay(by, out);
    return out->known && out->loop.verdict == RITZ_UNSTABLE
               ? RITZ_OK
               : find_limit(by, fastest, out);
}

ritz_status ritz_controlled_examine(ritz_model subject,
                                    const ritz_simulation_request *request,
                                    const ritz_controlled *controlled,
                                    ritz_loop_stability *out)
{
    ritz_loop_stability found = {
        .radius = nan(""), .limit = nan(""), .from = nan("")};
    double fastest = 0.0;
    RITZ_OWN(ritz_motion) motion = {0};
    scheme by = {.request = request, .controlled = controlled};

    RITZ_CHECK(ritz_controlled_check(subject, request, controlled));
    RITZ_CHECK(ritz_motion_new(subject, request, &motion));
    RITZ_CHECK(probe_loop(subject, &motion, controlled, &fastest, &found));
    by.motion = motion; /* borrowed */
    by.motion.energies = false;
    by.motion.any_step = true;
    if (!controlled->exact)
        RITZ_CHECK(examine_split(&by, fastest, &found));
    found.hides_instability = found.known &&
                              found.loop.verdict == RITZ_UNSTABLE &&
                              !controlled->exact && !found.grows;
    *out = found;
    return RITZ_OK;
}

static ritz_status refuse_step(double step,
                               const ritz_loop_stability *stability)
{
    RITZ_REFUSE_IF(
        stability->limit > 0.0, RITZ_ERR_ARGUMENT,
        "a step of %g s makes the loop unstable, whose parts hold each other's "
        "outputs: spectral radius %.8g; of steps tried from %.5g s up, %.5g s "
        "is "
        "the least that does; take it all the same with --any-step",
        step, stability->radius, stability->from, stability->limit);
    RITZ_REFUSE_IF(
        stability->limit == 0.0, RITZ_ERR_ARGUMENT,
        "a step of %g s makes the loop unstable, whose parts hold each other's "
        "outputs: spectral radius %.8g, and so does the least that was tried, "
        "%.5g s; take it all the same with --any-step",
        step, stability->radius, stability->from);
    return ritz_fail(
        RITZ_ERR_ARGUMENT,
        "a step of %g s makes the loop unstable, whose parts hold each other's "
        "outputs: spectral radius %.8g; take it all the same with --any-step",
        step, stability->radius);
}

ritz_status ritz_controlled_refuse(const ritz_simulation_request *request,
                                   const ritz_controlled *controlled,
                                   const ritz_loop_stability *stability)
{
    const bool unstable =
        stability->known && stability->loop.verdict == RITZ_UNSTABLE;
    char text[2 * RITZ_NAME_SIZE];

    if (unstable)
        ritz_probe_print(&stability->loop, text);
    RITZ_REFUSE_IF(unstable && !controlled->force &&
                       stability->hides_instability,
                   RITZ_ERR_ARGUMENT,
                   "the loop is unstable, %s, and a step of %g s would hide "
                   "that; simulate it all the same with --force",
                   text, request->step);
    RITZ_REFUSE_IF(unstable && !controlled->force, RITZ_ERR_ARGUMENT,
                   "the loop is unstable, %s: it grows without bound; simulate "
                   "it all the same with --force",
                   text);
    RITZ_REFUSE_IF(controlled->sample > 0.0 && stability->grows &&
                       !controlled->force,
                   RITZ_ERR_ARGUMENT,
                   "the sampled loop is unstable, %.8g times larger after each "
                   "sample; simulate it all the same with --force",
                   stability->radius);
    RITZ_REFUSE_IF(stability->unstable_by_delay && !controlled->force,
                   RITZ_ERR_ARGUMENT,
                   "the loop is unstable with its delay of %g s, %.8g times "
                   "more from one step to the next, and at finer steps too; "
                   "simulate it all the same with --force",
                   controlled->delay, stability->radius);
    if (controlled->sample > 0.0 || unstable || stability->unstable_by_delay ||
        !stability->grows || controlled->any_step)
        return RITZ_OK;
    return refuse_step(request->step, stability);
}
