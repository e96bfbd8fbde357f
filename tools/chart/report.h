/* One page of everything: a verdict, charts, tables, provenance. */
#ifndef RITZ_TOOLS_CHART_REPORT_H
#define RITZ_TOOLS_CHART_REPORT_H

#include "chart/chart.h"

/* The page in the making. */
typedef struct report_page {
    const chart_sources *sources;
    const chart_request *request;
    cli_table title, links, body; /* links of the contents; sections */
    cli_table figures;            /* of the section in the making */
    cli_table whole;
    int64_t num_pictures, num_sections;
    int num_signs; /* of its legend */
    picture_sign sign[PICTURE_SIGNS];
} report_page;

/**
 * Write the page. Charts are drawn for what the files hold.
 *
 * @param[in] request  path of the page; choices of charts
 */
ritz_status report_write(const chart_sources *sources,
                         const chart_request *request);

/** A section, which the contents name by these words and, unless it is "", by a
 * name. */
void report_begin(report_page *p, const char *words, const char *name);

/** Its end: one legend of all its pictures, then these. */
ritz_status report_end(report_page *p);

/** Begin a table with this caption, up to the rows of its head. */
void report_table(FILE *file, const char *caption);

/** Draw a chart for the section: picture, caption, and the same as a table. */
ritz_status report_figure(report_page *p, chart_draw *draw,
                          const chart_sources *sources,
                          const chart_request *request, const char *caption);

/** Verdicts, charts and tables of records, if there are any. */
ritz_status report_records(report_page *p);

#endif
