/* Parts of the page that report.c puts together. */
#ifndef RITZ_TOOLS_CHART_REPORT_PARTS_H
#define RITZ_TOOLS_CHART_REPORT_PARTS_H

#include "chart/chart.h"

/* The page in the making. */
typedef struct report_page {
    const chart_sources *sources;
    const chart_wish *wish;
    cli_table body;
    cli_table links; /* of the contents */
    int64_t num_pictures;
    int64_t num_sections;
} report_page;

/** A section with its title, which the contents name; and its end. */
void report_begin(report_page *p, const char *title);
void report_end(report_page *p);

/** Draw, and put picture, caption and data down. */
ritz_status report_figure(report_page *p, const chart_sources *sources,
                          const chart_wish *wish,
                          ritz_status (*draw)(const chart_sources *,
                                              const chart_wish *, gnuplot *),
                          const char *caption);

/** What the command line wishes, for pictures that stay on the page. */
chart_wish report_wish(const report_page *p);

/** The kind of chart of that name, which there is. */
const chart_kind *report_kind(const char *name);

/** Verdicts, charts and tables of records, if there are any. */
ritz_status report_records(report_page *p);

/** Pictures of all other files. */
ritz_status report_pictures(report_page *p);

/** Which method, how large, how wrong, how fast: of one subject. */
ritz_status report_verdict(FILE *file, const records *all);

/** Methods at equal order, and at equal error. */
ritz_status report_tables(FILE *file, const records *all);

/** A table with tabs, names of columns first, as one of markup. */
void report_table(FILE *file, const char *text, const char *caption);

/** Subjects of records that can be drawn, each once; borrowed names. */
ritz_status report_subjects(const records *all, int64_t *count,
                            const char ***out);

/** "sha256-..." in base 64 of lines, as a policy of contents has it. */
void report_hash(const char *const *lines, char out[64]);

#endif
