/*
 * Results that containers keep: measures, responses, simulations, rankings.
 * Rooms above the container compute them, so that they are freed here.
 */
#include "base/alloc.h"

#include <ritz/model.h>
#include <ritz/ranking.h>
#include <ritz/recover.h>
#include <ritz/response.h>
#include <ritz/simulate.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void ritz_response_free(ritz_response *response)
{
    RITZ_FREE(response->hertz, response->input, response->output, response->H,
              response->singular);
    *response = (ritz_response){0};
}

void ritz_simulation_free(ritz_simulation *simulation)
{
    RITZ_FREE(simulation->seconds, simulation->input, simulation->output,
              simulation->u, simulation->y, simulation->kinetic,
              simulation->potential, simulation->dissipated, simulation->work,
              simulation->balance);
    RITZ_FREE(simulation->diagnostic, simulation->diagnosis, simulation->q,
              simulation->v, simulation->a, simulation->block,
              simulation->state);
    *simulation = (ritz_simulation){0};
}

void ritz_ranking_free(ritz_ranking *ranking)
{
    RITZ_FREE(ranking->hertz, ranking->zeta, ranking->value, ranking->order,
              ranking->cluster, ranking->part, ranking->whole);
    ritz_dense_free(&ranking->parts);
    free(ranking->system_value);
    *ranking = (ritz_ranking){0};
}

void ritz_rankings_free(ritz_rankings *rankings)
{
    for (int64_t k = 0; k < rankings->count; k++) {
        ritz_ranking_free(&rankings->item[k]);
        if (rankings->track)
            free(rankings->track[k]);
    }
    RITZ_FREE(rankings->item, rankings->track);
    *rankings = (ritz_rankings){0};
}

ritz_status ritz_measures_add(ritz_measures *measures, const char *name,
                              double value, double limit, const char *where)
{
    ritz_measure *last = NULL;

    RITZ_CHECK(ritz_array_extend(&measures->item, measures->count, 1,
                                 sizeof *measures->item));
    last = &measures->item[measures->count++];
    snprintf(last->name, sizeof last->name, "%s", name);
    snprintf(last->where, sizeof last->where, "%s", where ? where : "");
    last->value = value;
    last->limit = limit;
    return RITZ_OK;
}

void ritz_measures_name_cause(ritz_measures *measures, const char *cause)
{
    ritz_measure *last = &measures->item[measures->count - 1];

    snprintf(last->cause, sizeof last->cause, "%s", cause);
}

ritz_measure *ritz_measures_find(const ritz_measures *measures,
                                 const char *name)
{
    for (int64_t k = 0; k < measures->count; k++)
        if (strcmp(measures->item[k].name, name) == 0)
            return &measures->item[k];
    return NULL;
}

double ritz_measures_value(const ritz_measures *measures, const char *name)
{
    const ritz_measure *found = ritz_measures_find(measures, name);

    return found ? found->value : nan("");
}

ritz_status ritz_measures_copy(const ritz_measures *from, ritz_measures *out)
{
    ritz_measure *item = NULL;

    RITZ_CHECK_COPY(item, from->item, from->count);
    ritz_measures_free(out);
    *out = (ritz_measures){from->count, item};
    return RITZ_OK;
}

void ritz_measures_free(ritz_measures *measures)
{
    free(measures->item);
    *measures = (ritz_measures){0};
}

void ritz_peaks_free(ritz_peaks *peaks)
{
    RITZ_FREE(peaks->place, peaks->part, peaks->value, peaks->seconds);
    *peaks = (ritz_peaks){0};
}

void ritz_recovered_free(ritz_recovered *recovered)
{
    RITZ_FREE_EACH(ritz_peaks, recovered->num_quantities, recovered->quantity);
    *recovered = (ritz_recovered){0};
}
