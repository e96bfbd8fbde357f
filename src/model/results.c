/*
 * Results that containers keep: responses, simulations, rankings. Whoever
 * computes one stands above the container, so that freeing it is done here.
 */
#include <ritz/ranking.h>
#include <ritz/response.h>
#include <ritz/simulate.h>

#include <stdlib.h>

void ritz_response_free(ritz_response *response)
{
    free(response->hertz);
    free(response->input);
    free(response->output);
    free(response->H);
    free(response->singular);
    *response = (ritz_response){0};
}

void ritz_simulation_free(ritz_simulation *simulation)
{
    free(simulation->seconds);
    free(simulation->input);
    free(simulation->output);
    free(simulation->u);
    free(simulation->y);
    free(simulation->kinetic);
    free(simulation->potential);
    free(simulation->dissipated);
    free(simulation->work);
    free(simulation->balance);
    *simulation = (ritz_simulation){0};
}

void ritz_ranking_free(ritz_ranking *ranking)
{
    free(ranking->hertz);
    free(ranking->zeta);
    free(ranking->value);
    free(ranking->order);
    free(ranking->cluster);
    free(ranking->part);
    free(ranking->whole);
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
    free(rankings->item);
    free(rankings->track);
    *rankings = (ritz_rankings){0};
}
