/* Sections of the page that records make: verdicts, charts, tables. */
#include "chart/html.h"
#include "chart/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Subjects of records that can be drawn, each once; borrowed names. */
static ritz_status list_subjects(const records *all, int64_t *count,
                                 const char ***out)
{
    const char **list = calloc((size_t)all->count + 1, sizeof *list);
    int64_t n = 0;

    RITZ_REFUSE_IF(!list, RITZ_ERR_MEMORY, "no memory for records");
    *out = list;
    for (int64_t k = 0; k < all->count; k++) {
        const record *r = &all->item[k];
        int64_t i = 0;

        if (!r->errors || r->order < 0 || !*r->method)
            continue;
        while (i < n && strcmp(list[i], r->subject) != 0)
            i++;
        if (i == n)
            list[n++] = r->subject;
    }
    RITZ_REFUSE_IF(n == 0, RITZ_ERR_ARGUMENT,
                   "no record has a method, an order and errors: those of "
                   "ritz-verify and ritz-fit do");
    *count = n;
    return RITZ_OK;
}

/*
 * A figure for each of the first four measures, as narrow pages need it; and
 * what simulators pay, where it is known of some models but not of all: of
 * others it is not worth measuring.
 */
static ritz_status put_errors(report_page *p, const selection *s,
                              const char *kind, chart_wish wish)
{
    const bool times = strcmp(kind, "pareto") == 0;
    bool some = false;
    char text[200];

    for (int64_t k = 0; k < s->all.count; k++)
        some = some || isfinite(s->all.item[k].cost);
    wish.measure = (cli_list){.count = 1, .text = {s->measure[0].name}};
    if (times && some && !records_cost(&p->sources->runs)) {
        chart_wish costs = wish;

        costs.against = "simulate";
        RITZ_CHECK(report_figure(p, kind, p->sources, &costs,
                                 "what simulating costs, of the models where "
                                 "that was measured"));
    }
    for (int64_t k = 0; k < s->num_measures && k < 4; k++) {
        if (k > 0 && !records_matter(&s->all, &s->measure[k]))
            continue;
        wish.measure.text[0] = s->measure[k].name;
        snprintf(text, sizeof text, "%.60s against %s, every method",
                 s->measure[k].title, times ? "time" : "order");
        RITZ_CHECK(report_figure(p, kind, p->sources, &wish, text));
    }
    return RITZ_OK;
}

static bool knows_cost(const records *all)
{
    for (int64_t k = 0; k < all->count; k++)
        if (isfinite(all->item[k].cpu) || isfinite(all->item[k].cost))
            return true;
    return false;
}

/* A section whose title says the subject, if there are several. */
static void begin_section(report_page *p, const char *title, const char *name)
{
    char text[200];

    snprintf(text, sizeof text, "%s%s%.100s", title, *name ? ": " : "", name);
    report_begin(p, text);
}

/* Charts and tables of one subject; its name, if there are several. */
static ritz_status put_charts(report_page *p, const selection *s,
                              const char *subject, const char *name)
{
    chart_wish wish = *p->wish;

    wish.subject = subject;
    if (knows_cost(&s->all)) {
        begin_section(p, "Speed against accuracy", name);
        fprintf(p->body.file,
                "<p>Left and low is better. Nothing beats what lies on the "
                "grey stairs. Level lines are lines of equal error, which is "
                "said at their right ends: the red one is the tolerance, and "
                "below the dashed one models are themselves less certain than "
                "their reductions. Numbers beside the stairs are orders.</p>"
                "\n");
        RITZ_CHECK(put_errors(p, s, "pareto", wish));
        RITZ_CHECK(report_end(p));
    }
    begin_section(p, "Convergence", name);
    RITZ_CHECK(put_errors(p, s, "convergence", wish));
    RITZ_CHECK(report_end(p));
    begin_section(p, "Methods side by side", name);
    report_tables(p->body.file, s);
    return report_end(p);
}

static void put_verdict(report_page *p, const selection *s, const char *subject,
                        long long number)
{
    html_print(p->body.file,
               "<section aria-labelledby=\"v%lld\">\n<h2 id=\"v%lld\">%s</h2>"
               "\n",
               number, number, *subject ? subject : "What was found");
    report_verdict(p->body.file, s);
    fprintf(p->body.file, "</section>\n");
}

ritz_status report_records(report_page *p)
{
    ritz_status status = RITZ_OK;
    const char **subject = NULL;
    selection s = {0};
    int64_t count = 0;

    if (p->sources->runs.count == 0)
        return RITZ_OK;
    RITZ_TRY(list_subjects(&p->sources->runs, &count, &subject));
    /* verdicts of all subjects come first */
    for (int64_t k = 0; k < 2 * count; k++) {
        const char *of = subject[k % count];

        RITZ_TRY(selection_new(&p->sources->runs, of, &s));
        if (k < count)
            put_verdict(p, &s, of, k);
        else
            RITZ_TRY(put_charts(p, &s, of, count > 1 ? of : ""));
        selection_free(&s);
    }
done:
    selection_free(&s);
    free(subject);
    return status;
}
