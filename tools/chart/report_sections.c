/* Sections of the page: figures with one legend for each section. */
#include "chart/report.h"

#include "base/alloc.h"

#include <ritz/verify.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

void report_begin(report_page *p, const char *words, const char *name)
{
    const int64_t k = ++p->num_sections;
    char title[200];

    snprintf(title, sizeof title, "%s%s%.100s", words, *name ? ": " : "", name);
    p->num_signs = 0;
    html_print(p->links.file, "<li><a href=\"#s%ld\">%s</a></li>\n", k, title);
    html_print(p->body.file,
               "<section aria-labelledby=\"s%ld\">\n<h2 id=\"s%ld\">%s</h2>"
               "\n",
               k, k, title);
}

static bool look_alike(const picture_sign *a, const picture_sign *b)
{
    return a->mark == b->mark && a->dash == b->dash && a->wide == b->wide &&
           strcmp(a->colour, b->colour) == 0 && !a->role == !b->role &&
           (!a->role || strcmp(a->role, b->role) == 0);
}

/* Signs that look alike have one row with the names of all. */
static void add_signs(report_page *p, const picture *from)
{
    for (int k = 0; k < from->num_signs; k++) {
        const picture_sign *s = &from->sign[k];
        picture_sign *own = p->sign;
        const picture_sign *end = p->sign + p->num_signs;

        while (own < end && !look_alike(own, s))
            own++;
        if (own == end && p->num_signs < PICTURE_SIGNS)
            p->sign[p->num_signs++] = *s;
        else if (own < end && !strstr(own->name, s->name))
            sink_append(own->name, sizeof own->name, ", %s", s->name);
    }
}

void report_table(FILE *file, const char *caption)
{
    html_print(file,
               "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
               "aria-label=\"%s\"><table><caption>%s</caption>\n<thead>",
               caption, caption);
}

/* Draw a sign of the legend: a line, or a mark by its number in gnuplot, where
   hollow ones are even and filled ones odd. */
static void put_sign(FILE *file, const picture_sign *s)
{
    static const char *const shapes[] = {
        "M10 3h8v8h-8z", "M9 7a5 5 0 1 0 10 0a5 5 0 1 0-10 0z",
        "M14 2l5.5 9h-11z", "M14 12l5.5-9h-11z",
        "M14 1.5l5.5 5.5l-5.5 5.5l-5.5-5.5z"};
    static const char *const dashes[] = {"none", "none", "7 4", "2 3",
                                         "7 3 2 3"};
    const int shape = (s->mark - 4) / 2;

    fprintf(file, "<li><svg class=\"sign\" viewBox=\"0 0 28 14\" "
                  "aria-hidden=\"true\">");
    if (s->mark >= 4 && shape < 5)
        fprintf(file,
                "<path d=\"%s\" fill=\"%s%s%s\" stroke=\"var(--%s)\" "
                "stroke-width=\"1.6\"/>",
                shapes[shape], s->mark % 2 ? "var(--" : "none",
                s->mark % 2 ? s->colour : "", s->mark % 2 ? ")" : "",
                s->colour);
    else
        fprintf(file,
                "<path d=\"M1 7H27\" stroke=\"var(--%s)\" stroke-width=\"%g\" "
                "stroke-dasharray=\"%s\"/>",
                s->colour, s->wide, dashes[s->dash % 5]);
    html_print(file, "</svg>%s%s%s</li>\n", s->name, s->role ? ": " : "",
               s->role ? s->role : "");
}

ritz_status report_end(report_page *p)
{
    FILE *file = p->body.file;

    RITZ_CHECK(cli_table_end(&p->figures));
    if (p->num_signs > 0)
        fprintf(file, "<ul class=\"legend\">\n");
    for (int k = 0; k < p->num_signs; k++)
        put_sign(file, &p->sign[k]);
    if (p->num_signs > 0)
        fprintf(file, "</ul>\n");
    if (p->figures.size > 0)
        fprintf(file, "<div class=\"figures\">\n%s</div>\n", p->figures.text);
    fprintf(file, "</section>\n");
    cli_table_free(&p->figures);
    return cli_table_new(&p->figures);
}

/* Turn a table with tabs, names of columns first, into one of markup. */
static void put_table(FILE *file, const char *text, const char *caption)
{
    bool head = true;

    fprintf(file, "<details><summary>The same as a table</summary>\n");
    report_table(file, caption);
    fprintf(file, "<tr>");
    for (const char *c = text; *c; c++) {
        const size_t length = strcspn(c, "\t\n");
        char *word = strndup(c, length);

        html_print(file, head ? "<th scope=\"col\">%s</th>" : "<td>%s</td>",
                   word ? word : "");
        free(word);
        c += length;
        if (*c != '\n')
            continue;
        fprintf(file, head ? "</tr></thead><tbody>\n" : "</tr>\n");
        fputs(c[1] ? "<tr>" : "", file);
        head = false;
    }
    fprintf(file, "</tbody></table></div>\n</details>\n");
}

ritz_status report_figure(report_page *p, chart_draw *draw,
                          const chart_sources *sources,
                          const chart_request *request, const char *caption)
{
    FILE *file = p->figures.file;
    RITZ_OWN(picture) drawn = {0};
    char prefix[32];

    RITZ_CHECK(picture_new(request->path, false, &drawn));
    RITZ_CHECK(draw(sources, request, &drawn));
    RITZ_CHECK(cli_table_end(&drawn.table));
    add_signs(p, &drawn);
    snprintf(prefix, sizeof prefix, "p%ld-", ++p->num_pictures);
    fprintf(file, "<figure%s>\n<div class=\"scroll\">\n",
            drawn.wide > PICTURE_WIDE ? " class=\"whole\"" : "");
    svg_copy(file, drawn.drawn.text, drawn.title, drawn.summary, prefix);
    html_print(file, "</div>\n<figcaption>%s%s%s</figcaption>\n", caption,
               *drawn.note ? ". " : "", drawn.note);
    put_table(file, drawn.table.text, caption);
    fprintf(file, "</figure>\n");
    return RITZ_OK;
}
