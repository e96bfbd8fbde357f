/* Sections of the page that records make: verdicts, charts, tables. */
#include "chart/report_parts.h"

#include "chart/html.h"

#include <math.h>
#include <stdlib.h>

/* One figure for each measure, as narrow pages need it. */
static ritz_status put_errors(report_page *p, const records *all,
                              const char *subject, const chart_kind *kind,
                              const char *caption)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;
    measure *m = NULL;
    chart_wish wish = report_wish(p);
    char text[200];

    RITZ_TRY(records_measures(all, &count, &m));
    count = count < 4 ? count : 4;
    for (int64_t k = 0; k < count; k++) {
        wish.subject = subject;
        wish.measure = (cli_list){.count = 1, .text = {m[k].name}};
        if (k > 0 && !records_matter(all, &m[k]))
            continue;
        snprintf(text, sizeof text, "%.60s %.120s", m[k].title, caption);
        RITZ_TRY(report_figure(p, p->sources, &wish, kind->draw, text));
    }
done:
    free(m);
    return status;
}

/* What simulators pay, where it is known of some: of others it is not worth
 * measuring. */
static ritz_status put_costs(report_page *p, const records *all,
                             const char *subject)
{
    ritz_status status = RITZ_OK;
    chart_wish wish = report_wish(p);
    measure *m = NULL;
    int64_t count = 0;
    bool any = false;

    for (int64_t k = 0; k < all->count; k++)
        any = any || isfinite(all->item[k].cost);
    if (!any || records_cost(&p->sources->runs))
        return RITZ_OK;
    RITZ_TRY(records_measures(all, &count, &m));
    wish.subject = subject;
    wish.against = "simulate";
    wish.measure = (cli_list){.count = 1, .text = {m->name}};
    RITZ_TRY(
        report_figure(p, p->sources, &wish, report_kind("pareto")->draw,
                      "what simulating costs, of the models where that was "
                      "measured"));
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

/* All that records of one subject say. */
static ritz_status put_subject(report_page *p, const char *subject, bool many)
{
    ritz_status status = RITZ_OK;
    const char *of = many && *subject ? ": " : "";
    const char *name = many ? subject : "";
    records all = {0};
    char title[200];

    RITZ_TRY(records_select(&p->sources->runs, subject, &all));
    if (knows_cost(&all)) {
        snprintf(title, sizeof title, "Speed against accuracy%s%.100s", of,
                 name);
        report_begin(p, title);
        fprintf(p->body.file,
                "<p>Left and low is better. Nothing beats what lies on the "
                "grey stairs. Level lines are lines of equal error, which is "
                "said at their right ends: the red one is the tolerance, and "
                "below the dashed one models are themselves less certain than "
                "their reductions. Numbers beside points are orders.</p>\n");
        fprintf(p->body.file, "<div class=\"figures\">\n");
        RITZ_TRY(put_costs(p, &all, subject));
        RITZ_TRY(put_errors(p, &all, subject, report_kind("pareto"),
                            "against time, every method"));
        fprintf(p->body.file, "</div>\n");
        report_end(p);
    }
    snprintf(title, sizeof title, "Convergence%s%.100s", of, name);
    report_begin(p, title);
    fprintf(p->body.file, "<div class=\"figures\">\n");
    RITZ_TRY(put_errors(p, &all, subject, report_kind("convergence"),
                        "against order, every method"));
    fprintf(p->body.file, "</div>\n");
    report_end(p);
    snprintf(title, sizeof title, "Methods side by side%s%.100s", of, name);
    report_begin(p, title);
    RITZ_TRY(report_tables(p->body.file, &all));
    report_end(p);
done:
    free(all.item);
    return status;
}

static ritz_status put_verdicts(report_page *p, int64_t count,
                                const char *const *subject)
{
    ritz_status status = RITZ_OK;
    records all = {0};

    for (int64_t k = 0; k < count; k++) {
        RITZ_TRY(records_select(&p->sources->runs, subject[k], &all));
        fprintf(p->body.file,
                "<section aria-labelledby=\"v%lld\">\n"
                "<h2 id=\"v%lld\">",
                (long long)k, (long long)k);
        html_text(p->body.file, *subject[k] ? subject[k] : "What was found");
        fprintf(p->body.file, "</h2>\n");
        RITZ_TRY(report_verdict(p->body.file, &all));
        report_end(p);
        free(all.item);
        all = (records){0};
    }
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
    RITZ_TRY(report_subjects(&p->sources->runs, &count, &subject));
    RITZ_TRY(put_verdicts(p, count, subject));
    for (int64_t k = 0; k < count; k++)
        RITZ_TRY(put_subject(p, subject[k], count > 1));
done:
    free(subject);
    return status;
}
