/* Errors against order: how fast each method gets better. */
#include "chart/chart_errors.h"

static double order_of(const record *r)
{
    return (double)r->order;
}

ritz_status chart_convergence(const chart_sources *sources,
                              const chart_wish *wish, gnuplot *out)
{
    static const chart_errors form = {
        .title = "Errors against order",
        .xlabel = "order of the reduced model",
        .x = order_of,
        .lines = true,
    };

    return chart_errors_draw(sources, wish, &form, out);
}
