/* Style and script of the page: report.css and report.js, line by line. */
#ifndef RITZ_TOOLS_CHART_REPORT_PAGE_H
#define RITZ_TOOLS_CHART_REPORT_PAGE_H

/* Each ended by NULL; CMake makes them of the two files. */
extern const char *const report_style[];
extern const char *const report_script[];

#endif
