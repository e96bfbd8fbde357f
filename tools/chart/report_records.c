/* What records make of the page: the verdict (which method, how large, how
   wrong, how fast), charts, and methods side by side. */
#include "chart/report.h"

#include "base/alloc.h"

#include <ritz/verify.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- the verdict ---------------------------------------------------------- */

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
        worst =
            fmax(worst, ritz_measure_ratio(name, record_value(r->errors, name),
                                           json_number_value(limit)));
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
 * The chosen record; else the smallest that meets its tolerance; else the one
 * nearest to its tolerance; NULL: no tolerance is known.
 */
static const record *find_shown(const records *all)
{
    const record *best = NULL;

    for (int64_t k = 0; k < all->count; k++) {
        const record *r = &all->item[k];

        if (r->chosen)
            return r;
        if (r->tolerance && (r->feasible || excess_of(r) < HUGE_VAL) &&
            is_better(r, best))
            best = r;
    }
    return best;
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

static void say_method(FILE *file, const records *all, const record *r)
{
    const record *second = all->item, *end = all->item + all->count;

    while (second < end && !second->runner_up)
        second++;
    begin_card(file, "Which method", r->method);
    if (second < end)
        html_print(file, "<li>runner-up: %s, order %ld</li>", second->method,
                   second->order);
    end_card(file);
}

/* "14 + 2 modes asked for": of each component of a scene. */
static void say_size(FILE *file, const record *r)
{
    const json_t *full = json_object_get(r->json, "dofs_full");
    const json_t *modes = json_object_get(r->json, "modes");
    const size_t count = json_array_size(modes);
    char order[32];

    snprintf(order, sizeof order, "%ld", r->order);
    begin_card(file, "How large", order);
    fprintf(file, "<li>coordinates");
    if (json_integer_value(full) > 0)
        fprintf(file, ", of %ld dofs of the full model",
                (int64_t)json_integer_value(full));
    fprintf(file, "</li>");
    for (size_t k = 0; k < count; k++)
        fprintf(file, k > 0 ? " + %ld" : "<li>%ld",
                (int64_t)json_integer_value(json_array_get(modes, k)));
    if (count > 0)
        fprintf(file, " modes asked for%s</li>",
                count > 1 ? ", component by component" : "");
    end_card(file);
}

/* Bounds that are proven without measuring; those above 1 say nothing. */
static void say_bounds(FILE *file, const record *r)
{
    const json_t *estimates = json_object_get(r->json, "estimates");
    const json_t *causes = json_object_get(r->json, "causes");
    const char *cause = NULL;

    for (int k = 0; k < RITZ_MEASURES; k++) {
        const ritz_measure_kind *kind = &ritz_measure_table[k];
        double bound = kind->bound && kind->label
                           ? record_value(estimates, kind->bound)
                           : nan("");

        if (!(bound <= 1.0))
            continue;
        cause = json_string_value(json_object_get(causes, kind->bound));
        html_print(file, "<li>proven: %s at most %s%s%s</li>", kind->label,
                   chart_say_error(bound).text,
                   cause ? ", far above the error by " : "",
                   cause ? cause : "");
    }
}

/* The measure whose error is the largest fraction of its tolerance; without a
   name if none is known. */
static ritz_measure find_worst(const record *r)
{
    ritz_measure worst = {.value = nan(""), .limit = nan("")};
    const char *name = NULL;
    json_t *limit = NULL;
    double most = -1.0;

    json_object_foreach(r->tolerance, name, limit)
    {
        const double value = record_value(r->errors, name);
        const double allowed = json_number_value(limit);
        const double times = ritz_measure_ratio(name, value, allowed);

        if (isnan(value) || !(times > most))
            continue;
        most = times;
        snprintf(worst.name, sizeof worst.name, "%s", name);
        worst.value = value;
        worst.limit = allowed;
    }
    return worst;
}

/* Name measures without a tolerance that are far worse than the worst one with
   a tolerance. */
static void say_beside(FILE *file, const record *r, const ritz_measure *worst)
{
    const char *name = NULL;
    json_t *value = NULL;

    json_object_foreach(r->errors, name, value)
    {
        if (json_object_get(r->tolerance, name) || !json_is_number(value) ||
            !ritz_measure_is_beside(name, json_number_value(value), worst))
            continue;
        html_print(file,
                   "<li class=\"misses\">not asked for, and more than ten "
                   "times that: %s %s</li>",
                   record_title(name),
                   chart_say_error(record_error(r, name)).text);
    }
}

/* The headline is the worst measure that has a tolerance, if it is relative. */
static void say_headline(FILE *file, const record *r, const measure *first)
{
    const ritz_measure worst = find_worst(r);
    const ritz_measure_kind *kind = ritz_measure_kind_find(worst.name);
    const bool known = kind && !*kind->unit;

    begin_card(
        file, "How wrong",
        chart_say_error(record_error(r, known ? worst.name : first->name))
            .text);
    if (!known)
        return;
    html_print(file, "<li>the worst of what was asked for: %s</li>",
               record_title(worst.name));
    say_beside(file, r, &worst);
}

static void say_errors(FILE *file, const record *r, int64_t count,
                       const measure *m)
{
    say_headline(file, r, m);
    for (int64_t k = 0; k < count; k++) {
        double error = record_error(r, m[k].name);

        if (isnan(error))
            continue;
        html_print(file, "<li>%s: %s", m[k].title, chart_say_error(error).text);
        if (m[k].tolerance > 0.0)
            fprintf(file, ", allowed <span class=\"whole\">%s</span>",
                    chart_say_error(m[k].tolerance).text);
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

    begin_card(file, "How fast",
               chart_say_seconds(simulated ? r->cost : r->cpu).text);
    if (simulated)
        fprintf(file, "<li>for one simulated second, %.0f times real time</li>",
                1.0 / r->cost);
    if (simulated && isfinite(step))
        html_print(file, "<li>step %s%s%s</li>", chart_say_seconds(step).text,
                   by ? ", " : "", by ? by : "");
    if (simulated && isfinite(highest))
        fprintf(file, "<li>highest mode %.4g Hz</li>", highest);
    if (isfinite(r->cpu))
        fprintf(file, "<li>%s%sto make basis and reduction</li>",
                simulated ? chart_say_seconds(r->cpu).text : "",
                simulated ? " " : "");
    end_card(file);
}

static void say_why(FILE *file, const record *r, int64_t count)
{
    const char *text = json_string_value(json_object_get(r->json, "why"));

    if (r->tolerance)
        fprintf(file, "<p class=\"%s\">%s</p>\n",
                r->feasible ? "meets" : "misses",
                r->feasible ? "&#10003; It meets every tolerance."
                            : "&#10007; It misses a tolerance.");
    if (text)
        html_print(file, "<p>Why: %s</p>\n", text);
    if (!r->chosen)
        fprintf(file,
                "<p class=\"note\">No record says which was chosen: this is "
                "the %s.</p>\n",
                r->feasible ? "smallest that meets the tolerance"
                            : "one that comes nearest to its tolerance");
    if (count > 1)
        fprintf(file,
                "<p class=\"note\">One of %ld models that were "
                "measured.</p>\n",
                count);
}

static void put_cards(FILE *file, const record_set *s)
{
    const record *r = find_shown(&s->all);

    if (!r) {
        fprintf(file,
                "<p>%ld model%s measured. No record says which was chosen, "
                "and none has a tolerance that its errors can be held "
                "against.</p>\n",
                s->all.count, s->all.count == 1 ? " was" : "s were");
        return;
    }
    fprintf(file, "<dl class=\"cards\">\n");
    say_method(file, &s->all, r);
    say_size(file, r);
    say_errors(file, r, s->num_measures, s->measure);
    say_cost(file, r);
    fprintf(file, "</dl>\n");
    say_why(file, r, s->all.count);
}

/* --- methods side by side ------------------------------------------------- */

enum { MOST_COLUMNS = 8 };

/* Least order above another; INT64_MAX: none. */
static int64_t next_order(const records *all, int64_t above)
{
    int64_t least = INT64_MAX;

    for (int64_t k = 0; k < all->count; k++)
        if (all->item[k].order > above && all->item[k].order < least)
            least = all->item[k].order;
    return least;
}

/* Up to eight orders, spread over those there are. */
static int64_t pick_orders(const records *all, double out[MOST_COLUMNS])
{
    int64_t n = 0, kept = 0, at = 0;

    for (int64_t o = -1; (o = next_order(all, o)) < INT64_MAX;)
        n++;
    for (int64_t o = -1; (o = next_order(all, o)) < INT64_MAX; at++)
        if (n <= MOST_COLUMNS || at == kept * (n - 1) / (MOST_COLUMNS - 1))
            out[kept++] = (double)o;
    return kept;
}

/* One of a method and a column; less is better. */
typedef struct cell {
    double value; /* NaN: none */
    chart_word text, small;
} cell;

/* A cell of a method: the least error at an order, or the fewest coordinates
   for an error. */
typedef cell (*find_cell)(const record_set *s, int64_t method, double column);

static cell error_at_order(const record_set *s, int64_t method, double order)
{
    cell c = {.value = nan("")};

    for (int64_t k = 0; k < s->all.count; k++) {
        const record *r = &s->all.item[k];
        double error = record_error(r, s->measure->name);

        if (s->which[k] == method && (double)r->order <= order &&
            !r->incomplete && !isnan(error) && !(c.value <= error))
            c.value = error;
    }
    if (c.value < RECORDS_ROUNDING)
        c.value = 0.5 * RECORDS_ROUNDING;
    c.text = chart_say_error(c.value);
    return c;
}

/* With a level of NaN the record has to meet its own tolerance. */
static cell order_at_error(const record_set *s, int64_t method, double level)
{
    const record *best = NULL;
    cell c = {.value = nan("")};

    for (int64_t k = 0; k < s->all.count; k++) {
        const record *r = &s->all.item[k];
        bool good = isnan(level) ? r->feasible && r->tolerance
                                 : record_error(r, s->measure->name) <= level &&
                                       !r->incomplete;

        if (s->which[k] == method && good && (!best || r->order < best->order))
            best = r;
    }
    if (!best)
        return c;
    c.value = (double)best->order;
    snprintf(c.text.text, sizeof c.text, "%ld", best->order);
    const double time = records_cost(&s->all) ? best->cost : best->cpu;

    if (isfinite(time))
        c.small = chart_say_seconds(time);
    return c;
}

/* A row for each method; the best of each column stands in bold. */
static void put_methods(FILE *file, const record_set *s, const char *caption,
                        int64_t count, const double *column, find_cell find)
{
    double best[MOST_COLUMNS];
    char word[32];

    report_table(file, caption);
    fprintf(file, "<tr><th scope=\"col\">method</th>");
    for (int64_t k = 0; k < count; k++) {
        best[k] = HUGE_VAL;
        for (int64_t m = 0; m < s->num_methods; m++)
            best[k] = fmin(best[k], find(s, m, column[k]).value);
        if (find == error_at_order)
            snprintf(word, sizeof word, "%.0f", column[k]);
        else if (isnan(column[k]))
            snprintf(word, sizeof word, "every tolerance");
        else
            snprintf(word, sizeof word, "%s", chart_say_error(column[k]).text);
        html_print(file, "<th scope=\"col\">%s</th>", word);
    }
    fprintf(file, "</tr></thead><tbody>\n");
    for (int64_t m = 0; m < s->num_methods; m++) {
        html_print(file, "<tr><th scope=\"row\">%s</th>", s->method[m]);
        for (int64_t k = 0; k < count; k++) {
            const cell c = find(s, m, column[k]);

            fprintf(file, "<td%s>",
                    c.value <= best[k] ? " class=\"best\"" : "");
            html_print(file, "%s",
                       isnan(c.value) ? "\xe2\x80\x93" : c.text.text);
            if (*c.small.text)
                html_print(file, " <span class=\"small\">%s</span>",
                           c.small.text);
            fprintf(file, "</td>");
        }
        fprintf(file, "</tr>\n");
    }
    fprintf(file, "</tbody></table></div>\n");
}

static void put_tables(FILE *file, const record_set *s)
{
    static const double levels[] = {(double)NAN, 0.1, 1e-2, 1e-3, 1e-4};
    double order[MOST_COLUMNS];
    const int64_t count = pick_orders(&s->all, order);
    bool limits = false;
    char text[PICTURE_WORD];

    for (int64_t k = 0; k < s->all.count; k++)
        limits = limits || s->all.item[k].tolerance;
    fprintf(file, "<h3>At equal order</h3>\n");
    snprintf(text, sizeof text,
             "Least %s with at most this number of coordinates",
             s->measure->title);
    put_methods(file, s, text, count, order, error_at_order);
    fprintf(file, "<h3>At equal error</h3>\n");
    snprintf(text, sizeof text,
             "Fewest coordinates for a %s of at most this value, and %s",
             s->measure->title,
             records_cost(&s->all) ? "time for one simulated second"
                                   : "time to reduce");
    put_methods(file, s, text, limits ? 5 : 4, limits ? levels : levels + 1,
                order_at_error);
    fprintf(file, "<p class=\"note\">The best of each column stands in bold. "
                  "Models that miss a mode of the band do not count.</p>\n");
}

/* --- records -------------------------------------------------------------- */

/* Subjects of records that can be drawn, each once; borrowed names. */
static ritz_status list_subjects(const records *all, int64_t *count,
                                 const char **list)
{
    for (int64_t k = 0; k < all->count; k++) {
        const record *r = &all->item[k];
        int64_t i = 0;

        if (!r->errors || r->order < 0 || !*r->method)
            continue;
        while (i < *count && strcmp(list[i], r->subject) != 0)
            i++;
        if (i == *count)
            list[(*count)++] = r->subject;
    }
    RITZ_REFUSE_IF(*count == 0, RITZ_ERR_ARGUMENT,
                   "no record has a method, an order and errors: those of "
                   "ritz-verify and ritz-fit do");
    return RITZ_OK;
}

/* A figure for each of the first four measures, as narrow pages need it. */
static ritz_status put_errors(report_page *p, const record_set *s,
                              chart_draw *draw, chart_request request)
{
    char text[200];

    for (int64_t k = 0; k < s->num_measures && k < 4; k++) {
        if (k > 0 && !records_matter(&s->all, &s->measure[k]))
            continue;
        request.measure = (cli_list){.count = 1, .text = {s->measure[k].name}};
        snprintf(text, sizeof text, "%.60s against %s, every method",
                 s->measure[k].title, draw == chart_pareto ? "time" : "order");
        RITZ_CHECK(report_figure(p, draw, p->sources, &request, text));
    }
    return RITZ_OK;
}

/*
 * Figures of errors against time; and against what simulators pay, where it is
 * known of some models but not of all: of others it is not worth measuring.
 */
static ritz_status put_times(report_page *p, const record_set *s, bool costs,
                             chart_request request)
{
    chart_request simulate = request;

    fprintf(p->body.file,
            "<p>Left and low is better. Nothing beats what lies on the "
            "grey stairs. Level lines are lines of equal error, which is "
            "said at their right ends: the red one is the tolerance, and "
            "below the dashed one models are themselves less certain than "
            "their reductions. Numbers beside the stairs are orders.</p>\n");
    simulate.measure = (cli_list){.count = 1, .text = {s->measure[0].name}};
    simulate.against = "simulate";
    if (costs && !records_cost(&p->sources->runs))
        RITZ_CHECK(report_figure(p, chart_pareto, p->sources, &simulate,
                                 "what simulating costs, of the models where "
                                 "that was measured"));
    return put_errors(p, s, chart_pareto, request);
}

/* Charts and tables of one subject; its name, if there are several. */
static ritz_status put_charts(report_page *p, const record_set *s,
                              const char *subject, const char *name)
{
    chart_request request = *p->request;
    bool times = false, costs = false;

    request.subject = subject;
    for (int64_t k = 0; k < s->all.count; k++) {
        times = times || isfinite(s->all.item[k].cpu);
        costs = costs || isfinite(s->all.item[k].cost);
    }
    if (times || costs) {
        report_begin(p, "Speed against accuracy", name);
        RITZ_CHECK(put_times(p, s, costs, request));
        RITZ_CHECK(report_end(p));
    }
    report_begin(p, "Convergence", name);
    RITZ_CHECK(put_errors(p, s, chart_convergence, request));
    RITZ_CHECK(report_end(p));
    report_begin(p, "Methods side by side", name);
    put_tables(p->body.file, s);
    return report_end(p);
}

ritz_status report_records(report_page *p)
{
    const records *all = &p->sources->runs;
    RITZ_OWN_ARRAY const char **subject = NULL;
    int64_t count = 0;

    if (all->count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(subject, all->count); /* NOLINT: of pointers */
    RITZ_CHECK(list_subjects(all, &count, subject));
    /* verdicts of all subjects come first */
    for (int64_t k = 0; k < 2 * count; k++) {
        const char *of = subject[k % count];
        RITZ_OWN(record_set) s = {0};

        RITZ_CHECK(record_set_new(all, of, &s));
        if (k >= count) {
            RITZ_CHECK(put_charts(p, &s, of, count > 1 ? of : ""));
            continue;
        }
        html_print(p->body.file,
                   "<section aria-labelledby=\"v%ld\">\n"
                   "<h2 id=\"v%ld\">%s</h2>\n",
                   k, k, *of ? of : "What was found");
        put_cards(p->body.file, &s);
        fprintf(p->body.file, "</section>\n");
    }
    return RITZ_OK;
}
