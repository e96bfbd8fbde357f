/* Time against errors: every method, the front, what was chosen. */
#include "chart/chart_errors.h"

#include <string.h>

static double time_of(const record *r)
{
    return r->cpu;
}

static double cost_of(const record *r)
{
    return r->cost;
}

ritz_status chart_pareto(const chart_sources *sources, const chart_wish *wish,
                         gnuplot *out)
{
    static const chart_errors to_reduce = {
        .title = "Errors against the time to reduce",
        .xlabel = "processor time to make basis and reduction",
        .seconds = true,
        .x = time_of,
        .front = true,
    };
    static const chart_errors to_simulate = {
        .title = "Errors against the cost of simulation",
        .xlabel = "processor time for one simulated second",
        .seconds = true,
        .x = cost_of,
        .front = true,
    };
    bool simulate = wish->against ? strcmp(wish->against, "simulate") == 0
                                  : records_cost(&sources->runs);

    return chart_errors_draw(sources, wish,
                             simulate ? &to_simulate : &to_reduce, out);
}
