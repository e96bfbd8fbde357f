/* One page of everything: a verdict, charts, tables, provenance. */
#ifndef RITZ_TOOLS_CHART_REPORT_H
#define RITZ_TOOLS_CHART_REPORT_H

#include "chart/chart.h"

/**
 * Write the page. Charts are drawn for what the files hold.
 *
 * @param[in] wish  path of the page; choices of charts
 */
ritz_status report_write(const chart_sources *sources, const chart_wish *wish);

#endif
