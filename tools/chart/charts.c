/* The table of charts: a new one is a file, its template, and a row. */
#include "chart/chart.h"

const chart_kind chart_kinds[] = {
    {"pareto", "errors against the time to reduce or to simulate",
     CHART_RECORDS, "run records", chart_pareto},
    {"convergence", "errors against order, a line for each method",
     CHART_RECORDS, "run records", chart_convergence},
    {"hankel", "values of modes as bars, by configuration or ranking",
     MODEL_RANKING, "rankings", chart_hankel},
    {"response", "responses over each other, errors below", MODEL_RESPONSE,
     "responses, the reference first", chart_response},
    {"mac", "how like the modes of two models are", CHART_MODES | MODEL_SYSTEM,
     "two of component, reduced, basis, system", chart_mac},
    {"tracks", "frequencies of modes over configurations", CHART_TRACKS,
     "a table of --tracks", chart_tracks},
    {"simulation", "outputs over time, over each other", MODEL_SIMULATION,
     "time responses", chart_simulation},
    {"diagnostics", "diagnostics of runs, such as violations", MODEL_SIMULATION,
     "time responses with diagnostics", chart_diagnostics},
    {"switched", "vectors of switched models over time, errors below",
     MODEL_SIMULATION, "time responses, the full model first", chart_switched},
    {"motion", "a body deformed and stressed at four times", CHART_MOTION,
     "a collection of ritz-recover", chart_motion},
    {0},
};
