/* Sections of the page: of records, then of all other files. */
#include "report_parts.h"

#include "html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Draw, and put picture, caption and data down. */
static ritz_status put_figure(
    report_page *p, const chart_sources *sources, const chart_wish *wish,
    ritz_status (*draw)(const chart_sources *, const chart_wish *, gnuplot *),
    const char *caption)
{
    ritz_status status = RITZ_OK;
    FILE *file = p->body.file;
    gnuplot picture = {0};
    char prefix[32];

    RITZ_TRY(draw(sources, wish, &picture));
    snprintf(prefix, sizeof prefix, "p%lld-", (long long)++p->num_pictures);
    fprintf(file, "<figure>\n<div class=\"scroll\">\n");
    svg_embed(file, picture.svg, prefix);
    fprintf(file, "</div>\n<figcaption>");
    html_text(file, caption);
    fprintf(file, "</figcaption>\n");
    RITZ_FAIL_IF(fflush(picture.table.file) != 0, RITZ_ERR_MEMORY,
                 "no memory for a table");
    if (picture.table.size > 0) {
        fprintf(file, "<details><summary>The same as a table</summary>\n");
        report_table(file, picture.table.text, caption);
        fprintf(file, "</details>\n");
    }
    fprintf(file, "</figure>\n");
done:
    gnuplot_free(&picture);
    return status;
}

static chart_wish wish_of(const report_page *p)
{
    chart_wish wish = *p->wish;

    wish.keep = false;
    return wish;
}

/* One figure for each measure, as narrow pages need it. */
static ritz_status put_errors(report_page *p, const records *all,
                              const char *subject, const chart_kind *kind,
                              const char *caption)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;
    measure *m = NULL;
    chart_wish wish = wish_of(p);
    char text[200];

    RITZ_TRY(records_measures(all, &count, &m));
    count = count < 4 ? count : 4;
    for (int64_t k = 0; k < count; k++) {
        wish.subject = subject;
        wish.measure = (cli_list){.count = 1, .text = {m[k].name}};
        if (k > 0 && !records_matter(all, &m[k]))
            continue;
        snprintf(text, sizeof text, "%.60s %.120s", m[k].title, caption);
        RITZ_TRY(put_figure(p, p->sources, &wish, kind->draw, text));
    }
done:
    free(m);
    return status;
}

static const chart_kind *kind_of(const char *name)
{
    const chart_kind *kind = chart_kinds;

    while (strcmp(kind->name, name) != 0)
        kind++;
    return kind;
}

/* What simulators pay, where it is known of some: of others it is not worth
 * measuring. */
static ritz_status put_costs(report_page *p, const records *all,
                             const char *subject)
{
    ritz_status status = RITZ_OK;
    chart_wish wish = wish_of(p);
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
    RITZ_TRY(put_figure(p, p->sources, &wish, kind_of("pareto")->draw,
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
                "grey line. Numbers beside points are orders.</p>\n");
        fprintf(p->body.file, "<div class=\"figures\">\n");
        RITZ_TRY(put_costs(p, &all, subject));
        RITZ_TRY(put_errors(p, &all, subject, kind_of("pareto"),
                            "against time, every method"));
        fprintf(p->body.file, "</div>\n");
        report_end(p);
    }
    snprintf(title, sizeof title, "Convergence%s%.100s", of, name);
    report_begin(p, title);
    fprintf(p->body.file, "<div class=\"figures\">\n");
    RITZ_TRY(put_errors(p, &all, subject, kind_of("convergence"),
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

static const char *base_of(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

/* Those of the files that belong into one picture. */
typedef bool (*belongs)(const chart_file *first, const chart_file *other);

static bool same_points(const chart_file *first, const chart_file *other)
{
    const ritz_response *a = &first->model.response;
    const ritz_response *b = &other->model.response;

    return a->num_inputs == b->num_inputs && a->num_outputs == b->num_outputs &&
           a->count == b->count &&
           memcmp(a->hertz, b->hertz, (size_t)a->count * sizeof *a->hertz) == 0;
}

static bool same_outputs(const chart_file *first, const chart_file *other)
{
    const ritz_simulation *a = &first->model.simulation;
    const ritz_simulation *b = &other->model.simulation;

    return a->num_outputs == b->num_outputs &&
           memcmp(a->output, b->output,
                  (size_t)a->num_outputs * sizeof *a->output) == 0;
}

static bool any_other(const chart_file *first, const chart_file *other)
{
    (void)first;
    (void)other;
    return true;
}

static bool no_other(const chart_file *first, const chart_file *other)
{
    return first == other;
}

/* The files that `first` begins, and are not taken; they then are. */
static int64_t gather(const report_page *p, int64_t first, belongs same,
                      bool *taken, chart_file *out)
{
    const chart_file *file = p->sources->file;
    int64_t count = 0;

    for (int64_t k = first; k < p->sources->count; k++) {
        if (taken[k] || file[k].holds != file[first].holds ||
            !same(&file[first], &file[k]))
            continue;
        if (file[first].holds == CHART_MODES && count == 2)
            break;
        taken[k] = true;
        out[count++] = file[k];
    }
    return count;
}

static const struct part {
    int holds;
    const char *kind, *title;
    belongs same;
    int64_t least; /* files of a picture */
} parts[] = {
    {CHART_RANKING, "hankel", "Which modes matter", any_other, 1},
    {CHART_RESPONSE, "response", "Frequency responses", same_points, 1},
    {CHART_SIMULATION, "simulation", "Time responses", same_outputs, 1},
    {CHART_MODES, "mac", "Mode shapes", any_other, 2},
    {CHART_TRACKS, "tracks", "Modes over configurations", no_other, 1},
};

static void name_files(int64_t count, const chart_file *file, size_t size,
                       char *out)
{
    size_t used = 0;

    for (int64_t k = 0; k < count && used < size; k++)
        used += (size_t)snprintf(out + used, size - used, "%s%.60s",
                                 k > 0 ? ", " : "", base_of(file[k].path));
}

/* A section of pictures of one kind, if there are files for it. */
static ritz_status put_part(report_page *p, const struct part *part,
                            bool *taken, chart_file *room)
{
    ritz_status status = RITZ_OK;
    chart_wish wish = wish_of(p);
    bool begun = false;
    char caption[400];

    for (int64_t k = 0; k < p->sources->count; k++) {
        chart_sources some = *p->sources;

        if (taken[k] || p->sources->file[k].holds != part->holds)
            continue;
        some.file = room;
        some.count = gather(p, k, part->same, taken, room);
        if (some.count < part->least)
            continue;
        if (!begun) {
            report_begin(p, part->title);
            fprintf(p->body.file, "<div class=\"figures\">\n");
        }
        begun = true;
        name_files(some.count, room, sizeof caption, caption);
        RITZ_TRY(
            put_figure(p, &some, &wish, kind_of(part->kind)->draw, caption));
    }
    if (begun) {
        fprintf(p->body.file, "</div>\n");
        report_end(p);
    }
done:
    return status;
}

ritz_status report_pictures(report_page *p)
{
    ritz_status status = RITZ_OK;
    size_t count = (size_t)p->sources->count + 1;
    bool *taken = calloc(count, sizeof *taken);
    chart_file *room = calloc(count, sizeof *room);

    RITZ_FAIL_IF(!taken || !room, RITZ_ERR_MEMORY, "no memory for files");
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        RITZ_TRY(put_part(p, &parts[k], taken, room));
done:
    free(taken);
    free(room);
    return status;
}
