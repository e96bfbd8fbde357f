/*
 * Which system modes matter. Values of all configurations are held against one
 * largest value, so that a mode that matters at one angle alone is kept for it.
 */
#include "base/alloc.h"
#include "synthesis/compare_parts.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Values of the flexible modes of one configuration. */
static ritz_status rank_one(const ritz_scene *scene,
                            const ritz_configuration *c, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    const ritz_ranker *ranker = ritz_ranker_find(scene->select_by);
    ritz_modal modal = {0};

    if (!ranker) {
        status = RITZ_ERR_ARGUMENT;
        goto done;
    }
    RITZ_TRY(ritz_modal_new(&c->K, &c->M, c->D.val ? &c->D : NULL, &c->io,
                            &scene->damping, &modal));
    RITZ_TRY(ritz_rank(ranker, &modal, ranking));
    RITZ_FAIL_IF(ranking->count != c->K.ncol - c->num_rigid,
                 RITZ_ERR_CONVERGENCE,
                 "%" PRId64 " flexible modes were ranked where there are "
                 "%" PRId64,
                 ranking->count, c->K.ncol - c->num_rigid);
done:
    ritz_modal_free(&modal);
    return ritz_context(status, c->at);
}

static bool is_ranked(const ritz_scene *scene)
{
    return scene->num_inputs > 0 && scene->num_outputs > 0;
}

ritz_status ritz_compare_threshold(const ritz_scene *scene,
                                   const ritz_system *system, double *least)
{
    ritz_status status = RITZ_OK;
    ritz_ranking ranking = {0};
    double largest = 0.0;

    *least = 0.0;
    if (!is_ranked(scene)) {
        RITZ_FAIL_IF(scene->band_hz[1] <= 0.0, RITZ_ERR_ARGUMENT,
                     "the scene has neither inputs and outputs to rank modes "
                     "by nor a band to keep");
        return RITZ_OK;
    }
    for (int64_t k = 0; k < system->num_configurations; k++) {
        RITZ_TRY(rank_one(scene, &system->configuration[k], &ranking));
        for (int64_t j = 0; j < ranking.count; j++)
            largest = fmax(largest, ranking.value[j]);
        ritz_ranking_free(&ranking);
    }
    RITZ_FAIL_IF(largest <= 0.0, RITZ_ERR_ARGUMENT,
                 "no flexible mode answers any input at any output, so none "
                 "can be chosen");
    *least = scene->select_tolerance * largest;
done:
    ritz_ranking_free(&ranking);
    return status;
}

ritz_status ritz_compare_select(const ritz_scene *scene,
                                const ritz_configuration *c, double least,
                                ritz_compare_row *row)
{
    ritz_status status = RITZ_OK;
    int64_t flexible = c->K.ncol - c->num_rigid;
    double highest = ritz_eigen_lambda(scene->band_hz[1]);
    ritz_ranking ranking = {0};

    if (is_ranked(scene))
        RITZ_TRY(rank_one(scene, c, &ranking));
    RITZ_NEW(row->kept, flexible);
    for (int64_t k = 0; k < flexible; k++)
        if (ranking.value ? ranking.value[k] >= least
                          : c->lambda[c->num_rigid + k] <= highest)
            row->kept[row->num_kept++] = k;
done:
    ritz_ranking_free(&ranking);
    return status;
}
