/* The answer in one look. */
#include "chart/html.h"
#include "chart/report.h"

#include <ritz/measures.h>

#include <math.h>

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

static void begin_card(FILE *file, const char *question, const char *answer)
{
    html_print(file, "<div><dt>%s</dt><dd><div class=\"big\">%s</div><ul>",
               question, answer);
}

static void end_card(FILE *file)
{
    fprintf(file, "</ul></dd></div>\n");
}

static void say_method(FILE *file, const record *r, const record *second)
{
    begin_card(file, "Which method", r->method);
    if (second)
        html_print(file, "<li>runner-up: %s, order %lld</li>", second->method,
                   (long long)second->order);
    end_card(file);
}

/* "14 + 2 modes asked for": of each component of a scene. */
static void say_size(FILE *file, const record *r)
{
    const json_t *full = json_object_get(r->json, "dofs_full");
    const json_t *modes = json_object_get(r->json, "modes");
    const size_t count = json_array_size(modes);
    char order[32];

    snprintf(order, sizeof order, "%lld", (long long)r->order);
    begin_card(file, "How large", order);
    fprintf(file, "<li>coordinates");
    if (json_integer_value(full) > 0)
        fprintf(file, ", of %lld dofs of the full model",
                (long long)json_integer_value(full));
    fprintf(file, count > 0 ? "</li><li>" : "</li>");
    for (size_t k = 0; k < count; k++)
        fprintf(file, "%s%lld", k > 0 ? " + " : "",
                (long long)json_integer_value(json_array_get(modes, k)));
    if (count > 0)
        fprintf(file, " modes asked for%s</li>",
                count > 1 ? ", component by component" : "");
    end_card(file);
}

/* Bounds that are proven without measuring; those above 1 say nothing. */
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
        html_print(file, "<li>proven: %s at most %s</li>", kind->label, word);
    }
}

static void say_errors(FILE *file, const record *r, int64_t count,
                       const measure *m)
{
    char word[32], limit[32];

    chart_say_error(record_error(r, m->name), word);
    begin_card(file, "How wrong", word);
    for (int64_t k = 0; k < count; k++) {
        double error = record_error(r, m[k].name);

        if (isnan(error))
            continue;
        chart_say_error(error, word);
        html_print(file, "<li>%s: %s", m[k].title, word);
        if (m[k].tolerance > 0.0) {
            chart_say_error(m[k].tolerance, limit);
            fprintf(file, ", allowed <span class=\"whole\">%s</span>", limit);
        }
        fprintf(file, "</li>");
    }
    say_bounds(file, r);
    end_card(file);
}

static void say_cost(FILE *file, const record *r)
{
    const json_t *cost = json_object_get(r->json, "cost");
    const double step = record_value(cost, "step");
    const double highest = record_value(cost, "highest_hz");
    const char *by = json_string_value(json_object_get(cost, "integrator"));
    const bool simulated = isfinite(r->cost);
    char word[32];

    chart_say_seconds(simulated ? r->cost : r->cpu, word);
    begin_card(file, "How fast", word);
    if (simulated)
        fprintf(file, "<li>for one simulated second, %.0f times real time</li>",
                1.0 / r->cost);
    if (simulated && isfinite(step)) {
        chart_say_seconds(step, word);
        html_print(file, "<li>step %s%s%s</li>", word, by ? ", " : "",
                   by ? by : "");
    }
    if (simulated && isfinite(highest))
        fprintf(file, "<li>highest mode %.4g Hz</li>", highest);
    chart_say_seconds(r->cpu, word);
    if (isfinite(r->cpu))
        fprintf(file, "<li>%s%sto make basis and reduction</li>",
                simulated ? word : "", simulated ? " " : "");
    end_card(file);
}

static void say_why(FILE *file, const record *r, reason why, int64_t count)
{
    const char *text = json_string_value(json_object_get(r->json, "why"));

    if (r->tolerance)
        fprintf(file, "<p class=\"%s\">%s</p>\n",
                r->feasible ? "meets" : "misses",
                r->feasible ? "&#10003; It meets every tolerance."
                            : "&#10007; It misses a tolerance.");
    if (text)
        html_print(file, "<p>Why: %s</p>\n", text);
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

void report_verdict(FILE *file, const selection *s)
{
    reason why = NEAREST;
    const record *r = find_answer(&s->all, &why);

    if (!r) {
        fprintf(file,
                "<p>%lld model%s measured. No record says which was chosen, "
                "and none has a tolerance that its errors can be held "
                "against.</p>\n",
                (long long)s->all.count, s->all.count == 1 ? " was" : "s were");
        return;
    }
    fprintf(file, "<dl class=\"cards\">\n");
    say_method(file, r, find_second(&s->all));
    say_size(file, r);
    say_errors(file, r, s->num_measures, s->measure);
    say_cost(file, r);
    fprintf(file, "</dl>\n");
    say_why(file, r, why, s->all.count);
}
