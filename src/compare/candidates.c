/*
 * Which dofs to attach [McDaniel2000, sec. 3.2.2]: stage two with the static
 * corrections of one set of forces after the other, each held against stage one
 * by static gain, at and between listed angles, and by the largest singular
 * value of the frequency response over the band.
 */
#include "base/alloc.h"
#include "compare/compare_parts.h"

#include <ritz/monitor.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sets that are tried, fewest forces first. */
static const int of_system[] = {0, RITZ_ATTACHED_INPUTS,
                                RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_OUTPUTS};
static const int of_components[] = {
    0,
    RITZ_ATTACHED_INPUTS,
    RITZ_ATTACHED_INTERFACE,
    RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE,
    RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_INTERFACE | RITZ_ATTACHED_OUTPUTS,
};

enum { MOST_SETS = sizeof of_components / sizeof *of_components + 1 };

/* "inputs, interface" */
static void name_set(const ritz_scene *scene, ritz_candidate *candidate)
{
    static const char *const words[] = {"inputs", "interface", "outputs"};
    char *out = candidate->name;
    size_t size = sizeof candidate->name;
    size_t used = 0;

    for (int k = 0; k < 3; k++)
        if (candidate->attached & (1 << k))
            used += (size_t)snprintf(out + used, size - used, "%s%s",
                                     used ? ", " : "", words[k]);
    for (int64_t k = 0;
         candidate->inputs_too && k < scene->num_attached_inputs && used < size;
         k++)
        used +=
            (size_t)snprintf(out + used, size - used, "%s%s", used ? ", " : "",
                             scene->input[scene->attached_input[k]].name);
    if (used == 0)
        snprintf(out, size, "nothing");
}

/* Errors at listed configurations. */
static ritz_status measure_listed(const ritz_rows *rows, ritz_trial *trial,
                                  ritz_candidate *out)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = rows->stage->scene;
    bool driven = scene->num_inputs > 0 && scene->num_outputs > 0;
    ritz_two_responses r = {0};

    for (int64_t k = 0; k < trial->system.num_configurations; k++) {
        const ritz_configuration *first = ritz_rows_first(rows, k);
        const ritz_configuration *second = &trial->system.configuration[k];
        double gain = nan(""), apart = 0.0, hertz = 0.0;

        if (driven)
            RITZ_TRY(ritz_compare_gain(first, second, &gain));
        out->gain_listed = fmax(out->gain_listed, gain);
        out->largest =
            second->K.ncol > out->largest ? second->K.ncol : out->largest;
        if (!ritz_compare_responds(scene))
            continue;
        RITZ_TRY(ritz_compare_respond(scene, first, second, &r));
        RITZ_TRY(ritz_compare_bode(&r, &apart, &hertz));
        ritz_two_responses_free(&r);
        if (isnan(out->deviation) || apart > out->deviation) {
            out->deviation = apart;
            out->hertz = hertz;
            memcpy(out->at, first->at, sizeof out->at);
        }
    }
done:
    ritz_two_responses_free(&r);
    return status;
}

/* Static gain between them. */
static ritz_status measure_between(const ritz_rows *rows, ritz_trial *trial,
                                   ritz_candidate *out)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = rows->stage->scene;
    bool driven = scene->num_inputs > 0 && scene->num_outputs > 0;
    ritz_configuration second = {0};

    for (int64_t k = trial->system.num_configurations;
         k < rows->num_rows && driven; k++) {
        double gain = 0.0;

        RITZ_TRY(
            ritz_stage_assemble(&trial->second, rows->row[k].setting, &second));
        RITZ_TRY(ritz_compare_gain(ritz_rows_first(rows, k), &second, &gain));
        out->gain_between = fmax(out->gain_between, gain);
        ritz_configuration_free(&second);
    }
done:
    ritz_configuration_free(&second);
    return status;
}

static ritz_status try_set(const ritz_rows *rows, const ritz_plan *plan,
                           ritz_candidate *out)
{
    ritz_status status = RITZ_OK;
    ritz_trial trial = {0};

    out->level = plan->augment;
    out->attached = plan->attached;
    out->inputs_too = plan->inputs_too;
    out->gain_listed = out->gain_between = out->deviation = nan("");
    name_set(rows->stage->scene, out);
    RITZ_TRY(ritz_compare_try(rows, plan, &trial));
    RITZ_NEW(out->order, trial.count);
    for (int64_t c = 0; c < trial.count; c++)
        out->total += out->order[c] = trial.V[c].ncol;
    RITZ_TRY(measure_listed(rows, &trial, out));
    RITZ_TRY(measure_between(rows, &trial, out));
done:
    ritz_trial_free(&trial);
    return ritz_context(status, out->name);
}

/*
 * The smallest of those within the tolerance, or else the nearest of all. Of
 * equal sizes the first is taken, which has fewer forces; one that is nearer by
 * rounding is no nearer.
 */
static int64_t pick(const ritz_scene *scene, int64_t count,
                    const ritz_candidate *candidate)
{
    const double nearer = 0.9;
    int64_t best = 0;

    for (int64_t k = 1; k < count; k++) {
        const ritz_candidate *a = &candidate[best];
        const ritz_candidate *b = &candidate[k];
        bool a_fits = a->deviation <= scene->attached_tolerance;
        bool b_fits = b->deviation <= scene->attached_tolerance;

        if (a_fits != b_fits ? b_fits
                             : (b_fits ? b->total < a->total
                                       : b->deviation < nearer * a->deviation))
            best = k;
    }
    return best;
}

/* Sets to try: those of the level, and the one asked if it is another. */
static int64_t list_sets(const ritz_plan *plan, ritz_plan sets[MOST_SETS])
{
    bool system = plan->augment == RITZ_AUGMENT_SYSTEM;
    const int *of = system ? of_system : of_components;
    int64_t count =
        (int64_t)(system ? sizeof of_system : sizeof of_components) /
        (int64_t)sizeof *of;
    bool listed = plan->attached == RITZ_ATTACHED_AUTO;

    for (int64_t k = 0; k < count; k++) {
        sets[k] = *plan;
        sets[k].attached = of[k];
        sets[k].inputs_too = false;
        listed = listed || (!plan->inputs_too && plan->attached == of[k]);
    }
    if (!listed)
        sets[count++] = *plan;
    return count;
}

/* Which of the sets is the one asked. */
static int64_t find_set(int64_t count, const ritz_plan *sets,
                        const ritz_plan *plan)
{
    int64_t at = 0;

    while (at < count - 1 && (sets[at].attached != plan->attached ||
                              sets[at].inputs_too != plan->inputs_too))
        at++;
    return at;
}

ritz_status ritz_compare_candidates(const ritz_rows *rows, ritz_plan *plan,
                                    int64_t *count, ritz_candidate **out)
{
    const ritz_scene *scene = rows->stage->scene;
    bool open = plan->attached == RITZ_ATTACHED_AUTO;
    ritz_plan sets[MOST_SETS];
    int64_t most = list_sets(plan, sets);
    int64_t chosen = 0;

    if (plan->augment != RITZ_AUGMENT_COMPONENT && !open)
        return RITZ_OK;
    RITZ_REFUSE_IF(open && !ritz_compare_responds(scene), RITZ_ERR_ARGUMENT,
                   "they are chosen by frequency responses, which need inputs, "
                   "outputs, a band and a damping of the scene");
    RITZ_CHECK_NEW(*out, most);
    *count = most;
    for (int64_t k = 0; k < most; k++) {
        ritz_monitor_step("attached dofs", k, most);
        RITZ_CHECK(try_set(rows, &sets[k], &(*out)[k]));
    }
    chosen = open ? pick(scene, most, *out) : find_set(most, sets, plan);
    (*out)[chosen].chosen = true;
    *plan = sets[chosen];
    return RITZ_OK;
}

void ritz_candidates_free(int64_t count, ritz_candidate **candidates)
{
    for (int64_t k = 0; *candidates && k < count; k++)
        free((*candidates)[k].order);
    free(*candidates);
    *candidates = NULL;
}
