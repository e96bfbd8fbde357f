/* Why the chosen candidate was chosen, in words, and what else there was. */
#include "base/tolerances.h"
#include "fit/fitter.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

[[gnu::format(printf, 2, 3)]] static void add(ritz_fit *fit, const char *format,
                                              ...)
{
    size_t used = strlen(fit->why);
    va_list args;

    va_start(args, format);
    (void)vsnprintf(fit->why + used, sizeof fit->why - used, format, args);
    va_end(args);
}

/* What ruled it out without being measured. */
static void add_bound(ritz_fit *fit, const ritz_fit_candidate *c)
{
    const ritz_measure *m =
        ritz_measures_find(&c->estimates, "frequency-relative-least");

    if (m)
        add(fit,
            "the error of 'frequency' is %.2e at least (%s) where %g is "
            "allowed, or a mode is missing",
            m->value, m->where, m->value / c->ratio);
}

/* "the error of 'response' is 2.1e-02 (3.41 Hz) where 1.0e-02 is allowed" */
static void add_error(ritz_fit *fit, const ritz_fit_candidate *c)
{
    const ritz_measure *m = NULL;
    const ritz_measure_kind *kind = NULL;

    if (c->refusal[0]) {
        add(fit, "it is refused: %s", c->refusal);
        return;
    }
    if (c->ruled_out)
        add_bound(fit, c);
    if (c->worst < 0)
        return;
    m = &c->errors.item[c->worst];
    kind = ritz_measure_kind_find(m->name);
    if (strcmp(m->name, "missing-modes") == 0)
        add(fit, "%.0f mode%s of the band %s missing (%s)", m->value,
            m->value > 1.0 ? "s" : "", m->value > 1.0 ? "are" : "is", m->where);
    else if (kind && kind->large_is_good && m->limit > RITZ_MAC_NEARLY_ONE)
        add(fit, "the least MAC is 1 - %.1e (%s) where 1 - %.1e is asked",
            1.0 - m->value, m->where, 1.0 - m->limit);
    else if (kind && kind->large_is_good)
        add(fit, "the least MAC is %.4f (%s) where %.4f is asked", m->value,
            m->where, m->limit);
    else
        add(fit, "the error of '%s' is %.2e (%s) where %g is allowed",
            ritz_tolerance_word(m->name), m->value, m->where, m->limit);
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

static void explain_end(const ritz_fitter *f, int64_t near, ritz_fit *fit)
{
    ritz_fit_end end = fit->end[near];

    if (end == RITZ_FIT_END_LARGEST)
        add(fit, "; more than %" PRId64 " columns were not tried (--largest)",
            f->largest);
    else if (end == RITZ_FIT_END_FAR)
        add(fit, "; more than %" PRId64 " modes were not tried (--largest)",
            f->num_steps);
    else if (end != RITZ_FIT_END_NONE)
        add(fit, "; %s", words[end]);
}

static void explain_none(const ritz_fitter *f, ritz_fit *fit)
{
    const ritz_fit_candidate *near = NULL;
    int64_t method = -1;

    for (int64_t m = 0; m < fit->num_methods; m++)
        if (fit->reached[m] >= 0) {
            const ritz_fit_candidate *c = &fit->candidate[fit->reached[m]];

            method = !near || ritz_fit_is_nearer(c, near) ? m : method;
            near = &fit->candidate[fit->reached[method]];
        }
    if (!near) {
        add(fit, "every method was refused");
        for (int64_t k = 0; k < fit->count; k++)
            if (fit->candidate[k].refusal[0]) {
                add(fit, ", the first with: %s", fit->candidate[k].refusal);
                break;
            }
        return;
    }
    add(fit,
        "no method meets the tolerance; nearest is %s with %" PRId64
        " column%s, where ",
        near->method->name, near->order, near->order == 1 ? "" : "s");
    add_error(fit, near);
    explain_end(f, method, fit);
}

static void explain_runner_up(ritz_fit *fit, const ritz_fit_candidate *c)
{
    const ritz_fit_candidate *second = &fit->candidate[fit->runner_up];
    int64_t more = second->order - c->order;

    if (more == 0 && fabs(second->ratio - c->ratio) < 0.005)
        add(fit, "; %s is as small, and as near to its tolerance",
            second->method->name);
    else if (more == 0)
        add(fit,
            "; %s is as small, and comes to %.2f of its tolerance where "
            "%s comes to %.2f",
            second->method->name, second->ratio, c->method->name, c->ratio);
    else
        add(fit, "; the runner-up, %s, needs %" PRId64 " column%s more",
            second->method->name, more, more == 1 ? "" : "s");
    if (c->cost.order > 0 && second->cost.order > 0 &&
        isfinite(second->cost.step_explicit) &&
        fabs(log(second->cost.step_explicit / c->cost.step_explicit)) >
            RITZ_STEP_WORTH_SAYING)
        add(fit,
            ", and an explicit integrator could take steps of %.2g s, not of "
            "%.2g s",
            second->cost.step_explicit, c->cost.step_explicit);
}

/* Whether a tolerance of the response left modes of the band out. */
static bool rigid_alone(const ritz_fitter *fitter, const ritz_fit_candidate *c)
{
    const ritz_verify_request *limits = &fitter->request.tolerance;
    if (isnan(limits->limit[RITZ_MEASURE_RESPONSE]) ||
        !isnan(limits->limit[RITZ_MEASURE_FLEXIBLE]))
        return false;
    return ritz_measures_value(&c->errors, "flexible-response-relative") >
           10.0 * limits->limit[RITZ_MEASURE_RESPONSE];
}

/* Tolerances that hold because there is nothing to measure: no mode lies in the
 * band, no channel shows one, no input controls an output. */
static void add_vacuous(const ritz_fitter *fitter, ritz_fit *fit,
                        const ritz_fit_candidate *c)
{
    bool any = false;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];

        if (isnan(fitter->request.tolerance.limit[k]) ||
            ritz_measures_find(&c->errors, kind->name))
            continue;
        add(fit, "%s '%s'", any ? " or" : "; nothing was there to be held to",
            kind->word);
        any = true;
    }
}

ritz_status ritz_fit_explain(const ritz_fitter *fitter, ritz_fit *fit)
{
    const ritz_fit_candidate *c = NULL;
    const ritz_fit_candidate *less = NULL;
    int64_t caught = 0, smaller = -1;

    fit->why[0] = '\0';
    if (fit->chosen < 0) {
        explain_none(fitter, fit);
        return RITZ_OK;
    }
    c = &fit->candidate[fit->chosen];
    smaller = ritz_fit_largest_of(fit, c->method, c->order - 1);
    less = smaller < 0 ? NULL : &fit->candidate[smaller];
    add(fit, "%s meets the tolerance with %" PRId64 " column%s",
        c->method->name, c->order, c->order == 1 ? "" : "s");
    if (c->left_out > 0)
        add(fit, ", %" PRId64 " of its basis being left out", c->left_out);
    if (less) {
        add(fit, "; the next smaller that was tried has %" PRId64 ", and ",
            less->order);
        add_error(fit, less);
    } else {
        add(fit, ", the fewest that it can have");
    }
    if (fit->runner_up >= 0)
        explain_runner_up(fit, c);
    else if (fit->num_methods > 1)
        add(fit, "; no other method meets it");
    if (rigid_alone(fitter, c))
        add(fit, "; nothing but rigid motion makes the largest response: to "
                 "hold the rest, ask for 'flexible'");
    add_vacuous(fitter, fit, c);
    for (int64_t k = 0; k < fit->count; k++)
        caught += fit->candidate[k].unconfirmed;
    if (caught > 0)
        add(fit, "; %" PRId64 " candidate%s the grid and failed at %s%s",
            caught, caught == 1 ? " met" : "s met",
            fitter->num_places > 1           ? "random places or "
            : fitter->request.num_random > 0 ? "random frequencies or "
                                             : "",
            caught == 1 ? "its own poles" : "their own poles");
    return RITZ_OK;
}
