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
static ritz_status put_errors(report_page *p, const records *all,
                              const char *kind, chart_wish wish)
{
    ritz_status status = RITZ_OK;
    const bool times = strcmp(kind, "pareto") == 0;
    int64_t count = 0;
    measure *m = NULL;
    bool some = false;
    char text[200];

    RITZ_TRY(records_measures(all, &count, &m));
    for (int64_t k = 0; k < all->count; k++)
        some = some || isfinite(all->item[k].cost);
    wish.measure = (cli_list){.count = 1, .text = {m->name}};
    if (times && some && !records_cost(&p->sources->runs)) {
        chart_wish costs = wish;

        costs.against = "simulate";
        RITZ_TRY(report_figure(p, kind, p->sources, &costs,
                               "what simulating costs, of the models where "
                               "that was measured"));
    }
    for (int64_t k = 0; k < count && k < 4; k++) {
        if (k > 0 && !records_matter(all, &m[k]))
            continue;
        wish.measure.text[0] = m[k].name;
        snprintf(text, sizeof text, "%.60s against %s, every method",
                 m[k].title, times ? "time" : "order");
        RITZ_TRY(report_figure(p, kind, p->sources, &wish, text));
    }
done:
    free(m);
    return status;
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

/* All that records of one subject say; its name, if there are several. */
static ritz_status put_subject(report_page *p, const char *subject,
                               const char *name)
{
    ritz_status status = RITZ_OK;
    chart_wish wish = *p->wish;
    records all = {0};

    wish.subject = subject;
    RITZ_TRY(records_select(&p->sources->runs, subject, &all));
    if (knows_cost(&all)) {
        begin_section(p, "Speed against accuracy", name);
        fprintf(p->body.file,
                "<p>Left and low is better. Nothing beats what lies on the "
                "grey stairs. Level lines are lines of equal error, which is "
                "said at their right ends: the red one is the tolerance, and "
                "below the dashed one models are themselves less certain than "
                "their reductions. Numbers beside the stairs are orders.</p>"
                "\n");
        RITZ_TRY(put_errors(p, &all, "pareto", wish));
        RITZ_TRY(report_end(p));
    }
    begin_section(p, "Convergence", name);
    RITZ_TRY(put_errors(p, &all, "convergence", wish));
    RITZ_TRY(report_end(p));
    begin_section(p, "Methods side by side", name);
    RITZ_TRY(report_tables(p->body.file, &all));
    RITZ_TRY(report_end(p));
done:
    free(all.item);
    return status;
}

static ritz_status put_verdict(report_page *p, const char *subject,
                               long long number)
{
    ritz_status status = RITZ_OK;
    records all = {0};

    RITZ_TRY(records_select(&p->sources->runs, subject, &all));
    html_print(p->body.file,
               "<section aria-labelledby=\"v%lld\">\n<h2 id=\"v%lld\">%s</h2>"
               "\n",
               number, number, *subject ? subject : "What was found");
    RITZ_TRY(report_verdict(p->body.file, &all));
    fprintf(p->body.file, "</section>\n");
done:
    free(all.item);
    return status;
}

ritz_status report_records(report_page *p)
{
    ritz_status status = RITZ_OK;
    const char **subject = NULL;
    int64_t count = 0;

    if (p->sources->runs.count == 0)
        return RITZ_OK;
    RITZ_TRY(list_subjects(&p->sources->runs, &count, &subject));
    for (int64_t k = 0; k < count; k++)
        RITZ_TRY(put_verdict(p, subject[k], k));
    for (int64_t k = 0; k < count; k++)
        RITZ_TRY(put_subject(p, subject[k], count > 1 ? subject[k] : ""));
done:
    free(subject);
    return status;
}
