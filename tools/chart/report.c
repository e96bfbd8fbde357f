#include "chart/report.h"

#include "chart/html.h"
#include "chart/report_page.h"
#include "chart/report_parts.h"

#include <ritz/version.h>

#include <string.h>

void report_begin(report_page *p, const char *title)
{
    p->num_sections++;
    fprintf(p->links.file, "<li><a href=\"#s%lld\">",
            (long long)p->num_sections);
    html_text(p->links.file, title);
    fprintf(p->links.file, "</a></li>\n");
    fprintf(p->body.file,
            "<section aria-labelledby=\"s%lld\">\n<h2 id=\"s%lld\">",
            (long long)p->num_sections, (long long)p->num_sections);
    html_text(p->body.file, title);
    fprintf(p->body.file, "</h2>\n");
}

void report_end(report_page *p)
{
    fprintf(p->body.file, "</section>\n");
}

/* What was read, and by which commands it was made. */
static void put_provenance(report_page *p)
{
    const cli_run *run = p->sources->run;
    const records *all = &p->sources->runs;
    const char *last = "";
    FILE *file = p->body.file;

    report_begin(p, "How this was made");
    fprintf(file, "<p><code>");
    html_text(file, run->command);
    fprintf(file, "</code>, Ritz %s</p>\n<h3>Inputs</h3>\n<ul>\n",
            ritz_version());
    for (int64_t k = 0; k < run->num_inputs; k++) {
        fprintf(file, "<li><code>");
        html_text(file, run->input[k]);
        fprintf(file, "</code></li>\n");
    }
    fprintf(file, "</ul>\n");
    if (all->count > 0)
        fprintf(file, "<details><summary>Commands of the "
                      "records</summary>\n<ul>\n");
    for (int64_t k = 0; k < all->count; k++) {
        const char *command =
            json_string_value(json_object_get(all->item[k].json, "command"));

        if (!command || strcmp(command, last) == 0)
            continue;
        last = command;
        fprintf(file, "<li><code>");
        html_text(file, command);
        fprintf(file, "</code></li>\n");
    }
    if (all->count > 0)
        fprintf(file, "</ul>\n</details>\n");
    report_end(p);
}

static void put_lines(FILE *file, const char *const *lines)
{
    for (int64_t k = 0; lines[k]; k++)
        fputs(lines[k], file);
}

/* What names the page: whose records it shows, or what it is. */
static void put_title(FILE *file, const chart_sources *sources)
{
    const char *subject = NULL;

    for (int64_t k = 0; k < sources->runs.count && !subject; k++)
        if (sources->runs.item[k].errors && *sources->runs.item[k].subject)
            subject = sources->runs.item[k].subject;
    if (subject) {
        html_text(file, subject);
        fprintf(file, ": ");
    }
    fprintf(file, "how small, how fast, how wrong");
}

/* Nothing is fetched, and nothing runs but the style and script below. */
static void put_head(FILE *file, const chart_sources *sources)
{
    char style[64], script[64];

    report_hash(report_style, style);
    report_hash(report_script, script);
    fprintf(file,
            "<!doctype html>\n<html lang=\"en\">\n<head>\n"
            "<meta charset=\"utf-8\">\n<meta "
            "http-equiv=\"Content-Security-Policy\" content=\"default-src "
            "'none'; style-src '%s'; script-src '%s'; base-uri 'none'; "
            "form-action 'none'\">\n<meta name=\"viewport\" "
            "content=\"width=device-width, initial-scale=1\">\n"
            "<meta name=\"referrer\" content=\"no-referrer\">\n"
            "<meta name=\"generator\" content=\"Ritz %s\">\n<title>",
            style, script, ritz_version());
    put_title(file, sources);
    fprintf(file, "</title>\n<style>");
    put_lines(file, report_style);
    fprintf(file, "</style>\n</head>\n");
}

static ritz_status put_page(FILE *file, report_page *p)
{
    RITZ_REFUSE_IF(fflush(p->body.file) != 0 || fflush(p->links.file) != 0,
                   RITZ_ERR_MEMORY, "no memory for the page");
    put_head(file, p->sources);
    fprintf(file, "<body>\n<a class=\"skip\" href=\"#main\">Skip to what was "
                  "found</a>\n<header>\n<div class=\"top\">\n<h1>");
    put_title(file, p->sources);
    fprintf(file,
            "</h1>\n<button id=\"theme\" type=\"button\" hidden>Dark "
            "page</button>\n</div>\n<nav aria-label=\"Contents\"><ul>\n%s</ul>"
            "</nav>\n</header>\n<main id=\"main\" tabindex=\"-1\">\n%s</main>\n"
            "<div id=\"tip\" hidden aria-hidden=\"true\"></div>\n<script>",
            p->links.text, p->body.text);
    put_lines(file, report_script);
    fprintf(file, "</script>\n</body>\n</html>\n");
    return RITZ_OK;
}

ritz_status report_write(const chart_sources *sources, const chart_wish *wish)
{
    ritz_status status = RITZ_OK;
    report_page p = {.sources = sources, .wish = wish};
    cli_table whole = {0};
    const size_t length = strlen(wish->path);

    RITZ_FAIL_IF(length >= 4 && strcmp(wish->path + length - 4, ".svg") == 0,
                 RITZ_ERR_ARGUMENT,
                 "a report is a page, no picture: -o NAME.html");
    RITZ_TRY(cli_table_new(&p.body));
    RITZ_TRY(cli_table_new(&p.links));
    RITZ_TRY(cli_table_new(&whole));
    RITZ_TRY(report_records(&p));
    RITZ_TRY(report_pictures(&p));
    RITZ_FAIL_IF(p.num_pictures == 0, RITZ_ERR_ARGUMENT,
                 "there is nothing to draw in these files");
    put_provenance(&p);
    RITZ_TRY(put_page(whole.file, &p));
    RITZ_TRY(cli_table_save(&whole, wish->path));
done:
    cli_table_free(&p.body);
    cli_table_free(&p.links);
    cli_table_free(&whole);
    return status;
}
