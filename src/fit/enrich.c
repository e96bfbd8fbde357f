/*
 * How far a search goes where nothing is met: COMPARE's first stage made richer,
 * and in words what ended it all.
 */
#include "fit/fit_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of a tolerance so much may be the first stage's own error. */
static const double may_leave = 0.1;
/* A richer stage has modes so much farther, and a quarter more of them. */
static const double farther = 1.5;
enum { PART = 4 };
/* Richer stages that are no better by a tenth, before it is given up. */
enum { MOST_FLAT = 3 };
static const double better = 0.9;

/* How far COMPARE is off with nothing removed, whatever its order. */
static ritz_status excess_of_all(ritz_fitter *f, double *out)
{
    ritz_status status = RITZ_OK;
    const ritz_fit_request request = f->request;
    const int64_t largest = f->largest;
    ritz_fit_candidate whole = {.method = &ritz_fit_compare,
                                .num_bodies = f->num_bodies,
                                .binding = -1};

    RITZ_NEW(whole.modes, f->num_bodies);
    ritz_fit_rung(f, whole.method, ritz_fit_rungs(f, whole.method),
                  whole.modes);
    f->largest = INT64_MAX;
    f->request.thorough = true; /* measured, not bounded */
    f->request.costs = false;
    status = ritz_fit_try_scene(f, &whole);
    f->request = request;
    f->largest = largest;
    RITZ_TRY(status);
    *out = whole.refusal[0] ? 0.0 : whole.excess; /* its sentence is told */
done:
    ritz_fit_candidate_free(&whole);
    return status;
}

/* Modes of bodies up to a frequency, as far as the ladder has them. */
static int64_t count_to(const ritz_fitter *f, double hertz)
{
    int64_t count = 0;

    while (count < f->num_steps && f->step_hz[count] <= hertz)
        count++;
    return count;
}

/* The frequency to which a richer stage has modes. */
static ritz_status next_hz(ritz_fitter *f, double *hertz, ritz_fit_end *end)
{
    const double from = f->second.rich_hz;
    int64_t count = 0, more = 0;

    *end = RITZ_FIT_END_NONE;
    for (;;) {
        count = count_to(f, from);
        more = count + count / PART + 1;
        if ((count_to(f, farther * from) < f->num_steps &&
             more <= f->num_steps) ||
            *end != RITZ_FIT_END_NONE)
            break;
        RITZ_CHECK(ritz_fit_extend(f, end));
    }
    if (count == f->num_steps)
        return RITZ_OK;
    *end = RITZ_FIT_END_NONE;
    more = more < f->num_steps ? more : f->num_steps;
    *hertz = fmax(farther * from, f->step_hz[more - 1] * (1.0 + 1e-9));
    return RITZ_OK;
}

ritz_status ritz_fit_enrich(ritz_fitter *f, ritz_fit_end *end)
{
    ritz_status status = RITZ_OK;
    double excess = 0.0, before = HUGE_VAL, hertz = 0.0;
    bool made = false;

    *end = RITZ_FIT_END_NONE;
    RITZ_TRY(ritz_fit_second_make(f));
    if (f->second.status != RITZ_OK)
        return RITZ_OK;
    RITZ_TRY(excess_of_all(f, &excess));
    for (int flat = 0; excess > may_leave;) {
        RITZ_TRY(next_hz(f, &hertz, end));
        if (*end != RITZ_FIT_END_NONE)
            break;
        *end = RITZ_FIT_END_REFUSED;
        RITZ_TRY(ritz_fit_second_remake(f, hertz, &made));
        if (!made)
            break;
        before = excess;
        RITZ_TRY(excess_of_all(f, &excess));
        flat = excess > better * before ? flat + 1 : 0;
        *end = flat == MOST_FLAT ? RITZ_FIT_END_FLAT : RITZ_FIT_END_NONE;
        if (*end != RITZ_FIT_END_NONE)
            break;
    }
done:
    return status;
}

/* What ended a method, but where a number says it. */
static const char *const words[] = {
    [RITZ_FIT_END_WHOLE] = "there are no more modes to be had",
    [RITZ_FIT_END_SAME] = "more modes give it no more columns",
    [RITZ_FIT_END_FLAT] = "more modes no longer made the error smaller",
    [RITZ_FIT_END_REFERENCE] =
        "what it is compared with, a first stage, has no more modes",
    [RITZ_FIT_END_REFUSED] = "the next larger one cannot be made",
};

/* The method that comes nearest; -1: all were refused. */
static int64_t nearest(const ritz_fit *fit)
{
    int64_t near = -1;

    for (int64_t m = 0; m < fit->num_methods; m++)
        if (fit->reached[m] >= 0 &&
            (near < 0 ||
             ritz_fit_is_nearer(&fit->candidate[fit->reached[m]],
                                &fit->candidate[fit->reached[near]])))
            near = m;
    return near;
}

void ritz_fit_explain_end(const ritz_fitter *f, ritz_fit *fit)
{
    const size_t used = strlen(fit->why), room = sizeof fit->why - used;
    int64_t near = fit->chosen < 0 ? nearest(fit) : -1;
    ritz_fit_end end = near < 0 ? RITZ_FIT_END_NONE : fit->end[near];

    if (end == RITZ_FIT_END_LARGEST)
        (void)snprintf(fit->why + used, room,
                       "; more than %" PRId64
                       " columns were not tried (--largest)",
                       f->largest);
    else if (end == RITZ_FIT_END_FAR)
        (void)snprintf(fit->why + used, room,
                       "; more than %" PRId64
                       " modes were not tried (--largest)",
                       f->num_steps);
    else if (end != RITZ_FIT_END_NONE)
        (void)snprintf(fit->why + used, room, "; %s", words[end]);
}
