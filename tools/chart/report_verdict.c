/* The answer in one look. */
#include "chart/report_parts.h"

#include "chart/html.h"

#include <ritz/measures.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Why a record is the answer. */
typedef enum reason { CHOSEN, SMALLEST, NEAREST } reason;

/* How many times its tolerance the worst error is; infinite: not known. */
static double excess_of(const record *r)
{
    const char *name = NULL;
    json_t *limit = NULL;
    double worst = 0.0;

    if (r->incomplete)
        return HUGE_VAL;
    json_object_foreach(r->tolerance, name, limit)
    {
        double times = ritz_measure_ratio(name, record_value(r->errors, name),
                                          json_number_value(limit));

        if (isnan(times))
            return HUGE_VAL;
        worst = fmax(worst, times);
    }
    return worst;
}

static bool is_better(const record *r, const record *than)
{
    if (!than)
        return true;
    if (r->feasible != than->feasible)
        return r->feasible;
    if (!r->feasible)
        return excess_of(r) < excess_of(than);
    return r->order < than->order ||
           (r->order == than->order && r->cost < than->cost);
}

/*
 * What was chosen; else the smallest that meets the tolerance; else what comes
 * nearest to it; NULL: no tolerance is known.
 */
static const record *find_answer(const records *all, reason *why)
{
    const record *best = NULL;

    for (int64_t k = 0; k < all->count; k++) {
        const record *r = &all->item[k];

        if (r->chosen) {
            *why = CHOSEN;
            return r;
        }
        if (r->tolerance && (r->feasible || excess_of(r) < HUGE_VAL) &&
            is_better(r, best))
            best = r;
    }
    *why = best && best->feasible ? SMALLEST : NEAREST;
    return best;
}

static const record *find_second(const records *all)
{
    for (int64_t k = 0; k < all->count; k++)
        if (all->item[k].runner_up)
            return &all->item[k];
    return NULL;
}

static void begin_card(FILE *file, const char *question)
{
    fprintf(file, "<div><dt>%s</dt><dd><div class=\"big\">", question);
}

static void say_method(FILE *file, const record *r, const record *second)
{
    begin_card(file, "Which method");
    html_text(file, r->method);
    fprintf(file, "</div>");
    if (second) {
        fprintf(file, "<ul><li>runner-up: ");
        html_text(file, second->method);
        fprintf(file, ", order %lld</li></ul>", (long long)second->order);
    }
    fprintf(file, "</dd></div>\n");
}

/* A whole number of a record; -1: it has none. */
static int64_t whole_of(const record *r, const char *name)
{
    const json_t *value = json_object_get(r->json, name);

    return json_is_integer(value) ? json_integer_value(value) : -1;
}

/* "14 + 2 flexible modes": of each component of a scene. */
static void say_modes(FILE *file, const json_t *modes)
{
    fprintf(file, "<li>");
    for (size_t k = 0; k < json_array_size(modes); k++)
        fprintf(file, "%s%lld", k > 0 ? " + " : "",
                (long long)json_integer_value(json_array_get(modes, k)));
    fprintf(file, " modes asked for%s</li>",
            json_array_size(modes) > 1 ? ", component by component" : "");
}

static void say_size(FILE *file, const record *r)
{
    int64_t full = whole_of(r, "dofs_full");
    const json_t *modes = json_object_get(r->json, "modes");

    begin_card(file, "How large");
    fprintf(file, "%lld", (long long)r->order);
    fprintf(file, "</div><ul><li>coordinates");
    if (full > 0)
        fprintf(file, ", of %lld dofs of the full model", (long long)full);
    fprintf(file, "</li>");
    if (json_array_size(modes) > 0)
        say_modes(file, modes);
    fprintf(file, "</ul></dd></div>\n");
}

/* What is known without measuring: nothing that is worse than all. */
static void say_bounds(FILE *file, const record *r)
{
    const json_t *estimates = json_object_get(r->json, "estimates");
    char word[32];

    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];
        double bound = kind->bound && kind->label
                           ? record_value(estimates, kind->bound)
                           : nan("");

        if (!(bound <= 1.0))
            continue;
        chart_say_error(bound, word);
        fprintf(file, "<li>");
        html_print(file, "proven: %s at most %s", kind->label, word);
        fprintf(file, "</li>");
    }
}

static void say_errors(FILE *file, const record *r, int64_t count,
                       const measure *m)
{
    char word[32], limit[32];

    begin_card(file, "How wrong");
    chart_say_error(record_error(r, m->name), word);
    html_text(file, word);
    fprintf(file, "</div><ul>");
    for (int64_t k = 0; k < count; k++) {
        double error = record_error(r, m[k].name);

        if (isnan(error))
            continue;
        chart_say_error(error, word);
        fprintf(file, "<li>");
        html_print(file, "%s: %s", m[k].title, word);
        if (m[k].tolerance > 0.0) {
            chart_say_error(m[k].tolerance, limit);
            fprintf(file, ", allowed <span class=\"whole\">%s</span>", limit);
        }
        fprintf(file, "</li>");
    }
    say_bounds(file, r);
    fprintf(file, "</ul></dd></div>\n");
}

static void say_cost(FILE *file, const record *r)
{
    const json_t *cost = json_object_get(r->json, "cost");
    double step = record_value(cost, "step");
    double highest = record_value(cost, "highest_hz");
    const char *by = json_string_value(json_object_get(cost, "integrator"));
    char word[32];

    begin_card(file, "How fast");
    chart_say_seconds(isfinite(r->cost) ? r->cost : r->cpu, word);
    fprintf(file, "%s</div><ul>", word);
    if (isfinite(r->cost)) {
        fprintf(file, "<li>for one simulated second, %.0f times real time</li>",
                1.0 / r->cost);
        if (isfinite(step)) {
            chart_say_seconds(step, word);
            fprintf(file, "<li>step %s", word);
            if (by)
                html_print(file, ", %.60s", by);
            fprintf(file, "</li>");
        }
        if (isfinite(highest))
            fprintf(file, "<li>highest mode %.4g Hz</li>", highest);
        chart_say_seconds(r->cpu, word);
    }
    if (isfinite(r->cpu))
        fprintf(file, "<li>%s%sto make basis and reduction</li>",
                isfinite(r->cost) ? word : "", isfinite(r->cost) ? " " : "");
    fprintf(file, "</ul></dd></div>\n");
}

static void say_why(FILE *file, const record *r, reason why, int64_t count)
{
    const char *text = json_string_value(json_object_get(r->json, "why"));

    if (r->tolerance)
        fprintf(file, "<p class=\"%s\">%s</p>\n",
                r->feasible ? "meets" : "misses",
                r->feasible ? "&#10003; It meets every tolerance."
                            : "&#10007; It misses a tolerance.");
    if (text) {
        fprintf(file, "<p>Why: ");
        html_text(file, text);
        fprintf(file, "</p>\n");
    }
    if (why != CHOSEN)
        fprintf(file,
                "<p class=\"note\">No record says which was chosen: this is "
                "the %s.</p>\n",
                why == SMALLEST ? "smallest that meets the tolerance"
                                : "one that comes nearest to its tolerance");
    if (count > 1)
        fprintf(file,
                "<p class=\"note\">One of %lld models that were "
                "measured.</p>\n",
                (long long)count);
}

ritz_status report_verdict(FILE *file, const records *all)
{
    ritz_status status = RITZ_OK;
    reason why = NEAREST;
    const record *r = find_answer(all, &why);
    measure *m = NULL;
    int64_t count = 0;

    if (!r) {
        fprintf(file,
                "<p>%lld model%s measured. No record says which was chosen, "
                "and none has a tolerance that its errors can be held "
                "against.</p>\n",
                (long long)all->count, all->count == 1 ? " was" : "s were");
        return RITZ_OK;
    }
    RITZ_TRY(records_measures(all, &count, &m));
    fprintf(file, "<dl class=\"cards\">\n");
    say_method(file, r, find_second(all));
    say_size(file, r);
    say_errors(file, r, count, m);
    say_cost(file, r);
    fprintf(file, "</dl>\n");
    say_why(file, r, why, all->count);
done:
    free(m);
    return status;
}
