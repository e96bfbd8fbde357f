/*
 * Constrained runs: the choice of parameters, the limit of the step, and the
 * properties of a run.
 *
 * Parameters are chosen from base = 1 / step. This is half of the highest
 * frequency at which an explicit integrator is stable, and about the highest
 * that an implicit one follows. With an explicit integrator base is reduced
 * until base^2 + highest^2 <= (0.9 2 / step)^2, where highest is that of the
 * bodies.
 */
#include "simulate/constrained.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "linear/blas_threads.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static ritz_status read_gain(char *word, ritz_constrained_request *how)
{
    const ritz_gain *gain = how->method->gain;
    char *equals = strchr(word, '=');
    int64_t count = 0, k = 0;

    while (count < RITZ_MOST_GAINS && gain[count].name)
        count++;
    RITZ_REFUSE_IF(!equals, RITZ_ERR_ARGUMENT, "'%s' is not NAME=VALUE", word);
    *equals = '\0';
    while (k < count && strcmp(gain[k].name, word) != 0)
        k++;
    RITZ_REFUSE_IF(k == count, RITZ_ERR_ARGUMENT,
                   "'%s' has no parameter '%s'%s%s", how->method->name, word,
                   count > 0 ? ", its first is " : "",
                   count > 0 ? gain[0].name : "");
    RITZ_REFUSE_IF(!isnan(how->gain[k]), RITZ_ERR_ARGUMENT,
                   "'%s' of %s is given twice", word, how->method->name);
    RITZ_REFUSE_IF(
        !ritz_text_real(equals + 1, &how->gain[k]) || how->gain[k] < 0.0,
        RITZ_ERR_ARGUMENT, "'%s' of %s is a number of 0 or more, not '%s'",
        word, how->method->name, equals + 1);
    return RITZ_OK;
}

ritz_status ritz_constrained_parse(const char *text,
                                   ritz_constrained_request *out)
{
    ritz_constrained_request how = {0};
    char copy[4 * RITZ_NAME_SIZE];
    char *words = NULL;

    RITZ_REFUSE_IF(strlen(text) >= sizeof copy, RITZ_ERR_ARGUMENT,
                   "a stabilisation is METHOD:NAME=VALUE,...");
    memcpy(copy, text, strlen(text) + 1);
    words = strchr(copy, ':');
    if (words)
        *words++ = '\0';
    for (const ritz_stabilisation *const *s = ritz_stabilisations; *s; s++)
        if (strcmp((*s)->name, copy) == 0)
            how.method = *s;
    RITZ_REFUSE_IF(!how.method, RITZ_ERR_ARGUMENT,
                   "no stabilisation is called '%s': see --list", copy);
    for (int k = 0; k < RITZ_MOST_GAINS; k++)
        how.gain[k] = nan("");
    while (words) {
        char *word = words;

        words = strchr(words, ',');
        if (words)
            *words++ = '\0';
        RITZ_CHECK(read_gain(word, &how));
    }
    *out = how;
    return RITZ_OK;
}

static double length_of(int64_t count, const double *x)
{
    return x ? sqrt(ritz_motion_dot(count, x, x)) : 0.0;
}

/* Initial values in coordinates x; NULL for NULL. A violation that is rounding
   of the values is none: stiff springs would ring with it. */
static ritz_status take_start(const ritz_linked *j, const double *from,
                              double **out)
{
    RITZ_OWN_ARRAY double *x = NULL;
    double length = 0.0;

    if (!from)
        return RITZ_OK;
    RITZ_CHECK_NEW(x, j->motion.n);
    for (int64_t k = 0; k < j->motion.n; k++)
        x[k] = ritz_motion_dot(j->to.nrow, ritz_dense_col(&j->to, k), from);
    length = length_of(j->motion.n, x);
    for (int64_t k = 0; k < j->rank; k++) {
        const double *to = ritz_dense_col(&j->to, k);
        double terms = length;

        for (int64_t i = 0; i < j->to.nrow; i++)
            terms += fabs(to[i] * from[i]);
        if (fabs(x[k]) <= RITZ_VIOLATION_ROUNDING * terms)
            x[k] = 0.0;
    }
    RITZ_MOVE(*out, x);
    return RITZ_OK;
}

/* Replace values by the nearest ones, in the norm of M, that satisfy the
   constraints; return the relative change. */
static double project_start(const ritz_linked *j, double *x)
{
    const double length = length_of(j->motion.n, x);
    const double cut = length_of(j->rank, x);

    for (int64_t k = 0; x && k < j->rank; k++)
        x[k] = 0.0;
    return cut > 0.0 ? cut / length : 0.0;
}

/* Violations at the start, and the largest |c''| of free bodies, from their
   initial state and the amplitudes of the inputs. */
static ritz_status measure_start(const ritz_linked *j,
                                 const ritz_simulation_request *request,
                                 ritz_gain_scales *scales)
{
    const ritz_motion *m = &j->motion;
    RITZ_OWN_ARRAY double *force = NULL;

    RITZ_CHECK_NEW(force, m->n);
    scales->violation = length_of(j->rank, request->x0);
    scales->rate = length_of(j->rank, request->v0);
    if (request->x0)
        ritz_motion_gemv(&m->K, 1.0, request->x0, force);
    scales->force = length_of(j->rank, force);
    memset(force, 0, (size_t)m->n * sizeof *force);
    if (request->v0)
        ritz_motion_gemv(&j->peak, 1.0, request->v0, force);
    scales->force += length_of(j->rank, force);
    for (int64_t k = 0; request->signal && k < m->B.ncol; k++)
        scales->force += fabs(request->signal[k].amplitude) *
                         length_of(j->rank, ritz_dense_col(&m->B, k));
    return RITZ_OK;
}

/* Choose the parameters that are not given, and find the terms of the
   method. */
static ritz_status find_terms(const ritz_linked *j,
                              const ritz_constrained_request *how,
                              const ritz_simulation_request *request,
                              double *gain, ritz_stabiliser *terms)
{
    ritz_gain_scales scales = {.base = 1.0 / request->step,
                               .step = request->step};
    const double most = RITZ_GAIN_ROOM * 2.0 / request->step;
    const double room = fmax(most * most - j->unjoined, 0.0);

    if (request->integrator->is_explicit)
        scales.base = fmin(scales.base, sqrt(room));
    if (scales.base < RITZ_GAIN_LEAST / request->step)
        scales.base = nan("");
    RITZ_CHECK(measure_start(j, request, &scales));
    memcpy(gain, how->gain, sizeof how->gain);
    if (how->method->choose)
        how->method->choose(&scales, gain);
    for (int k = 0; k < RITZ_MOST_GAINS; k++)
        RITZ_REFUSE_IF(
            how->method->gain[k].name && isnan(gain[k]), RITZ_ERR_ARGUMENT,
            "the highest frequency of the bodies, %.6g Hz, leaves "
            "'%s' of %s no room at a step of %g s: take a smaller "
            "step, or give it",
            sqrt(j->unjoined) / (2.0 * RITZ_PI), how->method->gain[k].name,
            how->method->name, request->step);
    RITZ_CHECK_IN(how->method->name, how->method->terms(gain, terms));
    RITZ_REFUSE_IF(!isfinite(terms->stiffness) || !isfinite(terms->damping) ||
                       !isfinite(terms->stiffest),
                   RITZ_ERR_ARGUMENT,
                   "%s: the stiffness of the parameters is too large for a "
                   "double",
                   how->method->name);
    return RITZ_OK;
}

/*
 * An integrator computes the violation of stiff springs, f / k, as a sum of
 * terms of up to h^2 f / (4 m). Their rounding is a force k eps h^2 f / (4 m) =
 * eps (w h)^2 / 4 f.
 */
static double force_rounding(const ritz_stabiliser *terms, double step)
{
    return terms->multipliers ? 0.0
                              : DBL_EPSILON * step * step * terms->stiffness /
                                    (4.0 * (1.0 + terms->inertia));
}

static ritz_status check_forces(const ritz_constrained_request *how,
                                double step,
                                const ritz_constrained_facts *facts)
{
    RITZ_REFUSE_IF(
        !how->any_step && facts->force_rounding > 1.0, RITZ_ERR_ARGUMENT,
        "springs of %s are so stiff that forces in the joints would be "
        "rounding at a step of %g s: they are accurate to a thousandth up to "
        "%.3g Hz",
        how->method->name, step,
        sqrt(4.0 * RITZ_FORCE_ROUNDING / DBL_EPSILON) / (2.0 * RITZ_PI * step));
    return RITZ_OK;
}

/* An explicit integrator is unstable at steps above 2 / omega. */
static ritz_status check_step(const ritz_constrained_request *how,
                              const ritz_simulation_request *request,
                              const ritz_constrained_facts *facts)
{
    const double own = 2.0 * RITZ_PI * facts->joined_hz;
    const double most = 2.0 / request->step;

    if (how->any_step || !request->integrator->is_explicit ||
        request->step < facts->step_limit)
        return RITZ_OK;
    RITZ_REFUSE_IF(own >= most, RITZ_ERR_ARGUMENT,
                   "a step of %g s is not stable: the highest frequency, %.6g "
                   "Hz, limits it to %.6g s",
                   request->step, facts->joined_hz, 2.0 / own);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "a step of %g s is not stable: %s raises the highest "
                     "frequency from %.6g Hz to %.6g Hz, which limits it to "
                     "%.6g s; with this step, constraints have room up to "
                     "%.6g rad/s, %.6g Hz",
                     request->step, how->method->name, facts->joined_hz,
                     facts->highest_hz, facts->step_limit,
                     sqrt(most * most - own * own),
                     sqrt(most * most - own * own) / (2.0 * RITZ_PI));
}

static ritz_status find_facts(const ritz_linked *j,
                              const ritz_stabiliser *terms, double step,
                              ritz_constrained_facts *facts)
{
    double highest = 0.0;

    RITZ_CHECK(ritz_stabilised_highest(j, terms, &highest));
    facts->num_rows = j->num_rows;
    facts->rank = j->rank;
    facts->num_redundant = j->num_redundant;
    RITZ_CHECK_COPY(facts->redundant, j->redundant, j->num_redundant);
    facts->joined_hz = sqrt(j->highest) / (2.0 * RITZ_PI);
    facts->highest_hz = sqrt(highest) / (2.0 * RITZ_PI);
    facts->step_limit = highest > 0.0 ? 2.0 / sqrt(highest) : HUGE_VAL;
    facts->force_rounding = force_rounding(terms, step);
    facts->unresolved =
        !terms->multipliers &&
        terms->stiffness > (1.0 + terms->inertia) * 4.0 / (step * step);
    return RITZ_OK;
}

/* Processor time of a step, measured at rest. */
static ritz_status find_cost(const ritz_linked *j, const ritz_stabiliser *terms,
                             const ritz_simulation_request *request,
                             double *out)
{
    RITZ_OWN(ritz_march) march = {0};
    RITZ_OWN_ARRAY double *u = NULL;

    RITZ_CHECK_NEW(u, j->motion.B.ncol);
    RITZ_CHECK(ritz_constrained_march(j, terms, request, &march));
    return ritz_march_cost(&march, u, out);
}

/* A copy of the request with the integrator that is used, whose name is that of
   the method and the integrator. */
static void name_run(const ritz_constrained_request *how,
                     const ritz_simulation_request *request,
                     ritz_integrator *integrator, char name[RITZ_NAME_SIZE])
{
    const bool own = !how->method->integrator;

    *integrator = own ? ritz_integrator_generalised_alpha
                  : request->integrator == &ritz_integrator_modal
                      ? *how->method->integrator
                      : *request->integrator;
    (void)snprintf(name, RITZ_NAME_SIZE, "%s %s", how->method->name,
                   integrator->name);
    integrator->name = name;
}

/* Largest number of coordinates for which a run takes one thread: a step takes
   microseconds, and threads would wait for each other in each step. */
enum { SMALL_RUN = 360 };

static ritz_status label_run(const ritz_unjoined *bodies, ritz_simulation *s)
{
    const ritz_second_order dense = {
        .K = &bodies->K, .M = &bodies->M, .io = &bodies->io};

    return ritz_simulation_label(ritz_model_of_dense(&dense, NULL), s);
}

ritz_status ritz_simulate_constrained(const ritz_unjoined *bodies,
                                      const ritz_constrained_request *how,
                                      const ritz_simulation_request *request,
                                      ritz_constrained_facts *facts,
                                      ritz_simulation *out)
{
    ritz_simulation_request asked = *request;
    ritz_integrator integrator = {0};
    char name[RITZ_NAME_SIZE];
    ritz_unjoined extended = *bodies; /* borrowed */
    RITZ_OWN(ritz_io) io = {0};
    RITZ_OWN(ritz_linked) joined = {0};
    RITZ_OWN(ritz_march) march = {0};
    RITZ_OWN(ritz_constrained_facts) found = {0};
    RITZ_OWN(ritz_simulation) s = {0};
    ritz_stabiliser terms = {0};
    RITZ_OWN_ARRAY double *x0 = NULL, *v0 = NULL;
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = {0};
    int64_t steps = 0;

    if (bodies->n <= SMALL_RUN)
        single = ritz_blas_single_new();
    if (request->coordinates) {
        RITZ_CHECK(ritz_coordinates_add(&bodies->io, NULL, &io));
        extended.io = io;
    }
    RITZ_CHECK(ritz_request_steps(request, &steps));
    name_run(how, request, &integrator, name);
    asked.integrator = &integrator;
    RITZ_CHECK(ritz_linked_new(&extended, &joined));
    RITZ_CHECK(take_start(&joined, request->x0, &x0));
    RITZ_CHECK(take_start(&joined, request->v0, &v0));
    asked.x0 = x0;
    asked.v0 = v0;
    RITZ_CHECK(find_terms(&joined, how, &asked, found.gain, &terms));
    RITZ_CHECK(find_facts(&joined, &terms, asked.step, &found));
    RITZ_CHECK(check_step(how, &asked, &found));
    RITZ_CHECK(check_forces(how, asked.step, &found));
    if (terms.projects) {
        found.moved = project_start(&joined, x0);
        found.moved_rate = project_start(&joined, v0);
    }
    RITZ_CHECK(ritz_constrained_march(&joined, &terms, &asked, &march));
    RITZ_CHECK(ritz_march_run(&march, &asked, NULL, &s));
    RITZ_CHECK(label_run(&extended, &s));
    if (request->coordinates)
        RITZ_CHECK(ritz_coordinates_take(bodies->io.num_outputs, &s));
    if (facts)
        RITZ_CHECK(find_cost(&joined, &terms, &asked, &found.step_cost));
    RITZ_MOVE(*out, s);
    if (facts)
        RITZ_MOVE(*facts, found);
    return RITZ_OK;
}

void ritz_constrained_facts_free(ritz_constrained_facts *facts)
{
    RITZ_FREE(facts->redundant);
    *facts = (ritz_constrained_facts){0};
}
