/* Over all methods: which are tried, which candidate is chosen, and why. */
#include "fit/fitter.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/base.h>

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Methods tried by default: second-order models with a number of modes; for a
   model with an interface those that keep it. Others must be named. */
static bool is_usual(const ritz_fitter *fitter, const ritz_method *method)
{
    const int special =
        RITZ_USES_SPACE | RITZ_USES_GRAMIAN | RITZ_USES_OPERATOR;
    const int joined = RITZ_USES_MODES | RITZ_USES_ATTACHED;

    if (fitter->scene)
        return (method->uses & joined) == joined &&
               !(method->only_named & RITZ_NAMED_FOR_SCENES);
    if (fitter->attached.count > 0 && !method->keeps_interface)
        return false;
    return (method->uses & RITZ_USES_MODES) && !(method->uses & special) &&
           !(method->uses & RITZ_USES_NEIGHBOUR) &&
           !(method->only_named & RITZ_NAMED_FOR_COMPONENTS);
}

/* The methods of the request, or all usual ones and, of joined bodies,
   `compare`. */
static ritz_status list_methods(ritz_fitter *fitter, ritz_fit *fit)
{
    const ritz_fit_request *asked = &fitter->request;
    bool joined = fitter->scene && fitter->scene->num_components > 1;
    int64_t all = 0;

    while (ritz_methods[all])
        all++;
    if (asked->num_methods > 0)
        all = asked->num_methods;
    RITZ_CHECK_NEW(fit->method, all + 1); /* NOLINT: of pointers */
    RITZ_CHECK_NEW(fit->best, all + 1);
    RITZ_CHECK_NEW(fit->reached, all + 1);
    RITZ_CHECK_NEW(fit->end, all + 1);
    for (int64_t k = 0; k < all; k++)
        if (asked->num_methods > 0)
            fit->method[fit->num_methods++] = asked->methods[k];
        else if (is_usual(fitter, ritz_methods[k]))
            fit->method[fit->num_methods++] = ritz_methods[k];
    if (asked->num_methods == 0 && joined)
        fit->method[fit->num_methods++] = &ritz_fit_compare;
    for (int64_t m = 0; m < fit->num_methods; m++) {
        fit->best[m] = fit->reached[m] = -1;
        if (fitter->scene && fit->method[m] == &ritz_fit_compare)
            RITZ_CHECK(ritz_fit_second_make(fitter, fitter->rich_hz, NULL));
    }
    return RITZ_OK;
}

/* Best of all methods but one; -1: none meets the tolerance. */
static int64_t find_best(const ritz_fit *fit, int64_t but)
{
    int64_t found = -1;

    for (int64_t m = 0; m < fit->num_methods; m++) {
        const int64_t k = fit->best[m];

        if (k >= 0 && k != but &&
            (found < 0 ||
             ritz_fit_is_better(&fit->candidate[k], &fit->candidate[found])))
            found = k;
    }
    return found;
}

static void choose_best(ritz_fit *fit)
{
    fit->chosen = find_best(fit, -1);
    fit->runner_up = find_best(fit, fit->chosen);
}

/* Leave columns that matter to nothing out of one method's best candidate. */
static ritz_status trim_candidate(ritz_fitter *fitter, int64_t at,
                                  ritz_fit *fit)
{
    RITZ_OWN(ritz_fit_candidate) less = {0};

    ritz_monitor_step("columns to be left out", at, fit->count);
    RITZ_CHECK(ritz_fit_trim(fitter, &fit->candidate[at], &less));
    if (less.order == 0)
        return RITZ_OK;
    if (fitter->request.observe)
        fitter->request.observe(&less, fitter->request.context);
    return ritz_fit_append(fit, &less);
}

/* The same of every method that may still be the best then, and choose
   again. */
static ritz_status trim_best(ritz_fitter *fitter, ritz_fit *fit)
{
    double most = 0.0;

    if (fit->chosen >= 0)
        most = RITZ_FIT_REACH * (double)fit->candidate[fit->chosen].order;
    for (int64_t m = 0; m < fit->num_methods; m++) {
        int64_t at = fit->best[m];

        if (at >= 0 &&
            ((double)fit->candidate[at].order <= most || at == fit->runner_up))
            RITZ_CHECK(trim_candidate(fitter, at, fit));
    }
    for (int64_t m = 0; m < fit->num_methods; m++)
        ritz_fit_conclude(fit, m);
    choose_best(fit);
    return RITZ_OK;
}

/* --- why ------------------------------------------------------------------ */

[[gnu::format(printf, 2, 3)]] static void add_why(ritz_fit *fit,
                                                  const char *format, ...)
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
        add_why(fit,
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
        add_why(fit, "it is refused: %s", c->refusal);
        return;
    }
    if (c->ruled_out)
        add_bound(fit, c);
    if (c->worst < 0)
        return;
    m = &c->errors.item[c->worst];
    kind = ritz_measure_kind_find(m->name);
    if (strcmp(m->name, "missing-modes") == 0)
        add_why(fit, "%.0f mode%s of the band %s missing (%s)", m->value,
                m->value > 1.0 ? "s" : "", m->value > 1.0 ? "are" : "is",
                m->where);
    else if (kind && kind->large_is_good && m->limit > RITZ_MAC_NEARLY_ONE)
        add_why(fit, "the least MAC is 1 - %.1e (%s) where 1 - %.1e is asked",
                1.0 - m->value, m->where, 1.0 - m->limit);
    else if (kind && kind->large_is_good)
        add_why(fit, "the least MAC is %.4f (%s) where %.4f is asked", m->value,
                m->where, m->limit);
    else
        add_why(fit, "the error of '%s' is %.2e (%s) where %g is allowed",
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
        add_why(fit,
                "; more than %" PRId64 " columns were not tried (--largest)",
                f->largest);
    else if (end == RITZ_FIT_END_FAR)
        add_why(fit, "; more than %" PRId64 " modes were not tried (--largest)",
                f->num_steps);
    else if (end != RITZ_FIT_END_NONE)
        add_why(fit, "; %s", words[end]);
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
    if (!near && fit->count == 0) {
        add_why(fit, "none was tried");
        return;
    }
    if (!near) {
        add_why(fit, "every %s was refused",
                fit->interrupted ? "candidate so far" : "method");
        for (int64_t k = 0; k < fit->count; k++)
            if (fit->candidate[k].refusal[0]) {
                add_why(fit, ", the first with: %s", fit->candidate[k].refusal);
                break;
            }
        return;
    }
    add_why(fit,
            "no %s meets the tolerance; nearest is %s with %" PRId64
            " column%s, where ",
            fit->interrupted ? "candidate so far" : "method",
            near->method->name, near->order, near->order == 1 ? "" : "s");
    add_error(fit, near);
    explain_end(f, method, fit);
}

static void explain_runner_up(ritz_fit *fit, const ritz_fit_candidate *c)
{
    const ritz_fit_candidate *second = &fit->candidate[fit->runner_up];
    int64_t more = second->order - c->order;

    if (more == 0 && fabs(second->ratio - c->ratio) < 0.005)
        add_why(fit, "; %s is as small, and as near to its tolerance",
                second->method->name);
    else if (more == 0)
        add_why(fit,
                "; %s is as small, and comes to %.2f of its tolerance where "
                "%s comes to %.2f",
                second->method->name, second->ratio, c->method->name, c->ratio);
    else
        add_why(fit, "; the runner-up, %s, needs %" PRId64 " column%s more",
                second->method->name, more, more == 1 ? "" : "s");
    if (c->cost.order > 0 && second->cost.order > 0 &&
        isfinite(second->cost.step_explicit) &&
        fabs(log(second->cost.step_explicit / c->cost.step_explicit)) >
            RITZ_STEP_WORTH_SAYING)
        add_why(
            fit,
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
        add_why(fit, "%s '%s'",
                any ? " or" : "; nothing was there to be held to", kind->word);
        any = true;
    }
}

/* Why the chosen candidate was chosen; where none is, what ended the search. */
static void explain_choice(const ritz_fitter *fitter, ritz_fit *fit)
{
    const ritz_fit_candidate *c = NULL;
    const ritz_fit_candidate *less = NULL;
    int64_t caught = 0, smaller = -1;

    fit->why[0] = '\0';
    if (fit->interrupted)
        add_why(fit, "interrupted after %" PRId64 " candidate%s; ", fit->count,
                fit->count == 1 ? "" : "s");
    if (fit->chosen < 0) {
        explain_none(fitter, fit);
        return;
    }
    c = &fit->candidate[fit->chosen];
    smaller = ritz_fit_largest_of(fit, c->method, c->order - 1);
    less = smaller < 0 ? NULL : &fit->candidate[smaller];
    add_why(fit, "%s meets the tolerance with %" PRId64 " column%s",
            c->method->name, c->order, c->order == 1 ? "" : "s");
    if (c->left_out > 0)
        add_why(fit, ", %" PRId64 " of its basis being left out", c->left_out);
    if (less) {
        add_why(fit, "; the next smaller that was tried has %" PRId64 ", and ",
                less->order);
        add_error(fit, less);
    } else {
        add_why(fit, "%s",
                fit->interrupted ? "; no smaller one was tried yet"
                                 : ", the fewest that it can have");
    }
    if (fit->runner_up >= 0)
        explain_runner_up(fit, c);
    else if (fit->num_methods > 1)
        add_why(fit, "%s",
                fit->interrupted ? "; no other method has met it yet"
                                 : "; no other method meets it");
    if (rigid_alone(fitter, c))
        add_why(fit,
                "; nothing but rigid motion makes the largest response: to "
                "hold the rest, ask for 'flexible'");
    add_vacuous(fitter, fit, c);
    for (int64_t k = 0; k < fit->count; k++)
        caught += fit->candidate[k].unconfirmed;
    if (caught > 0)
        add_why(fit, "; %" PRId64 " candidate%s the grid and failed at %s%s",
                caught, caught == 1 ? " met" : "s met",
                fitter->num_places > 1           ? "random places or "
                : fitter->request.num_random > 0 ? "random frequencies or "
                                                 : "",
                caught == 1 ? "its own poles" : "their own poles");
}

/* --- the search ----------------------------------------------------------- */

/* Costs of the best of each method, of an interrupted search of the result. */
static ritz_status find_costs(ritz_fitter *fitter, ritz_fit *fit)
{
    for (int64_t m = 0; m < fit->num_methods && fitter->request.costs; m++)
        if (fit->best[m] >= 0 &&
            (!fit->interrupted || fit->best[m] == fit->chosen))
            RITZ_CHECK(ritz_fit_cost(fitter, &fit->candidate[fit->best[m]]));
    return RITZ_OK;
}

static ritz_status search_methods(ritz_fitter *fitter, ritz_fit *fit)
{
    for (int64_t m = 0; m < fit->num_methods; m++)
        RITZ_CHECK(ritz_fit_search(fitter, fit, m, false));
    for (int64_t m = 0; m < fit->num_methods; m++)
        if (fitter->scene && fit->best[m] < 0 &&
            fit->method[m] != &ritz_fit_compare)
            RITZ_CHECK(ritz_fit_search(fitter, fit, m, true));
    choose_best(fit);
    RITZ_CHECK(trim_best(fitter, fit));
    if (fit->chosen >= 0)
        RITZ_CHECK(ritz_fit_bound(fitter, &fit->candidate[fit->chosen]));
    if (fit->runner_up >= 0)
        RITZ_CHECK(ritz_fit_bound(fitter, &fit->candidate[fit->runner_up]));
    return RITZ_OK;
}

ritz_status ritz_fitter_search(ritz_fitter *fitter, ritz_fit *out)
{
    [[maybe_unused]] RITZ_OWN(ritz_orders_lent) orders =
        ritz_orders_lend(fitter->orders);
    [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) spectra =
        ritz_spectra_lend(fitter->spectra);
    RITZ_OWN(ritz_fit) fit = {.chosen = -1, .runner_up = -1};
    ritz_status status = RITZ_OK;

    RITZ_CHECK(list_methods(fitter, &fit));
    status = search_methods(fitter, &fit);
    fit.interrupted = fitter->stopped;
    if (!fit.interrupted)
        RITZ_CHECK(status);
    for (int64_t m = 0; fit.interrupted && m < fit.num_methods; m++)
        ritz_fit_conclude(&fit, m);
    if (fit.interrupted)
        choose_best(&fit);
    RITZ_CHECK(find_costs(fitter, &fit));
    explain_choice(fitter, &fit);
    RITZ_MOVE(*out, fit);
    return RITZ_OK;
}

/* Largest candidate of a method with at most @p order columns, by bisection. */
static ritz_status approach_order(ritz_fitter *fitter, int64_t order,
                                  int64_t method, int64_t *modes, ritz_fit *fit)
{
    const ritz_method *asked = fit->method[method];
    bool met = false;
    int64_t low = -1, at = 0;
    int64_t high = 1 + (fitter->scene ? ritz_fit_rungs(fitter, asked) : order);

    if (!(asked->uses & RITZ_USES_MODES))
        high = 1;
    while (high - low > 1) {
        int64_t t = low + (high - low) / 2;
        const ritz_fit_candidate *c = NULL;

        ritz_fit_rung(fitter, asked, t, modes);
        RITZ_CHECK(ritz_fit_visit(fitter, fit, method, modes, &at));
        c = &fit->candidate[at];
        if (!c->refusal[0] && c->order <= order) {
            low = t;
            met = true;
        } else if (!c->refusal[0] || met || c->order > fitter->largest) {
            high = t;
        } else {
            low = t; /* refused for being too small, perhaps */
        }
    }
    return RITZ_OK;
}

ritz_status ritz_fitter_equal(ritz_fitter *fitter, int64_t order, ritz_fit *fit,
                              int64_t *at)
{
    [[maybe_unused]] RITZ_OWN(ritz_orders_lent) orders =
        ritz_orders_lend(fitter->orders);
    [[maybe_unused]] RITZ_OWN(ritz_spectra_lent) spectra =
        ritz_spectra_lend(fitter->spectra);
    RITZ_OWN_ARRAY int64_t *modes = NULL;

    RITZ_CHECK_NEW(modes, fitter->num_bodies);
    for (int64_t m = 0; m < fit->num_methods; m++) {
        RITZ_CHECK(approach_order(fitter, order, m, modes, fit));
        ritz_fit_conclude(fit, m);
        at[m] = ritz_fit_largest_of(fit, fit->method[m], order);
    }
    return RITZ_OK;
}

void ritz_fit_free(ritz_fit *fit)
{
    RITZ_FREE_EACH(ritz_fit_candidate, fit->count, fit->candidate);
    RITZ_FREE(fit->method, fit->best, fit->reached, fit->end);
    *fit = (ritz_fit){0};
}
