/* One picture on the page: its name, its caption and its numbers. */
#include "chart/report_parts.h"

#include "chart/html.h"

#include <string.h>

ritz_status report_figure(report_page *p, const chart_sources *sources,
                          const chart_wish *wish,
                          ritz_status (*draw)(const chart_sources *,
                                              const chart_wish *, gnuplot *),
                          const char *caption)
{
    ritz_status status = RITZ_OK;
    FILE *file = p->body.file;
    gnuplot picture = {0};
    char prefix[32];

    RITZ_TRY(draw(sources, wish, &picture));
    snprintf(prefix, sizeof prefix, "p%lld-", (long long)++p->num_pictures);
    fprintf(file, "<figure%s>\n<div class=\"scroll\">\n",
            picture.wide > SVG_WIDE ? " class=\"whole\"" : "");
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

chart_wish report_wish(const report_page *p)
{
    chart_wish wish = *p->wish;

    wish.keep = false;
    return wish;
}

const chart_kind *report_kind(const char *name)
{
    const chart_kind *kind = chart_kinds;

    while (strcmp(kind->name, name) != 0)
        kind++;
    return kind;
}
